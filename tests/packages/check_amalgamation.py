#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""libblob as one file, beside libblob.

check_amalgamation.py CXX CC LIBRARY [CASE]

Without a case: the compiler takes blob.cpp. With one: the example of a cursor and 20,000 queries by each set of instructions
have the bits of the library, and further compilers that are installed (clang, MinGW) take it, too."""
import os, pathlib, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUERIES = r"""
#include <stdio.h>
#include <blob.h>
int main(int argc, char** argv) {
  unsigned state = argc;
  for (int simd = 1; simd <= 4; ++simd) {
    blob_open_def def = blob_open_def_default();
    def.simd = (blob_simd)simd;
    blob_model* vessel;
    if (blob_model_open(argv[1], &def, &vessel) != BLOB_OK) return 1;
    for (unsigned i = 0; i < 20000; ++i) {
      const blob_node node = blob_model_node(vessel, i % blob_model_describe(vessel).node_count);
      double point[3];
      for (int k = 0; k < 3; ++k) {
        state = state * 1664525u + 1013904223u;
        point[k] = node.centre[k] + 3 * node.radius * ((state >> 8) / 16777216.0 - 0.5);
      }
      blob_sample s;
      blob_query(vessel, i % 2 ? BLOB_LOCAL : 0, point, NULL, &s);
      printf("%a %a %a %u\n", s.value, s.distance, s.normal[1], (unsigned)s.node);
    }
    blob_model_close(vessel);
  }
  return 0;
}
"""


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode: sys.exit(f"check_amalgamation.py: {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    cxx, cc, library, *case = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        run(sys.executable, ROOT / "libblob/amalgamate.py", folder)
        if not case: return run(cxx, "-std=c++20", "-fsyntax-only", folder / "blob.cpp")
        run(cxx, "-std=c++20", "-O2", "-c", "blob.cpp", cwd=folder)
        (folder / "queries.c").write_text(QUERIES)
        answers = {}
        for source in (folder / "queries.c", ROOT / "libblob/examples/cursor.c"):
            for linked in (folder / "blob.o", library):
                program = folder / f"{source.stem}-{pathlib.Path(linked).stem}"
                run(cc, "-std=c11", "-DBLOB_STATIC", f"-I{folder}", source, linked, "-lstdc++", "-lm", "-o", program)
                answers.setdefault(source, set()).add(run(program, case[0]))
            if len(answers[source]) != 1: sys.exit(f"check_amalgamation.py: {source.name}: other bits than the library's")
        for other in ("clang++-14", "x86_64-w64-mingw32-g++-posix"):
            if shutil.which(other): run(other, "-std=c++20", "-fsyntax-only", folder / "blob.cpp")
            else: print(f"{other} is not installed")


if __name__ == "__main__":
    main()
