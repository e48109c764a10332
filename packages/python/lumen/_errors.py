# SPDX-License-Identifier: Apache-2.0
"""Errors and warnings of lumen."""
from __future__ import annotations

import re
from typing import Optional

KINDS = {1: "failed", 2: "usage", 3: "invalid input", 4: "unsupported", 130: "interrupted"}
_PLACE = re.compile(r'\bat "(?P<pointer>/[^"]*)"|\b(?P<count>(?:byte|line) \d+)')
_FOUND = re.compile(r"found (?P<found>.+?), expected (?P<expected>.+)", re.DOTALL)


class Warning(UserWarning):  # pylint: disable=redefined-builtin
    """A fact that makes a result doubtful. ``strict=True`` makes an error of it."""


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
        return _restored, (str(self), self.exit_code, dict(self.__dict__))


def _restored(message, exit_code, facts):
    error = Error(message, exit_code)
    error.__dict__.update(facts)
    return error
