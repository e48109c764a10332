#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`lumen library build` in parts: rows that several processes make, a process that collects, states in between.

check_rows.py LUMEN

Its inputs are synthetic centerlines, which are converted in a moment. Exit status: 0 all holds, 1 not."""
import json, pathlib, signal, subprocess, sys, tempfile, time

NAMES = "input,id,title,synthetic,licence\n"


def must(holds, what):
    if not holds: sys.exit(f"check_rows.py: {what}")


class Rows:
    def __init__(self, lumen, folder, count):
        self.lumen, self.folder, self.list, self.library = lumen, folder, folder / "list.csv", folder / "lib"
        for k in range(count): self.draw(k)
        self.write_list(range(count))
        self.run("library", "init", self.library, "--title", "Trees", "--licence", "CC0-1.0")

    def draw(self, k, bend=0.02):
        nodes = [f"{i + 1} 0 {i} {bend * k * i} 0 {1.5 + 0.1 * k} {i if i else -1}" for i in range(21)]
        (self.folder / f"{k}.swc").write_text("# synthetic; mm, LPS\n" + "\n".join(nodes) + "\n")

    def write_list(self, numbers, name=lambda k: f"tree-{k}"):
        self.list.write_text(NAMES + "".join(f"{k}.swc,{name(k)},Tree {k},yes,CC0-1.0\n" for k in numbers))

    def words(self, *more): return [str(w) for w in (self.lumen, *more)]

    def run(self, *words, code=0):
        done = subprocess.run(self.words(*words), capture_output=True, text=True)
        must(done.returncode == code, f"{words}: {done.returncode}, {done.stdout}{done.stderr}")
        return done

    def build(self, *more, code=0):
        return json.loads(self.run("library", "build", self.list, self.library, "--json", *more, code=code).stdout)

    def states(self): return [row["state"] for row in self.build("--status")["rows"]]

    def ends(self, *more, code=0): return [row["end"] for row in self.build(*more, code=code)["rows"]]

    def revision(self): return json.loads((self.library / "library.json").read_text())["revision"]


def made_in_parts(rows):
    must(rows.states() == ["waiting"] * 4, f"before: {rows.states()}")
    must(rows.ends("--make-only", "--rows", "2,4") == ["made", "made"], "two rows")
    must(rows.states() == ["made", "waiting", "made", "waiting"], f"after two rows: {rows.states()}")
    must(rows.revision() == 1, "--make-only changed the library")
    must(rows.ends("--collect", code=1) == ["made", "failed", "made", "failed"], "a collection of two rows")
    must(rows.revision() == 2, "a collection is one revision")
    must(rows.states() == ["in_library", "waiting", "in_library", "waiting"], f"after a collection: {rows.states()}")
    must(rows.ends("--make-only", "--rows", "3,5") == ["made", "made"], "the other rows")
    must(rows.ends("--collect") == ["kept", "made", "kept", "made"], "a collection of the others")
    must(rows.revision() == 3 and not (rows.folder / "lib.build").exists(), "the end")
    rows.run("library", "check", rows.library)


def stays_when_resumed(rows):
    """Stands on made_in_parts()."""
    rows.draw(3, bend=0.3)
    must(rows.ends("--resume") == ["kept"] * 4, "--resume read an input")
    must(rows.ends() == ["kept", "kept", "kept", "made"], "without --resume another input made no other case")


def fails_alone(rows):
    (rows.folder / "1.swc").write_text("no numbers\n")
    must(rows.ends("--make-only", code=3) == ["made", "failed"], "a bad row")
    done = rows.build("--status")
    must(done["failed"] == 1 and "1.swc" in done["rows"][1]["why"], f"the state of a bad row: {done}")
    done = rows.build("--collect", code=3)
    must(done["failed"] == 1 and done["rows"][1]["code"] == 3 and "1.swc" in done["rows"][1]["why"], f"a collection beside a bad row: {done}")


def is_made_once_by_many(rows):
    """Processes with the same rows wait for each other, and each row is made once."""
    call = rows.words("library", "build", rows.list, rows.library, "--make-only", "--json")
    children = [subprocess.Popen(call, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    seconds = [sum(row["seconds"] > 0 for row in json.loads(child.communicate()[0])["rows"]) for child in children]
    must(all(child.returncode == 0 for child in children), "a process beside others failed")
    must(sum(seconds) == 2, f"rows that each process made: {seconds}, expected 2 together")
    must(rows.ends("--collect") == ["made"] * 2, "a collection of rows that several processes made")


def is_interrupted(rows):
    child = subprocess.Popen(rows.words("library", "build", rows.list, rows.library, "--make-only", "--quiet"))
    end = time.monotonic() + 60
    while "running" not in rows.states():
        must(time.monotonic() < end and child.poll() is None, "no row is running")
    child.send_signal(signal.SIGKILL)
    child.wait()
    states = rows.states()
    must("interrupted" in states and "running" not in states, f"after a kill: {states}")
    done = rows.build("--collect", code=1)
    whys = [row["why"] for row in done["rows"] if row["end"] == "failed"]
    must(any("ended before the case was made" in why for why in whys), f"the reason of a killed row: {whys}")
    must(all(end in ("made", "kept") for end in rows.ends()), "a run after a kill")
    rows.run("library", "check", rows.library)


def is_there_twice(rows):
    """A row without an id, twice: the case is there once, and the second row states why."""
    rows.write_list((0, 1, 0), name=lambda k: "")
    must(rows.ends("--make-only", "--rows", "2") == ["made"], "the first")
    must(rows.ends("--make-only", "--rows", "4") == ["made"], "the same in another process")
    done = rows.build("--collect", code=1)
    must([row["end"] for row in done["rows"]] == ["made", "failed", "failed"], f"ends: {done}")
    must("that of line 2" in done["rows"][2]["why"] and done["rows"][2]["code"] == 3, f"why: {done['rows'][2]}")


def is_refused(rows):
    for words, said in ((("--rows", "2,x"), "--rows: found 2,x"), (("--rows", "9"), "line 9: no row begins there"),
                        (("--make-only", "--collect"), "exclude one another"), (("--status", "--jobs", "2"), "exclude one another")):
        done = subprocess.run(rows.words("library", "build", rows.list, rows.library, *words), capture_output=True, text=True)
        must(done.returncode in (2, 3) and said in done.stderr, f"{words}: {done.returncode}, {done.stderr}")


def main():
    lumen = pathlib.Path(sys.argv[1]).resolve()
    for count, *steps in ((4, made_in_parts, stays_when_resumed), (2, fails_alone), (2, is_made_once_by_many), (2, is_interrupted),
                          (2, is_there_twice), (2, is_refused)):
        with tempfile.TemporaryDirectory() as folder:
            rows = Rows(lumen, pathlib.Path(folder), count)
            for step in steps: step(rows)


main()
