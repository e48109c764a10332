#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: lumen-conformance-VERSION.tar.gz, the conformance set of the format with what runs a reader over it. Equal commits
# give equal bytes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
version=$(sed -n 's/^project(lumen VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
set=$work/lumen-conformance-$version
python3 -B "$root/spec/conformance/make.py" "$set"
python3 -B "$root/spec/conformance/make.py" --check "$set"
cp "$root/LICENSE" "$root"/spec/conformance/*.* "$set"
tar -C "$work" --sort=name --mtime="@${SOURCE_DATE_EPOCH:-0}" --owner=0 --group=0 --numeric-owner --mode=u+w,go+r-w \
  -c "$(basename "$set")" | gzip -9n >"$1/lumen-conformance-$version.tar.gz"
