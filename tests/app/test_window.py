#!/usr/bin/env python3
"""The window under a virtual display: opens, takes the mouse and keys of xdotool, and the water answers.

usage: test_window.py LIDO [CASE ...]      exit code 77: Xvfb or xdotool is missing

Frames are followed through the window's title, energies through --stats. Every process is ended by its id.
"""
import contextlib
import ctypes
import ctypes.util
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

PATIENCE = 60  # s: how long anything may take on a slow machine under a sanitizer

POOL = {
    "version": 1, "name": "pool",
    "simulation": {"particle_radius": 0.03, "viscosity": 0.2},
    "container": {"min": [0, 0, 0], "max": [1.2, 0.8, 0.6]},
    "fluid": [{"type": "block", "min": [0, 0, 0], "max": [1.2, 0.3, 0.6]}],
}
# One push more than a world takes, from frame 6 on: the simulation must stop there.
FAILING = dict(POOL, events=[{"type": "push", "time": 0.1, "duration": 1, "origin": [0.6, 0.1, 2],
                              "direction": [0, 0, -1], "acceleration": [1, 0, 0]}] * 17)


def wait_until(what, test, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = test()
        if result:
            return result
        time.sleep(0.02)
    raise AssertionError(f"waited {seconds} s in vain: {what}")


def xdotool(*arguments):
    return subprocess.run(["xdotool", *map(str, arguments)], check=True, capture_output=True, text=True,
                          timeout=PATIENCE).stdout.strip()


def write_scene(folder, scene):
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


@contextlib.contextmanager
def virtual_display():
    """Xvfb on a display number that it finds itself."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1024x768x24", "-nolisten", "tcp",
                               "-noreset"],
                              pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as numbers:
            number = numbers.readline().strip()
        if not number:
            raise AssertionError("Xvfb did not start")
        os.environ["DISPLAY"] = ":" + number
        os.environ.pop("WAYLAND_DISPLAY", None)
        wait_until("the display answers", lambda: subprocess.run(["xdotool", "getdisplaygeometry"],
                                                                  capture_output=True).returncode == 0)
        yield
    finally:
        server.terminate()
        server.wait(PATIENCE)


class Window:
    """One run of the program with a window that has the keyboard."""

    def __init__(self, folder, *arguments, scene=POOL):
        self.folder = folder
        path = write_scene(folder, scene)
        self.errors = open(os.path.join(folder, "stderr"), "w+")
        self.process = subprocess.Popen([PROGRAM, path, "--size", "480x320", "--threads", "1", *map(str, arguments)],
                                        cwd=folder, stderr=self.errors)
        self.id = None

    def __enter__(self):
        self.id = wait_until("the window opens", self.find)
        wait_until("the first picture", lambda: "frame" in self.title())
        xdotool("windowfocus", self.id)
        xdotool("mousemove", "--window", self.id, 240, 160)
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.errors.close()

    def find(self):
        assert self.process.poll() is None, f"ended with {self.process.returncode}: {self.messages()}"
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Lido"], capture_output=True, text=True)
        return found.stdout.split()[0] if found.stdout.split() else None

    def title(self):
        assert self.process.poll() is None, f"ended with {self.process.returncode}: {self.messages()}"
        return xdotool("getwindowname", self.id)

    def frame(self):
        return int(re.search(r"frame (\d+)", self.title()).group(1))

    def paused(self):
        return "paused" in self.title()

    def key(self, *names):
        for name in names:
            xdotool("key", name)

    def wait_frame(self, number):
        wait_until(f"frame {number}", lambda: self.frame() >= number)

    def pause(self):
        self.key("space")
        wait_until("it pauses", self.paused)
        return self.standing_frame()

    def standing_frame(self):
        """The frame that is shown once the one at work has come."""
        last = -1
        while last != (now := self.frame()):
            last = now
            time.sleep(0.4)
        return now

    def messages(self):
        self.errors.seek(0)
        return self.errors.read()

    def ends_with(self, code):
        returned = self.process.wait(PATIENCE)
        assert returned == code, f"ended with {returned}, not {code}: {self.messages()}"

    def quit(self):
        self.key("q")
        self.ends_with(0)


def read_png(path):
    """Width, height and rows of RGB bytes."""
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        at += length + 12
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert (depth, colour) == (8, 2), "not RGB with 8 bits"
        if kind == b"IDAT":
            packed += body
    raw, stride, rows = zlib.decompress(packed), width * 3, []
    above = bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = row[i - 3] if i > 2 else 0, above[i], above[i - 3] if i > 2 else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                row[i] = (row[i] + near[2]) & 255
        rows.append(row)
        above = row
    return width, height, rows


# ---- Cases ------------------------------------------------------------------------------------------------------------

def largest_energy(folder, hand, frames=110, scene=POOL):
    """Largest kinetic energy (J) of a settled pool from frame 60 on, while `hand` acts."""
    stats = os.path.join(folder, "stats.jsonl")
    with Window(folder, "--frames", frames, "--stats", stats, scene=scene) as window:
        window.wait_frame(60)
        hand(window)
        window.ends_with(0)
    lines = [json.loads(line) for line in open(stats)]
    assert [line["frame"] for line in lines] == list(range(frames)), "not every frame once"
    return max(line["energy"]["kinetic"] for line in lines if line["frame"] >= 60)


def stroke(window, button, *keys, frames=0):
    """Drag from left to right, again and again until so many frames have passed."""
    end = window.frame() + frames
    for key in keys:
        xdotool("keydown", key)
    xdotool("mousemove", "--window", window.id, 160, 190, "mousedown", button)
    while True:
        for x in range(160, 321, 16):
            xdotool("mousemove", "--window", window.id, x, 190)
            time.sleep(0.02)
        if window.frame() >= end:
            break
    xdotool("mouseup", button)
    for key in keys:
        xdotool("keyup", key)


def hold(window, key):
    xdotool("keydown", key)
    window.wait_frame(window.frame() + 24)
    xdotool("keyup", key)


def case_water_answers(folder):
    calm = largest_energy(folder, lambda window: None)
    looked = largest_energy(folder, lambda window: stroke(window, 1, frames=12))
    assert looked == calm, f"looking around moved the water: {looked} J against {calm} J"
    for name, hand in [("push", lambda window: stroke(window, 3, frames=12)),
                       ("push with one button", lambda window: stroke(window, 1, "ctrl", frames=12)),
                       ("pull", lambda window: stroke(window, 3, "shift", frames=12)),
                       ("lean", lambda window: hold(window, "Right")),
                       ("lean by hand", lambda window: stroke(window, 1, "alt", frames=12)),
                       ("lean with the right button", lambda window: stroke(window, 3, "ctrl", frames=12))]:
        moved = largest_energy(folder, hand)
        print(f"  {name}: {moved:.4g} J against {calm:.4g} J")
        assert moved > 8 * calm, f"{name}: the water did not answer: {moved} J against {calm} J"


def case_body_answers(folder):
    """A left drag on a draggable body moves it, and it moves the water; on one that stands it looks around."""
    energies = []
    for motion in ["static", "draggable"]:
        ball = {"type": "sphere", "radius": 0.12, "position": [0.6, 0.2, 0.3], "motion": motion}
        scene = dict(POOL, obstacles=[ball], camera={"eye": [0.6, 0.2, 2], "target": [0.6, 0.2, 0.3]})

        def drag(window):
            end = window.frame() + 12
            xdotool("mousemove", "--window", window.id, 240, 160, "mousedown", 1)
            while window.frame() < end:
                for x in [280, 320, 280, 240, 200, 160, 200, 240]:
                    xdotool("mousemove", "--window", window.id, x, 160)
                    time.sleep(0.05)
            xdotool("mouseup", 1)
        energies.append(largest_energy(folder, drag, scene=scene))
    print(f"  dragged: {energies[1]:.4g} J against {energies[0]:.4g} J")
    assert energies[1] > 8 * energies[0], "the water did not answer to the body"


def case_glass_leans(folder):
    """A left drag on the glass leans it and moves the water; beside it, it looks around and the water stays."""
    glass = dict(POOL, container={"shape": "glass", "min": [0, 0, 0], "max": [0.6, 0.8, 0.6]},
                 fluid=[{"type": "block", "min": [0, 0, 0], "max": [0.6, 0.3, 0.6]}],
                 camera={"eye": [0.3, 0.4, 2.5], "target": [0.3, 0.4, 0.3]})

    def drag(x):
        def act(window):
            end = window.frame() + 24
            xdotool("mousemove", "--window", window.id, x, 160, "mousedown", 1)
            for step in range(1, 6):
                xdotool("mousemove", "--window", window.id, x + 12 * step, 160 - 4 * step)
            window.wait_frame(end)
            xdotool("mouseup", 1)
        return act
    beside, on = (largest_energy(folder, drag(x), scene=glass) for x in [40, 240])
    print(f"  dragged: {on:.4g} J against {beside:.4g} J")
    assert on > 8 * beside, "the water did not answer to the glass"


def case_pause_step_reset(folder):
    with Window(folder) as window:
        window.wait_frame(5)
        frame = window.pause()
        time.sleep(0.5)
        assert window.frame() == frame, "a paused frame moved"
        for step in range(1, 4):
            window.key("period")
            wait_until("the step is shown", lambda: window.frame() != frame + step - 1)
            assert window.standing_frame() == frame + step, "not exactly one step"
        window.key("r")
        wait_until("it starts again", lambda: window.frame() == 0)
        assert window.paused() and window.standing_frame() == 0
        window.key("space")
        window.wait_frame(3)
        window.quit()


def case_styles_and_overlays(folder):
    with Window(folder) as window:
        for key in ["s", "1", "2", "9", "s", "h", "f", "l", "l", "l", "l", "l", "l", "l", "s", "1", "F1", "f", "c"]:
            window.key(key)
            frame = window.frame()
            window.wait_frame(frame + 1)
        frame = window.pause()
        window.key("s", "l", "s", "1")  # another style of the frame that stands
        assert window.standing_frame() == frame
        window.quit()
        assert window.messages() == "", window.messages()


def case_eye(folder):
    """Orbit, pan and zoom change the picture of a paused frame; C brings the first one back."""
    with Window(folder) as window:
        window.wait_frame(2)
        window.pause()
        window.key("c")
        seen = []

        def look():
            window.key("p")
            path = os.path.join(folder, "out", f"picture_{len(seen) + 1:03d}.png")
            wait_until("a picture is saved", lambda: os.path.exists(path))
            seen.append(read_png(path)[2])

        look()
        for act in [lambda: stroke(window, 1), lambda: stroke(window, 2), lambda: stroke(window, 1, "shift"),
                    lambda: xdotool("click", 4), lambda: xdotool("click", 5, "click", 5)]:
            act()
            look()
            assert seen[-1] != seen[-2], f"picture {len(seen)} is as the one before"
        window.key("c")
        look()
        assert seen[-1] == seen[0], "C does not bring the camera back"
        window.quit()


def case_resize(folder):
    with Window(folder) as window:
        for number, (width, height) in enumerate([(480, 320), (300, 500), (801, 203), (64, 64)], 1):
            xdotool("windowsize", "--sync", window.id, width, height)
            window.wait_frame(window.frame() + 3)
            xdotool("windowfocus", window.id)
            window.key("h", "f", "p")
            path = os.path.join(folder, "out", f"picture_{number:03d}.png")
            wait_until("a picture is saved", lambda: os.path.exists(path))
            size_x, size_y, rows = read_png(path)
            assert (size_x, size_y) == (width, height), f"a picture of {size_x}x{size_y} in a window of {width}x{height}"
            colours = {bytes(row[i:i + 3]) for row in rows for i in range(0, len(row), 3)}
            assert len(colours) > 50, "an empty picture"
        window.quit()


def case_picture_cannot_be_saved(folder):
    with open(os.path.join(folder, "out"), "w"):
        pass  # a file where the folder should be
    with Window(folder) as window:
        window.wait_frame(2)
        window.key("p")
        window.wait_frame(window.frame() + 5)
        window.quit()


def case_answers_while_simulating(folder):
    """A frame that takes seconds: the eye still moves, pictures are drawn and saved meanwhile."""
    slow = dict(POOL, simulation={"particle_radius": 0.015, "iterations": 100, "time_step": 0.0005})
    with Window(folder, scene=slow) as window:
        begin, frame = time.monotonic(), window.frame()
        for number in range(1, 4):
            stroke(window, 1)
            window.key("p")
            path = os.path.join(folder, "out", f"picture_{number:03d}.png")
            wait_until("a picture is saved", lambda: os.path.exists(path))
        took = time.monotonic() - begin
        pictures = [read_png(os.path.join(folder, "out", f"picture_{number:03d}.png"))[2] for number in range(1, 4)]
        assert window.frame() <= frame + 1, f"{window.frame() - frame} frames in {took} s: too fast for this test"
        assert pictures[0] != pictures[1] != pictures[2], "the eye did not move"
        # Not quit: that would wait for the frame.


def send_client_message(window_id, protocol):
    """What a window manager sends when its close button is pressed."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XInternAtom.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x11.XOpenDisplay(None))

    class Event(ctypes.Structure):
        _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                    ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
                    ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("padding", ctypes.c_long * 24)]
    event = Event(type=33, window=int(window_id), format=32)
    event.message_type = x11.XInternAtom(display, b"WM_PROTOCOLS", 0)
    event.data[0] = x11.XInternAtom(display, protocol, 0)
    x11.XSendEvent(display, ctypes.c_ulong(int(window_id)), 0, ctypes.c_long(0), ctypes.byref(event))
    x11.XCloseDisplay(display)


def set_iconic(window_id, iconic):
    """What a window manager notes on a window that it has minimised."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XInternAtom.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    state = ctypes.c_ulong(x11.XInternAtom(display, b"WM_STATE", 0))
    value = (ctypes.c_ulong * 2)(3 if iconic else 1, 0)
    x11.XChangeProperty(display, ctypes.c_ulong(int(window_id)), state, state, 32, 0, value, 2)
    x11.XCloseDisplay(display)


def processor_seconds(pid):
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def case_minimised_sleeps(folder):
    if not os.path.exists("/proc/self/stat"):
        return print("minimised_sleeps: no /proc to read processor times from")
    with Window(folder) as window:
        window.wait_frame(3)
        set_iconic(window.id, True)
        time.sleep(1)
        frame, used = window.frame(), processor_seconds(window.process.pid)
        time.sleep(2)
        assert window.frame() == frame, "a minimised window simulates"
        used = processor_seconds(window.process.pid) - used
        assert used < 0.2, f"a minimised window used {used} s of processor time in 2 s"
        set_iconic(window.id, False)
        window.wait_frame(frame + 3)
        used = window.pause() and processor_seconds(window.process.pid)
        time.sleep(6)  # past the end of every notice
        used = processor_seconds(window.process.pid) - used
        assert used < 0.6, f"a paused window used {used} s of processor time in 6 s"
        window.quit()


def case_ends_well(folder):
    for key in ["q", "Escape"]:
        with Window(folder) as window:
            window.key(key)
            window.ends_with(0)
    with Window(folder) as window:
        send_client_message(window.id, b"WM_DELETE_WINDOW")
        window.ends_with(0)
    with Window(folder) as window:
        window.process.send_signal(signal.SIGINT)
        window.ends_with(0)


def case_failure_is_shown(folder):
    with Window(folder, scene=FAILING) as window:
        wait_until("the failure is told", lambda: "events[16]" in window.messages())
        assert window.standing_frame() == 6, "not the last good frame"
        window.key("s", "h", "f")
        assert window.messages().count("\n") == 1, "told more than once"
        window.key("r")
        wait_until("it fails again", lambda: window.messages().count("events[16]") == 2)
        assert window.standing_frame() == 6
        window.quit()
    with Window(folder, "--frames", 30, scene=FAILING) as window:
        window.ends_with(1)


def case_no_display(folder):
    for display in ["", ":98765"]:
        run = run_once(folder, DISPLAY=display)
        assert run.returncode == 1, f"ended with {run.returncode}"
        assert run.stderr.count("\n") == 1 and "display" in run.stderr and "lido render" in run.stderr, run.stderr
        run = subprocess.run([PROGRAM, "render", write_scene(folder, POOL), "--frames", "1", "--context", "glfw", "-o",
                              "f_%d.png"], cwd=folder, env={**os.environ, "DISPLAY": display}, capture_output=True,
                             text=True, timeout=PATIENCE)
        assert run.returncode == 1 and "display" in run.stderr, f"{run.returncode}: {run.stderr}"


def run_once(folder, *arguments, **environment):
    return subprocess.run([PROGRAM, write_scene(folder, POOL), *arguments], cwd=folder, env={**os.environ, **environment},
                          capture_output=True, text=True, timeout=PATIENCE)


def case_refusals(folder):
    for arguments, words in [(["--layer", "nonsense"], "nonsense"), (["--context", "egl"], "--context")]:
        run = run_once(folder, *arguments)
        assert run.returncode == 2 and run.stderr.count("\n") == 1 and words in run.stderr, (run.returncode, run.stderr)
    run = run_once(folder, MESA_GL_VERSION_OVERRIDE="3.3")
    assert run.returncode == 1 and run.stderr.count("\n") == 1 and "OpenGL 4.5" in run.stderr, run.stderr


def case_same_picture_with_every_context(folder):
    path = write_scene(folder, POOL)
    pictures = []
    for context in ["glfw", "egl"]:
        run = subprocess.run([PROGRAM, "render", path, "--frames", "3:4", "--size", "320x180", "--context", context,
                              "--quiet", "-o", context + "_%d.png"], cwd=folder, capture_output=True, text=True,
                             timeout=PATIENCE)
        if context == "egl" and run.returncode == 1 and "EGL" in run.stderr:
            print("  no EGL here")
            return
        assert run.returncode == 0, run.stderr
        pictures.append(b"".join(read_png(os.path.join(folder, context + "_3.png"))[2]))
    far = sum(abs(a - b) > 2 for a, b in zip(*pictures))
    assert far <= 0.005 * len(pictures[0]), f"{far} of {len(pictures[0])} values differ by more than 2/255"


def main():
    names = sys.argv[2:] or [name[5:] for name in globals() if name.startswith("case_")]
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        print("Xvfb or xdotool is missing")
        return 77
    failed = 0
    with virtual_display():
        for name in names:
            with tempfile.TemporaryDirectory() as folder:
                begin = time.monotonic()
                try:
                    globals()["case_" + name](folder)
                    outcome = "ok"
                except Exception as error:  # the other cases still tell something
                    outcome = f"FAILED: {type(error).__name__}: {error}"
                    failed += 1
                print(f"{name}: {outcome} ({time.monotonic() - begin:.1f} s)", flush=True)
    return 1 if failed else 0


PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else None
if __name__ == "__main__":
    if not PROGRAM:
        sys.exit(__doc__)
    sys.exit(main())
