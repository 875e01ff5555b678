"""Every OpenGL function that the compiled renderer asks libepoxy for is in the generated list that OSMesa needs.

usage: check_gl_functions.py NM LIST OBJECT_OR_LIBRARY...
"""
import re
import subprocess
import sys


def main():
    nm, listed_path, *objects = sys.argv[1:]
    with open(listed_path, encoding="utf-8") as file:
        listed = set(re.findall(r"GL_FUNCTION\((\w+)\)", file.read()))
    symbols = subprocess.run([nm, *objects], capture_output=True, text=True, check=True).stdout
    used = set(re.findall(r"\bU epoxy_(gl[A-Z]\w*)", symbols))
    if not used:
        sys.exit("the renderer asks for no OpenGL function at all: is this the right library?")
    missing = sorted(used - listed)
    if missing:
        sys.exit("not in the list for OSMesa: " + ", ".join(missing))
    print(f"{len(used)} OpenGL functions, all listed")


if __name__ == "__main__":
    main()
