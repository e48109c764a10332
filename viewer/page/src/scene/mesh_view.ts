// SPDX-License-Identifier: Apache-2.0
/** A mesh as the 3D view draws it, and how far its vertices lie from the wall of the case. */
import { usualRange, type MapName } from "../base/colour";
import { mm } from "../base/ui";
import { BufferAttribute, BufferGeometry, Mesh } from "three";
import type { Pack } from "../case/pack";
import { PartMaterial } from "./part_material";
import { vertexNormals } from "../case/surface";

export interface Deviation {
  /** Name of the mesh. */
  name: string;
  /** Of each vertex to the wall, mm; negative in the lumen. */
  distance: Float32Array;
  /** Of the absolute distances, mm. */
  median: number;
  percentile90: number;
}

/** Blue in the lumen, red outside of it, white on the wall. */
export const kDeviationMap: MapName = "diverging";

/** Reads the distances of a mesh with the stated number of vertices. Throws if the answer is that of another mesh. */
export function deviationOf(pack: Pack, name: string, vertices: number): Deviation {
  const distance = pack.get("distance", "f32"),
    { median, percentile90 } = pack.meta.figures as Record<string, unknown>;
  if (distance.length !== vertices || typeof median !== "number" || typeof percentile90 !== "number")
    throw new Error(`${name}: its distances are those of another mesh.`);
  return { name, distance, median, percentile90 };
}

/** One range for all of them, so that a colour means one distance. */
export function sharedRange(all: readonly Deviation[]): [number, number] {
  const most = Math.max(...all.map(each => usualRange(each.distance, true)[1]));
  return [-most, most];
}

export const deviationText = (deviation: Deviation): string =>
  `median ${mm(deviation.median)}, 90 % within ${mm(deviation.percentile90)}`;

const kGrey: [number, number, number] = [0.78, 0.76, 0.72],
  kOrder = 3; // after the vessels

export class MeshView {
  readonly mesh: Mesh<BufferGeometry, PartMaterial>;
  readonly position: Float32Array;
  private readonly value: BufferAttribute;
  /** Of the numbers that colours show; null: grey. */
  private range: [number, number] | null = null;

  /** Throws where a triangle names a vertex that does not exist. */
  constructor(
    pack: Pack,
    readonly name: string,
    public alpha: number,
  ) {
    const triangle = pack.get("triangle", "u32"),
      geometry = new BufferGeometry();
    this.position = pack.get("position", "f32");
    for (const v of triangle)
      if (3 * v >= this.position.length)
        throw new Error(`${name}: a triangle names a vertex that does not exist.`);
    this.value = new BufferAttribute(new Float32Array(this.position.length / 3), 1);
    geometry.setAttribute("position", new BufferAttribute(this.position, 3));
    geometry.setAttribute("normal", new BufferAttribute(vertexNormals(this.position, triangle), 3));
    geometry.setAttribute("value", this.value);
    geometry.setIndex(new BufferAttribute(triangle, 1));
    this.mesh = new Mesh(geometry, new PartMaterial(true));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = kOrder;
    this.look({});
  }

  /** A number for each vertex, which colours show once there is a range. */
  setValues(values: Float32Array): void {
    (this.value.array as Float32Array).set(values);
    this.value.needsUpdate = true;
  }

  look(change: { alpha?: number; range?: [number, number] | null }): void {
    const { alpha = this.alpha, range = this.range } = change;
    this.alpha = alpha;
    this.range = range;
    this.mesh.visible = alpha > 0;
    this.mesh.material.look({
      own: kGrey,
      alpha,
      mapped: range !== null,
      range: range ?? undefined,
      map: kDeviationMap,
    });
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
