#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How lumen library check grows with the number of cases.

scale.py LUMEN COPY_CASES [N...]

Makes libraries of N copies of one small synthetic case (by default 10, 1000 and 10000; some 20 kB each, below the folder
for temporary files, gone afterwards), and prints wall time, processor time and peak memory of a check, of one that goes
on from a whole one, and of a verification. A measurement, not a test."""
import os, pathlib, shutil, sys, tempfile, time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from batch import Program
from made import Maker


def measure(*words):
    """Seconds, processor seconds, and MB at the most, of a run that must succeed."""
    begin = time.monotonic()
    child = os.posix_spawn(words[0], [str(w) for w in words], os.environ, file_actions=[
        (os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(child, 0)
    if status: sys.exit(f"{' '.join(map(str, words))}: {status}")
    return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main():
    if len(sys.argv) < 3: sys.exit(__doc__)
    lumen, copy_cases = (str(pathlib.Path(p).resolve()) for p in sys.argv[1:3])
    counts = [int(n) for n in sys.argv[3:]] or [10, 1000, 10000]
    print("| cases | check, s | processor, s | MB at most | --resume, s | verify, s | bytes a case |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="lumen-scale-") as name:
        maker = Maker(Program(lumen), pathlib.Path(name))
        one = maker.folder / "one"
        maker.make_keys()
        maker.init(one, "One")
        maker.add(one, "a", maker.case("a"), "--no-surface", "--picture", "none")
        for count in counts:
            many, journal = maker.folder / "many", maker.folder / "checked"
            if os.spawnv(os.P_WAIT, copy_cases, [copy_cases, str(one), str(many), str(count)]): sys.exit("copy_cases failed")
            size = sum(f.stat().st_size for f in many.rglob("*") if f.is_file())
            time.sleep(4)  # what was just written is not kept in the journal
            seconds, processor, memory = measure(lumen, "library", "check", many, "--quiet")
            measure(lumen, "library", "check", many, "--quiet", "--resume", journal)
            again, _, _ = measure(lumen, "library", "check", many, "--quiet", "--resume", journal)
            maker.lumen("library", "sign", many, "--key", maker.key, "--resume", journal)
            verify, _, _ = measure(lumen, "library", "verify", many, "--key", maker.public, "--quiet", "--no-state")
            print(f"| {count} | {seconds:.2f} | {processor:.2f} | {memory:.0f} | {again:.2f} | {verify:.2f} | {size // count} |", flush=True)
            shutil.rmtree(many)
            journal.unlink()


if __name__ == "__main__":
    main()
