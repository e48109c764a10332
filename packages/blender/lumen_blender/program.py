# SPDX-License-Identifier: Apache-2.0
"""Runs the program lumen, which does all reading and writing of cases."""
import os, shutil, subprocess

# Variables by which Blender finds its own libraries and Python. Another program would load them, too.
FOREIGN = ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PYTHONHOME", "PYTHONPATH")


class Failure(Exception):
    """A sentence for people."""


def find(stated):
    """The program: `stated`, or that of the environment variable LUMEN, or of the path."""
    found = stated or os.environ.get("LUMEN") or shutil.which("lumen")
    if not found: raise Failure("The program lumen is not on the path; the add-on's preferences may state its place")
    return found


def run(stated, *arguments):
    environment = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    try:
        done = subprocess.run([find(stated), *map(str, arguments), "--quiet"], capture_output=True, text=True, env=environment)
    except OSError as error:
        raise Failure(f"The program lumen cannot be run: {error.strerror}")
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"lumen ended with {done.returncode}"]
        raise Failure(lines[-1].removeprefix("lumen: error: "))
