#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# try.sh OUT [BASE.tar]: builds the container from the packages in OUT on a base that mmdebstrap makes (or that is given), without a
# registry, and uses it: user, size, a phantom to a case, and a page. Needs root, buildah and mmdebstrap.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '3,4p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(cd "$1" && pwd)
version=$("$here/../version.py")
buildah=(buildah --storage-driver vfs)
most=200000000  # bytes of the image's files
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

base=${2:-$work/base.tar}
[ -e "$base" ] || mmdebstrap --variant=minbase --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright' bookworm "$base"
container=$("${buildah[@]}" from scratch)
"${buildah[@]}" add --quiet "$container" "$base" / >/dev/null
"${buildah[@]}" commit --quiet "$container" localhost/lumen-base >/dev/null
"${buildah[@]}" rm "$container" >/dev/null

LUMEN_BASE=localhost/lumen-base "$here/build.sh" "$out"
container=$("${buildah[@]}" from --pull-never "localhost/lumen:$version")
root=$("${buildah[@]}" mount "$container")
size=$(du -sb --apparent-size "$root" | cut -f1)
echo "files: $size bytes; archive: $(stat -c %s "$out/lumen-container-$version.tar") bytes"

# a bind mount as `podman run --volume DIR:/data` makes it; its owner is nobody
mkdir "$work/data"
chown nobody "$work/data"
lumen() { "${buildah[@]}" run --isolation chroot --volume "$work/data:/data" "$container" -- lumen "$@"; }
[ "$("${buildah[@]}" inspect --format '{{.OCIv1.Config.User}}' "$container")" = nobody ]
[ "$(lumen --version)" = "lumen $version" ]
lumen phantom bifurcation fork.nrrd --size 48 --seeds seeds.json --quiet
lumen convert fork.nrrd fork.lumen --seeds seeds.json --quiet
lumen view fork.lumen --html fork.html --quiet
lumen picture fork.lumen fork.png --quiet
ls -l "$work/data"
[ "$(stat -c %U "$work/data/fork.html")" = nobody ]
! lumen convert fork.lumen /usr/share/x.lumen --quiet 2>/dev/null || { echo "try.sh: nobody writes into /usr" >&2; exit 1; }
"${buildah[@]}" umount "$container" >/dev/null
"${buildah[@]}" rm "$container" >/dev/null
[ "$size" -le "$most" ] || { echo "try.sh: it has more than $most bytes" >&2; exit 1; }
echo "try.sh: all held"
