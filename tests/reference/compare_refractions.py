"""The style "refraction" with one, two and four refractions against the reference ray tracer, on the frames that the
paper's figures show.

compare_refractions.py PROGRAM                      check that each step brings the picture nearer to the reference
compare_refractions.py PROGRAM --write DOCUMENT     replace the table between the marks of DOCUMENT, and its pictures

PROGRAM is reference_compare. Runs in the source folder; the pictures need ffmpeg.
"""
import os
import re
import subprocess
import sys
import tempfile

FRAMES = {"steps_1": "steps", "steps_2": "steps", "wave_1": "wave"}
ROWS = ["refraction_1", "refraction_2", "refraction_4", "chain_1", "chain_2", "chain_4"]
SETTING = "environment.tile_size=0.5"
BEGIN, END = "<!-- table: scripts/compare_refractions.sh -->", "<!-- end of table -->"
PICTURES = ["refraction_1", "refraction_2", "refraction_4", "reference"]


def compare(program, frame, folder):
    """Rows of the table: name -> (mean, median, 95th percentile), in 1/255."""
    command = [program, f"configs/{FRAMES[frame]}.json", f"tests/reference/frames/{frame}.ply", folder,
               "--size", "640x480", "--set", SETTING]
    for refractions in (1, 2, 4):
        command += ["--style", f"refraction:{refractions}"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = {m[1]: tuple(float(m[k]) for k in (2, 3, 4))
            for m in re.finditer(r"^(\w+) +([\d.]+) +([\d.]+) +([\d.]+)$", text, re.M)}
    missing = [row for row in ROWS if row not in rows]
    if missing:
        sys.exit(f"{frame}: no row {missing[0]} in\n{text}")
    return rows


def tell(frame, rows):
    print(f"{frame}: " + ", ".join(f"{row} {rows[row][0]:.2f}" for row in ROWS))


def check(program):
    worse = []
    for frame in FRAMES:
        with tempfile.TemporaryDirectory() as folder:
            rows = compare(program, frame, folder)
        tell(frame, rows)
        for model in ("refraction", "chain"):
            one, two, four = (rows[f"{model}_{n}"][0] for n in (1, 2, 4))
            if not one > two > four:
                worse.append(f"{frame}: mean errors of {model}, which must fall: {one:.2f}, {two:.2f}, {four:.2f}")
    if worse:
        sys.exit("\n".join(worse))


def table(results):
    lines = ["| mean error, 1/255 | " + " | ".join(FRAMES) + " |", "|---|" + "---|" * len(FRAMES)]
    for row in ROWS:
        model, refractions = row.split("_")
        what = "the style" if model == "refraction" else "its model on the reference's surfaces"
        name = {"1": "one refraction", "2": "two refractions", "4": "four refractions"}[refractions]
        lines.append(f"| {what}, {name} | " + " | ".join(f"{results[f][row][0]:.1f}" for f in FRAMES) + " |")
    return "\n".join(lines)


def side_by_side(folder, path):
    """Two by two: one and two refractions above, four and the reference below."""
    command = ["ffmpeg", "-y", "-loglevel", "error"]
    for picture in PICTURES:
        command += ["-i", os.path.join(folder, picture + ".png")]
    stack = "[0][1]hstack[above];[2][3]hstack[below];[above][below]vstack"
    subprocess.run(command + ["-filter_complex", stack, "-q:v", "4", "-frames:v", "1", path], check=True)


def write(program, document):
    results = {}
    for frame in FRAMES:
        with tempfile.TemporaryDirectory() as folder:
            results[frame] = compare(program, frame, folder)
            side_by_side(folder, os.path.join(os.path.dirname(document), f"refraction_{frame}.jpg"))
        tell(frame, results[frame])
    with open(document, encoding="utf-8") as file:
        text = file.read()
    if BEGIN not in text or END not in text:
        sys.exit(f"{document}: no marks for the table")
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    with open(document + ".new", "w", encoding="utf-8") as file:
        file.write(f"{before}{BEGIN}\n{table(results)}\n{END}{after}")
    os.replace(document + ".new", document)


if len(sys.argv) == 2:
    check(sys.argv[1])
elif len(sys.argv) == 4 and sys.argv[2] == "--write":
    write(sys.argv[1], sys.argv[3])
else:
    sys.exit(__doc__)
