#!/bin/sh
# Install what is missing, build, and run Lido. With a display: the dam break in a window. Without one: a short film
# of it in out/. Arguments go on to lido: scripts/run.sh configs/still_pool.json, scripts/run.sh list …
set -eu
cd "$(dirname "$0")/.."
scripts/deps.sh

# Build only when asked to configure for the first time or when a source changed: make sees to that.
[ -f build/CMakeCache.txt ] || cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DLIDO_TESTS=OFF >/dev/null
cmake --build build -j "$(nproc 2>/dev/null || echo 2)" >build/build.log 2>&1 || { cat build/build.log >&2; exit 1; }

case "${1:-}" in
  render | simulate | check | bench | list | --help | -h | --version) exec build/lido "$@" ;;
esac
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec build/lido "$@"
fi

# No display: a film. A scene among the arguments replaces the dam break.
scene=configs/dam_break.json
for argument in "$@"; do
  case "$argument" in *.json) scene= ;; esac
done
mkdir -p out
echo "lido: no display: rendering a short film to out/" >&2
build/lido render ${scene:+"$scene"} --fps 30 --frames 120 -o 'out/frame_%05d.png' "$@"
if command -v ffmpeg >/dev/null 2>&1; then
  ffmpeg -loglevel error -y -framerate 30 -i out/frame_%05d.png -pix_fmt yuv420p -movflags +faststart out/.film.part.mp4
  mv out/.film.part.mp4 out/film.mp4
  echo "lido: the film is out/film.mp4, its pictures are out/frame_*.png" >&2
else
  echo "lido: the pictures are out/frame_*.png (with ffmpeg installed there is a film, too)" >&2
fi
