# SPDX-License-Identifier: Apache-2.0
"""The distance as an operation of PyTorch: values, and both derivatives by differences."""
import gc
import unittest

import numpy as np

try:
    import torch
except ImportError:
    torch = None

from fixture import sample
from lumen import _cuda, blob



def points_near_the_wall(model, count):
    """Points (n, 3) out to 1.6 radii of the sample, float64, without the axis, where many points of the wall are nearest."""
    tree = sample().case.tree
    random = np.random.default_rng(2)
    node = random.integers(len(tree), size=count)
    away = random.normal(size=(count, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    points = tree.centre[node] + away * tree.radius[node, None] * random.uniform(0.5, 1.6, (count, 1))
    near = np.abs(model.query(points, flags=blob.DISTANCE_EXACT).distance)
    return points[near < 0.5 * tree.radius[node]]


def has_cuda():
    if torch is None or not torch.cuda.is_available():
        return False
    try:
        return _cuda.library() is not None
    except ImportError:
        return False


@unittest.skipIf(torch is None, "torch (Debian: python3-torch) is missing")
class TorchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import lumen.torch
        cls.distance = staticmethod(lumen.torch.distance)
        cls.model = blob.Model(sample().case)
        cls.points = points_near_the_wall(cls.model, 400)

    def test_values_are_those_of_libblob_for_both_types(self):
        expected = self.model.query(self.points, flags=blob.DISTANCE_EXACT)
        for kind, tolerance in ((torch.float64, 0), (torch.float32, 1e-5)):
            points = torch.tensor(self.points, dtype=kind, requires_grad=True)
            depth = self.distance(self.model, points)
            self.assertEqual((depth.dtype, depth.shape), (kind, (len(self.points),)))
            np.testing.assert_allclose(depth.detach().numpy(), expected.distance, rtol=0, atol=tolerance)
            depth.sum().backward()
            np.testing.assert_allclose(points.grad.numpy(), expected.normal, rtol=0, atol=20 * tolerance)

    def differences(self, function, step):
        """Derivative of an answer (n, ...) by each coordinate, with the nodes of the points held."""
        columns = []
        for axis in range(3):
            ahead, behind = (function(torch.tensor(self.points + s * step * np.eye(3)[axis])) for s in (1, -1))
            columns.append((ahead - behind) / (2 * step))
        return torch.stack(columns, dim=-1).numpy()

    def test_the_gradient_is_that_of_differences(self):
        points = torch.tensor(self.points, requires_grad=True)
        self.distance(self.model, points).sum().backward()
        found = self.differences(lambda at: self.distance(self.model, at), 1e-3)
        self.assertLess(np.quantile(np.abs(found - points.grad.numpy()), 0.99), 5e-4)

    def gradient(self, points):
        points = points.clone().requires_grad_()
        return torch.autograd.grad(self.distance(self.model, points).sum(), points)[0]

    def test_the_second_derivative_is_that_of_differences_of_the_gradient(self):
        points = torch.tensor(self.points, requires_grad=True)
        gradient, = torch.autograd.grad(self.distance(self.model, points).sum(), points, create_graph=True)
        rows = [torch.autograd.grad(gradient[:, axis].sum(), points, retain_graph=True)[0] for axis in range(3)]
        hessian = torch.stack(rows, dim=1).numpy()
        found = self.differences(self.gradient, 1e-3)
        scale = np.linalg.norm(hessian, axis=(1, 2))
        error = np.linalg.norm(hessian - found, axis=(1, 2)) / scale
        self.assertGreater(np.median(scale), 0.1)  # 1/mm
        self.assertLess(np.median(error), 0.001)
        self.assertLess(np.quantile(error, 0.9), 0.005)
        along = np.linalg.norm(hessian @ gradient.detach().numpy()[:, :, None], axis=(1, 2))  # 0, as |normal| is 1
        self.assertLess(np.max(along / scale), 1e-4)

    def test_a_loss_moves_points_to_the_wall(self):
        points = torch.tensor(self.points, requires_grad=True)
        cursor = self.model.cursor(self.points)
        optimiser = torch.optim.SGD([points], lr=0.5)
        for _ in range(20):
            optimiser.zero_grad()
            self.distance(self.model, points, cursor).square().sum().backward()
            optimiser.step()
        depth = self.distance(self.model, points, cursor).detach().numpy()
        self.assertLess(np.quantile(np.abs(depth), 0.99), 1e-4)

    def test_a_tensor_of_nodes_is_a_cursor(self):
        points = torch.tensor(self.points)
        expected = self.model.cursor(self.points)
        cursor = torch.tensor(expected.node.view(np.int32))
        depth = self.distance(self.model, points, cursor)
        self.model.query(self.points, expected, blob.DISTANCE_EXACT)
        np.testing.assert_array_equal(cursor.numpy().view(np.uint32), expected.node)
        unknown = torch.full((len(points),), -1, dtype=torch.int32)
        np.testing.assert_array_equal(self.distance(self.model, points, unknown).numpy(), depth.numpy())
        self.assertGreater(len(unknown.unique()), 20)
        with self.assertRaisesRegex(TypeError, "int64 on cpu, expected torch.int32 on cpu"):
            self.distance(self.model, points, cursor.long())
        with self.assertRaisesRegex(ValueError, r"\(7,\)"):
            self.distance(self.model, points, cursor[:7])

    def test_arrays_of_other_libraries_are_read(self):
        np.testing.assert_array_equal(self.distance(self.model, self.points).numpy(),
                                      self.distance(self.model, torch.tensor(self.points)).numpy())

    def test_one_point_has_no_leading_axis_and_wrong_points_are_refused(self):
        one = self.distance(self.model, torch.tensor(self.points[0]))
        self.assertEqual(one.shape, ())
        with self.assertRaisesRegex(ValueError, r"\(n, 3\)"):
            self.distance(self.model, torch.zeros(4, 2, dtype=torch.float64))
        with self.assertRaisesRegex(TypeError, "float32"):
            self.distance(self.model, torch.zeros(4, 3, dtype=torch.int32))


@unittest.skipUnless(has_cuda(), "torch with a CUDA device, or libblob-cuda, is missing")
class CudaTest(unittest.TestCase):
    """Tensors on a device, beside libblob in doubles."""

    @classmethod
    def setUpClass(cls):
        import lumen.torch
        cls.distance = staticmethod(lumen.torch.distance)
        cls.model = blob.Model(sample().case)
        cls.host = points_near_the_wall(cls.model, 4000).astype(np.float32)
        cls.wanted = cls.model.query(cls.host, flags=blob.DISTANCE_EXACT)
        cls.points = torch.tensor(cls.host, device="cuda")
        cls.distance(cls.model, cls.points)  # uploads

    def expect_distances(self, depth):
        found = depth.detach().cpu().numpy()
        self.assertGreater(np.mean(np.abs(found - self.wanted.distance) < 1e-5), 0.99)
        np.testing.assert_array_equal(found < 0, self.wanted.distance < 0)

    def test_values_and_gradients_are_those_of_libblob(self):
        points = self.points.clone().requires_grad_()
        depth = self.distance(self.model, points)
        self.assertEqual((depth.dtype, depth.device, depth.shape), (torch.float32, points.device, points.shape[:1]))
        self.expect_distances(depth)
        (2 * depth).sum().backward()
        turned = np.abs(points.grad.cpu().numpy() / 2 - self.wanted.normal).max(axis=1)
        self.assertLess(np.median(turned), 1e-5)
        self.assertGreater(np.mean(turned < 1e-3), 0.99)

    def test_nothing_waits_for_the_device(self):
        points = self.points.clone().requires_grad_()
        cursor = torch.full((len(points),), -1, dtype=torch.int32, device="cuda")
        torch.cuda.set_sync_debug_mode("error")  # a copy to the processor's memory raises
        try:
            self.distance(self.model, points, cursor).square().sum().backward()
        finally:
            torch.cuda.set_sync_debug_mode("default")
        self.assertGreater(float(points.grad.norm()), 0)

    def test_the_gradient_is_that_of_differences(self):
        points = self.points.clone().requires_grad_()
        self.distance(self.model, points).sum().backward()
        step, columns = 2.0**-6, []
        for axis in range(3):
            offset = step * torch.eye(3, device="cuda")[axis]
            ahead, behind = (self.distance(self.model, self.points + sign * offset) for sign in (1, -1))
            columns.append((ahead - behind) / (2 * step))
        error = (torch.stack(columns, dim=1) - points.grad).abs().amax(dim=1).cpu().numpy()
        self.assertLess(np.quantile(error, 0.9), 1e-3)

    def test_second_derivatives_are_those_on_the_processor(self):
        def of(points):
            points = points.clone().requires_grad_()
            gradient, = torch.autograd.grad(self.distance(self.model, points).sum(), points, create_graph=True)
            rows = [torch.autograd.grad(gradient[:, axis].sum(), points, retain_graph=True)[0] for axis in range(3)]
            return torch.stack(rows, dim=1)

        there, here = of(self.points), of(torch.tensor(self.host, dtype=torch.float64))
        self.assertEqual((there.dtype, there.device), (torch.float32, self.points.device))
        error = (there.cpu() - here).norm(dim=(1, 2)) / here.norm(dim=(1, 2))
        self.assertLess(np.quantile(error.numpy(), 0.98), 1e-5)

    def test_doubles_are_answered_in_doubles(self):
        depth = self.distance(self.model, self.points.double())
        self.assertEqual((depth.dtype, depth.device), (torch.float64, self.points.device))
        np.testing.assert_array_equal(depth.cpu().numpy(), self.wanted.distance)

    def test_cursors_move_on_the_device(self):
        expected = self.model.cursor(self.host)
        cursor = torch.tensor(expected.node.view(np.int32), device="cuda")
        depth = self.distance(self.model, self.points, cursor)
        self.model.query(self.host, expected, blob.DISTANCE_EXACT)
        np.testing.assert_array_equal(cursor.cpu().numpy().view(np.uint32), expected.node)
        self.expect_distances(depth)
        with self.assertRaisesRegex(TypeError, "lumen.blob.Cursor, expected a tensor of torch.int32 on cuda"):
            self.distance(self.model, self.points, expected)
        with self.assertRaisesRegex(TypeError, "int32 on cpu, expected torch.int32 on cuda"):
            self.distance(self.model, self.points, cursor.cpu())

    def test_queries_are_on_the_current_stream(self):
        stream = torch.cuda.Stream()
        stream.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(stream):
            torch.cuda._sleep(2_000_000_000)  # pylint: disable=protected-access  # about a second of the device's clock
            depth = self.distance(self.model, self.points + 0)
            self.assertFalse(stream.query())  # the call is back before its stream is through
        stream.synchronize()
        self.expect_distances(depth)

    def test_a_graph_records_a_query(self):
        points = torch.zeros_like(self.points)
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph), torch.no_grad():
            depth = self.distance(self.model, points)
        points.copy_(self.points)
        graph.replay()
        self.expect_distances(depth)

    def test_slices_and_arrays_of_other_libraries_are_read(self):
        wide = torch.cat([self.points, self.points], dim=1)
        self.expect_distances(self.distance(self.model, wide[:, 3:]))
        try:
            import cupy
        except ImportError:
            self.skipTest("cupy is missing")
        depth = self.distance(self.model, cupy.asarray(self.host))
        self.assertTrue(depth.is_cuda)
        self.expect_distances(depth)

    def test_a_model_leaves_the_device_with_its_last_reference(self):
        model = blob.Model(sample().case)
        self.distance(model, self.points)
        count = len(_cuda._kept)  # pylint: disable=protected-access
        del model
        gc.collect()
        self.assertEqual(len(_cuda._kept), count - 1)  # pylint: disable=protected-access

    def test_a_loss_moves_points_to_the_wall(self):
        points = self.points.clone().requires_grad_()
        cursor = torch.full((len(points),), -1, dtype=torch.int32, device="cuda")
        optimiser = torch.optim.SGD([points], lr=0.5)
        for _ in range(20):
            optimiser.zero_grad()
            self.distance(self.model, points, cursor).square().sum().backward()
            optimiser.step()
        depth = self.distance(self.model, points, cursor).detach().cpu().numpy()
        self.assertLess(np.quantile(np.abs(depth), 0.99), 1e-4)


if __name__ == "__main__":
    unittest.main()
