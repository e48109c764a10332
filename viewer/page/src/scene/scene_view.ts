// SPDX-License-Identifier: Apache-2.0
/** The 3D view: the surface or its stand-in, centerlines, points, the volume behind them, and letters over them. */
import { clearedContext } from "../overlay/over";
import { DoubleSide, FrontSide, Group, Mesh, Scene, Vector4, type Object3D, type WebGLRenderer } from "three";
import { OrbitCamera } from "../drawing/camera";
import { Caster } from "./cast";
import { Choice, voxelOf } from "./choice";
import { colouring } from "../model/colouring";
import { colourOf, isShown, opacityOf, shownTree, type Part, type View } from "../model/model";
import { kFade, PartMaterial } from "./part_material";
import { drawSceneOverlay } from "./scene_overlay";
import { cylinders, placeCylinders, type Cylinders } from "./node_cylinders";
import { ball, centerlines, wallPoints } from "./scene_parts";
import { SlicePlanes } from "./slice_planes";
import { ScenePicture, type Drawn } from "../drawing/scene_picture";
import type { StageView } from "../drawing/stage";
import type { Surface } from "../case/surface";
import type { Path } from "../base/store";
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { dot, scale } from "../base/vec";
import type { VolumeTexture } from "../drawing/volume_texture";

const kStill = 250, // ms after the last movement at which what is slow is drawn again in full
  kHeld = 1500; // ms, while a button of the pointer is down: a hand that turns stops for moments

/** The values on which centerlines and wall points depend. */
const kLines: readonly Path<View>[] = [
  "document.tree",
  "motion.posed",
  "scene.layers",
  "selection.hidden",
  "selection.solo",
  "selection.colours",
];

export class SceneView implements StageView {
  readonly camera = new OrbitCamera();
  readonly scene = new Scene();
  readonly over: HTMLCanvasElement;
  caster: Caster | null = null;
  private readonly picture = new ScenePicture();
  private readonly planes = new SlicePlanes();
  private walls: Mesh<Surface["parts"][number]["geometry"], PartMaterial>[] = [];
  private tubes: Cylinders[] = [];
  private tubesOf: Tree | null = null; // the tree whose nodes they lie at
  private readonly lines = new Group();
  private readonly points = new Group();
  private readonly marks = new Group();
  private readonly choice = new Choice();
  /** The model of one node alone: shown by another module. */
  readonly extra = new Group();
  private moving = 0;
  private isHeld = false;
  private marking = 0;
  private surface: Surface | null = null;
  private fitted = false;
  private touched = false; // the camera is no longer where all is shown
  texture: VolumeTexture | null = null;

  constructor(
    readonly element: HTMLElement,
    private readonly app: Part<keyof View, "stage">,
  ) {
    this.over = element.querySelector("canvas")!;
    this.scene.add(this.lines, this.points, this.marks, this.choice.place, this.extra, this.planes.group);
    const { store, stage } = app;
    const all = (paths: readonly Path<View>[], call: (view: View) => void): void => {
      store.watch(paths, view => {
        call(view);
        stage.invalidate(this);
      });
    };
    all(["document.surface"], view => this.setSurface(view));
    all(["document.tree"], view => this.setTubes(view));
    all(kLines, view => {
      this.setLines(view);
      this.setPoints(view);
    });
    store.watch(["motion.time"], () => this.busy());
    all(["document.state", "scene.layers"], view => this.setMarks(view));
    all(
      [
        ...kLines,
        "document.surface",
        "document.distance",
        "document.volumeReady",
        "selection.opacity",
        "selection.allOpacity",
        "scene",
        "slices.window",
        "page.theme",
      ],
      view => this.setLooks(view),
    );
    store.watch(["document.proposals", "selection.proposal", "scene.layers"], () =>
      stage.invalidateOver(this),
    );
    store.watch(["selection.selected", "selection.chosen", "selection.place"], view => {
      this.choice.follow(view, [...this.walls, ...this.tubes]);
      stage.invalidateChoice(this);
    });
    store.watch(["slices.crosshair", "slices.frame"], view => {
      if (!view.scene.clip.on && !view.scene.layers.slices) return;
      this.setLooks(view);
      this.marked();
    });
    store.watch(
      [
        "slices.crosshair",
        "selection.node",
        "tools.measurements",
        "tools.pending",
        "tools.clicks",
        "tools.tool",
      ],
      () => stage.invalidateOver(this),
    );
  }

  private replace(group: Group, objects: Object3D[]): void {
    for (const old of group.children as Mesh[]) {
      old.geometry?.dispose();
      (old.material as PartMaterial | undefined)?.dispose();
    }
    group.clear();
    if (objects.length > 0) group.add(...objects);
  }

  private setSurface(view: Pick<View, "document">): void {
    if (view.document.surface === this.surface) return;
    for (const wall of this.walls) {
      this.scene.remove(wall);
      wall.material.dispose();
    }
    this.surface?.dispose();
    this.surface = view.document.surface;
    this.walls = (view.document.surface?.parts ?? []).map((part, index) => {
      const wall = new Mesh(part.geometry, new PartMaterial(true));
      wall.frustumCulled = false;
      wall.userData.branch = part.branch;
      wall.userData.part = index;
      this.scene.add(wall);
      return wall;
    });
  }

  private setTubes(view: Pick<View, "document">): void {
    for (const tube of this.tubes) {
      this.scene.remove(tube);
      tube.geometry.dispose();
      tube.material.dispose();
    }
    this.tubesOf = view.document.tree;
    this.tubes =
      view.document.tree === null ? [] : cylinders(view.document.tree, this.app.stage.software ? 6 : 20);
    if (this.tubes.length > 0) this.scene.add(...this.tubes);
    if (!this.fitted) this.fit();
  }
  private setLines(view: Pick<View, "document" | "selection" | "motion" | "scene">): void {
    this.replace(
      this.lines,
      view.document.tree !== null && view.scene.layers.lines ? [centerlines(view)] : [],
    );
  }
  private setPoints(view: Pick<View, "document" | "selection" | "motion" | "scene">): void {
    const points = view.document.tree !== null && view.scene.layers.points ? wallPoints(view) : null;
    this.replace(this.points, points === null ? [] : [points]);
  }

  private setMarks(view: Pick<View, "document" | "scene">): void {
    const marks: Object3D[] = [],
      least = voxelOf(view);
    if (view.scene.layers.seeds)
      for (const seed of view.document.state.seeds)
        for (const point of seed.points)
          marks.push(
            ball(
              point.position,
              Math.max(point.radius_mm ?? 0, 1.5 * least),
              seed.tracked ? [0.49, 0.83, 0.66] : [1, 0.82, 0.4],
              seed.tracked ? 0.5 : 0.9,
            ),
          );
    this.replace(this.marks, marks);
  }

  /** The plane that cuts away what is nearer than the crosshair; zero if it is off. */
  private clip(view: Pick<View, "slices" | "scene">): Vector4 {
    if (!view.scene.clip.on) return new Vector4(0, 0, 0, 0);
    const n: Vec3 = scale(view.slices.frame.normal, view.scene.clip.flip ? -1 : 1);
    return new Vector4(...n, -dot(n, view.slices.crosshair));
  }

  private setLooks(view: View): void {
    const clip = this.clip(view),
      { mapped, range, map } = colouring(view),
      asTubes = view.document.surface === null || view.scene.layers.nodes;
    const shown = shownTree(view);
    if (asTubes && shown !== this.tubesOf && shown?.branches.length === this.tubes.length) {
      placeCylinders(this.tubes, shown);
      this.tubesOf = shown;
    }
    if (view.document.tree !== null && this.tubes.length === view.document.tree.branches.length)
      this.tubes.forEach((tube, branch) => {
        const alpha = opacityOf(view, branch);
        tube.visible =
          asTubes &&
          isShown(view, branch) &&
          alpha > 0 &&
          (view.scene.layers.nodes || view.scene.layers.surface);
        tube.material.look({
          own: colourOf(view, branch),
          alpha,
          clip,
        });
      });
    for (const wall of this.walls) {
      const branch = wall.userData.branch as number,
        alpha = branch < 0 ? view.selection.allOpacity : opacityOf(view, branch);
      wall.visible =
        view.scene.layers.surface && !view.scene.layers.nodes && isShown(view, branch) && alpha > 0;
      const own: [number, number, number] = branch < 0 ? [0.75, 0.72, 0.68] : colourOf(view, branch);
      wall.material.look({
        own,
        alpha,
        mapped,
        range,
        map,
        clip,
      });
      wall.renderOrder = alpha < 1 ? 2 : 0;
    }
    for (const child of this.points.children)
      ((child as Mesh).material as PartMaterial).uniforms.clip.value = clip;
    this.planes.update(view, this.texture);
    this.choice.follow(view, [...this.walls, ...this.tubes]);
  }

  /** Shows everything that there is. */
  fit(): void {
    const { tree, volume } = this.app.store.get().document,
      box = tree?.box() ?? null;
    if (box !== null) this.camera.fit(box.low, box.high);
    else if (volume !== null) {
      const corners = volume.corners(),
        pick = (f: (...x: number[]) => number): Vec3 =>
          [0, 1, 2].map(a => f(...corners.map(c => c[a]))) as Vec3;
      this.camera.fit(pick(Math.min), pick(Math.max));
    } else return;
    this.fitted = true;
    this.touched = false;
    this.app.stage.invalidate(this);
  }

  /** A mark moved, which the overlay shows at once. The scene follows; without a graphics processor when the marks rest. */
  private marked(): void {
    const { stage } = this.app;
    stage.invalidateOver(this);
    if (!stage.software) {
      stage.invalidate(this);
      return;
    }
    window.clearTimeout(this.marking);
    this.marking = window.setTimeout(() => stage.invalidate(this), kStill);
  }

  /** The camera moved: coarse pictures of the volume until it rests. */
  moved(): void {
    this.touched = true;
    this.busy();
  }

  /** Something of the scene moves. */
  private busy(): void {
    window.clearTimeout(this.moving);
    this.moving = window.setTimeout(() => this.rest(), this.isHeld ? kHeld : kStill);
    this.app.stage.invalidate(this);
  }

  get isMoving(): boolean {
    return this.moving !== 0;
  }

  /** A button of the pointer is down on the view, or no longer. */
  hold(isDown: boolean): void {
    this.isHeld = isDown;
    if (isDown || this.moving === 0) return;
    window.clearTimeout(this.moving);
    this.moving = window.setTimeout(() => this.rest(), kStill);
  }

  /** Draws in full, unless another movement comes before the next frame: those wait for a slow picture. */
  private rest(): void {
    const before = this.moving;
    requestAnimationFrame(() => {
      if (this.moving !== before) return;
      this.moving = 0;
      this.app.stage.invalidate(this);
    });
  }

  /** Fewer triangles while pictures are coarse, and nothing of what walls hide: their far sides and the centerlines. */
  private chooseDetail(coarse: boolean, view: Pick<View, "scene">): void {
    const isSeenFromOutside =
      coarse &&
      !view.scene.clip.on &&
      this.camera.flight === null &&
      this.walls.some(wall => wall.visible) &&
      this.walls.every(wall => !wall.visible || !wall.material.transparent);
    this.lines.visible = !isSeenFromOutside;
    for (const wall of this.walls) {
      wall.material.side = isSeenFromOutside || wall.material.transparent ? FrontSide : DoubleSide;
      const { geometry, moving } = this.surface!.parts[wall.userData.part as number];
      wall.geometry = coarse && moving !== null ? moving : geometry;
    }
  }

  draw(renderer: WebGLRenderer, width: number, height: number): void {
    const view = this.app.store.get(),
      resized = width !== this.camera.width || height !== this.camera.height;
    this.camera.update(width, height);
    if (!this.fitted || (resized && !this.touched)) this.fit();
    const camera = this.camera.update(width, height),
      coarse = this.isCoarse();
    this.chooseDetail(coarse, view);
    kFade.value = this.camera.flight === null ? 0 : this.camera.flight.fade;
    this.picture.draw(renderer, [width, height], coarse, {
      all: () => {
        if (view.scene.cast !== "off" && this.caster !== null)
          this.cast(this.caster, renderer, [width, height]);
        renderer.render(this.scene, camera);
      },
      ...this.chosen(renderer),
    });
  }

  drawChoice(renderer: WebGLRenderer, width: number, height: number): void {
    if (!this.picture.isKept) {
      this.draw(renderer, width, height);
      return;
    }
    this.picture.draw(renderer, [width, height], false, {
      all: null,
      ...this.chosen(renderer),
    });
  }

  /** What stands out: in a flight nothing, as the eye is inside of it. */
  private chosen(renderer: WebGLRenderer): Omit<Drawn, "all"> {
    const { camera, flight } = this.camera;
    return flight !== null
      ? { chosen: null, isRestFaint: false }
      : this.choice.drawn(renderer, this.scene, camera, this.app.store.get());
  }

  /** The volume, as the ground of what follows. */
  private cast(caster: Caster, renderer: WebGLRenderer, size: [number, number]): void {
    const view = this.app.store.get(),
      { software } = this.app.stage,
      moving = this.moving !== 0;
    caster.draw(
      renderer,
      this.camera.camera,
      this.camera.isParallel && this.camera.flight === null,
      size,
      moving ? (software ? 0.22 : 0.6) : software ? 0.5 : 1,
      view.slices.window,
      view.scene.cast === "volume",
      this.clip(view),
      moving || software ? 1 : 0.6,
    );
  }

  /** Whether pictures are coarse: the scene moves, and no graphics processor draws it. */
  private isCoarse(): boolean {
    return this.moving !== 0 && this.app.stage.software;
  }

  drawOver(width: number, height: number): void {
    const c = clearedContext(this.over, width, height);
    drawSceneOverlay(c, this.camera, this.app.store.get(), width, height);
  }
}
