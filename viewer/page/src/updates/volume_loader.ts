// SPDX-License-Identifier: Apache-2.0
/** Fetches one volume of the document and shows its slices as they arrive. */
import { Caster } from "../scene/cast";
import type { kLabels, Part, VolumeKeys } from "../model/model";
import { headerEnd, Pack } from "../case/pack";
import type { SceneView } from "../scene/scene_view";
import type { SliceView } from "../slices/slice_view";
import { idle } from "../base/ui";
import { reduce, Volume } from "../case/volume";
import { VolumeTexture } from "../drawing/volume_texture";

const kArriving = 500; // ms from one picture of a volume that is arriving to the next
const kCastSoftware = 128,
  kCastHardware = 256; // texels along an axis for ray casting

export class VolumeLoader {
  private texture: VolumeTexture | null = null;

  /** With a scene, which the first volume has, the volume is also cast in 3D. `began`: called when its header is there. */
  constructor(
    private readonly app: Part<"document" | "slices", "source" | "stage">,
    private readonly keys: VolumeKeys | typeof kLabels,
    private readonly slices: SliceView[],
    private readonly scene: SceneView | null = null,
    private readonly began: () => void = () => undefined,
  ) {}

  /** Fetches the volume as it is now, or drops it. */
  async take(isThere: boolean): Promise<void> {
    const { stage, source } = this.app;
    if (!isThere) {
      this.replaceTexture(null);
      this.set(null, 0);
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
        this.set(volume, 0, volume.meta.window as [number, number]);
        this.began();
      }
      const slice = volume.size[0] * volume.size[1] * volume.bytesPerVoxel;
      volume.complete = Math.min(volume.size[2], Math.max(0, Math.floor((received - volume.begin) / slice)));
      const whole = volume.complete === volume.size[2],
        now = performance.now();
      if (!whole && now - last < kArriving) return; // each picture of what has arrived delays the rest
      last = now;
      this.upload(volume, texture!);
    };
    if ((await source.bytes(this.keys.volume, {}, arrived)) === null || volume === null) return;
    if (this.scene !== null) stage.afterFirstPicture(() => idle(() => this.prepareCast(volume!)));
  }

  private set(volume: Volume | null, ready: number, window?: [number, number]): void {
    const { keys } = this;
    this.app.store.set({
      document: { [keys.volume]: volume, [keys.ready]: ready },
      slices: window === undefined || keys.window === null ? {} : { [keys.window]: window },
    });
  }

  /** Hands slices that are complete to the graphics, a part of them with each picture. */
  private upload(volume: Volume, texture: VolumeTexture): void {
    const { stage, store } = this.app;
    stage.next(() => {
      if (this.texture !== texture) return;
      if (texture.upload()) this.upload(volume, texture);
      else {
        store.set({ document: { [this.keys.ready]: volume.complete } });
        stage.firstPicture ||= volume.complete === volume.size[2];
      }
      for (const each of this.slices) stage.invalidate(each);
    });
  }

  private replaceTexture(texture: VolumeTexture | null): void {
    this.texture?.dispose();
    this.texture = texture;
    for (const slice of this.slices) slice[this.keys.texture] = texture;
    if (this.scene === null) return;
    this.scene.caster?.dispose();
    this.scene.caster = null;
    this.scene.texture = texture;
  }

  private prepareCast(volume: Volume): void {
    const { store, stage } = this.app,
      { scene } = this;
    if (scene === null || this.texture?.volume !== volume) return;
    const { low, high } = volume.histogram(256),
      window = volume.meta.window;
    scene.caster = new Caster(
      volume,
      reduce(
        volume,
        stage.software ? kCastSoftware : kCastHardware,
        Math.min(window[0], high),
        Math.max(window[1], low),
      ),
    );
    stage.invalidate(scene);
    store.set({ document: { volumeReady: volume.size[2] } });
  }
}
