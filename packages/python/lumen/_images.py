# SPDX-License-Identifier: Apache-2.0
"""Images of SimpleITK, ITK, nibabel and xarray as arrays [k, j, i] with their geometry in mm, LPS.

None of these packages is imported: an image is known by the module of its class, and whoever has one has loaded its
package.
"""
from __future__ import annotations

import os
import sys
from typing import Any, NamedTuple, Tuple

import numpy as np

from ._errors import ValueFault

_MILLIMETRES = {"meter": 1e3, "m": 1e3, "cm": 10.0, "mm": 1.0, "millimeter": 1.0, "micron": 1e-3, "um": 1e-3}
I_FIRST = (2, 1, 0)  # places of k, j and i in arrays [i, j, k]
_RAS = np.array([-1.0, -1.0, 1.0])


class Image(NamedTuple):
    """An image as :class:`lumen.Volume` takes it."""
    array: Any
    spacing: Any     #: (3,), mm
    origin: Any      #: (3,), mm, LPS
    direction: np.ndarray
    is_placed: bool = True   #: whether it states where the patient's left, back and head are
    has_unit: bool = True    #: whether it states the unit of its lengths
    file: str = ""           #: the name of its file, without folders


def package_of(value: Any) -> str:
    """The package of the image's class or of one that it is derived from, or ""."""
    packages = (kind.__module__.partition(".")[0] for kind in type(value).__mro__)
    return next((package for package in packages if package in _READERS), "")


def is_array(value: Any) -> bool:
    """Whether the value is an array without a place."""
    return hasattr(value, "__array__") and not package_of(value)


def image_of(value: Any) -> Image:
    """The image of a package. Raises ValueFault if it is no 3-D image of one number a voxel."""
    return _READERS[package_of(value)](value)


def axes_of(value: Any) -> Tuple[int, int, int]:
    """The places of k, j and i among the axes of arrays of a volume, an image or an array."""
    package = package_of(value)
    if package == "xarray":
        return value.dims.index("z"), value.dims.index("y"), value.dims.index("x")
    return I_FIRST if package == "nibabel" else (0, 1, 2)


def turned(array: Any, axes: Tuple[int, ...], shape: Tuple[int, ...]) -> np.ndarray:
    """The labels as an array [k, j, i] of a shape, whose axes are at these places. Raises ValueFault for another."""
    array = _without_ones(np.asanyarray(array))
    own = tuple(shape[axes.index(axis)] for axis in range(3))
    if array.shape != own:
        names = ", ".join("kji"[axes.index(axis)] for axis in range(3))
        raise ValueFault(f"labels: found shape {array.shape}, expected that of the volume in its own axes [{names}], "
                         f"{own}")
    return array.transpose(axes)


def of_affine(array: Any, affine: Any, frame: str = "ras") -> Image:
    """An array [i, j, k] with its affine (4, 4) from (i, j, k) to mm in a frame, "ras" or "lps"."""
    matrix = np.array(affine, float)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or abs(matrix[3] - (0, 0, 0, 1)).max() > 1e-9:
        raise ValueFault(f"affine: found {np.array2string(matrix, separator=', ')}, expected a matrix (4, 4) of finite "
                         "numbers whose last row is 0, 0, 0, 1")
    if frame not in ("ras", "lps"):
        raise ValueFault(f"frame: found {frame!r}, expected 'ras' or 'lps'")
    if frame == "ras":
        matrix[:3] *= _RAS[:, None]
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    if not (spacing > 0).all():
        raise ValueFault("affine: found an axis without a length, expected three that place the voxels")
    return Image(_three_axes(array).T, spacing, matrix[:3, 3], matrix[:3, :3] / spacing)


def _three_axes(array: Any) -> np.ndarray:
    """The array without further axes of one step. Raises ValueFault if more than three are left."""
    array = _without_ones(np.asanyarray(array))
    if array.dtype.names:
        raise ValueFault(f"image: found {len(array.dtype.names)} numbers a voxel, expected 1: choose one colour first, "
                         f"such as array[{array.dtype.names[0]!r}]")
    if array.ndim != 3:
        raise ValueFault(f"image: found {array.ndim} axes, {' x '.join(map(str, array.shape))}, expected 3: choose one "
                         "volume of it first, such as image.slicer[..., 0] of nibabel, or array[..., 0]")
    return array


def _without_ones(array: np.ndarray) -> np.ndarray:
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    return array


def _of_itk(image: Any) -> Image:
    """An image of ITK or SimpleITK: arrays [k, j, i] and LPS, as lumen has them."""
    package = sys.modules[package_of(image)]
    is_simple = hasattr(image, "GetDimension")
    axes = image.GetDimension() if is_simple else image.GetImageDimension()
    numbers = image.GetNumberOfComponentsPerPixel()
    if axes != 3 or numbers != 1:
        raise ValueFault(f"image: found {axes} axes and {numbers} numbers a voxel, expected 3 and 1: choose one volume "
                         "first, such as image[:, :, :, 0] of SimpleITK")
    if is_simple:
        array, direction = package.GetArrayFromImage(image), image.GetDirection()  # a view would not keep the image
    else:
        array, direction = package.array_from_image(image), package.array_from_matrix(image.GetDirection())
    return Image(array, tuple(image.GetSpacing()), tuple(image.GetOrigin()), np.array(direction, float).reshape(3, 3))


def _of_nibabel(image: Any) -> Image:
    """An image of nibabel: arrays [i, j, k] and an affine to RAS in the unit of the header."""
    header, affine = image.header, image.affine
    is_placed = affine is not None and not (
        hasattr(header, "get_qform") and header["sform_code"] == 0 and header["qform_code"] == 0)
    if is_placed:
        found = of_affine(image.dataobj, affine)
    else:  # as lumen reads such a file
        found = of_affine(image.dataobj, np.diag([*header.get_zooms()[:3], 1.0]), "lps")
    unit = header.get_xyzt_units()[0] if hasattr(header, "get_xyzt_units") else "mm"
    scale = _MILLIMETRES.get(unit, 1.0)
    return found._replace(spacing=scale * np.array(found.spacing), origin=scale * np.array(found.origin),
                          is_placed=is_placed, has_unit=unit in _MILLIMETRES,
                          file=_file_of(image))


def _file_of(image: Any) -> str:
    path = image.get_filename() if hasattr(image, "get_filename") else None
    return os.path.basename(os.fspath(path or ""))


def _of_xarray(image: Any) -> Image:
    """A DataArray with the axes z, y, x in any order, positions in mm, LPS, as coordinates, and, as ITK writes it,
    attrs["direction"] in the order z, y, x, by which the axes turn about the first voxel."""
    if set(image.dims) != {"x", "y", "z"}:
        raise ValueFault(f"image: found the dims {', '.join(map(str, image.dims))}, expected x, y and z: choose one "
                         "volume of it first, such as image.isel(t=0)")
    steps, origin = zip(*(_steps(image, axis) for axis in "xyz"))
    direction = np.eye(3)
    if "direction" in image.attrs:
        direction = np.flip(np.array(image.attrs["direction"], float).reshape(3, 3))
    return Image(np.asarray(image.transpose("z", "y", "x").data), np.abs(steps), origin,
                 direction * np.sign(steps))


def _steps(image: Any, axis: str) -> Tuple[float, float]:
    """The step from one voxel to the next and the place of the first, mm, along an axis of a DataArray."""
    if axis not in image.coords:
        raise ValueFault(f"image: found no coordinates of the dim {axis}, expected its positions in mm, LPS")
    coordinate = image.coords[axis]
    unit = coordinate.attrs.get("units", "mm")
    if unit not in _MILLIMETRES:
        raise ValueFault(f"image: found the units {unit!r} of {axis}, expected one of {', '.join(_MILLIMETRES)}")
    places = np.asarray(coordinate.data, float) * _MILLIMETRES[unit]
    step = (places[-1] - places[0]) / max(len(places) - 1, 1)
    if not abs(np.diff(places) - step).max(initial=0) <= 1e-3 * abs(step) or step == 0:
        raise ValueFault(f"image: found uneven steps along {axis}, expected equal ones: resample it first")
    return step, places[0]


_READERS = {"SimpleITK": _of_itk, "itk": _of_itk, "nibabel": _of_nibabel, "xarray": _of_xarray}
