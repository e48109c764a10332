# SPDX-License-Identifier: Apache-2.0
"""Queries: shapes, layouts, bits, cursors, threads."""
import os
import tempfile
import threading
import unittest

import numpy as np

import lumen
from fixture import sample
from lumen import _hessian, blob


class BlobTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = sample().case
        cls.model = blob.Model(cls.case)
        random = np.random.default_rng(1)
        node = random.integers(len(cls.case.tree), size=2000)
        away = random.normal(size=(2000, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        length = cls.case.tree.radius[node, None] * random.uniform(0, 2, (2000, 1))
        cls.points = cls.case.tree.centre[node] + away * length

    def test_inside_is_a_value_above_the_iso_level_and_a_negative_distance(self):
        answer = self.model.query(self.points)
        self.assertGreater(answer.inside.sum(), 100)
        np.testing.assert_array_equal(answer.inside, answer.value > self.model.iso_level)
        np.testing.assert_array_equal(answer.inside, answer.distance < 0)
        self.assertEqual(self.model.iso_level, self.case.models.iso_level)
        self.assertEqual(len(self.model), len(self.case.tree))

    def test_the_gradient_is_that_of_the_value_and_the_normal_is_its_opposite(self):
        cursor = self.model.cursor(self.points)
        answer = self.model.query(self.points, cursor.copy(), blob.LOCAL)
        for axis in range(3):
            step = 1e-3 * np.eye(3)[axis]
            ahead, behind = (self.model.query(self.points + s * step, cursor.copy(),
                                              blob.LOCAL | blob.HOLD).value for s in (1, -1))
            np.testing.assert_allclose((ahead - behind) / 2e-3, answer.gradient[:, axis], atol=2e-3)
        length = np.linalg.norm(answer.gradient, axis=1, keepdims=True)
        np.testing.assert_allclose(answer.normal, -answer.gradient / length, atol=1e-6)

    def test_the_hessian_is_that_of_differences_of_the_gradient(self):
        cursor = self.model.cursor(self.points)
        flags = blob.LOCAL | blob.HOLD
        answer = self.model.hessian(self.points, cursor.copy(), flags)
        xx, yy, zz, xy, xz, yz = answer.hessian.T
        for axis, row in enumerate(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))):
            step = 1e-4 * np.eye(3)[axis]
            ahead, behind = (self.model.hessian(self.points + s * step, cursor.copy(), flags).gradient for s in (1, -1))
            np.testing.assert_allclose((ahead - behind) / 2e-4, np.stack(row, axis=1), atol=1e-4)
        np.testing.assert_allclose(answer.value, self.model.query(self.points, cursor, flags).value, atol=1e-6)
        self.assertEqual(self.model.hessian(self.points[0]).hessian.shape, (6,))

    def test_the_hessian_of_the_distance_is_that_of_differences_of_the_normal(self):
        answer = self.model.query(self.points, flags=blob.DISTANCE_EXACT)
        points = self.points[np.abs(answer.distance) < 0.5 * self.case.tree.radius[answer.node]]
        cursor = self.model.cursor(points)
        hessian = _hessian.of_distance(self.model, points, cursor)
        columns = []
        for axis in range(3):
            step = 1e-3 * np.eye(3)[axis]
            ahead, behind = (self.model.query(points + s * step, cursor.copy(), blob.DISTANCE_EXACT).normal for s in (1, -1))
            columns.append((ahead - behind) / 2e-3)
        scale = np.linalg.norm(hessian, axis=(1, 2))
        error = np.linalg.norm(hessian - np.stack(columns, axis=-1), axis=(1, 2)) / scale
        self.assertGreater(np.median(scale), 0.1)  # 1/mm
        self.assertLess(np.median(error), 0.001)
        self.assertLess(np.quantile(error, 0.9), 0.005)

    def test_models_are_packed_into_words_that_pass_the_check(self):
        one, two = blob.pack(self.model), blob.pack([self.model, self.model])
        self.assertEqual((one.dtype, one[3], two[3], one[2]), (np.uint32, 1, 2, len(one)))
        blob.check_packed(two)
        with self.assertRaisesRegex(lumen.Error, "packed models"):
            blob.check_packed(two[:-1])
        with self.assertRaisesRegex(ValueError, "at least one"):
            blob.pack([])

    def test_all_layouts_give_the_same_bits(self):
        expected = self.model.query(self.points).distance
        layouts = (np.asfortranarray(self.points), np.repeat(self.points, 2, axis=0)[::2],
                   self.points.tolist(), self.points.astype(">f8"),
                   np.concatenate([self.points, self.points], axis=1)[:, :3])
        for points in layouts:
            np.testing.assert_array_equal(self.model.query(points).distance, expected)
        single = self.points.astype(np.float32)
        np.testing.assert_array_equal(self.model.query(single).distance,
                                      self.model.query(single.astype(float)).distance)
        unaligned = np.frombuffer(b"x" + self.points.tobytes(), np.float64, offset=1).reshape(-1, 3)
        np.testing.assert_array_equal(self.model.query(unaligned).distance, expected)

    def test_one_point_has_no_leading_axis(self):
        many, one = self.model.query(self.points), self.model.query(self.points[0])
        self.assertIsInstance(one.distance, float)
        self.assertIsInstance(one.inside, bool)
        self.assertEqual(one.distance, many.distance[0])
        np.testing.assert_array_equal(one.normal, many.normal[0])
        self.assertEqual(self.model.query(np.empty((0, 3))).normal.shape, (0, 3))

    def test_columns_are_views_that_keep_the_answer(self):
        answer = self.model.query(self.points)
        distance, normal = answer.distance, answer.normal
        expected = distance.copy(), normal.copy()
        self.assertTrue(np.shares_memory(distance, answer.distance))
        del answer
        for _ in range(10):
            self.model.query(self.points + 1)
        np.testing.assert_array_equal(distance, expected[0])
        np.testing.assert_array_equal(normal, expected[1])

    def test_an_answer_can_be_filled_again(self):
        answer = self.model.query(self.points)
        distance = answer.distance
        again = self.model.query(self.points + 0.1, out=answer)
        self.assertIs(again, answer)
        np.testing.assert_array_equal(distance, self.model.query(self.points + 0.1).distance)
        with self.assertRaisesRegex(ValueError, "out: "):
            self.model.query(self.points[:7], out=answer)

    def test_cursors_are_the_nodes_of_least_power_and_follow_their_points(self):
        points = self.points[:100]
        away = np.linalg.norm(points[:, None] - self.case.tree.centre.astype(float), axis=2)
        power = away ** 2 - self.case.tree.radius.astype(float) ** 2
        cursor = self.model.cursor(points)
        np.testing.assert_array_equal(cursor.node, power.argmin(axis=1))
        branch = self.case.branches[0]
        start = branch.first_node
        tool = self.model.cursor(self.case.tree.centre[start:start + 1])
        self.assertEqual(tool.node[0], start)
        self.model.query(self.case.tree.centre[start + 3:start + 4], tool)
        self.assertEqual(tool.node[0], start + 3)
        with self.assertRaisesRegex(ValueError, "cursor: found 1 points, expected 100"):
            self.model.query(points, tool)

    def test_nearest_points_hits_and_capsules_meet_the_wall(self):
        points = self.points[:200]
        nearest = self.model.nearest(points)
        good = nearest.converged
        self.assertGreater(good.mean(), 0.95)
        away = np.linalg.norm(nearest.point - points, axis=1)
        np.testing.assert_allclose(away[good], np.abs(nearest.distance[good]), atol=1e-6)
        centre = self.case.tree.centre[len(self.case.tree) // 2].astype(float)
        hit = self.model.segment_hits(centre, centre + [0, 40, 0])
        self.assertTrue(hit.hit)
        self.assertLess(abs(self.model.query(hit.point).distance), 0.01)
        capsule = self.model.capsules(centre, hit.point, 0.2)
        self.assertAlmostEqual(capsule.depth - capsule.distance, 0.2)
        self.assertGreater(capsule.depth, 0)
        with self.assertRaisesRegex(ValueError, "ends: found 1 points, expected 2"):
            self.model.segment_hits(points[:2], points[:1])

    def test_wrong_shapes_are_refused(self):
        for points in (np.zeros((2, 2)), np.zeros(4), np.zeros((1, 2, 3)), 1.0):
            with self.assertRaisesRegex(ValueError, r"points: found shape .*, expected \(n, 3\)"):
                self.model.query(points)
        with self.assertRaises((TypeError, ValueError)):
            self.model.query([["a", "b", "c"]])

    def test_a_file_gives_the_model_of_its_case(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.lumen")
            self.case.write(path)
            model = blob.Model(path)
            with open(path, "wb") as file:
                file.write(b"no case at all")
            with self.assertRaisesRegex(lumen.Error, "a.lumen: ") as raised:
                blob.Model(path)
            self.assertEqual(raised.exception.file, path)
        np.testing.assert_array_equal(model.query(self.points).value, self.model.query(self.points).value)
        with self.assertRaises(lumen.Error):
            blob.Model("absent.lumen")

    def test_threads_get_the_same_bits(self):
        expected, results = self.model.query(self.points).distance, []
        work = lambda: results.append(self.model.query(self.points).distance)
        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result, expected)
        self.assertEqual(len(results), 4)


if __name__ == "__main__":
    unittest.main()
