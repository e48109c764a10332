#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what lumen needs on Debian 12, builds it, and runs the demonstration or the tests. Safe to repeat.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: ./bootstrap.sh demo|test|nightly|packages [PACKAGE...]

  demo       make a synthetic angiogram in ./demo, turn it into a case and a mesh, and score the result
  test       build everything but what the night needs, and run all tests but those of the night
  nightly    build everything, and run the tests of the night: slow ones, and many programs of others
  packages   only install what the tests need, and each PACKAGE

All install the missing Debian packages (with sudo unless run as root); all but packages build into build/release.
TEXT
}

packages=(
  build-essential cmake ninja-build ccache git ca-certificates python3
  libinsighttoolkit5-dev libgdcm-dev libgdcm-tools zlib1g-dev
  libeigen3-dev libopenmesh-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev libzstd-dev libpng-dev
  libopenvdb-dev libexpat1-dev robin-map-dev libcpp-httplib-dev
  libcli11-dev nlohmann-json3-dev libtbb-dev
  clang-14 lld-14 libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32
  libnglib-dev netgen-headers
  libgtest-dev libbenchmark-dev libcgal-dev libbullet-dev python3-vtk9 tetgen
)

say() { printf '\n== %s\n' "$*"; }

installed() { dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null | grep -q '^ii'; }

# The glTF validator of the tests runs on Node 18 or newer, from wherever it is.
have_node() {
  command -v npm >/dev/null && command -v node >/dev/null &&
    [ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ]
}

install_packages() {
  local wanted=("$@") missing=() as_root=()
  for package in "${wanted[@]}"; do
    installed "$package" || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    say "Debian packages: all present"
    return
  fi
  if ! command -v apt-get >/dev/null; then
    echo "bootstrap.sh: no apt-get here; install what matches these Debian 12 packages: ${missing[*]}" >&2
    exit 1
  fi
  say "Debian packages: installing ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -q -o Acquire::Retries=5
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y \
    -o Acquire::Retries=5 --no-install-recommends "${missing[@]}"
}

# The page of the viewer: it runs without npm, but is built by it. Fails if that does.
build_page() {
  local folder=viewer/page
  [ -f "$folder/package.json" ] || return 0
  if ! have_node; then
    say "The viewer's page: left out, as npm and Node 18 or newer are not here (apt install npm nodejs)"
    return
  fi
  say "The viewer's page: building it in $folder"
  local authorities=/etc/ssl/certs/ca-certificates.crt
  [ ! -r "$authorities" ] || export NODE_EXTRA_CA_CERTS="${NODE_EXTRA_CA_CERTS:-$authorities}"
  (
    cd "$folder" &&
      { [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund --fetch-retries=5; } &&
      npm run --silent build
  )
}

# configure_and_build [TARGET...]: everything without a target.
configure_and_build() {
  say "Configuring build/release"
  cmake --preset release
  say "Building ${*:-everything} on $(nproc) cores"
  ninja -C build/release -j "$(nproc)" "$@"
}

# json_figure FILE KEY: the first number under that key, with three decimals.
json_figure() {
  LC_ALL=C awk -v key="\"$2\":" '$1 == key { sub(/,$/, "", $2); printf "%.3f", $2; exit }' "$1"
}

run_demo() {
  have_node || packages+=(nodejs npm)
  install_packages "${packages[@]}"
  build_page || say "The viewer's page could not be built; all else goes on without it"
  configure_and_build lumen
  local lumen=build/release/converters/cli/lumen
  mkdir -p demo
  say "A synthetic angiogram, its truth, and the seeds that a user would click"
  $lumen phantom patient demo/angiogram.nrrd --truth demo/truth.lumen --seeds demo/seeds.json
  say "From the volume to a case: tracking and fitting"
  $lumen convert demo/angiogram.nrrd demo/vessels.lumen --seeds demo/seeds.json
  say "From the case to a mesh"
  $lumen convert demo/vessels.lumen demo/vessels.glb
  say "A picture of it, and a report to print"
  $lumen picture demo/vessels.lumen demo/vessels.png --volume demo/angiogram.nrrd --view anterior
  $lumen report demo/vessels.lumen demo/report.html --volume demo/angiogram.nrrd
  say "Contents of the case, and its agreement with the truth"
  $lumen info demo/vessels.lumen >demo/info.txt
  $lumen info demo/vessels.lumen --json --quiet >demo/info.json
  $lumen compare demo/vessels.lumen demo/truth.lumen >demo/compare.txt
  $lumen compare demo/vessels.lumen demo/truth.lumen --json --quiet >demo/compare.json
  close_demo
}

close_demo() {
  local c=demo/compare.json
  cat <<TEXT

== Made in ./demo
  angiogram.nrrd   the synthetic volume; 3D Slicer and ITK-SNAP show it
  seeds.json       the clicks that tracking starts from
  truth.lumen      the true tree
  vessels.lumen    the case: tree, wall points, blobby models
  vessels.glb      its wall as a mesh
  vessels.png      a picture of it, before the volume's projection
  report.html      pages to print: pictures, radius along each vessel, agreement with the volume
  info.txt         what the case holds, branch by branch (info.json for programs)
  compare.txt      how close it is to the truth, branch by branch (compare.json for programs)

== Key figures
  $(sed -n -e '1,4s/  */ /p' demo/info.txt | paste -sd, | sed 's/,/, /g')
  overlap with the true centerlines   $(json_figure $c overlap)
  centerline distance, mean           $(json_figure $c assd_mm) mm
  radius, mean error                  $(json_figure $c radius_bias_mm) mm
  wall distance, median and 90 %      $(json_figure $c median) mm, $(json_figure $c p90) mm

== To look at it
  The volume and the vessels in the browser, to see, measure and correct:
    build/release/converters/cli/lumen view demo/angiogram.nrrd demo/vessels.lumen
  Open demo/report.html in a browser, and demo/vessels.png.
  Ten synthetic patients as a library with a site:
    build/release/converters/cli/lumen library sample patients --jobs 2
    build/release/converters/cli/lumen library index patients    # then open patients/index.html
  Open demo/vessels.glb in any glTF viewer, such as Blender, or f3d from Debian (which cannot read --draco):
    apt install f3d && f3d demo/vessels.glb
  The command line is build/release/converters/cli/lumen; --help lists what it can do.
TEXT
}

run_ctest() {
  local report=$PWD/build/release/tests.xml status=0
  say "Running the tests"
  rm -rf "$report" build/release/results
  ctest --test-dir build/release --output-on-failure -j "$(nproc)" --output-junit "$report" "$@" || status=$?
  if [ ! -s "$report" ]; then
    echo "bootstrap.sh: ctest left no report" >&2
    exit 1
  fi
  tests/count_results.py "$report" build/release/results || status=$?
  return "$status"
}

# $1: a folder of tests with a package.json; $2: what it installs
install_from_npm() {
  local folder=$1
  if [ "$folder/node_modules/.package-lock.json" -nt "$folder/package-lock.json" ]; then
    say "$2: present"
    return
  fi
  say "$2: installing it into $folder"
  # node brings its own list of authorities; a proxy's certificate is only in the system's
  local authorities=/etc/ssl/certs/ca-certificates.crt
  [ ! -r "$authorities" ] || export NODE_EXTRA_CA_CERTS="${NODE_EXTRA_CA_CERTS:-$authorities}"
  (cd "$folder" && npm ci --no-audit --no-fund --fetch-retries=5)
}

install_test_packages() {
  have_node || packages+=(nodejs npm)
  # the JSON answers against their schemas, what judges the manual page, and what reads VTP
  packages+=(python3-jsonschema groff-base mandoc python3-vtk9)
  # signatures of libraries, and what the commands on their pages run
  packages+=(curl minisign openssh-client)
  # the query on a flat buffer, on the processor by pocl, and its translations
  packages+=(ocl-icd-opencl-dev opencl-headers pocl-opencl-icd python3-pycparser)
  # the viewer's page, as a person would use it
  packages+=(chromium)
  # libblob's examples and bindings, each left out where it is missing
  packages+=(libembree-dev libmujoco-dev python3-numpy)
  # the Python package, its stubs, and its notebook
  packages+=(pybind11-dev python3-dev mypy python3-pyopencl python3-nbclient python3-ipykernel strace)
  # what reads openBF's input
  packages+=(python3-yaml)
  # where a SOFA is: to run it, and to build its plugin
  packages+=(libtinyxml2-9 libglew2.2 libopengl0 libglu1-mesa libgl1)
  packages+=(libtinyxml2-dev libboost-dev libglew-dev libgl1-mesa-dev libglu1-mesa-dev)
  install_packages "${packages[@]}" "$@"
}

# $1: include or exclude, the tests of the night
run_tests() {
  install_test_packages
  build_page
  configure_and_build
  install_from_npm tests/gltf "The glTF validator"
  install_from_npm tests/mujoco "MuJoCo"
  install_from_npm tests/library "The RO-Crate library"
  install_from_npm tests/pipelines "The BIDS validator"
  case "$1" in
    exclude) run_ctest --label-exclude nightly ;;
    include) run_ctest --label-regex nightly ;;
  esac
}

cd "$(dirname "${BASH_SOURCE[0]}")"
case "${1:-}" in
  demo) run_demo ;;
  test) run_tests exclude ;;
  nightly) run_tests include ;;
  packages) install_test_packages "${@:2}" ;;
  -h | --help) usage ;;
  *)
    usage >&2
    exit 2
    ;;
esac
