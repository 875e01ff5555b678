#!/usr/bin/env python3
"""Particle files in an independent reader: meshio must find the positions and fields that we wrote.

What meshio reads is compared with the bytes of the VTK file at the places where the format puts them, taken
out here with numpy, and the PLY file with the VTK file. Exit code 77: meshio is not installed.
Usage: test_meshio.py LIDO
"""
import os
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy as np
except ImportError:
    print("meshio is not installed")
    sys.exit(77)

SCENE = """{"version": 1, "simulation": {"particle_radius": 0.02},
 "container": {"min": [0, 0, 0], "max": [0.6, 0.4, 0.4]},
 "fluid": [{"type": "block", "min": [0, 0, 0], "max": [0.24, 0.24, 0.4]},
           {"type": "block", "min": [0.4, 0, 0], "max": [0.6, 0.12, 0.4], "colour": [0.9, 0.1, 0.1]}]}"""


def raw_vtk(path):
    """Positions and fields by our own hand."""
    data = open(path, "rb").read()

    def block(after, dtype, count):
        start = data.index(after) + len(after)
        return np.frombuffer(data, dtype, count, start)

    header = data[: data.index(b" float\n")]
    n = int(header.split()[-1])
    fields = {"POINTS": block(b"POINTS %d float\n" % n, ">f4", 3 * n).reshape(-1, 3)}
    fields["cells"] = block(b"CELLS %d %d\n" % (n, 2 * n), ">i4", 2 * n).reshape(-1, 2)
    fields["id"] = block(b"id 1 %d unsigned_int\n" % n, ">u4", n)
    for name, size in ((b"velocity", 3), (b"density", 1), (b"colour", 3)):
        values = block(b"%s %d %d float\n" % (name, size, n), ">f4", size * n)
        fields[name.decode()] = values.reshape(-1, 3) if size == 3 else values
    return fields


def same(what, a, b):
    a, b = np.asarray(a), np.asarray(b)
    if a.shape != b.shape or not np.array_equal(a.astype("f8"), b.astype("f8")):
        sys.exit(f"{what} differs")


def main():
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.json")
        open(scene, "w").write(SCENE)
        for ending in ("vtk", "ply"):
            subprocess.run(
                [sys.argv[1], "simulate", scene, "--frames", "3", "-q", "-o", f"{folder}/p_%05d.{ending}"], check=True)
        for frame in (0, 2):
            path = f"{folder}/p_{frame:05d}"
            raw = raw_vtk(path + ".vtk")
            vtk = meshio.read(path + ".vtk")
            ply = meshio.read(path + ".ply")
            n = len(raw["POINTS"])
            assert n > 100
            same("VTK positions", vtk.points, raw["POINTS"])
            same("cells", raw["cells"], np.stack([np.ones(n), np.arange(n)], 1))
            assert [c.type for c in vtk.cells] == ["vertex"] and len(vtk.cells[0].data) == n
            for name in ("id", "velocity", "density", "colour"):
                same("VTK " + name, vtk.point_data[name], raw[name])
            same("PLY positions", ply.points, raw["POINTS"])
            for name, column in (("vx", 0), ("vy", 1), ("vz", 2)):
                same("PLY " + name, ply.point_data[name], raw["velocity"][:, column])
            for name, column in (("red", 0), ("green", 1), ("blue", 2)):
                same("PLY " + name, ply.point_data[name], raw["colour"][:, column])
            same("PLY id", ply.point_data["id"], raw["id"])
            same("PLY density", ply.point_data["density"], raw["density"])
            same("order", raw["id"], np.sort(raw["id"]))
            assert abs(raw["density"].mean() - 1000) < 300
    print("meshio agrees")


main()
