# SPDX-License-Identifier: Apache-2.0
"""Signed distance, gradient and inside test of a vessel tree, on NumPy arrays.

    import lumen_blob
    vessel = lumen_blob.Model("head.lumen")
    tool = vessel.cursors(points)               # one node for each point, kept from step to step
    answer = vessel.query(points, tool)
    answer.distance, answer.normal              # (n,) mm, negative in the lumen; (n, 3), outwards

Lengths are millimetres in the frame of the case: LPS (+x left, +y posterior, +z superior). Points are
(n, 3), or (3,) for one; answers have as many rows. libblob's header, blob.h, says what each number is, its
error and where it is smooth.
"""
from ._model import (BLENDED, DISTANCE_EXACT, HOLD, INSIDE, LOCAL, NOT_CONVERGED, NOWHERE, Answer,
                     Error, Hessian, Hits, Model, Nearest, pack)

__all__ = ["Answer", "BLENDED", "DISTANCE_EXACT", "Error", "HOLD", "Hessian", "Hits", "INSIDE", "LOCAL", "Model",
           "NOT_CONVERGED", "NOWHERE", "Nearest", "pack"]
