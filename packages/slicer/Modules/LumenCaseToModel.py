#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A case as models and markups; see LumenCaseToModel.xml."""
import pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import lumen_cli
from lumen_cli.results import write_results


def work(values, progress):
    if not any(values[name] for name in ("surface", "centerline", "ends")): raise lumen_cli.Failure("no output is asked for")
    write_results(values["case"], values, progress)


if __name__ == "__main__":
    sys.exit(lumen_cli.main(__file__, work, 6))
