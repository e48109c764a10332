// SPDX-License-Identifier: Apache-2.0
// Runs a scene in the official engine: node simulate.mjs SCENE.xml SECONDS SPEED ANSWER.json
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

function run(mujoco, model, seconds, speed) {
  const data = new mujoco.MjData(model);
  if (model.nkey > 0) mujoco.mj_resetDataKeyframe(model, data, 0);
  if (model.nu > 0) data.ctrl[0] = speed;
  const steps = Math.round(seconds / model.opt.timestep);
  const answer = { contacts: 0, speed: 0, restarts: 0, records: [] };
  for (let step = 1, before = 0; step <= steps; ++step, before = data.time) {
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

const [scene, seconds, speed, output] = process.argv.slice(2);
if (output === undefined) {
  console.error('usage: node simulate.mjs SCENE.xml SECONDS SPEED ANSWER.json');
  process.exit(2);
}
const { mujoco, model } = await open(scene);
const begin = Date.now();
const answer = run(mujoco, model, Number(seconds), Number(speed));
answer.stepsPerSecond = answer.steps / ((Date.now() - begin) / 1000);
answer.counts = { geoms: model.ngeom, bodies: model.nbody, sites: model.nsite, keys: model.nkey };
writeFileSync(output, JSON.stringify(answer));
