# SPDX-License-Identifier: Apache-2.0
"""Volumes in memory."""
from __future__ import annotations

import os

import numpy as np

from . import _images, _lumen
from ._calls import called, report, watch_of
from ._errors import ValueFault
from ._options import texts_of

# The engine's names of types, and the types that it holds of others.
_TYPES = {"b1": "unsigned char", "i1": "signed char", "u1": "unsigned char", "i2": "short", "u2": "unsigned short",
          "i4": "int", "u4": "unsigned int", "f4": "float", "f8": "double"}
_STAGED = "volume.nrrd"  # the name by which the engine knows voxels that lie in no file
_HELD = {"i1": "i2", "i4": "f4", "u4": "f4", "f8": "f4"}


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
    _is_bare = False  # an array whose voxel size nobody stated
    _file = ""  # of the image, for messages

    def __init__(self, array, spacing=1.0, origin=(0.0, 0.0, 0.0), direction=None):
        self.array = np.asarray(array)
        if self.array.ndim != 3:
            hint = ": choose one of its numbers or volumes first, such as array[..., 0]"
            raise ValueFault(f"array: found shape {self.array.shape}, expected (nk, nj, ni)"
                             f"{hint if self.array.ndim == 4 else ''}")
        if self.array.size == 0:
            raise ValueFault(f"array: found shape {self.array.shape}, expected (nk, nj, ni) above 0: it has no voxels")
        is_long = self.array.dtype.kind in "iu" and self.array.dtype.itemsize == 8
        if is_long and -2**31 <= self.array.min() and self.array.max() < 2**31:
            self.array = self.array.astype(np.int32)
        self.spacing = tuple(float(s) for s in np.broadcast_to(spacing, 3))
        self.origin = tuple(float(o) for o in origin)
        self.direction = np.eye(3) if direction is None else np.array(direction, float).reshape(3, 3)
        if len(self.origin) != 3:
            raise ValueFault(f"origin: found {len(self.origin)} numbers, expected 3")
        if self.array.dtype.str[1:] not in _TYPES:
            raise ValueFault(f"array: found {self.array.dtype}, expected integers of 8 to 32 bits, "
                             "float32, float64 or bool")

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
        ValueFault
            For an image of more axes, of several numbers a voxel, or with uneven coordinates.
        """
        if isinstance(image, Volume):
            return image
        if not _images.package_of(image):
            return cls(image)
        found = _images.image_of(image)
        volume = cls(found.array, found.spacing, found.origin, found.direction)
        volume._is_placed, volume._has_unit, volume._file = found.is_placed, found.has_unit, found.file
        return volume

    @classmethod
    def of_affine(cls, array, affine, frame="ras") -> "Volume":
        """The volume of an array [i, j, k], such as nibabel's ``image.get_fdata()``, and its affine.

        Parameters
        ----------
        array : (ni, nj, nk)
            The fastest axis of :class:`Volume` first: the other way round than ``Volume(array)``.
        affine : (4, 4)
            From (i, j, k) to mm; axes that lean are resampled to an upright grid.
        frame : "ras" or "lps"
            Frame that the affine leads to: NIfTI's is RAS.
        """
        found = _images.of_affine(array, affine, frame)
        return cls(found.array, found.spacing, found.origin, found.direction)

    @classmethod
    def read(cls, path, *, progress=None, **options) -> "Volume":
        """Reads NRRD, NIfTI, MetaImage, or a folder of DICOM; options as those of a volume in
        :func:`lumen.convert` (series, crop, spacing, unit...). The array points into the volume."""
        return cls._read(os.fspath(path), None, progress, options)

    @classmethod
    def from_bytes(cls, data: bytes, *, name=_STAGED, progress=None, **options) -> "Volume":
        """Reads the content of a file of NRRD, NIfTI or MetaImage. Its name states the format, and messages begin
        with it; options as those of :meth:`read`."""
        return cls._read(name, bytes(data), progress, options)

    @classmethod
    def _read(cls, name, data, progress, options):
        progress, *_ = watch_of({"progress": progress})
        words = [] if data is None or name != _STAGED else [(name, "volume")]
        voxels, warnings = called(_lumen.read_volume, name, data, texts_of("convert", options), progress, known=[name],
                                  words=words)
        report(warnings, words=words)
        return cls(voxels.array, voxels.spacing, voxels.origin, voxels.direction)

    def like(self, array) -> "Volume":
        """The volume of another array at the place of this one, such as labels of the same shape."""
        if np.shape(array) != self.shape:
            raise ValueFault(f"array: found shape {np.shape(array)}, expected that of the volume, {self.shape}")
        return Volume(array, self.spacing, self.origin, self.direction)

    @property
    def shape(self):
        """(nk, nj, ni)."""
        return self.array.shape

    def position(self, index):
        """Positions (..., 3), mm, LPS, of voxel indices (..., 3) in the order i, j, k."""
        return np.asarray(index) * self.spacing @ self.direction.T + self.origin

    def write(self, path) -> None:
        """Writes NRRD, NIfTI or MetaImage, by the ending of the name, atomically: a reader sees the old file or the
        new one.

        Parameters
        ----------
        path : path
            ``.nrrd`` holds every type of voxels as it is; ``.nii``, ``.nii.gz`` and ``.mha`` hold int8 as int16, and
            integers of 32 bits and float64 as float32.
        """
        path = os.fspath(path)
        is_exact = path.lower().endswith(".nrrd")
        called(_lumen.write_volume, path, self._parts({} if is_exact else _HELD), known=[path])

    def _words(self, name):
        """Words of messages for users in place of the engine's, which takes this volume as an NRRD of a name."""
        words = []
        if not self._is_placed:
            words += [(f'{name}: its space is "scanner-xyz", which does not', f"{name}: its header does not")]
        if self._is_bare:
            words += [(f'{name}: its space units are "?" "?" "?", which are not all known as lengths, so they are taken '
                       "to be mm; state the unit with --unit",
                       f"{name}: an array states no voxel size, so voxels are taken to be 1 mm wide; pass spacing=1 to "
                       "state it")]
        elif not self._has_unit:
            words += [(f'{name}: its space units are "?" "?" "?", which are not all known as lengths, so they are taken '
                       "to be mm; state the unit with --unit",
                       f'{name}: its header states no unit of length, so lengths are taken as mm; pass unit="mm" to '
                       "state it")]
        return words + [(name, self._file or name.partition(".")[0])]

    def _given(self):
        """The name and the content by which commands take this volume."""
        return _STAGED, self._parts({})

    def _parts(self, types):
        """As the compiled module takes it: the voxels in the machine's order, in the place of `types`, of which there
        is a copy only where the array's memory is in another order."""
        kind = self.array.dtype.str[1:]
        kind = types.get(kind, kind)
        return (np.ascontiguousarray(self.array, "<" + kind), _TYPES[kind], self.spacing, self.origin,
                self.direction.ravel().tolist(), self._is_placed, self._has_unit and not self._is_bare)

    def __repr__(self):
        return f"<lumen.Volume {self.array.shape} {self.array.dtype}, {self.spacing} mm>"
