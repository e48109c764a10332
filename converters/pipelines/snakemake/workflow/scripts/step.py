#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One step of a row: runs lumen, and takes an input that is no good for a result.

step.py --lumen PROGRAM OUTPUT [--needs FILE] [--answer] [--folder] -- COMMAND...

Exit code 3 of lumen states that the input is at fault, and no further try would help: OUTPUT is
then empty, and fault.txt beside it has the message. Where the file that the step needs is empty,
so is its output. Any other failure is this program's: the step is tried again with more memory."""
import argparse
import os
import pathlib
import subprocess
import sys

INVALID_INPUT = 3


def leave_empty(output, is_folder):
    if is_folder:
        output.mkdir(parents=True, exist_ok=True)
    else:
        output.write_text("")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumen", required=True)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--needs", type=pathlib.Path)
    parser.add_argument("--answer", action="store_true", help="OUTPUT is what lumen prints")
    parser.add_argument("--folder", action="store_true", help="OUTPUT is a folder")
    own = sys.argv[1:sys.argv.index("--")]
    options, command = parser.parse_args(own), sys.argv[sys.argv.index("--") + 1:]
    fault = options.output.parent / "fault.txt"
    if options.needs and options.needs.stat().st_size == 0:
        leave_empty(options.output, options.folder)
        return 0
    if options.folder and options.output.is_dir():
        options.output.rmdir()  # Snakemake makes it, empty
    done = subprocess.run([options.lumen, *command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, errors="replace", check=False)
    sys.stderr.write(done.stderr)
    if done.returncode == INVALID_INPUT:
        fault.write_text(done.stderr)
        leave_empty(options.output, options.folder)
        return 0
    if done.returncode == 0:
        fault.unlink(missing_ok=True)
        if options.answer:
            new = options.output.with_suffix(".new")
            new.write_text(done.stdout)
            os.replace(new, options.output)
    return done.returncode if done.returncode >= 0 else 128 - done.returncode


if __name__ == "__main__":
    sys.exit(main())
