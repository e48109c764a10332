# SPDX-License-Identifier: Apache-2.0
"""Runs on any fitted case: LUMEN_BLOB_MODEL names it."""
import os
import unittest

import numpy as np

import lumen_blob

PATH = os.environ["LUMEN_BLOB_MODEL"]


class ModelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = lumen_blob.Model(PATH)
        cls.centres, cls.radii, cls.parents = cls.model.nodes()
        # around nodes, out to twice their radius
        random = np.random.default_rng(1)
        node = random.integers(len(cls.model), size=2000)
        away = random.normal(size=(2000, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        cls.points = cls.centres[node] + away * cls.radii[node, None] * random.uniform(0, 2, (2000, 1))

    def test_centres_are_inside(self):
        answer = self.model.query(self.centres)
        self.assertGreater(answer.inside.mean(), 0.95)
        self.assertEqual(answer.distance.shape, (len(self.model),))

    def test_inside_is_a_value_above_the_iso_level_and_a_negative_distance(self):
        answer = self.model.query(self.points)
        np.testing.assert_array_equal(answer.inside, answer.value > self.model.iso_level)
        np.testing.assert_array_equal(answer.inside, answer.distance < 0)

    def test_gradient_is_that_of_the_value(self):
        cursors = self.model.cursors(self.points)
        answer = self.model.query(self.points, cursors, lumen_blob.LOCAL)
        step = 1e-3
        for axis in range(3):
            offset = step * np.eye(3)[axis]
            ahead, behind = (self.model.query(self.points + sign * offset, cursors.copy(),
                                              lumen_blob.LOCAL | lumen_blob.HOLD).value
                             for sign in (1, -1))
            np.testing.assert_allclose((ahead - behind) / (2 * step), answer.gradient[:, axis], atol=2e-3)

    def test_normal_is_the_gradient_turned_outwards(self):
        answer = self.model.query(self.points)
        length = np.linalg.norm(answer.gradient, axis=1, keepdims=True)
        np.testing.assert_allclose(answer.normal, -answer.gradient / length, atol=1e-6)

    def test_one_point_gives_the_first_row(self):
        many, one = self.model.query(self.points), self.model.query(self.points[0])
        self.assertEqual(one.distance, many.distance[0])
        np.testing.assert_array_equal(one.normal, many.normal[0])

    def test_cursors_are_the_nodes_of_least_power(self):
        points = self.points[:100]
        away = np.linalg.norm(points[:, None] - self.centres, axis=2)
        power = away ** 2 - self.radii ** 2
        np.testing.assert_array_equal(self.model.cursors(points), power.argmin(axis=1))
        self.assertEqual(self.model.cursors([[np.inf, 0, 0]])[0], lumen_blob.NOWHERE)

    def test_cursors_are_moved_in_place(self):
        cursors = np.zeros(len(self.points), dtype=np.uint32)
        self.model.query(self.points, cursors)
        self.assertGreater(np.count_nonzero(cursors), 0)
        self.assertTrue((cursors < len(self.model)).all())

    def test_arrays_of_any_layout_give_the_same(self):
        expected = self.model.query(self.points).distance
        for points in (np.asfortranarray(self.points), np.repeat(self.points, 2, axis=0)[::2],
                       self.points.tolist()):
            np.testing.assert_array_equal(self.model.query(points).distance, expected)

    def test_nearest_points_lie_on_the_wall(self):
        nearest = self.model.nearest(self.points[:200])
        good = nearest.converged
        self.assertGreater(good.mean(), 0.95)
        away = np.linalg.norm(nearest.point - self.points[:200], axis=1)
        np.testing.assert_allclose(away[good], np.abs(nearest.distance[good]), atol=1e-6)

    def test_the_hessian_is_that_of_differences_of_the_gradient(self):
        points = self.points[:200]
        cursors = self.model.cursors(points)
        second = self.model.hessian(points, cursors.copy(), lumen_blob.LOCAL)
        step = 1e-3
        for axis, entries in enumerate(((0, 3, 4), (3, 1, 5), (4, 5, 2))):
            ahead, behind = (self.model.hessian(points + sign * step * np.eye(3)[axis], cursors.copy(),
                                                lumen_blob.LOCAL | lumen_blob.HOLD).gradient for sign in (1, -1))
            np.testing.assert_allclose((ahead - behind) / (2 * step), second.hessian[:, entries], atol=1e-3)
        one = self.model.hessian(points[0], cursors[:1].copy(), lumen_blob.LOCAL)
        np.testing.assert_array_equal(one.hessian, second.hessian[0])

    def test_a_packed_model_states_its_size_and_number(self):
        words = lumen_blob.pack([self.model, self.model])
        self.assertEqual((words.dtype, words[3]), (np.uint32, 2))
        self.assertGreater(len(words), len(lumen_blob.pack([self.model])))
        with self.assertRaisesRegex(ValueError, "at least one"):
            lumen_blob.pack([])

    def test_a_segment_from_the_axis_outwards_hits_the_wall(self):
        node = len(self.model) // 2
        start = self.centres[node]
        hits = self.model.segment_hits(start, start + [0, 0, 50])
        self.assertTrue(hits.hit)
        self.assertLess(abs(self.model.query(hits.point).distance), 0.05)

    def test_nan_is_outside(self):
        answer = self.model.query([np.nan, 0, 0])
        self.assertFalse(answer.inside)
        self.assertTrue(np.isnan(answer.distance))

    def test_no_points_give_no_answers(self):
        self.assertEqual(self.model.query(np.empty((0, 3))).normal.shape, (0, 3))

    def test_bytes_open_like_the_file(self):
        with open(PATH, "rb") as file:
            model = lumen_blob.Model(file.read())
        self.assertEqual(len(model), len(self.model))

    def test_what_is_no_case_is_an_error_that_says_so(self):
        with self.assertRaisesRegex(lumen_blob.Error, "bytes: ."):
            lumen_blob.Model(b"no case at all")
        with self.assertRaisesRegex(lumen_blob.Error, "absent.lumen: "):
            lumen_blob.Model("absent.lumen")

    def test_wrong_shapes_are_refused(self):
        for points in (np.zeros((2, 2)), np.zeros(4), np.zeros((1, 2, 3))):
            with self.assertRaises(ValueError):
                self.model.query(points)
        for cursors in (np.zeros(2, np.int64), np.zeros(3, np.uint32), [0, 0]):
            with self.assertRaises(ValueError):
                self.model.query(np.zeros((2, 3)), cursors)


if __name__ == "__main__":
    unittest.main()
