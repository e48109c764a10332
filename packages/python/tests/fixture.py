# SPDX-License-Identifier: Apache-2.0
"""A small phantom, made once for all tests of a process: its volume, truth, clicks, and the case of it."""
import functools
import typing

import lumen


class Sample(typing.NamedTuple):
    phantom: lumen.Phantom
    case: lumen.Case


@functools.lru_cache(maxsize=None)
def sample() -> Sample:
    phantom = lumen.phantom("bifurcation")
    return Sample(phantom, lumen.convert(phantom.volume, seeds=phantom.seeds, seeds_only=True))
