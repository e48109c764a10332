// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute } from "three";
import { describe, expect, it, vi } from "vitest";
import { makePack, Pack } from "./pack";
import { Surface, vertexNormals } from "./surface";

/** Two squares of two triangles, as parts of one each; `moving` has one triangle of the first. */
function pack(moving: number[] | null): Pack {
  const position = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0],
    triangle = [0, 1, 2, 0, 2, 3, 1, 4, 2];
  const u32 = (data: number[]): { type: "u32"; shape: number[]; data: Uint32Array<ArrayBuffer> } => ({
    type: "u32",
    shape: [data.length / 3, 3],
    data: new Uint32Array(data),
  });
  return new Pack(
    makePack(
      {
        parts: [
          { name: "a", branch: 0, first: 0, count: 2, moving_first: 0, moving_count: 1 },
          { name: "b", branch: 1, first: 2, count: 1, moving_first: 1, moving_count: 0 },
        ],
      },
      {
        position: { type: "f32", shape: [5, 3], data: new Float32Array(position) },
        triangle: u32(triangle),
        node: { type: "u32", shape: [5], data: new Uint32Array(5) },
        radius_mm: { type: "f32", shape: [5], data: new Float32Array(5).fill(1) },
        ...(moving === null ? {} : { moving: u32(moving) }),
      },
    ),
  );
}

describe("Surface", () => {
  it("hasFewerTrianglesOfTheSameVerticesForMoving", () => {
    const [a, b] = new Surface(pack([0, 1, 3])).parts;
    expect([...a.moving!.getIndex()!.array]).toEqual([0, 1, 3]);
    expect(a.moving!.getAttribute("position")).toBe(a.geometry.getAttribute("position"));
    expect(a.geometry.getIndex()!.count).toBe(6);
    expect(b.moving).toBe(null); // none are left of it: it is drawn as it is
  });
  it("needsNone", () => {
    expect(new Surface(pack(null)).parts.map(p => p.moving)).toEqual([null, null]);
  });
  it("givesEachPartItsSphereWithoutAReadOfAllVertices", () => {
    const read = vi.spyOn(BufferAttribute.prototype, "getX");
    const { parts } = new Surface(pack([0, 1, 3]));
    for (const { geometry, moving } of parts)
      for (const each of [geometry, moving])
        if (each !== null && each.boundingSphere === null) each.computeBoundingSphere(); // as three.js before it draws
    expect(read.mock.calls.length).toBe(0);
    read.mockRestore();
    const [a, b] = parts.map(part => part.geometry.boundingSphere!);
    expect(a.center.toArray()).toEqual([0.5, 0.5, 0]);
    expect(a.radius).toBeCloseTo(Math.SQRT1_2);
    expect(b.center.toArray()).toEqual([1.5, 0.5, 0]); // of its own vertices, not of all
  });
  it("refusesAVertexThatDoesNotExist", () => {
    expect(() => new Surface(pack([0, 1, 5]))).toThrow(/moving/);
  });
});

describe("vertexNormals", () => {
  it("pointOutOfATetrahedron", () => {
    const normal = vertexNormals(
      new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]),
      new Uint32Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]),
    );
    expect(Array.from(normal.slice(0, 3))).toEqual([-1, -1, -1]);
  });
});
