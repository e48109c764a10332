#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# An installed SOFA that was copied without its symbolic links (each became a short text that names a file beside it)
# can be neither run nor linked against. This makes FOLDER a tree of links to it, with those links put right.
set -eu
[ $# = 2 ] || { echo "Usage: link_sofa.sh SOFA FOLDER" >&2; exit 2; }
sofa=$(cd "$1" && pwd)
[ -d "$sofa/lib/cmake/Sofa.Config" ] || { echo "link_sofa.sh: no installed SOFA in $sofa" >&2; exit 1; }
rm -rf "$2"
mkdir -p "$2"
cp -rs "$sofa/." "$2"
find "$2" -type d -exec chmod u+rwx {} +
# runSofa looks for its libraries beside itself, wherever a link to it is
for program in "$sofa"/bin/runSofa-*; do cp --remove-destination "$program" "$2/bin/"; done
# shorter than any program or library
find -L "$2/bin" "$2/lib" "$2"/plugins/*/lib -maxdepth 1 -type f -size -256c \( -name '*.so' -o -name runSofa \) |
while read -r file; do
  target=$(cat "$file")
  [ -f "$(dirname "$file")/$target" ] || { echo "link_sofa.sh: $file is neither a file nor a link" >&2; exit 1; }
  ln -sf "$target" "$file"
done
