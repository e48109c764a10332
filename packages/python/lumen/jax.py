# SPDX-License-Identifier: Apache-2.0
"""The distance to the wall as an operation of JAX, twice differentiable (needs the package jax, 0.7 or newer).

    depth = lumen.jax.distance(model, points)           # points (..., 3), mm, LPS; depth (...), mm
    jax.grad(lambda p: jnp.square(jnp.maximum(lumen.jax.distance(model, p), 0)).sum())(points)

The distance is that to the nearest point of the wall, negative in the lumen. Its gradient is the
outward normal there, its Hessian follows from the wall's curvatures there; a third derivative raises.
Works eagerly and under jit, vmap, grad, jvp and their compositions.

Points of float32 on a CUDA device are answered there by libblob-cuda, as a call on the stream of the
compiled program, and their second derivatives through the processor's memory. Others (float64 needs
jax_enable_x64) are answered in the processor's memory by libblob in doubles, by jax.pure_callback.

Compiled programs keep their models: JAX holds them until jax.clear_caches(), those on a device stay for
the life of the process. Arrays that are sharded over several devices are not supported.
"""
import functools

import jax
import jax.numpy as jnp
import numpy as np

from . import _hessian, _xla, blob

__all__ = ["NOWHERE", "distance", "distance_and_cursor"]

NOWHERE = np.uint32(0xFFFFFFFF)  #: a cursor that is not known: the query locates


def distance(model, points, cursor=None) -> jax.Array:
    """Signed distance to the nearest point of the wall, mm, negative in the lumen; differentiable by the points.

    Parameters
    ----------
    model : lumen.blob.Model
        No argument of a function that is transformed: it is not an array.
    points : array (..., 3), float32 or float64
        mm, LPS. An array of another library that has __dlpack__ (PyTorch, CuPy) is read without a copy.
    cursor : array (...) of uint32, optional
        The node of each point to start from, or NOWHERE. Points without a cursor are located, which costs more and may
        find a vessel that merely touches.

    Returns
    -------
    array (...), of the type of the points

    Raises ValueError for another shape, TypeError for another type. Without libblob-cuda, a computation on a CUDA device
    fails with its name.
    """
    return distance_and_cursor(model, points, cursor)[0]


def distance_and_cursor(model, points, cursor=None):
    """distance(), and the node of each point, (...) uint32: the cursor of the next step. Arguments as for distance()."""
    points = _array(points)
    if points.dtype not in (np.float32, np.float64):
        raise TypeError(f"points: found {points.dtype}, expected float32 or float64")
    if points.ndim == 0 or points.shape[-1] != 3:
        raise ValueError(f"points: found the shape {points.shape}, expected (..., 3)")
    if cursor is None:
        cursor = jnp.full(points.shape[:-1], NOWHERE, np.uint32)
    cursor = _array(cursor)
    if cursor.dtype != np.uint32:
        raise TypeError(f"cursor: found {cursor.dtype}, expected uint32")
    if cursor.shape != points.shape[:-1]:
        raise ValueError(f"cursor: found the shape {cursor.shape}, expected {points.shape[:-1]}")
    depth, normal, nodes = _answer(model, jax.lax.stop_gradient(points), cursor)
    return _depth(model, points, depth, normal, nodes), nodes


def _array(values):
    if isinstance(values, jax.Array) or not hasattr(values, "__dlpack__") or isinstance(values, (np.ndarray, np.generic)):
        return jnp.asarray(values)
    return jax.dlpack.from_dlpack(values)


@functools.partial(jax.jit, static_argnums=0)
def _answer(model, points, nodes):
    """Distances (...), normals (..., 3) and nodes (...); compiled, so that the place of the points is known."""
    on_host = functools.partial(_on_host, model)
    if points.dtype == np.float64:
        return on_host(points, nodes)
    return jax.lax.platform_dependent(points, nodes, cuda=functools.partial(_on_device, model), default=on_host)


def _on_device(model, points, nodes):
    _xla.register(jax.ffi)
    shape = nodes.shape
    results = (jax.ShapeDtypeStruct(shape + (4,), np.float32), jax.ShapeDtypeStruct(shape, np.uint32))
    call = jax.ffi.ffi_call(_xla.TARGET, results, vmap_method="broadcast_all", input_output_aliases={1: 1})
    answer, nodes = call(points, nodes, model=np.int64(_xla.number_of(model)))
    return answer[..., 0], answer[..., 1:], nodes


def _on_host(model, points, nodes):
    shape, kind = nodes.shape, points.dtype
    results = (jax.ShapeDtypeStruct(shape, kind), jax.ShapeDtypeStruct(shape + (3,), kind),
               jax.ShapeDtypeStruct(shape, np.uint32))
    return tuple(jax.pure_callback(functools.partial(_query, model), results, points, nodes, vmap_method="broadcast_all"))


def _query(model, points, nodes):
    """_answer() by libblob, of arrays with any leading axes."""
    points, nodes = np.asarray(points), np.asarray(nodes)
    cursor = _hessian.cursor_of(nodes.reshape(-1))
    answer = model.query(points.reshape(-1, 3), cursor, blob.DISTANCE_EXACT)
    return (answer.distance.astype(points.dtype).reshape(nodes.shape), answer.normal.astype(points.dtype).reshape(points.shape),
            cursor.node.reshape(nodes.shape).copy())


@functools.partial(jax.jit, static_argnums=0)
def _second(model, points, nodes):
    """The Hessian of the distance (..., 3, 3), 1/mm."""
    result = jax.ShapeDtypeStruct(points.shape + (3,), points.dtype)
    return jax.pure_callback(functools.partial(_query_second, model), result, points, nodes, vmap_method="broadcast_all")


def _query_second(model, points, nodes):
    """_second() by libblob, of arrays with any leading axes."""
    points, nodes = np.asarray(points), np.asarray(nodes)
    second = _hessian.of_distance(model, points.reshape(-1, 3), _hessian.cursor_of(nodes.reshape(-1)))
    return second.astype(points.dtype).reshape(points.shape + (3,))


@functools.partial(jax.custom_jvp, nondiff_argnums=(0,))
def _depth(model, points, depth, normal, nodes):  # pylint: disable=unused-argument
    """A depth that is known, whose derivative by the points is the normal."""
    return depth


@_depth.defjvp
def _depth_jvp(model, primals, tangents):
    points, depth, normal, nodes = primals
    along = _normal(model, points, normal, nodes)
    return _depth(model, points, depth, normal, nodes), jnp.sum(along * tangents[0], axis=-1)


@functools.partial(jax.custom_jvp, nondiff_argnums=(0,))
def _normal(model, points, normal, nodes):  # pylint: disable=unused-argument
    """A normal that is known, whose derivative by the points is the Hessian of the distance."""
    return normal


@_normal.defjvp
def _normal_jvp(model, primals, tangents):
    points, normal, nodes = primals
    change = jnp.sum(_second(model, points, nodes) * tangents[0][..., None, :], axis=-1)
    return _normal(model, points, normal, nodes), change
