# SPDX-License-Identifier: Apache-2.0
"""The program lumen: where it is, its version, and its runs."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

from .errors import FAILED, Fault


def find_program(stated):
    """Path of lumen: as stated, else $LUMEN, beside this program, or in PATH. Raises Fault."""
    beside = pathlib.Path(sys.argv[0]).resolve().parent / "lumen"
    for name in (stated, os.environ.get("LUMEN"), str(beside), "lumen"):
        if not name:
            continue
        found = shutil.which(name)
        if found:
            return str(pathlib.Path(found).resolve())
        if name == stated:
            raise Fault(f"--lumen: found no program {stated}", FAILED)
    raise Fault("found no program lumen, expected it in PATH, or stated by --lumen", FAILED)


class Program:
    """Runs lumen and keeps its messages."""

    def __init__(self, stated=None, threads=0, folders=()):
        self.path = find_program(stated)
        self.folders = folders  # whose names no message keeps
        self.threads = threads
        self.version = json.loads(self.run("--version", "--json"))["version"]

    def run(self, *words, log=None):
        """Standard output. Raises Fault with lumen's last line of standard error and its code."""
        words = [str(word) for word in words]
        call = [self.path, *words]
        if self.threads and not words[0].startswith("--"):
            call += ["--threads", str(self.threads)]
        done = subprocess.run(call, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              errors="replace", check=False)
        if log is not None and done.stderr:
            with open(log, "a", encoding="utf-8") as out:
                out.write(self.without_folders(done.stderr))
        if done.returncode:
            raise Fault(self.without_folders(reason(done)), done.returncode if done.returncode > 0 else FAILED)
        return done.stdout

    def without_folders(self, text):
        """A message in which files have their place in the folders: a folder's name may be somebody's."""
        names = {str(name) for folder in self.folders for name in (folder, folder.resolve())}
        for name in sorted(names - {".", "/"}, key=len, reverse=True):
            text = text.replace(f"{name}/", "").replace(name, ".")
        return text


def reason(done):
    lines = [line for line in done.stderr.splitlines() if line.startswith("lumen: error: ")]
    if lines:
        return lines[-1].removeprefix("lumen: error: ")
    if done.returncode < 0:
        return f"lumen crashed, or was ended for want of memory (signal {-done.returncode})"
    return f"lumen ended with exit code {done.returncode}"
