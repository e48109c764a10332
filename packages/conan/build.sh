#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh OUT: lumen-conan-VERSION.tar.gz, a recipe of Conan 2 that has the sources with it.
# Use: conan create lumen-conan-VERSION/recipe
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
exec "$here/../pack_recipe.sh" "$1" conan "$here/recipe" recipe
