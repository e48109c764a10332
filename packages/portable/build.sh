#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT [--try]: OUT/lumen-VERSION-linux-x86_64.tar.xz, a folder that runs on any Linux of this processor.
#
# The program of OUT/lumen_*.deb (packages/debian/build.sh makes it) with all libraries that it loads, those of C and the
# loader included: nothing of the system is linked, so the version of the system's C library does not matter. bin/lumen is a
# script of /bin/sh that starts the loader. --try runs the folder in a bare Debian 11, whose C library is 2.31, and in a root
# file system that holds nothing but a static busybox. Needs root, mmdebstrap and the network of apt.
#   LUMEN_CHROOTS       folder that keeps bare root file systems as archives (default ~/.cache/lumen/chroots)
#   LUMEN_APT_ARCHIVES  folder of packages that were fetched before
set -euo pipefail
[ $# -ge 1 ] || { sed -n '3,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
out=$(cd "$1" && pwd)
try=${2:-}
deb=$(ls "$out"/lumen_*_amd64.deb 2>/dev/null | tail -1)
[ -n "$deb" ] || { echo "build.sh: $out has no lumen_*_amd64.deb: packages/debian/build.sh makes it" >&2; exit 1; }
version=$(dpkg-deb -f "$deb" Version)
version=${version%-*}
name=lumen-$version-linux-x86_64
: "${SOURCE_DATE_EPOCH:=$(git -C "$(dirname "${BASH_SOURCE[0]}")" log -1 --format=%ct)}"

chroots=${LUMEN_CHROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/lumen/chroots}
mkdir -p "$chroots"
# bare SUITE FOLDER
bare() {
  [ -s "$chroots/$1-minbase.tar" ] || { mmdebstrap --variant=minbase "$1" "$chroots/$1-minbase.new.tar" && mv "$chroots/$1-minbase.new.tar" "$chroots/$1-minbase.tar"; }
  mkdir -p "$2"
  tar -x --numeric-owner -C "$2" -f "$chroots/$1-minbase.tar"
}
inside() { unshare --mount --pid --fork sh -c "mount -t proc proc '$1/proc'; exec chroot '$1' sh -ec \"\$1\"" sh "$2"; }

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/root
bare bookworm "$root"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
mkdir "$root/packages"
cp "$deb" "$out"/lumen-viewer_*_all.deb "$root/packages"
[ -z "${LUMEN_APT_ARCHIVES:-}" ] || cp "$LUMEN_APT_ARCHIVES"/*.deb "$root/var/cache/apt/archives/"
inside "$root" 'export DEBIAN_FRONTEND=noninteractive; apt-get -q update; apt-get -q -y install --no-install-recommends ./packages/*.deb' >"$work/apt.log" 2>&1 ||
  { tail -20 "$work/apt.log" >&2; exit 1; }

folder=$work/$name
mkdir -p "$folder/bin" "$folder/lib" "$folder/libexec" "$folder/share/doc/lumen/licences"
cp "$root/usr/bin/lumen" "$folder/libexec/lumen"
# lumen looks for its page beside the file that runs, which is the loader: both lie one level down
cp -a "$root/usr/share/lumen" "$folder/share/"
cp -a "$root/usr/share/doc/lumen/." "$folder/share/doc/lumen/"
mkdir -p "$folder/share/man/man1"
gzip -dc "$root/usr/share/man/man1/lumen.1.gz" >"$folder/share/man/man1/lumen.1"
for script in bash-completion/completions/lumen zsh/vendor-completions/_lumen fish/vendor_completions.d/lumen.fish; do
  install -D -m 644 "$root/usr/share/$script" "$folder/share/$script"
done

inside "$root" 'ldd /usr/bin/lumen' | awk '{for (i = 1; i <= NF; ++i) if ($i ~ "^/") print $i}' | sort -u >"$work/libraries"
inside "$root" "while read -r file; do real=\$(readlink -f \"\$file\"); dpkg-query -S \"\$real\" 2>/dev/null || dpkg-query -S \"\${real#/usr}\"; done" \
  <"$work/libraries" | sed 's/:.*//' | sort -u >"$work/owners"
while read -r library; do cp -L "$root$library" "$folder/lib/"; done <"$work/libraries"
while read -r owner; do
  cp -L "$root/usr/share/doc/$owner/copyright" "$folder/share/doc/lumen/licences/$owner"
  chroot "$root" dpkg-query -W -f='${Package} ${Version} (source ${source:Package} ${source:Version})\n' "$owner"
done <"$work/owners" | sort -u >"$folder/share/doc/lumen/bundled.txt"
cat >"$folder/bin/lumen" <<'RUN'
#!/bin/sh
# Runs lumen with the libraries of this folder, whatever the system has.
here=$(dirname "$(readlink -f "$0")")/..
exec "$here/lib/ld-linux-x86-64.so.2" --inhibit-cache --library-path "$here/lib" --argv0 "$0" "$here/libexec/lumen" "$@"
RUN
cat >"$folder/README" <<TEXT
lumen $version for Linux on x86-64. Run bin/lumen; put a link to it into a folder of PATH. Nothing else is needed but
/bin/sh, dirname and readlink, which every system has. share/doc/lumen/bundled.txt lists the libraries in lib/, which are
those of Debian 12 unchanged: https://snapshot.debian.org has their sources, share/doc/lumen/licences their licences.
TEXT
chmod 755 "$folder/bin/lumen"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX --format=ustar \
  --mtime="@$SOURCE_DATE_EPOCH" -c "$name" | xz -T1 -6 >"$out/$name.tar.xz"
echo "== $name: $(du -sm "$folder" | cut -f1) MB, $(ls "$folder/lib" | wc -l) libraries; the archive $(du -m "$out/$name.tar.xz" | cut -f1) MB"
[ "$try" = --try ] || exit 0

# try_in ROOT: the commands of a first use, without any library of the system
try_in() {
  mkdir -p "$1/proc" "$1/tmp" "$1/dev"
  tar -x -C "$1/tmp" -f "$out/$name.tar.xz"
  cp "$(dirname "${BASH_SOURCE[0]}")/../debian/try.sh" "$1/tmp/try.sh"
  inside "$1" "cd /tmp; ln -s $name/bin/lumen run; sh ./try.sh /tmp/run && ./run view --help | head -1"
}
echo "== In Debian 11, C library $(bare bullseye "$work/old" && chroot "$work/old" ldd --version | sed -n '1s/.* //p')"
try_in "$work/old"
busybox=$(command -v busybox || true)
if [ -n "$busybox" ] && ! ldd "$busybox" >/dev/null 2>&1; then
  echo "== Beside a static busybox alone, as in a system without this C library"
  mkdir -p "$work/bare/bin"
  cp "$busybox" "$work/bare/bin/busybox"
  for tool in sh dirname readlink mktemp rm test head ln cat; do ln -s busybox "$work/bare/bin/$tool"; done
  try_in "$work/bare"
else
  echo "== A system without this C library is not tried: apt install busybox-static"
fi
