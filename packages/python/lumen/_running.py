# SPDX-License-Identifier: Apache-2.0
"""Runs of the program's commands, and the files through which they take and give values."""
from __future__ import annotations

import json
import logging
import os
import tempfile
from typing import Any, Dict, Mapping

from . import _images, _lumen
from ._calls import called, warn
from ._errors import Error
from ._exchange import tables_of
from ._inputs import Volume
from ._options import commands, option_of, texts_of

_LOG = logging.getLogger("lumen")


class Answer(dict):
    """The answer of a command: a dictionary with the keys of the command's JSON answer
    (spec/answers), units in their names.

    Attributes
    ----------
    text : str
        The answer for people.
    code : int
        The exit code: 3 for a complete answer on an input that is not valid, else 0.
    warnings : list of str
        Facts that make the result doubtful; each is also a :class:`lumen.Warning`.
    """

    text: str
    code: int
    warnings: list

    def tables(self) -> Dict[str, Any]:
        """The tables of :meth:`lumen.Case.measure` as pandas.DataFrames.

        Returns
        -------
        dict of DataFrames
            "stations", "vessels", "paths", "forks", "narrowings" and "sacs", and the changes against an earlier case,
            with the columns that ``lumen measure --out`` writes: units in their names, ``_pm`` for the uncertainty,
            NaN for what is absent, with the reason in the column "absent".

        Examples
        --------
        >>> stations = case.measure().tables()["stations"]
        >>> stations.plot("along_mm", "area_mm2", yerr="area_mm2_pm")
        """
        return tables_of(self)


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
        """The file of an argument: a path as it is, a case, a volume or an image written for it."""
        if not isinstance(value, (str, os.PathLike)) and (_images.package_of(value) or hasattr(value, "__array__")):
            value = Volume.of(value)
        if hasattr(value, "_staged"):
            return value._staged(self)  # pylint: disable=protected-access
        if isinstance(value, (str, bytes, os.PathLike)):
            return os.fsdecode(value)
        raise TypeError(f"found {type(value).__module__}.{type(value).__name__}, expected a path, a lumen.Case, a "
                        "lumen.Volume, an array, or an image of SimpleITK, ITK, nibabel or xarray")

    def json_of(self, name: str, content: Any) -> str:
        """A new file with a content as JSON."""
        path = self.name(name)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)
        return path

    def option(self, row: Dict[str, Any], value: Any) -> Any:
        """The value of an option as texts can state it: names of files in place of values in memory."""
        if value is None or isinstance(value, (str, os.PathLike)):
            return value
        if row["name"] == "seeds":
            return self.json_of("seeds.json", seeds_document(value))
        if row["name"] == "label-table":
            return self.json_of("labels.json", {str(int(label)): name for label, name in value.items()})
        if row["name"] == "labels" and isinstance(value, Mapping):
            return ",".join(f"{int(label)}={name}" for label, name in value.items())
        return self.path_of(value) if row["placeholder"] == "FILE" else value

    def without_folder(self, message: str) -> str:
        """A message without the folder: names of its files alone."""
        parts = message.split(self._folder.name + os.sep)
        return parts[0] + "".join(part.partition(os.sep)[2] for part in parts[1:])


def run_staged(staging: Staging, command: str, *arguments, progress=None, threads=None, strict=False,
               **options) -> Answer:
    """Runs a command whose arguments and options may be cases, volumes and seeds in memory."""
    names = [staging.path_of(argument) for argument in arguments]
    rows = {row["name"]: row for row in commands()[command]["rows"]}
    given = {word: staging.option(rows.get(option_of(word), {"name": word, "placeholder": ""}), value)
             for word, value in options.items()}
    texts = texts_of(command, given)
    words = [row["name"] for row in commands()[command]["rows"] if row["argument"]]
    known = [name for name, word in zip(names, words + words[-1:] * len(names))
             if word not in ("NAME", "TARGET")] + [text for _, values in texts for text in values]
    json_text, text, code, warnings, details = called(
        _lumen.run, command, names, texts, progress, threads or 0, strict, staging=staging,
        known=known)
    for detail in details:
        _LOG.debug("%s", detail)
    answer = Answer(json.loads(staging.without_folder(json_text)) if json_text else {})
    answer.text, answer.code = staging.without_folder(text), code
    answer.warnings = [staging.without_folder(warning) for warning in warnings]
    warn(answer.warnings)
    return answer


def run(command: str, *arguments, progress=None, threads=None, strict=False, **options) -> Answer:
    """Runs any command of the program.

    Parameters
    ----------
    command : str
        Name of the command, such as "info" or "library check".
    *arguments : path, Case, Volume or str
        The command's arguments in their order. Outputs are paths.
    progress : callable, optional
        Called with (stage, units done, units in all or 0), about 20 times a second at most, by the
        thread that called. An exception that it raises cancels the work.
    threads : int, optional
        Most threads of this call; all cores without it.
    strict : bool
        A warning is an error.
    **options
        The command's options; ``lumen.options_of("info")`` lists them.

    Returns
    -------
    Answer
    """
    if command not in commands():
        raise Error(f"{command}: there is no such command", 2)
    with Staging() as staging:
        return run_staged(staging, command, *arguments, progress=progress, threads=threads, strict=strict, **options)
