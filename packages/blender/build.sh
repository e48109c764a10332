#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes OUT/lumen-blender-VERSION.zip, which Blender's preferences install as an add-on. Equal sources give equal bytes.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
python3 -B "$here/../zip_folder.py" "$1/lumen-blender-$("$here/../version.py").zip" lumen_blender \
  "$here"/lumen_blender/*.py "$here/README.md" "$here/../../LICENSE"
