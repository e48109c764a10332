// SPDX-License-Identifier: Apache-2.0
/** Linear blend skinning: vertices of a surface that hang on frames of nodes. */
import { poseMatrix, type Poses } from "./motion";
import type { Pack } from "./pack";

const kPerVertex = 4, // joints
  kWhole = 65535, // of a vertex's weights
  kMatrix = 12, // numbers: the rows of a 3 x 4 matrix
  kResting = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

/** Joints and weights of vertices. */
export class Skin {
  private constructor(
    /** Node that each joint rides on; -1: it rests. */
    private readonly node: Int32Array,
    private readonly joint: Uint16Array,
    private readonly weight: Uint16Array,
  ) {}

  /** That of a surface's pack; null if it does not move. Throws where a vertex names a joint that does not exist. */
  static of(pack: Pack, vertices: number): Skin | null {
    const node = pack.optional("joint_node", "i32");
    if (node === null) return null;
    const joint = pack.get("joint", "u16"),
      weight = pack.get("weight", "u16");
    if (joint.length !== kPerVertex * vertices || weight.length !== joint.length)
      throw new Error("The surface has not four joints and weights for each vertex.");
    if (joint.some(j => j >= node.length))
      throw new Error("A vertex of the surface names a joint that does not exist.");
    return new Skin(node, joint, weight);
  }

  /** The matrices of all joints, one after the other; `centre`: of all nodes at rest. */
  matrices(poses: Poses, centre: Float32Array): Float64Array {
    const out = new Float64Array(kMatrix * this.node.length);
    this.node.forEach((node, j) => {
      const pose = poses.get(node);
      out.set(
        pose === undefined ? kResting : poseMatrix(pose, centre.subarray(3 * node, 3 * node + 3)),
        kMatrix * j,
      );
    });
    return out;
  }

  /** Carries positions and directions (four bytes each) at rest to `position` and `normal`. */
  carry(
    matrices: Float64Array,
    rest: { position: Float32Array; normal: Int8Array },
    { position, normal }: { position: Float32Array; normal: Int8Array },
  ): void {
    const m = new Float64Array(kMatrix),
      { joint, weight } = this;
    for (let v = 0, p = 0, n = 0; p < position.length; ++v, p += 3, n += 4) {
      m.fill(0);
      for (let i = kPerVertex * v; i < kPerVertex * (v + 1); ++i) {
        if (weight[i] === 0) continue;
        const w = weight[i] / kWhole,
          at = kMatrix * joint[i];
        for (let k = 0; k < kMatrix; ++k) m[k] += w * matrices[at + k];
      }
      const x = rest.position[p],
        y = rest.position[p + 1],
        z = rest.position[p + 2];
      for (let a = 0; a < 3; ++a)
        position[p + a] = m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3];
      const u = rest.normal[n],
        s = rest.normal[n + 1],
        t = rest.normal[n + 2];
      const i = m[0] * u + m[1] * s + m[2] * t,
        j = m[4] * u + m[5] * s + m[6] * t,
        k = m[8] * u + m[9] * s + m[10] * t;
      const unit = 127 / (Math.sqrt(i * i + j * j + k * k) || 1);
      normal[n] = Math.round(unit * i);
      normal[n + 1] = Math.round(unit * j);
      normal[n + 2] = Math.round(unit * k);
    }
  }
}
