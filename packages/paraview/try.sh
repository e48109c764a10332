#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# try.sh OUT PICTURE.png [ROOT]: runs the plugin in Debian 12's ParaView, in a root file system that mmdebstrap makes (or in ROOT, made
# earlier), with lumen from the packages in OUT, and writes a picture. Needs root and mmdebstrap; 2.4 GB of disk.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '3,4p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(cd "$1" && pwd)
root=${3:-}
if [ -z "$root" ]; then
  root=$(mktemp -d)
  trap 'umount "$root/proc" 2>/dev/null; rm -rf "$root"' EXIT
  mmdebstrap --variant=apt --include=python3-paraview,paraview,xvfb,xauth,libgl1-mesa-dri bookworm "$root"
fi
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
rm -rf "$root/try"
mkdir "$root/try"
cp "$out"/lumen_*.deb "$here/lumen_reader.py" "$here/try.py" "$root/try/"
cp -r "$here/python311" "$root/try/"
cp /etc/resolv.conf "$root/etc/"
inside() { chroot "$root" env -C /try DEBIAN_FRONTEND=noninteractive PYTHONPATH=/try/python311 "$@"; }
inside apt-get update -q
inside sh -c 'apt-get install -q -y --no-install-recommends /try/lumen_*.deb'
inside lumen phantom patient patient.nrrd --truth patient.lumen --quiet
inside lumen convert patient.nrrd head.lumen --quiet
inside xvfb-run -a pvbatch try.py lumen_reader.py /try/head.lumen head.png
cp "$root/try/head.png" "$2"
