#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`lumen library build --slurm` on a Slurm of one machine, while tasks are killed and the disk fills.

check_slurm.py LUMEN [--patients 6]

Synthetic volumes as a list without ids. One volume is damaged, one row is there twice, the disk of the work is full once,
three tasks are killed, a task is put back into the queue, and the node is drained and resumed. Then every other case must
be in the library, once and whole, with the bytes that commands by hand make; the tables must name the faults; and a
further run must find nothing to do. Exit status: 0 all holds, 1 not, 77 skipped."""
import argparse, contextlib, hashlib, json, os, pathlib, random, shutil, signal, subprocess, sys, tempfile, time

sys.dont_write_bytecode = True
import slurm

DESIGNS = ("tube", "fork", "bifurcation", "stenosis", "cone", "arc")
UUID, DAY = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4", "2026-11-26"
NAMES = "input,title,synthetic,licence\n"


def must(holds, what):
    if not holds: sys.exit(f"check_slurm.py: {what}")


class Cohort:
    def __init__(self, lumen, folder, patients, environment):
        self.lumen, self.folder, self.patients, self.environment = lumen, folder, patients, environment
        self.list, self.library, self.work = folder / "list.csv", folder / "library", folder / "work"

    def run(self, *words, code=0):
        done = subprocess.run([str(w) for w in (self.lumen, *words)], env=self.environment, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        if code is not None: must(done.returncode == code, f"{' '.join(str(w) for w in words)}: {done.returncode}: {done.stdout}{done.stderr}")
        return done

    def init(self, library):
        self.run("library", "init", library, "--title", "Tubes", "--licence", "CC0-1.0", "--date", DAY, "--id", UUID)

    def draw(self):
        for k in range(self.patients):
            design = DESIGNS[k % len(DESIGNS)]
            self.run("phantom", design, self.folder / f"{k}.nii.gz", "--size", 40 + 4 * (k % 5), "--seed", k + 1, "--quiet")
        whole = (self.folder / "0.nii.gz").read_bytes()
        (self.folder / "damaged.nii.gz").write_bytes(whole[:len(whole) // 2])

    def write_list(self, *more):
        rows = [f"{k}.nii.gz,Tube {k},yes,CC0-1.0\n" for k in range(self.patients)]
        self.list.write_text(NAMES + "".join(rows) + "".join(f"{row},yes,CC0-1.0\n" for row in more))

    def build(self, *words, code=None):
        return self.run("library", "build", self.list, self.library, "--work", self.work, *words, "--json", code=code)

    def submit(self, *words):
        return json.loads(self.build("--slurm", *words, code=0).stdout)

    def status(self): return json.loads(self.build("--status", code=0).stdout)

    def result_of(self, jobs):
        """The answer of the job that collects, from its output."""
        text = (self.work / f"slurm/collect-{jobs['collect']}.txt").read_text()
        return json.loads(text[text.index("{"):text.rindex("}") + 1])


def digests(library, leave_out=()):
    return {f.relative_to(library).as_posix(): hashlib.sha256(f.read_bytes()).hexdigest()
            for f in sorted(library.rglob("*")) if f.is_file() and f.name not in leave_out}


def check_whole(cohort):
    done = cohort.run("library", "check", cohort.library, code=None)
    must(done.returncode == 0, f"the library is not whole: {done.stdout}{done.stderr}")


@contextlib.contextmanager
def small_disk(folder, megabytes):
    """A file system of that size on the folder, or None where none may be mounted."""
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "lumen-test", folder], capture_output=True).returncode == 0
    try:
        yield folder if mounted else None
    finally:
        if mounted: subprocess.run(["umount", "--lazy", folder], check=True)


def wait_running(cluster, cohort, jobs, count):
    """Tasks that are running while rows of theirs are being made."""
    def found():
        running = [name for name, state in cluster.tasks(jobs["array"]).items() if state == "RUNNING"]
        return running if len(running) >= count and cohort.status()["running"] >= count else None
    return slurm.wait_until(found, f"{count} tasks run", 300)


def full_disk(cluster, cohort):
    """Rows fail with the reason, those that were made come into the library, which stays whole."""
    cohort.work = cohort.folder / "small"
    with small_disk(cohort.work, 1) as disk:
        if disk is None:
            print("no file system can be mounted here: the full disk is left out")
        else:
            (disk / "filler").write_bytes(bytes(1 << 19))
            jobs = cohort.submit("--array", 2)
            cluster.wait_for_job(jobs["array"])
            cluster.wait_for_job(jobs["collect"])
            state = cohort.status()
            must(state["running"] == 0 and state["failed"] + state["interrupted"] > 0, f"a full disk stopped nothing: {state}")
            whys = {row["why"] for row in state["rows"] if row["why"]}
            named = [why for why in whys if "No space left" in why or str(cohort.work) in why]
            must(named, f"no row names the full disk, or a file on it: {whys}")
            check_whole(cohort)
    cohort.work = cohort.folder / "work"


def kill_tasks(cluster, cohort, jobs, count):
    """Kills tasks while they make rows, puts one back into the queue, and drains the node meanwhile."""
    killed = set()
    while len(killed) < count:
        task = next(iter(wait_running(cluster, cohort, jobs, 1)))
        cluster.try_run("scancel", "--signal=KILL", "--full", task)
        slurm.wait_until(lambda: task not in cluster.tasks(jobs["array"]), f"task {task} ends")
        killed.add(task)
    task = next(iter(wait_running(cluster, cohort, jobs, 1)))
    cluster.run("scontrol", "update", f"nodename={cluster.host}", "state=drain", "reason=test")
    cluster.run("scontrol", "requeue", task)
    slurm.wait_until(lambda: cluster.node_state().startswith("drained"), "the node is drained", 300)
    must(not any(state == "RUNNING" for state in cluster.tasks(jobs["array"]).values()), "a task runs on a drained node")
    must(cluster.tasks(jobs["collect"]), "the collection did not wait for the drained node")
    cluster.run("scontrol", "update", f"nodename={cluster.host}", "state=resume")
    return killed


def faults(cluster, cohort):
    """A list with a damaged volume and a row twice, tasks killed, a node drained."""
    cohort.write_list("damaged.nii.gz,Damaged", "0.nii.gz,Tube 0")
    jobs = cohort.submit("--array", min(1000, cohort.patients + 2))
    second = cohort.build("--slurm", code=1)
    must("still" in second.stderr and jobs["array"] in second.stderr, f"a second submission: {second.stderr}")
    kill_tasks(cluster, cohort, jobs, 3)
    cluster.wait_for_job(jobs["collect"])
    check_whole(cohort)
    rows = {row["row"]: row for row in cohort.result_of(jobs)["rows"]}
    damaged, twice = cohort.patients + 2, cohort.patients + 3
    must(rows[damaged]["end"] == "failed" and "damaged.nii.gz" in rows[damaged]["why"], f"the damaged volume: {rows[damaged]}")
    must(rows[twice]["end"] == "failed", f"the row twice: {rows[twice]}")
    gone = [row for row in rows.values() if row["end"] == "failed" and row["row"] < damaged]
    killed = ("ended before", "no process has begun it")  # a task may be killed before its row begins
    must(gone and all(any(words in row["why"] for words in killed) for row in gone), f"the killed tasks: {gone}")

    jobs = cohort.submit()
    must(jobs["to_make"] <= len(gone) + 2, f"more is made again than was killed: {jobs}")
    cluster.wait_for_job(jobs["collect"])
    rows = {row["row"]: row for row in cohort.result_of(jobs)["rows"]}
    must([r for r, row in rows.items() if row["end"] == "failed"] == [damaged, twice], f"after a further run: {rows}")
    must("line 2" in rows[twice]["why"] and rows[twice]["code"] == 3, f"the row twice: {rows[twice]}")
    check_whole(cohort)


def nothing_left(cohort):
    cohort.write_list()
    before = digests(cohort.library)
    begin = time.monotonic()
    jobs = cohort.submit()
    must(jobs["array"] is None and jobs["collect"] is None and jobs["in_library"] == cohort.patients, f"something is left to do: {jobs}")
    print(f"a run that finds nothing to do: {time.monotonic() - begin:.2f} s for {cohort.patients} rows")
    done = json.loads(cohort.build(code=0).stdout)
    must(done["kept"] == cohort.patients and done["made"] == 0, f"a local run after Slurm: {done}")
    must(digests(cohort.library) == before, "a run that finds nothing to do changed the library")
    must(not cohort.work.exists(), "the folder for work stays, with nothing left to do")


def same_by_hand(cluster, cohort):
    """Cases as `lumen convert` makes them by itself, and a library as one that no Slurm made."""
    hand = Cohort(cohort.lumen, cohort.folder, cohort.patients, cohort.environment)
    hand.library, hand.work = cohort.folder / "hand", cohort.folder / "hand.build"
    hand.init(hand.library)
    hand.build("--make-only", code=0)
    hand.build("--collect", code=0)
    names = ("record.json", "ro-crate-metadata.json", "library.json", "manifest-sha256.txt", "tagmanifest-sha256.txt", "bag-info.txt")
    must(digests(cohort.library, names) == digests(hand.library, names), "files of cases differ from those made by hand")
    case = cohort.folder / "by-hand.lumen"
    cohort.run("convert", cohort.folder / "1.nii.gz", case)
    made = {hashlib.sha256(f.read_bytes()).hexdigest() for f in cohort.library.glob("data/*/case.lumen")}
    must(len(made) == cohort.patients, "a case is there twice")
    must(hashlib.sha256(case.read_bytes()).hexdigest() in made, "lumen convert makes other bytes")

    undisturbed = Cohort(cohort.lumen, cohort.folder, cohort.patients, cohort.environment)
    undisturbed.library, undisturbed.work = cohort.folder / "undisturbed", cohort.folder / "undisturbed.build"
    undisturbed.init(undisturbed.library)
    jobs = undisturbed.submit("--array", 2)
    cluster.wait_for_job(jobs["collect"])
    must(undisturbed.result_of(jobs)["made"] == cohort.patients, "the output of the job that collects is gone")
    must(undisturbed.status()["in_library"] == cohort.patients, f"the state after all: {undisturbed.status()}")
    must(digests(undisturbed.library) == digests(hand.library), "a library by Slurm has other bytes than one by hand")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--patients", type=int, default=6)
    options = parser.parse_args()
    if reason := slurm.cannot_start():
        print(f"skipped: {reason}")
        return 77
    with slurm.Slurm() as cluster, tempfile.TemporaryDirectory(prefix="lumen-cohort-") as folder:
        environment = {**cluster.environment, "SOURCE_DATE_EPOCH": "1795305600"}
        cohort = Cohort(options.lumen.resolve(), pathlib.Path(folder), options.patients, environment)
        cohort.draw()
        cohort.write_list()
        cohort.init(cohort.library)
        full_disk(cluster, cohort)
        faults(cluster, cohort)
        nothing_left(cohort)
        same_by_hand(cluster, cohort)
    return 0


if __name__ == "__main__": sys.exit(main())
