// SPDX-License-Identifier: Apache-2.0
/** A mesh as the 3D view draws it. */
import { BufferAttribute, BufferGeometry, Mesh } from "three";
import { kDeviationMap } from "../case/deviation";
import type { Pack } from "../case/pack";
import { PartMaterial } from "./part_material";
import { vertexNormals } from "../case/surface";

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
