# SPDX-License-Identifier: Apache-2.0
"""Errors and warnings of lumen."""
from __future__ import annotations

import errno
import os
import re
from typing import Any, Optional

KINDS = {1: "failed", 2: "usage", 3: "invalid input", 4: "unsupported", 130: "interrupted"}
_PLACE = re.compile(r'\bat "(?P<pointer>/[^"]*)"|\b(?P<count>(?:byte|line) \d+)')
_FOUND = re.compile(r"(?:\bfound (?P<found>.+?))?[,;] expected (?P<expected>.+)", re.DOTALL)
_CODE = re.compile(r" \[([a-z-]+)\]$")
_MISSING = re.compile(r": (there is no such (?!command)|[Nn]o such file|IO_MISSING\b)")


class Warning(UserWarning):  # pylint: disable=redefined-builtin
    """A fact that makes a result doubtful. ``strict=True`` makes an error of it.

    Attributes
    ----------
    code : str or None
        Its kind, such as "seed-untracked": docs/warnings.md explains all.
    """

    @property
    def code(self) -> Optional[str]:
        match = _CODE.search(str(self))
        return match[1] if match else None


class Error(Exception):
    """A fault of an input, of an option, or of the work.

    Attributes
    ----------
    exit_code : int
        The exit code of the program in this situation: 1 failed, 2 usage, 3 invalid input,
        4 unsupported.
    kind : str
        The same as a word: "failed", "usage", "invalid input", "unsupported".
    file : str or None
        The file that the fault is in.
    place : str or None
        The place in the file: "byte 128", "line 3", or a JSON pointer such as "/tree/radius/0".
    code, number : str and int, or None
        The rule of the case format that is broken, such as "RADIUS_RANGE" and 406.
    found, expected : str or None
        The value that was found, and the values that are allowed.
    """

    def __init__(self, message: str, exit_code: int = 1, *, file: Optional[str] = None,
                 place: Optional[str] = None, code: Optional[str] = None,
                 number: Optional[int] = None, found: Optional[str] = None,
                 expected: Optional[str] = None):
        super().__init__(message)
        self.exit_code = exit_code
        self.kind = KINDS.get(exit_code, "failed")
        self.file, self.place, self.code, self.number = file, place, code, number
        if place is None and (match := _PLACE.search(message)):
            self.place = match["pointer"] or match["count"]
        match = _FOUND.search(message)
        self.found = match["found"] if found is None and match else found
        self.expected = match["expected"] if expected is None and match else expected

    def __reduce__(self):
        return _restored, (type(self), str(self), self.exit_code, dict(self.__dict__))


class ValueFault(Error, ValueError, TypeError):
    """A value of an argument that is none of those allowed: also a ValueError and a TypeError."""

    def __init__(self, message: str, exit_code: int = 2, **facts):
        super().__init__(message, exit_code, **facts)


class MissingFile(Error, FileNotFoundError):
    """A file that is not there: also a FileNotFoundError."""

    def __init__(self, message: str, exit_code: int = 3, **facts):
        super().__init__(message, exit_code, **facts)
        self.errno = errno.ENOENT


def class_of(message: str, file: Optional[str]) -> type:
    """The class of an error of the compiled module."""
    is_missing = file and (_MISSING.match(message.removeprefix(file))
                           or "cannot be opened" in message and not os.path.lexists(file))
    return MissingFile if is_missing else Error


def shown(value: Any) -> str:
    """A value in a message: numbers and short texts as they are, others by their type, since arrays are of patients."""
    value = value.item() if getattr(value, "ndim", None) == 0 and hasattr(value, "item") else value
    if value is None or isinstance(value, (str, bool, int, float)):
        text = repr(value)
        return text if len(text) <= 60 else f"{text[:56]}..."
    kind = type(value)
    return kind.__name__ if kind.__module__ == "builtins" else f"{kind.__module__}.{kind.__name__}"


def _restored(kind, message, exit_code, facts):
    error = kind(message, exit_code)
    error.__dict__.update(facts)
    return error
