#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The effect of a change of each named constant by a fifth on the trees that are found without a click.

  constants.py SOURCE FOLDER [VOLUME [NAME ...]]

SOURCE is a checkout of lumen. FOLDER gets a copy of its sources, in which the numbers that are named in the code of finding and tracking
can be changed at run time, a build of `lumen` of that copy, and small phantoms; NAMEs choose some. Each constant is multiplied by 0.8
and by 1.25 (whole numbers change by one at least), alone, unless those of its source leave the case as it is when they change together.
Cases are compared with the phantom's truth. Three phantoms are tracked from clicks alone, which other code serves. VOLUME is a real one,
without a truth: the constants that decide most are tried on it, too.

What is measured stays in FOLDER/runs.jsonl, so that a run that was stopped goes on there; each phantom that is complete renews the table
FOLDER/constants.md. Its figures depend on SOURCE: another one wants another FOLDER.
"""
import copy
import hashlib
import json
import os
import re
import resource
import subprocess
import sys
import threading
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from forks import right_forks

STAGES = "converters/stages/"
PLACES = [STAGES + "finding/*", STAGES + "tracking/*", STAGES + "editing/smooth_axes.*", STAGES + "editing/correct_topology.*",
          STAGES + "editing/joined_ends.*", STAGES + "editing/inlets.*", STAGES + "editing/node_graph.*", "converters/voxels/vessel_paths.*", "converters/voxels/skeleton.h"]
LESS, MORE = 0.8, 1.25
SEEDS = (2, 3, 4)  # of other drawings of a phantom, with every constant as it is: how much chance alone changes
PHANTOMS = [(name, [name, "--size", 64]) for name in ("right-angle", "aneurysm", "kissing", "fading", "bifurcation", "companion")]
PHANTOMS += [("willis", ["willis", "--size", 96])]
PHANTOMS += [(name, [name, "--size", 64]) for name in ("dropout", "hairpin", "sac-lobes", "stenosis", "helix")]
# runs from clicks alone, which other code serves
CLICKED = [("bifurcation-clicks", ["bifurcation", "--size", 64]), ("aneurysm-clicks", ["aneurysm", "--size", 64]),
           ("right-angle-clicks", ["right-angle", "--size", 64, "--clicks", "careless"])]
LARGE = [("patient-1", ["patient", "--size", 128, "--voxel", 0.4])]
# facts of mathematics and of memory
FACTS = {"tracking/corrections.cpp:kWidthAtHalfHeight", "tracking/tracking_volume.cpp:kEdgesToVariance",
         "tracking/wall_ellipse.h:kEllipseUnknowns", "voxels/vessel_paths.h:kMostSteps", "voxels/vessel_paths.h:kAxesShift"}
ON_REAL = 30  # constants that are tried on the real volume
JOBS = 2
LONGEST = 20  # times the processor time of the unchanged run: more counts as a failure

STATEMENT = re.compile(r"^( *)((?:static |inline )*)constexpr (double|float|int|std::size_t|std::array|auto)\s+(k[A-Z][^;]*);", re.M)
TUNED = """#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

/// A constant, times the factor that LUMEN_CONSTANTS (",KEY=FACTOR,KEY=FACTOR") has for it.
template <class T> T tunedConstant(const char* key, T value) {
  const char* given = std::getenv("LUMEN_CONSTANTS");
  if (given == nullptr) return value;
  const char* at = std::strstr(given, (std::string(",") + key + "=").c_str());
  if (at == nullptr) return value;
  const double factor = std::atof(at + std::strlen(key) + 2), changed = static_cast<double>(value) * factor;
  if constexpr (std::is_integral_v<T>) {
    const T whole = static_cast<T>(std::llround(changed));
    if (value == 0 || whole != value) return whole;
    return factor < 1 ? value - 1 : value + 1;
  }
  return static_cast<T>(changed);
}
"""


def parts(text):
    """The parts of a list between commas that no bracket holds."""
    found, depth = [""], 0
    for letter in text:
        depth += (letter in "({[") - (letter in ")}]")
        if letter == "," and depth == 0: found.append("")
        else: found[-1] += letter
    return [part.strip() for part in found]


class Sources:
    """The constants of a checkout, and its copy with constants that the environment changes."""

    def __init__(self, source, folder):
        self.source, self.copy, self.values, self.derived = source, folder / "source", {}, set()
        self.kept = folder / "fixed.json"
        self.fixed = set(json.loads(self.kept.read_text())) if self.kept.exists() else set()
        listed = subprocess.run(["git", "-C", source, "ls-files", "-z"], check=True, capture_output=True, text=True).stdout
        self.files = [name for name in listed.split("\0") if name and (source / name).is_file()]
        self.tuned = [name for name in self.files if name.endswith((".h", ".cpp")) and any(Path(name).match(place) for place in PLACES)]

    def write(self):
        for name in self.files:
            data = (self.source / name).read_bytes()
            if name in self.tuned: data = self.changeable(name, data.decode()).encode()
            path = self.copy / name
            if path.exists() and path.read_bytes() == data: continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            path.chmod((self.source / name).stat().st_mode | 0o200)
        header = self.copy / "converters/tuned_constant.h"
        if not header.exists() or header.read_text() != TUNED: header.write_text(TUNED)

    def changeable(self, name, text):
        """The text of a source whose constants are read at run time."""
        short = name.removeprefix("converters/").removeprefix("stages/")

        def rewritten(match):
            indent, prefix, kind, rest = match.groups()
            declared = [re.match(r"(k\w+)\s*(\[\])?\s*(?:=\s*)?(.*)", part, re.S).groups() for part in parts(re.sub(r"//.*", "", rest))]
            for word, _, value in declared:
                self.values[f"{short}:{word}"] = " ".join(value.split())
                if re.search(r"\bk[A-Z]|numeric_limits", value): self.derived.add(f"{short}:{word}")
            if any(f"{short}:{word}" in self.fixed for word, _, _ in declared): return match.group(0)
            if kind == "auto": kind = "std::size_t"
            out = []
            for word, array, value in declared:
                tuned = lambda number, of: f'tunedConstant<{of}>("{short}:{word}", {number})'
                if value.startswith("{"):
                    of = kind if array else "int" if re.fullmatch(r"[\d, {}]+", value) else "double"
                    out.append(f"{word}{array or ''} = {{{', '.join(tuned(number, of) for number in parts(value.strip('{} ')))}}}")
                else: out.append(f"{word} = {tuned(value, kind)}")
            storage = ("inline " if name.endswith(".h") and "inline" not in prefix and (not indent or "static" in prefix) else "") + prefix
            if indent and "static" not in prefix: storage = "static " + prefix
            return f"{indent}{storage}const {kind} {', '.join(out)};"

        after = STATEMENT.sub(rewritten, text)
        return after if after == text else '#include "converters/tuned_constant.h"\n' + after

    def build(self):
        """Builds the copy; a constant that the compiler needs stays as it is."""
        settings = ["-DLUMEN_BUILD_TESTS=OFF", "-DLUMEN_BUILD_NIGHTLY=OFF"]
        while True:
            self.write()
            subprocess.run(["cmake", "--preset", "release", *settings], cwd=self.copy, check=True, capture_output=True)
            done = subprocess.run(["cmake", "--build", "build/release", "--target", "lumen", "--parallel", str(JOBS), "--", "-k", "0"],
                                  cwd=self.copy, capture_output=True, text=True, check=False)
            if done.returncode == 0: return next((self.copy / "build/release").rglob("lumen"))
            errors = [line for line in done.stdout.splitlines() if "error:" in line or "note:" in line]
            before = len(self.fixed)
            for key in self.values:
                place, word = key.split(":")
                if any(re.search(rf"\b{word}\b", line) for line in errors if place.rsplit(".", 1)[0] in line or place.endswith(".h")):
                    self.fixed.add(key)
            if len(self.fixed) == before: sys.exit("constants.py: the copy does not build\n" + done.stdout[-4000:])
            self.kept.write_text(json.dumps(sorted(self.fixed)))

    def table(self):
        """Constants that can be changed."""
        return sorted(set(self.values) - self.fixed - self.derived - FACTS)


class Runs:
    """Runs that are measured once and kept."""

    def __init__(self, lumen, folder):
        self.lumen, self.folder, self.file = lumen, folder, folder / "runs.jsonl"
        self.lock, self.kept = threading.Lock(), {}
        if self.file.exists():
            for line in self.file.read_text().splitlines():
                record = json.loads(line)
                self.kept[self.name(record)] = record

    @staticmethod
    def name(record):
        return record["volume"], record["constant"], record["factor"]

    def answer(self, *words, constants="", seconds=600):
        """The JSON answer of lumen, or None if it failed."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        done = subprocess.run([str(word) for word in (self.lumen, *words, "--threads", 1, "--json", "--quiet")], capture_output=True, text=True,
                              check=False, env={**os.environ, "LUMEN_CONSTANTS": constants}, preexec_fn=limit)
        return json.loads(done.stdout) if done.returncode == 0 else None

    @staticmethod
    def setting(constants, factor):
        return "".join(f",{constant}={factor}" for constant in constants.split() if constant != "seed")

    def all_of(self, volume, constants, factor):
        """Runs of the constants of one source. If all at once leave the case as it is, none of them is run alone."""
        together = self.of(volume, " ".join(constants), factor)
        if together.get("same"):
            for constant in constants: self.kept[volume.name, constant, factor] = together
        else:
            for constant in constants: self.of(volume, constant, factor)

    def of(self, volume, constant="", factor=1.0):
        """One run: a constant, or several with a space between them, and the factor; or "seed" and its number."""
        key = (volume.name, constant, factor)
        if key in self.kept: return self.kept[key]
        record = {"volume": volume.name, "constant": constant, "factor": factor}
        case = self.folder / f"{volume.name}.{threading.get_ident()}.lumen"
        drawn = volume.drawn(self, int(factor)) if constant == "seed" else volume
        before = os.times()
        found = self.answer(*drawn.command, drawn.file, case, constants=self.setting(constant, factor), seconds=volume.seconds)
        after = os.times()
        if found is None: record["failed"] = True
        else:
            digest = hashlib.sha256(case.read_bytes()).hexdigest()
            whole = self.kept.get((volume.name, "", 1.0))
            if whole and whole["digest"] == digest: record["same"] = True
            else: record |= {"digest": digest, "branches": found["branches"], "length": found["length_mm"], **drawn.measures(self, case)}
        if not constant:
            record["seconds"] = after.children_user - before.children_user
            case.replace(self.folder / f"{volume.name}.lumen")
        else: case.unlink(missing_ok=True)
        with self.lock:
            self.kept[key] = record
            with self.file.open("a") as file: file.write(json.dumps(record) + "\n")
        return record


class Phantom:
    """A synthetic volume; its measures against the truth."""

    def __init__(self, runs, name, options):
        self.name, self.options, self.seconds = name, options, 600
        self.draw(runs, name)
        self.seconds = int(LONGEST * runs.of(self).get("seconds", 1)) + 2

    def draw(self, runs, stem, *more):
        self.file, self.truth, seeds = (runs.folder / f"{stem}{end}" for end in (".nrrd", ".truth.lumen", ".json"))
        self.command = ["track"] + (["--seeds-only", "--seeds", seeds] if self.name.endswith("-clicks") else [])
        kept = runs.folder / f"{stem}.made.json"
        if not kept.exists():
            made = runs.answer("phantom", *self.options, *more, self.file, "--truth", self.truth, "--seeds", seeds)
            kept.write_text(json.dumps(made))
        made = json.loads(kept.read_text())
        self.voxel, self.length = made["voxel_size_mm"], made["length_mm"]

    def drawn(self, runs, seed):
        """The phantom with other noise."""
        other = copy.copy(self)
        other.draw(runs, f"{self.name}-{seed}", "--seed", seed)
        return other

    def measures(self, runs, case):
        score = runs.answer("compare", case, self.truth)
        forks, right = right_forks(runs.lumen, case, self.truth)
        return {"overlap": 100 * score["overlap"], "false": score["false_mm"], "rms": score["radius_rms_mm"] / self.voxel, "right": right,
                "forks": forks}


class Real:
    """A real volume: the length of its vessels, and the share that `lumen check` finds held."""
    command = ["convert"]

    def __init__(self, runs, file):
        self.name, self.file, self.seconds = "real", file, 3600
        self.seconds = int(LONGEST * runs.of(self).get("seconds", 1)) + 2

    def measures(self, runs, case):
        check = runs.answer("check", self.file, case)
        return {"held": 100 * check["coverage_share"]}


def change(record, whole, phantom):
    """The differences of a run from the unchanged one: points of overlap lost, false mm more, right forks lost, branches, radius."""
    if record.get("failed"): return {"failed": True, "worse": 100.0}
    if record.get("same"): return {"worse": 0.0, "same": True}
    loss = {"overlap": whole["overlap"] - record["overlap"], "false": record["false"] - whole["false"], "forks": whole["right"] - record["right"],
            "branches": record["branches"] - whole["branches"], "rms": record["rms"] - whole["rms"]}
    loss["worse"] = max(0, loss["overlap"]) + max(0, 100 * loss["false"] / phantom.length)
    return loss


class Effects:
    """Largest changes over the phantoms that are complete."""

    def __init__(self, runs, phantoms, constants):
        self.runs, self.phantoms, self.constants = runs, phantoms, constants
        self.chance = {phantom.name: [self.of(phantom, "seed", seed) for seed in SEEDS] for phantom in phantoms}

    def of(self, phantom, constant, factor):
        return change(self.runs.of(phantom, constant, factor), self.runs.of(phantom), phantom)

    def all(self, constant, factor):
        return {phantom.name: self.of(phantom, constant, factor) for phantom in self.phantoms}

    def same(self, constant):
        return all(loss.get("same") for factor in (LESS, MORE) for loss in self.all(constant, factor).values())

    def beyond_chance(self, constant, factor):
        """Phantoms on which a change costs more than every other random seed does."""
        out = []
        for name, loss in self.all(constant, factor).items():
            chance = self.chance[name]
            worse = loss["worse"] > max(0.5, *(other["worse"] for other in chance)) + 1e-9
            if worse or loss.get("forks", 0) > max(0, *(other.get("forks", 0) for other in chance)): out.append(name)
        return out

    def weight(self, constant):
        """Order: the worst place first; a fork that no other random seed costs counts as five points."""
        spared = {name: max(0, *(loss.get("forks", 0) for loss in losses)) for name, losses in self.chance.items()}
        return max(loss["worse"] + 5 * max(0, loss.get("forks", 0) - spared[name])
                   for factor in (LESS, MORE) for name, loss in self.all(constant, factor).items())

    def cell(self, constant, factor):
        """The largest of each effect, with the phantom that shows it."""
        losses = {name: loss for name, loss in self.all(constant, factor).items() if not loss.get("same")}
        failed = [name for name, loss in losses.items() if loss.get("failed")]
        if failed: return f"nothing is found: {', '.join(failed)}"
        if not losses: return "none"
        out = []
        for key, least, text in (("overlap", 0.1, "overlap {:+.1f}"), ("false", 0.1, "false {:+.1f} mm"), ("forks", 1, "forks {:+d}"),
                                 ("rms", 0.01, "radius {:+.2f}")):
            name = max(losses, key=lambda name: losses[name][key])
            value = losses[name][key]
            if value >= least: out.append(text.format(-value if key in ("overlap", "forks") else value) + f" ({name})")
        low, high = (pick(loss["branches"] for loss in losses.values()) for pick in (min, max))
        if low or high: out.append(f"branches {low:+d}" if low == high else f"branches {low:+d} to {high:+d}")
        return ", ".join(out) or "below 0.1 point"


def report(sources, effects, real_rows):
    """The Markdown of the phantoms that are complete."""
    constants = effects.constants
    none = [c for c in constants if effects.same(c)]
    decide = [c for c in constants if effects.beyond_chance(c, LESS) or effects.beyond_chance(c, MORE)]
    decide.sort(key=lambda c: (-effects.weight(c), c))
    rest = sorted(set(constants) - set(none) - set(decide))
    names = ", ".join(phantom.name for phantom in effects.phantoms)
    shown = lambda c: "`" + c.split(":")[1] + "`"
    value = lambda c: "`" + sources.values[c] + "`"
    both = lambda c: f"| {shown(c)} | {c.split(':')[0]} | {value(c)} | {effects.cell(c, LESS)} | {effects.cell(c, MORE)} |"
    lines = ["# Constants", "", f"`constants.py SOURCE FOLDER [VOLUME]`: each named number of finding and tracking without a click times {LESS} and times {MORE}, alone.",
             f"Whole numbers change by one at least; the numbers of a list change together. Phantoms ({len(effects.phantoms)}): {names}.",
             "Each cell has the largest loss over all phantoms: overlap in points, false length in mm, right forks (forks.py), the root mean square",
             "error of radii in voxels, each with the phantom that shows it, and the change of the number of branches. Three other drawings of the",
             "noise, with every constant as it is, show what chance does.", "",
             f"The sources name {len(sources.values)} numbers, of which {len(constants)} are changed here. **{len(none)}** of these leave the case of every phantom as it was to the byte.",
             f"**{len(rest)}** change cases, but cost no phantom more than any other noise does and more than 0.5 points (of overlap, or of false length in the",
             f"true one), nor a fork that no seed costs. **{len(decide)}** cost more.", ""]
    lines += ["| noise | effect |", "|--:|---|"] + [f"| {seed} | {effects.cell('seed', seed)} |" for seed in SEEDS]
    head = ["", "| constant | file | value | effect of less | effect of more |", "|---|---|---|---|---|"]
    lines += ["", "## More than chance", *head, *map(both, decide), "", "## No more than chance", *head, *map(both, rest)]
    if real_rows: lines += ["", "## A real volume", "", *real_rows]
    return "\n".join(lines) + "\n", decide + sorted(rest, key=lambda c: -effects.weight(c))


def real_table(runs, real, constants, pool):
    """Rows of the constants that decide most, on a real volume."""
    whole = runs.of(real)
    jobs = [(c, factor) for c in constants for factor in (LESS, MORE)]
    done = dict(zip(jobs, pool.map(lambda job: runs.of(real, *job), jobs)))

    def cell(record):
        if record.get("failed"): return "nothing is found"
        if record.get("same"): return "none"
        return f"{100 * (record['length'] / whole['length'] - 1):+.1f} %, held {record['held'] - whole['held']:+.1f}, branches {record['branches'] - whole['branches']:+d}"

    rows = [f"The {len(constants)} first constants on a real volume ({whole['length']:.0f} mm in {whole['branches']} branches, {whole['held']:.1f} % held by `lumen check`): change of the length, of the share that is held, in points, and of branches.",
            "", "| constant | file | effect of less | effect of more |", "|---|---|---|---|"]
    return rows + [f"| `{c.split(':')[1]}` | {c.split(':')[0]} | {cell(done[c, LESS])} | {cell(done[c, MORE])} |" for c in constants]


def main():
    source, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    volume, names = Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None, sys.argv[4:]
    folder.mkdir(parents=True, exist_ok=True)
    sources = Sources(source, folder)
    print("copy and build", flush=True)
    runs = Runs(sources.build(), folder)
    constants = sources.table()
    phantoms = [Phantom(runs, name, options) for name, options in PHANTOMS + CLICKED + LARGE if not names or name in names]
    seconds = {phantom.name: runs.of(phantom)["seconds"] for phantom in phantoms}
    count = 2 * len(constants) + len(SEEDS)
    print(f"{len(constants)} constants of {len(sources.values)}, {len(phantoms)} phantoms, {sum(seconds.values()):.1f} s each time: "
          f"{count * (sum(seconds.values()) + 0.2 * len(phantoms)) / JOBS / 60:.0f} minutes on {JOBS} free cores", flush=True)
    groups = defaultdict(list)
    for constant in constants: groups[constant.split(":")[0]].append(constant)
    jobs = [(["seed"], seed) for seed in SEEDS] + [(group, factor) for group in groups.values() for factor in (LESS, MORE)]
    text, order = "", []
    with ThreadPoolExecutor(JOBS) as pool:
        for n, phantom in enumerate(phantoms):
            begin = time.monotonic()
            list(pool.map(lambda job: runs.all_of(phantom, *job), jobs))
            print(f"{phantom.name}: {time.monotonic() - begin:.0f} s", flush=True)
            text, order = report(sources, Effects(runs, phantoms[:n + 1], constants), [])
            (folder / "constants.md").write_text(text)
        if volume:
            real = Real(runs, volume)
            for count in range(5, ON_REAL + 1, 5):
                text, _ = report(sources, Effects(runs, phantoms, constants), real_table(runs, real, order[:count], pool))
                (folder / "constants.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
