#!/usr/bin/env python3
"""Check who includes whom (docs/design.md, "Layers").

    app    -> sim/sim.h, sim/frame.h, render/render.h, and its own headers
    render -> sim/frame.h, and its own headers
    sim    -> its own headers, libm, OpenMP, ODE and POSIX threads in rigid
    cJSON, GLFW, EGL, OSMesa, spng, Assimp: app only; libepoxy: render and app/context_*

Usage: check_layers.py ROOT    exits 1 and prints each breach as file:line: reason.
       check_layers.py --self-test    feeds it breaches and checks that each is found.
"""
import pathlib
import re
import sys
import tempfile

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
PRAGMA_OMP = re.compile(r'^\s*#\s*pragma\s+omp\b')

C_STANDARD = {
    "assert.h", "complex.h", "ctype.h", "errno.h", "float.h", "inttypes.h", "limits.h", "math.h", "stdalign.h",
    "stdarg.h", "stdatomic.h", "stdbool.h", "stddef.h", "stdint.h", "stdio.h", "stdlib.h", "string.h", "time.h",
}
# What each layer may include besides the C standard library and its own headers.
LAYERS = {
    "sim": {"own": ("sim/",), "project": (), "system": (r"omp\.h", r"[ei]mmintrin\.h", r"ode/.*", r"pthread\.h")},
    "render": {"own": ("render/",), "project": ("sim/frame.h",), "system": (r"epoxy/gl\.h", r"cglm/.*")},
    "app": {"own": ("app/",), "project": ("sim/sim.h", "sim/frame.h", "render/render.h"),
            "system": (r"cjson/.*", r"GLFW/.*", r"EGL/.*", r"GL/osmesa\.h", r"spng\.h", r"assimp/.*", r"sys/.*", r"unistd\.h",
                       r"fcntl\.h", r"signal\.h", r"spawn\.h", r"pthread\.h", r"getopt\.h", r"dirent\.h", r"poll\.h",
                       r"strings\.h", r"termios\.h", r"libgen\.h", r"dlfcn\.h", r"mach-o/.*")},
}
ONLY_IN = [  # (system header, files that may include it)
    (r"epoxy/.*", r"render/|app/context_"),
    (r"EGL/.*", r"app/context_"),
    (r"GL/osmesa\.h", r"app/context_osmesa\."),
    (r"GLFW/.*", r"app/context_glfw\.|app/window\.|app/window_"),
    (r"cjson/.*", r"app/"),
    (r"assimp/.*", r"app/mesh_import\."),
    (r"omp\.h", r"sim/parallel\."),
    (r"[ei]mmintrin\.h", r"sim/wide/simd\.h"),
    (r"ode/.*", r"sim/rigid\."),
    (r"pthread\.h", r"app/|sim/rigid\."),
]
EXCEPT = {
    ("app/context_osmesa.c", "osmesa_functions.h"): "the list of OpenGL functions, made by the build",
    ("render/gpu_context.c", "fprintf(stderr"): "a debug build says which OpenGL error ends it",
}
FILE_CALLS = re.compile(r'\b(fopen|freopen|open|fprintf|printf|puts|getenv|system|popen)\s*\(')


def allowed(layer, relative, kind, name):
    """None when the include is fine, else the reason why not."""
    rules = LAYERS[layer]
    if kind == '"':
        if any(name.startswith(own) for own in rules["own"]) or name in rules["project"]:
            return None
        return f'{layer} may not include "{name}"'
    if name in C_STANDARD:
        return None
    if layer == "app" and re.fullmatch(r"epoxy/.*", name):
        rules = {"system": (r"epoxy/.*",)}
    if not any(re.fullmatch(pattern, name) for pattern in rules["system"]):
        return f"{layer} may not include <{name}>"
    for header, files in ONLY_IN:
        if re.fullmatch(header, name) and not re.match(files, relative):
            return f"<{name}> belongs to {files}"
    return None


def breaches(root):
    found = []
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*.[ch]")):
            relative = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                reason = allowed(layer, relative, *match.groups()) if match else None
                if PRAGMA_OMP.match(line) and not relative.startswith("sim/parallel."):
                    reason = "OpenMP has one door: sim/parallel"
                code = line.split("//")[0]
                if layer in ("sim", "render") and FILE_CALLS.search(code) and not code.lstrip().startswith("*"):
                    reason = f"{layer} neither prints nor opens files"
                if any(relative == file and part in code for file, part in EXCEPT):
                    reason = None
                if reason:
                    found.append(f"{relative}:{number}: {reason}")
    return found


def self_test():
    cases = {
        "sim/a.c": '#include "render/render.h"', "sim/b.c": "#include <cjson/cJSON.h>",
        "sim/c.c": "#pragma omp parallel for", "sim/d.c": '  FILE *f = fopen("x", "r");',
        "sim/e.c": "#include <omp.h>", "render/a.c": '#include "sim/sim.h"', "render/b.c": '#include "app/app.h"',
        "render/c.c": "#include <GLFW/glfw3.h>", "app/a.c": '#include "sim/world.h"',
        "app/b.c": '#include "render/style.h"', "app/c.c": "#include <epoxy/gl.h>", "app/d.c": "#include <EGL/egl.h>",
        "app/e.c": "#include <omp.h>", "sim/f.c": "#include <ode/ode.h>", "sim/g.c": "#include <pthread.h>",
    }
    fine = {
        "sim/ok.c": '#include "sim/sim.h"\n#include <math.h>', "sim/parallel.c": "#include <omp.h>",
        "sim/rigid.c": "#include <ode/ode.h>\n#include <pthread.h>",
        "render/ok.c": '#include "sim/frame.h"\n#include <epoxy/gl.h>', "app/ok.c": '#include "render/render.h"',
        "app/context_x.c": "#include <epoxy/gl.h>",
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in {**cases, **fine}.items():
            (root / name).parent.mkdir(exist_ok=True)
            (root / name).write_text(text + "\n")
        found = {line.split(":")[0] for line in breaches(root)}
    if found != set(cases):
        print("missed:", sorted(set(cases) - found), "wrongly found:", sorted(found - set(cases)))
        return 1
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    found = breaches(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "layers: nothing to report")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
