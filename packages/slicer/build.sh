#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes OUT/lumen-slicer-VERSION.zip, a folder of modules for 3D Slicer. Equal sources give equal bytes.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
python3 -B "$here/../zip_folder.py" "$1/lumen-slicer-$("$here/../version.py").zip" lumen-slicer \
  "$here"/Modules/*.py "$here"/Modules/*.xml "$here"/Modules/lumen_cli/*.py "$here/Modules/Lumen/Lumen.py" "$here/README.md" \
  "$here/../../LICENSE" --below "$here/Modules"
