#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: lumen-vcpkg-VERSION.tar.gz, an overlay of vcpkg that has the sources with it.
# Use: vcpkg install lumen --overlay-ports=lumen-vcpkg-VERSION/ports
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
exec "$here/../pack_recipe.sh" "$1" vcpkg "$here/ports" ports/lumen
