#!/bin/sh
# Make the pictures of docs/heightfield.md again.
#   scripts/heightfield_pictures.sh [FOLDER]          default docs
# shellcheck disable=SC2034
FOLDER=${1:-docs} STYLE=heightfield
# shellcheck disable=SC1091
. "$(dirname "$0")/pictures.sh"

set_key() {
  printf -- '--set render.heightfield.%s ' "$@"
}

# The scene ripple without the edges of its tank: they would cross what is to be seen.
ripple() {
  name=$1 frame=$2
  shift 2
  picture "$name" ripple "$frame" --set container.visible=false "$@"
}

ripple ripple 60 --size 1280x800 --camera 1.85,2.85,3.25,1.2,0.32,0.86
# shellcheck disable=SC2154
ffmpeg -loglevel error -y -i "$parts/ripple.png" -q:v 3 "$FOLDER/heightfield_ripple.jpg"

for frame in 80 92 104 116; do
  picture pool_$frame table_pool $frame --size 640x360 --camera 0.23,2.4,3.55,1.35,0.21,0.9
done
grid heightfield_table_pool.jpg 2 pool_80 pool_92 pool_104 pool_116

# Figures 2 and 3 of the paper: an eye for every ray, one for each object and its picture stretched, one. By direction there is
# a difference on waves only.
eyes_view='--size 640x400 --camera 0.6,1.25,1.9,1.08,0.44,0.72'
for eyes in each scaled one; do
  # shellcheck disable=SC2046,SC2086
  ripple eyes_$eyes 0 $eyes_view $(set_key eyes=$eyes) --set 'fluid.0.waves=[]'
done
# shellcheck disable=SC2046,SC2086
ripple eyes_direction 40 $eyes_view $(set_key access=direction)
grid heightfield_eyes.jpg 2 eyes_each eyes_scaled eyes_one eyes_direction

# Figure 9: none, simple, traced, both.
# shellcheck disable=SC2046,SC2086
{
  above='--size 640x400 --camera 0.9,2.3,2.0,1.15,0.3,0.8'
  ripple caustics_none 100 $above $(set_key traced_caustics=false)
  ripple caustics_simple 100 $above $(set_key traced_caustics=false simple_caustics=true)
  ripple caustics_traced 100 $above
  ripple caustics_both 100 $above $(set_key simple_caustics=true)
}
grid heightfield_caustics.jpg 2 caustics_none caustics_simple caustics_traced caustics_both

# A wave that breaks and jets, with one layer and with two.
# shellcheck disable=SC2046,SC2086
for layer in false true; do
  picture lip_$layer dam_break 85 --size 640x480 --camera 1.8,0.7,2.6,2.6,0.4,0.5 $(set_key second_layer=$layer)
  picture jets_$layer spouts 100 --size 640x480 $(set_key second_layer=$layer)
done
grid heightfield_layers.jpg 2 lip_false lip_true jets_false jets_true

# Figure 10: rays looked up by direction, with the surface pulled to the objects' planes and without; and by point.
# shellcheck disable=SC2046,SC2086
{
  near='--size 480x400 --camera 0.5,1.35,2.0,0.85,0.55,0.75'
  ripple line_pulled 40 $near $(set_key access=direction pull_reach=6)
  ripple line_free 40 $near $(set_key access=direction pull_reach=0)
  ripple line_point 40 $near
}
grid heightfield_waterline.jpg 3 line_pulled line_free line_point
