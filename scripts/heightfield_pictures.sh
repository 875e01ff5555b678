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

picture ripple ripple 100 --size 1280x800
# shellcheck disable=SC2154
ffmpeg -loglevel error -y -i "$parts/ripple.png" -q:v 3 "$FOLDER/heightfield_ripple.jpg"

for frame in 80 90 100 110; do picture pool_$frame table_pool $frame --size 640x400; done
grid heightfield_table_pool.jpg 2 pool_80 pool_90 pool_100 pool_110

# Figures 2 and 3 of the paper: an eye for every ray, one for each object and its picture stretched, one.
near='--size 480x400 --camera 0.9,1.6,2.6,1.05,0.45,0.8'
for eyes in each scaled one; do
  # shellcheck disable=SC2046,SC2086
  picture eyes_$eyes ripple 0 $near $(set_key eyes=$eyes) --set 'fluid.0.waves=[]'
done
grid heightfield_eyes.jpg 3 eyes_each eyes_scaled eyes_one

# Figure 9: none, simple, traced, both.
# shellcheck disable=SC2046
{
  picture caustics_none ripple 100 --size 640x400 $(set_key traced_caustics=false)
  picture caustics_simple ripple 100 --size 640x400 $(set_key traced_caustics=false simple_caustics=true)
  picture caustics_traced ripple 100 --size 640x400
  picture caustics_both ripple 100 --size 640x400 $(set_key simple_caustics=true)
}
grid heightfield_caustics.jpg 2 caustics_none caustics_simple caustics_traced caustics_both

# Figure 10: rays looked up by direction, with the surface pulled to the objects' planes and without; and by point.
# shellcheck disable=SC2046,SC2086
{
  near='--size 480x400 --camera 0.5,1.35,2.0,0.85,0.55,0.75'
  picture line_pulled ripple 40 $near $(set_key access=direction)
  picture line_free ripple 40 $near $(set_key access=direction pull_reach=0)
  picture line_point ripple 40 $near
}
grid heightfield_waterline.jpg 3 line_pulled line_free line_point
