// SPDX-License-Identifier: Apache-2.0
// Contents of a scene in the engine: node read_scene.mjs SCENE.xml prints vertices of its mesh geoms and places of its
// sites, by name, in the world, m. The engine moves and turns each mesh to its inertia, and its geom back.
import { open } from './engine.mjs';

const { mujoco, model } = await open(process.argv[2]);
const data = new mujoco.MjData(model);
mujoco.mj_forward(model, data);

const bytes = [...model.names];
const nameAt = (at) => {
  const name = bytes.slice(at, bytes.indexOf(0, at));
  return typeof name[0] === 'string' ? name.join('') : String.fromCharCode(...name);
};
const row = (array, k, n) => Array.from(array.slice(k * n, (k + 1) * n));

const meshes = {};
const vertices = model.mesh_vert;
for (let g = 0; g < model.ngeom; ++g) {
  const mesh = model.geom_dataid[g];
  if (mesh < 0) continue;
  const place = row(data.geom_xpos, g, 3);
  const frame = row(data.geom_xmat, g, 9);
  const name = nameAt(model.name_geomadr[g]);
  if (name.startsWith('hull_')) continue;
  meshes[name] = [];
  for (let v = 0; v < model.mesh_vertnum[mesh]; ++v) {
    const p = row(vertices, model.mesh_vertadr[mesh] + v, 3);
    meshes[name].push([0, 1, 2].map((a) => place[a] + frame[3 * a] * p[0] + frame[3 * a + 1] * p[1] + frame[3 * a + 2] * p[2]));
  }
}
const sites = {};
for (let s = 0; s < model.nsite; ++s) sites[nameAt(model.name_siteadr[s])] = row(data.site_xpos, s, 3);
process.stdout.write(JSON.stringify({ meshes, sites }));
