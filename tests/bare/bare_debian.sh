#!/bin/sh
# What the README promises, on a bare Debian: make one with debootstrap, clone into it, run both commands twice.
#   bare_debian.sh SOURCE_FOLDER      needs root, debootstrap, git and Debian's mirrors; else it is skipped (exit 77)
set -eu
source=$1
[ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null 2>&1 && command -v git >/dev/null 2>&1 || exit 77
root=$(mktemp -d)
chmod 755 "$root" # apt fetches as a user of its own
finish() {
  for mount in tmp dev/pts dev proc; do umount -l "$root/$mount" 2>/dev/null || :; done
  rm -rf --one-file-system "$root"
}
trap finish EXIT
trap 'exit 1' INT TERM

debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 || { echo "no Debian mirror"; rm -f "$root.log"; exit 77; }
rm -f "$root.log"
mount -t proc proc "$root/proc" && mount --bind /dev "$root/dev" && mount -t tmpfs tmpfs "$root/tmp" || exit 77
cp /etc/resolv.conf "$root/etc/resolv.conf"
git clone -q "$source" "$root/srv/lido"

inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/srv LANG=C.UTF-8 chroot "$root" sh -c "cd /srv/lido && $1"
}
fail() {
  echo "bare Debian: $1"
  exit 1
}

inside 'scripts/run.sh' || fail 'scripts/run.sh failed'
[ "$(ls "$root/srv/lido/out" | grep -c '^frame_[0-9]*\.png$')" -eq 120 ] || fail 'scripts/run.sh left no 120 pictures'
[ -s "$root/srv/lido/out/film.mp4" ] || fail 'scripts/run.sh left no film'

# A second run installs and builds nothing.
touch "$root/srv/marker"
inside 'scripts/run.sh list' >/dev/null || fail 'the second run failed'
[ -z "$(find "$root/srv/lido/build" -newer "$root/srv/marker" \( -name '*.o' -o -name '*.a' -o -name lido \) -print)" ] ||
  fail 'the second run built something'

inside 'scripts/test.sh' || fail 'scripts/test.sh failed'
echo "bare Debian: both commands work"
