#!/bin/sh
# What the scripts that make the pictures of the documentation share. To be sourced, from any folder, with FOLDER and STYLE
# set: builds the program, and defines picture and grid.
set -eu
cd "$(dirname "$0")/.."
scripts/deps.sh
[ -f build/CMakeCache.txt ] || cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DLIDO_TESTS=OFF >/dev/null
cmake --build build -j "$(nproc 2>/dev/null || echo 2)" >build/build.log 2>&1 || { cat build/build.log >&2; exit 1; }
parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

# picture NAME SCENE FRAME [OPTION ...]
picture() {
  name=$1 scene=$2 frame=$3
  shift 3
  build/lido render "$scene" --quiet --style "$STYLE" --frames "$frame:$((frame + 1))" -o "$parts/part_%05d.png" "$@"
  mv "$parts"/part_*.png "$parts/$name.png"
}

# grid OUTPUT COLUMNS NAME ...: rows of pictures of one size
grid() {
  output=$1 columns=$2
  shift 2
  inputs='' layout='' i=0
  for name in "$@"; do
    inputs="$inputs -i $parts/$name.png"
    x=0 y=0 k=0
    while [ $k -lt $((i % columns)) ]; do x="$x+w0" k=$((k + 1)); done
    k=0
    while [ $k -lt $((i / columns)) ]; do y="$y+h0" k=$((k + 1)); done
    layout="$layout${layout:+|}${x}_$y"
    i=$((i + 1))
  done
  # shellcheck disable=SC2086
  ffmpeg -loglevel error -y $inputs -filter_complex "xstack=inputs=$i:layout=$layout" -q:v 3 "$FOLDER/$output"
}
