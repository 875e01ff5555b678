#!/bin/sh
# Install what is missing, build with assertions alive and warnings as errors, and run the tests.
#   scripts/test.sh            the ordinary tests
#   scripts/test.sh long       and those labelled long
#   scripts/test.sh asan|tsan|scalar|debug [long]   the same in that build (see CMakePresets.json)
# Further arguments go on to ctest.
set -eu
cd "$(dirname "$0")/.."
scripts/deps.sh test

preset=test
case "${1:-}" in asan | tsan | scalar | debug) preset=$1; shift ;; esac
labels='-LE long'
if [ "${1:-}" = long ]; then
  labels=
  shift
fi
jobs=$(nproc 2>/dev/null || echo 2)
cmake --preset "$preset" >/dev/null
cmake --build "build-$preset" -j "$jobs" >"build-$preset/build.log" 2>&1 || { cat "build-$preset/build.log" >&2; exit 1; }
# shellcheck disable=SC2086
exec ctest --preset "$preset" $labels "$@"
