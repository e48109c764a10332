# SPDX-License-Identifier: Apache-2.0
"""Signed distance, gradient, normal and inside test of a vessel case, for many points at once.

    vessel = lumen.blob.Model(case)
    tool = vessel.cursor(points)          # one node for each point, kept from step to step
    answer = vessel.query(points, tool)   # points (n, 3), mm, LPS
    answer.distance, answer.normal        # (n,) mm, negative in the lumen; (n, 3), outwards

Packed arrays (n, 3) of float64 are read where they lie, others (float32, lists, slices) are copied.
One point of shape (3,) gives answers without the leading axis. Queries let go of Python's lock, and
any number of threads may query one model, each with cursors of its own. libblob's header, blob.h,
defines each number.
"""
from __future__ import annotations

import os
import pathlib

import numpy as np

from . import _lumen
from ._calls import called
from ._case import Case
from ._options import check_flag
from ._lumen import Answer, Approaches, Cursor, Hessian, Hits, Nearest

__all__ = ["Answer", "Approaches", "BLENDED", "Cursor", "DISTANCE_EXACT", "HOLD", "Hessian", "Hits",
           "LOCAL", "Model", "Nearest", "check_packed", "device_sources", "pack"]

BLENDED = 0  #: the wall of the case: models of neighbours blend
LOCAL = 1  #: the model of the cursor's node answers alone, the fastest
DISTANCE_EXACT = 2  #: distance and normal refer to the nearest point of the wall
HOLD = 4  #: cursors do not move


def pack(models) -> np.ndarray:
    """One flat buffer of models, from which libblob's header blob_device.h answers on any processor.

    Parameters
    ----------
    models : Model or sequence of Model
        At least one; vessel i of the buffer is model i.

    Returns
    -------
    (n,) uint32, which needs no pointer: upload it, or write it by tofile()
    """
    return called(_lumen.pack, [models] if isinstance(models, _lumen.Model) else list(models))


def check_packed(words) -> None:
    """Raises lumen.Error unless `words`, (n,) uint32, is a whole buffer of pack(). A query of a buffer
    that passes reads nothing outside of it."""
    _lumen.check_packed(np.ascontiguousarray(words, np.uint32))


def device_sources() -> pathlib.Path:
    """The folder with the query of a packed buffer as sources: blob_device.h and its parts, which
    query.cl (OpenCL) and query.cu (CUDA) include, and query.wgsl (WebGPU)."""
    return pathlib.Path(__file__).resolve().parent / "device"


class Model(_lumen.Model):
    """A vessel tree with its blobs, which never changes.

    Parameters
    ----------
    source : Case or path
        A case with models, or a .lumen file.
    verify : bool
        Checks the checksums of a file.
    """

    def __init__(self, source, verify: bool = True):
        if isinstance(source, Case):
            called(super().__init__, source._core)  # pylint: disable=protected-access
        else:
            called(super().__init__, os.fspath(source), check_flag("verify", verify), known=[os.fspath(source)])
