#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which way includes go, and that strings do not go the other way: see docs/architecture.md.

check_includes.py [--table]

Prints every include that runs from a folder to one above it, and every cycle of files; with --table also
the folders with their lines, files and the folders that they include. Exit status: 0 neither, 1 some."""
import argparse, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Folders that each folder may include besides itself, from the bottom up. A folder that is not here may not exist.
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

# The rooms of the converters from the bottom up. A folder may include the formats, libblob's header, all folders of the
# rooms before its own, and in its own room those that are named beside it.
ROOMS = [
    {"base": []},
    {"geometry": []},
    {"voxels": []},
    {"io/content": [], "io/vtk": [], "io/volume": [], "io/mesh": ["io/vtk"], "io/seeds": ["io/volume"],
     "io/centerline": ["io/seeds", "io/vtk", "io/volume"]},
    {"stages/finding": [], "stages/tracking": [], "stages/fitting": [], "stages/editing": ["stages/fitting"], "stages/repair": [],
     "stages/surface": [], "stages/surface/patches": ["stages/surface"],
     "stages/trees_from_surfaces": ["stages/repair"], "stages/phantom": []},
    {"judge/compare": [], "judge/check": []},
    {"judge/facts": []},
    {"draw/raster": [], "draw/overlay": ["draw/raster"], "draw/picture": ["draw/raster"],
     "draw/report": ["draw/overlay", "draw/raster"]},
    {"export/shared": []},
    {"export/targets/" + name: [] for name in ("cathsim", "engines", "grid", "isaac", "mujoco", "oned", "openfoam", "print",
                                               "simvascular", "slicer", "sofa", "steve", "svzerod")},
    {"export": []},
    {"library": [], "library/site": ["library"]},
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
MAY_INCLUDE["viewer/session"] = FORMATS + ["libblob/include"] + CONVERTERS
MAY_INCLUDE["viewer/server"] = MAY_INCLUDE["viewer/session"] + ["viewer/session"]
MAY_INCLUDE["converters/cli"] = MAY_INCLUDE["viewer/server"] + ["viewer/server"]


def sources():
    """Every C or C++ file of the product, relative to the root."""
    for top in ("formats", "libblob/include", "libblob/src", "converters", "viewer/session", "viewer/server"):
        yield from (p.relative_to(ROOT) for p in sorted((ROOT / top).rglob("*")) if p.suffix in (".h", ".cpp", ".c"))


def resolve(file, name, files):
    """The file that an include names, or None for one of another project."""
    for base in (pathlib.Path(), file.parent, pathlib.Path("libblob/src"), pathlib.Path("libblob/include")):
        if base / name in files: return base / name
    return None


# Folders that know the command line. Below them a message names an option without dashes, as its row does.
KNOW_OPTIONS = ("converters/engine", "converters/cli", "viewer/server")
# Files below that still spell options with their dashes: a list that only gets shorter.
SPELL_OPTIONS = """
converters/draw/picture/draw_case.cpp
converters/draw/report/report_agreement.cpp
converters/draw/report/report_page.cpp
converters/draw/report/report_provenance.cpp
converters/export/export_case.cpp
converters/export/shared/distance_grid.cpp
converters/export/shared/insertion.cpp
converters/export/shared/no_vdb.cpp
converters/export/shared/volume_mesh.cpp
converters/export/targets/cathsim/export_cathsim.cpp
converters/export/targets/engines/engines.cpp
converters/export/targets/grid/grid.cpp
converters/export/targets/isaac/isaac.cpp
converters/export/targets/mujoco/export_mujoco.cpp
converters/export/targets/openfoam/openfoam.cpp
converters/export/targets/print/print.cpp
converters/export/targets/simvascular/simvascular.cpp
converters/export/targets/slicer/slicer.cpp
converters/export/targets/sofa/export_sofa.cpp
converters/export/targets/steve/steve.cpp
converters/io/centerline/patient_space.cpp
converters/io/centerline/read_curves.cpp
converters/io/content/file_content.cpp
converters/io/mesh/write_gltf.cpp
converters/io/seeds/place_seeds.cpp
converters/io/seeds/seeds_fcsv.cpp
converters/io/seeds/seeds_json.cpp
converters/io/seeds/seeds_markups.cpp
converters/io/seeds/seeds_parse.cpp
converters/io/volume/detached_data.cpp
converters/io/volume/dicom_folder.cpp
converters/io/volume/meta_header.cpp
converters/io/volume/nifti_file.cpp
converters/io/volume/nifti_geometry.cpp
converters/io/volume/nrrd_geometry.cpp
converters/io/volume/read_dicom.cpp
converters/io/volume/read_volume.cpp
converters/io/volume/stated_geometry.cpp
converters/io/volume/volume_checks.cpp
converters/judge/check/check.cpp
converters/judge/facts/reachable.cpp
converters/library/build_list.cpp
converters/library/change.cpp
converters/library/check_journal.cpp
converters/library/record_names.cpp
converters/library/site/case_files.cpp
converters/library/site/notes.cpp
converters/library/verified_revisions.cpp
converters/stages/phantom/phantom.cpp
converters/stages/phantom/scene.cpp
converters/stages/tracking/node_fit.cpp
converters/stages/tracking/tracking_volume.cpp
""".split()


def options_spelled(text):
    """String literals with an option in them: a call upwards that no include shows."""
    code = re.sub(r"//[^\n]*", "", text)
    return re.findall(r'"(?:[^"\\\n]|\\.)*?(--[a-z][a-z-]+)(?:[^"\\\n]|\\.)*"', code)


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
    for file in sorted(files):
        spelled = [] if file.as_posix().startswith(KNOW_OPTIONS) else options_spelled(text[file])
        if spelled and file.as_posix() not in SPELL_OPTIONS:
            wrong.append(f"{file} names {spelled[0]} in a string; below the engine options are named without dashes")
        if not spelled and file.as_posix() in SPELL_OPTIONS:
            wrong.append(f"{file} names no option any more; it leaves the list of this script")
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
