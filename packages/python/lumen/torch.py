# SPDX-License-Identifier: Apache-2.0
"""The distance to the wall as an operation of PyTorch, twice differentiable (needs the package torch).

    depth = lumen.torch.distance(model, points)         # points (n, 3) tensor, mm, LPS; depth (n,), mm
    depth.clamp(min=0).square().sum().backward()        # a loss on what leaves the lumen

The distance is that to the nearest point of the wall, negative in the lumen. Its gradient is the
outward normal there, its Hessian follows from the wall's curvatures there; a third derivative is not
offered. Tensors in the processor's memory are read without a copy, float64 as they are, float32 as
doubles; others are copied to it and back. Answers have the type of the points.
"""
import numpy as np
import torch

from . import blob

__all__ = ["distance"]


def distance(model, points: torch.Tensor, cursor=None) -> torch.Tensor:
    """Signed distance to the nearest point of the wall, mm, negative in the lumen; differentiable.

    Parameters
    ----------
    model : lumen.blob.Model
    points : tensor (n, 3) or (3,), float32 or float64
        mm, LPS.
    cursor : lumen.blob.Cursor, optional
        The node of each point, which moves; located where it is missing. Derivatives refer to the
        nodes of this call.

    Returns
    -------
    tensor (n,) or (), of the type and on the device of the points

    Raises ValueError for another shape, TypeError for another type.
    """
    if points.dtype not in (torch.float32, torch.float64):
        raise TypeError(f"points: found {points.dtype}, expected torch.float32 or torch.float64")
    if points.ndim not in (1, 2) or points.shape[-1] != 3:
        raise ValueError(f"points: found the shape {tuple(points.shape)}, expected (n, 3) or (3,)")
    if cursor is None:
        cursor = model.cursor(_numbers(points))
    result = _Distance.apply(points.reshape(-1, 3), model, cursor)
    return result.reshape(points.shape[:-1])


def _numbers(tensor):
    """The tensor's memory as an array of NumPy, or a copy from another device."""
    return tensor.detach().cpu().contiguous().numpy()


def _tensor(array, like):
    return torch.from_numpy(np.ascontiguousarray(array)).to(like)


class _Distance(torch.autograd.Function):
    """Distances, whose gradient is the normal."""

    @staticmethod
    def forward(ctx, points, model, cursor):
        answer = model.query(_numbers(points), cursor, blob.DISTANCE_EXACT)
        ctx.model, ctx.cursor = model, cursor.copy()
        ctx.save_for_backward(points, _tensor(answer.normal, points))
        return _tensor(answer.distance, points)

    @staticmethod
    def backward(ctx, of_distance):
        points, normal = ctx.saved_tensors
        return of_distance[:, None] * _Normal.apply(points, normal, ctx.model, ctx.cursor), None, None


class _Normal(torch.autograd.Function):
    """Normals that are known, whose derivative is the Hessian of the distance."""

    @staticmethod
    def forward(ctx, points, normal, model, cursor):
        ctx.model, ctx.cursor = model, cursor
        ctx.save_for_backward(points)
        return normal.clone()

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx, of_normal):
        points, = ctx.saved_tensors
        hessian = _tensor(_hessian(ctx.model, _numbers(points), ctx.cursor), points)
        return (hessian @ of_normal[:, :, None])[:, :, 0], None, None, None


def _hessian(model, points, cursor):
    """(n, 3, 3), 1/mm. At the wall that of the distance is the wall's shape operator S, the Hessian of f
    between tangents over -|grad f|; at the distance d it is S (1 + d S)^-1 (offset surfaces)."""
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
