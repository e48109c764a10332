# SPDX-License-Identifier: Apache-2.0
"""Parts of a case: views of its memory, which keep the case alive."""
from __future__ import annotations

import os
from typing import List, NamedTuple, Optional

import numpy as np

from ._exchange import PolyData


class Branch(NamedTuple):
    """A vessel or an aneurysm: a contiguous range of nodes, each the child of the one before."""
    label: str
    kind: str                          #: "vessel" or "aneurysm"
    parent_node: int                   #: parent of the first node; -1 for a root
    first_node: int
    node_count: int
    stop_reason: str                   #: reason why tracking ended: "unknown", "left-volume"...
    mean_inlier_rate: Optional[float]  #: in [0, 1]
    system: str = "unknown"            #: or "artery", "vein", "true-lumen", "false-lumen"

    @property
    def nodes(self) -> slice:
        """The nodes of the branch, to index arrays of the tree with."""
        return slice(self.first_node, self.first_node + self.node_count)


class Change(NamedTuple):
    """The relation of a corrected case to the case before."""
    sentence: str               #: the edit for people, as the case's "edit" step records it
    before: np.ndarray          #: (n,) uint32, index before of each node; 0xFFFFFFFF for a new one
    stale: np.ndarray           #: (m,) uint32, nodes whose models were out of date
    dropped_arrays: List[str]   #: names of node arrays that were dropped; "motion" for the motion


class Tree(PolyData):
    """The centerlines: n nodes, a forest, branches in contiguous ranges."""

    def __init__(self, core):
        self._core = core

    def __len__(self):
        return len(self._core.radius)

    centre = property(lambda self: self._core.centre, doc="(n, 3) float32, mm, LPS.")
    direction = property(lambda self: self._core.direction,
                         doc="(n, 3) float32, unit vectors along the vessel, away from the parent.")
    radius = property(lambda self: self._core.radius, doc="(n,) float32, mm, > 0.")
    height = property(lambda self: self._core.height,
                      doc="(n,) float32, mm: length of the node's cylinder along its direction.")
    parent = property(lambda self: self._core.parent,
                      doc="(n,) int32, index of the parent, which is smaller; -1 for a root.")
    branch = property(lambda self: self._core.branch, doc="(n,) uint32, index into branches.")
    links = property(lambda self: self._core.links,
                     doc="(m, 2) uint32, pairs of nodes that close loops; the smaller first.")

    @property
    def inlier_rate(self) -> Optional[np.ndarray]:
        """(n,) float32 in [0, 1], or None if it is unknown."""
        rates = self._core.inlier_rate
        return rates if len(rates) else None

    @property
    def branches(self) -> List[Branch]:
        """The branches in the order of their nodes."""
        return [Branch(*facts) for facts in self._core.branches]

    def _poly_data(self):
        """A line for each branch, from its parent's node on."""
        lines = [np.arange(one.first_node, one.first_node + one.node_count) for one in self.branches]
        lines = [line if one.parent_node < 0 else np.insert(line, 0, one.parent_node)
                 for line, one in zip(lines, self.branches)]
        of_points = {"radius": self.radius, "direction": self.direction, "branch": self.branch}
        return self.centre, "Lines", lines, of_points, {"branch": np.arange(len(lines), dtype=np.int32)}

    def __repr__(self):
        return f"<lumen.Tree {len(self)} nodes, {len(self._core.branches)} branches>"


class Points:
    """Points on the wall: node i owns ``position[offset[i]:offset[i + 1]]``."""

    def __init__(self, core):
        self._core = core

    offset = property(lambda self: self._core.point_offset, doc="(n + 1,) uint32, from 0.")
    position = property(lambda self: self._core.point_position, doc="(p, 3) float32, mm, LPS.")

    def of(self, node: int) -> np.ndarray:
        """The points of a node, (k, 3) float32, mm, LPS: a view."""
        return self.position[self.offset[node]:self.offset[node + 1]]

    def __len__(self):
        return len(self.position)

    def __repr__(self):
        return f"<lumen.Points {len(self)} points>"


class Models:
    """One implicit surface f = T for each node: node i owns the blobs offset[i] .. offset[i + 1]."""

    def __init__(self, core):
        self._core = core

    kernel = property(lambda self: self._core.kernel[0],
                      doc='Name of the kernel, such as "cauchy".')
    kernel_parameter = property(lambda self: self._core.kernel[1],
                                doc="Cauchy: s^2; Gaussian: a^2; no meaning for others.")
    iso_level = property(lambda self: self._core.kernel[2], doc="T, mm.")
    offset = property(lambda self: self._core.blob_offset, doc="(n + 1,) uint32, from 0.")
    centre = property(lambda self: self._core.blob_centre, doc="(b, 3) float32, mm, LPS.")
    width = property(lambda self: self._core.blob_width, doc="(b,) float32, mm, > 0.")

    def __len__(self):
        return len(self.width)

    def __repr__(self):
        return f"<lumen.Models {len(self)} blobs, kernel {self.kernel}>"


class Motion:
    """Poses of some nodes over time; all other nodes rest. The pose of a node carries a point X at
    rest to ``centre + factor * R (X - centre at rest)``."""

    def __init__(self, core):
        self._core = core

    time = property(lambda self: self._core.motion_time, doc="(k,) float64, s, ascending.")
    node = property(lambda self: self._core.motion_node,
                    doc="(m,) uint32, the moving nodes, ascending.")
    centre = property(lambda self: self._core.motion_centre, doc="(k, m, 3) float32, mm, LPS.")
    rotation = property(lambda self: self._core.motion_rotation,
                        doc="(k, m, 4) float32, unit quaternions x, y, z, w.")
    factor = property(lambda self: self._core.motion_factor,
                      doc="(k, m) float32, > 0, of the radius.")

    @property
    def period(self) -> Optional[float]:
        """s, or None if the motion is not periodic."""
        return self._core.motion_period or None

    def __len__(self):
        return len(self.time)

    def __repr__(self):
        return f"<lumen.Motion {len(self)} times, {len(self.node)} nodes>"


class Picture(bytes):
    """The bytes of a PNG, which a notebook shows."""

    def _repr_png_(self) -> bytes:
        return bytes(self)

    def save(self, path) -> None:
        """Writes the PNG."""
        with open(os.fspath(path), "wb") as file:
            file.write(self)


class Mesh(PolyData):
    """A surface of triangles.

    Attributes
    ----------
    vertices : (v, 3) float32
        mm, LPS.
    triangles : (t, 3) int32
        Indices of vertices, counter-clockwise seen from outside.
    group : (t,) int32
        Number of each triangle's group, from 1 on, as files have it; empty without groups.
    groups : list of str
        Names: ``groups[number - 1]`` is "wall", "inlet-LABEL", "outlet-LABEL"...
    attributes : dict of arrays
        Further values of the vertices by name, such as normals.
    """

    def __init__(self, vertices, triangles, group, groups, attributes):
        self.vertices, self.triangles = vertices, triangles
        self.group, self.groups, self.attributes = group, groups, attributes

    def area(self) -> float:
        """mm^2."""
        return float(np.linalg.norm(self._crosses(), axis=1).sum() / 2)

    def volume(self) -> float:
        """mm^3; positive for a closed surface whose triangles face outwards."""
        corners = self.vertices.astype(float)[self.triangles[:, 0]]
        return float(np.einsum("ij,ij->", corners, self._crosses()) / 6)

    def _crosses(self):
        a, b, c = np.moveaxis(self.vertices.astype(float)[self.triangles], 1, 0)
        return np.cross(b - a, c - a)

    def _poly_data(self):
        of_cells = {"group": self.group} if len(self.group) else {}
        return self.vertices, "Polys", self.triangles, self.attributes, of_cells

    def __repr__(self):
        return f"<lumen.Mesh {len(self.vertices)} vertices, {len(self.triangles)} triangles>"
