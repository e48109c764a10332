// SPDX-License-Identifier: Apache-2.0
/** Nodes as cylinders, each as long as its node is high: a mesh for each branch, of vertices that all share. None is an instance of
 * another: without a graphics processor each instance is a drawing of its own, and tens of thousands take seconds a picture. */
import { Box3, BufferAttribute, BufferGeometry, Mesh, Sphere, Vector3 } from "three";
import { PartMaterial } from "./part_material";
import type { Tree } from "../case/tree";
import { across, add, along, cross, distance, scale, unit } from "../base/vec";

export type Cylinders = Mesh<BufferGeometry, PartMaterial>;

const kSteps = 127; // of a normal's components

/** Open cylinders with that many sides, in the order of the branches. */
export function cylinders(tree: Tree, sides: number): Cylinders[] {
  const vertices = 2 * sides * tree.count,
    position = new BufferAttribute(new Float32Array(3 * vertices), 3),
    normal = new BufferAttribute(new Int8Array(4 * vertices), 4, true),
    index = new Uint32Array(6 * sides * tree.count);
  for (let node = 0, to = 0; node < tree.count; ++node)
    for (let s = 0, low = 2 * sides * node; s < sides; ++s) {
      const a = low + s,
        b = low + ((s + 1) % sides);
      for (const v of [a, b, a + sides, b, b + sides, a + sides]) index[to++] = v;
    }
  const meshes = tree.branches.map(({ index: branch, first_node: first, node_count: count }) => {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", position);
    geometry.setAttribute("normal", normal);
    geometry.setIndex(new BufferAttribute(index.subarray(6 * sides * first, 6 * sides * (first + count)), 1));
    geometry.boundingSphere = new Sphere(); // by which three.js orders meshes: it would make one from the vertices of all
    const mesh = new Mesh(geometry, new PartMaterial(false));
    mesh.frustumCulled = false;
    mesh.userData.branch = branch;
    return mesh;
  });
  placeCylinders(meshes, tree);
  return meshes;
}

/** Puts the cylinders of all branches where their nodes are. */
export function placeCylinders(meshes: readonly Cylinders[], tree: Tree): void {
  if (meshes.length === 0) return;
  const { position, normal } = meshes[0].geometry.attributes,
    p = position.array,
    n = normal.array,
    sides = position.count / (2 * tree.count);
  for (let node = 0, v = 0; node < tree.count; ++node) {
    const r = tree.radius[node],
      // without a length of its own a node reaches half-way to its neighbours
      length = Math.max(tree.height[node], 0.2 * r, spacing(tree, node)),
      axis = unit(tree.axis(node)),
      u = across(axis),
      w = cross(axis, u);
    for (const end of [-0.5, 0.5]) {
      const centre = along(tree.position(node), axis, end * length);
      for (let s = 0; s < sides; ++s, ++v) {
        const angle = (2 * Math.PI * s) / sides,
          out = add(scale(u, Math.cos(angle)), scale(w, Math.sin(angle)));
        for (let a = 0; a < 3; ++a) {
          p[3 * v + a] = centre[a] + r * out[a];
          n[4 * v + a] = Math.round(kSteps * out[a]);
        }
      }
    }
  }
  position.needsUpdate = normal.needsUpdate = true;
  for (const mesh of meshes) placeSphere(mesh.geometry.boundingSphere!, tree, mesh.userData.branch as number);
}

function placeSphere(sphere: Sphere, tree: Tree, branch: number): void {
  const { first_node: first, node_count: count } = tree.branches[branch],
    box = new Box3();
  for (let node = first; node < first + count; ++node) box.expandByPoint(new Vector3(...tree.position(node)));
  box.getBoundingSphere(sphere);
}

function spacing(tree: Tree, node: number): number {
  const p = tree.parent[node];
  if (p < 0 || tree.branch[p] !== tree.branch[node]) return 0;
  return distance(tree.position(node), tree.position(p));
}
