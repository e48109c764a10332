# SPDX-License-Identifier: Apache-2.0
"""Failures, with the exit codes of lumen."""

FAILED, USAGE, INVALID_INPUT = 1, 2, 3


class Fault(Exception):
    """A sentence for a person, and an exit code."""

    def __init__(self, message, code=INVALID_INPUT):
        super().__init__(message)
        self.code = code
