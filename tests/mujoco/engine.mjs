// SPDX-License-Identifier: Apache-2.0
// Opens a scene in the official engine, with the meshes of its folder.
import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join } from 'node:path';
import load from '@mujoco/mujoco';

function filesBelow(folder, below = '') {
  return readdirSync(join(folder, below), { withFileTypes: true }).flatMap((entry) => {
    const name = below === '' ? entry.name : `${below}/${entry.name}`;
    return entry.isDirectory() ? filesBelow(folder, name) : [name];
  });
}

/** The engine and the model; exits with 1, saying why, where the engine refuses the scene. */
export async function open(scene) {
  const mujoco = await load();
  const files = new mujoco.MjVFS();
  for (const name of filesBelow(dirname(scene)))
    if (/\.(stl|obj)$/.test(name)) files.addBuffer(name, readFileSync(join(dirname(scene), name)));
  try {
    return { mujoco, model: mujoco.MjModel.from_xml_string(readFileSync(scene, 'utf8'), files) };
  } catch (error) {
    console.error(String(error).split('\n').slice(0, 3).join(' '));
    process.exit(1);
  }
}
