#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that texts of others are read by one JSON reader, and their numbers as one type: JsonValue and JsonNumber of
formats/case. Prints every line of the product that parses JSON by nlohmann-json, or asks it for a number. Exit status: 0
no such line, 1 some."""
import pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FORBIDDEN = re.compile(r"[Jj]son::(parse|accept)\(|\bis_(number|binary)\w*\(|"
                       r"[.>]\s*(template )?get(_to|_ref|_ptr)?<[^>]*\b(double|float|int|long|(u?int\d+|size)_t)\b")

# Readers of values that lumen itself has made in memory, and the reader itself.
ALLOWED = {
    "formats/json/json_value.cpp": "the reader",
    "converters/library/publish/record_faults.cpp": "facts of two records, which lumen made",
    "viewer/session/packs/case_pack.cpp": "a pack of this program",
}


def is_json(path):
    text = path.read_text()
    return "json" in text.lower() and path.relative_to(ROOT).as_posix() not in ALLOWED


def main():
    found = 0
    for folder in ("formats", "converters", "viewer"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".cpp", ".h") or not is_json(path): continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if FORBIDDEN.search(line):
                    print(f"{path.relative_to(ROOT)}:{number}: {line.strip()}")
                    found = 1
    return found


sys.exit(main())
