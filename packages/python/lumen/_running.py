# SPDX-License-Identifier: Apache-2.0
"""Runs of the program's commands."""
from __future__ import annotations

import json
import logging

from . import _lumen
from ._calls import called, warn
from ._errors import Error
from ._inputs import Staging
from ._options import commands, texts_of

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


def run_staged(staging: Staging, command: str, arguments, options, progress=None, threads=None,
               strict=False) -> Answer:
    """Runs a command whose arguments and options may be cases, volumes and seeds in memory."""
    names = [staging.path_of(argument) for argument in arguments]
    files = {row["name"] for row in commands()[command]["rows"] if row["placeholder"] == "FILE"}
    given = dict(options)
    for word, value in options.items():
        if word == "seeds":
            given[word] = staging.seeds(value)
        elif word in files and value is not None:
            given[word] = staging.path_of(value)
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
        return run_staged(staging, command, arguments, options, progress, threads, strict)
