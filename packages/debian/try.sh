#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# try.sh LUMEN: the program makes a synthetic volume, a case, a mesh and a picture, and finds the case valid.
set -eu
lumen=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$lumen" --version
"$lumen" phantom tube tube.nrrd --size 32 --seeds seeds.json --quiet
"$lumen" convert tube.nrrd tube.lumen --seeds seeds.json --quiet
"$lumen" validate tube.lumen --quiet
"$lumen" convert tube.lumen tube.glb --quiet
"$lumen" picture tube.lumen tube.png --quiet
test -s tube.glb
test -s tube.png
