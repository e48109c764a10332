# SPDX-License-Identifier: Apache-2.0
"""lumen.warp, by Warp where that is installed, else by the stand-in: answers beside libblob's."""
import sys
import unittest

import numpy as np

try:
    import warp as wp
except ImportError:
    import warp_stand_in as wp
    sys.modules["warp"] = wp

import lumen
import lumen.warp
from fixture import sample
from lumen import blob

POINTS = 300


def touching():
    """Two vessels that touch, as a Gaussian model, which has code of its own."""
    phantom = lumen.phantom("kissing")
    return lumen.convert(phantom.volume, seeds=phantom.seeds, seeds_only=True, kernel="gaussian")


class WarpTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cases = [sample().case, touching()]
        cls.models = [blob.Model(case) for case in cls.cases]
        cls.vessels = lumen.warp.Vessels(cls.models)

    def points(self, vessel):
        """float32 points about nodes, and their nodes."""
        random = np.random.default_rng(3)
        tree = self.cases[vessel].tree
        node = random.integers(len(tree), size=POINTS)
        away = random.uniform(-1.5, 1.5, (POINTS, 3))
        return (tree.centre[node] + tree.radius[node, None] * away).astype(np.float32), tree.radius[node]

    def test_answers_are_those_of_libblob(self):
        for vessel, model in enumerate(self.models):
            for flags in (blob.BLENDED, blob.LOCAL):
                points, _ = self.points(vessel)
                cursor = model.cursor(points)
                found = self.vessels.query(points, wp.array(cursor.node, dtype=wp.uint32), flags, vessel)
                wanted = model.query(points, cursor, flags)
                np.testing.assert_array_equal(found.cursor.numpy(), wanted.node)
                np.testing.assert_array_equal(found.state.numpy() == 1, wanted.inside)
                self.assertGreater(wanted.inside.sum(), POINTS // 5)
                radius = self.cases[vessel].tree.radius[wanted.node]
                scale = np.maximum(radius, wanted.distance)
                self.assertLess(np.max(np.abs(found.distance.numpy() - wanted.distance) / scale), 1e-5)
                np.testing.assert_allclose(found.value.numpy(), wanted.value, rtol=1e-5, atol=1e-6)
                steep = np.linalg.norm(wanted.gradient, axis=1) > 0.1
                np.testing.assert_allclose(found.normal.numpy()[steep], wanted.normal[steep], atol=1e-4)
                np.testing.assert_allclose(found.gradient.numpy(), wanted.gradient, rtol=1e-4, atol=1e-5)

    def test_exact_distances_are_those_of_libblob(self):
        for vessel, model in enumerate(self.models):
            points = self.points(vessel)[0][:60]
            cursor = model.cursor(points)
            found = self.vessels.query(points, wp.array(cursor.node, dtype=wp.uint32), blob.DISTANCE_EXACT, vessel)
            wanted = model.query(points, cursor, blob.DISTANCE_EXACT)
            np.testing.assert_array_equal(found.cursor.numpy(), wanted.node)
            np.testing.assert_array_equal(found.state.numpy() & 1 == 1, wanted.inside)
            radius = self.cases[vessel].tree.radius[wanted.node]
            near = np.abs(found.distance.numpy() - wanted.distance) <= 1e-5 * np.maximum(radius, wanted.distance)
            self.assertLessEqual(np.sum(~near), 1)  # where another place of the wall is nearest about it
            np.testing.assert_allclose(found.value.numpy(), wanted.value, rtol=1e-5, atol=1e-6)

    def test_unknown_cursors_are_located_and_kept(self):
        points, _ = self.points(0)
        points = points[:5]
        answer = self.vessels.query(points)
        np.testing.assert_array_equal(answer.cursor.numpy(), self.models[0].query(points).node)
        before = answer.distance.numpy().copy()
        again = self.vessels.query(points + np.float32(0.01), answer.cursor, out=answer)
        self.assertIs(again.distance, answer.distance)
        self.assertTrue(np.all(again.distance.numpy() != before))

    def test_a_buffer_is_checked(self):
        words = blob.pack(self.models)
        self.assertEqual(lumen.warp.Vessels(words).count, 2)
        words[3] = 3
        with self.assertRaisesRegex(lumen.Error, "packed models"):
            lumen.warp.Vessels(words)
        with self.assertRaises(ValueError):
            blob.pack([])

    def test_wrong_arguments_are_refused(self):
        points, _ = self.points(0)
        with self.assertRaisesRegex(IndexError, "vessel: found 2"):
            self.vessels.query(points, vessel=2)
        with self.assertRaisesRegex(ValueError, "cursor: found 4 elements"):
            self.vessels.query(points, self.vessels.answer(4).cursor)


if __name__ == "__main__":
    unittest.main()
