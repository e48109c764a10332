// SPDX-License-Identifier: Apache-2.0
/** Keeps what is shown in step with the document: fetches the packs whose revision has changed, small ones first. */
import { load as loadBlob, type Blob as BlobLibrary } from "../../../../libblob/wasm/blob.mjs";
import { fillValues } from "../model/colouring";
import { kFirst, kLabels, kSecond, type CursorPart, type View } from "../model/model";
import { Pack } from "../case/pack";
import { sameVessels } from "../model/same_vessel";
import type { SceneView } from "../scene/scene_view";
import type { SliceView } from "../slices/slice_view";
import { Surface } from "../case/surface";
import { Tree } from "../case/tree";
import type { State } from "../base/types";
import { errorText, idle } from "../base/ui";
import { VolumeLoader } from "./volume_loader";

const kOutlines = 400, // ms from one drawing of outlines to the next, while they are prepared
  kWhileMoving = 500; // ms until the scene is looked at again, where it moves

export class Loader {
  private seen = { case: -1, surface: -1, volume: -1, second: 0, labels: 0, proposals: -1, distance: "" };
  private library: Promise<BlobLibrary | null> | null = null;
  private readonly volume: VolumeLoader;
  private readonly second: VolumeLoader;
  private readonly labels: VolumeLoader;
  private quickOf = -1;
  private shown = { case: -1, kind: "", level: 0 };
  private first = true;

  constructor(
    private readonly app: CursorPart<"scene", "source" | "stage" | "inform">,
    private readonly slices: SliceView[],
    private readonly scene: SceneView,
  ) {
    this.volume = new VolumeLoader(app, kFirst, slices, scene, () => this.settle());
    this.second = new VolumeLoader(app, kSecond, slices);
    this.labels = new VolumeLoader(app, kLabels, slices);
    app.store.watch(["scene.colourBy", "document.surface", "document.distance"], view => {
      fillValues(view);
      app.stage.invalidate(scene);
    });
    app.store.watch(["scene.colourBy", "document.surface", "document.state"], () => this.askDistance());
  }

  /** Takes a state as the new truth. */
  async take(state: State): Promise<void> {
    const { store } = this.app,
      r = state.revisions,
      jobs: Promise<void>[] = [];
    store.set({ document: { state, figures: state.figures ?? null } });
    if (r.case !== this.seen.case) {
      this.seen.case = r.case;
      jobs.push(this.takeCase(state));
    }
    if (r.volume !== this.seen.volume) {
      this.seen.volume = r.volume;
      jobs.push(this.volume.take(state.has_volume));
    }
    if ((r.second ?? 0) !== this.seen.second) {
      this.seen.second = r.second ?? 0;
      jobs.push(this.second.take(state.second !== null));
    }
    if ((r.labels ?? 0) !== this.seen.labels) {
      this.seen.labels = r.labels ?? 0;
      jobs.push(this.labels.take(state.labels !== null));
    }
    if ((r.proposals ?? 0) !== this.seen.proposals) {
      this.seen.proposals = r.proposals ?? 0;
      jobs.push(this.takeProposals(state));
    }
    await Promise.all(jobs);
    store.set({ document: { treeRevision: state.revision } });
    if (r.surface !== this.seen.surface) {
      this.seen.surface = r.surface;
      void this.takeSurface(state);
    }
    this.settle();
    this.askDistance();
  }

  /** Distances belong to one surface and one truth, and take a while: they are asked for when they are shown. */
  private askDistance(): void {
    const {
        document: { state, surface },
        scene: { colourBy },
      } = this.app.store.get(),
      r = state.revisions;
    if (colourBy !== "compare" || surface === null || !state.has_truth) return;
    const key = `${r.case} ${r.truth ?? 0} ${this.shown.kind} ${this.shown.level}`;
    if (key === this.seen.distance) return;
    this.seen.distance = key;
    void this.takeDistance(surface).catch((error: unknown) => this.app.inform(errorText(error), "error"));
  }

  /** Once: the crosshair to where the page was sent, or into the middle; the projection where there is no case. */
  private settle(): void {
    const { store, stage } = this.app,
      { tree, volume, state } = store.get().document;
    if (!this.first || (tree === null && (volume === null || state.has_case))) return;
    this.first = false;
    store.set({
      slices: {
        crosshair:
          state.look ?? (tree !== null && tree.count > 0 ? tree.position(thickest(tree)) : volume!.centre()),
      },
      scene: { cast: tree === null && volume !== null ? "mip" : "off" },
      motion: state.time_s !== null && tree?.motion ? { time: tree.motion.within(state.time_s) } : {},
    });
    stage.invalidate();
  }

  private async pack(name: string, query: Record<string, string> = {}): Promise<Pack | null> {
    const bytes = await this.app.source.bytes(name, query);
    return bytes === null ? null : new Pack(bytes);
  }

  private async takeCase(state: State): Promise<void> {
    const { store } = this.app,
      pack = state.has_case ? await this.pack("case") : null;
    const tree = pack === null ? null : new Tree(pack);
    store.set({
      document: { tree, ...(tree === null ? { surface: null } : {}) },
      selection: sameVessels(store.get(), tree),
    });
    this.app.stage.firstPicture ||= tree !== null && !state.has_volume;
    this.settle();
    void this.openModel(tree);
  }

  private async takeProposals(state: State): Promise<void> {
    const { store } = this.app,
      pack = state.proposals.length > 0 ? await this.pack("proposals") : null,
      tree = pack === null ? null : new Tree(pack),
      { proposal } = store.get().selection;
    store.set({
      document: { proposals: tree },
      selection: { proposal: tree?.branches.some(b => b.label === proposal) === true ? proposal : null },
    });
  }

  private async openModel(tree: Tree | null): Promise<void> {
    const { store, source, inform } = this.app;
    if (tree?.hasModels !== true) {
      store.set({ document: { blob: null } });
      return;
    }
    try {
      this.library ??= source
        .bytes("blob.wasm")
        .then(wasm => (wasm === null ? null : loadBlob(wasm as BufferSource)));
      const [library, file] = await Promise.all([this.library, source.bytes("case.lumen")]);
      if (store.get().document.tree !== tree) return;
      store.get().document.blob?.close();
      store.set({ document: { blob: library === null || file === null ? null : library.open(file) } });
    } catch (error) {
      store.set({ document: { blob: null } });
      inform(`The probe is not available: ${errorText(error)}`, "warning");
    }
  }

  /** A coarse surface at once; finer ones as the server has made them, each announced by a revision of its own. */
  private async takeSurface(state: State): Promise<void> {
    const { store, stage } = this.app,
      ofCase = state.revisions.case,
      live = (): boolean => ofCase === this.seen.case;
    if (!state.has_case || store.get().document.tree?.hasModels !== true) {
      store.set({ document: { surface: null } });
      return;
    }
    const level = stage.software ? 1 : 0;
    try {
      if (this.shown.case !== ofCase && this.quickOf !== ofCase) {
        this.quickOf = ofCase;
        this.showSurface(await this.pack("surface", { quick: "1" }), ofCase, live);
      }
      if (!live() || (this.shown.case === ofCase && this.shown.kind !== "quick" && this.shown.level <= level))
        return;
      this.showSurface(await this.pack("surface", { level: String(level) }), ofCase, live);
    } catch (error) {
      if (live()) this.app.inform(`The surface could not be shown: ${errorText(error)}`, "warning");
    }
  }

  private showSurface(pack: Pack | null, ofCase: number, live: () => boolean): void {
    if (pack === null || !live()) return;
    const kind = String(pack.meta.kind),
      level = Number(pack.meta.level ?? 0),
      { shown } = this;
    if (
      shown.case === ofCase &&
      (shown.kind !== "quick" || kind === "quick") &&
      (kind === shown.kind ? level >= shown.level : true)
    )
      return;
    this.shown = { case: ofCase, kind, level };
    this.app.store.set({ document: { surface: new Surface(pack), distance: null } });
    document.body.dataset.surface = kind;
    const { surface } = this.app.store.get().document;
    if (surface !== null) this.buildBoxes(surface, live, performance.now());
  }

  /** Builds what outlines and picking need, a part at a time, while nothing moves; outlines appear by and by. */
  private buildBoxes(surface: Surface, live: () => boolean, drawn: number): void {
    idle(() => {
      if (!live() || this.app.store.get().document.surface !== surface) return;
      if (this.scene.isMoving) {
        window.setTimeout(() => this.buildBoxes(surface, live, drawn), kWhileMoving);
        return;
      }
      const more = surface.buildNext(),
        now = performance.now(),
        isDue = !more || now - drawn > kOutlines;
      if (isDue) for (const slice of this.slices) this.app.stage.invalidateOver(slice);
      if (more) this.buildBoxes(surface, live, isDue ? now : drawn);
    });
  }

  private async takeDistance(surface: Surface): Promise<void> {
    const query: Record<string, string> =
      surface.kind === "quick" ? { quick: "1" } : { level: String(surface.level) };
    const pack = await this.pack("distance", query),
      distance = pack?.optional("distance_mm", "f32") ?? null,
      { store } = this.app;
    if (store.get().document.surface !== surface) return;
    if (distance !== null && distance.length !== surface.radius.length) {
      this.seen.distance = "";
      return;
    } // of a finer one, which comes soon
    store.set({
      document: {
        distance,
        figures: (pack?.meta.figures as View["document"]["figures"]) ?? store.get().document.figures,
      },
    });
  }
}

function thickest(tree: Tree): number {
  let best = 0;
  for (let i = 1; i < tree.count; ++i) if (tree.radius[i] > tree.radius[best]) best = i;
  return best;
}
