#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# package_test.sh BUILD: the Debian package of a build folder, installed in a clean root (debootstrap) and used there by a
# plain user: no other file of another package overwritten, no error of lintian, a case copied, run and evaluated.
# Opt-in: root, network, 2 GB and five minutes. ROOT_FOLDER names a clean root that is there already.
set -euo pipefail
build=$(cd "$1" && pwd)
root=${ROOT_FOLDER:-$(mktemp -d)}
inside() { chroot "$root" env PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }
end() {
  umount "$root/proc" 2>/dev/null || true
  [ -n "${ROOT_FOLDER:-}" ] || rm -rf "$root"
}
trap end EXIT

rm -f "$build"/vielto_*.deb
(cd "$build" && cpack -G DEB >/dev/null)
package=$(echo "$build"/vielto_*.deb)
lintian --allow-root --fail-on error "$package"
[ -e "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$root" >/dev/null
cp /etc/resolv.conf "$root/etc/"
cp -r /etc/apt/. "$root/etc/apt/"
mount -t proc proc "$root/proc"
cp "$package" "$root/tmp/vielto.deb"
inside apt-get update -qq
inside env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /tmp/vielto.deb >/dev/null
inside dpkg --verify vielto
inside useradd -m stranger
# shellcheck disable=SC2016
inside su stranger -c '
  set -e
  cd ~
  vielto --version
  vielto copy mixing
  cd mixing/cases/mixer
  small="-var grainDiameter 0.016 -var youngsModulus 2e5 -var wall_youngsModulus 2e5 -var maxOverlap 0.2 -var turns 3"
  liggghts-vielto -log none -in in.mixer -var fill 0.05 -var settleTime 0.2 $small >run.txt
  vielto post results/run
  # of a -var given twice LIGGGHTS takes the first
  short="-var fill 0.05 -var settleTime 0.05 -var turns 0.1"
  mpirun -np 2 liggghts-vielto -log none -in in.mixer $short $small -var run results/two >two.txt
  vielto gap predict --library millet --apparatus mixer --speed 1 --fill 0.15
  cd ~ && vielto fit mixing/libraries/millet/observations.csv --material hulled_millet --groups l,Fr_M >fit.txt'
inside apt-get purge -y -qq vielto >/dev/null
left=$(find "$root/usr/share/vielto" "$root/usr/lib/vielto" 2>/dev/null || true)
[ -z "$left" ] || { echo "left after purge: $left" >&2; exit 1; }
echo "package installed, used and removed in a clean root"
