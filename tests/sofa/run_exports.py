#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exports cases as scenes of SOFA, runs them in the real engine, and measures whether the instrument stays inside.

run_exports.py --lumen LUMEN [--sofa FOLDER] [--steps N] [--case NAME|FILE ...] [--wall WALL ...]
               [--instrument KIND ...] [--plugin FILE] [--insert LABEL] [--markdown FILE] [--keep FOLDER]

A case is a phantom of lumen, which is made, tracked and fitted here, or a file; `coronary-beating` is a case with a motion,
which each record is measured against at its time. For each scene: what SOFA complained of
(errors and warnings must be none), whether a position is no number, how deep the instrument was in the wall of the case's
blended field, its radius included (at most 0.1 mm in 99 % of the records), and how far it came. Exit status: 0 all
held, 1 something did not, 77 there is no SOFA."""
import argparse, pathlib, re, subprocess, sys, tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import engine

LIMIT, SHARE = 0.1, 99  # mm, per cent


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumen", required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--sofa", help="an installed SOFA; else LUMEN_SOFA, else beside the repository")
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--case", nargs="*", default=["bifurcation", "helix", "aneurysm"])
    parser.add_argument("--wall", nargs="*", default=["mesh"])
    parser.add_argument("--instrument", nargs="*", default=["guidewire"])
    parser.add_argument("--insert")
    parser.add_argument("--plugin", nargs="*", default=[], help="further plugins, such as libLumenSofa.so")
    parser.add_argument("--markdown", help="write a table of the results")
    parser.add_argument("--keep", help="keep the folders here")
    return parser.parse_args()


def lumen(options, folder, *arguments):
    done = subprocess.run([str(options.lumen), *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0: sys.exit(f"lumen {' '.join(map(str, arguments))}: {done.stderr}")


def case_file(options, folder, name):
    if pathlib.Path(name).suffix: return pathlib.Path(name).resolve()
    made = folder / f"{name}.lumen"
    if name == "coronary-beating" and not made.exists():
        lumen(options, folder, "phantom", "coronary", "beat.nrrd", "--motion", "heart", "--phases", "6", "--seeds", "beat.json", "--quiet")
        lumen(options, folder, "convert", "beat-00.nrrd", "rest.lumen", "--seeds", "beat.json", "--quiet")
        phases = sorted(path.name for path in folder.glob("beat-*.nrrd"))
        lumen(options, folder, "motion", "rest.lumen", *phases, "--out", made.name, "--period", "0.8", "--quiet")
    if not made.exists():
        lumen(options, folder, "phantom", name, f"{name}.nrrd", "--seeds", f"{name}-seeds.json", "--quiet")
        lumen(options, folder, "convert", f"{name}.nrrd", made.name, "--seeds", f"{name}-seeds.json", "--seeds-only", "--quiet")
    return made


def depths(options, models, folder, case, times, points, tools):
    """As engine.depths(), of a case that may move."""
    if "beating" not in case.stem: return engine.depths(models(case), times, points, tools)
    found = []
    for time, place in zip(times, points):
        lumen(options, folder, "convert", case, "now.lumen", "--time", f"{time:.9g}", "--quiet")
        found.append(engine.depths(models(folder / "now.lumen"), [time], [place], tools)[0])
    return found


def check(options, sofa, model_of, folder, case, wall, instrument):
    import numpy as np
    scene_folder = folder / f"{case.stem}-{wall}-{instrument}"
    insert = ["--insert", options.insert] if options.insert else []
    lumen(options, folder, "export", "sofa", case, scene_folder.name, "--wall", wall, "--instrument", instrument,
          *insert, "--quiet")
    lines, rate = engine.run(sofa, scene_folder / "scene.scn", options.steps, options.plugin)
    problems = engine.faults(lines)
    result = {"case": case.stem, "wall": wall, "instrument": instrument, "rate": rate}
    recorded = scene_folder / "positions.txt"
    if not recorded.exists(): return dict(result, problems=problems + ["no positions were recorded"])
    times, points = engine.positions(recorded)
    text = (scene_folder / "scene.scn").read_text()
    step, period = (float(re.search(pattern, text)[1]) for pattern in (r'<Node name="root" dt="([^"]*)"', r' period="([^"]*)"'))
    if len(points) < int(options.steps * step / period): problems.append(f"{len(points)} records of {options.steps} steps")
    if not all(np.isfinite(p).all() for p in points): return dict(result, problems=problems + ["a position is no number"])
    depth = np.array(depths(options, model_of, folder, case, times, points, engine.Tools(scene_folder / "scene.scn")))
    length = float(np.linalg.norm(np.diff(points[-1], axis=0), axis=1).sum())
    result |= {"deepest": float(depth.max()), "usual": float(np.percentile(depth, SHARE)), "length": length}
    if result["usual"] > LIMIT: problems.append(f"{SHARE} % of the records reach {result['usual']:.3f} mm into the wall")
    if length < 1: problems.append(f"it came {length:.2f} mm far")
    return dict(result, problems=problems)


def row(r):
    number = lambda key, digits: f"{r[key]:.{digits}f}" if r.get(key) is not None else "-"
    return (f"| {r['case']} | {r['wall']} | {r['instrument']} | {number('length', 1)} | {number('usual', 3)} | "
            f"{number('deepest', 3)} | {number('rate', 1)} | {'; '.join(r['problems']) or 'none'} |")


def main():
    options = parse()
    sofa = engine.find_sofa(options.sofa)
    if sofa is None:
        print("skipped: no SOFA; LUMEN_SOFA names the folder of an installed one")
        return 77
    try:
        from lumen import blob
    except ImportError:
        print("skipped: the Python package lumen is missing; PYTHONPATH has its folder, BUILD/packages/python")
        return 77
    head = (f"| case | wall | instrument | inserted, mm | depth of {SHARE} %, mm | deepest, mm | steps / s | complaints |\n"
            "|---|---|---|---|---|---|---|---|")
    rows = []
    with tempfile.TemporaryDirectory() as own:
        folder = pathlib.Path(options.keep or own).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        usable = engine.usable(sofa, pathlib.Path(own) / "sofa")
        print(head)
        for name in options.case:
            case = case_file(options, folder, name)
            for wall in options.wall:
                for instrument in options.instrument:
                    rows.append(check(options, usable, blob.Model, folder, case, wall, instrument))
                    print(row(rows[-1]), flush=True)
    if options.markdown:
        pathlib.Path(options.markdown).write_text("\n".join([head] + [row(r) for r in rows]) + "\n")
    return 1 if any(r["problems"] for r in rows) else 0


if __name__ == "__main__": sys.exit(main())
