#!/bin/sh
# Make the pictures of docs/cartoon.md again.
#   scripts/cartoon_pictures.sh [FOLDER]          default docs
# shellcheck disable=SC2034
FOLDER=${1:-docs} STYLE=cartoon
# shellcheck disable=SC1091
. "$(dirname "$0")/pictures.sh"

set_key() {
  printf -- '--set render.cartoon.%s ' "$@"
}

for palette in lagoon ink lava storm; do
  picture $palette double_dam_break 60 --size 960x540 --set render.cartoon.palette=$palette
done
grid cartoon_palettes.jpg 2 lagoon ink lava storm

# Figure 6 of the paper: neither, reflection, refraction; and both.
# shellcheck disable=SC2046
{
  picture neither pontoon 60 --size 640x400 $(set_key reflection=false refraction=false)
  picture reflection pontoon 60 --size 640x400 $(set_key refraction=false)
  picture refraction pontoon 60 --size 640x400 $(set_key reflection=false)
  picture both pontoon 60 --size 640x400
}
grid cartoon_optics.jpg 2 neither reflection refraction both

# Figure 5: kernels close up, full and separated; none, curvature flow, and the adaptive default. Without outlines, which
# would hide the tones.
near='--camera 0.5,0.9,1.5,1.5,0.2,0.3 --set render.cartoon.outline=0'
for kernel in 10 20 30; do
  # shellcheck disable=SC2046,SC2086
  {
    paper=$(set_key fitted=false half_resolution=false kernel=$kernel)
    picture near_$kernel dam_break 30 --size 480x320 $near $paper
    picture split_$kernel dam_break 30 --size 480x320 $near $paper $(set_key separated=true)
  }
done
# shellcheck disable=SC2046,SC2086
{
  picture near_none dam_break 30 --size 480x320 $near $(set_key smoothing=none)
  picture near_flow dam_break 30 --size 480x320 $near $(set_key smoothing=curvature_flow)
  picture near_adaptive dam_break 30 --size 480x320 $near
}
grid cartoon_smoothing.jpg 3 near_10 near_20 near_30 split_10 split_20 split_30 near_none near_flow near_adaptive

# Figure 7: drops apart, and in one with the body.
# shellcheck disable=SC2046
{
  picture apart splash 30 --size 640x400
  picture together splash 30 --size 640x400 $(set_key splashes_apart=false)
}
grid cartoon_drops.jpg 2 apart together

for frame in 60 120 180 240; do picture pool_$frame wave_pool $frame --size 640x400; done
grid cartoon_wave_pool.jpg 2 pool_60 pool_120 pool_180 pool_240
