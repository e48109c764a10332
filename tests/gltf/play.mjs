// SPDX-License-Identifier: Apache-2.0
// Vertices of a skinned GLB as three.js moves them: node play.mjs FILE NODE_MODULES TIME...
// Prints one JSON object: `duration` of the animation in s, and `frames`, for each time an array of positions
// [x, y, z] in three's world (metres, y up), mesh after mesh. Exits 1 if a mesh has no skin, or the file no animation.
import { readFile } from 'node:fs/promises';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [file, modules, ...times] = process.argv.slice(2);
const three = (path) => import(pathToFileURL(resolve(modules, 'three', path)).href);
globalThis.self ??= globalThis;
const { AnimationMixer, LoopOnce, Vector3 } = await three('build/three.module.js');
const { GLTFLoader } = await three('examples/jsm/loaders/GLTFLoader.js');
const { MeshoptDecoder } = await three('examples/jsm/libs/meshopt_decoder.module.js');

const loader = new GLTFLoader();
loader.setMeshoptDecoder(MeshoptDecoder);
const bytes = await readFile(file);
const data = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const gltf = await loader.parseAsync(data, '');

const meshes = [];
gltf.scene.traverse((object) => {
  if (object.isMesh) meshes.push(object);
});
if (meshes.length === 0 || !meshes.every((mesh) => mesh.isSkinnedMesh) || gltf.animations.length !== 1) {
  console.error(`${file}: found ${meshes.length} meshes and ${gltf.animations.length} animations`);
  process.exit(1);
}

const mixer = new AnimationMixer(gltf.scene);
const action = mixer.clipAction(gltf.animations[0]).setLoop(LoopOnce, 1);
action.clampWhenFinished = true;
action.play();

function positionsAt(time) {
  mixer.setTime(time);
  gltf.scene.updateMatrixWorld(true);
  const positions = [];
  for (const mesh of meshes) {
    mesh.skeleton.update();
    const stored = mesh.geometry.attributes.position;
    for (let i = 0; i < stored.count; ++i) {
      const p = new Vector3().fromBufferAttribute(stored, i);
      mesh.applyBoneTransform(i, p).applyMatrix4(mesh.matrixWorld);
      positions.push(p.toArray());
    }
  }
  return positions;
}

console.log(JSON.stringify({ duration: gltf.animations[0].duration, frames: times.map(Number).map(positionsAt) }));
