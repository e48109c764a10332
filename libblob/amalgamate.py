#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""libblob as one source and its header, for projects that compile it themselves.

amalgamate.py FOLDER

Writes FOLDER/blob.cpp (C++20, no library but the standard one) and its headers, blob.h and blob_pose.h:

    c++ -std=c++20 -O2 -c blob.cpp        # GCC, clang, MinGW, emscripten; the headers are C99 and C++11

Buffers for other processors (blob_device.h) are left to the library.

Headers of the repository are put where they are included, those with #pragma once the first time. Results have the bits of
the library, whatever the compiler's flags: products and sums are not fused."""
import pathlib, re, sys

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[1]
INCLUDES = ROOT / "libblob/include"
FOLDERS = (ROOT, INCLUDES, ROOT / "libblob/src")  # as -I has them
HEADERS = ("blob.h", "blob_pose.h")
LEFT_OUT = {"device.cpp"}
INCLUDE = re.compile(r'^\s*#include "([^"]+)"')
SYSTEM = re.compile(r"^\s*#include <([^>]+)>")
HEAD = """\
// SPDX-License-Identifier: Apache-2.0
// libblob {version} in one file, by libblob/amalgamate.py of lumen: change the sources, not this.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("fp-contract=off")
#else
#pragma STDC FP_CONTRACT OFF
#endif
#ifndef BLOB_STATIC
#define BLOB_STATIC
#endif
#include "blob_pose.h"
"""


def fail(message):
    sys.exit(f"amalgamate.py: {message}")


def sources(path, name):
    """The .cpp files that a CMakeLists.txt lists below a name."""
    text = re.search(rf"\b{name}\b([^)]*)\)", path.read_text())
    found = text and re.findall(r"\S+\.cpp", text[1])
    if not found: fail(f"{path.relative_to(ROOT)}: found no sources of {name}")
    return [path.parent / source for source in found]


class Writer:
    def __init__(self):
        self.seen, self.lines = {INCLUDES / name for name in HEADERS}, []

    def resolve(self, name, beside):
        for folder in (beside.parent, *FOLDERS):
            if (folder / name).is_file(): return (folder / name).resolve()
        fail(f"{beside.relative_to(ROOT)}: there is no {name}")

    def add(self, path):
        text = path.read_text()
        if "#pragma once" in text or path.suffix == ".h" and re.search(r"^#ifndef \w+_H_?$", text, re.M):
            if path in self.seen: return
            self.seen.add(path)
        self.lines.append(f"// {path.relative_to(ROOT)}")
        for line in text.splitlines():
            if match := INCLUDE.match(line):
                self.add(self.resolve(match[1], path))
            elif not line.startswith(("#pragma once", "// SPDX")):
                self.lines.append(line)


def main():
    if len(sys.argv) != 2: fail("expected FOLDER")
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    header = (INCLUDES / "blob.h").read_text()
    version = ".".join(re.search(rf"#define BLOB_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))
    writer = Writer()
    for name in ("lumen_container", "lumen_field", "lumen_view"):
        for source in sources(ROOT / "formats/CMakeLists.txt", name): writer.add(source.resolve())
    for source in sources(ROOT / "libblob/CMakeLists.txt", "blob_sources"):
        if source.name not in LEFT_OUT: writer.add(source.resolve())
    (out / "blob.cpp").write_text(HEAD.format(version=version) + "\n".join(writer.lines) + "\n")
    for name in HEADERS: (out / name).write_text((INCLUDES / name).read_text())


if __name__ == "__main__":
    main()
