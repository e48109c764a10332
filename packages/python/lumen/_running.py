# SPDX-License-Identifier: Apache-2.0
"""Runs of the program's commands, whose inputs and outputs may be values in memory."""
from __future__ import annotations

import functools
import itertools
import json
import math
import numbers
import os
from typing import Any, Dict, Iterable, Mapping, Tuple

from . import _images, _lumen
from ._calls import called, report, reworded, watch_of
from ._errors import Error, ValueFault, shown
from ._exchange import tables_of
from ._inputs import Volume
from ._options import commands, group_rows, keyword_of, option_of, texts_of


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
    if isinstance(seeds, Mapping):
        is_branch = "points" in seeds and isinstance(seeds.get("label"), str)
        seeds = [seeds] if is_branch else [{"label": label, "points": points} for label, points in seeds.items()]
    branches = list(seeds) if isinstance(seeds, Iterable) else [seeds]
    if not all(isinstance(branch, Mapping) for branch in branches):
        raise ValueFault(f"seeds: found {shown(seeds)}, expected a path, {{'BA': points (n, 3)}} or a list of branches, "
                         "each a dict with label and points")
    branches = [{key: _plain(value) for key, value in branch.items()} for branch in branches]
    for branch in branches:
        if "points" in branch:
            branch["points"] = _points(branch)
    return {"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
            "branches": branches}


def _points(branch):
    """The points of a branch: a list, of one point where it is three numbers. Raises ValueFault for no number."""
    points, label = branch["points"], branch.get("label", "")
    if isinstance(points, list) and len(points) == 3 and all(isinstance(one, numbers.Real) for one in points):
        points = [points]
    for index, point in enumerate(points if isinstance(points, list) else []):
        place = point if isinstance(point, list) else []
        wrong = next((one for one in place if isinstance(one, float) and not math.isfinite(one)), None)
        if wrong is not None:
            raise ValueFault(f"seeds: branch {label!r}, point {index}: found {wrong}, expected finite numbers")
    return points


def _plain(value):
    """Arrays as nested lists, a single point as a list of one."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value


class Kept(str):
    """The name of an output that stays in memory."""


class Values:
    """Inputs and outputs of a command in memory, by the names that its arguments, options and messages have."""

    def __init__(self, arguments):
        self.given = {}
        self.kept = []
        self.words = []  # of messages on images
        flat = itertools.chain.from_iterable(one if isinstance(one, (list, tuple)) else [one] for one in arguments)
        self._taken = {os.fsdecode(one) for one in flat if _is_path(one) and not isinstance(one, Kept)}

    def _new(self, name: str) -> str:
        """The name, or one with a number if another value or a file has it."""
        stem, _, ending = name.partition(".")
        names = itertools.chain([name], (f"{stem}-{number}.{ending}" for number in itertools.count(2)))
        new = next(one for one in names if one not in self._taken)
        self._taken.add(new)
        return new

    def _give(self, name: str, value: Any) -> str:
        name = self._new(name)
        self.given[name] = value
        return name

    def _give_text(self, name: str, value: str) -> str:
        name = self._give(name, value)
        self.words.append((name, name.partition(".")[0]))  # nobody wrote such a file
        return name

    def name_of(self, value: Any, role: str = "") -> str:
        """The name of an argument: a path as it is, a case, a volume or an image by a name for it, or by the role that
        it has as an option."""
        if isinstance(value, Kept):
            self.kept.append(self._new(value))
            return self.kept[-1]
        if _is_path(value):
            return os.fsdecode(value)
        if _images.package_of(value) or hasattr(value, "__array__"):
            value = Volume.of(value)
        if hasattr(value, "_given"):
            name, held = value._given()  # pylint: disable=protected-access
            name = self._give(role + name[name.index("."):] if role else name, held)
            if isinstance(value, Volume):
                self.words += value._words(name)  # pylint: disable=protected-access
            else:
                self.words.append((name, name.partition(".")[0]))
            return name
        if isinstance(value, dict) and value.keys() & _grouped().keys():
            name = next(group for word, group in _grouped().items() if word in value)
            raise ValueFault(f"found options as an argument, expected keywords: pass **{name}(...)")
        place = f"{role}: " if role else ""
        raise ValueFault(f"{place}found {type(value).__module__}.{type(value).__name__}, expected a path, a lumen.Case, "
                         "a lumen.Volume, an array, or an image of SimpleITK, ITK, nibabel or xarray")

    def option(self, row: Dict[str, Any], value: Any) -> Any:
        """The value of an option as texts can state it: names in place of values in memory."""
        if value is None or isinstance(value, (str, os.PathLike)):
            return self.name_of(value) if isinstance(value, Kept) else value
        if row["name"] == "seeds":
            return self._give_text("seeds.json", json.dumps(seeds_document(value)))
        if row["name"] == "label-table":
            return self._give_text("labels.json", json.dumps({str(_label(row, one)): name for one, name in value.items()}))
        if row["name"] == "role" and isinstance(value, Mapping):
            return [f"{label}={role}" for label, role in value.items()]
        if row["name"] == "label-map" and isinstance(value, (list, tuple)):
            return [self.option(row, one) for one in value]
        if row["name"] == "labels" and isinstance(value, Mapping):
            return ",".join(f"{_label(row, one)}={name}" for one, name in value.items())
        return self.name_of(value, row["name"].replace("-", "_")) if row["placeholder"] == "FILE" else value


@functools.lru_cache(maxsize=None)
def _grouped() -> Dict[str, str]:
    """The classes of lumen.options by the keywords of their options."""
    return {keyword_of(row["name"]): name for name, rows in group_rows().items() for row in rows}


def _label(row: Dict[str, Any], label: Any) -> int:
    """The number of a label. Raises ValueFault for a name in its place."""
    try:
        if int(label) == label or isinstance(label, str):
            return int(label)
    except (TypeError, ValueError):
        pass
    raise ValueFault(f"{keyword_of(row['name'])}: found {shown(label)} as a label, expected {{1: 'BA'}}")


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, bytes, os.PathLike))


def call(command: str, *arguments, **options) -> Tuple[Answer, list]:
    """The answer of a command whose arguments and options may be values in memory, and its outputs whose names are
    Kept: cases of the compiled module, or bytes."""
    watch = watch_of(options)
    values = Values([*arguments, *options.values()])
    names = [values.name_of(argument) for argument in arguments]
    rows = {row["name"]: row for row in commands()[command]["rows"]}
    texts = texts_of(command, {
        word: values.option(rows.get(option_of(word), {"name": word, "placeholder": ""}), value)
        for word, value in options.items()})
    words = [row["name"] for row in commands()[command]["rows"] if row["argument"]]
    known = [name for name, word in zip(names, words + words[-1:] * len(names))
             if word not in ("NAME", "TARGET")] + [text for _, some in texts for text in some]
    json_text, text, code, warnings, details, kept = called(
        _lumen.run, command, names, texts, values.given, values.kept, *watch, known=known, words=values.words)
    answer = Answer(json.loads(json_text) if json_text else {})
    answer.text, answer.code = text, code
    answer.warnings = [reworded(one, values.words) for one in warnings]
    report(answer.warnings, details)
    return answer, [kept[name] for name in values.kept]


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
    return call(command, *arguments, progress=progress, threads=threads, strict=strict, **options)[0]
