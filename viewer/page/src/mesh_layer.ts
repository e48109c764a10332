// SPDX-License-Identifier: Apache-2.0
/** Meshes that were opened beside the case: shown in grey, each with an opacity of its own. */
import { BufferAttribute, BufferGeometry, Mesh } from "three";
import type { App } from "./model";
import { Pack } from "./pack";
import { kNoClip, PartMaterial } from "./part_material";
import type { SceneView } from "./scene_view";
import { vertexNormals } from "./surface";
import type { Vec3 } from "./types";
import { h, section, slider } from "./ui";

const kAlpha = 0.55,
  kGrey: [number, number, number] = [0.78, 0.76, 0.72];

type Shown = Mesh<BufferGeometry, PartMaterial>;

export class MeshLayer {
  readonly panel: HTMLDetailsElement;
  private readonly list = h("div", { id: "mesh-list" });
  private readonly shown = new Map<string, Shown | null>(); // null: being fetched

  constructor(
    private readonly app: App,
    private readonly scene: SceneView,
  ) {
    this.panel = section("section-meshes", "Meshes", true, this.list);
    app.store.watch(["state"], ({ state }) => {
      this.panel.hidden = state.meshes.length === 0;
      const wanted = new Map(state.meshes.map(m => [String(m.id), m.name]));
      for (const [id, mesh] of this.shown) if (!wanted.has(id)) this.drop(id, mesh);
      for (const [id, name] of wanted)
        if (!this.shown.has(id)) {
          this.shown.set(id, null);
          void this.take(id, name);
        }
    });
  }

  private drop(id: string, mesh: Shown | null): void {
    if (mesh !== null) {
      this.scene.extra.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.shown.delete(id);
    this.list.querySelector(`[data-mesh="${CSS.escape(id)}"]`)?.remove();
    this.app.stage.invalidate(this.scene);
  }

  private async take(id: string, name: string): Promise<void> {
    const { app, scene } = this;
    try {
      const bytes = await app.source.bytes("mesh", { id });
      if (bytes === null || !this.shown.has(id)) return;
      const pack = new Pack(bytes),
        position = pack.get("position", "f32"),
        triangle = pack.get("triangle", "u32"),
        geometry = new BufferGeometry();
      for (const v of triangle)
        if (3 * v >= position.length)
          throw new Error(`${name}: a triangle names a vertex that does not exist.`);
      geometry.setAttribute("position", new BufferAttribute(position, 3));
      geometry.setAttribute("normal", new BufferAttribute(vertexNormals(position, triangle), 3));
      geometry.setIndex(new BufferAttribute(triangle, 1));
      const mesh: Shown = new Mesh(geometry, new PartMaterial(false));
      mesh.frustumCulled = false;
      mesh.renderOrder = 3;
      const look = (alpha: number): void => {
        mesh.visible = alpha > 0;
        mesh.material.look({
          own: kGrey,
          alpha,
          mapped: false,
          range: [0, 1],
          map: "sequential",
          lit: false,
          clip: kNoClip,
        });
        app.stage.invalidate(scene);
      };
      const alpha = app.store.get().tree === null ? 1 : kAlpha;
      look(alpha);
      this.shown.set(id, mesh);
      scene.extra.add(mesh);
      const field = slider(`mesh-opacity-${id}`, `Opacity of ${name}`, [0, 1, 0.05], alpha, look);
      this.list.append(
        h(
          "label",
          { class: "line", "data-mesh": id },
          h("span", { class: "filename", title: name }, name),
          field,
        ),
      );
      this.fit(position);
    } catch (error) {
      app.inform(error instanceof Error ? error.message : String(error), "error");
    }
  }

  /** The view shows the mesh as a whole if nothing else is open. */
  private fit(position: Float32Array): void {
    const { tree, volume } = this.app.store.get();
    if (tree !== null || volume !== null || position.length === 0) return;
    const low: Vec3 = [Infinity, Infinity, Infinity],
      high: Vec3 = [-Infinity, -Infinity, -Infinity];
    position.forEach((x, i) => {
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    });
    this.scene.camera.fit(low, high);
    this.app.stage.invalidate(this.scene);
  }
}
