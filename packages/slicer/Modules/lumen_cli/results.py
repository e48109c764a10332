# SPDX-License-Identifier: Apache-2.0
"""Results of the modules, made of a case: a surface and a centerline as models, and the ends of vessels as a list of points."""
import json, pathlib, shutil, tempfile

from . import Failure, run


def joined_markups(files, out):
    """Writes the markups of several files of Slicer's as one, as lumen takes them. None without a file."""
    if not files: return None
    whole = None
    for file in files:
        content = json.loads(pathlib.Path(file).read_text())
        if "markups" not in content: raise Failure(f"{pathlib.Path(file).name} is no file of markups")
        for markup in content["markups"]:
            if markup.get("type") != "Fiducial": markup.setdefault("name", pathlib.Path(file).name.removesuffix(".mrk.json"))
        if whole is None: whole = content
        else: whole["markups"] += content["markups"]
    out.write_text(json.dumps(whole))
    return out


def ends_of(tree):
    """Name and position (mm, LPS) of each place where a vessel begins or ends freely."""
    parents, linked = set(tree["parent"]), {node for link in tree.get("links", []) for node in link}
    for branch in tree["branches"]:
        first, last = branch["firstNode"], branch["firstNode"] + branch["nodeCount"] - 1
        if branch["parentNode"] < 0 and first not in linked: yield branch["label"] + ", begin", tree["centre"][first]
        if last not in parents and last not in linked: yield branch["label"], tree["centre"][last]


def write_points(points, path):
    controls = [{"id": str(i + 1), "label": label, "position": position, "orientation": [-1, 0, 0, 0, -1, 0, 0, 0, 1],
                 "selected": True, "locked": False, "visibility": True, "positionStatus": "defined"}
                for i, (label, position) in enumerate(points)]
    markups = [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": controls}]
    pathlib.Path(path).write_text(json.dumps({"markups": markups}, indent=1) + "\n")


def write_results(case, values, progress):
    """The outputs that `values` ask for, of a case."""
    with tempfile.TemporaryDirectory(prefix="lumen-") as folder:
        work = pathlib.Path(folder)
        if values.get("surface"):
            options = ["--edge", values["edge"]] if values.get("edge") else []
            if values.get("thickness"): options += ["--thickness", values["thickness"]]
            if values.get("open"): options.append("--open")
            run(progress, "convert", case, values["surface"], *options)
        if values.get("centerline"):
            made = work / "made.centerline.vtp"
            run(progress, "convert", case, made)
            shutil.copy(made, values["centerline"])
        if values.get("ends"):
            text = work / "case.lumen.json"
            run(progress, "convert", case, text)
            write_points(ends_of(json.loads(text.read_text())["tree"]), values["ends"])
