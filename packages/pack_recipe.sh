#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# pack_recipe.sh OUT NAME FOLDER PLACE: OUT/lumen-NAME-VERSION.tar.gz with FOLDER, and the archive of the committed sources at
# PLACE in it. Equal commits give equal bytes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
version=$(sed -n 's/^project(lumen VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
mkdir -p "$1"
out=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
name=lumen-$2-$version
mkdir "$work/$name"
cp -r "$3" "$work/$name/"
git -C "$root" archive --prefix="lumen-$version/" HEAD | gzip -9n >"$work/$name/$4/lumen-$version.tar.gz"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX --format=ustar \
  --mtime="@$(git -C "$root" log -1 --format=%ct)" -c "$name" | gzip -9n >"$out/$name.tar.gz"
