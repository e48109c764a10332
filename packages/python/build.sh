#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: builds the Python package in build/release, and writes its wheel into the folder OUT.
# It needs the packages that ./bootstrap.sh packages patchelf installs.
set -euo pipefail
[ $# -eq 1 ] || {
  echo "Usage: packages/python/build.sh OUT" >&2
  exit 2
}
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
for tool in patchelf objdump strip python3; do
  command -v "$tool" >/dev/null || {
    echo "build.sh: $tool is missing; Debian: apt install patchelf binutils python3" >&2
    exit 1
  }
done
[ -f build/release/build.ninja ] || cmake --preset release
cmake --build build/release -t lumen_python_package
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' build/release/CMakeCache.txt)
: "${SOURCE_DATE_EPOCH:=$(git log -1 --format=%ct 2>/dev/null || echo 1704067200)}"
export SOURCE_DATE_EPOCH
python3 -B packages/python/make_wheel.py build/release/packages/python/lumen "$version" "$out"
