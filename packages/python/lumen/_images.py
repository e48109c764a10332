# SPDX-License-Identifier: Apache-2.0
"""Images of SimpleITK, ITK, nibabel and xarray as arrays [k, j, i] with their geometry in mm, LPS.

None of these packages is imported: an image is known by the module of its class, and whoever has one has loaded its
package.
"""
from __future__ import annotations

import sys
from typing import Any, NamedTuple, Tuple

import numpy as np

_MILLIMETRES = {"meter": 1e3, "m": 1e3, "cm": 10.0, "mm": 1.0, "millimeter": 1.0, "micron": 1e-3, "um": 1e-3}
_RAS = np.array([-1.0, -1.0, 1.0])


class Image(NamedTuple):
    """An image as :class:`lumen.Volume` takes it."""
    array: Any
    spacing: Any     #: (3,), mm
    origin: Any      #: (3,), mm, LPS
    direction: np.ndarray
    is_placed: bool = True   #: whether it states where the patient's left, back and head are
    has_unit: bool = True    #: whether it states the unit of its lengths


def package_of(value: Any) -> str:
    """The package of the image's class or of one that it is derived from, or ""."""
    packages = (kind.__module__.partition(".")[0] for kind in type(value).__mro__)
    return next((package for package in packages if package in _READERS), "")


def image_of(value: Any) -> Image:
    """The image of a package. Raises ValueError if it is no 3-D image of one number a voxel."""
    return _READERS[package_of(value)](value)


def of_affine(array: Any, affine: Any, frame: str = "ras") -> Image:
    """An array [i, j, k] with its affine (4, 4) from (i, j, k) to mm in a frame, "ras" or "lps"."""
    matrix = np.array(affine, float)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or abs(matrix[3] - (0, 0, 0, 1)).max() > 1e-9:
        raise ValueError(f"affine: found {np.array2string(matrix, separator=', ')}, expected a matrix (4, 4) of finite "
                         "numbers whose last row is 0, 0, 0, 1")
    if frame not in ("ras", "lps"):
        raise ValueError(f"frame: found {frame!r}, expected 'ras' or 'lps'")
    if frame == "ras":
        matrix[:3] *= _RAS[:, None]
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    if not (spacing > 0).all():
        raise ValueError("affine: found an axis without a length, expected three that place the voxels")
    return Image(_three_axes(array).T, spacing, matrix[:3, 3], matrix[:3, :3] / spacing)


def _three_axes(array: Any) -> np.ndarray:
    """The array without further axes of one step. Raises ValueError if more than three are left."""
    array = np.asanyarray(array)
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    if array.ndim != 3:
        raise ValueError(f"image: found {array.ndim} axes, {' x '.join(map(str, array.shape))}, expected 3: choose one "
                         "volume of it first, such as image.slicer[..., 0] of nibabel, or array[..., 0]")
    return array


def _of_itk(image: Any) -> Image:
    """An image of ITK or SimpleITK: arrays [k, j, i] and LPS, as lumen has them."""
    package = sys.modules[package_of(image)]
    is_simple = hasattr(image, "GetDimension")
    axes = image.GetDimension() if is_simple else image.GetImageDimension()
    numbers = image.GetNumberOfComponentsPerPixel()
    if axes != 3 or numbers != 1:
        raise ValueError(f"image: found {axes} axes and {numbers} numbers a voxel, expected 3 and 1: choose one volume "
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
                          is_placed=is_placed, has_unit=unit in _MILLIMETRES)


def _of_xarray(image: Any) -> Image:
    """A DataArray with the axes z, y, x in any order, positions in mm, LPS, as coordinates, and, as ITK writes it,
    attrs["direction"] in the order z, y, x, by which the axes turn about the first voxel."""
    if set(image.dims) != {"x", "y", "z"}:
        raise ValueError(f"image: found the dims {', '.join(map(str, image.dims))}, expected x, y and z: choose one "
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
        raise ValueError(f"image: found no coordinates of the dim {axis}, expected its positions in mm, LPS")
    coordinate = image.coords[axis]
    unit = coordinate.attrs.get("units", "mm")
    if unit not in _MILLIMETRES:
        raise ValueError(f"image: found the units {unit!r} of {axis}, expected one of {', '.join(_MILLIMETRES)}")
    places = np.asarray(coordinate.data, float) * _MILLIMETRES[unit]
    step = (places[-1] - places[0]) / max(len(places) - 1, 1)
    if not abs(np.diff(places) - step).max(initial=0) <= 1e-3 * abs(step) or step == 0:
        raise ValueError(f"image: found uneven steps along {axis}, expected equal ones: resample it first")
    return step, places[0]


_READERS = {"SimpleITK": _of_itk, "itk": _of_itk, "nibabel": _of_nibabel, "xarray": _of_xarray}
