#!/bin/sh
# Make the pictures of docs/raycast.md again.
#   scripts/raycast_pictures.sh [FOLDER]          default docs
#   scripts/raycast_pictures.sh FOLDER normals    only Figure 3 of the paper: gradient, PCA, and both blended and filtered
set -eu
cd "$(dirname "$0")/.."
scripts/deps.sh
folder=${1:-docs} only=${2:-}
[ -f build/CMakeCache.txt ] || cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DLIDO_TESTS=OFF >/dev/null
cmake --build build -j "$(nproc 2>/dev/null || echo 2)" >build/build.log 2>&1 || { cat build/build.log >&2; exit 1; }
parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

# picture NAME SCENE FRAME [OPTION ...]
picture() {
  name=$1 scene=$2 frame=$3
  shift 3
  build/lido render "$scene" --quiet --style raycast --frames "$frame:$((frame + 1))" -o "$parts/part_%05d.png" "$@"
  mv "$parts"/part_*.png "$parts/$name.png"
}

# grid OUTPUT COLUMNS NAME ...: rows of pictures of one size
grid() {
  output=$1 columns=$2
  shift 2
  inputs= layout= i=0
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
  ffmpeg -loglevel error -y $inputs -filter_complex "xstack=inputs=$i:layout=$layout" -q:v 3 "$folder/$output"
}

for normals in gradient pca blend; do
  filter=0
  [ $normals = blend ] && filter=3
  picture $normals double_dam_break 38 --size 520x520 --camera 0.9,0.75,1.55,1.35,0.3,0.4 \
    --set render.material=metal --set render.raycast.normals=$normals --set render.raycast.filter_reach=$filter
done
grid raycast_normals.jpg 3 gradient pca blend
[ "$only" = normals ] && exit 0

for material in water milk juice oil cola ink metal gold copper; do
  picture $material splash 24 --size 480x400 --set render.material=$material
done
grid raycast_materials.jpg 3 water milk juice oil cola ink metal gold copper

for frame in 60 100 160 220; do picture spouts_$frame spouts $frame --size 640x480; done
grid raycast_spouts.jpg 2 spouts_60 spouts_100 spouts_160 spouts_220
for frame in 18 24 32 44; do picture splash_$frame splash $frame --size 640x480; done
grid raycast_splash.jpg 2 splash_18 splash_24 splash_32 splash_44
