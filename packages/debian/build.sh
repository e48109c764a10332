#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT [--twice]: Debian packages of the committed state, in a clean chroot without a network.
#
# --twice builds again at another path, in another time zone, language and umask, and fails unless all packages have the
# same bytes. Needs root, mmdebstrap and util-linux; lintian judges the packages if it is installed.
#   LUMEN_CHROOTS  folder that keeps the chroot as an archive (default ~/.cache/lumen/chroots)
#   LUMEN_CCACHE   folder of a compiler cache for the first build; without it everything is compiled
#   LUMEN_SOFA     an installed SOFA: builds lumen-sofa, too
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
[ $# -ge 1 ] || { sed -n '3,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
twice=${2:-}
[ "$(id -u)" -eq 0 ] || { echo "build.sh: a chroot needs root" >&2; exit 1; }
for tool in mmdebstrap unshare dpkg-parsechangelog; do
  command -v $tool >/dev/null || { echo "build.sh: $tool is missing (apt install mmdebstrap dpkg-dev)" >&2; exit 1; }
done

version=$(dpkg-parsechangelog -l "$here/changelog" -S Version)
upstream=${version%-*}
grep -q "^project(lumen VERSION $upstream " "$root/CMakeLists.txt" || {
  echo "build.sh: packages/debian/changelog has $upstream, CMakeLists.txt another version" >&2
  exit 1
}
page=$root/viewer/page/dist
for file in page.js blob.wasm; do
  [ -s "$page/$file" ] || { echo "build.sh: $page/$file is missing: ./bootstrap.sh test builds the page" >&2; exit 1; }
done

profiles=()
[ -x "$root/packages/python/build.sh" ] || profiles+=(pkg.lumen.nopython)
[ -z "${LUMEN_SOFA:-}" ] || profiles+=(pkg.lumen.sofa)

commit=$(git -C "$root" rev-parse HEAD)
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT

# make_source FOLDER: the committed files, the page, and debian/ at the top
make_source() {
  mkdir -p "$1"
  git -C "$root" archive "$commit" | tar -x -C "$1"
  mkdir -p "$1/viewer/page/dist"
  cp -r "$page/." "$1/viewer/page/dist"
  cp -r "$1/packages/debian" "$1/debian"
}

# the packages of Build-Depends that these profiles need
build_packages() {
  sed -n '/^Build-Depends:/,/^$/p' "$here/control" | tail -n +2 | while read -r line; do
    profile=$(sed -n 's/.*<\(.*\)>.*/\1/p' <<<"$line")
    name=$(sed 's/[ ,(<].*//; s/debhelper-compat/debhelper/' <<<"$line")
    [ -n "$name" ] || continue
    case $profile in
      "") ;;
      '!'*) [[ " ${profiles[*]} " != *" ${profile#!} "* ]] || continue ;;
      *) [[ " ${profiles[*]} " == *" $profile "* ]] || continue ;;
    esac
    echo "$name"
  done
}

chroots=${LUMEN_CHROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/lumen/chroots}
mkdir -p "$chroots"
include=$(build_packages | paste -sd,)${LUMEN_CCACHE:+,ccache}
chroot_archive=$chroots/bookworm-$(sha256sum <<<"$include" | cut -c1-12).tar
if [ ! -s "$chroot_archive" ]; then
  echo "== A chroot of Debian 12 with what the build needs"
  mmdebstrap --variant=buildd --include="$include" ${LUMEN_CHROOT_OPTIONS:-} bookworm "${chroot_archive%.tar}.new.tar"
  mv "${chroot_archive%.tar}.new.tar" "$chroot_archive"
fi

# build PATH OUT COMMAND...: builds in a fresh chroot at PATH, with COMMAND before dpkg-buildpackage
build() {
  local path=$1 target=$2
  shift 2
  local inside=$work/chroot
  rm -rf --one-file-system "$inside"
  mkdir -p "$inside" "$target"
  tar -x --numeric-owner -C "$inside" -f "$chroot_archive"
  make_source "$inside$path/lumen-$upstream"
  local mounts="mount -t proc proc '$inside/proc'"
  if [ -n "${LUMEN_CCACHE:-}" ] && [ "$path" = /build ]; then
    mkdir -p "$LUMEN_CCACHE" "$inside/ccache"
    mounts+=" && mount --bind '$LUMEN_CCACHE' '$inside/ccache'"
  fi
  if [ -n "${LUMEN_SOFA:-}" ]; then
    mkdir -p "$inside/sofa"
    mounts+=" && mount --bind '$LUMEN_SOFA' '$inside/sofa'"
  fi
  unshare --mount --net --pid --fork --kill-child sh -c "$mounts && exec chroot '$inside' env -i \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/nonexistent CCACHE_DIR=/ccache LUMEN_SOFA=/sofa \
    DEB_BUILD_OPTIONS='noautodbgsym parallel=$(nproc)' DEB_BUILD_PROFILES='${profiles[*]}' \
    $* sh -c 'umask \${UMASK:-022}; cd $path/lumen-$upstream && dpkg-buildpackage -b -us -uc'"
  cp "$inside$path"/*.deb "$inside$path"/*.buildinfo "$inside$path"/*.changes "$target"
}

echo "== Building lumen $version"
build /build "$out" LC_ALL=C.UTF-8 TZ=UTC
(cd "$out" && ls -l *.deb)
if command -v lintian >/dev/null; then
  echo "== lintian"
  lintian --allow-root --fail-on error "$out"/lumen_*.changes
fi
if [ "$twice" = --twice ]; then
  echo "== Building again, elsewhere"
  build /other/place "$work/second" LC_ALL=C TZ=Pacific/Auckland UMASK=002
  for package in "$out"/*.deb; do cmp "$package" "$work/second/$(basename "$package")"; done
  echo "Both builds made the same bytes"
fi
