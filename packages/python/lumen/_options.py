# SPDX-License-Identifier: Apache-2.0
"""Keyword arguments of functions, from the rows of options of the program's commands."""
from __future__ import annotations

import functools
import inspect
import keyword
import os
import re
import textwrap
from typing import Any, Dict, List, Sequence, Tuple, TypedDict

import numpy as np

from . import _lumen
from ._errors import ValueFault, shown

Row = Dict[str, Any]
Texts = List[Tuple[str, List[str]]]


@functools.lru_cache(maxsize=None)
def commands() -> Dict[str, Dict[str, Any]]:
    """All commands with their summaries, examples and rows."""
    return _lumen.commands()


def rows_of(command: str) -> List[Row]:
    """The rows of a command's options, without its arguments."""
    return [row for row in commands()[command]["rows"] if not row["argument"]]


def mesh_rows() -> List[Row]:
    """The rows of ``lumen convert`` that count for the arrays of a mesh of a case."""
    return [row for row in rows_of("convert") if row["for_mesh"] and row["name"] not in ("from", "to")]


def keyword_of(name: str) -> str:
    """The keyword of an option: "inlier-rate" is inlier_rate, "from" is from_."""
    word = name.replace("-", "_")
    return word + "_" if keyword.iskeyword(word) else word


def option_of(word: str) -> str:
    """The option of a keyword."""
    return word.rstrip("_").replace("_", "-")


def check_flag(word: str, value: Any) -> bool:
    """The value of a flag. Raises ValueFault for all but True and False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueFault(f"{word}: found {shown(value)}, expected True or False")
    return bool(value)


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if hasattr(value, "item"):  # a number of NumPy
        value = value.item()
    return repr(value) if isinstance(value, float) else str(value)


def _is_many(value: Any) -> bool:
    return not isinstance(value, (str, bytes, os.PathLike)) and isinstance(value, Sequence) or \
        getattr(value, "ndim", 0) > 0


def _texts(row: Row, value: Any) -> List[str]:
    """The texts of one option. A sequence within a text has commas between its numbers."""
    separator = "x" if row["placeholder"] == "WxH" else ","
    joined = lambda one: separator.join(map(_text, one)) if _is_many(one) else _text(one)
    if row.get("type") == "flag":
        return [_text(check_flag(keyword_of(row["name"]), value))]
    if not _is_many(value):
        return [_text(value)]
    if row["repeats"]:
        is_one = len(value) > 0 and "," in row["placeholder"] and not _is_many(value[0]) \
            and not isinstance(value[0], str)
        return [joined(value)] if is_one else [joined(one) for one in value]
    if row["count"] > 1 or row["delimited"]:
        return [_text(one) for one in value]
    return [joined(value)]


def texts_of(command: str, options: Dict[str, Any]) -> Texts:
    """Options as the engine takes them. Unknown names are left to the engine, which refuses them
    with a suggestion. None stands for an option that is not given."""
    rows = {row["name"]: row for row in rows_of(command)}
    unknown = {"placeholder": "", "repeats": False, "count": 1, "delimited": False}
    return [(option_of(word), _texts(rows.get(option_of(word), unknown), value))
            for word, value in options.items() if value is not None]


def in_python(message: str) -> str:
    """A message with options spelled as keywords: "--inlier-rate" becomes "inlier_rate"."""
    return re.sub(r"(?<![\w-])--([a-z][a-z0-9]*(?:-[a-z0-9]+)*)",
                  lambda match: keyword_of(match[1]), message)


# Options whose values may be in memory, by the types of the stubs.
_IN_MEMORY = {"seeds": "Seeds", "volume": "VolumeLike", "image": "VolumeLike",
              "label-map": "VolumeLike | Sequence[VolumeLike]", "native": "VolumeLike", "role": "str | Sequence[str] | Mapping[Union[int, str], str]",
              "label-table": "PathLike | Mapping[int, str]", "labels": "VolumeLike | Mapping[int, str]",
              "against": "Case | PathLike"}


def type_of(row: Row) -> str:
    """The type of an option's value, as a stub states it."""
    if row["name"] in _IN_MEMORY:
        return _IN_MEMORY[row["name"]]
    single = {"flag": "bool", "int": "int", "float": "float"}.get(row["type"], "str")
    if row["words"]:
        single = f"Literal[{', '.join(map(repr, row['words']))}]"
    elif row["placeholder"] in ("FILE", "PATH"):
        single = "PathLike"
    elif "," in row["placeholder"] or row["placeholder"] == "WxH":
        single = f"str | Sequence[{'int' if row['type'] == 'int' or 'W' in row['placeholder'] else 'float'}]"
    elif row["placeholder"] == "LENGTH":
        single = "str | float"
    if row["repeats"]:
        element = f"Union[{single.replace(' | ', ', ')}]" if " | " in single else single
        return f"{single} | Sequence[{element}]"
    return f"{single} | Sequence[{single}]" if row["delimited"] and "Sequence" not in single else single


# Commands whose rows make the groups of lumen.options: of two with a group of one name, the first.
_GROUPED = ("convert", "export", "picture", "phantom")


@functools.lru_cache(maxsize=None)
def group_rows() -> Dict[str, List[Row]]:
    """The rows of each class of lumen.options."""
    rows: Dict[str, List[Row]] = {}
    for command in _GROUPED:
        of_command: Dict[str, List[Row]] = {}
        for row in rows_of(command):
            if row["group"]:
                of_command.setdefault(class_of(row["group"]), []).append(row)
        rows = {**of_command, **rows}
    return rows


def class_of(group: str) -> str:
    """The class of a group: "Case file" is CaseFile."""
    return "".join(word[0].upper() + word[1:] for word in group.split())


@functools.lru_cache(maxsize=None)
def groups() -> Dict[str, type]:
    """The classes of lumen.options by name: TypedDicts whose keys are keywords."""
    return {name: _group(name, rows) for name, rows in sorted(group_rows().items())}


def _group(name: str, rows: List[Row]) -> type:
    words = {keyword_of(row["name"]): type_of(row) for row in rows}
    group = TypedDict(name, words, total=False)  # type: ignore[misc]
    group.__module__ = f"{__package__}.options"
    group.__doc__ = f"Options of the group {name}.\n\n{_described(rows)}"
    parameters = [inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, annotation=kind, default=...)
                  for word, kind in words.items()]
    group.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return group


def _described(rows: List[Row]) -> str:
    """Keywords with types, defaults, helps and ranges."""
    lines = []
    for row in rows:
        default = f", default {row['default']}" if row["default"] else ""
        limits = f" ({row['range']})" if row["range"] else ""
        lines.append(f"{keyword_of(row['name'])} : {type_of(row)}{default}")
        lines += textwrap.wrap(in_python(row["help"]) + limits, 92, initial_indent="    ",
                               subsequent_indent="    ")
    return "\n".join(lines) + "\n"


def _listed(rows: List[Row]) -> str:
    """Rows without a class of lumen.options in full, the others by their keywords under the name of their class."""
    members = {name: {row["name"] for row in some} for name, some in group_rows().items()}
    alone: List[Row] = []
    grouped: Dict[str, List[str]] = {}
    for row in rows:
        name = class_of(row["group"])
        if row["name"] in members.get(name, ()):
            grouped.setdefault(name, []).append(keyword_of(row["name"]))
        else:
            alone.append(row)
    lines = []
    for name, words in grouped.items():
        lines += [f"lumen.options.{name}", *textwrap.wrap(", ".join(words), 92, initial_indent="    ",
                                                          subsequent_indent="    ")]
    return _described(alone) + "\n".join(lines) + "\n"


_RUN = {"progress": None, "threads": None, "strict": False}


def document(command: str, *without: str, rows=None):
    """Decorates a function with ``**options``: completes its docstring and signature by the rows of its command."""
    rows = [row for row in (rows_of(command) if rows is None else rows) if row["name"] not in without]

    def decorated(function):
        body, title = inspect.cleandoc(function.__doc__), f"Options of lumen {command}"
        function.__doc__ = (f"{body}\n\n{title}\n{'-' * len(title)}\nprogress, threads, strict\n"
                            f"    As for :func:`lumen.run`.\n{_listed(rows)}")
        signature = inspect.signature(function)
        *own, options = signature.parameters.values()
        run = [inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, default=default)
               for word, default in _RUN.items()]
        function.__signature__ = signature.replace(parameters=[*own, *run, options])
        return function
    return decorated
