// SPDX-License-Identifier: Apache-2.0
/** The surface as parts, one for each branch: geometry that shares its vertices, and a tree of boxes for each part,
 * built when somebody asks or when nothing else is to be done. */
import { Box3, BufferAttribute, BufferGeometry, DoubleSide, Plane, Sphere, Vector3, type Ray } from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Poses } from "./motion";
import type { Pack } from "./pack";
import { Skin } from "./skin";
import type { Vec3 } from "../base/types";

interface Part {
  name: string;
  branch: number;
  first: number;
  count: number;
  geometry: BufferGeometry;
  /** With fewer triangles, for pictures while the scene moves; null: there are none. */
  moving: BufferGeometry | null;
  box: Box3;
  bvh: MeshBVH | null;
  /** Box and hierarchy are those of another time. */
  isStale: boolean;
}

/** A part as a pack lists it. */
interface PartRecord {
  name: string;
  branch: number;
  first: number;
  count: number;
  moving_first?: number;
  moving_count?: number;
}

export interface Hit {
  part: number;
  branch: number;
  point: Vec3;
  distance: number;
  vertex: number;
  node: number;
}

/** Sums of the triangles' normals, weighted by area, at each vertex; not of unit length: the shader sees to it. */
export function vertexNormals(position: Float32Array, triangle: Uint32Array): Float32Array {
  const normal = new Float32Array(position.length),
    p = position;
  for (let t = 0; t < triangle.length; t += 3) {
    const a = 3 * triangle[t],
      b = 3 * triangle[t + 1],
      c = 3 * triangle[t + 2];
    const ux = p[b] - p[a],
      uy = p[b + 1] - p[a + 1],
      uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a],
      vy = p[c + 1] - p[a + 1],
      vz = p[c + 2] - p[a + 2];
    const x = uy * vz - uz * vy,
      y = uz * vx - ux * vz,
      z = ux * vy - uy * vx;
    for (const v of [a, b, c]) {
      normal[v] += x;
      normal[v + 1] += y;
      normal[v + 2] += z;
    }
  }
  return normal;
}

/** To bytes, as the graphics take them: a third of the memory. */
function packed(normal: Float32Array): Int8Array {
  const bytes = new Int8Array((normal.length / 3) * 4);
  for (let i = 0, o = 0; i < normal.length; i += 3, o += 4) {
    const s = 127 / (Math.hypot(normal[i], normal[i + 1], normal[i + 2]) || 1);
    bytes[o] = Math.round(normal[i] * s);
    bytes[o + 1] = Math.round(normal[i + 1] * s);
    bytes[o + 2] = Math.round(normal[i + 2] * s);
  }
  return bytes;
}

export class Surface {
  readonly parts: Part[];
  readonly position: Float32Array;
  readonly triangle: Uint32Array;
  readonly node: Uint32Array;
  readonly radius: Float32Array;
  /** A number for each vertex that colours show; filled by `colourBy`. */
  readonly value: BufferAttribute;
  readonly kind: string;
  readonly level: number;
  readonly levels: number;
  /** Counts the poses that it was in: outlines of another one are no longer right. */
  poses = 0;
  private readonly skin: Skin | null;
  private readonly drawn: { position: BufferAttribute; normal: BufferAttribute };
  /** Positions and normals at rest, once it has moved. */
  private atRest: { position: Float32Array; normal: Int8Array } | null = null;
  private isPosed = false;

  constructor(pack: Pack) {
    this.position = pack.get("position", "f32");
    this.triangle = pack.get("triangle", "u32");
    this.node = pack.get("node", "u32");
    this.radius = pack.get("radius_mm", "f32");
    this.kind = String(pack.meta.kind ?? "closed");
    this.level = Number(pack.meta.level ?? 0);
    this.levels = Number(pack.meta.levels ?? 1);
    const vertices = this.position.length / 3;
    for (const v of this.triangle)
      if (v >= vertices) throw new Error("A triangle of the surface names a vertex that does not exist.");
    const position = new BufferAttribute(this.position, 3);
    const normal = new BufferAttribute(
      packed(pack.optional("normal", "f32") ?? vertexNormals(this.position, this.triangle)),
      4,
      true,
    );
    this.skin = Skin.of(pack, vertices);
    this.drawn = { position, normal };
    this.value = new BufferAttribute(new Float32Array(vertices), 1);
    const moving = pack.optional("moving", "u32");
    if (moving?.some(v => v >= vertices) === true)
      throw new Error("A triangle of the moving surface names a vertex that does not exist.");
    // with its sphere, by which three.js orders parts: it would make one for each part from the vertices of all
    const geometryOf = (
      triangle: Uint32Array,
      first: number,
      count: number,
      sphere: Sphere,
    ): BufferGeometry => {
      const geometry = new BufferGeometry();
      geometry.boundingSphere = sphere;
      geometry.setAttribute("position", position);
      geometry.setAttribute("normal", normal);
      geometry.setAttribute("value", this.value);
      geometry.setIndex(new BufferAttribute(triangle.subarray(3 * first, 3 * (first + count)), 1));
      return geometry;
    };
    this.parts = (pack.meta.parts as PartRecord[])
      .filter(part => part.count > 0)
      .map(part => {
        const {
            name,
            branch,
            first,
            count,
            moving_first: movingFirst = 0,
            moving_count: movingCount = 0,
          } = part,
          box = this.boxOf(part),
          sphere = box.getBoundingSphere(new Sphere());
        return {
          name,
          branch,
          first,
          count,
          geometry: geometryOf(this.triangle, first, count, sphere),
          moving:
            moving === null || movingCount === 0
              ? null
              : geometryOf(moving, movingFirst, movingCount, sphere),
          box,
          bvh: null,
          isStale: false,
        };
      });
  }

  private boxOf(part: { first: number; count: number }): Box3 {
    const low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity],
      p = this.position;
    for (let i = 3 * part.first; i < 3 * (part.first + part.count); ++i)
      for (let a = 0, v = 3 * this.triangle[i]; a < 3; ++a, ++v) {
        if (p[v] < low[a]) low[a] = p[v];
        if (p[v] > high[a]) high[a] = p[v];
      }
    return new Box3(new Vector3(...low), new Vector3(...high));
  }

  /** Sets the number that each vertex shows, from one for each node. */
  fromNodes(values: ArrayLike<number>): void {
    const out = this.value.array as Float32Array;
    for (let i = 0; i < out.length; ++i) out[i] = this.node[i] < values.length ? values[this.node[i]] : NaN;
    this.value.needsUpdate = true;
  }
  fromVertices(values: Float32Array): void {
    (this.value.array as Float32Array).set(values.subarray(0, this.value.array.length));
    this.value.needsUpdate = true;
  }

  /** Moves the vertices with the nodes that they hang on; `centre`: of all nodes at rest. */
  pose(poses: Poses, centre: Float32Array): void {
    if (this.skin === null) return;
    const { position, normal } = this.drawnArrays();
    this.atRest ??= { position: position.slice(), normal: normal.slice() };
    this.skin.carry(this.skin.matrices(poses, centre), this.atRest, { position, normal });
    this.isPosed = true;
    this.moved();
  }
  /** Moves the vertices back to their places at rest. */
  rest(): void {
    if (!this.isPosed || this.atRest === null) return;
    const { position, normal } = this.drawnArrays();
    position.set(this.atRest.position);
    normal.set(this.atRest.normal);
    this.isPosed = false;
    this.moved();
  }
  private drawnArrays(): { position: Float32Array; normal: Int8Array } {
    return { position: this.position, normal: this.drawn.normal.array as Int8Array };
  }
  private moved(): void {
    ++this.poses;
    this.drawn.position.needsUpdate = true;
    this.drawn.normal.needsUpdate = true;
    for (const part of this.parts) part.isStale = true;
  }

  tree(part: Part): MeshBVH {
    if (part.bvh === null) part.bvh = new MeshBVH(part.geometry);
    else if (part.isStale) part.bvh.refit();
    if (part.isStale) {
      part.bvh.getBoundingBox(part.box);
      part.box.getBoundingSphere(part.geometry.boundingSphere!); // that of `moving`, too
    }
    part.isStale = false;
    return part.bvh;
  }

  /** Builds the tree of one part that has none; true if more are missing. */
  buildNext(): boolean {
    const part = this.parts.find(p => p.bvh === null);
    if (part !== undefined) this.tree(part);
    return this.parts.some(p => p.bvh === null);
  }

  /** The nearest crossing of a ray with a part that is shown. */
  pick(ray: Ray, shown: (branch: number) => boolean, beyond: (p: Vec3) => boolean = () => true): Hit | null {
    let best: Hit | null = null;
    const target = new Vector3();
    this.parts.forEach((part, index) => {
      if (!shown(part.branch)) return;
      if (part.isStale) this.tree(part);
      const { box } = part;
      if (ray.intersectBox(box, target) === null) return;
      if (best !== null && !box.containsPoint(ray.origin) && target.distanceTo(ray.origin) > best.distance)
        return;
      for (const hit of this.tree(part)
        .raycast(ray, DoubleSide)
        .sort((a, b) => a.distance - b.distance)) {
        const point = hit.point.toArray() as Vec3;
        if (!beyond(point)) continue;
        if (best === null || hit.distance < best.distance)
          best = {
            part: index,
            branch: part.branch,
            point,
            distance: hit.distance,
            vertex: hit.face!.a,
            node: this.node[hit.face!.a],
          };
        break;
      }
    });
    return best;
  }

  /** Segments in which a part meets a plane: x y z of both ends, one after the other. */
  cut(part: Part, normal: Vec3, origin: Vec3): number[] {
    const plane = new Plane().setFromNormalAndCoplanarPoint(new Vector3(...normal), new Vector3(...origin)),
      out: number[] = [];
    if (part.isStale) this.tree(part);
    if (!plane.intersectsBox(part.box)) return out;
    this.tree(part).shapecast({
      intersectsBounds: box => plane.intersectsBox(box),
      intersectsTriangle: triangle => {
        const ends: number[] = [],
          corners = [triangle.a, triangle.b, triangle.c],
          d = corners.map(c => plane.distanceToPoint(c));
        for (let i = 0; i < 3; ++i) {
          const j = (i + 1) % 3;
          if (d[i] < 0 === d[j] < 0) continue;
          const s = d[i] / (d[i] - d[j]),
            a = corners[i],
            b = corners[j];
          ends.push(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z));
        }
        if (ends.length === 6) out.push(...ends);
        return false;
      },
    });
    return out;
  }

  dispose(): void {
    for (const part of this.parts) {
      part.geometry.dispose();
      part.moving?.dispose();
    }
  }
}
