# SPDX-License-Identifier: Apache-2.0
"""Calls of the compiled module: its errors, warnings and details in the words of Python."""
from __future__ import annotations

import logging
import numbers
import os
import re
import sys
import types
import warnings as python_warnings
from typing import Any, Dict, Optional, Sequence, Tuple

from ._errors import Error, ValueFault, Warning, class_of, shown  # pylint: disable=redefined-builtin
from ._options import check_flag, in_python

_LOG = logging.getLogger("lumen")


Words = Sequence[Tuple[str, str]]  # of the engine, and those for users in their place


def reworded(message: str, words: Words) -> str:
    """A message with keywords for options, and with words for users in place of the engine's."""
    for old, new in words:
        message = new.join(re.split(rf"(?<![\w/-]){re.escape(old)}", message))
    return in_python(message)


def report(warnings, details=(), words: Words = ()) -> None:
    """Shows warnings at the line that called lumen, and logs details."""
    for detail in details:
        _LOG.debug("%s", detail)
    folder, level = os.path.dirname(__file__), 2
    frame: Optional[types.FrameType] = sys._getframe(1)  # pylint: disable=protected-access
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == folder:
        frame, level = frame.f_back, level + 1
    for message in warnings:
        python_warnings.warn(reworded(message, words), Warning, stacklevel=level)


def called(function, *arguments, known=(), words: Words = ()):
    """The result of a function of the module. Messages of errors have keywords for options; a message about one of
    the known files and values begins with its name."""
    try:
        return function(*arguments)
    except Error as error:
        file = error.file or next((name for name in known if str(error).startswith(name + ":")), None)
        found, expected = (text and reworded(text, words) for text in (error.found, error.expected))
        raise class_of(str(error), file)(
            reworded(str(error), words), error.exit_code, file=file and dict(words).get(file, file), place=error.place,
            code=error.code, number=error.number, found=found, expected=expected) from None
    except TypeError as error:
        place = error.__traceback__
        if "incompatible function arguments" not in str(error) or place is not None and place.tb_next is not None:
            raise  # of a function that the module called
        raise ValueFault(f"found arguments of the types {', '.join(type(one).__name__ for one in arguments)}, expected "
                         "those that help() states") from None


def watch_of(options: Dict[str, Any]) -> tuple:
    """Takes progress, threads and strict out of the options, as functions of the module take them."""
    progress, threads, strict = (options.pop(word, None) for word in ("progress", "threads", "strict"))
    if progress is not None and not callable(progress):
        raise ValueFault(f"progress: found {shown(progress)}, expected a function of stage, units done and units in "
                         "all, such as print")
    if threads is not None and (not isinstance(threads, numbers.Integral) or isinstance(threads, bool) or threads < 1):
        raise ValueFault(f"threads: found {shown(threads)}, expected a whole number above 0")
    return progress, int(threads or 0), strict is not None and check_flag("strict", strict)
