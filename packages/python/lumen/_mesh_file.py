# SPDX-License-Identifier: Apache-2.0
"""Meshes that the engine writes, as arrays."""
from __future__ import annotations

from typing import Dict, List

import numpy as np

from ._parts import Mesh

_NUMBERS = {"float": "<f4", "int": "<i4"}


def read_mesh(path: str) -> Mesh:
    """The mesh in a binary PLY of lumen, whose faces are triangles."""
    with open(path, "rb") as file:
        data = file.read()
    header, _, _ = data.partition(b"end_header\n")
    start = len(header) + len(b"end_header\n")
    groups: List[str] = []
    columns: Dict[str, list] = {}
    counts: Dict[str, int] = {}
    element = ""
    for line in header.decode().splitlines():
        words = line.split(" ")
        if words[:2] == ["comment", "group"]:
            groups.append(words[3])
        elif words[0] == "element":
            element = words[1]
            columns[element], counts[element] = [], int(words[2])
        elif words[0] == "property":
            columns[element].append(("sides", "u1") if words[1] == "list" else
                                    (words[2], _NUMBERS[words[1]]))
            if words[1] == "list":
                columns[element].append(("corners", "<i4", 3))
    vertex = np.frombuffer(data, np.dtype(columns["vertex"]), counts["vertex"], start)
    face = np.frombuffer(data, np.dtype(columns["face"]), counts["face"], start + vertex.nbytes)
    column = lambda name: np.ascontiguousarray(vertex[name])
    stacked = lambda names: np.stack([vertex[name] for name in names], axis=1)
    attributes = {"normal": stacked(("nx", "ny", "nz"))}
    attributes.update((name, column(name)) for name in vertex.dtype.names or ()
                      if name not in ("x", "y", "z", "nx", "ny", "nz"))
    return Mesh(stacked(("x", "y", "z")), np.ascontiguousarray(face["corners"]),
                np.ascontiguousarray(face["group"]), groups, attributes)
