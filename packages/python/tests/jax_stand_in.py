# SPDX-License-Identifier: Apache-2.0
"""The part of JAX that lumen.jax uses, on NumPy, for tests where JAX is missing: eager, with forward derivatives of any order.

Derivatives are dual numbers with levels: a custom_jvp takes those of the highest level away, calls its rule, and puts its
answers together again. Results of callbacks must have the types and shapes that were announced. It proves nothing about XLA."""
import sys
import types

import numpy as np


class Dual:
    """A value and its tangent, of a level: that of the derivative which is taken."""

    __array_priority__ = 1000

    def __init__(self, level, primal, tangent):
        self.level, self.primal, self.tangent = level, primal, tangent
        self.dtype, self.shape, self.ndim = primal.dtype, primal.shape, primal.ndim

    def __getitem__(self, index):
        return Dual(self.level, self.primal[index], self.tangent[index])

    def __mul__(self, other):
        level = other.level if isinstance(other, Dual) else -1
        if level == self.level:
            return Dual(level, self.primal * other.primal, self.primal * other.tangent + self.tangent * other.primal)
        if level < self.level:
            return Dual(self.level, self.primal * other, self.tangent * other)
        return Dual(level, self * other.primal, self * other.tangent)

    __rmul__ = __mul__

    def __add__(self, other):
        level = other.level if isinstance(other, Dual) else -1
        if level == self.level:
            return Dual(level, self.primal + other.primal, self.tangent + other.tangent)
        if level < self.level:
            return Dual(self.level, self.primal + other, self.tangent)
        return Dual(level, self + other.primal, other.tangent)

    __radd__ = __add__

    def sum(self, axis=None):
        return Dual(self.level, self.primal.sum(axis=axis), self.tangent.sum(axis=axis))


class CustomJvp:
    def __init__(self, function, nondiff_argnums=()):
        self.function, self.fixed, self.rule = function, len(nondiff_argnums), None

    def defjvp(self, rule):
        self.rule = rule
        return rule

    def __call__(self, *arguments):
        fixed, rest = arguments[:self.fixed], arguments[self.fixed:]
        level = max((a.level for a in rest if isinstance(a, Dual)), default=None)
        if level is None:
            return self.function(*arguments)
        mine = [isinstance(a, Dual) and a.level == level for a in rest]
        primals = tuple(a.primal if is_mine else a for a, is_mine in zip(rest, mine))
        tangents = tuple(a.tangent if is_mine else np.zeros(a.shape, a.dtype) for a, is_mine in zip(rest, mine))
        primal, tangent = self.rule(*fixed, primals, tangents)
        if (primal.shape, primal.dtype) != (tangent.shape, tangent.dtype):
            raise TypeError(f"found a tangent {tangent.dtype}{tangent.shape} of {primal.dtype}{primal.shape}")
        return Dual(level, primal, tangent)


class Shape(types.SimpleNamespace):
    def __init__(self, shape, dtype):
        super().__init__(shape=shape, dtype=np.dtype(dtype))


def pure_callback(function, results, *arguments, vmap_method):
    if vmap_method != "broadcast_all" or any(isinstance(a, Dual) for a in arguments):
        raise ValueError("Pure callbacks do not support JVP")
    for array in arguments:
        array.flags.writeable = False
    found = function(*arguments)
    for array, result in zip(*((found, results) if isinstance(found, tuple) else ((found,), (results,)))):
        if (array.shape, array.dtype) != (result.shape, result.dtype):
            raise TypeError(f"found {array.dtype}{array.shape}, announced {result.dtype}{result.shape}")
    return found


def stop_gradient(value):
    while isinstance(value, Dual):
        value = value.primal
    return value


def install(platform, ffi):
    """Puts the modules jax and jax.numpy in place; `platform()` is that of programs, `ffi` stands for jax.ffi."""
    jax = types.ModuleType("jax")
    jax.numpy = types.ModuleType("jax.numpy")
    jax.numpy.asarray = lambda value, dtype=None: value if isinstance(value, Dual) else np.asarray(value, dtype)
    jax.numpy.full, jax.numpy.sum = np.full, lambda value, axis=None: value.sum(axis=axis)
    jax.Array, jax.ShapeDtypeStruct, jax.ffi = (np.ndarray, Dual), Shape, ffi
    jax.jit, jax.custom_jvp, jax.pure_callback = lambda function, static_argnums: function, CustomJvp, pure_callback
    jax.lax = types.SimpleNamespace(stop_gradient=stop_gradient, platform_dependent=lambda *arguments, default, **known:
                                    known.get(platform(), default)(*arguments))
    jax.dlpack = types.SimpleNamespace(from_dlpack=np.from_dlpack)
    sys.modules.update({"jax": jax, "jax.numpy": jax.numpy})
