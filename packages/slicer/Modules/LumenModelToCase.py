#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A surface model of vessels as a case; see LumenModelToCase.xml."""
import pathlib, sys, tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import lumen_cli
from lumen_cli.results import joined_markups, write_results


def work(values, progress):
    with tempfile.TemporaryDirectory(prefix="lumen-") as folder:
        case = values["case"] or str(pathlib.Path(folder) / "case.lumen")
        curves = joined_markups(values["curves"], pathlib.Path(folder) / "curves.mrk.json")
        lumen_cli.run(progress, "convert", values["model"], case, *(["--centerline", curves] if curves else []))
        write_results(case, values, progress)


if __name__ == "__main__":
    sys.exit(lumen_cli.main(__file__, work, 11))
