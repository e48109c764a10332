# SPDX-License-Identifier: Apache-2.0
"""Guidewires as environments of Gymnasium; tasks and their faults."""
import json
import os
import tempfile
import unittest
import warnings

import numpy as np

import lumen
from fixture import sample

try:
    import gymnasium
    import jsonschema  # noqa: F401  pylint: disable=unused-import
except ImportError:
    gymnasium = None
else:
    import lumen.gym


def task(**groups):
    device = {"nodes": 60, "spacing": 0.5, "radius": 0.15, "bending": 5, "tip_bending": 0.5}
    return {"format": "lumen-task", "version": 1, "cases": [sample().case], "device": device,
            "randomise": {"friction": [0, 0.2], "rotation": [0, 360], "pose_degrees": 20, "pose_mm": 5}, **groups}


@unittest.skipIf(gymnasium is None, "gymnasium (PyPI) or jsonschema (python3-jsonschema) is missing")
class GymTest(unittest.TestCase):
    def test_gymnasium_accepts_the_environment(self):
        from gymnasium.utils.env_checker import check_env
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # observations have no bounds
            check_env(gymnasium.make("lumen/Vessel-v0", task=task()).unwrapped, skip_render_check=True)

    def test_bits_depend_on_the_seed_alone(self):
        many = lumen.gym.VesselVectorEnv(task(), 5, threads=2)
        again = lumen.gym.VesselVectorEnv(task(), 5, threads=1)
        one = lumen.gym.VesselEnv(task())
        seen, other, alone = many.reset(seed=3)[0], again.reset(seed=3)[0], one.reset(seed=5)[0]
        actions = np.random.default_rng(0).uniform(-1, 1, (60, 5, 2)).astype(np.float32)
        for action in actions:
            self.assertTrue((seen == other).all() and (seen[2] == alone).all())
            self.assertTrue(many.observation_space.contains(seen))
            (seen, reward, *_), (other, *_), (alone, own, *_) = many.step(action), again.step(action), one.step(action[2])
            self.assertEqual(reward[2], own)

    def test_a_wire_that_is_pushed_comes_nearer_and_episodes_end(self):
        many = lumen.gym.VesselVectorEnv(task(limits={"steps": 30, "target_distance": 1}), 4)
        _, before = many.reset(seed=1)
        for _ in range(10):
            _, reward, _, _, after = many.step(np.tile(np.float32([1, 0]), (4, 1)))
        nearer = after["left_mm"] < before["left_mm"] - 5  # the others have taken the other branch
        self.assertTrue(nearer.any())
        self.assertTrue((reward[nearer] > 0).all() and (reward[~nearer] < 0).all())
        ended = np.zeros(4, bool)
        for _ in range(21):
            _, _, reached, over, _ = many.step(np.zeros((4, 2), np.float32))
            ended |= reached | over
        self.assertTrue(ended.all())
        self.assertTrue((many.fleet.steps <= 1).any())  # the next step began anew

    def test_nodes_stay_in_the_lumen(self):
        many = lumen.gym.VesselVectorEnv(task(), 8)
        many.reset(seed=2)
        random, wires = np.random.default_rng(1), many.fleet.wires
        for _ in range(150):
            many.step(random.uniform([-0.5, -1], 1, (8, 2)))
            for i in range(8):
                inside = wires.position[i, :wires.free[i]]
                self.assertTrue(lumen.blob.Model(sample().case).query(inside).inside.all())

    def test_a_file_is_read_and_its_faults_are_placed(self):
        with tempfile.TemporaryDirectory() as folder:
            sample().case.write(os.path.join(folder, "a.lumen"))
            path = os.path.join(folder, "a.task.json")

            def written(**groups):
                with open(path, "w", encoding="utf-8") as file:
                    json.dump({**task(), "cases": ["a.lumen"], **groups}, file)
                return path

            labels = [branch.label for branch in sample().case.branches]
            lumen.gym.VesselEnv(written(targets=[{"vessel": labels[-1]}])).reset(seed=0)
            for groups, words in (({"device": {"radius": -1}}, 'at "/device/radius": -1'), ({"speed": 1}, "speed"),
                                  ({"targets": [{"vessel": "nobody"}]}, "nobody"), ({"format": "x"}, 'at "/format"')):
                with self.assertRaisesRegex(lumen.ValueFault, words):
                    lumen.gym.VesselEnv(written(**groups))
            with self.assertRaisesRegex(lumen.Error, "without a way"):
                lumen.gym.VesselEnv(written(device={"radius": 50}))

    def test_columns_are_views(self):
        wires = lumen.gym.VesselVectorEnv(task(), 3).fleet.wires
        self.assertEqual(wires.position.shape, (3, 60, 3))
        self.assertEqual(wires.position.ctypes.data, wires.position.ctypes.data)
        self.assertFalse(wires.position.flags.writeable)
        self.assertTrue(wires.load.flags.writeable)
        with self.assertRaises(ValueError):
            wires.step(np.zeros(2), np.zeros(3))


if __name__ == "__main__":
    unittest.main()
