#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""translate.py [--check]: writes the query of blob_device.h in other languages (TEXTS), from the C of the header alone.

--check compares the files with what would be written, and ends with 1 where they differ; with 77 without python3-pycparser."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
SKIPPED = 77


def texts():
    """The text of each file by its path."""
    from c_query import Query
    from warp_text import Warp
    from wgsl import Wgsl
    query = Query()
    return {ROOT / "libblob/device/query.wgsl": Wgsl(query).text(),
            ROOT / "libblob/device/query_warp.py": Warp(query).text()}


def main():
    try:
        import pycparser  # pylint: disable=unused-import
    except ImportError:
        print("skipped: python3-pycparser is missing")
        return SKIPPED
    stale = []
    for path, text in texts().items():
        if "--check" not in sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            stale.append(str(path.relative_to(ROOT)))
    for name in stale:
        print(f"{name} is not what libblob/device/translate/translate.py makes of blob_device.h; run it")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
