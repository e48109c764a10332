// SPDX-License-Identifier: Apache-2.0
// Result of three.js's USD loader for a stage, as JSON: node load_usda.mjs FILE NODE_MODULES
// Positions of `wall` and `ends` are in three's world: metres, y up; those of `centerline`, which three does not draw, and
// schemas are as its parser has them.
import { readFile } from 'node:fs/promises';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [file, modules] = process.argv.slice(2);
const three = (path) => import(pathToFileURL(resolve(modules, 'three', path)).href);
const { Vector3 } = await three('build/three.module.js');
const { USDLoader } = await three('examples/jsm/loaders/USDLoader.js');
const { USDAParser } = await three('examples/jsm/loaders/usd/USDAParser.js');

const text = await readFile(file, 'utf8');
const group = new USDLoader().parse(text);
group.updateMatrixWorld(true);

const answer = { wall: [], ends: {} };
group.traverse((object) => {
  if (object.isMesh) {
    const position = object.geometry.getAttribute('position');
    for (let i = 0; i < position.count; ++i)
      answer.wall.push(...new Vector3().fromBufferAttribute(position, i).applyMatrix4(object.matrixWorld));
  }
  if (object.parent?.name === 'ends')
    answer.ends[object.name] = [...new Vector3().setFromMatrixPosition(object.matrixWorld)];
});

const specs = new USDAParser().parseData(text).specsByPath;
const valueOf = (path) => specs[path].fields.default;
const list = (value) => (typeof value === 'string' ? value.match(/[-+\w.]+/g) : [...value].flat());
const head = specs['/'].fields;
answer.metersPerUnit = head.metersPerUnit;
answer.upAxis = head.upAxis;
answer.apiSchemas = text.match(/apiSchemas = \[([^\]]*)\]/)[1].match(/\w+/g);
answer.approximation = valueOf('/vessel/wall.physics:approximation');
answer.centerline = {
  points: list(valueOf('/vessel/centerline.points')).map(Number),
  counts: list(valueOf('/vessel/centerline.curveVertexCounts')).map(Number),
  widths: list(valueOf('/vessel/centerline.widths')).map(Number),
};
console.log(JSON.stringify(answer));
