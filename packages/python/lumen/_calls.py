# SPDX-License-Identifier: Apache-2.0
"""Calls of the compiled module: its errors and warnings in the words of Python."""
from __future__ import annotations

import os
import sys
import types
import warnings as python_warnings
from typing import Optional

from ._errors import Error, Warning  # pylint: disable=redefined-builtin
from ._options import in_python


def warn(messages) -> None:
    """Shows warnings at the line that called lumen."""
    folder, level = os.path.dirname(__file__), 2
    frame: Optional[types.FrameType] = sys._getframe(1)  # pylint: disable=protected-access
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == folder:
        frame, level = frame.f_back, level + 1
    for message in messages:
        python_warnings.warn(in_python(message), Warning, stacklevel=level)


def called(function, *arguments, staging=None, known=()):
    """The result of a function of the module. Messages of errors have keywords for options."""
    try:
        return function(*arguments)
    except Error as error:
        raise _worded(error, staging, known) from None


def _worded(error: Error, staging, known) -> Error:
    message = in_python(staging.without_folder(str(error)) if staging else str(error))
    file = error.file or next((name for name in known if str(error).startswith(name + ":")), None)
    if staging and file:
        file = staging.without_folder(file)
    return Error(message, error.exit_code, file=file, place=error.place, code=error.code,
                 number=error.number, found=error.found and in_python(error.found),
                 expected=error.expected and in_python(error.expected))
