#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes OUT/lumen-container-VERSION.tar, an image in the OCI format, from the Debian packages in OUT. Needs buildah and
# the image debian:bookworm-slim; LUMEN_BASE names another one, such as one that try.sh makes without a registry.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,4p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
version=$("$here/../version.py")
buildah=(buildah)
[ "$(id -u)" -ne 0 ] || buildah+=(--storage-driver vfs)  # works where overlays cannot be mounted, such as in a container

for package in lumen lumen-viewer; do
  compgen -G "$out/${package}_$version*.deb" >/dev/null ||
    { echo "build.sh: no ${package}_$version*.deb in $out; packages/debian/build.sh makes it" >&2; exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$out"/lumen_"$version"*.deb "$out"/lumen-viewer_"$version"*.deb "$here/gather.sh" "$work/"

base=()
[ -z "${LUMEN_BASE:-}" ] || base=(--build-arg "BASE=$LUMEN_BASE" --pull-never)
epoch=${SOURCE_DATE_EPOCH:-$(git -C "$here" log -1 --format=%ct)}
"${buildah[@]}" build --isolation chroot --timestamp "$epoch" "${base[@]}" \
  --tag "lumen:$version" --file "$here/Containerfile" "$work"
archive=$out/lumen-container-$version.tar
rm -f "$archive"
"${buildah[@]}" push "lumen:$version" "oci-archive:$archive:lumen:$version"
ls -l "$archive"
