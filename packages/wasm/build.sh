#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes the npm package lumen-vascular as OUT/lumen-vascular-VERSION.tgz: the engine as WebAssembly, and a command. Puts
# lumen-view.wasm, the engine of the page without a server, beside the page in viewer/page/dist.
# The compiler and its libraries come from PyPI and from Debian's sources on the first call (toolchain.sh), into build/wasm-tools.
# Needs cmake, ninja, npm, python3-pip, dpkg-dev and the headers of libeigen3-dev, nlohmann-json3-dev, librobin-map-dev and
# libdraco-dev. Equal sources give equal bytes.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,7p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
tools=${LUMEN_WASM_TOOLCHAIN:-$root/build/wasm-tools}
build=$root/build/wasm

"$here/toolchain.sh" "$tools"
# without developers' warnings: every library is an archive here, those that are shared elsewhere, too
cmake -S "$root" -B "$build" -G Ninja -Wno-dev --log-level=WARNING -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" \
  -DLUMEN_WASM_TOOLCHAIN="$tools" -DLUMEN_IO=minimal -DLUMEN_WITH_NETGEN=OFF -DLUMEN_BUILD_TESTS=OFF -DLUMEN_UNITY=ON \
  -DCMAKE_BUILD_TYPE=Release
cmake --build "$build" -t lumen_wasm lumen_view_wasm
install -D -m 644 "$build/lumen-view.wasm" "$root/viewer/page/dist/lumen-view.wasm"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$root/packages/npm/engine" "$root/LICENSE" "$root/THIRD_PARTY.md" "$work/"
mv "$work/LICENSE" "$work/THIRD_PARTY.md" "$work/engine/"
install -m 644 "$build/lumen.wasm" "$work/engine/"
(cd "$work/engine" && npm pack --silent --pack-destination "$out" >/dev/null)
ls -l "$out"/lumen-vascular-*.tgz
