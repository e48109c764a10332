# SPDX-License-Identifier: Apache-2.0
"""Volumes in memory."""
from __future__ import annotations

import os
import secrets

import numpy as np

from . import _images, _lumen
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
        or booleans; integers of 64 bits whose values have 32. It is not copied if it is an array of NumPy
        of the others.
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

    _is_placed = _has_unit = True

    def __init__(self, array, spacing=1.0, origin=(0.0, 0.0, 0.0), direction=None):
        self.array = np.asarray(array)
        if self.array.ndim != 3 or self.array.size == 0:
            raise ValueError(f"array: found shape {self.array.shape}, expected (nk, nj, ni)")
        is_long = self.array.dtype.kind in "iu" and self.array.dtype.itemsize == 8
        if is_long and -2**31 <= self.array.min() and self.array.max() < 2**31:
            self.array = self.array.astype(np.int32)
        self.spacing = tuple(float(s) for s in np.broadcast_to(spacing, 3))
        self.origin = tuple(float(o) for o in origin)
        self.direction = np.eye(3) if direction is None else np.array(direction, float).reshape(3, 3)
        if len(self.origin) != 3:
            raise ValueError(f"origin: found {len(self.origin)} numbers, expected 3")
        self._type_name()

    @classmethod
    def of(cls, image) -> "Volume":
        """The volume of an image of SimpleITK, ITK, nibabel or xarray, by its own axes and frame.

        Parameters
        ----------
        image : SimpleITK.Image, itk.Image, nibabel image, xarray.DataArray, Volume or (nk, nj, ni) array
            3-D, one number a voxel. nibabel's affine leads to RAS, in the unit of its header. A DataArray has the dims
            x, y and z in any order, positions in LPS as their coordinates, in mm or in their attribute ``units``, and
            the attribute ``direction`` if ITK made it. An array alone has voxels of 1 mm at the origin.

        Raises
        ------
        ValueError
            For an image of more axes, of several numbers a voxel, or with uneven coordinates.
        """
        if isinstance(image, Volume):
            return image
        if not _images.package_of(image):
            return cls(image)
        found = _images.image_of(image)
        volume = cls(found.array, found.spacing, found.origin, found.direction)
        volume._is_placed, volume._has_unit = found.is_placed, found.has_unit
        return volume

    @classmethod
    def of_affine(cls, array, affine, frame="ras") -> "Volume":
        """The volume of an array [i, j, k], such as nibabel's ``image.get_fdata()``, and its affine.

        Parameters
        ----------
        array : (ni, nj, nk)
            The fastest axis of :class:`Volume` first: the other way round than ``Volume(array)``.
        affine : (4, 4)
            From (i, j, k) to mm; its axes are orthogonal.
        frame : "ras" or "lps"
            Frame that the affine leads to: NIfTI's is RAS.
        """
        found = _images.of_affine(array, affine, frame)
        return cls(found.array, found.spacing, found.origin, found.direction)

    @classmethod
    def read(cls, path, *, progress=None, **options) -> "Volume":
        """Reads NRRD, NIfTI, MetaImage, or a folder of DICOM; options as those of a volume in
        :func:`lumen.convert` (series, crop, spacing, unit...). The array points into the volume."""
        path = os.fspath(path)
        voxels, warnings = called(_lumen.read_volume, path, texts_of("convert", options), progress,
                                  known=[path])
        warn(warnings)
        return cls(voxels.array, voxels.spacing, voxels.origin, voxels.direction)

    def like(self, array) -> "Volume":
        """The volume of another array at the place of this one, such as labels of the same shape."""
        if np.shape(array) != self.shape:
            raise ValueError(f"array: found shape {np.shape(array)}, expected that of the volume, {self.shape}")
        return Volume(array, self.spacing, self.origin, self.direction)

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

    def _staged(self, staging) -> str:
        """The name of a file with this volume."""
        path = staging.name("volume.nrrd")
        with open(path, "wb") as file:
            self._write_to(file)
        return path

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
        # the engine warns of a space and of a unit that do not state left and right, or a length
        space = "left-posterior-superior" if self._is_placed else "scanner-xyz"
        unit = '"mm"' if self._has_unit else '"?"'
        header = (f"NRRD0004\ntype: {self._type_name()}\ndimension: 3\n"
                  f"space: {space}\nsizes: {sizes}\nspace directions: {axes}\n"
                  f"kinds: domain domain domain\nendian: little\nencoding: raw\n"
                  f"space units: {unit} {unit} {unit}\nspace origin: {vector(self.origin)}\n\n")
        file.write(header.encode())
        little = self.array.dtype.newbyteorder("<") if self.array.dtype != bool else "u1"
        np.ascontiguousarray(self.array).astype(little, copy=False).tofile(file)

    def __repr__(self):
        return f"<lumen.Volume {self.array.shape} {self.array.dtype}, {self.spacing} mm>"
