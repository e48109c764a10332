# SPDX-License-Identifier: Apache-2.0
"""libblob's query in kernels of NVIDIA Warp, for simulators such as Isaac Lab (needs the package warp).

    vessels = lumen.warp.Vessels([model])               # on Warp's current device
    answer = vessels.query(points)                      # points: wp.array(dtype=wp.vec3), mm, LPS
    answer.distance, answer.normal                      # arrays of Warp; mm, negative in the lumen
    vessels.query(points, answer.cursor, out=answer)    # the next step: cursors follow their points

A kernel of your own calls `lumen.warp.functions.blob_device_query`; its text states arguments and
results. Numbers are 32-bit floats: distances agree with lumen.blob within 1e-5 of the vessel's radius
near the wall. The text is generated from libblob's C header and tested as plain Python on NumPy; it
has not been run by Warp itself.
"""
from typing import NamedTuple

import numpy as np
import warp as wp

from . import _warp_query as functions
from . import blob

__all__ = ["Answer", "Vessels", "functions"]

NOWHERE = 0xFFFFFFFF  # a cursor that is not known: the query locates


class Answer(NamedTuple):
    """Arrays of Warp for n points."""

    distance: wp.array  #: (n,) float32, mm, negative in the lumen
    normal: wp.array  #: (n,) vec3, outwards
    value: wp.array  #: (n,) float32, f in mm
    gradient: wp.array  #: (n,) vec3, of f
    state: wp.array  #: (n,) uint32, 1 in the lumen, and 2 where an exact distance has not converged
    cursor: wp.array  #: (n,) uint32, the node of each point


class Vessels:
    """Models on a device of Warp.

    Parameters
    ----------
    source : Model, sequence of Model, or array (n,) of uint32
        The array is a buffer of lumen.blob.pack(), such as numpy.fromfile("vessels.bin", "<u4"). Raises
        lumen.Error for words that are none.
    device : str, optional
        Warp's current device by default.
    """

    def __init__(self, source, device=None):
        words = source
        if isinstance(source, np.ndarray):
            blob.check_packed(source)
        else:
            words = blob.pack(source)
        self.count = int(words[3])  #: number of vessels
        self.buffer = wp.array(words, dtype=wp.uint32, device=device)

    def answer(self, count: int) -> Answer:
        """Memory for `count` points, whose cursors are not known."""
        device = self.buffer.device
        scalar = [wp.zeros(count, dtype=wp.float32, device=device) for _ in range(2)]
        vector = [wp.zeros(count, dtype=wp.vec3, device=device) for _ in range(2)]
        return Answer(scalar[0], vector[0], scalar[1], vector[1],
                      wp.zeros(count, dtype=wp.uint32, device=device),
                      wp.full(count, wp.uint32(NOWHERE), dtype=wp.uint32, device=device))

    def query(self, points, cursor=None, flags: int = blob.BLENDED, vessel: int = 0, out=None) -> Answer:
        """Launches blob_query_points() or blob_query_exact_points(); Warp runs it asynchronously on a graphics processor.

        Parameters
        ----------
        points : wp.array of vec3 on the same device, or array (n, 3)
            mm, LPS.
        cursor : wp.array of uint32, optional
            The node of each point, which moves; located where it is missing.
        flags : int
            blob.LOCAL, blob.HOLD and blob.DISTANCE_EXACT.
        vessel : int
            Index in the buffer. Raises IndexError for one that it does not have.
        out : Answer, optional
            Memory for the answer.
        """
        if not 0 <= vessel < self.count:
            raise IndexError(f"vessel: found {vessel}, expected less than {self.count}")
        device = self.buffer.device
        if not isinstance(points, wp.array):
            points = wp.array(np.asarray(points, np.float32).reshape(-1, 3), dtype=wp.vec3, device=device)
        count = len(points)
        answer = self.answer(count) if out is None else out
        if cursor is not None:
            answer = answer._replace(cursor=cursor)
        for name, array in zip(Answer._fields, answer):
            if len(array) != count:
                raise ValueError(f"{name}: found {len(array)} elements, expected {count}")
        exact = flags & blob.DISTANCE_EXACT
        wp.launch(functions.blob_query_exact_points if exact else functions.blob_query_points, dim=count, device=device, inputs=[
            self.buffer, vessel, flags, points, answer.cursor, answer.distance, answer.normal,
            answer.value, answer.gradient, answer.state])
        return answer
