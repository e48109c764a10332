#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""zip_folder.py OUT.zip FOLDER FILE... [--below ROOT]: files as FOLDER/NAME in an archive; those below ROOT keep their path from there.

Order, times and modes are fixed, so that equal files give equal bytes."""
import os, pathlib, sys, zipfile

DATE = (1980, 1, 1, 0, 0, 0)  # the earliest that the format knows


def main(words):
    root = None
    if "--below" in words:
        at = words.index("--below")
        root, words = pathlib.Path(words[at + 1]).resolve(), words[:at] + words[at + 2:]
    out, folder, *files = words
    names = {}
    for file in map(pathlib.Path, files):
        path = file.resolve()
        name = path.relative_to(root) if root is not None and path.is_relative_to(root) else pathlib.Path(path.name)
        names[f"{folder}/{name.as_posix()}"] = path
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, path in sorted(names.items()):
            entry = zipfile.ZipInfo(name, DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if os.access(path, os.X_OK) else 0o100644) << 16
            archive.writestr(entry, path.read_bytes())
    print(f"{out}: {len(names)} files, {os.path.getsize(out)} bytes")


if __name__ == "__main__":
    if len(sys.argv) < 4: sys.exit(__doc__)
    main(sys.argv[1:])
