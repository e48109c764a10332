# SPDX-License-Identifier: Apache-2.0
"""Operations on volumes and files."""
from __future__ import annotations

import json
import os
import re
from typing import Any, List, Mapping, NamedTuple

from ._case import Case, case_made
from ._errors import Error, ValueFault, shown
from ._images import I_FIRST, axes_of, is_array, package_of, turned
from ._inputs import Volume
from ._options import commands, document, keyword_of, rows_of
from ._running import Answer, Kept, call, run


_NO_LABELS = re.compile("no voxel has the label|expected labels")


@document("track", "to", "seeds")
def track(volume, *, seeds=None, **options) -> Case:
    """Tracks vessels through a volume: a case with its tree and wall points, without models.

    Parameters
    ----------
    volume : path, Volume, image or (nk, nj, ni) array
        An array alone has voxels of 1 mm at the origin; :class:`Volume` states the geometry. Images of SimpleITK, ITK,
        nibabel and xarray have their own: :meth:`Volume.of`.
    seeds : path, dict or list of dicts, optional
        Hints on the vessels, and starts of others: a file, ``{label: points (n, 3)}`` in mm, LPS, or
        branches with the keys of spec/seeds.md.

    Returns
    -------
    Case
    """
    volume, options = _beside(volume, options)
    return case_made("track", volume, seeds=seeds, **options)


@document("convert", "to")
def convert(source, to=None, **options) -> Any:
    """Turns a volume, a surface, a label map, a centerline or a case into a case, or into a file.

    Parameters
    ----------
    source : path, Volume, image, (nk, nj, ni) array or Case
        As for :func:`track`.
    to : path, optional
        File to write: .lumen, a mesh (.glb, .vtp, .stl, .ply, .obj) or a centerline (.swc, .vtp).
        The name states the format, so no ``to=`` option of the program is needed.
    label_map : path, Volume, image or array, or a list of them, optional
        Labels that name branches and state what is a vessel or none.
    native : path, Volume, image or array, optional
        Computed tomography of the same body without contrast, whose bone is registered and subtracted.
    role : dict, optional
        Roles of labels, such as ``{"aorta": "artery", 5: "bone"}``.
    label_table : path, name or dict, optional
        Names of the labels, such as ``{1: "BA"}``.
    labels : str, dict, array, Volume or image, optional
        A dict ``{1: "ICA", 2: "MCA"}``: the volume holds labels, and these are of vessels. Others as for :func:`case_of`.

    Returns
    -------
    Case
        Without ``to``: tracked and fitted.
    Answer
        With ``to``: what was written.

    Examples
    --------
    >>> from lumen.options import Fitting, Tracking
    >>> case = lumen.convert(nibabel.load("head.nii.gz"), **Tracking(inlier_rate=0.6), **Fitting(accuracy=0.2))
    >>> case.to_pyvista().plot()
    """
    if to is not None and not isinstance(to, (str, os.PathLike)):
        hint = "keywords: pass **Tracking(...)" if isinstance(to, dict) else "a path"
        raise ValueFault(f"to: found {shown(to)}, expected {hint}")
    source, options = _beside(source, options)
    return _made(source, **options) if to is None else run("convert", source, os.fspath(to), **options)


def _made(source, **options) -> Case:
    """The case that lumen convert makes. Adds a hint to the refusal of a volume that holds no labels."""
    try:
        return case_made("convert", source, **options)
    except Error as error:
        if not isinstance(options.get("labels"), Mapping) or not _NO_LABELS.search(str(error)):
            raise
        raise Error(f"{error}; labels= are those that the volume itself holds: did you mean label_table?",
                    error.exit_code, file=error.file, place=error.place, found=error.found,
                    expected=error.expected) from None


def case_of(source, *, affine=None, affine_frame="ras", labels=None, **options) -> Case:
    """The case of a volume in memory, tracked and fitted: :func:`convert` without a file.

    Parameters
    ----------
    source : array, Volume, image, path or Case
        As for :func:`convert`; an array [k, j, i] without ``affine``, and [i, j, k] with it.
    affine : (4, 4), optional
        From the indices (i, j, k) of the array to mm, as nibabel's ``image.affine``; axes that lean are resampled.
    affine_frame : "ras" or "lps"
        Frame that the affine leads to.
    labels : array, Volume, image or dict, optional
        Labels beside the volume, which name its branches: an image, or an array in the shape and axes of ``source``:
        [i, j, k] for an image of nibabel or with ``affine``, those of its dims for one of xarray, else [k, j, i]. A
        dict ``{1: "ICA"}`` states that the volume itself holds labels, and which are of vessels.
    **options
        Those of :func:`convert`, such as ``label_table={1: "BA", 2: "ICA"}``.

    Returns
    -------
    Case

    Examples
    --------
    >>> case = lumen.case_of(image.get_fdata(), affine=image.affine, labels=segmentation, label_table={1: "BA"})
    >>> plane = case.surface()[0][:, [0, 2]]                      # x and z: from the front
    >>> matplotlib.pyplot.scatter(*plane.T, s=1)
    """
    if affine is not None:
        _check_array(source)
        source = Volume.of_affine(source, affine, affine_frame)
    source, options = _beside(source, {"labels": labels, **options}, None if affine is None else I_FIRST)
    return _made(source, **options)


def _check_array(source) -> None:
    """Raises ValueFault for what has a place of its own, and needs no affine."""
    if package_of(source) == "nibabel":
        raise ValueFault("affine: the image has its own; leave it out, or pass image.get_fdata()")
    if package_of(source) or isinstance(source, (str, os.PathLike, Volume, Case)):
        raise ValueFault(f"affine: the {type(source).__name__} has its own place; leave it out, or pass an array "
                         "[i, j, k]")


def _beside(source, options, axes=None):
    """The source and options, of which labels beside the source, arrays in its axes, become a label map."""
    labels = options.get("labels")
    if "affine" in options:
        raise ValueFault("affine: use lumen.case_of(array, affine=...), or lumen.Volume.of_affine(array, affine)")
    given = source
    if is_array(source) or package_of(source):
        source = Volume.of(source)
        source._is_bare = is_array(given) and not {"spacing", "unit"} & options.keys()
    if labels is None or isinstance(labels, (str, Mapping)):
        return source, options
    if is_array(labels):
        if not isinstance(source, Volume):
            raise ValueFault("labels: found an array beside a value without axes, expected a volume or an image as the "
                             "source, such as lumen.Volume.read(path)")
        labels = source.like(turned(labels, axes or axes_of(given), source.shape))
    return source, {**options, "label_map": labels, "labels": None}


@document("seeds")
def find_vessels(source, **options) -> List[dict]:
    """The vessels of a volume as seeds to edit, found without a click.

    Parameters
    ----------
    source : path, Volume, image or (nk, nj, ni) array; or a Case, whose seeds are returned

    Returns
    -------
    list of dicts
        Branches with ``label``, ``points`` (mm, LPS), ``radius`` and ``parent`` (spec/seeds.md), as
        ``seeds=`` of :func:`track` and :func:`convert` takes them.
    """
    return _branches(call("seeds", source, Kept("seeds.json"), **options)[1][0])


def _branches(seeds: bytes) -> List[dict]:
    return json.loads(seeds)["branches"]


class Phantom(NamedTuple):
    """A synthetic angiogram with its truth."""
    volume: Volume
    truth: Case
    seeds: List[dict]  #: the clicks that a user would make, spec/seeds.md


@document("phantom", "truth", "seeds", "motion", "phases")
def phantom(name: str, **options) -> Phantom:
    """Makes a synthetic angiogram with a known truth, such as "bifurcation" or "patient".

    Returns
    -------
    Phantom
        ``volume``, ``truth`` and ``seeds``.
    """
    if options.get("motion") not in (None, "none"):
        raise ValueFault("motion: found several phases, which are files: lumen.run(\"phantom\", name, path, "
                         f"motion={options['motion']!r}), expected one volume")
    _, (volume, truth, seeds) = call("phantom", name, Kept("volume.nrrd"), truth=Kept("truth.lumen"),
                                     seeds=Kept("seeds.json"), **options)
    return Phantom(Volume.from_bytes(volume), Case(truth), _branches(seeds))


def check(volume, case, **options) -> Answer:
    """Agreement of a case with its volume: see :meth:`Case.check`."""
    return run("check", volume, case, **options)


def export(target: str, case, folder, **options) -> Answer:
    """The folder that a simulator loads: see :meth:`Case.export`."""
    return run("export", target, case, os.fspath(folder), **options)


# of a case, or of a path of one
validate, fit, mesh, measure = Case.validate, Case.fit, Case.mesh, Case.measure
picture, xray = Case.picture, Case.xray


def targets() -> List[dict]:
    """The targets of :meth:`Case.export`: name, title, files, units, axes, contents and options."""
    answer = run("export", list=True)
    return answer["targets"]


def options_of(command: str) -> List[dict]:
    """The options of a command: keyword, type, default, range, words and help."""
    if command not in commands():
        run(command)
    return [{"keyword": keyword_of(row["name"]),
             **{key: row[key] for key in ("type", "placeholder", "default", "range", "words", "help")}}
            for row in rows_of(command)]
