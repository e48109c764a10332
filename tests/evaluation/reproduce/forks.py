#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Forks of a true tree that a found one has with the right parent.

  forks.py LUMEN FOUND TRUTH

FOUND and TRUTH are cases. A true branch of at least 5 mm counts. Its fork is right if the found tree leads from a place in the branch,
two of its radii beyond its parent's wall, up to a place in the parent, two of the parent's radii before the fork, and takes at most
twice the true path for it.
"""
import json
import math
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

CELL = 2.0  # mm
SHORTEST = 5.0  # mm


def tree_of(lumen, case):
    """The tree of a case as its JSON twin has it."""
    with tempfile.TemporaryDirectory() as folder:
        twin = Path(folder) / "case.lumen.json"
        subprocess.run([str(lumen), "convert", str(case), str(twin), "--quiet"], check=True, capture_output=True)
        return json.loads(twin.read_text())["tree"]


def apart(tree, i, j):
    return math.dist(tree["centre"][i], tree["centre"][j])


def off_edge(a, b, point):
    """Distance of a point from the segment between two others, mm."""
    along = [q - p for p, q in zip(a, b)]
    square = sum(x * x for x in along)
    t = 0 if square == 0 else max(0, min(1, sum((x - p) * d for x, p, d in zip(point, a, along)) / square))
    return math.dist(point, [p + t * d for p, d in zip(a, along)])


class Found:
    """A found tree, whose nodes are looked up by place."""

    def __init__(self, tree):
        self.tree, self.cells = tree, defaultdict(list)
        for i, centre in enumerate(tree["centre"]): self.cells[self.cell(centre)].append(i)

    @staticmethod
    def cell(point):
        return tuple(math.floor(x / CELL) for x in point)

    def at(self, point, radius):
        """The node whose edge is nearest to a point, or None if none is within 1.5 radii and 0.3 mm more."""
        x, y, z = self.cell(point)
        best, least = None, 1.5 * radius + 0.3
        for cell in ((x + a, y + b, z + c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)):
            for node in self.cells.get(cell, ()):
                parent = self.tree["parent"][node]
                end = self.tree["centre"][parent if parent >= 0 else node]
                away = off_edge(end, self.tree["centre"][node], point)
                if away < least: best, least = node, away
        return best

    def leads(self, lower, upper, limit):
        """Whether the path from one node towards its root passes another within a length, mm."""
        length, node, tree = 0, lower, self.tree
        while node >= 0 and length <= limit:
            same = tree["branch"][node] == tree["branch"][upper]
            if node == upper or (same and apart(tree, node, upper) < 0.5 * tree["radius"][upper]): return True
            parent = tree["parent"][node]
            if parent >= 0: length += apart(tree, node, parent)
            node = parent
        return False


def places(truth, branch):
    """A node in a branch, one in its parent, and the length between both, mm; None if the branch does not count."""
    fork, first = branch.get("parentNode", -1), branch["firstNode"]
    last = first + branch["nodeCount"] - 1
    if fork < 0 or branch.get("kind", "vessel") != "vessel": return None
    if sum(apart(truth, i, i + 1) for i in range(first, last)) < SHORTEST: return None
    radius = truth["radius"]
    lower = first
    while lower < last and apart(truth, lower, fork) < radius[fork] + 2 * radius[lower]: lower += 1
    upper, before = fork, 0
    while truth["parent"][upper] >= 0 and before < 2 * radius[fork] + radius[first]:
        before += apart(truth, upper, truth["parent"][upper])
        upper = truth["parent"][upper]
    length = before + apart(truth, fork, first) + sum(apart(truth, i, i + 1) for i in range(first, lower))
    return lower, upper, 2 * length + 4 * radius[fork]


def right_forks(lumen, found_case, truth_case):
    """(forks that count, those with the right parent)."""
    found, truth = Found(tree_of(lumen, found_case)), tree_of(lumen, truth_case)
    count = right = 0
    for branch in truth["branches"]:
        at = places(truth, branch)
        if at is None: continue
        lower, upper, limit = at
        ends = [found.at(truth["centre"][node], truth["radius"][node]) for node in (lower, upper)]
        count += 1
        right += None not in ends and found.leads(*ends, limit)
    return count, right


if __name__ == "__main__":
    total, good = right_forks(*sys.argv[1:4])
    print(f"{good} of {total} forks have the right parent")
