#!/usr/bin/env python3
"""Keeps the positions of a binary PLY file that `lido simulate` wrote, and its comment with radius, time and container.

Usage: keep_positions.py IN.ply OUT.ply
"""
import struct
import sys

source, target = sys.argv[1:]
header, body = open(source, "rb").read().split(b"end_header\n", 1)
lines = header.decode().splitlines()
properties = [line.split()[1:] for line in lines if line.startswith("property")]
count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
if "format binary_little_endian 1.0" not in lines or [["float", axis] for axis in "xyz"] != properties[:3]:
    sys.exit(f"{source}: not a little-endian PLY file that begins with x, y, z")
if any(kind not in ("float", "uint", "int") for kind, _ in properties) or len(body) != 4 * count * len(properties):
    sys.exit(f"{source}: its vertices are not {count} rows of 32-bit values")
kept = [line for line in lines if not line.startswith("property") or line.split()[2] in ("x", "y", "z")]
with open(target, "wb") as out:
    out.write(("\n".join(kept) + "\nend_header\n").encode())
    for (position,) in struct.iter_unpack(f"12s{4 * len(properties) - 12}x", body):
        out.write(position)
