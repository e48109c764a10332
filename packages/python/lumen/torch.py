# SPDX-License-Identifier: Apache-2.0
"""The distance to the wall as an operation of PyTorch, twice differentiable (needs the package torch).

    depth = lumen.torch.distance(model, points)         # points (n, 3) tensor, mm, LPS; depth (n,), mm
    depth.clamp(min=0).square().sum().backward()        # a loss on what leaves the lumen

The distance is that to the nearest point of the wall, negative in the lumen. Its gradient is the
outward normal there, its Hessian follows from the wall's curvatures there; a third derivative is not
offered, nor the distance of the field itself (lumen.blob.BLENDED, LOCAL), whose gradient is not the
normal. Answers have the type of the points, on their device.

Points in the processor's memory are answered there by libblob in doubles, float64 read without a copy.
Points of float32 on a CUDA device are answered there by libblob-cuda on PyTorch's current stream: values
and gradients never leave the device, and no call waits for it; second derivatives go through the
processor's memory. Others are copied to the processor's memory and back.

A model stays on a device while it lives. Distances there agree with lumen.blob within 1e-5 mm but at
up to two of a thousand points, where another place of the wall is nearest about them.
"""
import functools

import numpy as np
import torch

from . import _cuda, _hessian, blob

__all__ = ["distance"]

NOWHERE = -1  # of int32: a cursor that is not known, the query locates


def distance(model, points, cursor=None) -> torch.Tensor:
    """Signed distance to the nearest point of the wall, mm, negative in the lumen; differentiable.

    Parameters
    ----------
    model : lumen.blob.Model
    points : tensor (n, 3) or (3,), float32 or float64
        mm, LPS. An array of another library that has __dlpack__ (CuPy, JAX, NumPy) is read without a copy.
    cursor : tensor (n,) of int32 on the points' device, or lumen.blob.Cursor, optional
        The node of each point, which moves; -1 where it is not known. Points without a cursor are located, which costs
        more and may find a vessel that merely touches. Derivatives refer to the nodes of this call. A lumen.blob.Cursor
        is for points that are answered in the processor's memory.

    Returns
    -------
    tensor (n,) or (), of the type and on the device of the points

    Raises ValueError for another shape, TypeError for another type, ImportError for float32 on a CUDA device without
    libblob-cuda, RuntimeError where the device refuses.
    """
    if not isinstance(points, torch.Tensor):
        points = torch.from_dlpack(points)
    if points.dtype not in (torch.float32, torch.float64):
        raise TypeError(f"points: found {points.dtype}, expected torch.float32 or torch.float64")
    if points.ndim not in (1, 2) or points.shape[-1] != 3:
        raise ValueError(f"points: found the shape {tuple(points.shape)}, expected (n, 3) or (3,)")
    rows = points.reshape(-1, 3)
    if isinstance(cursor, torch.Tensor):
        _check_cursor(cursor, rows)
    result = _Distance.apply(rows, model, cursor)
    return result.reshape(points.shape[:-1])


def _check_cursor(cursor, rows):
    """Raises TypeError for another type or device, ValueError for another length or for strides."""
    if cursor.dtype != torch.int32 or cursor.device != rows.device:
        raise TypeError(f"cursor: found {cursor.dtype} on {cursor.device}, expected torch.int32 on {rows.device}")
    if cursor.shape != rows.shape[:1] or not cursor.is_contiguous():
        raise ValueError(f"cursor: found the shape {tuple(cursor.shape)}, expected a contiguous ({len(rows)},)")


def _numbers(tensor):
    """The tensor's memory as an array of NumPy, or a copy from another device."""
    return tensor.detach().cpu().contiguous().numpy()


def _tensor(array, like):
    return torch.from_numpy(np.ascontiguousarray(array)).to(like)


def _answered_there(points):
    """Whether libblob-cuda answers these points where they are."""
    return points.is_cuda and torch.version.cuda is not None and points.dtype == torch.float32


def _through_host(model, points, cursor):
    """Distances, normals, and the nodes of the points as a lumen.blob.Cursor."""
    numbers = _numbers(points)
    if cursor is None:
        nodes = model.cursor(numbers)
    elif isinstance(cursor, torch.Tensor):
        nodes = _hessian.cursor_of(_numbers(cursor).view(np.uint32))
    else:
        nodes = cursor
    answer = model.query(numbers, nodes, blob.DISTANCE_EXACT)
    if isinstance(cursor, torch.Tensor):
        cursor.copy_(torch.from_numpy(nodes.node.view(np.int32)))
    return _tensor(answer.distance, points), _tensor(answer.normal, points), nodes


def _on_device(model, points, cursor):
    """Distances, normals, and the nodes of the points as a tensor, all on the points' device."""
    if isinstance(cursor, blob.Cursor):
        raise TypeError(f"cursor: found lumen.blob.Cursor, expected a tensor of torch.int32 on {points.device}")
    device = points.device
    points = points.detach().contiguous()
    if cursor is None:
        cursor = torch.full((len(points),), NOWHERE, dtype=torch.int32, device=device)
    answer = torch.empty((len(points), 4), dtype=torch.float32, device=device)
    vessels = _cuda.vessels(model, device.index, functools.partial(torch.cuda.synchronize, device.index))
    vessels.query(len(points), points.data_ptr(), cursor.data_ptr(), answer.data_ptr(),
                  stream=torch.cuda.current_stream(device).cuda_stream)
    return answer[:, 0].clone(), answer[:, 1:], cursor


class _Distance(torch.autograd.Function):
    """Distances, whose gradient is the normal."""

    @staticmethod
    def forward(ctx, points, model, cursor):
        answered = _on_device if _answered_there(points) else _through_host
        depth, normal, nodes = answered(model, points, cursor)
        if ctx.needs_input_grad[0]:
            if cursor is not None:  # the caller's, which moves on
                nodes = nodes.clone() if isinstance(nodes, torch.Tensor) else nodes.copy()
            ctx.model, ctx.nodes = model, nodes
            ctx.save_for_backward(points, normal)
        return depth

    @staticmethod
    def backward(ctx, of_distance):
        points, normal = ctx.saved_tensors
        return of_distance[:, None] * _Normal.apply(points, normal, ctx.model, ctx.nodes), None, None


class _Normal(torch.autograd.Function):
    """Normals that are known, whose derivative is the Hessian of the distance."""

    @staticmethod
    def forward(ctx, points, normal, model, nodes):
        ctx.model, ctx.nodes = model, nodes
        ctx.save_for_backward(points)
        return normal.clone()

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx, of_normal):
        points, = ctx.saved_tensors
        nodes = ctx.nodes
        if isinstance(nodes, torch.Tensor):
            nodes = _hessian.cursor_of(_numbers(nodes).view(np.uint32))
        hessian = _tensor(_hessian.of_distance(ctx.model, _numbers(points), nodes), points)
        return (hessian * of_normal[:, None, :]).sum(dim=-1), None, None, None
