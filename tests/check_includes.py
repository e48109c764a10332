#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which way includes go: see docs/architecture.md.

check_includes.py [--table]

Prints every include that runs from a folder to one above it, and every cycle of files; with --table also
the folders with their lines, files and the folders that they include. Exit status: 0 neither, 1 some."""
import argparse, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What each folder may include besides itself, from the bottom up. A folder that is not here may not exist.
MAY_INCLUDE = {
    "formats/container": [],
    "formats/field": [],
    "formats/view": ["formats/container", "formats/field"],
    "formats/case": ["formats/container", "formats/field", "formats/view"],
    "libblob/include": [],
    "libblob/src": ["libblob/include", "libblob/src/simd", "formats/container", "formats/field", "formats/view"],
    "libblob/src/simd": ["libblob/include", "libblob/src", "formats/field"],
}
FORMATS = ["formats/container", "formats/field", "formats/view", "formats/case"]
MAY_INCLUDE["converters/common"] = FORMATS
STAGES = {"volume": [], "seeds": ["volume"], "centerline": ["seeds"], "tracking": ["seeds", "volume"], "fitting": [], "mesh": [], "surface": ["mesh"], "compare": [],
          "check": ["volume"], "phantom": ["seeds", "volume", "centerline"],
          "export": ["volume", "mesh", "surface", "centerline", "export/sofa", "export/mujoco", "export/cathsim"],
          "export/sofa": ["mesh", "surface", "export"], "export/mujoco": ["mesh", "surface", "export", "export/sofa"],
          "export/cathsim": ["mesh", "surface", "export", "export/mujoco"],
          "picture": ["check", "mesh", "volume"], "report": ["check"],
          "library": ["fitting", "mesh", "surface", "export"],
          "library/site": ["library"],
          "inside": ["volume", "centerline", "mesh", "surface"], "editing": ["fitting"]}
for stage, below in STAGES.items():
    MAY_INCLUDE["converters/" + stage] = FORMATS + ["converters/common"] + ["converters/" + b for b in below]
MAY_INCLUDE["converters/export"] += ["libblob/include"]  # its grids hold what libblob answers
MAY_INCLUDE["converters/export/cathsim"] += ["libblob/include"]  # which outer corners of its prisms lie in a lumen
MAY_INCLUDE["converters/picture"] += ["libblob/include"]  # it draws what libblob answers
MAY_INCLUDE["converters/app"] = FORMATS + ["converters/common"] + ["converters/" + s for s in STAGES]
MAY_INCLUDE["converters/export/sofa/plugin/src/LumenSofa"] = ["libblob/include", "formats/container", "formats/view"]
MAY_INCLUDE["converters/export/sofa/plugin/tests"] = []

# The viewer does what commands do; `app` has nothing of it but the name of a function that makes a command.
VIEWER = MAY_INCLUDE["converters/app"] + ["converters/app"]
MAY_INCLUDE["viewer/session"] = VIEWER
MAY_INCLUDE["viewer/server"] = VIEWER + ["viewer/session"]


def sources():
    """Every C or C++ file of the product, relative to the root."""
    for top in ("formats", "libblob/include", "libblob/src", "converters", "viewer/session", "viewer/server"):
        yield from (p.relative_to(ROOT) for p in sorted((ROOT / top).rglob("*")) if p.suffix in (".h", ".cpp", ".c"))


def resolve(file, name, files):
    """The file that an include names, or None for one of another project."""
    for base in (pathlib.Path(), file.parent, pathlib.Path("libblob/src"), pathlib.Path("libblob/include")):
        if base / name in files: return base / name
    return None


def cycles(arrows):
    """Each cycle that a depth-first search meets, as a list of files."""
    found, state, path = [], {}, []

    def visit(file):
        state[file] = 1
        path.append(file)
        for other in arrows[file]:
            if state.get(other) == 1: found.append(path[path.index(other):] + [other])
            elif other not in state: visit(other)
        path.pop()
        state[file] = 2

    for file in arrows:
        if file not in state: visit(file)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", action="store_true", help="the folders, their sizes and what they include")
    options = parser.parse_args()
    files = set(sources())
    text = {file: (ROOT / file).read_text() for file in files}
    arrows = {file: sorted({other for name in re.findall(r'^\s*#\s*include\s+"([^"]+)"', text[file], re.M)
                            if (other := resolve(file, name, files)) and other != file}) for file in sorted(files)}
    folder = lambda file: file.parent.as_posix()
    wrong = [f"{file} includes {other}, which is not below it" for file in arrows for other in arrows[file]
             if folder(file) != folder(other) and folder(other) not in MAY_INCLUDE.get(folder(file), [])]
    wrong += [f"{file}: its folder is not in the list of this script" for file in arrows if folder(file) not in MAY_INCLUDE]
    wrong += ["cycle: " + " -> ".join(map(str, cycle)) for cycle in cycles(arrows)]
    if options.table:
        print("| folder | files | lines | includes |\n|---|--:|--:|---|")
        for name in MAY_INCLUDE:
            inside = [f for f in files if folder(f) == name]
            below = sorted({folder(o) for f in inside for o in arrows[f]} - {name})
            print(f"| {name} | {len(inside)} | {sum(text[f].count(chr(10)) for f in inside)} | {', '.join(below)} |")
    print("\n".join(wrong) if wrong else f"{sum(map(len, arrows.values()))} includes among {len(files)} files, none upwards, no cycle")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
