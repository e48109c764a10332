#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants the faults of faults.py one at a time in a checkout of its own, and reports which the tests find.

    tests/mutants/plant.py                       # all, about a minute each after the first build of their programs
    tests/mutants/plant.py --only libblob        # those whose file or program has that in its name
    tests/mutants/plant.py --list                # what there is; ends with 1 if a line is not there once

The checkout, build/mutants by default, stays there with its build. Before a fault is planted its test
must pass. Ends with 0 if at most --survivors faults survive and none is stale.
"""
import argparse
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from faults import FAULTS

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS = 600  # a fault may make a test run for ever
SHOWN_LINES = 15  # of a build that fails


def run(*command, folder=ROOT, seconds=None):
    """(whether it ended with 0, its output)."""
    try:
        done = subprocess.run([*map(str, command)], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return False, f"runs longer than {seconds} s"
    return done.returncode == 0, done.stdout.decode(errors="replace")


def needed(*command, folder=ROOT):
    done, output = run(*command, folder=folder)
    if not done:
        sys.exit("plant.py: " + " ".join(map(str, command)) + "\n" + output)


class Checkout:
    """A commit with a build of its own."""

    def __init__(self, folder, commit, preset, jobs):
        self.folder, self.build, self.jobs, self.passing = folder, folder / "build" / preset, jobs, {}
        commit = subprocess.check_output(["git", "rev-parse", commit], cwd=ROOT, text=True).strip()
        if (folder / ".git").exists():
            needed("git", "checkout", "--quiet", "--force", "--detach", commit, folder=folder)
        else:
            needed("git", "worktree", "add", "--quiet", "--force", "--detach", folder, commit)
        needed("cmake", "--preset", preset, folder=folder)

    def compiles(self, target):
        return run("ninja", "-j", self.jobs, "-C", self.build, target)

    def passes(self, fault):
        """(whether the fault's cases pass, and are not none, their output)."""
        done, output = run(self.build / "tests" / fault.target, "--gtest_brief=1", f"--gtest_filter={fault.cases}",
                           folder=self.build / "tests", seconds=SECONDS)
        return done and "] 0 tests from" not in output, output

    def is_sound(self, fault):
        """Whether the fault's test passes without it."""
        key = (fault.target, fault.cases)
        if key not in self.passing:
            done, output = self.compiles(fault.target)
            if not done:
                print("\n".join(output.splitlines()[-SHOWN_LINES:]))
            self.passing[key] = done and self.passes(fault)[0]
        return self.passing[key]

    def outcome(self, fault):
        """"found", "survived", or why neither can be known."""
        path = self.folder / fault.file
        text = path.read_text() if path.exists() else ""
        if text.count(fault.before) != 1:
            return "stale"
        if not self.is_sound(fault):
            return "fails without it"
        path.write_text(text.replace(fault.before, fault.after))
        try:
            compiled, _ = self.compiles(fault.target)
            return "found" if not compiled or not self.passes(fault)[0] else "survived"
        finally:
            path.write_text(text)


def arguments():
    about, _, text = __doc__.partition("\n\n")
    parser = argparse.ArgumentParser(description=about, epilog=text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT", default="", help="faults whose file or program has this in its name")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "mutants", help="the checkout")
    parser.add_argument("--commit", default="HEAD", help="what is checked out (HEAD)")
    parser.add_argument("--preset", default="dev")
    parser.add_argument("--jobs", default="2", help="compilers at once (2)")
    parser.add_argument("--survivors", type=int, default=3, help="faults that may survive (3)")
    parser.add_argument("--list", action="store_true", help="plant nothing")
    return parser.parse_args()


def main():
    options = arguments()
    faults = [f for f in FAULTS if options.only in f.file or options.only in f.target]
    if options.list:
        stale = 0
        for fault in faults:
            path = ROOT / fault.file
            isThere = path.exists() and path.read_text().count(fault.before) == 1
            stale += not isThere
            print(f"{'there' if isThere else 'STALE':6} {fault.target:18} {fault.file}: {fault.what}")
        return 1 if stale else 0
    checkout = Checkout(options.folder.resolve(), options.commit, options.preset, options.jobs)
    outcomes = []
    for fault in faults:
        began = time.monotonic()
        outcomes.append(checkout.outcome(fault))
        print(f"{outcomes[-1]:9} {time.monotonic() - began:4.0f} s  {fault.target:18} {fault.file}: {fault.what}",
              flush=True)
    count = {name: outcomes.count(name) for name in dict.fromkeys(outcomes)}
    print(f"{len(faults)} faults: " + ", ".join(f"{n} {name}" for name, n in count.items()))
    return 0 if count.get("survived", 0) <= options.survivors and set(count) <= {"found", "survived"} else 1


if __name__ == "__main__":
    sys.exit(main())
