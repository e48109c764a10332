#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of docs/mistakes and compares what lumen says with what the pages say.

run.py [--lumen PROGRAM] [--fix] [--at-least N] [PAGE.md ...]

Every fenced block "console" holds commands ("$ lumen ..."), each followed by all that it prints and by "exit CODE".
Each block has a folder of its own, with the files (see fixtures.py) whose names its commands mention; the commands
are run there by bash, without the rights of a privileged user. Lines of progress ("reading: done in 0.1 s") are left
out. A command that fails must leave every file as it was and no temporary file behind. --fix writes what the program
says into the pages, to be read with git diff. Exit status: 0 all as written, 1 not."""
import argparse, concurrent.futures, ctypes, difflib, hashlib, os, pathlib, re, shutil, subprocess, sys, tempfile

sys.dont_write_bytecode = True
import fixtures

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "mistakes"
LUMEN = ROOT / "build" / "release" / "converters" / "cli" / "lumen"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)
PROGRESS = re.compile(r"^.*: done in [^\n]*\n", re.M)
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


def run(command, folder, lumen):
    """Output of the command, with its exit code as the last line, and the faults of that or of its traces."""
    before = state(folder)
    environment = {"PATH": f"{lumen.parent}:/usr/bin:/bin", "HOME": str(folder), "LC_ALL": "C.UTF-8"}
    try:
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS, preexec_fn=as_a_user)
    except subprocess.TimeoutExpired:
        return "", [f"runs longer than {SECONDS} s"]
    text = PROGRESS.sub("", done.stdout.decode("utf-8", "backslashreplace"))
    if text and not text.endswith("\n"):
        text += "\n"
    after, faults = state(folder), []
    if done.returncode not in EXIT_CODES:
        faults.append(f"ends with {done.returncode}, which is not one of lumen's exit codes")
    if done.returncode != 0 and after != before:
        faults.append("fails, but changes " + ", ".join(n for n in after.keys() | before.keys() if after.get(n) != before.get(n)))
    if any(pathlib.Path(name).name.startswith(".") for name in after):
        faults.append("leaves a temporary file behind")
    if re.search(r"0x[0-9a-f]{9,}", text):
        faults.append("prints an address")
    if str(folder.parent) in text:
        faults.append("prints the path of a file that was named without one")
    return text + f"exit {done.returncode}\n", faults


def commands_of(block):
    """The lines of a block that are commands."""
    return [line[2:] for line in block.splitlines() if line.startswith("$ ")]


def play(block, folder, lumen, store):
    """The block as the program has it, and the faults that no page can excuse."""
    commands = commands_of(block)
    store.copy(" ".join(commands), folder)
    text, faults = "", []
    for command in commands:
        said, wrong = run(command, folder, lumen)
        text += f"$ {command}\n{said}"
        faults += [f"$ {command}: {fault}" for fault in wrong]
    return text, faults


def heading(page, position):
    """The last heading above a position of a page."""
    return re.findall(r"^#+ (.*)$", page[:position], re.M)[-1]


def check(page, lumen, store, scratch, pool, fix):
    """Runs one page; gives the number of its entries and prints what is wrong. Returns (entries, faults)."""
    text = page.read_text()
    blocks = list(BLOCK.finditer(text))
    folders = [scratch / f"{page.stem}-{i}" for i in range(len(blocks))]
    for folder in folders:
        folder.mkdir()
    played = list(pool.map(lambda b, f: play(b.group(1), f, lumen, store), blocks, folders))
    faults, new = 0, text
    for block, (said, wrong) in reversed(list(zip(blocks, played))):
        title = f"{page.name}: {heading(text, block.start())}"
        for fault in wrong:
            print(f"{title}\n  {fault}")
        differs = said != block.group(1)
        if differs and not fix:
            print(title)
            lines = difflib.unified_diff(block.group(1).splitlines(), said.splitlines(), "page", "program", lineterm="")
            print("".join(f"  {line}\n" for line in lines), end="")
        faults += len(wrong) + (differs and not fix)
        new = new[:block.start(1)] + said + new[block.end(1):]
    if fix and new != text:
        page.write_text(new)
    return len(blocks), faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumen", default=LUMEN, type=pathlib.Path, help="default: that of build/release")
    parser.add_argument("--fix", action="store_true")
    parser.add_argument("--at-least", type=int, default=0, help="fail if the pages have fewer blocks")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    pages = options.pages or sorted(PAGES.glob("*.md"))
    lumen = options.lumen.resolve()
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="lumen-mistakes-"))
    store = fixtures.Store(scratch / "fixtures", lumen)
    try:
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            results = [check(page, lumen, store, scratch, pool, options.fix) for page in pages]
    finally:
        shutil.rmtree(scratch)
    count, faults = (sum(column) for column in zip(*results))
    print(f"{count} mistakes, {faults} of them not as written")
    if count < options.at_least:
        print(f"there should be at least {options.at_least}")
    return 1 if faults or count < options.at_least else 0


if __name__ == "__main__":
    sys.exit(main())
