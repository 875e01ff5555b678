#!/bin/sh
# Make docs/styles.jpg again: one frame in the four published styles.
#   scripts/style_pictures.sh [FOLDER]          default docs
# shellcheck disable=SC2034
FOLDER=${1:-docs} STYLE=refraction,cartoon,heightfield,raycast
# shellcheck disable=SC1091
. "$(dirname "$0")/pictures.sh"

picture styles table_pool 100 --size 960x540 --camera 0.23,2.4,3.55,1.35,0.21,0.9
# shellcheck disable=SC2154
ffmpeg -loglevel error -y -i "$parts/styles.png" -q:v 3 "$FOLDER/styles.jpg"
