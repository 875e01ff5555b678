#!/usr/bin/env python3
"""The JSON schema agrees with the parser: shipped scenes and what `lido check` prints are valid; what the parser
refuses for its type, range or key, the schema refuses too.

usage: test_schema.py LIDO SOURCE_FOLDER
"""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

LIDO, SOURCES = sys.argv[1], pathlib.Path(sys.argv[2])

FULL = {
    "version": 1,
    "name": "everything",
    "simulation": {"solver": "pbf", "particle_radius": 0.02, "gravity": [0, -9.81, 0], "iterations": 5, "seed": 3,
                   "kinematic_viscosity": 0.1, "surface_tension": 1, "vorticity": 0.5, "max_particles": 100000,
                   "reuse": True, "colour_diffusion": 0.1},
    "container": {"shape": "box", "min": [0, 0, 0], "max": [2, 1, 1], "friction": 0.5, "visible": False},
    "fluid": [
        {"type": "block", "min": [0, 0, 0], "max": [1, 1, 1], "velocity": [1, 0, 0], "colour": [0, 0, 1]},
        {"type": "drop", "centre": [1.5, 0.5, 0.5], "radius": 0.1},
        {"type": "emitter", "name": "tap", "diameter": 0.1, "position": [1, 0.5, 0.5], "direction": [1, 0, 0]},
        {"type": "emitter", "shape": "rectangle", "size": [0.1, 0.2], "position": [1, 0.5, 0.5], "direction": [1, 0, 0],
         "up": [0, 0, 1], "speed": 2, "start": 1, "stop": None, "obstacle": "ball"},
    ],
    "sinks": [{"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}],
    "obstacles": [
        {"type": "box", "size": [0.1, 0.1, 0.1], "position": [1.5, 0, 0], "rotation": [0, 45, 0]},
        {"type": "sphere", "radius": 0.1, "position": [1.5, 0.5, 0.5]},
        {"type": "cylinder", "radius": 0.1, "height": 1, "position": [1.8, 0.5, 0.5], "motion": "static"},
        {"type": "capsule", "name": "ball", "radius": 0.1, "height": 1, "position": [1.8, 0.5, 0.5], "motion": "draggable"},
        {"type": "stairs", "size": [1, 1, 1], "steps": 4, "position": [1.8, 0.5, 0.5], "motion": "scripted",
         "keys": [{"time": 1, "position": [0, 0, 0], "rotation": [0, 0, 0]}, {"time": 2, "position": [1, 0, 0]}]},
    ],
    "camera": {"eye": [0, 1, 3], "target": None, "fov": 50},
    "light": {"direction": [0, 1, 0], "sun": True},
    "environment": {"sky": "gradient", "floor": "checker", "floor_level": None},
    "render": {"style": "points", "tone_map": "none", "points": {"scale": 1}},
    "events": [
        {"type": "push", "origin": [0, 0, 0], "direction": [1, 0, 0], "acceleration": [5, 0, 0], "duration": 1},
        {"type": "pour", "time": 1, "min": [0, 0, 0], "max": [0.2, 0.2, 0.2]},
        {"type": "tilt", "time": 1, "gravity": [1, -9, 0]},
        {"type": "style", "time": 2, "name": "points"},
        {"type": "camera", "time": 3, "eye": [1, 1, 1], "target": [0, 0, 0], "fov": 40},
        {"type": "drag", "time": 4, "obstacle": "ball", "position": [1, 1, 1], "rotation": None},
        {"type": "emitter", "time": 5, "emitter": 2, "on": False},
    ],
}

# The one kind of water that stands alone.
RIPPLE = {
    "version": 1,
    "fluid": [{"type": "ripple", "level": 0.5,
               "waves": [{"amplitude": 0.01, "wavelength": 1, "direction": [1, 0, 1], "phase": 30, "standing": True}]}],
}

# Key path and a value that neither parser nor schema takes; DELETE takes a required key away.
DELETE = object()
WRONG = [
    ("version", 2), ("version", "1"), ("version", DELETE), ("nmae", 1), ("name", 5), ("simulation", []),
    ("simulation.particle_radius", 0), ("simulation.particle_radius", "x"), ("simulation.iterations", 2.5),
    ("simulation.iterations", 101), ("simulation.gravity", [0, 0]), ("simulation.gravity", [0, 0, "x"]),
    ("simulation.solver", "sphh"), ("simulation.vorticity", 2), ("simulation.max_particles", -1),
    ("simulation.reuse", 0), ("container.shape", "cup"), ("container.friction", 2), ("container.visible", 1), ("container.min", None),
    ("fluid", {}), ("fluid.0.type", "drop"), ("fluid.1.radius", 0), ("fluid.2.diameter", 0),
    ("fluid.2.direction", DELETE), ("fluid.3.size", [1, 1, 1]), ("fluid.3.size.0", 0), ("fluid.3.obstacle", -1),
    ("fluid.3.obstacle", ""), ("fluid.3.stop", -1), ("fluid.3.speed", 0), ("sinks.0.max", DELETE),
    ("fluid.0.min", DELETE), ("fluid.0.colour", [2, 0, 0]),
    ("obstacles.0.type", DELETE), ("obstacles.0.radius", 1), ("obstacles.1.radius", 0), ("obstacles.2.height", DELETE),
    ("obstacles.2.motion", "flying"), ("obstacles.3.name", 3), ("obstacles.4.steps", 0), ("obstacles.4.keys", {}),
    ("obstacles.4.keys.1.time", DELETE), ("obstacles.4.density", 0), ("camera.fov", 1), ("camera.fov", None), ("camera.eye", [1, 2]),
    ("environment.sky", "blue"), ("environment.floor_level", "x"), ("render.style", "blue"),
    ("render.points.scale", 6), ("render.points.size", 1), ("events.0.time", -1), ("events.0.gravity", [0, 0, 0]),
    ("events.1.max", DELETE), ("events.3.name", "blue"), ("events.4.type", "drag"),
    ("events.5.obstacle", None), ("events.5.position", DELETE), ("events.6.on", DELETE), ("events.6.emitter", 1.5),
]  # fmt: skip
WRONG_RIPPLES = [
    ("fluid.0.level", DELETE), ("fluid.0.level", "x"), ("fluid.0.min", [0, 0, 0]), ("fluid.0.waves", {}),
    ("fluid.0.waves.0.amplitude", -1), ("fluid.0.waves.0.wavelength", 0), ("fluid.0.waves.0.wavelength", DELETE),
    ("fluid.0.waves.0.direction", [1, 0]), ("fluid.0.waves.0.phase", 400), ("fluid.0.waves.0.standing", 1),
    ("fluid.0.waves.0.speed", 1),
]


def changed(full, path, value):
    scene = copy.deepcopy(full)
    *parents, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    here = scene
    for key in parents:
        here = here[key]
    if value is DELETE:
        del here[last]
    else:
        here[last] = value
    return scene


def check(scene):
    """What lido check says to a scene."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(scene, file)
        file.flush()
        return subprocess.run([LIDO, "check", file.name], capture_output=True, timeout=60)


def main():
    schema = json.loads((SOURCES / "configs" / "scene.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    failures = []
    scenes = {p.name: json.loads(p.read_text(encoding="utf-8")) for p in sorted((SOURCES / "configs").glob("*.json"))}
    del scenes["scene.schema.json"]
    for name, scene in {**scenes, "everything": FULL, "a ripple": RIPPLE}.items():
        printed = check(scene)
        if printed.returncode != 0:
            failures.append(f"{name}: {printed.stderr.decode()}")
            continue
        for what, text in ((name, scene), (name + " as printed", json.loads(printed.stdout))):
            failures += [f"{what}: {e.json_path}: {e.message[:200]}" for e in validator.iter_errors(text)]
    mistakes = [(FULL, *mistake) for mistake in WRONG] + [(RIPPLE, *mistake) for mistake in WRONG_RIPPLES]
    for full, path, value in mistakes:
        scene = changed(full, path, value)
        if validator.is_valid(scene):
            failures.append(f"the schema takes {path} = {value}")
        if check(scene).returncode != 2:
            failures.append(f"the parser takes {path} = {value}")
    print("\n".join(failures) or f"{len(scenes)} scenes and {len(mistakes)} mistakes: schema and parser agree")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
