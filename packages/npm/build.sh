#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: makes the npm packages @lumen/blob and @lumen/viewer as OUT/NAME.tgz, and @lumen/page, the page without a server, where
# packages/wasm/build.sh has built its engine. Needs `npm ci` in viewer/page, and blob.wasm
# and query.wgsl (targets blob_wasm and blob_shader) in $LUMEN_BUILD (default: build/release). Equal sources give equal bytes.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,5p' "$0" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
build=${LUMEN_BUILD:-$root/build/release}
page=$root/viewer/page
wasm=$(find "$build/libblob" -name blob.wasm | head -n 1)
[ -n "$wasm" ] || { echo "build.sh: no blob.wasm in $build; cmake --build it with -t blob_wasm" >&2; exit 1; }
shader=$build/libblob/query.wgsl
[ -f "$shader" ] || { echo "build.sh: no query.wgsl in $build; cmake --build it with -t blob_shader (Debian: python3-pycparser)" >&2; exit 1; }
[ -d "$page/node_modules" ] || { echo "build.sh: npm ci in viewer/page is missing" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cp -r "$root/packages/npm/blob" "$root/packages/npm/viewer" "$work/"
cp "$root/libblob/wasm/blob.mjs" "$root/libblob/wasm/gpu.mjs" "$work/blob/"
{ # as a module, because bundlers differ in how they import texts; the shader has neither ` nor ${ nor a backslash
  echo "// SPDX-License-Identifier: Apache-2.0"
  echo "/** The text of query.wgsl. */"
  printf 'export const shader = `%s\n`;\n' "$(cat "$shader")"
} >"$work/blob/query_wgsl.mjs"
for package in blob viewer; do
  cp "$root/LICENSE" "$root/THIRD_PARTY.md" "$work/$package/"
  install -m 644 "$wasm" "$work/$package/"
done

# types from the JSDoc of the wrapper
cat >"$work/tsconfig.json" <<'JSON'
{"compilerOptions": {"allowJs": true, "declaration": true, "emitDeclarationOnly": true, "target": "es2022", "module": "nodenext",
  "lib": ["es2022", "dom"], "types": []}, "files": ["blob/blob.mjs", "blob/webgpu.mjs"]}
JSON
"$page/node_modules/.bin/tsc" -p "$work/tsconfig.json"

(cd "$page" && node build.mjs "$work/page" >/dev/null)
cp "$work/page/page.js" "$work/page/page.css" "$work/viewer/"
rm "$work/viewer/index.ts"
"$page/node_modules/.bin/esbuild" "$root/packages/npm/viewer/index.ts" --bundle --format=esm --target=es2022 --minify \
  --charset=utf8 --log-level=warning --outfile="$work/viewer/index.js"

packages=(blob viewer)
if [ -f "$page/dist/lumen-view.wasm" ]; then
  packages+=(page)
  cp -r "$root/packages/npm/page" "$work/files"
  mkdir "$work/files/site"
  for name in page.js page.css worker.js offline.js; do cp "$work/page/$name" "$work/files/site/"; done
  cp "$work/page/serverless.html" "$work/files/site/index.html"
  install -m 644 "$wasm" "$page/dist/lumen-view.wasm" "$work/files/site/"
  cp "$root/LICENSE" "$root/THIRD_PARTY.md" "$work/files/"
  rm -r "$work/page"
  mv "$work/files" "$work/page"
fi
for package in "${packages[@]}"; do
  (cd "$work/$package" && npm pack --silent --pack-destination "$out" >/dev/null)
done
ls -l "$out"/lumen-*.tgz
