#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# release.sh [KIND...]: builds packages of all kinds, or of these, into dist/, and writes SHA256SUMS and its signature.
#
# A kind is a folder beside this script with a build.sh, which is handed the output folder. A kind that cannot be built
# here fails and is named at the end; the others go on. Signing needs one of
#   LUMEN_MINISIGN_KEY  file of a secret key of minisign: SHA256SUMS.minisig
#   LUMEN_GPG_KEY       name of a key in the caller's keyring: SHA256SUMS.asc
# Without one, SHA256SUMS is not signed, and the script says so. Exit status: 0 all kinds are built, 1 some are not.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$here")
dist=$root/dist
version=$(sed -n 's/^project(lumen VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$root" log -1 --format=%ct)}

kinds=("$@")
if [ ${#kinds[@]} -eq 0 ]; then
  for build in "$here"/*/build.sh; do
    kind=$(basename "$(dirname "$build")")
    [ "$kind" = container ] || kinds+=("$kind")
  done
  # a container is made from the Debian packages
  [ ! -e "$here/container/build.sh" ] || kinds+=(container)
fi
if ! git -C "$root" diff --quiet HEAD; then
  echo "release.sh: files differ from the last commit; packages of committed files do not have these changes" >&2
fi

rm -rf "$dist"
mkdir -p "$dist"
git -C "$root" archive --prefix="lumen-$version/" HEAD | gzip -9n >"$dist/lumen-$version.tar.gz"
failed=()
for kind in "${kinds[@]}"; do
  echo "== $kind"
  [ -x "$here/$kind/build.sh" ] || { echo "release.sh: there is no packages/$kind/build.sh" >&2; failed+=("$kind"); continue; }
  "$here/$kind/build.sh" "$dist" || failed+=("$kind")
done

cd "$dist"
find . -type f ! -name 'SHA256SUMS*' -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' sha256sum >SHA256SUMS
if [ -n "${LUMEN_MINISIGN_KEY:-}" ]; then
  minisign -S -s "$LUMEN_MINISIGN_KEY" -m SHA256SUMS -t "lumen $version"
elif [ -n "${LUMEN_GPG_KEY:-}" ]; then
  gpg --batch --yes --local-user "$LUMEN_GPG_KEY" --armor --detach-sign SHA256SUMS
else
  echo "release.sh: SHA256SUMS is not signed: neither LUMEN_MINISIGN_KEY nor LUMEN_GPG_KEY is set"
fi
cat SHA256SUMS
if [ ${#failed[@]} -gt 0 ]; then
  echo "release.sh: not built: ${failed[*]}" >&2
  exit 1
fi
