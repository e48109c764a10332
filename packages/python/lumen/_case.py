# SPDX-License-Identifier: Apache-2.0
"""The case: metadata, a tree of centerlines, wall points and models."""
from __future__ import annotations

import json
import os
from typing import Any, Dict, Optional

import numpy as np

from . import _lumen
from ._calls import called
from ._editing import Editor
from ._inputs import Staging
from ._mesh_file import read_mesh
from ._options import document
from ._parts import Change, Mesh, Models, Motion, Picture, Points, Tree
from ._running import Answer, run_staged


class Case:
    """A vessel case in memory. :func:`lumen.read` reads one.

    Arrays of the tree, the points and the models are views of the case's memory: they are never
    copied, and keep the case alive. Those of a case that was read or made cannot be written to;
    :meth:`copy` gives one whose arrays can be. All lengths are in mm, all coordinates LPS (+x left,
    +y back, +z head).
    """

    def __init__(self, core, change: Optional[Change] = None):
        if not isinstance(core, _lumen.Case):
            raise TypeError("lumen.read() reads a case, Case.from_bytes() decodes one")
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
            raise ValueError(f"{path}: found another name, expected one in .lumen or .lumen.json; "
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
            raise ValueError(f"found times of shape {times.shape} and nodes of shape {nodes.shape}, "
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
                raise KeyError(f"{label}: found no such branch, expected one of {', '.join(names)}")
            return names.index(label)
        index = range(len(names))[label]
        return index

    @property
    def edit(self) -> Editor:
        """Corrections by hand: ``case.edit.rename("b3", "MCA")`` returns a new case."""
        return Editor(self)

    # ------------------------------------------------------------ work
    def validate(self, **options) -> Answer:
        """All faults of the case: see :func:`lumen.validate`."""
        return validate(self, **options)

    def fit(self, *, progress=None, threads=None, strict=False, **options) -> "Case":
        """Fits models to the wall points; returns a new case."""
        return self._made("fit", progress, threads, strict, options)

    def trim(self, *, progress=None, threads=None, strict=False, **options) -> "Case":
        """Removes ends of vessels that are too thin or too short; returns a new case."""
        return self._made("trim", progress, threads, strict, options)

    def mesh(self, *, progress=None, threads=None, strict=False, **options) -> Mesh:
        """The closed surface, or its patches, as arrays.

        Returns
        -------
        Mesh
            Vertices (v, 3) float32, mm, LPS; triangles (t, 3) int32, facing outwards.
        """
        with Staging() as staging:
            path = staging.name("mesh.ply")
            run_staged(staging, "convert", (self, path), options, progress, threads, strict)
            return read_mesh(path)

    def measure(self, *, progress=None, threads=None, strict=False, **options) -> Answer:
        """Measures vessels, paths, forks, narrowings and aneurysms, each with its uncertainty.

        Returns
        -------
        Answer
            Tables with units in their keys: spec/answers/measure.schema.json.
        """
        return self._asked("measure", (), progress, threads, strict, options)

    def check(self, volume, *, progress=None, threads=None, strict=False, **options) -> Answer:
        """Agreement with the volume (a path, or a :class:`Volume`): wall, dark lumen, missing
        vessels."""
        with Staging() as staging:
            return run_staged(staging, "check", (volume, self), options, progress, threads, strict)

    def compare(self, truth, *, progress=None, threads=None, strict=False, **options) -> Answer:
        """Scores of this case against the true one, a path or a Case."""
        return self._asked("compare", (truth,), progress, threads, strict, options)

    def export(self, target: str, folder, *, progress=None, threads=None, strict=False,
               **options) -> Answer:
        """Writes the folder that a simulator loads; :func:`lumen.targets` lists the targets."""
        with Staging() as staging:
            arguments = (target, self, os.fspath(folder))
            return run_staged(staging, "export", arguments, options, progress, threads, strict)

    def info(self, *, progress=None, threads=None, strict=False, **options) -> Answer:
        """Figures of the content: counts, lengths, radii, branches."""
        return self._asked("info", (), progress, threads, strict, options)

    def picture(self, *, progress=None, threads=None, strict=False, **options) -> Picture:
        """Draws the case: the bytes of a PNG, which a notebook shows. ``volume`` may be a path or a
        :class:`Volume`; ``size`` is (width, height)."""
        with Staging() as staging:
            path = staging.name("picture.png")
            run_staged(staging, "picture", (self, path), options, progress, threads, strict)
            with open(path, "rb") as file:
                return Picture(file.read())

    def _repr_png_(self) -> Optional[bytes]:
        return None if self.models is None else bytes(self.picture(size=(800, 600)))

    def _staged(self, staging: Staging) -> str:
        path = staging.name("case.lumen")
        self.write(path)
        return path

    def _asked(self, command, others, progress, threads, strict, options) -> Answer:
        with Staging() as staging:
            return run_staged(staging, command, (self, *others), options, progress, threads, strict)

    def _made(self, command, progress, threads, strict, options) -> "Case":
        with Staging() as staging:
            path = staging.name("made.lumen")
            run_staged(staging, command, (self, path), options, progress, threads, strict)
            return Case(_lumen.Case.read(path))

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


def validate(source, *, progress=None, threads=None, strict=False, **options) -> Answer:
    """All faults of a case.

    Parameters
    ----------
    source : path or Case

    Returns
    -------
    Answer
        ``valid``, ``errors``, ``warnings``, ``information`` and ``issues``, each with code, number,
        severity, pointer or offset, arguments and message.
    """
    if isinstance(source, Case):
        errors, warnings, notes, issues = source._core.issues(  # pylint: disable=protected-access
            int(options.get("max_issues") or 100))
        if errors:
            answer = Answer(file=None, valid=False, complete=len(issues) == errors + warnings + notes,
                            errors=errors, warnings=warnings, information=notes, issues=issues)
            answer.text = "\n".join(f"{i['code']} at {i['pointer']}: {i['message']}" for i in issues)
            answer.code, answer.warnings = 3, []
            return answer
    with Staging() as staging:
        whole = run_staged(staging, "validate", (source,), options, progress, threads, strict)
    answer = Answer(whole["files"][0])
    if isinstance(source, Case):
        answer["file"] = None
    answer.text, answer.code, answer.warnings = whole.text, whole.code, whole.warnings
    return answer


def _bits(point_bits: int) -> int:
    if not 0 <= point_bits <= 30:
        raise ValueError(f"point_bits: found {point_bits}, expected a whole number from 0 to 30")
    return point_bits


for _name in ("fit", "trim", "measure", "check", "compare", "export", "info", "picture"):
    document(getattr(Case, _name), _name, "to", "turntable", "list")
