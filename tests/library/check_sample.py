#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`lumen library sample`: ten synthetic patients with two exports each, by one command.

check_sample.py LUMEN [--keep FOLDER]

Exit status: 0 all holds, 1 not."""
import argparse, json, pathlib, subprocess, sys, tempfile


def must(holds, what):
    if not holds: sys.exit(f"check_sample.py: {what}")


def run(lumen, *words):
    done = subprocess.run([str(lumen), "library", *(str(w) for w in words)], capture_output=True, text=True)
    must(done.returncode == 0, f"lumen library {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def look_at(case, folder):
    record = json.loads((folder / "record.json").read_text())
    must(record["synthetic"] and record["licence"] == "CC0-1.0" and record["modality"] == "synthetic", f"{case['id']}: what it says of itself")
    figures = record["figures"]
    must(figures["branches"] >= 10 and figures["length_mm"] > 100, f"{case['id']}: {figures}")
    must(figures["reachable_mm"] > 0.95 * figures["length_mm"], f"{case['id']}: only {figures['reachable_mm']} mm can be reached")
    roles = [file["role"] for file in record["files"]]
    targets = {file["target"] for file in record["files"] if file["role"] == "export"}
    must(len(targets) == 2, f"{case['id']}: exports: {targets}")
    must(roles.count("case") == 1 and "surface" in roles and "picture" in roles, f"{case['id']}: {roles}")
    for target in targets:
        must((folder / "exports" / target / "lumen-export.json").is_file(), f"{case['id']}: {target}")
    must(record["insertions"] and record["ends"], f"{case['id']}: nowhere to go in")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lumen")
    parser.add_argument("--keep")
    options = parser.parse_args()
    lumen = pathlib.Path(options.lumen).resolve()
    with tempfile.TemporaryDirectory() as folder:
        library = pathlib.Path(options.keep or folder) / "patients"
        answer = json.loads(run(lumen, "sample", library, "--jobs", 2, "--json"))
        must(answer["made"] == 10 and answer["failed"] == 0, f"made: {answer}")
        run(lumen, "check", library)
        cases = json.loads((library / "library.json").read_text())["cases"]
        must(len(cases) == 10, f"{len(cases)} cases")
        for case in cases: look_at(case, library / "data" / case["id"])
        must(len({(library / "data" / c["id"] / "case.lumen").read_bytes() for c in cases}) == 10, "two patients are alike")
        run(lumen, "index", library)
        must((library / "index.html").is_file(), "no page")
        run(lumen, "check", library)


main()
