#!/usr/bin/env python3
"""Run the program on scenes that are wrong, and see that it says so.

Each case must end with exit code 2 and exactly one line on stderr, "lido: FILE…cause…", print nothing, and leave
nothing behind; with `lido check` and with `lido simulate`.

usage: run.py LIDO SOURCE_FOLDER
"""

import os
import pathlib
import subprocess
import sys
import tempfile

LIDO = os.path.abspath(sys.argv[1])
SOURCES = pathlib.Path(sys.argv[2]).resolve()
HERE = pathlib.Path(__file__).resolve().parent


def cases_of_file():
    """Cases of scenes.txt as (cause, bytes)."""
    cause, lines = None, []
    for line in (HERE / "scenes.txt").read_text(encoding="utf-8").splitlines(keepends=True):
        if line.startswith("== "):
            if cause is not None:
                yield cause, "".join(lines).encode()
            cause, lines = line[3:].rstrip("\n"), []
        else:
            lines.append(line)
    yield cause, "".join(lines).encode()


def made_cases():
    """Cases that are too large or too odd to be kept as text."""
    block = '{"min":[0,0,0],"max":[1,1,1]}'
    yield "the file is empty", b""
    yield "the file is empty", b"\xef\xbb\xbf"
    yield "the file is empty", b" \n\t\r\n"
    yield "a NUL byte where", b"\0" * 100
    yield "a NUL byte where", b'{"version": 1}\0{"version": 1}'
    yield "a NUL byte in a string", b'{"version": 1, "name": "a\0b"}'
    yield "a control character in a string", b'{"version": 1, "name": "a\x1bb"}'
    yield "not UTF-8", b'{"version": 1, "name": "caf\xe9"}'
    yield "not UTF-8", b'{"version": 1, "name": "\xc0\x80"}'
    yield "not UTF-8", b'{"version": 1, "name": "\xed\xa0\x80"}'
    yield "got byte 0xff", '{"version": 1}'.encode("utf-16")
    yield "got byte 0x89", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 10
    yield "got byte 0x7f", b"\x7fELF" + bytes(1000)
    yield "nested deeper than 64 levels", b'{"a":' * 100000
    yield "nested deeper than 64 levels", b"[" * 100000 + b"]" * 100000
    yield "nested deeper than 64 levels", b'{"version": 1, "fluid": ' + b"[" * 65 + b"]" * 65 + b"}"
    yield ":1: fluid.0: must be an object, got a list", b'{"version": 1, "fluid": ' + b"[" * 60 + b"]" * 60 + b"}"
    yield "larger than 16 MiB", b'{"version": 1, "name": "' + b"a" * (17 << 20) + b'"}'
    yield "more than 1000000 values", b'{"version": 1, "fluid": [' + b"0," * 1000001 + b"0]}"
    yield "a number with more than 60 characters", b'{"version": 1' + b"0" * 100 + b"}"
    yield "name: must have at most 127 bytes, got 128", b'{"version": 1, "name": "' + b"a" * 128 + b'"}'
    yield "fluid: must have at most 4096 items, got 5000", f'{{"version": 1, "fluid": [{",".join([block] * 5000)}]}}'.encode()
    yield "obstacles: must have at most 1024 items, got 2000", b'{"version": 1, "obstacles": [' + b",".join([b"{}"] * 2000) + b"]}"
    keys = ",".join('{"time":%d,"position":[0,0,0]}' % i for i in range(5000))
    body = '{"type":"box","size":[1,1,1],"position":[0,0,0],"motion":"scripted","keys":['
    yield "obstacles.0.keys: must have at most 4096 items, got 5000", f'{{"version": 1, "obstacles": [{body}{keys}]}}]}}'.encode()
    yield "sinks: must have at most 1024 items, got 2000", b'{"version": 1, "sinks": [' + b",".join([b"{}"] * 2000) + b"]}"
    yield "obstacles.0.file: must have at most 127 bytes", b'{"version": 1, "obstacles": [{"type": "mesh", "position": [0,0,0], "file": "' + b"a" * 200 + b'"}]}'
    yield "k0: unknown key", b'{"version": 1, ' + b",".join(b'"k%d": 0' % i for i in range(100000)) + b"}"
    yield ":1001: fluid: must be a list of objects, got 1", b'{"version": 1' + b"\n" * 1000 + b', "fluid": 1}'
    yield 'solver: must be one of pbf, sph, got "' + "x" * 40 + '..."', b'{"version": 1, "simulation": {"solver": "' + b"x" * 100000 + b'"}}'
    yield "a" * 40 + "...: unknown key", b'{"version": 1, "' + b"a" * 100000 + b'": 1}'
    text = (SOURCES / "configs" / "dam_break.json").read_bytes()
    end = text.rindex(b"}")
    for i in range(25):
        yield "not valid JSON: the text ends" if i else "the file is empty", text[: i * end // 25]


def run(arguments, folder):
    return subprocess.run([LIDO, *arguments], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=60)


def complaints(result, place, cause):
    """What is wrong with a refusal."""
    lines = result.stderr.decode("utf-8", "replace").splitlines()
    if result.returncode != 2:
        yield f"exit code {result.returncode}"
    if len(lines) != 1:
        yield f"{len(lines)} lines on stderr"
    if not lines or not lines[0].startswith("lido: " + place):
        yield f"does not begin with 'lido: {place}'"
    if not lines or cause not in lines[0]:
        yield f"does not name the cause '{cause}'"
    if result.stdout:
        yield "something was printed"


def check(label, arguments, place, cause, work, allowed):
    result = run(arguments, work)
    wrong = list(complaints(result, place, cause))
    left = sorted(p.name for p in work.iterdir() if p.name not in allowed)
    if left:
        wrong.append(f"left behind: {left}")
    if wrong:
        print(f"FAILED {label}: {'; '.join(wrong)}\n  lido {' '.join(arguments)}\n  {result.stderr.decode('utf-8', 'replace')[:2000]}")
    return not wrong


def check_both(label, name, place, cause, work, allowed):
    """Validating and simulating must refuse alike."""
    return check(label + " (check)", ["check", name], place, cause, work, allowed) & check(
        label + " (simulate)", ["simulate", name, "--frames", "1", "-o", "p_%05d.vtk"], place, cause, work, allowed
    )


def main():
    good, count = True, 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for number, (cause, content) in enumerate([*cases_of_file(), *made_cases()]):
            (work / "x.json").write_bytes(content)
            good &= check_both(f"case {number}", "x.json", "x.json", cause, work, {"x.json"})
            count += 1
        (work / "x.json").unlink()
        (work / "folder.json").mkdir()
        (work / "loop.json").symlink_to("loop.json")
        (work / "dangling.json").symlink_to("nowhere")
        odd = {"folder.json", "loop.json", "dangling.json"}
        for name, cause in [
            ("folder.json", "is a directory"),
            ("loop.json", "no such file"),
            ("dangling.json", "no such file"),
            ("nowhere/scene.json", "no such file"),
            ("no\nsuch\x1b[2Jscene.json", "no such file"),
            ("/dev/null", "the file is empty"),
            ("/dev/zero", "larger than 16 MiB"),
        ]:
            place = name.replace("\n", "?").replace("\x1b", "?")
            good &= check_both(f"file {place}", name, place, cause, work, odd)
            count += 1
        # A scene that is right gets through, or all of this shows nothing.
        result = run(["check", str(SOURCES / "configs" / "dam_break.json")], work)
        if result.returncode != 0 or result.stderr or not result.stdout:
            print(f"FAILED: the dam break is refused: {result.stderr}")
            good = False
    print(f"{count} cases, each checked and simulated")
    return 0 if good and count >= 40 else 1


if __name__ == "__main__":
    sys.exit(main())
