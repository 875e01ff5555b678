#!/bin/sh
# Compare the style "refraction" with the reference ray tracer: writes the table and the pictures of docs/refraction.md.
#   scripts/compare_refractions.sh [BUILD]     build folder, default build
set -eu
cd "$(dirname "$0")/.."
scripts/deps.sh test

build=${1:-build}
cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$build" -j "$(nproc 2>/dev/null || echo 2)" --target reference_compare >"$build/compare.log" 2>&1 ||
  { cat "$build/compare.log" >&2; exit 1; }
exec python3 tests/reference/compare_refractions.py "$build/tests/reference/reference_compare" --write docs/refraction.md
