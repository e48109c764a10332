# SPDX-License-Identifier: Apache-2.0
"""The distance as an operation of PyTorch: values, and both derivatives by differences."""
import unittest

import numpy as np

try:
    import torch
except ImportError:
    torch = None

from fixture import sample
from lumen import blob


@unittest.skipIf(torch is None, "torch (Debian: python3-torch) is missing")
class TorchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import lumen.torch
        cls.distance = staticmethod(lumen.torch.distance)
        cls.model = blob.Model(sample().case)
        tree = sample().case.tree
        random = np.random.default_rng(2)
        node = random.integers(len(tree), size=400)
        away = random.normal(size=(400, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        points = tree.centre[node] + away * tree.radius[node, None] * random.uniform(0.5, 1.6, (400, 1))
        near = np.abs(cls.model.query(points, flags=blob.DISTANCE_EXACT).distance)
        cls.points = points[near < 0.5 * tree.radius[node]]  # the axis, where the nearest point is many, is left out

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

    def test_one_point_has_no_leading_axis_and_wrong_points_are_refused(self):
        one = self.distance(self.model, torch.tensor(self.points[0]))
        self.assertEqual(one.shape, ())
        with self.assertRaisesRegex(ValueError, r"\(n, 3\)"):
            self.distance(self.model, torch.zeros(4, 2, dtype=torch.float64))
        with self.assertRaisesRegex(TypeError, "float32"):
            self.distance(self.model, torch.zeros(4, 3, dtype=torch.int32))


if __name__ == "__main__":
    unittest.main()
