# SPDX-License-Identifier: Apache-2.0
"""The second derivative of the distance to the wall, for lumen.torch."""
import numpy as np

from . import blob


def cursor_of(nodes) -> blob.Cursor:
    """A cursor with these nodes, (n,) uint32."""
    cursor = blob.Cursor(len(nodes))
    cursor.node[:] = nodes
    return cursor


def of_distance(model, points, cursor) -> np.ndarray:
    """Hessian of the distance to the nearest point of the wall, in the processor's memory.

    Parameters
    ----------
    model : lumen.blob.Model
    points : array (n, 3)
        mm.
    cursor : lumen.blob.Cursor
        The node of each point, which does not move.

    Returns
    -------
    (n, 3, 3) float64, 1/mm. At the wall it is the wall's shape operator S, the Hessian of f between tangents over
    -|grad f|; at the distance d it is S (1 + d S)^-1 (offset surfaces), which grows without bound towards the wall's
    centres of curvature.
    """
    cursor = cursor.copy()
    foot = model.nearest(points, cursor)
    second = model.hessian(foot.point, cursor)
    xx, yy, zz, xy, xz, yz = second.hessian.T
    of_f = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
    steepness = np.linalg.norm(second.gradient, axis=1)
    normal = second.gradient / steepness[:, None]
    tangents = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    shape = tangents @ (-of_f / steepness[:, None, None]) @ tangents
    return np.linalg.solve(np.eye(3) + foot.distance[:, None, None] * shape, shape)
