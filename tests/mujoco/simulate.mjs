// SPDX-License-Identifier: Apache-2.0
// Runs a scene in the official engine: node simulate.mjs SCENE.xml SECONDS SPEED ANSWER.json [PERIOD]
// PERIOD, s, 0 for none, is that of a wall that moves: keyframes after the first place its bodies, as the README of the folder has it.
// SPEED, m/s, is what its first actuator is asked for, from its keyframe on. Meshes are read from the folder that the
// scene names. The answer: what the engine says of names and counts, the greatest speed and number of contacts, and
// 100 records of time, insertion and points along the capsules, m. Exits with 1 where the engine refuses the scene.
import { writeFileSync } from 'node:fs';
import { open } from './engine.mjs';

const kRecords = 100;
const kCapsule = 3; // mjGEOM_CAPSULE

function pointsOf(model, data) {
  const centre = [...data.geom_xpos];
  const frame = [...data.geom_xmat];
  const points = [];
  for (let g = 0; g < model.ngeom; ++g) {
    if (model.geom_type[g] !== kCapsule) continue;
    const half = model.geom_size[3 * g + 1];
    for (const along of [-half, 0, half])
      points.push([0, 1, 2].map((a) => centre[3 * g + a] + along * frame[9 * g + 3 * a + 2]));
  }
  return points;
}

/** A function that places the bodies of the wall at a time. */
function player(model, data, period) {
  const n = model.nmocap;
  const times = [...model.key_time].slice(1);
  const places = [...model.key_mpos];
  const turns = [...model.key_mquat];
  return (seconds) => {
    const t = period > 0 ? times[0] + ((seconds - times[0]) % period) : seconds;
    const after = times.findIndex((time) => time > t);
    const b = after >= 0 ? after : period > 0 ? 0 : times.length - 1;
    const a = after >= 0 ? Math.max(after - 1, 0) : times.length - 1;
    const span = b > a ? times[b] - times[a] : (period || 1) + times[b] - times[a];
    const u = Math.min(Math.max((t - times[a]) / span, 0), 1);
    const at = (values, key, width) => values.slice((key + 1) * n * width, (key + 2) * n * width);
    const [p, q, r, s] = [at(places, a, 3), at(places, b, 3), at(turns, a, 4), at(turns, b, 4)];
    p.forEach((from, k) => (data.mocap_pos[k] = (1 - u) * from + u * q[k]));
    for (let body = 0; body < n; ++body) {
      const four = [0, 1, 2, 3].map((k) => 4 * body + k);
      const sign = four.reduce((sum, k) => sum + r[k] * s[k], 0) < 0 ? -1 : 1;
      const turn = four.map((k) => (1 - u) * r[k] + u * sign * s[k]);
      four.forEach((k, i) => (data.mocap_quat[k] = turn[i] / Math.hypot(...turn)));
    }
  };
}

function run(mujoco, model, seconds, speed, period) {
  const data = new mujoco.MjData(model);
  const play = model.nmocap > 0 ? player(model, data, period) : () => {};
  if (model.nkey > 0) mujoco.mj_resetDataKeyframe(model, data, 0);
  if (model.nu > 0) data.ctrl[0] = speed;
  const steps = Math.round(seconds / model.opt.timestep);
  const answer = { contacts: 0, speed: 0, restarts: 0, records: [] };
  for (let step = 1, before = 0; step <= steps; ++step, before = data.time) {
    play(data.time);
    mujoco.mj_step(model, data);
    if (!(data.time > before)) ++answer.restarts; // the engine starts again after numbers that are not finite
    answer.contacts = Math.max(answer.contacts, data.ncon);
    for (const v of data.qvel) answer.speed = Math.max(answer.speed, Math.abs(v));
    if (step % Math.max(1, Math.round(steps / kRecords)) === 0)
      answer.records.push({
        time: data.time,
        inserted: model.nq > 0 ? data.qpos[0] : 0,
        points: pointsOf(model, data),
      });
  }
  return { ...answer, steps, sites: [...data.site_xpos] };
}

const [scene, seconds, speed, output, period] = process.argv.slice(2);
if (output === undefined) {
  console.error('usage: node simulate.mjs SCENE.xml SECONDS SPEED ANSWER.json [PERIOD]');
  process.exit(2);
}
const { mujoco, model } = await open(scene);
const begin = Date.now();
const answer = run(mujoco, model, Number(seconds), Number(speed), Number(period ?? 0));
answer.stepsPerSecond = answer.steps / ((Date.now() - begin) / 1000);
answer.counts = { geoms: model.ngeom, bodies: model.nbody, sites: model.nsite, keys: model.nkey, moving: model.nmocap };
writeFileSync(output, JSON.stringify(answer));
