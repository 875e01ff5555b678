#!/bin/sh
# Make docs/styles.jpg again: one frame in the four published styles.
#   scripts/style_pictures.sh [FOLDER]          default docs
# shellcheck disable=SC2034
FOLDER=${1:-docs} STYLE=refraction,cartoon,heightfield,raycast
# shellcheck disable=SC1091
. "$(dirname "$0")/pictures.sh"

picture styles table_pool 90 --size 960x540
ffmpeg -loglevel error -y -i "$parts/styles.png" -q:v 3 "$FOLDER/styles.jpg"
