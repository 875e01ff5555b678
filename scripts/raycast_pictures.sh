#!/bin/sh
# Make the pictures of docs/raycast.md again.
#   scripts/raycast_pictures.sh [FOLDER]          default docs
#   scripts/raycast_pictures.sh FOLDER normals    only Figure 3 of the paper: gradient, PCA, and both blended and filtered
# shellcheck disable=SC2034
FOLDER=${1:-docs} STYLE=raycast only=${2:-}
# shellcheck disable=SC1091
. "$(dirname "$0")/pictures.sh"

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
