#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of docs/mistakes and compares what lumen says with what the pages say.

run.py --lumen PROGRAM --batch BATCH_LUMEN [--fix] [--at-least N] [PAGE.md ...]

Every fenced block "console" has entries with blank lines between them: a comment, and commands ("$ lumen ..."), each
followed by all that it prints and by "exit CODE". Each entry has a folder of its own, with the files (see fixtures.py)
whose names its commands mention; the commands are run there without the rights of a privileged user, those that need a
shell by bash. Lines of progress ("reading: done in 0.1 s") are left out. A command that fails must leave every file as it
was and no temporary file behind. --fix writes what the program says into the pages, to be read with git diff. Exit
status: 0 all as written, 1 not."""
import argparse, ctypes, difflib, hashlib, os, pathlib, re, shlex, shutil, subprocess, sys, tempfile

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import fixtures
from batch import Batch, Run

PAGES = pathlib.Path(__file__).resolve().parents[3] / "docs" / "mistakes"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)
PROGRESS = re.compile(r"^.*: done in [^\n]*\n", re.M)
OF_A_SHELL = re.compile(r"[|&;<>$`]")
EXIT_CODES = (0, 1, 2, 3, 4, 130)
SECONDS = 20
PR_CAPBSET_DROP, OVERRIDE, READ_SEARCH = 24, 1, 2


def as_a_user():
    """Takes from a privileged process what would let it read and write everything."""
    for capability in (OVERRIDE, READ_SEARCH):
        ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)


def state(folder):
    """A digest of every file in the folder, by name."""
    digests = {}
    for path in sorted(folder.rglob("*")):
        readable = path.is_file() and os.access(path, os.R_OK)
        digests[str(path.relative_to(folder))] = hashlib.sha256(path.read_bytes()).hexdigest() if readable else ""
    return digests


class Player:
    """Commands run in folders below `scratch`."""
    def __init__(self, lumen, batch, scratch):
        self.scratch = scratch
        self.environment = {"PATH": f"{lumen.parent}:/usr/bin:/bin", "HOME": str(scratch), "LC_ALL": "C.UTF-8"}
        self.batch = Batch(batch, seconds=SECONDS, env=self.environment, preexec_fn=as_a_user)
        self.store = fixtures.Store(scratch / "fixtures", lambda words, folder: self.batch.run(words, folder, merged=True))

    def ran(self, command, folder):
        if command.startswith("lumen ") and not OF_A_SHELL.search(command):
            return self.batch.run(shlex.split(command)[1:], folder, merged=True)
        words = ["timeout", "-s", "KILL", str(SECONDS), "bash", "-o", "pipefail", "-c", command]
        done = subprocess.run(words, cwd=folder, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, preexec_fn=as_a_user)
        return Run(done.returncode, done.stdout.decode("utf-8", "backslashreplace"), "")

    def run(self, command, folder):
        """Output of the command, with its exit code as the last line, and the faults of that or of its traces."""
        before = state(folder)
        done = self.ran(command, folder)
        text = PROGRESS.sub("", done.stdout)
        if text and not text.endswith("\n"): text += "\n"
        after, faults = state(folder), []
        if done.returncode not in EXIT_CODES:
            faults.append(f"ends with {done.returncode} (minus 9: after {SECONDS} s), which is not one of lumen's exit codes")
        if done.returncode != 0 and after != before:
            changed = [name for name in after.keys() | before.keys() if after.get(name) != before.get(name)]
            faults.append("fails, but changes " + ", ".join(changed))
        if any(pathlib.Path(name).name.startswith(".") for name in after): faults.append("leaves a temporary file behind")
        if re.search(r"0x[0-9a-f]{9,}", text): faults.append("prints an address")
        if str(self.scratch) in text: faults.append("prints the path of a file that was named without one")
        return text + f"exit {done.returncode}\n", [f"$ {command}: {fault}" for fault in faults]

    def play(self, entry):
        """The entry as the program has it, and the faults that no page can excuse."""
        lines = entry.splitlines()
        commands = [line[2:] for line in lines if line.startswith("$ ")]
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.scratch))
        self.store.copy(" ".join(commands), folder)
        text, faults = lines[0] + "\n", []
        for command in commands:
            said, wrong = self.run(command, folder)
            text += f"$ {command}\n{said}"
            faults += wrong
        return text, faults


def check(page, player, fix):
    """Runs one page and prints what is wrong. Returns (entries, faults)."""
    old = page.read_text()
    new, count, faults = old, 0, 0
    for block in BLOCK.finditer(old):
        entries = [entry.rstrip("\n") + "\n" for entry in block[1].split("\n\n")]
        played = [player.play(entry) for entry in entries]
        for entry, (said, wrong) in zip(entries, played):
            differs = said != entry and not fix
            if wrong or differs: print(f"{page.name}: {entry.splitlines()[0]}")
            print("".join(f"  {fault}\n" for fault in wrong), end="")
            if differs:
                lines = difflib.unified_diff(entry.splitlines(), said.splitlines(), "page", "program", lineterm="")
                print("".join(f"  {line}\n" for line in lines), end="")
            faults += len(wrong) + differs
        count += len(entries)
        new = new.replace(block[1], "\n".join(said for said, _ in played))
    if fix and new != old: page.write_text(new)
    return count, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumen", required=True, type=pathlib.Path)
    parser.add_argument("--batch", required=True, type=pathlib.Path)
    parser.add_argument("--fix", action="store_true")
    parser.add_argument("--at-least", type=int, default=0, help="fail if the pages have fewer entries")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="lumen-mistakes-"))
    try:
        player = Player(options.lumen.resolve(), options.batch.resolve(), scratch)
        results = [check(page, player, options.fix) for page in options.pages or sorted(PAGES.glob("*.md"))]
        player.batch.end()
    finally:
        shutil.rmtree(scratch)
    count, faults = (sum(column) for column in zip(*results))
    print(f"{count} mistakes, {faults} of them not as written")
    if count < options.at_least: print(f"there should be at least {options.at_least}")
    return 1 if faults or count < options.at_least else 0


if __name__ == "__main__":
    sys.exit(main())
