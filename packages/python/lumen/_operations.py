# SPDX-License-Identifier: Apache-2.0
"""Operations on volumes and files."""
from __future__ import annotations

import json
import os
from typing import Any, List, NamedTuple, Optional

from . import _lumen
from ._case import Case, validate
from ._inputs import Staging, Volume
from ._options import commands, document, keyword_of, mesh_rows, rows_of
from ._running import Answer, called, run, run_staged


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
    return Case(called(_lumen.Case.read, os.fspath(path)))


def track(volume, *, seeds=None, progress=None, threads=None, strict=False, **options) -> Case:
    """Tracks vessels through a volume: a case with its tree and wall points, without models.

    Parameters
    ----------
    volume : path, Volume or (nk, nj, ni) array
        An array alone has voxels of 1 mm at the origin; :class:`Volume` states the geometry.
    seeds : path, dict or list of dicts, optional
        Hints on the vessels, and starts of others: a file, ``{label: points (n, 3)}`` in mm, LPS, or
        branches with the keys of spec/seeds.md.
    progress : callable, optional
        Called with (stage, done, total or 0). An exception that it raises cancels the work.
    threads : int, optional
        Most threads.
    strict : bool
        A warning is an error.

    Returns
    -------
    Case
    """
    return _made("track", volume, dict(options, seeds=seeds), progress, threads, strict)


def convert(source, to=None, *, progress=None, threads=None, strict=False, **options) -> Any:
    """Turns a volume, a surface, a label map, a centerline or a case into a case, or into a file.

    Parameters
    ----------
    source : path, Volume, (nk, nj, ni) array or Case
    to : path, optional
        File to write: .lumen, a mesh (.glb, .vtp, .stl, .ply, .obj) or a centerline (.swc, .vtp).
        The name states the format, so no ``to=`` option of the program is needed.
    progress, threads, strict
        As for :func:`track`.

    Returns
    -------
    Case
        Without ``to``: tracked and fitted.
    Answer
        With ``to``: what was written.
    """
    if to is None:
        return _made("convert", source, options, progress, threads, strict)
    with Staging() as staging:
        return run_staged(staging, "convert", (source, os.fspath(to)), options, progress, threads,
                          strict)


def find_vessels(source, *, progress=None, threads=None, strict=False, **options) -> List[dict]:
    """The vessels of a volume as seeds to edit, found without a click.

    Parameters
    ----------
    source : path, Volume or (nk, nj, ni) array; or a Case, whose seeds are returned

    Returns
    -------
    list of dicts
        Branches with ``label``, ``points`` (mm, LPS), ``radius`` and ``parent`` (spec/seeds.md), as
        ``seeds=`` of :func:`track` and :func:`convert` takes them.
    """
    with Staging() as staging:
        path = staging.name("seeds.json")
        run_staged(staging, "seeds", (source, path), options, progress, threads, strict)
        with open(path, encoding="utf-8") as file:
            return json.load(file)["branches"]


class Phantom(NamedTuple):
    """A synthetic angiogram with its truth."""
    volume: Volume
    truth: Case
    seeds: List[dict]  #: the clicks that a user would make, spec/seeds.md


def phantom(name: str, *, progress=None, threads=None, strict=False, **options) -> Phantom:
    """Makes a synthetic angiogram with a known truth, such as "bifurcation" or "patient".

    Returns
    -------
    Phantom
        ``volume``, ``truth`` and ``seeds``.
    """
    with Staging() as staging:
        image, truth, seeds = map(staging.name, ("volume.nrrd", "truth.lumen", "seeds.json"))
        options = dict(options, truth=truth, seeds=seeds)
        run_staged(staging, "phantom", (name, image), options, progress, threads, strict)
        with open(seeds, encoding="utf-8") as file:
            branches = json.load(file)["branches"]
        return Phantom(Volume.read(image), read(truth), branches)


def fit(case, **options) -> Case:
    """Fits models to a tracked case, a path or a Case: see :meth:`Case.fit`."""
    return _case(case).fit(**options)


def mesh(case, **options):
    """The surface of a case, a path or a Case, as arrays: see :meth:`Case.mesh`."""
    return _case(case).mesh(**options)


def measure(case, **options) -> Answer:
    """Measures of a case, a path or a Case: see :meth:`Case.measure`."""
    return _case(case).measure(**options)


def check(volume, case, **options) -> Answer:
    """Agreement of a case with its volume: see :meth:`Case.check`."""
    return _case(case).check(volume, **options)


def export(target: str, case, folder, **options) -> Answer:
    """The folder that a simulator loads: see :meth:`Case.export`."""
    return _case(case).export(target, folder, **options)


def picture(case, **options):
    """The bytes of a PNG: see :meth:`Case.picture`."""
    return _case(case).picture(**options)


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


def _case(source) -> Case:
    return source if isinstance(source, Case) else read(source)


def _made(command, source, options, progress, threads, strict) -> Case:
    with Staging() as staging:
        path = staging.name("made.lumen")
        run_staged(staging, command, (source, path), options, progress, threads, strict)
        return Case(called(_lumen.Case.read, path))


document(track, "track", "to")
document(convert, "convert", "to")
document(find_vessels, "seeds")
document(phantom, "phantom", "truth", "seeds")
document(validate, "validate")
_of_meshes = {row["name"] for row in mesh_rows()}
document(Case.mesh, "convert", *(
    row["name"] for row in rows_of("convert") if row["name"] not in _of_meshes))
