#!/bin/sh
# Install what is missing to build and run Lido (Debian, Ubuntu). Elsewhere: name what is missing.
#   scripts/deps.sh         to build and run
#   scripts/deps.sh test    and to run the tests
set -eu

build='gcc libc6-dev make cmake pkg-config
  libglfw3-dev libepoxy-dev libegl-dev libgl-dev libcjson-dev libcglm-dev libspng-dev libode-dev
  libassimp-dev
  libgl1-mesa-dri libegl1 libegl-mesa0 libgl1 ffmpeg'
optional='libosmesa6-dev' # left Mesa in 25.1
test='libcmocka-dev libembree-dev clang libomp-dev git xvfb xauth xdotool python3 python3-meshio python3-jsonschema'

want="$build"
if [ "${1:-}" = test ]; then
  want="$want $test"
fi

if ! command -v apt-get >/dev/null 2>&1; then
  missing=
  for tool in cc make cmake pkg-config; do
    command -v "$tool" >/dev/null 2>&1 || missing="$missing $tool"
  done
  if command -v pkg-config >/dev/null 2>&1; then
    for module in glfw3 epoxy egl libcjson cglm spng ode assimp; do
      pkg-config --exists "$module" || missing="$missing $module"
    done
    if [ "${1:-}" = test ]; then
      pkg-config --exists cmocka || missing="$missing cmocka"
    fi
  fi
  [ -z "$missing" ] && exit 0
  echo "lido: please install the development packages of:$missing" >&2
  echo "lido: (optional: OSMesa, ffmpeg; for the tests: Xvfb, xdotool, python3 with meshio and jsonschema)" >&2
  exit 1
fi

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}
missing=
for package in $want; do
  is_installed "$package" || missing="$missing $package"
done
for package in $optional; do
  is_installed "$package" || missing_optional="${missing_optional:-} $package"
done
[ -z "$missing${missing_optional:-}" ] && exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  if command -v sudo >/dev/null 2>&1; then
    as_root=sudo
  elif [ -z "$missing" ]; then
    exit 0
  else
    echo "lido: please install, as root: apt-get install$missing" >&2
    exit 1
  fi
fi
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq
for package in ${missing_optional:-}; do
  apt-cache show "$package" >/dev/null 2>&1 && missing="$missing $package"
done
[ -z "$missing" ] && exit 0
echo "lido: installing$missing" >&2
# shellcheck disable=SC2086
$as_root apt-get install -qq -y --no-install-recommends $missing >/dev/null
