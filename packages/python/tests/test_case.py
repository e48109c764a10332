# SPDX-License-Identifier: Apache-2.0
"""Cases in memory: views, files, corrections, errors."""
import gc
import json
import os
import pickle
import tempfile
import threading
import time
import unittest

import numpy as np

import lumen
from fixture import sample


class ViewsTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case

    def test_arrays_have_the_shapes_and_types_that_are_stated(self):
        tree, points, models = self.case.tree, self.case.points, self.case.models
        n = len(tree)
        self.assertGreater(n, 20)
        for array, shape, kind in ((tree.centre, (n, 3), "f4"), (tree.direction, (n, 3), "f4"),
                                   (tree.radius, (n,), "f4"), (tree.height, (n,), "f4"),
                                   (tree.parent, (n,), "i4"), (tree.branch, (n,), "u4"),
                                   (tree.links, (0, 2), "u4"), (points.offset, (n + 1,), "u4"),
                                   (points.position, (points.offset[-1], 3), "f4"),
                                   (models.offset, (n + 1,), "u4"),
                                   (models.centre, (models.offset[-1], 3), "f4"),
                                   (models.width, (models.offset[-1],), "f4")):
            self.assertEqual((array.shape, array.dtype), (shape, np.dtype(kind)))
            self.assertTrue(array.flags.c_contiguous)

    def test_two_views_are_one_memory(self):
        self.assertTrue(np.shares_memory(self.case.tree.radius, self.case.tree.radius))
        copy = self.case.copy()
        self.assertFalse(np.shares_memory(copy.tree.radius, self.case.tree.radius))

    def test_a_view_keeps_the_case_alive(self):
        case = self.case.copy()
        radius, expected = case.tree.radius, self.case.tree.radius.copy()
        del case
        gc.collect()
        filler = [np.zeros(len(expected), np.float32) for _ in range(100)]
        np.testing.assert_array_equal(radius, expected)
        self.assertEqual(len(filler), 100)

    def test_views_of_a_constant_case_cannot_be_written_to(self):
        self.assertFalse(self.case.writable)
        with self.assertRaises(ValueError):
            self.case.tree.radius[0] = 1
        with self.assertRaises(ValueError):
            self.case.tree.radius.setflags(write=True)

    def test_views_of_a_copy_write_into_the_case(self):
        copy = self.case.copy()
        copy.tree.radius[3] *= np.float32(1.5)
        self.assertEqual(copy.tree.radius[3], self.case.tree.radius[3] * np.float32(1.5))
        self.assertNotEqual(copy, self.case)
        self.assertEqual(lumen.Case.from_bytes(copy.to_bytes()).tree.radius[3], copy.tree.radius[3])

    def test_branches_are_ranges_of_nodes(self):
        for number, branch in enumerate(self.case.branches):
            self.assertTrue((self.case.tree.branch[branch.nodes] == number).all())
            self.assertEqual(self.case.branch(branch.label), number)
        with self.assertRaisesRegex(KeyError, "expected one of"):
            self.case.branch("nobody")

    def test_branches_have_the_system_of_their_nodes(self):
        self.assertEqual({branch.system for branch in self.case.branches}, {"unknown"})
        document = json.loads(self.case.to_bytes(json=True))
        document["metadata"]["extensionsUsed"] = ["LUMEN_vessel"]
        document["metadata"]["nodeArrays"] = [{"name": "LUMEN_vessel.system", "type": "u32", "components": 1}]
        document["nodeArrays"] = {"LUMEN_vessel.system": len(self.case.tree) * [2]}
        stated = lumen.Case.from_bytes(json.dumps(document).encode())
        self.assertEqual({branch.system for branch in stated.branches}, {"vein"})

    def test_metadata_state_the_steps(self):
        names = [step["name"] for step in self.case.metadata["steps"]]
        self.assertEqual(names[-1], "fit")


class LargeCaseTest(unittest.TestCase):
    @staticmethod
    def large_case():
        nodes = 200_000
        branch = {"label": "a", "kind": "vessel", "parentNode": -1, "firstNode": 0, "nodeCount": nodes, "stopReason": "unknown"}
        text = json.dumps({
            "format": "lumen", "version": "1.1", "minimumReader": "1.0",
            "metadata": {"coordinateSystem": "LPS", "units": "mm", "steps": []},
            "tree": {"branches": [branch], "centre": [[0, 0, 0.1 * i] for i in range(nodes)], "direction": nodes * [[0, 0, 1]],
                     "radius": nodes * [1], "height": nodes * [0.5], "parent": list(range(-1, nodes - 1)), "branch": nodes * [0]}})
        return lumen.Case.from_bytes(text.encode())

    @staticmethod
    def longest_pause(work):
        """The longest time in which another thread stood still, as a share of the time of `work`."""
        ticks, is_done = [time.perf_counter()], threading.Event()

        def tick():
            while not is_done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.0005)

        thread = threading.Thread(target=tick)
        thread.start()
        began = time.perf_counter()
        work()
        seconds = time.perf_counter() - began
        is_done.set()
        thread.join()
        return np.diff([*ticks, time.perf_counter()]).max() / seconds

    def test_others_run_while_a_case_is_encoded_as_json(self):
        case = self.large_case()
        # a busy machine may hold the thread up as well, but not each time
        self.assertLess(min(self.longest_pause(lambda: case.to_bytes(json=True)) for _ in range(5)), 0.5)


class MotionTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case
        self.nodes = [2, 5]
        self.centre = np.stack([self.case.tree.centre[self.nodes]] * 3)
        self.centre[1:, :, 1] += 0.5
        self.rotation = np.tile(np.float32([0, 0, 0.6, 0.8]), (3, 2, 1))

    def moving(self, **more):
        return self.case.with_motion([0, 0.25, 0.5], self.nodes, self.centre, self.rotation, **more)

    def test_a_motion_is_given_back_by_the_file(self):
        case = lumen.Case.from_bytes(self.moving(period=0.8).to_bytes())
        motion = case.motion
        self.assertIsNone(self.case.motion)
        self.assertEqual((len(motion), motion.period), (3, 0.8))
        np.testing.assert_array_equal(motion.node, self.nodes)
        np.testing.assert_array_equal(motion.centre, self.centre)
        np.testing.assert_array_equal(motion.rotation, self.rotation)
        np.testing.assert_array_equal(motion.factor, np.ones((3, 2)))
        self.assertEqual(case.without_motion(), self.case)

    def test_views_of_poses_write_into_a_copy(self):
        copy = self.moving().copy()
        copy.motion.factor[2, 1] = 1.5
        self.assertEqual(lumen.Case.from_bytes(copy.to_bytes()).motion.factor[2, 1], 1.5)
        with self.assertRaises(ValueError):
            self.moving().motion.centre[0, 0, 0] = 1

    def test_a_motion_that_breaks_a_rule_is_refused_with_its_place(self):
        with self.assertRaisesRegex(lumen.Error, "MOTION_PERIOD at /motion/period"):
            self.moving(period=0.5)
        with self.assertRaises(ValueError):
            self.case.with_motion([], self.nodes, self.centre, self.rotation)


class FilesTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_a_case_is_read_as_it_was_written(self):
        for name in ("a.lumen", "a.lumen.json"):
            self.case.write(self.path(name))
            self.assertEqual(lumen.read(self.path(name)), self.case)
        self.case.write(self.path("c.lumen"), compress=True)
        self.assertLess(os.path.getsize(self.path("c.lumen")), os.path.getsize(self.path("a.lumen")))
        self.assertEqual(pickle.loads(pickle.dumps(self.case)), self.case)

    def test_a_broken_rule_has_its_place_and_leaves_the_file_as_it_was(self):
        self.case.write(self.path("a.lumen"))
        copy = self.case.copy()
        copy.tree.radius[2] = -1
        with self.assertRaises(lumen.Error) as raised:
            copy.write(self.path("a.lumen"))
        error = raised.exception
        self.assertEqual((error.code, error.number, error.place, error.exit_code, error.kind),
                         ("RADIUS_RANGE", 406, "/tree/radius/2", 3, "invalid input"))
        self.assertEqual(error.found, "-1")
        self.assertIn("0", error.expected)
        self.assertEqual(lumen.read(self.path("a.lumen")), self.case)
        self.assertEqual(os.listdir(self.folder), ["a.lumen"])
        report = lumen.validate(copy)
        self.assertEqual((report["valid"], report.code), (False, 3))
        self.assertEqual(report["issues"][0]["pointer"], "/tree/radius/2")

    def test_a_damaged_file_is_refused_with_file_and_place(self):
        data = bytearray(self.case.to_bytes())
        data[len(data) // 2] ^= 1
        with open(self.path("bad.lumen"), "wb") as file:
            file.write(data)
        with self.assertRaises(lumen.Error) as raised:
            lumen.read(self.path("bad.lumen"))
        self.assertEqual(raised.exception.file, self.path("bad.lumen"))
        self.assertEqual(raised.exception.code, "CHUNK_CHECKSUM")
        self.assertRegex(raised.exception.place, "^byte [0-9]+")
        with self.assertRaisesRegex(lumen.Error, "absent.lumen"):
            lumen.read(self.path("absent.lumen"))
        with self.assertRaises(ValueError):
            self.case.write(self.path("case.glb"))

    def test_errors_survive_a_pickle(self):
        error = lumen.Error("a: found 1, expected 2", 3, file="a", place="byte 4")
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.__dict__), (str(error), error.__dict__))
        self.assertEqual((again.found, again.expected), ("1", "2"))

    def test_validation_lists_warnings_of_a_file(self):
        self.case.write(self.path("a.lumen"))
        report = lumen.validate(self.path("a.lumen"))
        self.assertTrue(report["valid"])
        self.assertEqual(report["file"], self.path("a.lumen"))
        self.assertEqual(report["errors"], 0)
        json.dumps(report)


class EditsTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case
        self.last = self.case.branches[-1]

    def test_a_new_name_changes_a_new_case_alone(self):
        new = self.case.edit.rename(self.last.label, "MCA")
        self.assertEqual(new.branches[-1].label, "MCA")
        self.assertEqual(self.case.branches[-1].label, self.last.label)
        self.assertIn("MCA", new.change.sentence)
        self.assertEqual(len(new.change.stale), 0)
        self.assertEqual(new.metadata["steps"][-1]["name"], "edit")

    def test_widening_fits_the_models_near_the_node_alone(self):
        node = self.last.first_node + self.last.node_count // 2
        radius = float(self.case.tree.radius[node])
        new = self.case.edit.widen(node, 1.3 * radius, 2.0)
        self.assertAlmostEqual(float(new.tree.radius[node]), 1.3 * radius, places=4)
        self.assertIn(node, new.change.stale)
        self.assertLess(len(new.change.stale), len(new.tree))
        model = lumen.blob.Model
        was, now = (model(case).query(self.case.tree.centre[node]).distance
                    for case in (self.case, new))
        self.assertAlmostEqual((now - was) / radius, -0.3, delta=0.1)
        later = self.case.edit.widen(node, 1.3 * radius, 2.0, refit=False)
        self.assertEqual(later.edit.refit(later.change.stale), new)

    def test_all_corrections_give_valid_cases(self):
        node, edit = self.last.first_node + self.last.node_count // 2, self.case.edit
        centre = self.case.tree.centre[node]
        radius = float(self.case.tree.radius[node])
        cut = edit.cut(node, label="rest")
        wall = self.case.points.of(node)[0]
        results = [
            edit.delete(self.last.label), edit.delete(0, children=False), cut,
            edit.cut(node, keep_joined=True), cut.edit.join("rest", node - 1),
            edit.cut(node, keep_joined=True, label="rest").edit.merge("rest"),
            edit.reverse(self.last.label), edit.root(self.last.label),
            edit.kind(self.last.label, "aneurysm"), edit.move(node, centre, radius),
            edit.push(node, wall, (wall - centre) * 0.2, radius), edit.add_node(node),
            edit.delete_node(node)]
        for new in results:
            self.assertTrue(lumen.validate(new)["valid"], new.change.sentence)
            self.assertNotEqual(new, self.case)
        self.assertEqual(len(results[11].tree), len(self.case.tree) + 1)
        self.assertEqual(len(results[12].tree), len(self.case.tree) - 1)

    def test_what_a_correction_does_not_allow_is_an_error(self):
        with self.assertRaises(lumen.Error):
            self.case.edit.rename(0, self.last.label)
        with self.assertRaises(IndexError):
            self.case.edit.add_node(len(self.case.tree))
        with self.assertRaisesRegex(lumen.Error, "expected vessel or aneurysm"):
            self.case.edit.kind(0, "vein")


if __name__ == "__main__":
    unittest.main()
