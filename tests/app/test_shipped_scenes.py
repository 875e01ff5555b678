#!/usr/bin/env python3
"""The shipped scenes through the real program: nothing leaves the tank or the glass, still water stays still, water runs
down the steps and does not cease, the wave climbs the far wall, spouts fill the pool.

Usage: test_shipped_scenes.py LIDO SOURCE_FOLDER [long]
The ordinary run uses coarser particles and fewer frames, `long` the scenes as they are.
"""
import array
import glob
import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile

# Scene: particle radius of the ordinary run (m), frames of the ordinary and the long run.
SCENES = {
    "dam_break": (0.04, 60, 120), "double_dam_break": (0.04, 60, 120), "still_pool": (0.025, 301, 301),
    "wave_pool": (0.05, 90, 120), "glass": (0.003, 90, 150), "steps": (0.03, 90, 240), "spouts": (0.025, 90, 150),
    "pontoon": (0.06, 180, 180), "splash": (0.04, 40, 60), "wave": (0.0375, 120, 120), "ocean_waves": (0.08, 90, 60),
    "table_pool": (0.03, 150, 150),
}  # fmt: skip
# Particle radius of twenty seconds of the scene (m), None: as it is.
TWENTY_SECONDS = {"wave_pool": None, "glass": None, "steps": None, "ocean_waves": 0.04, "table_pool": 0.03}
# Particles of the scene as it is, at the start.
EXACT = {"wave_pool": 65536, "ocean_waves": 262144, "steps": 25600, "wave": 125000}

WITHOUT_PARTICLES = {"ripple"}

MEAN_DENSITY_ERROR = 0.01  # of still_pool after 3 s
MAX_DENSITY_ERROR = 0.05
ENERGY_SHARE = 1e-4        # kinetic energy per mass, in g·H, after 5 s


def simulate(lido, scene, folder, frames, sets, options=()):
    stats = os.path.join(folder, "stats.jsonl")
    command = [lido, "simulate", scene, "--frames", str(frames), "-q", "--stats", stats, "-o", f"{folder}/p_%05d.ply"]
    command += options
    for key in sets:
        command += ["--set", key]
    subprocess.run(command, check=True)
    return [json.loads(line) for line in open(stats)]


def positions(path):
    """Positions of a PLY file whose vertices hold 32-bit values only, x, y, z first."""
    data = open(path, "rb").read()
    header, body = data.split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    properties = [line.split() for line in lines if line.startswith("property")]
    assert [p[2] for p in properties[:3]] == ["x", "y", "z"] and all(p[1] in ("float", "uint", "int") for p in properties)
    values = array.array("f", body)
    width = len(properties)
    assert len(values) == count * width
    return [values[axis::width] for axis in range(3)]


def check_container(name, folder, frames, box):
    files = sorted(glob.glob(f"{folder}/p_*.ply"))
    assert len(files) == frames, f"{name}: {len(files)} files of {frames}"
    for path in files:
        places = positions(path)
        for axis, values in enumerate(places):
            low, high = min(values), max(values)
            assert box["min"][axis] <= low and high <= box["max"][axis], f"{name}: {path}: axis {axis}: {low} … {high}"
        if box["shape"] == "glass":
            middle = [(box["min"][axis] + box["max"][axis]) / 2 for axis in (0, 2)]
            radius = min(box["max"][axis] - box["min"][axis] for axis in (0, 2)) / 2
            reach = max(math.hypot(x - middle[0], z - middle[1]) for x, z in zip(places[0], places[2]))
            assert reach <= radius, f"{name}: {path}: {reach} m from the axis of a glass of {radius} m"


def check_still_pool(scene, lines):
    at_3_s, at_5_s = lines[180]["density_error"], lines[300]
    assert at_3_s["mean"] <= MEAN_DENSITY_ERROR, f"mean density error {at_3_s['mean']}"
    assert at_3_s["max"] <= MAX_DENSITY_ERROR, f"largest density error {at_3_s['max']}"
    block = scene["fluid"][0]
    size = [b - a for a, b in zip(block["min"], block["max"])]
    mass = scene["simulation"]["rest_density"] * size[0] * size[1] * size[2]
    bound = ENERGY_SHARE * 9.81 * size[1] * mass
    assert at_5_s["energy"]["kinetic"] <= bound, f"{at_5_s['energy']['kinetic']} J, bound {bound} J"
    print(f"still_pool: density error {at_3_s['mean']:.4%} mean, {at_3_s['max']:.4%} largest after 3 s; "
          f"{at_5_s['energy']['kinetic']:.3g} J after 5 s (bound {bound:.3g})")


def check_exact(lido, path, name):
    """Not one particle more or less, and none left out."""
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.jsonl")
        command = [lido, "simulate", path, "--frames", "1", "--stats", stats, "-o", f"{folder}/p.ply"]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
        count = json.loads(open(stats).readline())["particles"]
    assert count == EXACT[name], f"{name}: {count} particles, not {EXACT[name]}"
    assert "left out" not in said, f"{name}: {said}"


def check_ripple(lido, path, name):
    """It has waves, no particles, and says that there is nothing to write."""
    water, = json.loads(subprocess.check_output([lido, "check", path]))["fluid"]
    assert water["type"] == "ripple" and 4 <= len(water["waves"]) <= 6, f"{name}: {water}"
    with tempfile.TemporaryDirectory() as folder:
        told = subprocess.run([lido, "simulate", path, "-o", f"{folder}/p_%05d.ply"], capture_output=True, text=True)
        assert told.returncode == 2 and "no particles" in told.stderr, f"{name}: {told}"
        assert not os.listdir(folder), f"{name}: {os.listdir(folder)}"


def check_steps(scene, lines, last):
    """The water pours over every tread, and does not come to rest while the spring runs."""
    flight, = (body for body in scene["obstacles"] if body["type"] == "stairs")
    run, rise = flight["size"][0] / flight["steps"], flight["size"][1] / flight["steps"]
    foot, bottom = (flight["position"][axis] - flight["size"][axis] / 2 for axis in (0, 1))
    on = [0] * flight["steps"]
    for x, y in zip(last[0], last[1]):
        tread = math.floor((x - foot) / run)
        if 0 <= tread < flight["steps"] and 0 <= y - bottom - (tread + 1) * rise < rise:
            on[tread] += 1
    assert min(on) > 0.01 * len(last[0]), f"steps: {on} particles on the treads"
    energies = [line["energy"]["kinetic"] for line in lines]
    assert energies[-1] > 0.5 * max(energies), f"steps: {energies[-1]} J at last, {max(energies)} J at most"
    print(f"steps: {lines[-1]['particles']} particles, {on} on the treads; {energies[-1]:.4g} J of {max(energies):.4g}")


def check_wave(scene, folder):
    """The wave climbs the far wall higher than the water stood at the start."""
    wall, height = scene["container"]["max"][0] - 0.3, max(block["max"][1] for block in scene["fluid"])
    climbed = 0
    for path in sorted(glob.glob(f"{folder}/p_*.ply")):
        x, y, _ = positions(path)
        climbed = max([climbed] + [b for a, b in zip(x, y) if a > wall])
    print(f"wave: {climbed:.3g} m up the far wall")
    assert climbed > height, f"wave: {climbed} m up the far wall, {height} m at the start"


def check_table_pool(scene, folder):
    """Legs stand on the floor and in the air, their tops under the table's; waves rise and fall in front of each of them."""
    level = max(block["max"][1] for block in scene["fluid"])
    legs = [body for body in scene["obstacles"] if body["name"].endswith("leg")]
    heights = [[] for leg in legs]
    for path in sorted(glob.glob(f"{folder}/p_*.ply")):
        particles = list(zip(*positions(path)))
        for leg, tops in zip(legs, heights):
            (x, y, z), (width, height, depth) = leg["position"], leg["size"]
            assert y - height / 2 < 1e-6 and y + height / 2 > level + 0.2, f"table_pool: {leg['name']} does not stand right"
            front = (b for a, b, c in particles if abs(a - x) < width and depth / 2 < c - z < depth / 2 + 0.15)
            tops.append(max(front))
    swings = [max(tops) - min(tops) for tops in heights]
    print(f"table_pool: the water beside the legs rises and falls by {min(swings):.3f} to {max(swings):.3f} m")
    assert len(legs) == 4 and min(swings) > 0.03, f"table_pool: {swings} m beside the legs"


def check_motion(name, scene, folder, lines):
    """What the scene is there to show."""
    first, last = lines[0], lines[-1]
    if name == "spouts":
        assert last["particles"] > first["particles"], "spouts: nothing was emitted"
        speeds = max(line["max_speed"] for line in lines)
        assert speeds < 10, f"spouts: {speeds} m/s"
    if name == "steps":
        check_steps(scene, lines, positions(sorted(glob.glob(f"{folder}/p_*.ply"))[-1]))
    if name == "wave":
        check_wave(scene, folder)
    if name == "table_pool":
        check_table_pool(scene, folder)


def check_paddles(lido, path, scene, frames, sets, lines):
    """The paddles put work into the water: with them it moves more than without."""
    sets = sets + [f"obstacles.{i}.start=100" for i, body in enumerate(scene["obstacles"]) if body["motion"] == "scripted"]
    with tempfile.TemporaryDirectory() as folder:
        still = simulate(lido, path, folder, frames, sets)
    at_rest, moved = (run[-1]["energy"]["kinetic"] for run in (still, lines))
    print(f"{scene['name']}: {moved:.4g} J, {at_rest:.4g} J without paddles")
    assert moved > 1.5 * at_rest, f"{scene['name']}: {moved} J with paddles, {at_rest} J without"


def pose(body, time):
    """Where a body stands: at its place, or on its stroke."""
    swing = 0
    if body["motion"] == "scripted" and time > body["start"]:
        swing = (1 - math.cos(2 * math.pi * (time - body["start"]) / body["period"])) / 2
    return [p + swing * s for p, s in zip(body["position"], body["stroke"])]


def to_body(body, p):
    """A vector in the body's own axes; the body was turned about x, then y, then z."""
    p = list(p)
    for axis in (2, 1, 0):
        c, s = math.cos(math.radians(body["rotation"][axis])), math.sin(math.radians(body["rotation"][axis]))
        a, b = (axis + 1) % 3, (axis + 2) % 3
        p[a], p[b] = c * p[a] + s * p[b], c * p[b] - s * p[a]
    return p


def inside(body, at, point, tolerance):
    """Whether the point lies deeper than the tolerance in the body."""
    x, y, z = to_body(body, [p - a for p, a in zip(point, at)])
    if body["type"] == "sphere":
        return math.sqrt(x * x + y * y + z * z) < body["radius"] - tolerance
    half = [size / 2 - tolerance for size in body["size"]]
    if abs(x) >= half[0] or abs(y) >= half[1] or abs(z) >= half[2]:
        return False
    if body["type"] == "box":
        return True
    assert body["type"] == "stairs"
    length, height, _ = body["size"]
    step = math.floor((x - tolerance + length / 2) / length * body["steps"])
    return y + tolerance < (step + 1) / body["steps"] * height - height / 2


def check_twenty_seconds(lido, path, name, scene):
    """Twenty seconds of the scene: no particle outside the container, nor deeper than 0.1 spacings in a body."""
    fps, radius = 5, TWENTY_SECONDS[name] or scene["simulation"]["particle_radius"]
    tolerance, sets = 0.2 * radius, [f"simulation.particle_radius={radius}"]
    bodies = [body for body in scene["obstacles"] if body["motion"] in ("static", "scripted", "draggable")]
    with tempfile.TemporaryDirectory() as folder:
        simulate(lido, path, folder, 20 * fps + 1, sets, ["--fps", str(fps)])
        check_container(name, folder, 20 * fps + 1, scene["container"])
        for frame, file in enumerate(sorted(glob.glob(f"{folder}/p_*.ply"))):
            at = [pose(body, frame / fps) for body in bodies]
            for point in zip(*positions(file)):
                for body, place in zip(bodies, at):
                    assert not inside(body, place, point, tolerance), f"{name}: {file}: {point} is in {body['name']}"
    print(f"{name}: 20 s, nothing outside the container or in a body")


def check_threads(lido, path, name, radius):
    """The same bytes for any number of threads."""
    found = set()
    for threads in (1, 2, 3, 8):
        with tempfile.TemporaryDirectory() as folder:
            simulate(lido, path, folder, 45, [f"simulation.particle_radius={radius}"], ["--threads", str(threads)])
            files = sorted(glob.glob(f"{folder}/p_*.ply"))
            found.add(hashlib.sha256(b"".join(open(file, "rb").read() for file in files)).digest())
    assert len(found) == 1, f"{name}: the particles depend on the number of threads"


def main():
    lido, source, full = sys.argv[1], sys.argv[2], sys.argv[3:] == ["long"]
    shipped = {os.path.basename(path)[:-5] for path in glob.glob(os.path.join(source, "configs", "*.json"))}
    assert shipped - {"scene.schema"} == set(SCENES) | WITHOUT_PARTICLES, f"not tested: {shipped - {'scene.schema'} - set(SCENES)}"
    for name in WITHOUT_PARTICLES:
        check_ripple(lido, os.path.join(source, "configs", name + ".json"), name)
    for name, (radius, frames, long_frames) in SCENES.items():
        path = os.path.join(source, "configs", name + ".json")
        sets = [] if full else [f"simulation.particle_radius={radius}"]
        scene = json.loads(subprocess.check_output([lido, "check", path]))
        frames = long_frames if full else frames
        if name in EXACT:
            check_exact(lido, path, name)
        with tempfile.TemporaryDirectory() as folder:
            lines = simulate(lido, path, folder, frames, sets)
            check_container(name, folder, frames, scene["container"])
            check_motion(name, scene, folder, lines)
        if name in ("wave_pool", "ocean_waves", "pontoon"):
            check_paddles(lido, path, scene, frames, sets, lines)
        if name == "still_pool":
            check_still_pool(scene, lines)
        if full:
            check_threads(lido, path, name, radius)
        if full and name == "steps":
            assert 39000 <= lines[-1]["particles"] <= 40000, f"steps: {lines[-1]['particles']} particles after 4 s"
        if full and name in TWENTY_SECONDS:
            check_twenty_seconds(lido, path, name, scene)


if __name__ == "__main__":
    main()
