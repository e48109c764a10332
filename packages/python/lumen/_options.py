# SPDX-License-Identifier: Apache-2.0
"""Keyword arguments of functions, from the rows of options of the program's commands."""
from __future__ import annotations

import functools
import inspect
import keyword
import os
import re
import textwrap
from typing import Any, Dict, List, Sequence, Tuple

from . import _lumen

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


def type_of(row: Row) -> str:
    """The type of an option's value, as a stub states it."""
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


def document(function, command: str, *without: str):
    """Completes a function's docstring and signature by the rows of its command."""
    rows = [row for row in rows_of(command) if row["name"] not in without]
    lines = []
    for row in rows:
        default = f", default {row['default']}" if row["default"] else ""
        limits = f" ({row['range']})" if row["range"] else ""
        lines.append(f"{keyword_of(row['name'])} : {type_of(row)}{default}")
        lines += textwrap.wrap(in_python(row["help"]) + limits, 92, initial_indent="    ",
                               subsequent_indent="    ")
    body = inspect.cleandoc(function.__doc__)
    title = f"Options of lumen {command}"
    function.__doc__ = f"{body}\n\n{title}\n{'-' * len(title)}\n" + "\n".join(lines) + "\n"
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind != p.VAR_KEYWORD]
    taken = {p.name for p in own}
    extra = [inspect.Parameter(keyword_of(row["name"]), inspect.Parameter.KEYWORD_ONLY, default=None)
             for row in rows if keyword_of(row["name"]) not in taken]
    function.__signature__ = signature.replace(parameters=own + extra)
    return function
