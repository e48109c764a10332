# SPDX-License-Identifier: Apache-2.0
"""Programs that are run, and the time that they take."""
import os
import subprocess
import sys
from pathlib import Path

SHOWN = 2000  # characters of a failed program's output


def run(*words, folder=None):
    """Standard output, and seconds of the processor. Ends this script where the program fails."""
    before = os.times()
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, cwd=folder)
    after = os.times()
    if done.returncode != 0:
        sys.exit(f"{Path(sys.argv[0]).name}: {' '.join(map(str, words))}\n{done.stdout[-SHOWN:]}{done.stderr[-SHOWN:]}")
    return done.stdout, after.children_user + after.children_system - before.children_user - before.children_system
