#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# gather.sh IMAGE: copies the files of lumen's packages, the libraries that the program loads, and the licences of both from the
# system where they are installed into the folder IMAGE. Runs in the container's build, by dash.
set -eu
image=$1
mkdir -p "$image/usr/lib" "$image/usr/lib64" "$image/etc" "$image/tmp" "$image/data" "$image/var/lib/dpkg/status.d"
ln -s usr/lib "$image/lib"
ln -s usr/lib64 "$image/lib64"
chmod 1777 "$image/tmp"
chown nobody "$image/data"
grep -E '^(root|nobody):' /etc/passwd >"$image/etc/passwd"
grep -E '^(root|nogroup):' /etc/group >"$image/etc/group"

packages=""
keep_package() {
  case " $packages " in *" $1 "*) return ;; esac
  packages="$packages $1"
  mkdir -p "$image/usr/share/doc/$1"
  cp -L "/usr/share/doc/$1/copyright" "$image/usr/share/doc/$1/" 2>/dev/null || echo "gather.sh: $1 has no copyright file" >&2
  dpkg-query --status "$1" >"$image/var/lib/dpkg/status.d/${1%%:*}" # where scanners for known faults look
}

for package in lumen lumen-viewer; do
  keep_package "$package"
  dpkg-query --listfiles "$package" | while read -r file; do
    if [ -f "$file" ]; then
      mkdir -p "$image$(dirname "$file")"
      cp -a "$file" "$image$file"
    fi
  done
done
rm -rf "$image/usr/share/man" "$image/usr/share/bash-completion" "$image/usr/share/zsh" "$image/usr/share/fish"

# Libraries under the names by which they are loaded, in the folders that the loader knows without a cache.
for file in $(ldd /usr/bin/lumen | sed -nE 's/^.*=> (\/[^ ]+) .*$/\1/p; s/^\t(\/[^ ]*ld-linux[^ ]*) .*$/\1/p'); do
  place=$(readlink -f "$(dirname "$file")")
  mkdir -p "$image$place"
  cp -L "$file" "$image$place/"
  keep_package "$(dpkg-query --search "$(readlink -f "$file")" | cut -d: -f1)"
done
echo "gather.sh: $(echo "$packages" | wc -w) packages, $(du -sk "$image" | cut -f1) kB"
