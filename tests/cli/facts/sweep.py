#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns each fact that files state (unit, axes, spacing, direction, sign, order, scale), one at a time, and compares the cases.

    sweep.py BATCH_LUMEN [--every N] [--only WORDS] [--others] [--list]

BATCH_LUMEN is the test program; `--every N` takes one file of N. A case is silently wrong if it differs from the original's
and no message states the fact; a refusal counts as stated if it holds the words that name the remedy."""
import argparse, collections, itertools, json, math, pathlib, re, sys, tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from batch import Batch
import lines, meshes, others, turned, volumes

# Shares, and mm, within which a case is the original's. Equal voxels in equal order give equal cases but for the roundings of
# headers. Where their axes run otherwise, tips and forks move by a voxel, half a mm, but most nodes do not.
Near = collections.namedtuple("Near", "length radius most mean")
EQUAL, TURNED = Near(0.002, 0.002, 0.005, 0.005), Near(0.1, 0.08, 0.3, 0.1)


class Tree:
    """Nodes of a case, and the stretches between them."""
    def __init__(self, case):
        tree = case["tree"]
        self.places, self.radii = tree["centre"], tree["radius"]
        self.stretches = [(p, i) for i, p in enumerate(tree["parent"]) if p >= 0]
        self.length = sum(math.dist(self.places[a], self.places[b]) for a, b in self.stretches)

    def nearest(self, at):
        """The displacement from `at` to the nearest place of a stretch, and the radius there."""
        best = None
        for a, b in self.stretches:
            p, q = self.places[a], self.places[b]
            along = [y - x for x, y in zip(p, q)]
            square = sum(x * x for x in along)
            t = max(0.0, min(1.0, sum((z - x) * d for x, z, d in zip(p, at, along)) / square)) if square else 0.0
            off = [x + t * d - z for x, d, z in zip(p, along, at)]
            if best is None or math.hypot(*off) < best[0]:
                best = math.hypot(*off), off, self.radii[a] + t * (self.radii[b] - self.radii[a])
        return best[1], best[2]


def difference(one, other, near):
    """How `other` differs from `one`, in words; empty if it does not."""
    if abs(other.length / one.length - 1) > near.length: return f"{other.length:.2f} mm long for {one.length:.2f}"
    for a, b in ((one, other), (other, one)):
        found = [b.nearest(p) for p in a.places]
        apart = sorted(math.hypot(*off) for off, _ in found)[len(found) * 3 // 4]
        mean = math.hypot(*(sum(off[i] for off, _ in found) / len(found) for i in range(3)))
        if apart > near.most: return f"a quarter of its nodes {apart:.2f} mm away"
        if mean > near.mean: return f"{mean:.3f} mm away on average"
        ratio = sorted(r / mine for (_, r), mine in zip(found, a.radii))[len(found) // 2]
        if abs(ratio - 1) > near.radius: return f"radii of {ratio:.3f} of those"
    return ""


class Sweep:
    def __init__(self, batch, folder):
        self.batch, self.folder, self.originals, self.counts, self.faults = batch, pathlib.Path(folder), {}, collections.Counter(), []

    def convert(self, file):
        first = next(iter(file.files))
        for name, content in file.files.items():
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_bytes(content)
        done = self.batch.run(["convert", first.partition("/")[0], "x.lumen.json", *file.options], self.folder)
        out = self.folder / "x.lumen.json"
        tree = Tree(json.loads(out.read_text())) if done.returncode == 0 else None
        for name in (*file.files, out.name): (self.folder / name).unlink(missing_ok=True)
        return done, tree

    def original(self, file):
        key = file.original.title()
        if key not in self.originals:
            done, tree = self.convert(file.original)
            if tree is None: sys.exit(f"the original {key} cannot be read: {done.stderr}")
            self.originals[key] = tree
        return self.originals[key]

    def judge(self, file, verbose):
        done, tree = self.convert(file)
        words = "\n".join(line for line in done.stderr.splitlines() if "warning" in line or "error" in line or done.returncode)
        hasWords = bool(file.words and re.search(file.words, words))
        found = difference(self.original(file), tree, TURNED if file.isTurned else EQUAL) if tree else ""
        verdict = "refused" if tree is None else "warned" if found and hasWords else "differs in silence" if found else "same"
        fault = ""
        if verdict == "differs in silence": fault = "silently wrong: " + found
        elif verdict == "warned" and file.answer != "warned": fault = "wrong, with a word: " + found
        elif verdict == "refused" and file.answer != "refused": fault = "refused: " + words.strip()[-300:]
        elif verdict == "refused" and not hasWords: fault = "refused without a way on: " + words.strip()[-300:]
        elif file.answer == "refused" and verdict != "refused": fault = "read, but should be refused"
        elif file.words and not hasWords: fault = "read without the words " + file.words
        self.counts[verdict] += 1
        if fault: self.faults.append(f"{file.title()}: {fault}")
        if verbose: print(f"{verdict:10} {file.title()} {found} {fault}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("batch")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--others", action="store_true", help="files that libraries of others write, too")
    parser.add_argument("--list", action="store_true")
    given = parser.parse_args()
    grids = turned.grids()
    made = itertools.chain(lines.all_lines(), meshes.all_meshes(), volumes.volumes(grids), others.others(grids) if given.others else ())
    files = [f for f in made if given.only in f.title()][::given.every]
    batch = Batch(given.batch)
    with tempfile.TemporaryDirectory() as folder:
        sweep = Sweep(batch, folder)
        for file in files: sweep.judge(file, given.list)
    batch.end()
    formats = collections.Counter(f.format for f in files)
    print(f"{len(files)} files ({', '.join(f'{n} {k}' for k, n in formats.items())}): " + ", ".join(f"{n} {k}" for k, n in sweep.counts.items()))
    for fault in sweep.faults: print("FAULT", fault)
    sys.exit(bool(sweep.faults) or not files)


if __name__ == "__main__": main()
