# SPDX-License-Identifier: Apache-2.0
"""lumen.jax on the stand-in for JAX, where JAX is missing: values and derivatives of its rules. test_jax.py tests JAX itself."""
import unittest

import numpy as np

try:
    import jax
except ImportError:
    jax = None
    import jax_stand_in

from fixture import sample
from lumen import _hessian, blob
from test_cuda import DRIVER, NEEDS_STAND_IN, Runtime, enter_context

PLATFORM = "cpu"


class Ffi:
    """jax.ffi, whose calls are made at once."""

    registered = ()

    def pycapsule(self, address):
        return address

    def register_ffi_target(self, name, capsule, platform):
        self.registered += ((name, platform, capsule != 0),)

    def ffi_call(self, name, results, vmap_method, input_output_aliases):
        if (name, "CUDA", True) not in self.registered or vmap_method != "broadcast_all" or input_output_aliases != {1: 1}:
            raise ValueError(name)

        def call(points, nodes, model):
            answer, nodes = np.empty(results[0].shape, results[0].dtype), nodes.copy()
            if Runtime().call(int(model), points, nodes, answer) is not None:
                raise RuntimeError(name)
            DRIVER.cuStreamSynchronize(None)
            return [answer, nodes]

        return call


@unittest.skipUnless(jax is None, "jax is here: test_jax.py")
class RulesTest(unittest.TestCase):
    platform = "cpu"
    tolerance = {np.float32: 1e-5, np.float64: 0}

    @classmethod
    def setUpClass(cls):
        jax_stand_in.install(lambda: PLATFORM, Ffi())
        import lumen.jax
        cls.lumen = lumen.jax
        cls.model = blob.Model(sample().case)
        tree = sample().case.tree
        random = np.random.default_rng(4)
        away = random.normal(size=(len(tree), 3))
        away *= random.uniform(0.8, 1.2, (len(tree), 1)) / np.linalg.norm(away, axis=1, keepdims=True)
        cls.points = (tree.centre + tree.radius[:, None] * away).astype(np.float32)
        cls.wanted = cls.model.query(cls.points, flags=blob.DISTANCE_EXACT)

    def setUp(self):
        global PLATFORM
        PLATFORM = self.platform

    def distance(self, points):
        return self.lumen.distance(self.model, points)

    def derivatives(self, function, points, level):
        """Those of a function of points by each coordinate, on a new last axis."""
        columns = []
        for axis in range(3):
            direction = np.zeros(points.shape, points.dtype)
            direction[:, axis] = 1
            columns.append(function(jax_stand_in.Dual(level, points, direction)).tangent)
        return columns

    def test_values_and_nodes_are_those_of_libblob(self):
        for kind, tolerance in self.tolerance.items():
            depth, nodes = self.lumen.distance_and_cursor(self.model, self.points.astype(kind))
            self.assertEqual((depth.dtype, depth.shape, nodes.dtype), (kind, (len(self.points),), np.uint32))
            np.testing.assert_allclose(depth, self.wanted.distance, rtol=0, atol=tolerance)
            np.testing.assert_array_equal(nodes, self.wanted.node)

    def test_the_first_derivative_is_the_normal(self):
        for kind, tolerance in self.tolerance.items():
            found = np.stack(self.derivatives(self.distance, self.points.astype(kind), 1), axis=-1)
            self.assertEqual(found.dtype, kind)
            np.testing.assert_allclose(found, self.wanted.normal, rtol=0, atol=300 * tolerance)

    def test_the_second_derivative_is_the_hessian_and_a_third_raises(self):
        wanted = _hessian.of_distance(self.model, self.points, self.model.cursor(self.points))
        for kind in self.tolerance:
            points = self.points.astype(kind)
            rows = [self.derivatives(lambda at, axis=axis: self.derivatives_at(at, axis), points, 1) for axis in range(3)]
            np.testing.assert_allclose(np.moveaxis(rows, 2, 0), wanted, rtol=0, atol=1e-5 * np.abs(wanted).max())
            with self.assertRaisesRegex(ValueError, "do not support JVP"):
                self.derivatives(lambda at: self.derivatives(lambda more: self.derivatives_at(more, 0), at, 2)[0], points, 1)

    def derivatives_at(self, points, axis):
        """One column of derivatives at points that may be duals already."""
        direction = np.zeros(points.shape, points.dtype)
        direction[:, axis] = 1
        return self.distance(jax_stand_in.Dual(3, points, direction)).tangent

    def test_any_leading_axes_and_none_are_points(self):
        np.testing.assert_array_equal(self.distance(self.points[None, :, None])[0, :, 0], self.distance(self.points))
        self.assertEqual(self.distance(self.points[0]), self.distance(self.points)[0])
        self.assertEqual(self.distance(self.points[:0]).shape, (0,))


@NEEDS_STAND_IN
class RulesOnCudaTest(RulesTest):
    """float32 through the call of XLA's interface, float64 through the processor."""

    platform = "cuda"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        enter_context()


if __name__ == "__main__":
    unittest.main()
