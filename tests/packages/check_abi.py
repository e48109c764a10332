#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the binary interface of a library with the stored one.

check_abi.py [--write | --try-changes] LIBRARY TYPES HEADERS NAME

LIBRARY is the library that is installed, whose exported symbols and soname count. TYPES is one with debugging information
of the same functions, and HEADERS the folder of the headers that make their types public. The stored interface is
packages/abi/NAME.abi; --write replaces it. --try-changes removes a function, a member of a struct and a value of an
enumeration from the stored one, one at a time, and expects each to be found. Exit status: 0 equal, 1 not, 77 abigail-tools
or nm is missing."""
import pathlib, re, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCOMPATIBLE, CHANGED = 8, 4  # bits of abidiff's exit status


def run(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=120)


def dump(types, headers, out):
    made = run("abidw", "--exported-interfaces-only", "--headers-dir", headers, "--drop-private-types", "--no-corpus-path", "--no-comp-dir-path",
               "--no-show-locs", "--no-elf-needed", "--type-id-style", "hash", "--out-file", out, types)
    if made.returncode: sys.exit(f"abidw: {made.stdout}{made.stderr}")


def differences(old, new):
    """The report of abidiff, empty for equal interfaces, and whether programs that exist break."""
    found = run("abidiff", old, new)
    if found.returncode & ~(INCOMPATIBLE | CHANGED): sys.exit(f"abidiff: {found.stdout}{found.stderr}")
    return found.stdout if found.returncode else "", bool(found.returncode & INCOMPATIBLE)


def exported(library):
    lines = run("nm", "-D", "--defined-only", library).stdout.splitlines()
    return {line.split()[-1].split("@")[0] for line in lines}


def soname(library):
    return re.search(r"SONAME\s+(\S+)", run("objdump", "-p", library).stdout)[1]


def try_changes(stored, work):
    """Faults of changes to the interface that are not found."""
    text = stored.read_text()
    added = re.sub(r"    <elf-symbol name='lumen_case_note' .*\n", "", text)
    added = re.sub(r"<function-decl name='lumen_case_note' .*?</function-decl>\s*", "", added, flags=re.S)
    member = r"<data-member [^>]*>\s*<var-decl name='link_count'.*?</data-member>\s*"
    value = r"<enumerator name='LUMEN_CASE_ERROR_WRITE' value='5'/>"
    changes = {"a function that is added": added,
               "a member that is added": re.sub(member, "", text, flags=re.S),
               "a value that is renumbered": text.replace(value, value.replace("5", "6"))}
    faults = []
    for name, changed in changes.items():
        other = work / "changed.abi"
        other.write_text(changed)
        if changed == text or not differences(other, stored)[0]: faults.append(f"abidiff does not find {name}")
    if not differences(stored, work / "changed.abi")[0]: faults.append("abidiff sees no difference in the other direction")
    (work / "removed.abi").write_text(added)
    if not differences(stored, work / "removed.abi")[1]: faults.append("abidiff takes a removed function for compatible")
    return faults


def main():
    options, arguments = [a for a in sys.argv[1:] if a.startswith("--")], [a for a in sys.argv[1:] if a[0] != "-"]
    if len(arguments) != 4 or not set(options) <= {"--write", "--try-changes"}: sys.exit(__doc__)
    for tool in ("abidw", "abidiff", "nm", "objdump"):
        if not shutil.which(tool):
            print(f"{tool} is missing (Debian: abigail-tools, binutils)")
            return 77
    library, types, headers, name = arguments
    stored = ROOT / "packages/abi" / f"{name}.abi"
    if "--write" in options:
        dump(types, headers, stored)
        return 0
    with tempfile.TemporaryDirectory(prefix="lumen-abi-") as work:
        if "--try-changes" in options:
            faults = try_changes(stored, pathlib.Path(work))
            print("\n".join(faults) or "all changes are found")
            return 1 if faults else 0
        now = pathlib.Path(work) / "now.abi"
        dump(types, headers, now)
        report, breaks = differences(stored, now)
    symbols = set(re.findall(r"<elf-symbol name='([^']+)'", stored.read_text()))
    faults = [report] if report else []
    if exported(library) != symbols: faults.append(f"symbols that differ: {sorted(exported(library) ^ symbols)}")
    if soname(library) != f"{name}.so.1": faults.append(f"the soname is {soname(library)}")
    if breaks: faults.append("programs that exist break: restore the interface, or raise the soname")
    elif report: faults.append("additions: ninja write_abi stores them")
    print("\n".join(faults) or f"{len(symbols)} functions as stored")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
