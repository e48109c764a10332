# SPDX-License-Identifier: Apache-2.0
"""Calls of the compiled module: its errors, warnings and details in the words of Python."""
from __future__ import annotations

import logging
import os
import sys
import types
import warnings as python_warnings
from typing import Any, Dict, Optional

from ._errors import Error, Warning  # pylint: disable=redefined-builtin
from ._options import in_python

_LOG = logging.getLogger("lumen")


def report(warnings, details=()) -> None:
    """Shows warnings at the line that called lumen, and logs details."""
    for detail in details:
        _LOG.debug("%s", detail)
    folder, level = os.path.dirname(__file__), 2
    frame: Optional[types.FrameType] = sys._getframe(1)  # pylint: disable=protected-access
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == folder:
        frame, level = frame.f_back, level + 1
    for message in warnings:
        python_warnings.warn(in_python(message), Warning, stacklevel=level)


def called(function, *arguments, known=()):
    """The result of a function of the module. Messages of errors have keywords for options; a message about one of
    the known files and values begins with its name."""
    try:
        return function(*arguments)
    except Error as error:
        file = error.file or next((name for name in known if str(error).startswith(name + ":")), None)
        found, expected = (text and in_python(text) for text in (error.found, error.expected))
        raise Error(in_python(str(error)), error.exit_code, file=file, place=error.place, code=error.code,
                    number=error.number, found=found, expected=expected) from None


def watch_of(options: Dict[str, Any]) -> tuple:
    """Takes progress, threads and strict out of the options, as functions of the module take them."""
    return options.pop("progress", None), options.pop("threads", None) or 0, options.pop("strict", False)
