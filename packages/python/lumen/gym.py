# SPDX-License-Identifier: Apache-2.0
"""Guidewires in vessels as environments of Gymnasium (needs the packages gymnasium and jsonschema).

    environment = lumen.gym.VesselEnv("aorta.task.json")          # or gymnasium.make("lumen.gym:lumen/Vessel-v0", task=...)
    many = lumen.gym.VesselVectorEnv("aorta.task.json", 64)       # one call of libblob/wire steps all of them

An action is two numbers in [-1, 1]: push (negative: pull) and turn, in units of the task's longest step. An
observation is 22 float32: the tip, mm, in the frame of the case as the task's random pose shows it, from the entry;
nodes 2, 4, 8 and 16 behind it and the target, from the tip; the inserted share of the wire; cosine and sine of its
rotation; the push of the hand, N. docs/training.md states tasks, rewards and what the wire does.

Environment i of a vector that is reset with seed s is that of VesselEnv with seed s + i, to the bit, on any number
of threads.
"""
from __future__ import annotations

from typing import Any, Dict, List, Optional

import gymnasium
import numpy as np
from gymnasium.vector.utils import batch_space

from . import _lumen
from ._calls import called
from ._task import Vessels, read_task

__all__ = ["VesselEnv", "VesselVectorEnv"]

SHOWN = (2, 4, 8, 16)  # nodes in observations, besides the tip
ACTIONS = gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32)
OBSERVATIONS = gymnasium.spaces.Box(-np.inf, np.inf, (3 * (2 + len(SHOWN)) + 4,), np.float32)


def _turned(axis, angle) -> np.ndarray:
    """The rotation about a unit axis, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


class _Fleet:
    """A number of episodes, each with a wire, a target and a pose of its own."""

    def __init__(self, task, count: int, threads: int):
        self.task = read_task(task)
        self.vessels = [Vessels(case, self.task) for case in self.task["cases"]]
        device = self.task["device"]
        self.wires = called(_lumen.Wires, count, device["nodes"], threads)
        self.device = {name: value for name, value in device.items() if name != "nodes"}
        self.device["curve_angle"] = np.radians(device["curve_angle"])
        self.room = (device["nodes"] - 3) * device["spacing"]
        self.steps = np.zeros(count, int)
        self.before = np.zeros(count)
        self.case, self.way = np.zeros(count, int), np.zeros(count, int)
        self.target, self.entry, self.shift = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3))
        self.pose = np.tile(np.eye(3), (count, 1, 1))
        # the ways of all targets and the nodes of all cases, one after another
        ways = [(vessels, way) for vessels in self.vessels for way in vessels.ways]
        self._ways_before = np.cumsum([0] + [len(v.ways) for v in self.vessels])
        self._first = np.cumsum([0] + [len(way.left) for _, way in ways])[:-1]
        self._left = np.concatenate([way.left for _, way in ways])
        self._toward = np.concatenate([way.toward for _, way in ways])
        self._centre = np.concatenate([vessels.centre for vessels in self.vessels])
        self._nodes_before = np.cumsum([0] + [len(v.centre) for v in self.vessels])[:-1]

    def begin(self, i: int, random: np.random.Generator) -> None:
        """A new episode of wire i."""
        ranges = self.task["randomise"]
        case = int(random.integers(len(self.vessels)))
        vessels = self.vessels[case]
        way = int(random.integers(len(vessels.ways)))
        draws = random.random(3)
        low, high = np.array([ranges.get("friction", [self.device["friction"]] * 2), ranges.get("inserted", [5.0] * 2),
                              ranges.get("rotation", [0.0] * 2)], float).T
        friction, inserted, rotation = low + draws * (high - low)
        axis, shift = random.normal(size=3), random.normal(size=3)
        angle = np.radians(ranges.get("pose_degrees", 0.0)) * random.random()
        self.pose[i] = _turned(axis / np.linalg.norm(axis), angle)
        self.shift[i] = shift / np.linalg.norm(shift) * ranges.get("pose_mm", 0.0) * random.random()
        self.wires.set(i, vessels.model, {**self.device, "friction": float(friction)}, vessels.entry, vessels.direction,
                       float(inserted), float(np.radians(rotation)))
        self.case[i], self.way[i] = case, self._ways_before[case] + way
        self.target[i], self.entry[i], self.steps[i] = vessels.ways[way].target, vessels.entry, 0
        self.before[i] = self.left()[i]

    def left(self) -> np.ndarray:
        """The way that is left to each target, mm."""
        tip, node = self.wires.position[:, 0], self.wires.node[:, 0].astype(np.int64)
        at = self._first[self.way] + node
        from_node = tip - self._centre[self._nodes_before[self.case] + node]
        return np.abs(self._left[at] - np.einsum("ij,ij->i", from_node, self._toward[at]))

    def observe(self) -> np.ndarray:
        position = self.wires.position
        tip = position[:, 0]
        rows = np.concatenate([(tip - self.entry)[:, None], position[:, SHOWN] - tip[:, None], (self.target - tip)[:, None]], axis=1)
        rows = np.einsum("iab,ijb->ija", self.pose, rows)
        rows[:, 0] += self.shift
        rotation = self.wires.rotation
        others = np.stack([self.wires.inserted / self.room, np.cos(rotation), np.sin(rotation), self.wires.force], axis=1)
        return np.concatenate([rows.reshape(len(tip), -1), others], axis=1).astype(np.float32)

    def step(self, actions: np.ndarray, still: Optional[np.ndarray] = None):
        """Steps all wires, those of `still` not at all. Reward, reached and out of steps."""
        moves = np.clip(np.asarray(actions, float), -1.0, 1.0)
        if still is not None:
            moves[still] = 0.0
        self.wires.step(moves[:, 0] * self.task["action"]["push"], moves[:, 1] * np.radians(self.task["action"]["turn"]))
        self.steps += 1
        left = self.left()
        reached = left <= self.task["limits"]["target_distance"]
        weights = self.task["reward"]
        reward = (weights["progress"] * (self.before - left) + weights["step"] + weights["reached"] * reached
                  + weights["force"] * np.abs(self.wires.force))
        self.before = left
        return reward, reached, ~reached & (self.steps >= self.task["limits"]["steps"])


class VesselEnv(gymnasium.Env):
    """One guidewire.

    Parameters
    ----------
    task : path or dict
        A task by spec/schema/task.schema.json. In a dictionary, cases may be lumen.Case.
    """

    metadata: Dict[str, Any] = {"render_modes": []}
    action_space = ACTIONS
    observation_space = OBSERVATIONS

    def __init__(self, task, render_mode: Optional[str] = None):
        self.render_mode = render_mode
        self.fleet = _Fleet(task, 1, 1)

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None):
        super().reset(seed=seed)
        self.fleet.begin(0, self.np_random)
        return self.fleet.observe()[0], self._facts(False)

    def step(self, action):
        reward, reached, ended = self.fleet.step(np.asarray(action)[None])
        return self.fleet.observe()[0], float(reward[0]), bool(reached[0]), bool(ended[0]), self._facts(bool(reached[0]))

    def _facts(self, reached: bool) -> Dict[str, Any]:
        return {"left_mm": float(self.fleet.before[0]), "is_success": reached}


class VesselVectorEnv(gymnasium.vector.VectorEnv):
    """Many guidewires, stepped by one call. An environment that has ended begins anew in the next step, whose action
    it ignores (gymnasium.vector.AutoresetMode.NEXT_STEP).

    Parameters
    ----------
    task : path or dict
        As of VesselEnv.
    num_envs : int
    threads : int
        0: as many as there are processors.
    """

    metadata: Dict[str, Any] = {"render_modes": [], "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}
    single_action_space = ACTIONS
    single_observation_space = OBSERVATIONS

    def __init__(self, task, num_envs: int = 1, threads: int = 0, render_mode: Optional[str] = None):
        self.num_envs, self.render_mode = num_envs, render_mode
        self.action_space, self.observation_space = batch_space(ACTIONS, num_envs), batch_space(OBSERVATIONS, num_envs)
        self.fleet = _Fleet(task, num_envs, threads)
        self._random: List[np.random.Generator] = []
        self._over = np.zeros(num_envs, bool)

    def reset(self, *, seed=None, options: Optional[Dict[str, Any]] = None):
        if seed is not None or not self._random:
            first = seed if seed is not None else np.random.SeedSequence().entropy % 2**31
            seeds = first if isinstance(first, (list, tuple)) else [first + i for i in range(self.num_envs)]
            self._random = [gymnasium.utils.seeding.np_random(one)[0] for one in seeds]
        for i, random in enumerate(self._random):
            self.fleet.begin(i, random)
        self._over[:] = False
        return self.fleet.observe(), {"left_mm": self.fleet.before.copy()}

    def step(self, actions):
        over = self._over
        reward, reached, ended = self.fleet.step(actions, over)
        for i in np.flatnonzero(over):
            self.fleet.begin(int(i), self._random[i])
            reward[i], reached[i], ended[i] = 0.0, False, False
        self._over = reached | ended
        facts = {"left_mm": self.fleet.before.copy(), "is_success": reached.copy()}
        return self.fleet.observe(), reward, reached, ended, facts


gymnasium.register("lumen/Vessel-v0", entry_point="lumen.gym:VesselEnv", vector_entry_point="lumen.gym:VesselVectorEnv")
