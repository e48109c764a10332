// SPDX-License-Identifier: Apache-2.0
/** The model of one node alone, as a coarse surface: marching tetrahedra over the distance that libblob answers with its
 * cursor held at the node. */
import { BufferAttribute, BufferGeometry, Mesh } from "three";
import { Flags, type Model } from "../../../../libblob/wasm/blob.mjs";
import { kTetrahedra } from "../case/field_surface";
import type { Part } from "../model/model";
import { PartMaterial } from "./part_material";
import type { SceneView } from "./scene_view";
import type { Tree } from "../case/tree";

const kCells = 22; // along an edge of the box
const kBoxRadii = 2.2; // radii from the centre to the box's sides: a local field may go on beyond; it is cut there

/** Triangles (x y z of three corners each) of the zero level of values on a grid of n^3 points over a box. */
export function marchTetrahedra(value: ArrayLike<number>, n: number, low: number[], step: number): number[] {
  const out: number[] = [],
    corner = (i: number, j: number, k: number, c: number): number[] => [
      i + (c & 1),
      j + ((c >> 1) & 1),
      k + (c >> 2),
    ];
  for (let k = 0; k + 1 < n; ++k)
    for (let j = 0; j + 1 < n; ++j)
      for (let i = 0; i + 1 < n; ++i)
        for (const tetrahedron of kTetrahedra) {
          const points = tetrahedron.map(c => corner(i, j, k, c)),
            f = points.map(p => value[p[0] + n * (p[1] + n * p[2])]);
          const inside = [0, 1, 2, 3].filter(c => f[c] < 0),
            outside = [0, 1, 2, 3].filter(c => !(f[c] < 0));
          if (inside.length === 0 || outside.length === 0) continue;
          const cut = (a: number, b: number): number[] =>
            [0, 1, 2].map(
              d => low[d] + step * (points[a][d] + (f[a] / (f[a] - f[b])) * (points[b][d] - points[a][d])),
            );
          if (inside.length === 1) out.push(...outside.flatMap(b => cut(inside[0], b)));
          else if (outside.length === 1) out.push(...inside.flatMap(a => cut(a, outside[0])));
          else {
            const [a, b] = inside,
              [c, d] = outside;
            out.push(...cut(a, c), ...cut(a, d), ...cut(b, d), ...cut(a, c), ...cut(b, d), ...cut(b, c));
          }
        }
  return out;
}

function localSurface(
  model: Model,
  tree: Tree,
  node: number,
): { position: Float32Array; normal: Float32Array } {
  const n = kCells + 1,
    half = kBoxRadii * tree.radius[node],
    step = (2 * half) / kCells,
    centre = tree.position(node),
    low = centre.map(x => x - half);
  const answer = (points: ArrayLike<number>): { distance: Float64Array; normal: Float32Array } => {
    const count = points.length / 3,
      batch = model.batch(count),
      normal = new Float32Array(3 * count);
    batch.points.set(points);
    batch.cursors.fill(node);
    batch.query(Flags.LOCAL | Flags.HOLD);
    for (let i = 0; i < count; ++i) normal.set(batch.sample(i).normal, 3 * i);
    const distance = batch.distances();
    batch.free();
    return { distance, normal };
  };
  const grid = new Float64Array(3 * n ** 3);
  for (let k = 0, at = 0; k < n; ++k)
    for (let j = 0; j < n; ++j)
      for (let i = 0; i < n; ++i, at += 3)
        grid.set([low[0] + i * step, low[1] + j * step, low[2] + k * step], at);
  const position = new Float32Array(marchTetrahedra(answer(grid).distance, n, low, step));
  return { position, normal: position.length === 0 ? new Float32Array(0) : answer(position).normal };
}

/** Shows the local model of the cursor's node while its layer is on. */
export class LocalModel {
  private mesh: Mesh<BufferGeometry, PartMaterial> | null = null;

  constructor(app: Part<"document" | "selection" | "motion" | "scene", "stage">, scene: SceneView) {
    app.store.watch(
      ["scene.layers", "selection.node", "document.blob", "document.tree", "motion.time"],
      view => {
        if (this.mesh !== null) {
          scene.extra.remove(this.mesh);
          this.mesh.geometry.dispose();
          this.mesh.material.dispose();
          this.mesh = null;
          app.stage.invalidate(scene);
        }
        if (
          !view.scene.layers.local ||
          view.motion.time !== null ||
          view.document.blob === null ||
          view.document.tree === null ||
          view.selection.node < 0
        )
          return;
        const { position, normal } = localSurface(
            view.document.blob,
            view.document.tree,
            view.selection.node,
          ),
          geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(position, 3));
        geometry.setAttribute("normal", new BufferAttribute(normal, 3));
        this.mesh = new Mesh(geometry, new PartMaterial(false));
        this.mesh.material.look({ own: [1, 0.86, 0.35], alpha: 0.8 });
        this.mesh.material.lit = true;
        this.mesh.renderOrder = 4;
        this.mesh.frustumCulled = false;
        scene.extra.add(this.mesh);
        app.stage.invalidate(scene);
      },
    );
  }
}
