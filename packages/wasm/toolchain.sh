#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# toolchain.sh OUT: makes a C++ compiler for WebAssembly in OUT, with the C and C++ libraries and those that lumen links. clang
# and the sources of its libraries come from PyPI, by hash (zig.txt); the sources of the others from Debian's packages. Minutes; a second
# call does nothing.
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,5p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
made=$(cat "$here"/{zig.txt,config_site.h,missing_calls.h} "$0" | sha256sum)
if [ "$(cat "$out/made-of.txt" 2>/dev/null)" != "$made" ]; then
  rm -rf "${out:?}"/{apt,bin,cache,include,lib,objects,source,zig,complete}
  echo "$made" >"$out/made-of.txt"
fi
[ ! -e "$out/complete" ] || exit 0
export ZIG_GLOBAL_CACHE_DIR=$out/cache ZIG_LOCAL_CACHE_DIR=$out/cache

fetch_zig() {
  [ ! -x "$out/zig/ziglang/zig" ] || return 0
  rm -rf "$out/wheel" "$out/zig"
  python3 -m pip download --quiet --require-hashes --only-binary :all: --no-deps -r "$here/zig.txt" -d "$out/wheel"
  python3 -m zipfile -e "$out"/wheel/ziglang-*.whl "$out/zig"
  rm -r "$out/wheel"
  chmod +x "$out/zig/ziglang/zig"
}

# Sources of Debian's packages: a list of packages' sources beside the system's own lists, which stay as they are.
fetch_sources() {
  [ ! -d "$out/source" ] || return 0
  rm -rf "$out/apt"
  mkdir -p "$out/apt/parts" "$out/apt/lists/partial" "$out/apt/source"
  awk 'BEGIN { RS = ""; ORS = "\n\n" } !/-security/ { sub(/Types: deb(\n|$)/, "Types: deb-src\n"); print }' \
    /etc/apt/sources.list.d/debian.sources >"$out/apt/parts/source.sources"
  local apt=(apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$out/apt/parts"
    -o "Dir::State::lists=$out/apt/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$out/apt/source" && "${apt[@]}" source wasi-libc zlib expat libzstd draco openmesh meshoptimizer libpng1.6 >/dev/null)
  mv "$out/apt/source" "$out/"
}

# A driver for each tool. Every object is compiled with SIMD and with WebAssembly's own exceptions.
make_tools() {
  local lib=$out/zig/ziglang/lib name
  mkdir -p "$out/bin" "$out/include" "$out/lib"
  cp "$here/config_site.h" "$out/include/"
  for name in ar ranlib wasm-ld; do
    printf '#!/bin/sh\nexec "%s/zig/ziglang/zig" %s "$@"\n' "$out" "$name" >"$out/bin/$name"
  done
  for name in clang clang++; do
    local mode='' headers=''
    [ $name = clang ] || mode=--driver-mode=g++
    [ $name = clang ] || headers="-include $out/include/config_site.h -isystem $lib/libcxx/include -isystem $lib/libcxxabi/include"
    cat >"$out/bin/$name" <<SCRIPT
#!/bin/sh
exec "$out/zig/ziglang/zig" clang $mode --target=wasm32-wasip1 -msimd128 -mbulk-memory -msign-ext -mnontrapping-fptoint \\
  -fwasm-exceptions -fno-math-errno -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_PROCESS_CLOCKS -nostdinc $headers -isystem $lib/include \\
  -isystem $lib/libc/include/wasm-wasi-musl -isystem $lib/libc/include/generic-musl -isystem $out/include \\
  -Wno-unused-command-line-argument \\
  "\$@"
SCRIPT
  done
  chmod +x "$out"/bin/*
}

# The C library as zig compiles it for a module without main: its linker line names the parts. Its malloc rounds sizes up to
# powers of two, so that a large volume takes up to twice its bytes: that of Debian's C library goes before it.
make_libc() {
  [ ! -f "$out/lib/libcompiler_rt.a" ] || return 0
  local line part work=$out/cache/probe
  mkdir -p "$work"
  echo 'int one(void) { return 1; }' >"$work/probe.c"
  line=$(cd "$work" && "$out/zig/ziglang/zig" cc --target=wasm32-wasi -O2 -msimd128 -mexec-model=reactor probe.c -o probe.wasm \
    --verbose 2>&1 | grep '^wasm-ld')
  for part in crt1-reactor.o libc.a libzigc.a libcompiler_rt.a; do
    cp "$(cd "$work" && realpath "$(tr ' ' '\n' <<<"$line" | grep "/$part\$")")" "$out/lib/"
  done
}

# compile NAME FLAGS... -- SOURCES...: lib/libNAME.a; large libraries whose speed matters little for size.
compile() {
  local name=$1 flags=() source
  [ ! -f "$out/lib/lib$name.a" ] || return 0
  shift
  while [ "$1" != -- ]; do flags+=("$1"); shift; done
  shift
  rm -rf "$out/objects/$name"
  mkdir -p "$out/objects/$name"
  for source in "$@"; do
    local tool="$out/bin/clang++ -std=c++23"
    [ "${source%.c}" = "$source" ] || tool="$out/bin/clang -std=gnu17"
    printf '%s -O3 -DNDEBUG -w %s -c %s -o %s\n' "$tool" "${flags[*]}" "$source" \
      "$out/objects/$name/$(tr / _ <<<"${source#"$out"/}").o"
  done | xargs -P "${JOBS:-$(nproc)}" -I{} sh -c '{}'
  "$out/bin/ar" rcs "$out/lib/lib$name.a" "$out/objects/$name"/*.o
}

make_runtime() {
  local lib=$out/zig/ziglang/lib
  # shellcheck disable=SC2046
  compile c++ -Os -D_LIBCPP_BUILDING_LIBRARY -DLIBCXX_BUILDING_LIBCXXABI -include "$here/missing_calls.h" -I"$lib/libcxx/src" -I"$lib/libcxx/libc" -- \
    $(ls "$lib"/libcxx/src/*.cpp "$lib"/libcxx/src/{filesystem,ryu}/*.cpp | grep -vE '/(strstream|print)\.cpp$')
  # shellcheck disable=SC2046
  compile c++abi -Os -D_LIBCXXABI_BUILDING_LIBRARY -D_LIBCPP_BUILDING_LIBRARY \
    -D_LIBCPP_ENABLE_CXX17_REMOVED_UNEXPECTED_FUNCTIONS -I"$lib/libunwind/include" -DLIBCXXABI_SILENT_TERMINATE -I"$lib/libcxx/src" -- \
    $(ls "$lib"/libcxxabi/src/*.cpp | grep -vE 'noexception|thread_atexit')
  compile unwind -D_LIBUNWIND_HIDE_SYMBOLS -I"$lib/libunwind/include" -- "$lib/libunwind/src/Unwind-wasm.c"
}

# package NAME TARGET [LIBRARY]: what find_package(NAME) finds; without a LIBRARY, headers alone.
package() {
  local folder=$out/lib/cmake/$1
  mkdir -p "$folder"
  {
    echo "set($1_VERSION 99)"
    if [ $# -eq 3 ]; then
      echo "add_library($2 STATIC IMPORTED)"
      echo "set_target_properties($2 PROPERTIES IMPORTED_LOCATION $out/lib/lib$3.a)"
    else
      echo "add_library($2 INTERFACE IMPORTED)"
    fi
    [ "$1" != Eigen3 ] || echo "target_include_directories($2 INTERFACE $out/include/eigen3)"
    [ "$1" != PNG ] || echo "target_link_libraries($2 INTERFACE $out/lib/libz.a)"
  } >"$folder/$1Config.cmake"
  echo 'set(PACKAGE_VERSION_COMPATIBLE TRUE)' >"$folder/$1ConfigVersion.cmake"
}

make_libraries() {
  local from
  from=$(echo "$out"/source/wasi-libc-*/dlmalloc)
  compile malloc -I"$from/include" -- "$from/src/dlmalloc.c"
  from=$(echo "$out"/source/zlib-*)
  compile z -I"$from" -- "$from"/{adler32,compress,crc32,deflate,inffast,inflate,inftrees,trees,uncompr,zutil}.c
  cp "$from"/{zlib,zconf}.h "$out/include/"
  from=$(echo "$out"/source/expat-*/expat/lib)
  : >"$out/include/expat_config.h"
  compile expat -Os -DXML_STATIC -DXML_NS=1 -DXML_DTD=1 -DXML_CONTEXT_BYTES=1024 -DBYTEORDER=1234 -DHAVE_ARC4RANDOM_BUF -- \
    "$from"/{xmlparse,xmlrole,xmltok}.c
  cp "$from"/{expat,expat_external}.h "$out/include/"
  from=$(echo "$out"/source/libzstd-*/lib)
  compile zstd -Os -DZSTD_DISABLE_ASM -- "$from"/{common,compress,decompress}/*.c
  cp "$from"/{zstd,zstd_errors}.h "$out/include/"
  from=$(echo "$out"/source/libpng1.6-*)
  cp "$from/scripts/pnglibconf.h.prebuilt" "$out/include/pnglibconf.h"
  compile png -Os -- "$from"/png{,error,get,mem,pread,read,rio,rtran,rutil,set,trans,wio,write,wtran,wutil}.c
  cp "$from"/{png,pngconf}.h "$out/include/"
  from=$(echo "$out"/source/meshoptimizer-*/src)
  compile meshoptimizer -- "$from"/*.cpp
  cp "$from"/meshoptimizer.h "$out/include/"
  from=$(echo "$out"/source/openmesh-*/src)
  # shellcheck disable=SC2046
  compile OpenMeshCore -Os -D_USE_MATH_DEFINES -I"$from" -- $(find "$from/OpenMesh/Core" -name '*.cc')
  from=$(echo "$out"/source/draco-*/src)
  mkdir -p "$out/include/draco"
  cp /usr/include/draco/draco_features.h "$out/include/draco/"
  # shellcheck disable=SC2046
  compile draco -Os -I"$from" -- $(find "$from"/draco/{attributes,compression,core,mesh,metadata,point_cloud} -name '*.cc' |
    grep -vE '_test|test_|mesh_utils|mesh_splitter')
}

# Headers: those of the packages above, and of libraries that are headers alone, which must not bring the system's own.
make_headers() {
  cp -r /usr/include/{eigen3,nlohmann,tsl} "$out/include/"
  local from
  for from in "$out"/source/{openmesh,draco}-*/src; do
    (cd "$from" && find . -name '*.h' -o -name '*.hh' -o -name '*.inl' | xargs cp --parents -t "$out/include")
  done
  package ZLIB ZLIB::ZLIB z
  package EXPAT EXPAT::EXPAT expat
  package zstd zstd::libzstd_static zstd
  package PNG PNG::PNG png
  package meshoptimizer meshoptimizer::meshoptimizer meshoptimizer
  package OpenMesh OpenMeshCore OpenMeshCore
  package draco draco::draco draco
  package Threads Threads::Threads
  package Eigen3 Eigen3::Eigen
  package nlohmann_json nlohmann_json::nlohmann_json
}

fetch_zig
fetch_sources
make_tools
make_libc
make_runtime
make_libraries
make_headers
touch "$out/complete"
