// SPDX-License-Identifier: Apache-2.0
/** Keeps what is shown in step with the document: fetches the packs whose revision has changed, small ones first. */
import { load as loadBlob, type Blob as BlobLibrary } from "../../../libblob/wasm/blob.mjs";
import { Caster } from "./cast";
import { fillValues } from "./colouring";
import type { App, View } from "./model";
import { headerEnd, Pack } from "./pack";
import { sameVessels } from "./same_vessel";
import type { SceneView } from "./scene_view";
import type { SliceView } from "./slice_view";
import { Surface } from "./surface";
import { Tree } from "./tree";
import type { State } from "./types";
import { reduce, Volume } from "./volume";
import { VolumeTexture } from "./volume_texture";

const kArriving = 500; // ms from one picture of a volume that is arriving to the next
const kCastSoftware = 128,
  kCastHardware = 256; // texels along an axis for ray casting

export class Loader {
  private seen = { case: -1, surface: -1, volume: -1, proposals: -1, distance: "" };
  private library: Promise<BlobLibrary | null> | null = null;
  private texture: VolumeTexture | null = null;
  private quickOf = -1;
  private shown = { case: -1, kind: "", level: 0 };
  private first = true;

  constructor(
    private readonly app: App,
    private readonly slices: SliceView[],
    private readonly scene: SceneView,
  ) {
    app.store.watch(["colourBy", "surface", "distance"], view => {
      fillValues(view);
      app.stage.invalidate(scene);
    });
    app.store.watch(["colourBy", "surface", "state"], () => this.askDistance());
  }

  /** Takes a state as the new truth. */
  async take(state: State): Promise<void> {
    const { store } = this.app,
      r = state.revisions,
      jobs: Promise<void>[] = [];
    store.set({ state, figures: state.figures ?? null });
    if (r.case !== this.seen.case) {
      this.seen.case = r.case;
      jobs.push(this.takeCase(state));
    }
    if (r.volume !== this.seen.volume) {
      this.seen.volume = r.volume;
      jobs.push(this.takeVolume(state));
    }
    if ((r.proposals ?? 0) !== this.seen.proposals) {
      this.seen.proposals = r.proposals ?? 0;
      jobs.push(this.takeProposals(state));
    }
    await Promise.all(jobs);
    store.set({ treeRevision: state.revision });
    if (r.surface !== this.seen.surface) {
      this.seen.surface = r.surface;
      void this.takeSurface(state);
    }
    this.settle();
    this.askDistance();
  }

  /** Distances belong to one surface and one truth, and take a while: they are asked for when they are shown. */
  private askDistance(): void {
    const { state, surface, colourBy } = this.app.store.get(),
      r = state.revisions;
    if (colourBy !== "compare" || surface === null || !state.hasTruth) return;
    const key = `${r.case} ${r.truth ?? 0} ${this.shown.kind} ${this.shown.level}`;
    if (key === this.seen.distance) return;
    this.seen.distance = key;
    void this.takeDistance(surface).catch((error: unknown) =>
      this.app.inform(error instanceof Error ? error.message : String(error), "error"),
    );
  }

  /** Once: the crosshair into the middle of what there is, and the projection where there is no case. */
  private settle(): void {
    const { store, stage } = this.app,
      { tree, volume, state } = store.get();
    if (!this.first || (tree === null && (volume === null || state.hasCase))) return;
    this.first = false;
    store.set({
      crosshair: tree !== null && tree.count > 0 ? tree.position(thickest(tree)) : volume!.centre(),
      cast: tree === null && volume !== null ? "mip" : "off",
    });
    stage.invalidate();
  }

  private async pack(name: string, query: Record<string, string> = {}): Promise<Pack | null> {
    const bytes = await this.app.source.bytes(name, query);
    return bytes === null ? null : new Pack(bytes);
  }

  private async takeCase(state: State): Promise<void> {
    const { store } = this.app,
      pack = state.hasCase ? await this.pack("case") : null;
    const tree = pack === null ? null : new Tree(pack),
      before = store.get();
    store.set({ tree, ...sameVessels(before, tree), ...(tree === null ? { surface: null } : {}) });
    this.app.stage.firstPicture ||= tree !== null && !state.hasVolume;
    this.settle();
    void this.openModel(tree);
  }

  private async takeProposals(state: State): Promise<void> {
    const { store } = this.app,
      pack = state.proposals.length > 0 ? await this.pack("proposals") : null,
      tree = pack === null ? null : new Tree(pack),
      { proposal } = store.get();
    store.set({
      proposals: tree,
      proposal: tree?.branches.some(b => b.label === proposal) === true ? proposal : null,
    });
  }

  private async openModel(tree: Tree | null): Promise<void> {
    const { store, source, inform } = this.app;
    if (tree?.hasModels !== true) {
      store.set({ blob: null });
      return;
    }
    try {
      this.library ??= source
        .bytes("blob.wasm")
        .then(wasm => (wasm === null ? null : loadBlob(wasm as BufferSource)));
      const [library, file] = await Promise.all([this.library, source.bytes("case.lumen")]);
      if (store.get().tree !== tree) return;
      store.get().blob?.close();
      store.set({ blob: library === null || file === null ? null : library.open(file) });
    } catch (error) {
      store.set({ blob: null });
      inform(
        `The probe and the wire are not available: ${error instanceof Error ? error.message : String(error)}`,
        "warning",
      );
    }
  }

  /** A coarse surface at once; finer ones as the server has made them, each announced by a revision of its own. */
  private async takeSurface(state: State): Promise<void> {
    const { store, stage } = this.app,
      ofCase = state.revisions.case,
      live = (): boolean => ofCase === this.seen.case;
    if (!state.hasCase || store.get().tree?.hasModels !== true) {
      store.set({ surface: null });
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
      if (live())
        this.app.inform(
          `The surface could not be shown: ${error instanceof Error ? error.message : String(error)}`,
          "warning",
        );
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
    this.app.store.set({ surface: new Surface(pack), distance: null });
    document.body.dataset.surface = kind;
    const { surface } = this.app.store.get(),
      build = (): void => {
        if (!live() || surface === null || this.app.store.get().surface !== surface) return;
        const more = surface.buildNext();
        this.app.stage.invalidateOver();
        if (more) idle(build);
      };
    idle(build);
  }

  private async takeVolume(state: State): Promise<void> {
    const { store, stage, source } = this.app;
    if (!state.hasVolume) {
      this.replaceTexture(null);
      store.set({ volume: null, volumeReady: 0 });
      return;
    }
    let volume: Volume | null = null,
      texture: VolumeTexture | null = null,
      last = performance.now();
    const arrived = (bytes: Uint8Array, received: number): void => {
      if (volume === null) {
        if (received < 4 || received < headerEnd(bytes)) return;
        volume = new Volume(new Pack(bytes));
        texture = new VolumeTexture(stage.renderer, volume);
        this.replaceTexture(texture);
        store.set({ volume, volumeReady: 0, window: volume.meta.window as [number, number] });
        this.settle();
      }
      const slice = volume.size[0] * volume.size[1] * volume.bytesPerVoxel;
      volume.complete = Math.min(volume.size[2], Math.max(0, Math.floor((received - volume.begin) / slice)));
      const whole = volume.complete === volume.size[2],
        now = performance.now();
      if (!whole && now - last < kArriving) return; // each picture of what has arrived delays the rest
      last = now;
      const upload = (): void => {
        if (volume === null || this.texture !== texture) return;
        const more = texture!.upload();
        if (more) stage.next(upload);
        else {
          store.set({ volumeReady: volume.complete });
          stage.firstPicture ||= volume.complete === volume.size[2];
        }
        for (const each of this.slices) stage.invalidate(each);
      };
      stage.next(upload);
    };
    if ((await source.bytes("volume", {}, arrived)) === null || volume === null) return;
    stage.afterFirstPicture(() => idle(() => this.prepareCast(volume!)));
  }

  private replaceTexture(texture: VolumeTexture | null): void {
    this.texture?.dispose();
    this.texture = texture;
    this.scene.caster?.dispose();
    this.scene.caster = null;
    this.scene.texture = texture;
    for (const slice of this.slices) slice.texture = texture;
  }

  private prepareCast(volume: Volume): void {
    const { store, stage } = this.app;
    if (this.texture?.volume !== volume) return;
    const { low, high } = volume.histogram(256),
      window = volume.meta.window;
    this.scene.caster = new Caster(
      volume,
      reduce(
        volume,
        stage.software ? kCastSoftware : kCastHardware,
        Math.min(window[0], high),
        Math.max(window[1], low),
      ),
    );
    stage.invalidate(this.scene);
    store.set({ volumeReady: volume.size[2] });
  }

  private async takeDistance(surface: Surface): Promise<void> {
    const query: Record<string, string> =
      surface.kind === "quick" ? { quick: "1" } : { level: String(surface.level) };
    const pack = await this.pack("distance", query),
      distance = pack?.optional("distance", "f32") ?? null,
      { store } = this.app;
    if (store.get().surface !== surface) return;
    if (distance !== null && distance.length !== surface.radius.length) {
      this.seen.distance = "";
      return;
    } // of a finer one, which comes soon
    store.set({ distance, figures: (pack?.meta.figures as View["figures"]) ?? store.get().figures });
  }
}

function thickest(tree: Tree): number {
  let best = 0;
  for (let i = 1; i < tree.count; ++i) if (tree.radius[i] > tree.radius[best]) best = i;
  return best;
}

const kIdleBy = 300; // ms after which idle work is done anyway

export function idle(call: () => void): void {
  if ("requestIdleCallback" in window) window.requestIdleCallback(call, { timeout: kIdleBy });
  else setTimeout(call, 0);
}
