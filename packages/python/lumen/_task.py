# SPDX-License-Identifier: Apache-2.0
"""Tasks of guidewires: the file of a task, and the vessels of its cases with the ways through them."""
from __future__ import annotations

import heapq
import json
import math
import os
import pathlib
from typing import Any, Dict, List, NamedTuple

import jsonschema
import numpy as np

from . import blob
from ._case import Case, read
from ._errors import Error, ValueFault

SCHEMA = json.loads(pathlib.Path(__file__).with_name("task.schema.json").read_text(encoding="utf-8"))
WIDER = 1.1  # wire radii: vessels that are narrower are no way
BEHIND = 3  # nodes behind a vessel's first one, at which a wire comes in


def defaults(group: str) -> Dict[str, Any]:
    """The default values of a group of a task."""
    return {name: row["default"] for name, row in SCHEMA["properties"][group]["properties"].items() if "default" in row}


def read_task(source) -> Dict[str, Any]:
    """A task with all its groups: of a dictionary, whose cases may be values, or of a file. Raises ValueFault, which
    states the place of the fault."""
    name, task, folder = "task", source, pathlib.Path()
    if not isinstance(source, dict):
        name, folder = os.fspath(source), pathlib.Path(source).parent
        try:
            task = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))
        except ValueError as fault:
            raise ValueFault(f"{name}: {fault}, expected a task in JSON") from None
    cases = task.get("cases") if isinstance(task, dict) else None
    plain = dict(task, cases=["." if isinstance(c, Case) else c for c in cases]) if isinstance(cases, list) else task
    fault = jsonschema.exceptions.best_match(jsonschema.Draft202012Validator(SCHEMA).iter_errors(plain))
    if fault is not None:
        raise ValueFault(f'{name}: at "/{"/".join(map(str, fault.absolute_path))}": {fault.message}')
    whole = {group: {**defaults(group), **task.get(group, {})} for group in ("device", "action", "reward", "limits")}
    whole["cases"] = [case if isinstance(case, Case) else folder / case for case in cases]
    return {"entry": None, "targets": None, "randomise": {}, **{k: v for k, v in task.items() if k not in whole}, **whole}


class Way(NamedTuple):
    """Ways along the tree to one target: of each node the length that is left, mm (infinite: there is none), and the
    direction of the next part of it; whether the wire fits."""
    target: np.ndarray
    left: np.ndarray
    toward: np.ndarray
    is_reached: np.ndarray


class Vessels:
    """One case of a task: its model, the entry, and targets that can be reached from there."""

    def __init__(self, source, task: Dict[str, Any]):
        case = source if isinstance(source, Case) else read(source)
        self.name = "case" if isinstance(source, Case) else str(source)
        self.model = blob.Model(case)
        self.centre = np.asarray(case.tree.centre, float)
        self.parent = np.asarray(case.tree.parent)
        self._labels = {branch.label: branch for branch in reversed(case.branches)}
        self._wide = np.asarray(case.tree.radius) > WIDER * task["device"]["radius"]
        self._edges = self._edges_of(np.asarray(case.tree.links))
        self.entry, self.direction = self._entry(task["entry"])
        device = task["device"]
        self._room = (device["nodes"] - 3) * device["spacing"]
        self.ways = self._ways(task["targets"])

    def _edges_of(self, links) -> List[List]:
        edges: List[List] = [[] for _ in self.parent]
        pairs = [(i, p) for i, p in enumerate(self.parent) if p >= 0] + [tuple(map(int, link)) for link in links]
        for a, b in pairs:
            length = math.dist(self.centre[a], self.centre[b])
            edges[a].append((int(b), length))
            edges[b].append((int(a), length))
        return edges

    def _branch(self, label: str):
        if label not in self._labels:
            raise ValueFault(f"{self.name}: found no vessel {label!r}, expected one of {', '.join(sorted(self._labels))}")
        return self._labels[label]

    def _largest_root(self) -> int:
        """The root of the tree with most nodes."""
        root = np.arange(len(self.parent))
        while (self.parent[root] >= 0).any():
            root = np.where(self.parent[root] >= 0, self.parent[root], root)
        return int(np.bincount(root).argmax())

    def _entry(self, entry):
        if entry and "point" in entry:
            return np.asarray(entry["point"], float), np.asarray(entry["direction"], float)
        node = self._branch(entry["vessel"]).first_node if entry else self._largest_root()
        for _ in range(BEHIND):
            node = self._next(node)
        along = self.centre[self._next(node)] - self.centre[node]
        return self.centre[node], along / np.linalg.norm(along)

    def _next(self, node: int) -> int:
        """The first child, which goes on along the vessel."""
        children = np.flatnonzero(self.parent == node)
        if len(children) == 0:
            raise ValueFault(f"{self.name}: found a vessel of {BEHIND + 1} nodes or fewer, expected a longer one for the entry")
        return int(children[0])

    def way_to(self, target) -> Way:
        """The ways to a point from all nodes, by Dijkstra's algorithm from the node nearest to it; from where the wire
        has no way, but may get its tip to, the ways through narrow vessels."""
        target = np.asarray(target, float)
        first = int(self.model.cursor(target[None]).node[0])
        left, after = np.full(len(self.centre), np.inf), np.full(len(self.centre), first)
        left[first] = math.dist(self.centre[first], target)
        self._search(left, after, [first], self._wide)
        is_reached = np.isfinite(left)
        self._search(left, after, np.flatnonzero(is_reached), ~is_reached)
        toward = self.centre[after] - self.centre
        toward[first] = target - self.centre[first]
        return Way(target, left, toward / np.maximum(np.linalg.norm(toward, axis=1, keepdims=True), 1e-9), is_reached)

    def _search(self, left, after, starts, allowed) -> None:
        queue = [(left[start], int(start)) for start in starts]
        heapq.heapify(queue)
        while queue:
            length, node = heapq.heappop(queue)
            if length > left[node]:
                continue
            for other, edge in self._edges[node]:
                if allowed[other] and length + edge < left[other]:
                    left[other], after[other] = length + edge, node
                    heapq.heappush(queue, (left[other], other))

    def _ways(self, targets) -> List[Way]:
        from_entry = self.way_to(self.entry)
        if targets is None:
            ends = np.setdiff1d(np.flatnonzero(self._wide), self.parent)
            places = [self.centre[end] for end in ends if from_entry.is_reached[end] and 5.0 < from_entry.left[end] < 0.9 * self._room]
        else:
            places = [one["point"] if "point" in one else self.centre[self._branch(one["vessel"]).nodes.stop - 1] for one in targets]
        ways = [self.way_to(place) for place in places]
        start = int(self.model.cursor(self.entry[None]).node[0])
        if not ways or not all(way.is_reached[start] for way in ways):
            raise Error(f"{self.name}: found a target without a way from the entry, or no end within {0.9 * self._room:g} mm of "
                        f"wire, expected vessels that are {WIDER} times as wide as the wire all along", 3)
        return ways
