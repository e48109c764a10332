#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`lumen-bids` on a data set of synthetic volumes: derivatives, library, table and page, and what BIDS's validator says.

check_bids.py LUMEN [--quick] [--keep FOLDER]

Exit status: 0 all holds, 1 not. Where node or the validator (npm ci in tests/pipelines) is missing, that part is skipped."""
import argparse, csv, json, os, pathlib, shutil, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
from private_words import FOLDER, words_in

APP = HERE.parents[1] / "converters/pipelines/bids/lumen-bids"
VALIDATOR = HERE / "node_modules/bids-validator/bin/bids-validator"
VOLUMES = {"sub-01/anat/sub-01_angio": "fork", "sub-01/anat/sub-01_run-2_angio": "tube", "sub-02/ses-a/anat/sub-02_ses-a_angio": "stenosis"}
NOTE = "Synthetic angiograms of lumen phantom: a program drew them, and they are nobody's.\n"


def must(holds, what):
    if not holds: sys.exit(f"check_bids.py: {what}")


class App:
    def __init__(self, lumen, folder, volumes):
        self.lumen, self.root, self.out, self.volumes = lumen, folder / "raw", folder / "out", volumes
        self.statements = folder / "statements.json"
        self.statements.write_text(json.dumps({"synthetic": True, "anatomy": "tubes", "modality": "synthetic"}))

    def run_lumen(self, *words):
        subprocess.run([self.lumen, *(str(w) for w in words), "--quiet"], check=True, stdout=subprocess.DEVNULL)

    def draw(self):
        self.root.mkdir()
        description = {"Name": "Synthetic angiograms", "BIDSVersion": "1.8.0", "DatasetType": "raw", "License": "CC0-1.0", "Authors": ["a program", "lumen phantom"]}
        (self.root / "dataset_description.json").write_text(json.dumps(description))
        (self.root / "README").write_text(NOTE * 3)
        subjects = sorted({place.split("/")[0] for place in self.volumes})
        (self.root / "participants.tsv").write_text("participant_id\n" + "".join(f"{s}\n" for s in subjects))
        for place, design in self.volumes.items():
            file = self.root / f"{place}.nii.gz"
            file.parent.mkdir(parents=True, exist_ok=True)
            self.run_lumen("phantom", design, file, "--size", 40)

    def run(self, level, *more, code=0, out=None):
        words = [sys.executable, APP, self.root, out or self.out, level, "--lumen", self.lumen, "--licence", "CC0-1.0",
                 "--statements", self.statements, *more]
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
        must(done.returncode == code, f"{level} {more}: {done.returncode}, {done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def derivative(self, place, desc, ending):
        stem, suffix = place.rsplit("_", 1)
        return self.out / f"{stem}_desc-{desc}_{suffix}{ending}"


def is_accepted(folder, what, *ignored):
    """Whether the validator finds no error in a data set; codes in `ignored` do not count."""
    node = shutil.which("node") or shutil.which("nodejs")
    if node is None or not VALIDATOR.exists():
        print(f"skipped: {what} is not validated, as node or the validator is missing (npm ci in tests/pipelines)")
        return
    with tempfile.NamedTemporaryFile("w", suffix=".json") as config:
        json.dump({"ignore": list(ignored)}, config)
        config.flush()
        done = subprocess.run([node, VALIDATOR, folder, "--json", "--config", config.name], capture_output=True, text=True)
    errors = json.loads(done.stdout)["issues"]["errors"]
    must(not errors and done.returncode == 0, f"{what} is refused: {[(e['key'], [f['file'] and f['file'].get('relativePath') for f in e['files']]) for e in errors]}")


def makes_derivatives(app):
    said = app.run("participant", "--jobs", 2)
    count = len(app.volumes)
    must(f"{count} volumes: {count} made, 0 kept, 0 failed" in said, said)
    for place in app.volumes:
        for desc, ending in (("vessels", ".lumen"), ("vessels", ".glb"), ("vessels", ".json"), ("centerline", ".swc"), ("check", ".json"),
                             ("measures", ".tsv"), ("measures", ".json"), ("report", ".html")):
            must(app.derivative(place, desc, ending).is_file(), f"{place}: no {desc}{ending}")
        sidecar = json.loads(app.derivative(place, "vessels", ".json").read_text())
        must(sidecar["Sources"] == [f"bids:raw:{place}.nii.gz"] and len(sidecar["Inputs"]["Volume"]) == 64, f"provenance: {sidecar}")
    place, by_hand = next(iter(app.volumes)), app.root.parent / "by-hand.lumen"
    app.run_lumen("convert", app.root / f"{place}.nii.gz", by_hand)
    must(app.derivative(place, "vessels", ".lumen").read_bytes() == by_hand.read_bytes(), "lumen convert makes other bytes")


def makes_a_library(app):
    """The group of a data set without faults."""
    must("0 made, 1 kept, 0 failed" in app.run("participant"), "a second run made the case again")
    app.run("group")
    ids = [case["id"] for case in json.loads((app.out / "library/library.json").read_text())["cases"]]
    must(ids == ["sub-01-angio"], f"cases of the library: {ids}")
    app.run("list")
    rows = list(csv.DictReader((app.out / "volumes.csv").open(newline="")))
    must([row["id"] for row in rows] == ids, f"the list: {rows}")


def makes_again_only_what_changed(app):
    for file in app.out.rglob("*.json"): os.utime(file, (1, 1))
    for file in app.root.rglob("*.nii.gz"): os.utime(file)
    must("0 made, 3 kept, 0 failed" in app.run("participant"), "times of files made cases again")
    config = app.root.parent / "options.txt"
    config.write_text("inlier-rate = 0.65\n")
    must("2 volumes: 2 made" in app.run("participant", "--participant-label", "sub-01", "--config", config), "an option made nothing again")
    must("2 volumes: 2 made" in app.run("participant", "--participant-label", "01"), "an option that is gone made nothing again")
    must("1 volumes: 0 made, 1 kept" in app.run("participant", "--session-label", "a"), "a session")


def uses_label_maps(app):
    """The lumen of a case as a label map of it: its name comes back as the name of the vessel."""
    place, volume = "sub-01/anat/sub-01_run-2_angio", app.root / "sub-01/anat/sub-01_run-2_angio.nii.gz"
    maps = app.root / "derivatives/hand"
    (maps / "sub-01/anat").mkdir(parents=True)
    (maps / "dataset_description.json").write_text(json.dumps({"Name": "Labels", "BIDSVersion": "1.8.0", "DatasetType": "derivative",
                                                               "GeneratedBy": [{"Name": "lumen check"}]}))
    app.run_lumen("check", volume, app.derivative(place, "vessels", ".lumen"), "--mask", maps / "sub-01/anat/sub-01_run-2_desc-hand_dseg.nii.gz")
    table = maps / "desc-hand_dseg.tsv"  # that of all maps of the data set
    table.write_text("index\tname\trole\n1\tbasilar\tvessel\n")
    must("1 made" in app.run("participant", "--labels", maps), "a label map made nothing again")
    table.write_text("index\tname\trole\n1\tbasilar\tvein\n")
    must("1 made" in app.run("participant", "--labels", maps), "a role made nothing again")
    info = subprocess.run([app.lumen, "info", app.derivative(place, "vessels", ".lumen"), "--json"], capture_output=True, text=True, check=True)
    must("basilar" in info.stdout, "no vessel has the name of its label")
    app.run("list", "--labels", maps)
    row = list(csv.DictReader((app.out / "volumes.csv").open(newline="")))[1]
    must(row["--label-map"].endswith("_dseg.nii.gz") and pathlib.Path(row["--label-table"]).samefile(table), f"labels in the list: {row}")
    shutil.rmtree(app.root / "derivatives")
    must("1 made" in app.run("participant"), "a label map that is gone made nothing again")


def makes_the_group(app):
    damaged = app.root / "sub-03/anat/sub-03_angio.nii.gz"
    damaged.parent.mkdir(parents=True)
    damaged.write_bytes((app.root / "sub-01/anat/sub-01_angio.nii.gz").read_bytes()[:5000])
    said = app.run("participant", code=3)
    must("0 made, 3 kept, 1 failed" in said and "sub-03_angio.nii.gz" in said, f"a damaged volume: {said}")
    app.run("group", code=1)
    ids = [case["id"] for case in json.loads((app.out / "library/library.json").read_text())["cases"]]
    must(ids == ["sub-01-angio", "sub-01-run-2-angio", "sub-02-ses-a-angio"], f"cases of the library: {ids}")
    subprocess.run([app.lumen, "library", "check", app.out / "library"], check=True, stdout=subprocess.DEVNULL)
    with open(app.out / "measures.tsv", newline="") as table: rows = list(csv.DictReader(table, delimiter="\t"))
    must({row["volume"] for row in rows} == {"sub-01_angio", "sub-01_run-2_angio", "sub-02_ses-a_angio"}, "volumes of the table of measures")
    must({row["session_id"] for row in rows} == {"n/a", "ses-a"} and any(row["measure"] == "length_mm" for row in rows), "rows of the table of measures")
    page = (app.out / "quality.html").read_text()
    must(page.index("sub-03_angio") < page.index("<h2>Volumes</h2>"), "the page does not begin with the volume that failed")
    for file in (path for path in app.out.rglob("*") if path.is_file()):  # a folder's name may be somebody's
        must(file.name == "volumes.csv" or  # the list of inputs for programs on this machine
             app.root.parent.name.encode() not in file.read_bytes(), f"{file.relative_to(app.out)} names the folder of the data set")
    shutil.rmtree(damaged.parent.parent)


def sorts_outliers_first():
    sys.path.insert(0, str(APP.parent))
    from lumen_bids.quality import TITLES, page, sort_by_outliers
    usual = {name: 0.1 for name in TITLES}
    rows = [{"name": f"v{k}", "report": "r", "figures": {**usual, "length_mm": 100 + k}} for k in range(9)]
    rows[4]["figures"]["missing_share"] = 0.6
    rows[2]["figures"]["length_mm"] = 300
    found = sort_by_outliers(rows)
    must([row["name"] for row in found[:2]] == ["v2", "v4"] and found[2]["worst"] < 3.5, f"order: {[(r['name'], r['worst']) for r in found]}")
    must(page("<T>", found, [("v9", "a < b")]).count('class="outlier"') == 2, "marks of outliers")
    must("&lt;T&gt;" in page("<T>", found, []) and "a &lt; b" in page("T", found, [("v9", "a < b")]), "markup in texts")


def writes_a_list(app):
    app.run("list")
    rows = list(csv.DictReader((app.out / "volumes.csv").open(newline="")))
    must([row["id"] for row in rows] == ["sub-01-angio", "sub-01-run-2-angio", "sub-02-ses-a-angio"], f"the list: {rows}")
    must(all(pathlib.Path(row["input"]).is_file() and row["synthetic"] == "yes" for row in rows), f"the list: {rows}")


def is_valid(app):
    is_accepted(app.root, "the data set")
    is_accepted(app.out, "the folder of derivatives by itself", 45)  # 1.x of the validator expects raw data of every subject
    inside = app.root / "derivatives/lumen"
    shutil.copytree(app.out, inside)
    is_accepted(app.root, "the data set with derivatives in it")


def refuses(app):
    for words, said in ((("--participant-label", "07"), "no participant 07"), (("--suffix", "T1w"), "found no angiogram"),
                        (("--session-label", "b"), "found no angiogram")):
        must(said in app.run("participant", *words, code=3), f"{words}")
    must("is the data set itself" in app.run("participant", code=2, out=app.root), "OUT is BIDS_DIR")
    bad = app.root.parent / "bad.json"
    bad.write_text('{"patient": "x"}')
    must("found 'patient'" in app.run("group", "--statements", bad, code=3), "statements")
    (app.root / "dataset_description.json").unlink()
    must("no dataset_description.json" in app.run("participant", code=3), "no data set")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="a data set of one volume")
    parser.add_argument("--keep", type=pathlib.Path, help="copy the derivatives there, to be looked at")
    options = parser.parse_args()
    sorts_outliers_first()
    with tempfile.TemporaryDirectory(prefix=f"{FOLDER}-") as folder:
        app = App(options.lumen.resolve(), pathlib.Path(folder), dict(list(VOLUMES.items())[:1] if options.quick else VOLUMES))
        app.draw()
        whole = (makes_derivatives, makes_again_only_what_changed, uses_label_maps, makes_the_group, writes_a_list, is_valid)
        for step in (makes_derivatives, makes_a_library) if options.quick else whole: step(app)
        for file in app.out.rglob("*"):
            found = words_in(file.read_bytes()) if file.is_file() else []
            must(not found or file.name == "volumes.csv", f"{file.relative_to(app.out)} holds {found}, which the name of a folder is")
        if options.keep: shutil.copytree(app.out, options.keep)
        refuses(app)


if __name__ == "__main__": main()
