#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the tests of a run of ctest: the cases of a GoogleTest program one by one, all else as ctest has it.

    ctest --test-dir BUILD --output-junit BUILD/tests.xml
    tests/count_results.py BUILD/tests.xml BUILD/results

Prints the reason of each skipped test, then "N passed, M failed". Ends with 1 if one failed or none ran.
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

REASON_LENGTH = 160  # characters of a reason that are printed


def cases_of(program):
    """(name, outcome, reason) of each case that a GoogleTest program ran."""
    for case in ElementTree.parse(program).getroot().iter("testcase"):
        if case.get("status") != "run":
            continue
        name = f"{case.get('classname')}.{case.get('name')}"
        skipped = case.find("skipped")
        if case.find("failure") is not None:
            yield name, "failed", ""
        elif skipped is not None:
            # the first line of GoogleTest's message is a place in a source
            yield name, "skipped", (skipped.get("message") or "").strip().split("\n")[-1]
        else:
            yield name, "passed", ""


def results_of(report, programs):
    """(name, outcome, reason) of each test, and of each case of the programs that left a list of theirs."""
    for test in ElementTree.parse(report).getroot().iter("testcase"):
        name, listed = test.get("name"), programs / f"{test.get('name')}.xml"
        skipped = test.find("skipped")
        if skipped is not None and skipped.get("message", "").startswith("SKIP_"):
            yield name, "skipped", (test.findtext("system-out") or "").strip().split("\n")[-1]
        elif test.get("status") != "run":
            cases = list(cases_of(listed)) if listed.exists() else []
            yield from cases
            if all(outcome != "failed" for _, outcome, _ in cases):
                yield name, "failed", ""  # not started, or ended after its last case
        elif listed.exists():
            yield from cases_of(listed)
        else:
            yield name, "passed", ""


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    report, programs = map(pathlib.Path, sys.argv[1:])
    results = list(results_of(report, programs))
    count = collections.Counter(outcome for _, outcome, _ in results)
    skipped = [(name, reason) for name, outcome, reason in results if outcome == "skipped"]
    if skipped:
        print(f"{len(skipped)} skipped: they need files or programs that are not here")
        for name, reason in skipped:
            print(f"  {name}: {reason[:REASON_LENGTH]}")
    print(f"{count['passed']} passed, {count['failed']} failed")
    return 1 if count["failed"] > 0 or not results else 0


if __name__ == "__main__":
    sys.exit(main())
