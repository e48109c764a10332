# SPDX-License-Identifier: Apache-2.0
"""The distance as an operation of JAX: values and both derivatives, eagerly and compiled, on each of JAX's platforms."""
import typing
import unittest

import numpy as np

try:
    import jax
    import jax.numpy as jnp
except ImportError:
    jax = None

from fixture import sample
from lumen import _cuda, blob


def platforms():
    """Those that can answer here: the processor, and CUDA with libblob-cuda."""
    found = ["cpu"]
    try:
        _cuda.library()
        jax.devices("cuda")
        found.append("cuda")
    except (ImportError, RuntimeError):
        pass
    return found


class Case(typing.NamedTuple):
    platform: str
    kind: type
    points: typing.Any  #: on a device of the platform
    share: float  #: of distances that must be within 1e-5 mm of libblob's


@unittest.skipIf(jax is None, "jax is missing")
class JaxTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import lumen.jax
        jax.config.update("jax_enable_x64", True)
        cls.lumen = lumen.jax
        cls.model = blob.Model(sample().case)
        tree = sample().case.tree
        random = np.random.default_rng(2)
        node = random.integers(len(tree), size=400)
        away = random.normal(size=(400, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        points = tree.centre[node] + away * tree.radius[node, None] * random.uniform(0.5, 1.6, (400, 1))
        near = np.abs(cls.model.query(points, flags=blob.DISTANCE_EXACT).distance)
        points = points[near < 0.5 * tree.radius[node]]  # without the axis, where many points of the wall are nearest
        cls.points = points.astype(np.float32)
        cls.wanted = cls.model.query(cls.points, flags=blob.DISTANCE_EXACT)

    @classmethod
    def tearDownClass(cls):
        jax.config.update("jax_enable_x64", False)

    def distance(self, points, cursor=None):
        return self.lumen.distance(self.model, points, cursor)

    def cases(self):
        for platform in platforms():
            for kind in (np.float32, np.float64):
                points = jax.device_put(self.points.astype(kind), jax.devices(platform)[0])
                yield Case(platform, kind, points, 0.99 if (platform, kind) == ("cuda", np.float32) else 1)

    def for_each_case(self, check):
        for case in self.cases():
            with self.subTest(platform=case.platform, kind=case.kind.__name__):
                check(case)

    def expect_distances(self, depth, share=1):
        self.assertGreaterEqual(np.mean(np.abs(np.asarray(depth).reshape(-1) - self.wanted.distance) < 1e-5), share)

    def expect_normals(self, gradient):
        turned = np.abs(np.asarray(gradient).reshape(-1, 3) - self.wanted.normal).max(axis=1)
        self.assertLess(np.median(turned), 1e-5)
        self.assertGreater(np.mean(turned < 1e-3), 0.99)

    def test_values_are_those_of_libblob(self):
        def check(case):
            for function in (self.distance, jax.jit(self.distance)):
                depth = function(case.points)
                self.assertEqual((depth.dtype, depth.shape), (case.kind, case.points.shape[:1]))
                self.assertEqual(depth.devices(), case.points.devices())
                self.expect_distances(depth, case.share)
                if case.kind == np.float64:
                    np.testing.assert_array_equal(depth, self.wanted.distance)

        self.for_each_case(check)

    def test_gradients_are_normals(self):
        def check(case):
            gradient = jax.grad(lambda at: self.distance(at).sum())
            mapped = jax.vmap(jax.grad(self.distance))
            for function in (gradient, jax.jit(gradient), mapped, jax.jit(mapped)):
                found = function(case.points)
                self.assertEqual(found.dtype, case.kind)
                self.expect_normals(found)
            value, found = jax.jit(jax.value_and_grad(lambda at: jnp.square(self.distance(at)).sum()))(case.points)
            np.testing.assert_allclose(value, np.square(self.wanted.distance).sum(), rtol=1e-4)
            self.expect_normals(found / (2 * self.wanted.distance[:, None]))

        self.for_each_case(check)

    def test_forward_derivatives_are_those_along_a_direction(self):
        direction = np.array([0.6, 0, 0.8])

        def check(case):
            directions = jnp.broadcast_to(jnp.asarray(direction, case.kind), case.points.shape)
            change = jax.jvp(self.distance, (case.points,), (directions,))[1]
            self.assertLess(np.median(np.abs(change - self.wanted.normal @ direction)), 1e-5)

        self.for_each_case(check)

    def test_the_gradient_is_that_of_differences(self):
        points = jnp.asarray(self.points, jnp.float64)
        gradient = jax.grad(lambda at: self.distance(at).sum())(points)
        step = 1e-3
        for axis in range(3):
            offset = step * np.eye(3)[axis]
            found = (self.distance(points + offset) - self.distance(points - offset)) / (2 * step)
            self.assertLess(np.quantile(np.abs(found - gradient[:, axis]), 0.99), 5e-4)

    def test_the_second_derivative_is_that_of_differences_of_the_gradient(self):
        gradient = jax.vmap(jax.grad(self.distance))
        step, columns = 1e-3, []
        for axis in range(3):
            offset = step * np.eye(3)[axis]
            columns.append((gradient(self.points + offset) - gradient(self.points - offset)) / (2 * step))
        wanted = np.stack(columns, axis=-1)
        scale = np.linalg.norm(wanted, axis=(1, 2))
        self.assertGreater(np.median(scale), 0.1)  # 1/mm

        def check(case):
            for name, function in (("hessian", jax.hessian(self.distance)), ("grad of grad", self.grad_of_grad)):
                for compiled in (False, True):
                    with self.subTest(function=name, compiled=compiled):
                        mapped = jax.vmap(function)
                        found = (jax.jit(mapped) if compiled else mapped)(case.points)
                        self.assertEqual((found.dtype, found.shape), (case.kind, case.points.shape + (3,)))
                        error = np.linalg.norm(found - wanted, axis=(1, 2)) / scale
                        self.assertLess(np.median(error), 0.001)
                        self.assertLess(np.quantile(error, 0.9), 0.005)

        self.for_each_case(check)

    def grad_of_grad(self, point):
        gradient = jax.grad(self.distance)
        return jnp.stack([jax.grad(lambda at, axis=axis: gradient(at)[axis])(point) for axis in range(3)])

    def test_a_third_derivative_raises(self):
        with self.assertRaisesRegex(ValueError, "do not support JVP"):
            jax.jacfwd(jax.hessian(self.distance))(jnp.asarray(self.points[0]))

    def test_any_leading_axes_are_points(self):
        def check(case):
            depth = self.distance(case.points[None, :, None])
            self.expect_distances(depth, case.share)
            nested = jax.vmap(jax.vmap(self.distance))(case.points[None])
            self.expect_distances(nested, case.share)
            self.assertEqual(self.distance(case.points[0]).shape, ())
            self.assertEqual(self.distance(case.points[:0]).shape, (0,))

        self.for_each_case(check)

    def sum_and_cursor(self, points, cursor):
        depth, cursor = self.lumen.distance_and_cursor(self.model, points, cursor)
        return depth.sum(), cursor

    def test_cursors_are_kept_from_step_to_step(self):
        def check(case):
            step = jax.jit(lambda at, cursor=None: self.lumen.distance_and_cursor(self.model, at, cursor))
            depth, cursor = step(case.points)
            self.expect_distances(depth, case.share)
            self.assertEqual((cursor.dtype, cursor.shape), (np.uint32, case.points.shape[:1]))
            np.testing.assert_array_equal(cursor, self.wanted.node)
            again, same = step(case.points, cursor)
            self.expect_distances(again, case.share)
            np.testing.assert_array_equal(same, cursor)
            _, held = step(case.points, cursor)  # the first call has not moved the caller's array
            np.testing.assert_array_equal(held, cursor)
            gradient, moved = jax.grad(self.sum_and_cursor, has_aux=True)(case.points, cursor)
            self.expect_normals(gradient)
            np.testing.assert_array_equal(moved, cursor)

        self.for_each_case(check)

    def test_a_given_cursor_is_not_overwritten(self):
        def check(case):
            start = jax.device_put(np.zeros(len(case.points), np.uint32), next(iter(case.points.devices())))
            depth, moved = self.lumen.distance_and_cursor(self.model, case.points, start)
            self.expect_distances(depth, case.share)
            self.assertGreater(np.count_nonzero(moved), 0)
            self.assertEqual(np.count_nonzero(start), 0)

        self.for_each_case(check)

    def test_steps_in_a_scan_move_points_to_the_wall(self):
        def check(case):
            def step(carry, _):
                at, cursor = carry
                normal, cursor = jax.grad(self.sum_and_cursor, has_aux=True)(at, cursor)
                return (at - self.distance(at, cursor)[:, None] * normal, cursor), None

            start = jnp.full(len(case.points), self.lumen.NOWHERE)
            (at, cursor), _ = jax.jit(lambda p: jax.lax.scan(step, (p, start), length=20))(case.points)
            self.assertLess(np.quantile(np.abs(self.distance(at, cursor)), 0.99), 1e-4)

        self.for_each_case(check)

    def test_lists_and_arrays_of_numpy_are_points(self):
        self.expect_distances(self.distance(self.points.astype(np.float64)))
        self.assertEqual(self.distance(self.points[:2].astype(float).tolist()).shape, (2,))

    def test_tensors_of_pytorch_are_points(self):
        try:
            import torch
        except ImportError:
            self.skipTest("torch is missing")
        self.expect_distances(self.distance(torch.tensor(self.points)))

    def test_wrong_points_and_cursors_are_refused(self):
        with self.assertRaisesRegex(ValueError, r"expected \(\.\.\., 3\)"):
            self.distance(np.zeros((4, 2)))
        with self.assertRaisesRegex(TypeError, "int32"):
            self.distance(np.zeros((4, 3), np.int32))
        with self.assertRaisesRegex(TypeError, "expected uint32"):
            self.distance(self.points, np.zeros(len(self.points), np.int32))
        with self.assertRaisesRegex(ValueError, r"\(2,\)"):
            self.distance(self.points, np.zeros(2, np.uint32))


if __name__ == "__main__":
    unittest.main()
