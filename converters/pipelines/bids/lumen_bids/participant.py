# SPDX-License-Identifier: Apache-2.0
"""The level participant: derivatives of each volume, by commands of lumen."""
import concurrent.futures
import csv
import io
import json
import os
import pathlib
import sys
import tempfile

from .dataset import label_table
from .describe import case_sidecar, measure_columns
from .errors import FAILED, INVALID_INPUT, Fault
from .files import digest, digest_of, write_json, write_text

# files of every volume: (desc, ending)
CASE, MESH = ("vessels", ".lumen"), ("vessels", ".glb")
CENTERLINE, CHECK = ("centerline", ".swc"), ("check", ".json")
MEASURES, REPORT = ("measures", ".tsv"), ("report", ".html")
SIDECAR, FAULT = ("vessels", ".json"), ("fault", ".json")
KINDS = (CASE, MESH, CENTERLINE, CHECK, MEASURES, REPORT)


class Recipe:
    """All that the derivatives of a volume come from, as digests."""

    def __init__(self, volume, options, program):
        table = label_table(volume.labels) if volume.labels else None
        self.parts = {
            "Lumen": program.version,
            "Volume": digest(volume.file),
            "LabelMap": digest(volume.labels) if volume.labels else None,
            "LabelTable": digest(table) if table else None,
            "Options": digest(options.config) if options.config else None,
            "Exports": sorted(options.export)}
        self.digest = digest_of(self.parts)


def is_made(volume, out, recipe, options):
    """Whether all derivatives are there, made of these inputs by this version."""
    try:
        sidecar = json.loads(volume.derivative(out, *SIDECAR).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    files = [volume.derivative(out, *kind) for kind in KINDS]
    files += [volume.derivative(out, target, "") for target in options.export]
    return sidecar.get("RecipeSHA256") == recipe.digest and all(f.exists() for f in files)


class Maker:
    """Makes the derivatives of one volume; each file appears whole, the sidecar last."""

    def __init__(self, volume, out, options, program):
        self.volume, self.out, self.options, self.program = volume, out, options, program
        self.log = pathlib.Path(out) / "logs" / f"{volume.name}.txt"

    def file(self, kind):
        return self.volume.derivative(self.out, *kind)

    def lumen(self, *words):
        return self.program.run(*words, log=self.log)

    def make(self, recipe):
        self.file(CASE).parent.mkdir(parents=True, exist_ok=True)
        self.log.parent.mkdir(parents=True, exist_ok=True)
        self.log.unlink(missing_ok=True)
        self.file(SIDECAR).unlink(missing_ok=True)
        self.convert()
        case, volume = self.file(CASE), self.volume.file
        write_text(self.lumen("check", volume, case, "--json"), self.file(CHECK))
        self.lumen("convert", case, self.file(MESH))
        self.lumen("convert", case, self.file(CENTERLINE))
        self.measure()
        for target in self.options.export:
            self.export(target)
        self.lumen("report", case, self.file(REPORT), "--volume", volume,
                   "--title", self.volume.name)
        write_json(case_sidecar(self.volume, recipe, self.program.version), self.file(SIDECAR))
        self.file(FAULT).unlink(missing_ok=True)

    def convert(self):
        words = ["convert", self.volume.file, self.file(CASE)]
        if self.options.config:
            words += ["--config", self.options.config]
        if self.volume.labels:
            words += ["--label-map", self.volume.labels]
            if table := label_table(self.volume.labels):
                words += ["--label-table", table]
        self.lumen(*words)

    def export(self, target):
        folder = self.volume.derivative(self.out, target, "")
        if folder.is_dir():
            for path in sorted(folder.rglob("*"), reverse=True):
                path.rmdir() if path.is_dir() else path.unlink()
        self.lumen("export", target, self.file(CASE), folder)

    def measure(self):
        """lumen's comma-separated rows as the tab-separated table of BIDS."""
        with tempfile.TemporaryDirectory() as folder:
            rows = pathlib.Path(folder) / "measures.csv"
            self.lumen("measure", self.file(CASE), "--out", rows)
            with open(rows, encoding="utf-8", newline="") as text:
                table = [[cell or "n/a" for cell in row[1:]] for row in csv.reader(text)]
        out = io.StringIO()
        csv.writer(out, delimiter="\t", lineterminator="\n").writerows(table)
        write_text(out.getvalue(), self.file(MEASURES))
        write_json(measure_columns(), self.file(MEASURES).with_suffix(".json"))


def make_one(volume, out, options, program):
    """"made", "kept" or "failed", and why. A volume that fails leaves a file that states it."""
    fault = volume.derivative(out, *FAULT)
    try:
        recipe = Recipe(volume, options, program)
        if is_made(volume, out, recipe, options):
            return "kept", None
        Maker(volume, out, options, program).make(recipe)
        return "made", None
    except Fault as error:
        state = {"Source": volume.place, "Why": str(error), "Code": error.code}
    except OSError as error:
        state = {"Source": volume.place, "Why": f"{error.filename}: {error.strerror}",
                 "Code": FAILED}
    state["Why"] = program.without_folders(state["Why"])
    try:
        write_json(state, fault)
    except Fault as error:
        print(f"lumen-bids: {error}", file=sys.stderr)
    return "failed", state


def run(volumes, out, options, program):
    """Makes all volumes; returns the exit code."""
    counts, codes = {"made": 0, "kept": 0, "failed": 0}, set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        work = {pool.submit(make_one, v, out, options, program): v for v in volumes}
        for done in concurrent.futures.as_completed(work):
            end, why = done.result()
            counts[end] += 1
            if why:
                codes.add(why["Code"])
                print(f"lumen-bids: {work[done].place}: {why['Why']}", file=sys.stderr)
    print(f"{os.fspath(out)}: {len(volumes)} volumes: {counts['made']} made, "
          f"{counts['kept']} kept, {counts['failed']} failed")
    if not codes:
        return 0
    return INVALID_INPUT if codes == {INVALID_INPUT} else FAILED
