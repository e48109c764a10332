#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the modules for 3D Slicer's command-line interface as Slicer does, and holds their XML to the Execution Model.

check_slicer.py LUMEN. Exit status: 0 all held, 1 something did not."""
import importlib.util, json, math, os, pathlib, re, signal, subprocess, sys, tempfile, time, types
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from execution_model import faults_of

MODULES = pathlib.Path(__file__).resolve().parents[2] / "packages/slicer/Modules"
NAMES = ["LumenVessels", "LumenModelToCase", "LumenCaseToModel"]
SHARE = re.compile(r"<filter-progress>([0-9.]+)</filter-progress>")
failures = []


def check(holds, what):
    if holds: return
    failures.append(what)
    print(what)


def module(name, *words, lumen, folder, **more):
    # a library path as Slicer's own, which must not reach the program
    environment = {**os.environ, "LUMEN": lumen, "PYTHONHOME": "/nowhere-of-slicer"}
    command = [sys.executable, "-B", "-E", MODULES / f"{name}.py", *words]
    return subprocess.run([str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True, timeout=300, **more)


def check_xml(lumen, folder):
    for name in NAMES:
        told = module(name, "--xml", lumen=lumen, folder=folder)
        check(told.returncode == 0 and told.stdout == (MODULES / f"{name}.xml").read_text(), f"{name} --xml: {told}")
        for fault in faults_of(told.stdout): check(False, f"{name}.xml: {fault}")
    # the checker itself finds what is wrong
    good = (MODULES / "LumenVessels.xml").read_text()
    for old, new in (("<name>edge</name>", "<name>my edge</name>"), ("<channel>output</channel>", "<channel>out</channel>"),
                     ("<default>false</default>", "<default>0</default>"), ("<index>0</index>\n    </image>", "<index>1</index>\n    </image>"),
                     ("<longflag>dark</longflag>", ""), ("<longflag>dark</longflag>", "<longflag>is-dark</longflag>"), ("<image>", "<image color=\"red\">"), ("<license>Apache-2.0</license>", ""), ("<minimum>0</minimum>", "<minimum>2</minimum>")):
        check(old in good and faults_of(good.replace(old, new)), f"the checker lets {new!r} for {old!r} through")


def check_progress(text, title):
    shares = [float(share) for share in SHARE.findall(text)]
    check(len(shares) > 5 and shares == sorted(shares) and shares[-1] == 1 and shares[len(shares) // 2] < 1, f"{title}: progress is {shares}")
    lines = text.strip().splitlines()
    check(lines[0].startswith(f"<filter-start><filter-name>{title}<") and lines[-1].startswith("<filter-end>"), f"{title}: {lines[:1]} {lines[-1:]}")
    for line in lines: ElementTree.fromstring(f"<all>{line}</all>")


def points_of(path):
    return {p["label"]: p["position"] for p in json.loads(path.read_text())["markups"][0]["controlPoints"]}


def check_run(lumen, folder):
    fork = folder / "fork.nrrd"
    subprocess.run([lumen, "phantom", "bifurcation", fork, "--size", "48", "--seeds", folder / "seeds.json", "--quiet"], check=True, timeout=100)
    seeds = json.loads((folder / "seeds.json").read_text())["branches"]
    for i, branch in enumerate(seeds):  # as Slicer writes nodes: a file for each
        points = [{"id": str(k), "label": f"{k}", "position": p["position"] if isinstance(p, dict) else p} for k, p in enumerate(branch["points"])]
        (folder / f"vessel{i}.mrk.json").write_text(json.dumps({"markups": [
            {"type": "Curve", "name": branch["label"], "coordinateSystem": "LPS", "controlPoints": points}]}))
    seeded = [word for i in range(len(seeds)) for word in ("--seeds", f"vessel{i}.mrk.json")]
    made = module("LumenVessels", *seeded, "--randomSeed", "1", "--edge", "0.6r", "--surface", "wall.vtp", "--centerline", "line.vtp",
                  "--ends", "ends.mrk.json", "--case", "fork.lumen", fork, lumen=lumen, folder=folder)
    check(made.returncode == 0, f"LumenVessels: {made.stderr}")
    check_progress(made.stdout, "Vessels from volume")
    ends = points_of(folder / "ends.mrk.json")
    check({branch["label"] for branch in seeds} <= set(ends) and len(ends) == len(seeds) + 1, f"ends are {sorted(ends)}")
    back = module("LumenModelToCase", "--case", "back.lumen", "--ends", "back.mrk.json", "wall.vtp", lumen=lumen, folder=folder)
    check(back.returncode == 0, f"LumenModelToCase: {back.stderr}")
    apart = [min(math.dist(a, b) for b in points_of(folder / "back.mrk.json").values()) for a in ends.values()]
    check_labels(seeds, fork, lumen, folder)
    check(max(apart) < 2, f"ends of the case that was made of the surface lie {apart} mm from those of the volume")
    shown = module("LumenCaseToModel", "--surface", "again.vtp", "--edge=0.6r", "fork.lumen", lumen=lumen, folder=folder)
    check(shown.returncode == 0 and (folder / "again.vtp").read_bytes() == (folder / "wall.vtp").read_bytes(), f"LumenCaseToModel: {shown.stderr}")


def check_labels(seeds, fork, lumen, folder):
    """A label map names the vessels, and a role states their system."""
    subprocess.run([lumen, "check", fork, folder / "fork.lumen", "--mask", folder / "labels.nrrd", "--quiet"], check=True, timeout=100)
    made = module("LumenVessels", "--labelMap", "labels.nrrd", "--roles", "label-1=bone, 1=vein", "--onlyLabelled", "--case", "veins.lumen", fork,
                  lumen=lumen, folder=folder)
    check(made.returncode == 1 and "label-1" in made.stderr, f"a role of no label: {made.stderr}")
    made = module("LumenVessels", "--labelMap", "labels.nrrd", "--roles", "1=vein", "--onlyLabelled", "--case", "veins.lumen", fork,
                  lumen=lumen, folder=folder)
    check(made.returncode == 0, f"LumenVessels with labels: {made.stderr}")
    info = json.loads(subprocess.run([lumen, "info", folder / "veins.lumen", "--json"], capture_output=True, text=True, check=True).stdout)
    check({branch["system"] for branch in info["branches"]} == {"vein"}, f"systems of labelled vessels: {info['branches']}")
    check(not module("LumenVessels", "--labelMap", "labels.nrrd", "--roles", "1=bone, 2=bone", "--case", "bone.lumen", fork, lumen=lumen,
                     folder=folder).returncode == 0, "vessels are found where all is bone")


def check_models(folder):
    try:
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    except ImportError:
        return print("python3-vtk9 is missing: models are not opened")
    for name, array in (("wall.vtp", None), ("line.vtp", "MaximumInscribedSphereRadius")):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / name))
        reader.Update()
        data = reader.GetOutput()
        cells = data.GetNumberOfLines() if array else data.GetNumberOfPolys()
        check(cells > 0 and (array is None or data.GetPointData().HasArray(array)), f"{name}: {cells} cells")


def check_failures(lumen, folder):
    for words, message in ((["--surface", "x.vtp", "none.nrrd"], "none.nrrd"), (["--colour", "red", "fork.nrrd"], "--colour"), ([], "volume"),
                           (["--seedsOnly", "fork.nrrd"], "seeds"), (["--roles", "1=vein", "fork.nrrd"], "label map")):
        told = module("LumenVessels", *words, lumen=lumen, folder=folder)
        check(told.returncode == 1 and message in told.stderr and "Traceback" not in told.stderr, f"LumenVessels {words}: {told}")
    told = module("LumenCaseToModel", "--surface", "x.vtp", "fork.lumen", lumen="/nowhere/lumen", folder=folder)
    check(told.returncode == 1, f"without lumen: {told}")


def check_cancel(folder):
    """Slicer's Cancel kills the module; the program must not go on without it."""
    slow = folder / "slow-lumen"
    slow.write_text(f"#!/bin/sh\necho $$ > {folder}/pid\nexec sleep 60\n")
    slow.chmod(0o755)
    words = [sys.executable, "-B", MODULES / "LumenCaseToModel.py", "--surface", "x.vtp", "fork.lumen"]
    with subprocess.Popen([str(w) for w in words], cwd=folder, env={**os.environ, "LUMEN": str(slow)}, stdout=subprocess.DEVNULL) as running:
        for _ in range(200):
            if (folder / "pid").exists() and (folder / "pid").read_text().strip(): break
            time.sleep(0.1)
        running.send_signal(signal.SIGKILL)
    status = pathlib.Path(f"/proc/{(folder / 'pid').read_text().strip()}/status")
    for _ in range(100):
        if not status.exists() or "State:\tZ" in status.read_text(): return
        time.sleep(0.1)
    check(False, "lumen goes on after its module was killed")


def check_scripted(program):
    """The form hands on only parameters that the modules have."""
    stub = types.ModuleType("slicer.ScriptedLoadableModule")
    for name in ("ScriptedLoadableModule", "ScriptedLoadableModuleLogic", "ScriptedLoadableModuleWidget"): setattr(stub, name, object)
    asked = {}
    slicer = types.ModuleType("slicer")
    slicer.modules = types.SimpleNamespace(lumenvessels="LumenVessels", lumencasetomodel="LumenCaseToModel")
    slicer.cli = types.SimpleNamespace(run=lambda module, node, parameters: asked.update({module: parameters}))
    slicer.mrmlScene = types.SimpleNamespace(AddNewNodeByClass=lambda kind, name: (kind, name))
    sys.modules.update({"slicer": slicer, "slicer.ScriptedLoadableModule": stub, "qt": types.ModuleType("qt"), "ctk": types.ModuleType("ctk")})
    spec = importlib.util.spec_from_file_location("Lumen", MODULES / "Lumen/Lumen.py")
    lumen = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(lumen)
    logic = lumen.LumenLogic()
    outputs = logic.outputs("head")
    slicer.util = types.SimpleNamespace(tempDirectory=lambda: "/tmp", saveNode=lambda node, path: node == "segments")
    labels = logic.labelParameters("segments", {"aorta": "artery", "rib": lumen.AS_NAMED})
    check(labels["roles"] == "aorta=artery" and labels["labelMap"].endswith(".seg.nrrd"), f"Lumen.py hands on {labels}")
    words = subprocess.run([program, "convert", "--help"], capture_output=True, text=True, check=True).stdout
    check(all(role in words for role in lumen.ROLES), f"Lumen.py has other roles than lumen: {lumen.ROLES}")
    logic.findVessels(logic.vesselParameters("volume", ["points"], outputs, "head.lumen", True, labels=labels))
    logic.showCase("head.lumen", outputs)
    for name, parameters in asked.items():
        root = ElementTree.parse(MODULES / f"{name}.xml").getroot()
        known = {element.findtext("name") for group in root.iter("parameters") for element in group}
        check(set(parameters) <= known, f"Lumen.py hands {set(parameters) - known} to {name}")
    check(len(asked) == 2, f"Lumen.py runs {sorted(asked)}")
    try:
        logic.vesselParameters("volume", [], outputs, "", seedsOnly=True)
        check(False, "seeds alone without seeds are taken")
    except ValueError:
        pass


def main(lumen):
    lumen = str(pathlib.Path(lumen).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_xml(lumen, folder)
        check_run(lumen, folder)
        check_models(folder)
        check_failures(lumen, folder)
        check_cancel(folder)
    check_scripted(lumen)
    print(f"{len(NAMES)} modules, {len(failures)} faults")
    return 1 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) != 2: sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
