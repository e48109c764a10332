#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# try_install.sh FOLDER [OUT]: installs, uses, upgrades and purges the packages of FOLDER in a bare Debian 12.
#
# Prints seconds and megabytes from the bare root file system to a picture of the demonstration. Fails if `lumen` brings a
# compiler or headers or takes 150 MB, if a program or the examples in C and C++ do not work, or if a purge leaves a file.
# OUT receives the pictures. Needs root, mmdebstrap and the network of apt.
#   LUMEN_CHROOTS       folder that keeps the bare root file system as an archive (default ~/.cache/lumen/chroots)
#   LUMEN_APT_ARCHIVES  folder of packages that were fetched before, which are not fetched again
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[ $# -ge 1 ] || { sed -n '3,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
debs=$(cd "$1" && pwd)
pictures=${2:-}
readonly most_mb=150

chroots=${LUMEN_CHROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/lumen/chroots}
mkdir -p "$chroots"
bare=$chroots/bookworm-minbase.tar
[ -s "$bare" ] || { mmdebstrap --variant=minbase bookworm "${bare%.tar}.new.tar" && mv "${bare%.tar}.new.tar" "$bare"; }
work=$(mktemp -d)
root=$work/root
trap 'rm -rf --one-file-system "$work"' EXIT
mkdir -p "$root"
tar -x --numeric-owner -C "$root" -f "$bare"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
mkdir -p "$root/packages" "$root/examples"
cp "$debs"/*.deb "$root/packages"
cp "$here"/../examples/* "$root/examples"

inside() { unshare --mount --pid --fork sh -c "mount -t proc proc '$root/proc'; exec chroot '$root' sh -ec \"\$1\"" sh "$1"; }
apt() { inside "DEBIAN_FRONTEND=noninteractive apt-get -q -y -o APT::Keep-Downloaded-Packages=true -o Acquire::Retries=5 $*" >>"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log" >&2; exit 1; }; }
installed() { chroot "$root" dpkg-query -W -f='${Package} ${Version}\n' | sort; }
kilobytes() { chroot "$root" dpkg-query -W -f='${Installed-Size}\n' | awk '{s += $1} END {print s}'; }
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./packages -o -path ./examples -o -path ./var/lib/apt -o -path ./var/cache \
  -o -path ./var/log -o -path ./var/lib/dpkg -o -path ./tmp -o -path ./var/tmp \) -prune -o -print | LC_ALL=C sort); }
seconds() { date +%s.%N; }
since() { awk -v a="$1" -v b="$(seconds)" 'BEGIN {printf "%.1f", b - a}'; }

echo "== A bare Debian 12: $(($(kilobytes) / 1024)) MB in $(installed | wc -l) packages"
installed >"$work/before"
files >"$work/files_before"
before=$(kilobytes)
started=$(seconds)
apt update
if [ -n "${LUMEN_APT_ARCHIVES:-}" ]; then
  mkdir -p "$root/var/cache/apt/archives"
  cp "$LUMEN_APT_ARCHIVES"/*.deb "$root/var/cache/apt/archives/"
fi
version=$(dpkg-deb -f "$debs"/lumen_*.deb Version)
begin=$(seconds)
apt install --no-install-recommends ./packages/lumen_"$version"_*.deb
echo "== lumen: $(since "$begin") s, $((($(kilobytes) - before) / 1024)) MB with $(installed | comm -13 "$work/before" - | wc -l) packages"
grep -hE "^(Need to get|After this)" "$work/apt.log" | tail -2
[ $((($(kilobytes) - before) / 1024)) -lt $most_mb ] || { echo "more than $most_mb MB"; exit 1; }
if installed | comm -13 "$work/before" - | grep -E '^(gcc|g\+\+|cpp|clang|binutils|[a-z0-9.+]*-dev) '; then
  echo "lumen brings a compiler or headers" >&2
  exit 1
fi

echo "== The demonstration, as nobody"
begin=$(seconds)
inside 'mkdir -p /tmp/demo && chown nobody /tmp/demo && cd /tmp/demo && exec setpriv --reuid=nobody --regid=nogroup --clear-groups sh -ec "
  export HOME=/tmp/demo
  lumen --version
  lumen phantom patient angiogram.nrrd --truth truth.lumen --seeds seeds.json --quiet
  lumen convert angiogram.nrrd vessels.lumen --seeds seeds.json --quiet
  lumen picture vessels.lumen vessels.png --volume angiogram.nrrd --view anterior --quiet
  lumen validate vessels.lumen --quiet"'
echo "== Picture after $(since "$begin") s; from the bare system on $(since "$started") s"

echo "== All packages, and programs in C and C++"
apt install --no-install-recommends ./packages/*.deb g++ cmake make pkgconf
inside 'cd /tmp/demo && cc /examples/make_case.c -o make_case $(pkg-config --cflags --libs lumen-case) && ./make_case made.lumen
  printf "%s\n" "cmake_minimum_required(VERSION 3.16)" "project(x CXX)" "find_package(lumen 0.2 REQUIRED COMPONENTS blob case)" \
    "add_executable(x /examples/widest_places.cpp)" "target_link_libraries(x PRIVATE lumen::case lumen::blob)" \
    "target_compile_features(x PRIVATE cxx_std_17)" >CMakeLists.txt
  cmake -B build . >cmake.log && cmake --build build >>cmake.log && ./build/x vessels.lumen wide.lumen | tail -3'
if [ -d "$root/usr/lib/python3/dist-packages/lumen" ]; then
  inside 'cd /tmp/demo && python3 -c "
import lumen
case = lumen.read(\"vessels.lumen\")
vessel = lumen.blob.Model(case)
centres = case.tree.centre.astype(float)
inside = vessel.query(centres, vessel.cursor(centres)).inside
print(f\"{len(case.tree.branches)} branches in Python, {inside.mean():.0%} of the axes inside of the wall\")
assert inside.mean() > 0.99"'
fi
if [ -e "$root/usr/share/lumen/viewer/page.js" ]; then
  inside 'cd /tmp/demo && lumen view angiogram.nrrd vessels.lumen --html page.html --quiet && ls -l page.html'
fi

echo "== Upgrade"
mkdir "$work/next"
for deb in "$debs"/*.deb; do
  rm -rf "$work/taken"
  dpkg-deb -R "$deb" "$work/taken"
  sed -i "s/$version/$version+next/g" "$work/taken/DEBIAN/control"
  dpkg-deb -Znone --root-owner-group -b "$work/taken" "$work/next" >>"$work/apt.log"
done
mkdir "$root/packages/next"
cp "$work/next"/*.deb "$root/packages/next"
apt install ./packages/next/*.deb
for package in $(for d in "$debs"/*.deb; do dpkg-deb -f "$d" Package; done); do
  chroot "$root" dpkg-query -W -f='${Package} ${Version} ${db:Status-Abbrev}\n' "$package" | grep -q "+next ii" || { echo "$package is not upgraded"; exit 1; }
done
inside 'lumen --version && lumen validate /tmp/demo/vessels.lumen --quiet'

echo "== Purge"
[ -z "$pictures" ] || { mkdir -p "$pictures" && cp "$root"/tmp/demo/*.png "$pictures"; }
apt purge $(installed | cut -d' ' -f1 | comm -13 <(cut -d' ' -f1 "$work/before") -)
installed | diff "$work/before" - || { echo "packages are left"; exit 1; }
files >"$work/files_after"
left=$(LC_ALL=C comm -13 "$work/files_before" "$work/files_after" | grep -i lumen || true)
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo "nothing of lumen is left; other new files: $(LC_ALL=C comm -13 "$work/files_before" "$work/files_after" | wc -l)"
