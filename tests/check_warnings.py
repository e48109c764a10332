#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every warning has a code, and that every code is used and explained.

Codes are the values of WarningCode (converters/base/warning.h), their names those of warningName(), their explanations the
rows of docs/warnings.md. Prints every code that lacks one of these, every row without a code, and every line of the product
that passes text to Progress::warn() without a code. Exit status: 0 nothing, 1 some."""
import pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BASE = ROOT / "converters" / "base"
# Listeners, which pass on what has a code already.
PASSING_ON = {"converters/base/warning.cpp", "converters/base/relayed_progress.h"}


def sources():
    for folder in ("converters", "viewer", "packages/python/src"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".cpp", ".h") and "node_modules" not in path.parts: yield path


def word(code):
    """SeedUnused as seed-unused."""
    return re.sub(r"(?<!^)([A-Z])", r"-\1", code).lower()


def main():
    header = (BASE / "warning.h").read_text()
    codes = re.findall(r"\b[A-Z]\w+", re.search(r"enum class WarningCode.*?\{(.*?)\}", header, re.S)[1])
    names = dict(re.findall(r"case WarningCode::(\w+):\s*return \"([\w-]+)\"", (BASE / "warning.cpp").read_text()))
    rows = re.findall(r"^\| `([\w-]+)` \| [^|]+ \| [^|]+ \|$", (ROOT / "docs" / "warnings.md").read_text(), re.M)
    faults, used = [], set()
    for path in sources():
        name = path.relative_to(ROOT).as_posix()
        if name in PASSING_ON or path.parent == BASE and path.stem == "warning": continue
        text = path.read_text()
        used.update(re.findall(r"WarningCode::(\w+)", text))
        for number, line in enumerate(text.splitlines(), 1):
            if re.search(r"(\.|->)warn\(", line): faults.append(f"{name}:{number}: a warning without a code: {line.strip()}")
    for code in codes:
        if names.get(code) != word(code): faults.append(f"{code}: its name is {names.get(code)}, expected {word(code)}")
        if word(code) not in rows: faults.append(f"{code}: docs/warnings.md has no row `{word(code)}`")
        if code not in used: faults.append(f"{code}: no warning has it")
    faults += [f"docs/warnings.md: `{row}` is no code" for row in rows if row not in map(word, codes)]
    if rows != sorted(set(rows)): faults.append("docs/warnings.md: rows are not in order, or there twice")
    print(*faults, sep="\n", end="\n" if faults else "")
    return bool(faults)


sys.exit(main())
