#!/bin/sh
# Install a build to an empty folder and use it as a stranger would: the program from another folder, and both
# libraries through the CMake package and through pkg-config.
#   test_install.sh BUILD_FOLDER SOURCE_FOLDER C_COMPILER C_FLAGS
set -eu
build=$1 source=$2 compiler=$3 flags=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/usr" >/dev/null

# The program finds its scenes from any folder.
cd /
"$work/usr/bin/lido" check dam_break >/dev/null
"$work/usr/bin/lido" list | grep -q dam_break

# The CMake package.
cmake -S "$source/tests/install" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_C_COMPILER="$compiler" \
  -DCMAKE_C_FLAGS="$flags" >"$work/log" 2>&1 && cmake --build "$work/cmake" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/cmake/consumer"

# pkg-config.
pc=$(dirname "$(find "$work/usr" -name lido-sim.pc)")
# shellcheck disable=SC2046,SC2086
"$compiler" -std=c17 $flags "$source/tests/install/consumer.c" -o "$work/consumer" \
  $(PKG_CONFIG_PATH="$pc" PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 pkg-config --define-prefix --static --cflags --libs lido-render lido-sim)
LD_LIBRARY_PATH="$(dirname "$pc")" "$work/consumer"
