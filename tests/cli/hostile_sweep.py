#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hands every file of some folders to every command of lumen that takes a file, in every role.

hostile_sweep.py --lumen PROGRAM [--all] FOLDER_OR_FILE ...

Each run is judged by its exit code (0 to 4), its time (at most 2 s), its memory (that of the command for a small
good file, and 3 times the file or the volume that it holds, whichever is larger), and its output, without control
characters and addresses. A table lists the runs with a fault (--all: every run), then the slowest and the largest. Files
are read in place. Exit status: 0 no fault, 1 some."""
import argparse, collections, json, os, pathlib, re, shutil, signal, subprocess, sys, tempfile, time

SECONDS, PATIENCE = 2, 60  # a fault; a kill
TIMES, SLACK = 3, 8 << 20  # of the larger of file and volume; bytes that differ from run to run
OUTPUTS = ("out.lumen", "out.lumen.json", "out.glb", "out.stl")
SEEDS = {"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm"}

Run = collections.namedtuple("Run", "file role code seconds memory limit faults")


def measure(program, arguments, folder):
    """Exit code (negative: signal), seconds, peak memory in bytes, and all that was printed."""
    with open(folder / "said", "wb+") as said:
        begin = time.monotonic()
        child = subprocess.Popen([program, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL, stdout=said,
                                 stderr=said)
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid or time.monotonic() - begin > PATIENCE:
                break
            time.sleep(0.005)
        if not pid:
            os.kill(child.pid, signal.SIGKILL)
            _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - begin
        said.seek(0)
        return child.returncode, seconds, usage.ru_maxrss * 1024, said.read()


def roles(file, seeds, good):
    """Every way to hand over the file: a name and the arguments."""
    yield "info", ["info", file]
    yield "info --json", ["info", file, "--json"]
    yield "info --chunks", ["info", file, "--chunks"]
    yield "validate", ["validate", file, "--privacy"]
    for output in OUTPUTS:
        yield f"convert to {output[3:]}", ["convert", file, output, "--seeds", seeds]
    yield "track", ["track", file, "out.lumen", "--seeds", seeds]
    yield "fit", ["fit", file, "out.lumen"]
    yield "trim", ["trim", file, "out.lumen", "--min-length", "1"]
    yield "ends", ["ends", file, "--root", "1", "--out", "out.lumen"]
    yield "names", ["names", file, "--table", "out.csv"]
    yield "compare", ["compare", file, file]
    yield "track --seeds", ["track", good / "tube.nrrd", "out.lumen", "--seeds", file]
    yield "--config", ["info", good / "case.lumen", "--config", file]


def make_good(program, folder):
    """A small volume, its seeds and its case, and the memory that each role takes for them."""
    quiet = {"cwd": folder, "check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([program, "phantom", "tube", "tube.nrrd", "--size", "32", "--seeds", "seeds.json"], **quiet)
    subprocess.run([program, "convert", "tube.nrrd", "case.lumen", "--seeds", "seeds.json"], **quiet)
    base = collections.Counter()
    for name in ("tube.nrrd", "case.lumen", "seeds.json"):
        for role, arguments in roles(folder / name, folder / "seeds.json", folder):
            base[role] = max(base[role], measure(program, arguments, folder)[2])
    return base


def held(program, file, folder):
    """The bytes of the volume in a file, as floats, and a seed in its middle; 0 and None if it cannot be read."""
    code, _, _, said = measure(program, ["info", file, "--json", "--quiet"], folder)
    try:
        volume = json.loads(said) if code == 0 else {}
        size, spacing, origin, d = (volume[key] for key in ("size", "spacing_mm", "origin_mm", "direction"))
    except (ValueError, KeyError):
        return 0, None
    steps = [spacing[a] * (size[a] - 1) / 2 for a in range(3)]
    middle = [origin[r] + sum(d[3 * a + r] * steps[a] for a in range(3)) for r in range(3)]
    return 4 * size[0] * size[1] * size[2], middle


def seeds_for(file, middle, folder, good):
    """The file's own seeds, NAME.seeds.json, or a click in its middle, or those of the small volume."""
    own = file.parent / (file.name.split(".")[0] + ".seeds.json")
    if own.exists():
        return own
    if middle is None:
        return good / "seeds.json"
    path = folder / "seeds.json"
    path.write_text(json.dumps({**SEEDS, "branches": [{"label": "middle", "points": [middle], "radius": 1}]}))
    return path


def faults_of(code, seconds, memory, limit, said):
    """Faults of a run: its exit code, its time, its memory and its output."""
    faults = []
    if code < 0:
        faults.append("killed after %d s" % PATIENCE if seconds > PATIENCE else f"signal {-code}")
    elif code > 4:
        faults.append(f"exit {code}")
    if seconds > SECONDS:
        faults.append("slow")
    if memory > limit:
        faults.append("memory")
    if re.search(rb"[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xaa-\xae]", said):
        faults.append("control characters")
    if re.search(rb"0x[0-9a-f]{9,}", said):
        faults.append("an address")
    if b"unexpected: " in said:
        faults.append("an unexpected exception")
    return faults


def sweep(program, file, base, scratch, good):
    """Every role of one file."""
    volume, middle = held(program, file, scratch)
    seeds = seeds_for(file, middle, scratch, good)
    larger = max(file.stat().st_size, volume)
    for role, arguments in roles(file, seeds, good):
        for output in OUTPUTS:
            (scratch / output).unlink(missing_ok=True)
        code, seconds, memory, said = measure(program, arguments, scratch)
        limit = base[role] + TIMES * larger + SLACK
        yield Run(file.name, role, code, seconds, memory, limit, faults_of(code, seconds, memory, limit, said))


def line(run):
    return (f"{run.file:36.36} {run.role:22} {run.code:4} {run.seconds:7.2f} {run.memory / 2**20:8.1f} "
            f"{run.limit / 2**20:8.1f}  {', '.join(run.faults)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumen", required=True, type=pathlib.Path)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("paths", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    files = sorted(f.resolve() for p in options.paths for f in ([p] if p.is_file() else p.rglob("*")) if f.is_file())
    program = options.lumen.resolve()
    top = pathlib.Path(tempfile.mkdtemp(prefix="lumen-sweep-"))
    scratch, good = top / "scratch", top / "good"
    scratch.mkdir(), good.mkdir()
    print(f"{'file':36} {'role':22} exit seconds   MiB of limit")
    runs = []
    try:
        base = make_good(program, good)
        for file in files:
            for run in sweep(program, file, base, scratch, good):
                runs.append(run)
                if run.faults or options.all:
                    print(line(run), flush=True)
    finally:
        shutil.rmtree(top)
    bad = [run for run in runs if run.faults]
    print(f"\n{len(files)} files, {len(runs)} runs, {len(bad)} with a fault; exit codes: "
          + ", ".join(f"{code}: {n}" for code, n in sorted(collections.Counter(r.code for r in runs).items())))
    print("slowest:\n" + "\n".join(line(r) for r in sorted(runs, key=lambda r: -r.seconds)[:3]))
    print("largest share of its limit:\n" + "\n".join(line(r) for r in sorted(runs, key=lambda r: -r.memory / r.limit)[:3]))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
