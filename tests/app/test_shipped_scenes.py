#!/usr/bin/env python3
"""The shipped scenes through the real program: nothing leaves the tank, still water stays still.

Usage: test_shipped_scenes.py LIDO SOURCE_FOLDER [long]
The ordinary run uses coarser particles and fewer frames, `long` the scenes as they are.
"""
import array
import glob
import json
import os
import subprocess
import sys
import tempfile

MEAN_DENSITY_ERROR = 0.01  # of still_pool after 3 s
MAX_DENSITY_ERROR = 0.05
ENERGY_SHARE = 1e-4        # kinetic energy per mass, in g·H, after 5 s


def simulate(lido, scene, folder, frames, sets):
    stats = os.path.join(folder, "stats.jsonl")
    command = [lido, "simulate", scene, "--frames", str(frames), "-q", "--stats", stats, "-o", f"{folder}/p_%05d.ply"]
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
        for axis, values in enumerate(positions(path)):
            low, high = min(values), max(values)
            assert box["min"][axis] <= low and high <= box["max"][axis], f"{name}: {path}: axis {axis}: {low} … {high}"


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


def main():
    lido, source, full = sys.argv[1], sys.argv[2], sys.argv[3:] == ["long"]
    for name in ("dam_break", "double_dam_break", "still_pool"):
        path = os.path.join(source, "configs", name + ".json")
        sets = [] if full else ["simulation.particle_radius=" + ("0.025" if name == "still_pool" else "0.04")]
        scene = json.loads(subprocess.check_output([lido, "check", path]))
        frames = 301 if name == "still_pool" else 120 if full else 60
        with tempfile.TemporaryDirectory() as folder:
            lines = simulate(lido, path, folder, frames, sets)
            check_container(name, folder, frames, scene["container"])
            if name == "still_pool":
                check_still_pool(scene, lines)


if __name__ == "__main__":
    main()
