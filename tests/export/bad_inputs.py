#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cases that are hard to export, through every target: each is written whole, or refused in one sentence.

bad_inputs.py BATCH_LUMEN [--only TARGET...] [--cases NAME...]

Without models; of one node; with a loop; with ends too short for a flat cut; an aneurysm alone; a forest of ten trees
(all synthetic). A folder that is written has the files that its lumen-export.json lists, to the byte; a refusal has
exit code 3, one line that names the case, and leaves nothing. Exit status: 0 all, 1 some not."""
import argparse, hashlib, json, math, pathlib, sys, tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from batch import Batch

# what must be refused whatever the target: the rest may be, with a reason
MUST_HOLD = {"forest of ten", "with a loop"}


def run(lumen, *words):
    return lumen.run(words, "/")


def made(lumen, *words):
    done = run(lumen, *words)
    if done.returncode != 0: sys.exit(f"bad_inputs.py: lumen {' '.join(map(str, words))}: {done.stderr}")


def line(first, start, step, count, radius, parent=-1):
    """Rows of SWC: `count` points from `start`, each a step further."""
    rows = []
    for i in range(count):
        place = [start[a] + i * step[a] for a in range(3)]
        rows.append(f"{first + i} 0 {place[0]} {place[1]} {place[2]} {radius} {parent}")
        parent = first + i
    return rows


def case_of(lumen, folder, name, rows):
    source = folder / f"{name}.swc"
    source.write_text("# synthetic; mm, LPS\n" + "\n".join(rows) + "\n")
    made(lumen, "convert", source, folder / f"{name}.lumen.json", "--quiet")
    return folder / f"{name}.lumen.json"


def edited(file, name, change):
    case = json.loads(file.read_text())
    change(case)
    out = file.with_name(f"{name}.lumen.json")
    out.write_text(json.dumps(case))
    return out


def ring():
    """A trunk, two ways round, of which the first goes on behind them: the second one's last node gets a link to it."""
    rows, first = line(1, [0, 0, -12], [0, 0, 1], 13, 1.0), 14
    for side in (1, -1):
        parent = 13
        for i in range(1, 16):
            angle = math.pi * i / 16
            place = (side * 8 * math.sin(angle), 0, 8 - 8 * math.cos(angle))
            rows.append(f"{first} 0 {place[0]} {place[1]} {place[2]} 1.0 {parent}")
            parent, first = first, first + 1
        if side == 1:
            onward = line(first, [0, 0, 17], [0, 0, 1], 10, 1.0, parent)
            rows, first = rows + onward, first + len(onward)
    return rows


def cases(lumen, folder):
    straight = case_of(lumen, folder, "straight", line(1, [0, 0, 0], [0, 0, 1], 20, 1.5))
    yield "without models", edited(straight, "bare", lambda case: case.pop("models"))
    yield "aneurysm only", edited(straight, "sac", lambda case: case["tree"]["branches"][0].update(kind="aneurysm"))
    one = run(lumen, "convert", write(folder / "one.swc", line(1, [0, 0, 0], [0, 0, 1], 1, 1.5)),
              folder / "one.lumen.json", "--quiet")
    if one.returncode == 0: yield "one node", folder / "one.lumen.json"
    loop = case_of(lumen, folder, "ring", ring())
    yield "with a loop", edited(loop, "loop", add_link)
    yield "short ends", case_of(lumen, folder, "short", line(1, [0, 0, 0], [0, 0, 0.4], 3, 2.0))
    trees = [row for t in range(10) for row in line(1 + 15 * t, [9 * t, 3 * t, 0], [0.1 * t, 0, 1], 15, 1 + 0.1 * t)]
    yield "forest of ten", case_of(lumen, folder, "forest", trees)


def write(file, rows):
    file.write_text("# synthetic; mm, LPS\n" + "\n".join(rows) + "\n")
    return file


def add_link(case):
    """Between the last node of the second way round and the node of another branch that is nearest to it."""
    tree = case["tree"]
    second = max(range(len(tree["branches"])), key=lambda b: tree["branches"][b]["firstNode"])
    tip = tree["branches"][second]["firstNode"] + tree["branches"][second]["nodeCount"] - 1
    others = [n for n in range(len(tree["centre"])) if tree["branch"][n] != second]
    tree["links"] = [sorted([tip, min(others, key=lambda n: math.dist(tree["centre"][n], tree["centre"][tip]))])]


def folder_faults(folder):
    manifest = folder / "lumen-export.json"
    if not manifest.exists(): return ["there is no lumen-export.json"]
    faults = []
    for file in json.loads(manifest.read_text())["files"]:
        path = folder / file["name"]
        if not path.exists() or hashlib.sha256(path.read_bytes()).hexdigest() != file["sha256"]:
            faults.append(f"{file['name']} is not what is listed")
    return faults


def try_one(lumen, target, name, case, out):
    done = run(lumen, "export", target, case, out)
    if done.returncode == 0: return "written", folder_faults(out)
    faults = []
    if name in MUST_HOLD: faults.append("it can be held, but is refused")
    if done.returncode != 3: faults.append(f"exit code {done.returncode}, expected 0 or 3")
    lines = [l for l in done.stderr.splitlines() if l.startswith("lumen: error: ")]
    if len(lines) != 1 or case.name not in lines[0]: faults.append("no one sentence that names the case")
    if out.exists(): faults.append("a folder is left")
    return f"refused: {lines[0][14:] if lines else done.stderr.strip()}", faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--cases", nargs="*", help="default: all")
    arguments = parser.parse_args()
    lumen = Batch(arguments.lumen.resolve())
    listed = json.loads(run(lumen, "export", "--list", "--json").stdout)["targets"]
    targets = arguments.only or [t["name"] for t in listed]
    failed = passed = 0
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        for name, case in cases(lumen, folder):
            if arguments.cases and name not in arguments.cases: continue
            for target in targets:
                said, faults = try_one(lumen, target, name, case, folder / f"{target}-{case.stem}")
                said = said.replace(str(folder) + "/", "")
                print(f"{name:15} {target:10} {said[:150]}" + "".join(f"\n    FAULT: {f}" for f in faults))
                failed += bool(faults)
                passed += not faults
    lumen.end()
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
