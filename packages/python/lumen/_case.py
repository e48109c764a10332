# SPDX-License-Identifier: Apache-2.0
"""The case: metadata, a tree of centerlines, wall points and models."""
from __future__ import annotations

import difflib
import json
import numbers
import os
import zlib
from typing import Any, Dict, Optional, Tuple

import numpy as np

from . import _lumen
from ._calls import called, report, watch_of
from ._editing import Editor
from ._errors import Error, ValueFault, shown
from ._exchange import graph_of
from ._options import check_flag, document, mesh_rows, texts_of
from ._parts import Change, Mesh, Models, Motion, Picture, Points, Tree
from ._running import Answer, Kept, call, run


_OF_SURFACES = [("mesh.ply:", "surface:")]  # words of messages


class Case:
    """A vessel case in memory. :func:`lumen.read` reads one.

    Arrays of the tree, the points and the models are views of the case's memory: they are never
    copied, and keep the case alive. Those of a case that was read or made cannot be written to;
    :meth:`copy` gives one whose arrays can be. All lengths are in mm, all coordinates LPS (+x left,
    +y back, +z head).
    """

    def __init__(self, core, change: Optional[Change] = None):
        if not isinstance(core, _lumen.Case):
            raise ValueFault("lumen.read() reads a case, Case.from_bytes() decodes one")
        self._core = core
        self.change = change  #: the edit that made this case, or None

    # ------------------------------------------------------------ files and bytes
    @classmethod
    def from_bytes(cls, data: bytes) -> "Case":
        """Decodes the content of a .lumen or .lumen.json file. Raises lumen.Error with the place."""
        return cls(called(_lumen.Case.decode, bytes(data)))

    def to_bytes(self, *, json: bool = False, compress: bool = False, point_bits: int = 0) -> bytes:
        """The bytes of a .lumen file, or of a .lumen.json one. Equal cases give equal bytes."""
        # pylint: disable=redefined-outer-name
        return called(self._core.encode, json, compress, _bits(point_bits))

    def write(self, path, *, compress: bool = False, point_bits: int = 0) -> None:
        """Validates the case and writes it in one step: JSON if the name ends in .json.

        Parameters
        ----------
        path : path
            ``.lumen`` or ``.lumen.json``. :func:`lumen.convert` writes meshes and centerlines.
        compress : bool
            zstd for every part that it makes smaller.
        point_bits : int
            Rounds wall points to 1 to 30 bits of their bounding box; 0: exact.

        Raises
        ------
        Error
            With the place of the first rule that is broken; the file is as it was.
        """
        path = os.fspath(path)
        if not path.endswith((".lumen", ".json")):
            raise ValueFault(f"{path}: found another name, expected one in .lumen or .lumen.json; "
                             "lumen.convert(case, path) writes meshes and centerlines")
        called(self._core.write, path, path.endswith(".json"), compress, _bits(point_bits))

    def copy(self) -> "Case":
        """A copy whose arrays can be written to. :meth:`write` validates it."""
        return Case(self._core.copy(True))

    @property
    def writable(self) -> bool:
        """Whether the arrays can be written to."""
        return self._core.writable

    # ------------------------------------------------------------ content
    @property
    def tree(self) -> Tree:
        """The centerlines."""
        return Tree(self._core)

    @property
    def points(self) -> Optional[Points]:
        """The wall points, or None."""
        return None if self._core.point_offset is None else Points(self._core)

    @property
    def models(self) -> Optional[Models]:
        """The implicit surfaces, or None before the fit."""
        return None if self._core.kernel is None else Models(self._core)

    @property
    def motion(self) -> Optional[Motion]:
        """The poses of nodes over time, or None."""
        return None if self._core.motion_time is None else Motion(self._core)

    def with_motion(self, time, node, centre, rotation, factor=1.0, *, period=None) -> "Case":
        """A new case with a motion in place of the one of this case.

        Parameters
        ----------
        time : (k,)
            s, ascending.
        node : (m,)
            Moving nodes, ascending.
        centre : (k, m, 3)
            mm, LPS.
        rotation : (k, m, 4)
            Unit quaternions x, y, z, w.
        factor : (k, m), or a number
            > 0, of the radius.
        period : float, optional
            s, longer than from the first time to the last; without it, the motion is not periodic.

        Raises
        ------
        Error
            With the place of the first rule that is broken.
        """
        # pylint: disable=too-many-arguments
        times, nodes = np.asarray(time, float), np.asarray(node)
        if times.ndim != 1 or len(times) == 0 or nodes.ndim != 1:
            raise ValueFault(f"found times of shape {times.shape} and nodes of shape {nodes.shape}, "
                             "expected (k,) with k > 0, and (m,)")
        poses = np.empty((len(times), len(nodes), 8), np.float32)
        poses[..., :3], poses[..., 3:7], poses[..., 7] = centre, rotation, factor
        return Case(called(self._core.with_motion, times.tolist(), nodes.tolist(), poses, period or 0.0))

    def without_motion(self) -> "Case":
        """A new case, at rest."""
        return Case(called(self._core.with_motion, [], [], np.empty(0, np.float32), 0.0))

    @property
    def branches(self):
        """The branches of the tree."""
        return self.tree.branches

    @property
    def node_arrays(self) -> Dict[str, np.ndarray]:
        """Values of extensions by name: (n,) or (n, components), views."""
        return self._core.node_arrays

    @property
    def metadata(self) -> Dict[str, Any]:
        """Units, source volume, and every processing step with its parameters: a new dictionary."""
        return json.loads(self._core.metadata_json)

    def branch(self, label) -> int:
        """The index of the branch with a label; an index is returned as it is."""
        names = [one.label for one in self.branches]
        if isinstance(label, str):
            if label not in names:
                near = difflib.get_close_matches(label, names, 5, 0) if len(names) > 9 else names
                more = f", or another of {len(names)}: case.branches lists all" if len(near) < len(names) else ""
                raise KeyError(f"{label}: found no such branch, expected one of {', '.join(near)}{more}")
            return names.index(label)
        index = range(len(names))[label]
        return index

    @property
    def edit(self) -> Editor:
        """Corrections by hand: ``case.edit.rename("b3", "MCA")`` returns a new case."""
        return Editor(self)

    # ------------------------------------------------------------ work
    # those whose first argument is no self are functions of lumen, too, which take the path of a case
    # pylint: disable=no-self-argument
    @document("validate")
    def validate(source, **options) -> Answer:
        """All faults of a case.

        Returns
        -------
        Answer
            ``valid``, ``errors``, ``warnings``, ``information`` and ``issues``, each with code, number,
            severity, pointer or offset, arguments and message.
        """
        if isinstance(source, Case):
            errors, warnings, notes, issues = source._core.issues(int(options.get("max_issues") or 100))
            if errors:
                answer = Answer(file=None, valid=False, complete=len(issues) == errors + warnings + notes,
                                errors=errors, warnings=warnings, information=notes, issues=issues)
                answer.text = "\n".join(f"{i['code']} at {i['pointer']}: {i['message']}" for i in issues)
                answer.code, answer.warnings = 3, []
                return answer
        whole = run("validate", source, **options)
        answer = Answer(whole["files"][0])
        if isinstance(source, Case):
            answer["file"] = None
        answer.text, answer.code, answer.warnings = whole.text, whole.code, whole.warnings
        return answer

    @document("fit", "to")
    def fit(case, **options) -> "Case":
        """Fits models to the wall points; returns a new case."""
        return case_made("fit", case, **options)

    @document("trim", "to")
    def trim(self, **options) -> "Case":
        """Removes ends of vessels that are too thin or too short; returns a new case."""
        return case_made("trim", self, **options)

    @document("convert", rows=mesh_rows())
    def mesh(case, **options) -> Mesh:
        """The closed surface, or its patches, as arrays.

        Returns
        -------
        Mesh
            Vertices (v, 3) float32, mm, LPS; triangles (t, 3) int32, facing outwards.

        Examples
        --------
        >>> case.mesh(edge="0.25r").to_pyvista().plot(scalars="group")
        """
        source: Any = case
        name, core = case._given() if isinstance(case, Case) else (os.fsdecode(source), read(source)._core)
        words = _OF_SURFACES + ([(name, name.partition(".")[0])] if isinstance(case, Case) else [])
        watch = watch_of(options)
        *arrays, warnings, details = called(_lumen.mesh_of, core, name, texts_of("convert", options), *watch,
                                            known=[name], words=words)
        report(warnings, details, words)
        return Mesh(*arrays)

    def surface(self, **options) -> Tuple[np.ndarray, np.ndarray]:
        """The closed surface as two arrays; options as those of :meth:`mesh`.

        Returns
        -------
        vertices : (v, 3) float32
            mm, LPS.
        triangles : (t, 3) int32
            Indices of vertices, counter-clockwise seen from outside.

        Examples
        --------
        >>> vertices, triangles = case.surface()
        >>> axes = matplotlib.pyplot.figure().add_subplot(projection="3d")
        >>> axes.plot_trisurf(*vertices.T, triangles=triangles)
        """
        mesh = self.mesh(**options)
        return mesh.vertices, mesh.triangles

    def to_pyvista(self, **options):
        """The closed surface as a ``pyvista.PolyData``, mm, LPS; options as those of :meth:`mesh`.

        Examples
        --------
        >>> plotter = pyvista.Plotter()
        >>> plotter.add_mesh(case.to_pyvista(), opacity=0.3)
        >>> plotter.add_mesh(case.tree.to_pyvista(), scalars="radius")
        >>> plotter.show()
        """
        return self.mesh(**options).to_pyvista()

    def to_networkx(self, *, plain: bool = False):
        """The tree as a ``networkx.DiGraph`` whose edges lead from parents to children.

        Parameters
        ----------
        plain : bool
            Attributes that are numbers and texts, as ``networkx.write_graphml`` and other files of graphs take them: no
            ``centre``, and several numbers of a node array as ``name_0``, ``name_1``...

        Returns
        -------
        networkx.DiGraph
            Nodes 0 to n - 1 with ``centre`` (x, y, z) and ``x``, ``y``, ``z``, mm, LPS, ``radius``, mm, ``branch``, its
            label, ``inlier_rate`` where it is known, and the values of :attr:`node_arrays`. Edges with ``length``, mm,
            and ``link``, true for those of :attr:`Tree.links`, which close loops.

        Examples
        --------
        >>> graph = case.to_networkx()
        >>> places = {node: centre[::2] for node, centre in graph.nodes(data="centre")}   # x and z: from the front
        >>> networkx.draw(graph, places, node_size=[10 * radius for _, radius in graph.nodes(data="radius")])
        """
        return graph_of(self, check_flag("plain", plain))

    @document("measure")
    def measure(case, **options) -> Answer:
        """Measures vessels, paths, forks, narrowings and aneurysms, each with its uncertainty.

        Returns
        -------
        Answer
            Tables with units in their keys, as spec/answers states them; :meth:`lumen.Answer.tables` gives them to
            pandas.
        """
        return run("measure", case, **options)

    @document("check")
    def check(self, volume, **options) -> Answer:
        """Agreement with the volume (a path, a :class:`Volume` or an image): wall, dark lumen, missing
        vessels."""
        return run("check", volume, self, **options)

    @document("compare")
    def compare(self, truth, **options) -> Answer:
        """Scores of this case against the true one, a path or a Case."""
        return run("compare", self, truth, **options)

    @document("export", "list")
    def export(self, target: str, folder, **options) -> Answer:
        """Writes the folder that a simulator loads; :func:`lumen.targets` lists the targets."""
        return run("export", target, self, os.fspath(folder), **options)

    @document("info")
    def info(self, **options) -> Answer:
        """Figures of the content: counts, lengths, radii, branches."""
        return run("info", self, **options)

    @document("picture", "turntable")
    def picture(case, **options) -> Picture:
        """Draws the case: the bytes of a PNG, which a notebook shows. ``volume`` may be a path, a
        :class:`Volume` or an image; ``size`` is (width, height)."""
        return Picture(call("picture", case, Kept("picture.png"), **options)[1][0])

    @document("xray")
    def xray(case, **options) -> np.ndarray:
        """The X-ray of the case with contrast agent in it: an array (height, width) of float32, rows from the top, with
        -ln of the share of the energy that arrives at each pixel. ``lumen.run("xray", case, "a.png")`` answers where
        source and detector are."""
        header, _, voxels = call("xray", case, Kept("xray.nrrd"), **options)[1][0].partition(b"\n\n")
        width, height, _ = (int(n) for n in header.partition(b"sizes: ")[2].split(b"\n", 1)[0].split())
        return np.frombuffer(zlib.decompress(voxels, zlib.MAX_WBITS | 16), "<f4").reshape(height, width)  # gzip

    def _repr_png_(self) -> Optional[bytes]:
        return None if self.models is None else bytes(self.picture(size=(800, 600)))

    def _given(self):
        """The name and the content by which commands take this case."""
        return "case.lumen", self._core

    # ------------------------------------------------------------ object
    def __eq__(self, other):
        return isinstance(other, Case) and self._core.equals(other._core)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self):
        return Case.from_bytes, (self.to_bytes(),)

    def __repr__(self):
        points = 0 if self.points is None else len(self.points)
        blobs = 0 if self.models is None else len(self.models)
        return (f"<lumen.Case {len(self.branches)} branches, {len(self.tree)} nodes, {points} points, "
                f"{blobs} blobs>")


def _bits(point_bits: int) -> int:
    if not isinstance(point_bits, numbers.Integral) or not 0 <= point_bits <= 30:
        raise ValueFault(f"point_bits: found {shown(point_bits)}, expected a whole number from 0 to 30")
    return point_bits


def read(path) -> Case:
    """Reads a case, .lumen or .lumen.json, by its content.

    Parameters
    ----------
    path : path

    Returns
    -------
    Case
        Its arrays cannot be written to.

    Raises
    ------
    Error
        With file, place, rule, and the values found and expected.
    """
    path = os.fsdecode(path)
    try:
        return Case(called(_lumen.Case.read, path, known=[path]))
    except Error as error:
        if error.code != "NOT_LUMEN" or not path.endswith((".nrrd", ".nii", ".nii.gz", ".mha", ".mhd", ".dcm")):
            raise
        raise Error(f"{error}; lumen.Volume.read reads a volume, and lumen.convert makes a case of one", error.exit_code,
                    file=error.file, place=error.place, code=error.code, number=error.number) from None


def case_made(command: str, *arguments, **options) -> Case:
    """The case that a command writes as its last argument."""
    return Case(call(command, *arguments, Kept("made.lumen"), **options)[1][0])
