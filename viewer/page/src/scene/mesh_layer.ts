// SPDX-License-Identifier: Apache-2.0
/** Meshes that were opened beside the case: each with an opacity of its own, in grey or coloured by its distance from the
 * wall of the case. */
import type { Part, View } from "../model/model";
import { MeshView } from "./mesh_view";
import { deviationOf, deviationText, sharedRange, type Deviation } from "../case/deviation";
import { Pack } from "../case/pack";
import type { SceneView } from "./scene_view";
import type { Vec3 } from "../base/types";
import { checkbox, errorText, h, section, slider } from "../base/ui";

const kAlpha = 0.55,
  kFaint = 0.15; // opacity of all vessels where a mesh has colours, as the wall would hide half of it

interface Row {
  view: MeshView;
  opacity: HTMLInputElement;
  box: HTMLInputElement;
  figures: HTMLElement;
  /** The case and meshes that the asked-for distances belong to; empty: none are wanted. */
  asked: string;
  waiting: AbortController | null;
}

/** How a person has chosen to see a mesh. */
interface Look {
  alpha: number;
  coloured: boolean;
}

export class MeshLayer {
  readonly panel: HTMLDetailsElement;
  private readonly list = h("div", { id: "mesh-list" });
  private readonly rows = new Map<string, Row | null>(); // null: being fetched

  constructor(
    private readonly app: Part<"document" | "selection", "source" | "stage" | "inform">,
    private readonly scene: SceneView,
  ) {
    this.panel = section("section-meshes", "Meshes", true, this.list);
    app.store.watch(["document.state"], ({ document: { state } }) => {
      this.panel.hidden = state.meshes.length === 0;
      const wanted = new Map(state.meshes.map(m => [String(m.id), m.name]));
      const looks = new Map<string, Look>(); // by name: a mesh that was read again has another number
      for (const [id, row] of this.rows)
        if (!wanted.has(id)) {
          if (row !== null) looks.set(row.view.name, { alpha: row.view.alpha, coloured: row.box.checked });
          this.drop(id, row);
        }
      for (const [id, name] of wanted)
        if (!this.rows.has(id)) {
          this.rows.set(id, null);
          void this.take(id, name, looks.get(name));
        }
    });
    app.store.watch(["document.tree", "document.state"], view => this.follow(view));
    app.store.watch(["document.deviations"], ({ document: { deviations } }) => this.colour(deviations));
  }

  private drop(id: string, row: Row | null): void {
    if (row !== null) {
      this.scene.extra.remove(row.view.mesh);
      row.view.dispose();
    }
    this.clear(id, row);
    this.rows.delete(id);
    this.list.querySelector(`[data-mesh="${CSS.escape(id)}"]`)?.remove();
    this.app.stage.invalidate(this.scene);
  }

  private async take(id: string, name: string, look?: Look): Promise<void> {
    const { app, scene } = this;
    try {
      const bytes = await app.source.bytes("mesh", { id });
      if (bytes === null || !this.rows.has(id)) return;
      const alpha = look?.alpha ?? (app.store.get().document.tree === null ? 1 : kAlpha),
        view = new MeshView(new Pack(bytes), name, alpha);
      const row = this.makeRow(id, view);
      row.box.checked = look?.coloured === true;
      this.rows.set(id, row);
      scene.extra.add(view.mesh);
      this.follow(app.store.get());
      this.fit(view.position);
      app.stage.invalidate(scene);
    } catch (error) {
      app.inform(errorText(error), "error");
    }
  }

  private makeRow(id: string, view: MeshView): Row {
    const { name } = view,
      opacity = slider(`mesh-opacity-${id}`, `Opacity of ${name}`, [0, 1, 0.05], view.alpha, alpha => {
        view.look({ alpha });
        this.app.stage.invalidate(this.scene);
      }),
      check = checkbox(
        `mesh-deviation-${id}`,
        "Colour by deviation",
        `Colours of ${name}: the distance of each vertex from the wall of the case, blue in the lumen, red outside`,
        false,
        on => this.choose(id, on),
      ),
      figures = h("output", { class: "hint deviation", id: `mesh-figures-${id}` });
    this.list.append(
      h(
        "div",
        { class: "mesh", "data-mesh": id },
        h("label", { class: "line" }, h("span", { class: "filename", title: name }, name), opacity),
        check,
        figures,
      ),
    );
    return { view, opacity, box: check.querySelector("input")!, figures, asked: "", waiting: null };
  }

  /** A person switches the colours of a mesh: it is drawn in full, and the vessels faint. */
  private choose(id: string, on: boolean): void {
    const row = this.rows.get(id),
      { store } = this.app;
    if (row === null || row === undefined) return;
    const alpha = on ? 1 : kAlpha;
    row.opacity.value = String(alpha);
    row.view.look({ alpha });
    if (on) {
      if (store.get().selection.allOpacity === 1) store.set({ selection: { allOpacity: kFaint } });
      this.follow(store.get());
      return;
    }
    this.clear(id, row);
    const others = [...this.rows.values()].some(each => each?.box.checked === true);
    if (!others && store.get().selection.allOpacity === kFaint) store.set({ selection: { allOpacity: 1 } });
  }

  /** Distances belong to one wall: another asks for others. */
  private follow({ document: { tree, state } }: Pick<View, "document">): void {
    const canAsk = tree?.hasModels === true;
    for (const [id, row] of this.rows) {
      if (row === null) continue;
      row.box.disabled = !canAsk;
      const key = `${state.revisions.case} ${state.revisions.meshes ?? 0}`;
      if (!row.box.checked || row.asked === key) continue;
      if (canAsk) void this.ask(id, row, key);
      else this.clear(id, row);
    }
  }

  private async ask(id: string, row: Row, key: string): Promise<void> {
    const { app } = this,
      waiting = new AbortController();
    row.waiting?.abort();
    row.waiting = waiting;
    row.asked = key;
    row.figures.textContent = "distances are being computed";
    row.figures.setAttribute("aria-busy", "true");
    try {
      const bytes = await app.source.bytes("deviation", { id }, undefined, waiting.signal);
      if (row.waiting !== waiting) return;
      if (bytes === null) throw new Error(`${row.view.name}: there is no wall to measure it from.`);
      this.show(id, row, deviationOf(new Pack(bytes), row.view.name, row.view.position.length / 3));
    } catch (error) {
      if (row.waiting !== waiting) return;
      this.clear(id, row);
      row.box.checked = false;
      app.inform(errorText(error), "error");
    }
  }

  private show(id: string, row: Row, deviation: Deviation): void {
    const { store } = this.app;
    row.waiting = null;
    row.view.setValues(deviation.distance);
    row.figures.textContent = deviationText(deviation);
    row.figures.removeAttribute("aria-busy");
    store.set({ document: { deviations: new Map(store.get().document.deviations).set(id, deviation) } });
  }

  private clear(id: string, row: Row | null): void {
    if (row !== null) {
      row.waiting?.abort();
      row.waiting = null;
      row.asked = "";
      row.figures.textContent = "";
      row.figures.removeAttribute("aria-busy");
    }
    const { store } = this.app,
      deviations = new Map(store.get().document.deviations);
    if (deviations.delete(id)) store.set({ document: { deviations } });
    this.app.stage.invalidate(this.scene);
  }

  private colour(deviations: View["document"]["deviations"]): void {
    const range = deviations.size === 0 ? null : sharedRange([...deviations.values()]);
    for (const [id, row] of this.rows) row?.view.look({ range: deviations.has(id) ? range : null });
    this.app.stage.invalidate(this.scene);
  }

  /** The view shows the mesh as a whole if nothing else is open. */
  private fit(position: Float32Array): void {
    const { tree, volume } = this.app.store.get().document;
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
