#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which way includes of C++ and imports of the page and of the Python package go, that strings do not go the other way
(docs/architecture.md), and that no test is left out of the build.

check_includes.py [--table]

Prints every include or import that runs from a folder to one above it, and every cycle of files, imports of types and
those within functions included; with --table also the folders with their lines, files and the folders that they include. Exit status: 0 neither, 1 some."""
import argparse, ast, os, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Folders that each folder may include besides itself, from the bottom up. A folder that is not here may not exist.
MAY_INCLUDE = {
    "formats/container": [],
    "formats/field": [],
    "formats/view": ["formats/container", "formats/field"],
    "formats/json": ["formats/container", "formats/field", "formats/view"],
    "formats/case": ["formats/container", "formats/field", "formats/view", "formats/json"],
    "formats/include/lumen": [],
    "formats/api": ["formats/include/lumen", "formats/container", "formats/field", "formats/view", "formats/json", "formats/case"],
    "libblob/include": [],
    "libblob/src": ["libblob/include", "libblob/src/simd", "formats/container", "formats/field", "formats/view"],
    "libblob/cuda": ["libblob/include"],
    "libblob/wire": ["libblob/include"],
    "libblob/src/simd": ["libblob/include", "libblob/src", "formats/field"],
}
FORMATS = ["formats/container", "formats/field", "formats/view", "formats/json", "formats/case"]

# The rooms of the converters from the bottom up. A folder may include the formats, libblob's header, all folders of the
# rooms before its own, and in its own room those that are named beside it.
ROOMS = [
    {"base": []},
    {"base/options": []},
    {"geometry": []},
    {"voxels": []},
    {"io/content": []},
    {"io/vtk": [], "io/volume": [], "io/volume/dicom": ["io/volume"], "io/labels": ["io/volume", "io/volume/dicom"], "io/mesh": ["io/vtk", "io/volume/dicom"], "io/seeds": ["io/volume"],
     "io/centerline": ["io/seeds", "io/vtk", "io/volume"]},
    {"stages/finding": [], "stages/native": ["stages/finding"], "stages/tracking/cylinders": [], "stages/tracking": ["stages/tracking/cylinders"], "stages/fitting": [], "stages/fitting/image": [], "stages/editing": ["stages/fitting"], "stages/anatomy": [], "stages/repair": [],
     "stages/surface": [], "stages/surface/remesh": ["stages/surface"], "stages/surface/simplify": ["stages/surface", "stages/surface/remesh"],
     "stages/surface/closing": ["stages/surface", "stages/surface/remesh", "stages/surface/simplify"],
     "stages/surface/patches": ["stages/surface", "stages/surface/closing"],
     "stages/volume_mesh/netgen": [], "stages/volume_mesh": ["stages/surface", "stages/surface/remesh", "stages/surface/closing", "stages/volume_mesh/netgen"],
     "stages/trees_from_surfaces": ["stages/repair"], "stages/motion": ["stages/fitting/image"], "stages/phantom": ["stages/motion"]},
    {"judge/measure": []},
    {"judge/compare": [], "judge/check": []},
    {"judge/facts": []},
    {"judge/gate": []},
    {"draw/raster": [], "draw/overlay": ["draw/raster"], "draw/picture": ["draw/raster"], "draw/xray": ["draw/raster"],
     "draw/report": ["draw/overlay", "draw/raster"]},
    {"export/shared": []},
    {"export/targets": []},
    {"export/targets/" + name: [] for name in ("cathsim", "engines", "grid", "isaac", "mujoco", "oned", "openfoam", "print",
                                               "simvascular", "slicer", "sofa", "steve", "svzerod")},
    {"export": []},
    {"operations": []},
    {"library/index": [], "library/publish": ["library/index"], "library/rows": ["library/index"], "library/site": ["library/index"], "library/batch": ["library/rows", "library/index"]},
    {"engine/answers": []},
    {"engine": []},
    {"engine/operations": []},
]
CONVERTERS = []
for room in ROOMS:
    for name, beside in room.items():
        MAY_INCLUDE["converters/" + name] = FORMATS + ["libblob/include"] + CONVERTERS + ["converters/" + b for b in beside]
    CONVERTERS = CONVERTERS + ["converters/" + name for name in room]
MAY_INCLUDE["converters/export/sofa_plugin/src/LumenSofa"] = ["libblob/include", "formats/container", "formats/view"]
MAY_INCLUDE["converters/export/sofa_plugin/tests"] = []

# The viewer and the command line stand beside one another on the engine; only the list of commands names both.
# The C interface of the engine.
MAY_INCLUDE["converters/api/include/lumen"] = []
MAY_INCLUDE["converters/api"] = FORMATS + ["libblob/include", "converters/api/include/lumen"] + CONVERTERS
MAY_INCLUDE["viewer/session/packs"] = FORMATS + ["libblob/include"] + CONVERTERS
MAY_INCLUDE["viewer/session/document"] = MAY_INCLUDE["viewer/session/packs"]
MAY_INCLUDE["viewer/session"] = MAY_INCLUDE["viewer/session/packs"] + ["viewer/session/packs", "viewer/session/document"]
MAY_INCLUDE["viewer/routes"] = MAY_INCLUDE["viewer/session"] + ["viewer/session"]
MAY_INCLUDE["viewer/server"] = MAY_INCLUDE["viewer/routes"] + ["viewer/routes"]
MAY_INCLUDE["converters/cli"] = MAY_INCLUDE["viewer/server"] + ["viewer/server"]
# The Python module stands beside them.
MAY_INCLUDE["packages/python/src"] = MAY_INCLUDE["viewer/session/packs"] + ["libblob/wire"]
MAY_INCLUDE["packages/python/lumen"] = []

# The rooms of the page from the bottom up. A room may import all before its own; those of one list do not know each other.
PAGE = "viewer/page/src"
PAGE_ROOMS = [["base"], ["case"], ["drawing", "net"], ["model"], ["overlay"], ["slices", "scene"], ["tools"], ["panels"], ["updates"]]
below = []
for rooms in PAGE_ROOMS:
    MAY_INCLUDE.update({f"{PAGE}/{room}": below for room in rooms})
    below = below + [f"{PAGE}/{room}" for room in rooms]
MAY_INCLUDE[PAGE] = below


def sources():
    """Every C, C++ or TypeScript file of the product, and those of the Python package, relative to the root."""
    for top in ("formats", "libblob/include", "libblob/src", "libblob/cuda", "libblob/wire", "converters", "viewer/session", "viewer/routes", "viewer/server",
                "packages/python/src", PAGE):
        yield from (p.relative_to(ROOT) for p in sorted((ROOT / top).rglob("*")) if p.suffix in (".h", ".cpp", ".c", ".ts"))
    yield from (p.relative_to(ROOT) for p in sorted((ROOT / "packages/python/lumen").glob("*.py")))


def python_modules(text):
    """Modules beside it that a module of the Python package imports, wherever it does so."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            yield from [node.module] if node.module else (alias.name for alias in node.names)


def named(file, text):
    """The names of files that a file includes or imports."""
    if file.suffix == ".py": return [f"{module}.py" for module in python_modules(text)]
    if file.suffix == ".ts": return [f"{name}.ts" for name in re.findall(r'(?:\bfrom|\bimport)[ (]"(\.[^"]+)"', text)]
    return re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.M)


def resolve(file, name, files):
    """The file that an include or import names, or None for one of another project."""
    for base in (pathlib.Path(), file.parent, pathlib.Path("libblob/src"), pathlib.Path("libblob/include"), pathlib.Path("formats/include"), pathlib.Path("converters/api/include")):
        found = pathlib.Path(os.path.normpath(base / name))
        if found in files: return found
    return None


# Folders that know the command line. A message below them names a field of its options by their word (base/field_word.h).
KNOW_OPTIONS = ("converters/engine", "converters/cli", "viewer/routes", "viewer/server")
# Folders that work on values: they know no file, no text of an option and no JSON.
ON_VALUES = "converters/operations/"
FILES_AND_TEXTS = re.compile(r'#\s*include\s+[<"](filesystem|fstream|nlohmann/.*|converters/base/(?:files|options/option_name|options/option_table)\.h)[>"]')
# A character, or a string as the group.
LITERAL = re.compile(r"""'(?:[^'\\\n]|\\.)'|"((?:[^"\\\n]|\\.)*)\"""")


def options_spelled(text):
    """Options in string literals, and dashes at their ends, which a name follows: calls upwards that no include shows.

    A literal that is a command of curl holds options of curl, so it is passed over."""
    strings = LITERAL.findall(re.sub(r"//[^\n]*", "", text))
    found = (re.search(r"--[a-z][a-z-]+|(?<=[^-])--$", string) for string in strings if not string.lstrip().startswith("curl "))
    return [option.group() for option in found if option]


def unknown_fields(text):
    """Fields that messages name, field("edge") or word("edge"), and that no row of an option is called."""
    rows = set(re.findall(r'\b(?:add|flag|file|choice|scaled|add\w*Choice)\(\s*(?:table,\s*)?"([a-z][a-z-]*)"', "\n".join(text.values())))
    rows |= set(re.findall(r'OptionName \w+{"([a-z-]+)"}', "\n".join(text.values())))
    return [f"{file} names the field {name}, and no option is called so"
            for file in sorted(text) if file.parts[0] == "converters" for name in re.findall(r'\b(?:field|word|fieldWord)\(\s*"([a-z][a-z-]*)"', text[file]) if name not in rows]


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


def forgotten_tests():
    """Sources of unit tests that no list of CMake names, in folders that no list takes whole: nobody would compile them."""
    lists = "\n".join(file.read_text() for pattern in ("CMakeLists.txt", "*.cmake") for file in (ROOT / "tests").rglob(pattern))
    return [f"{file.relative_to(ROOT)} is in no list of CMake, so that its tests do not run"
            for file in sorted((ROOT / "tests/unit").rglob("*_test.cpp"))
            if not re.search(rf"/{re.escape(file.name)}\b", lists) and not re.search(rf"FOLDER {file.parent.name}\b", lists)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", action="store_true", help="the folders, their sizes and what they include")
    options = parser.parse_args()
    files = set(sources())
    text = {file: (ROOT / file).read_text() for file in files}
    arrows = {file: sorted({other for name in named(file, text[file])
                            if (other := resolve(file, name, files)) and other != file}) for file in sorted(files)}
    folder = lambda file: file.parent.as_posix()
    wrong = [f"{file} includes {other}, which is not below it" for file in arrows for other in arrows[file]
             if folder(file) != folder(other) and folder(other) not in MAY_INCLUDE.get(folder(file), [])]
    wrong += [f"{file}: its folder is not in the list of this script" for file in arrows if folder(file) not in MAY_INCLUDE]
    wrong += ["cycle: " + " -> ".join(map(str, cycle)) for cycle in cycles(arrows)]
    for file in sorted(files):
        spelled = [] if file.as_posix().startswith(KNOW_OPTIONS) or file.suffix in (".ts", ".py") else options_spelled(text[file])
        if spelled:
            wrong.append(f"{file} spells {spelled[0]} in a string; base/field_word.h names a field, base/options/option_name.h the option of a command")
        if file.as_posix().startswith(ON_VALUES):
            wrong += [f"{file} includes {name}, though it works on values alone" for name in FILES_AND_TEXTS.findall(text[file])]
    wrong += unknown_fields(text) + forgotten_tests()
    if options.table:
        print("| folder | files | lines | includes |\n|---|--:|--:|---|")
        for name in MAY_INCLUDE:
            inside = [f for f in files if folder(f) == name]
            below = sorted({folder(o) for f in inside for o in arrows[f]} - {name})
            print(f"| {name} | {len(inside)} | {sum(text[f].count(chr(10)) for f in inside)} | {', '.join(below)} |")
    print("\n".join(wrong) if wrong else f"{sum(map(len, arrows.values()))} includes and imports among {len(files)} files, none upwards, no cycle")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
