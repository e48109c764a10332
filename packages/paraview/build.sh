#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes OUT/lumen-paraview-VERSION.zip, with the plugin for ParaView. Equal sources give equal bytes.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
python3 -B "$here/../zip_folder.py" "$1/lumen-paraview-$("$here/../version.py").zip" lumen-paraview \
  "$here/lumen_reader.py" "$here/python311/sitecustomize.py" "$here/README.md" "$here/../../LICENSE" --below "$here"
