# SPDX-License-Identifier: Apache-2.0
"""Volumes and seeds in memory, and the files that commands read them from."""
from __future__ import annotations

import json
import os
import secrets
import tempfile
from typing import Any

import numpy as np

from . import _lumen
from ._calls import called, warn
from ._options import texts_of

_NRRD_TYPES = {"i1": "int8", "u1": "uint8", "i2": "int16", "u2": "uint16", "i4": "int32",
               "u4": "uint32", "f4": "float", "f8": "double"}


class Volume:
    """An image volume in memory.

    Parameters
    ----------
    array : array_like, shape (nk, nj, ni)
        Voxels, the slowest axis first, as SimpleITK returns them. Integers of 8 to 32 bits, floats
        or booleans. It is not copied if it is an array of NumPy.
    spacing : float or (3,) floats
        Distance of voxels along i, j and k, mm.
    origin : (3,) floats
        Centre of voxel ``array[0, 0, 0]``, mm, LPS.
    direction : (3, 3) floats
        Column a is the LPS direction of index axis a (i, j, k); orthonormal.

    Notes
    -----
    ``position = origin + direction @ (spacing * (i, j, k))`` for voxel ``array[k, j, i]``.
    """

    def __init__(self, array, spacing=1.0, origin=(0.0, 0.0, 0.0), direction=None):
        self.array = np.asarray(array)
        if self.array.ndim != 3 or self.array.size == 0:
            raise ValueError(f"array: found shape {self.array.shape}, expected (nk, nj, ni)")
        self.spacing = tuple(float(s) for s in np.broadcast_to(spacing, 3))
        self.origin = tuple(float(o) for o in origin)
        self.direction = np.eye(3) if direction is None else np.array(direction, float).reshape(3, 3)
        if len(self.origin) != 3:
            raise ValueError(f"origin: found {len(self.origin)} numbers, expected 3")
        self._type_name()

    @classmethod
    def read(cls, path, *, progress=None, **options) -> "Volume":
        """Reads NRRD, NIfTI, MetaImage, or a folder of DICOM; options as those of a volume in
        :func:`lumen.convert` (series, crop, spacing, unit...). The array points into the volume."""
        path = os.fspath(path)
        voxels, warnings = called(_lumen.read_volume, path, texts_of("convert", options), progress,
                                  known=[path])
        warn(warnings)
        return cls(voxels.array, voxels.spacing, voxels.origin, voxels.direction)

    @property
    def shape(self):
        """(nk, nj, ni)."""
        return self.array.shape

    def position(self, index):
        """Positions (..., 3), mm, LPS, of voxel indices (..., 3) in the order i, j, k."""
        return np.asarray(index) * self.spacing @ self.direction.T + self.origin

    def write(self, path) -> None:
        """Writes NRRD, uncompressed, atomically: a reader sees the old file or the new one."""
        path = os.fspath(path)
        if not path.endswith(".nrrd"):
            raise ValueError(f"{path}: found a name without .nrrd, expected one with it")
        unfinished = os.path.join(os.path.dirname(path), f".lumen-{secrets.token_hex(8)}.nrrd")
        with open(unfinished, "xb") as file:
            try:
                self._write_to(file)
                file.flush()
                os.fsync(file.fileno())
                os.replace(unfinished, path)
            except BaseException:
                os.unlink(unfinished)
                raise

    def _type_name(self):
        kind = "u1" if self.array.dtype == bool else self.array.dtype.str[1:]
        if kind not in _NRRD_TYPES:
            raise ValueError(f"array: found {self.array.dtype}, expected integers of 8 to 32 bits, "
                             "float32, float64 or bool")
        return _NRRD_TYPES[kind]

    def _write_to(self, file) -> None:
        vector = lambda numbers: "(" + ",".join(repr(float(n)) for n in numbers) + ")"
        axes = " ".join(vector(self.direction[:, a] * self.spacing[a]) for a in range(3))
        sizes = " ".join(str(n) for n in reversed(self.array.shape))
        header = (f"NRRD0004\ntype: {self._type_name()}\ndimension: 3\n"
                  f"space: left-posterior-superior\nsizes: {sizes}\nspace directions: {axes}\n"
                  f"kinds: domain domain domain\nendian: little\nencoding: raw\n"
                  f"space units: \"mm\" \"mm\" \"mm\"\nspace origin: {vector(self.origin)}\n\n")
        file.write(header.encode())
        little = self.array.dtype.newbyteorder("<") if self.array.dtype != bool else "u1"
        np.ascontiguousarray(self.array).astype(little, copy=False).tofile(file)

    def __repr__(self):
        return f"<lumen.Volume {self.array.shape} {self.array.dtype}, {self.spacing} mm>"


def seeds_document(seeds: Any) -> dict:
    """Seeds as lumen's JSON (spec/seeds.md): a document as it is, a list of branches, or a mapping
    of labels to points (n, 3)."""
    if isinstance(seeds, dict) and "format" in seeds:
        return seeds
    if isinstance(seeds, dict):
        seeds = [{"label": label, "points": points} for label, points in seeds.items()]
    branches = [{key: _plain(value) for key, value in branch.items()} for branch in seeds]
    return {"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
            "branches": branches}


def _plain(value):
    """Arrays as nested lists, a single point as a list of one."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value


class Staging:
    """A folder for what a command reads and writes by name, removed at the end."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="lumen-")
        self._count = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._folder.cleanup()

    def name(self, name: str) -> str:
        """A new file's name in the folder."""
        self._count += 1
        folder = os.path.join(self._folder.name, str(self._count))
        os.mkdir(folder)
        return os.path.join(folder, name)

    def path_of(self, value: Any) -> str:
        """The file of an argument: a path as it is, a case or a volume written for it."""
        if hasattr(value, "_staged"):
            return value._staged(self)  # pylint: disable=protected-access
        if isinstance(value, np.ndarray):
            value = Volume(value)
        if isinstance(value, Volume):
            path = self.name("volume.nrrd")
            with open(path, "wb") as file:
                value._write_to(file)  # pylint: disable=protected-access
            return path
        return os.fspath(value)

    def seeds(self, value: Any) -> Any:
        """The file of seeds: a path as it is, others written as lumen's JSON."""
        if value is None or isinstance(value, (str, os.PathLike)):
            return value
        path = self.name("seeds.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(seeds_document(value), file)
        return path

    def without_folder(self, message: str) -> str:
        """A message without the folder: names of its files alone."""
        parts = message.split(self._folder.name + os.sep)
        return parts[0] + "".join(part.partition(os.sep)[2] for part in parts[1:])
