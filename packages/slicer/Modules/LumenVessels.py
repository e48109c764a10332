#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Vessels of a volume as a case, a surface, a centerline and a list of their ends; see LumenVessels.xml."""
import pathlib, sys, tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import lumen_cli
from lumen_cli.results import joined_markups, write_results


def label_options(values):
    roles = [word for text in (values["roles"] or "").split(",") if text.strip() for word in ("--role", text.strip())]
    return ["--label-map", values["labelMap"], *roles, *(["--only-labelled"] if values["onlyLabelled"] else [])]


def work(values, progress):
    with tempfile.TemporaryDirectory(prefix="lumen-") as folder:
        case = values["case"] or str(pathlib.Path(folder) / "case.lumen")
        seeds = joined_markups(values["seeds"], pathlib.Path(folder) / "seeds.mrk.json")
        options = ["--seeds", seeds, "--random-seed", values["randomSeed"]] if seeds else []
        for flag in ("seedsOnly", "onlyConnected", "dark"):
            if values[flag]: options.append({"seedsOnly": "--seeds-only", "onlyConnected": "--only-connected", "dark": "--dark"}[flag])
        if values["labelMap"]: options += label_options(values)
        elif values["roles"] or values["onlyLabelled"]: raise lumen_cli.Failure("roles and labelled vessels need a label map")
        if values["seedsOnly"] and not seeds: raise lumen_cli.Failure("tracking from seeds alone needs seeds")
        lumen_cli.run(progress, "convert", values["volume"], case, *options)
        write_results(case, values, progress)


if __name__ == "__main__":
    sys.exit(lumen_cli.main(__file__, work, 10))
