#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills `lumen library add` at any moment and looks at what is left.

check_kills.py LUMEN [--kills 200] [--seed 1]

A library is changed again and again, and each time but every fifth the process is killed (SIGKILL) after a random
part of the time that a change takes. Then the library must be, bit for bit, the one before or the one after, valid as a
reader that is not lumen's sees it; and after a change that was let end nothing else may lie beside it. Exit status: 0 so
it was, 1 not."""
import argparse, hashlib, os, pathlib, random, signal, subprocess, sys, tempfile, time

sys.dont_write_bytecode = True
import bag


def state(folder):
    """Every file below the folder, and its digest."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if not p.is_dir()):
        digest.update(f"{path.relative_to(folder)}\0{bag.sha256(path)}\n".encode())
    return digest.hexdigest()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    lumen, chance = str(options.lumen.resolve()), random.Random(options.seed)
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "1795305600"}
    failures = []
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        run = lambda *words: subprocess.run([lumen, *words, "--quiet"], cwd=work, env=environment, check=True)
        run("phantom", "stenosis", "tube.nrrd", "--size", "64", "--seeds", "tube.json")
        run("convert", "tube.nrrd", "tube.lumen", "--seeds", "tube.json")
        os.mkdir(work / "place")
        library = work / "place/library"
        run("library", "init", str(library), "--title", "Killed", "--licence", "CC0-1.0",
            "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
        add = lambda words: [lumen, "library", "add", str(library), "tube.lumen", "--synthetic", "--no-surface", "--picture", "none",
                             "--quiet", *words]
        # two that stay, so that there is something to lose
        for one in ("a", "z"): subprocess.run(add(["--id", one, "--export", "svzerod"]), cwd=work, env=environment, check=True)

        kills, before, old, spans, number = 0, 0, state(library), [], 0
        while kills < options.kills:
            number += 1
            words = ["--id", f"case-{number % 7}", "--replace", "--title", f"Number {number}", "--export", "svzerod"]
            whole = number % 5 == 1 or not spans
            begin = time.monotonic()
            process = subprocess.Popen(add(words), cwd=work, env=environment)
            if not whole:
                # anywhere in what the slowest of the last changes took
                try:
                    process.wait(chance.uniform(0, 1.05 * max(spans[-5:])))
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGKILL)
            code = process.wait()
            if code == 0: spans.append(time.monotonic() - begin)
            kills += code == -signal.SIGKILL
            if code not in (0, -signal.SIGKILL): failures.append(f"change {number} ended with {code}")
            new = state(library)
            faults = bag.library_faults(library)
            failures += [f"after change {number}: {fault}" for fault in faults]
            if code == 0 and new == old: failures.append(f"change {number} changed nothing")
            if code == -signal.SIGKILL and new == old: before += 1
            if code == -signal.SIGKILL and new != old and f'"Number {number}"' not in (library / "library.json").read_text():
                failures.append(f"after change {number} the library is neither the old nor the new one")
            if code == 0 and os.listdir(work / "place") != ["library"]:
                failures.append(f"beside the library: {os.listdir(work / 'place')}")
            old = new
            if len(failures) > 10: break
        print(f"{kills} kills: {before} left the old library, {kills - before} the new one; "
              f"{number - kills} changes ended; {len(failures)} failures")
        if kills > before == 0 or kills < options.kills: failures.append("the kills did not hit what they should")
    for failure in failures: print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
