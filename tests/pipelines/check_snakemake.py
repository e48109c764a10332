#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The workflow of Snakemake on synthetic volumes: on this machine, and with --slurm also by a Slurm of one machine.

check_snakemake.py LUMEN [--slurm]

Two whole volumes and a damaged one: the library has the two, and fault.txt names the third. Nothing is run again for
other times of files, all steps of one row for another option of it. Exit status: 0 all holds, 1 not, 77 skipped."""
import json, os, pathlib, shutil, subprocess, sys, tempfile

sys.dont_write_bytecode = True
import slurm

WORKFLOW = pathlib.Path(__file__).resolve().parents[2] / "converters/pipelines/snakemake"
NAMES = "input,id,title,synthetic,licence,--inlier-rate,--accuracy\n"


def must(holds, what):
    if not holds: sys.exit(f"check_snakemake.py: {what}")


class Workflow:
    def __init__(self, lumen, folder):
        self.lumen, self.folder = lumen, folder
        for k in (1, 2):
            subprocess.run([lumen, "phantom", "fork", folder / f"{k}.nii.gz", "--size", "40", "--seed", str(k), "--quiet"], check=True,
                           stdout=subprocess.DEVNULL)
        (folder / "3.nii.gz").write_bytes((folder / "1.nii.gz").read_bytes()[:3000])
        self.write_list("")

    def write_list(self, rate):
        rows = (f"1.nii.gz,one,One,yes,CC0-1.0,{rate},\n", "2.nii.gz,two,Two,yes,CC0-1.0,,0.3\n", "3.nii.gz,three,Three,yes,CC0-1.0,,\n")
        (self.folder / "list.csv").write_text(NAMES + "".join(rows))

    def run(self, work, profile, *more, environment=None):
        """The output of Snakemake."""
        words = ["snakemake", "--snakefile", WORKFLOW / "workflow/Snakefile", "--profile", WORKFLOW / "profiles" / profile, *more,
                 "--config", "list=list.csv", "licence=CC0-1.0", f"lumen={self.lumen}", f"work={work}", f"library={work}-library"]
        done = subprocess.run([str(w) for w in words], cwd=self.folder, env=environment, capture_output=True, text=True)
        must(done.returncode == 0, f"{profile} {more}: {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
        return done.stdout + done.stderr

    def planned(self, work):
        """Rules of the jobs that a run would start."""
        text = self.run(work, "local", "--dry-run", "--quiet")
        return {line.split()[0] for line in text.splitlines() if len(line.split()) >= 2 and line.split()[1].isdigit()} - {"total"}

    def ids(self, work): return [case["id"] for case in json.loads((self.folder / f"{work}-library/library.json").read_text())["cases"]]


def on_one_machine(flow):
    flow.run("work", "local")
    must(flow.ids("work") == ["one", "two"], f"cases of the library: {flow.ids('work')}")
    must("3.nii.gz" in (flow.folder / "work/three/fault.txt").read_text(), "no fault names the damaged volume")
    for row in ("one", "two"):
        for file in ("tracked.lumen", "case.lumen", "case.glb", "check.json", "report.html"):
            must((flow.folder / "work" / row / file).stat().st_size > 0, f"{row}: no {file}")
    tracked, fitted = flow.folder / "by-hand.lumen", flow.folder / "by-hand-fitted.lumen"
    for words in (("track", flow.folder / "2.nii.gz", tracked), ("fit", tracked, fitted, "--accuracy", "0.3")):
        subprocess.run([flow.lumen, *words, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    must((flow.folder / "work/two/case.lumen").read_bytes() == fitted.read_bytes(), "lumen track and fit make other bytes")


def runs_again_only_what_changed(flow):
    for file in flow.folder.glob("*.nii.gz"): os.utime(file)
    os.utime(flow.folder / "list.csv")
    must(flow.planned("work") == set(), f"times of files run again {flow.planned('work')}")
    flow.write_list("0.65")
    must({"track", "fit", "check", "mesh", "report", "library"} <= flow.planned("work"), f"another option runs only {flow.planned('work')}")
    flow.write_list("")


def on_slurm(flow):
    with slurm.Slurm() as cluster:
        flow.run("cluster", "slurm", environment=cluster.environment)
    must(flow.ids("cluster") == ["one", "two"], f"cases of the library by Slurm: {flow.ids('cluster')}")
    for row in ("one", "two"):
        files = [(flow.folder / work / row / "case.lumen").read_bytes() for work in ("work", "cluster")]
        must(files[0] == files[1], f"{row}: Slurm makes other bytes")


def main():
    if shutil.which("snakemake") is None:
        print("skipped: no snakemake (apt install snakemake)")
        return 77
    by_slurm = "--slurm" in sys.argv
    if by_slurm and (reason := slurm.cannot_start()):
        print(f"skipped: {reason}")
        return 77
    with tempfile.TemporaryDirectory(prefix="lumen-snakemake-") as folder:
        flow = Workflow(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder))
        for step in (on_one_machine, on_slurm) if by_slurm else (on_one_machine, runs_again_only_what_changed): step(flow)
    return 0


if __name__ == "__main__": sys.exit(main())
