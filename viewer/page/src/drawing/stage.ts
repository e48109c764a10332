// SPDX-License-Identifier: Apache-2.0
/** One WebGL canvas behind all views: a view draws into its own rectangle, and only when it has changed. */
import { Color, WebGLRenderer } from "three";

export interface StageView {
  readonly element: HTMLElement;
  /** Draws into the current viewport of that size in CSS pixels. */
  draw(renderer: WebGLRenderer, width: number, height: number): void;
  /** As `draw`, where nothing but the choice has changed since. */
  drawChoice?(renderer: WebGLRenderer, width: number, height: number): void;
  /** Draws lines and letters over it, on a 2D canvas. */
  drawOver?(width: number, height: number): void;
}

const kFirstPicture = "lumen-first-picture";

export class Stage {
  readonly renderer: WebGLRenderer;
  /** Without a graphics processor: everything costs, so levels of detail and resolutions are lower. */
  readonly software: boolean;
  private readonly views: StageView[] = [];
  private readonly dirty = new Set<StageView>();
  private readonly dirtyOver = new Set<StageView>();
  private readonly dirtyChoice = new Set<StageView>();
  private clearAll = true; // also the space between views
  private scheduled = false;
  private readonly frames: (() => void)[] = [];
  private readonly afterwards: (() => void)[] = [];
  private seen = false;
  /** Set when there is something to see; the next frame is the first picture, and marked as such for measuring. */
  firstPicture = false;

  /** Throws if there is no WebGL 2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext("webgl2", {
      antialias: false, // the 3D view smooths its own edges, and slices have none
      alpha: false,
      preserveDrawingBuffer: true,
      powerPreference: "high-performance",
    });
    if (context === null)
      throw new Error(
        "This browser has no WebGL 2, which the viewer draws with. Switch on hardware acceleration, or start Chromium with --enable-unsafe-swiftshader.",
      );
    const info = context.getExtension("WEBGL_debug_renderer_info");
    const name = String(
      context.getParameter(info === null ? context.RENDERER : info.UNMASKED_RENDERER_WEBGL),
    );
    this.software = /swiftshader|llvmpipe|software|basic render/i.test(name);
    this.renderer = new WebGLRenderer({ canvas, context, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(this.software ? 1 : Math.min(window.devicePixelRatio, 2));
    this.renderer.debug.checkShaderErrors = false; // asking waits until each shader is compiled, before anything is fetched
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
  }

  add(view: StageView): void {
    this.views.push(view);
    new ResizeObserver(() => this.invalidate(view)).observe(view.element);
  }

  /** Draws a view, or all of them, with the next frame. */
  invalidate(view?: StageView): void {
    if (view === undefined) {
      for (const each of this.views) this.dirty.add(each);
      this.clearAll = true;
    } else this.dirty.add(view);
    this.schedule();
  }

  /** Draws what is chosen in a view anew, over its picture of all. */
  invalidateChoice(view: StageView): void {
    this.dirtyChoice.add(view);
    this.schedule();
  }

  /** Draws only the overlay of a view, or of all views. */
  invalidateOver(view?: StageView): void {
    for (const each of view === undefined ? this.views : [view]) this.dirtyOver.add(each);
    this.schedule();
  }

  /** Calls before the next frame is drawn. */
  next(call: () => void): void {
    this.frames.push(call);
    this.schedule();
  }

  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => this.frame());
  }

  private resize(): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    this.renderer.setSize(box.width, box.height, false);
    this.invalidate();
  }

  private frame(): void {
    this.scheduled = false;
    for (const call of this.frames.splice(0)) call();
    const views = new Set([...this.dirty, ...this.dirtyChoice]),
      whole = new Set(this.dirty),
      all = this.canvas.getBoundingClientRect();
    this.dirty.clear();
    this.dirtyChoice.clear();
    if (this.clearAll) {
      this.renderer.setScissorTest(false);
      this.renderer.setClearColor(0x1c222b, 1);
      this.renderer.clear();
    }
    this.clearAll = false;
    this.renderer.setScissorTest(true); // uploads reset it
    for (const view of views) {
      const box = view.element.getBoundingClientRect();
      if (box.width < 1 || box.height < 1) continue;
      const y = all.bottom - box.bottom,
        x = box.left - all.left;
      this.renderer.setViewport(x, y, box.width, box.height);
      this.renderer.setScissor(x, y, box.width, box.height);
      this.renderer.setClearColor(new Color(0x07090c), 1);
      this.renderer.clear();
      if (whole.has(view) || view.drawChoice === undefined) view.draw(this.renderer, box.width, box.height);
      else view.drawChoice(this.renderer, box.width, box.height);
      view.drawOver?.(box.width, box.height);
      this.dirtyOver.delete(view);
    }
    for (const view of this.dirtyOver) {
      const box = view.element.getBoundingClientRect();
      if (box.width >= 1 && box.height >= 1) view.drawOver?.(box.width, box.height);
    }
    this.dirtyOver.clear();
    if (this.firstPicture && !this.seen) this.markFirstPicture();
  }

  private markFirstPicture(): void {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    performance.mark(kFirstPicture);
    this.seen = true;
    for (const call of this.afterwards.splice(0)) call();
  }

  /** Calls back when the first picture is there, for work that can wait for it. */
  afterFirstPicture(call: () => void): void {
    if (this.seen) call();
    else this.afterwards.push(call);
  }

  /** The picture of all views with their overlays. */
  picture(over: HTMLCanvasElement[], legends: HTMLElement[], background: string): HTMLCanvasElement {
    const out = document.createElement("canvas"),
      all = this.canvas.getBoundingClientRect(),
      ratio = this.canvas.width / all.width;
    out.width = this.canvas.width;
    out.height = this.canvas.height;
    const c = out.getContext("2d")!;
    c.fillStyle = background;
    c.fillRect(0, 0, out.width, out.height);
    c.drawImage(this.canvas, 0, 0);
    for (const layer of over) drawWhereItIs(c, layer, all, ratio);
    for (const legend of legends) if (!legend.hidden) drawLegend(c, legend, all, ratio);
    return out;
  }
}

/** A canvas at its place on the page; nothing if it is not shown. */
function drawWhereItIs(
  c: CanvasRenderingContext2D,
  drawn: HTMLCanvasElement,
  all: DOMRect,
  ratio: number,
): void {
  const { left, top, width, height } = drawn.getBoundingClientRect();
  if (width > 0)
    c.drawImage(drawn, (left - all.left) * ratio, (top - all.top) * ratio, width * ratio, height * ratio);
}

/** A legend's scale and words, where they are on the page. */
function drawLegend(c: CanvasRenderingContext2D, legend: HTMLElement, all: DOMRect, ratio: number): void {
  const bar = legend.querySelector("canvas");
  if (bar !== null) drawWhereItIs(c, bar, all, ratio);
  c.textBaseline = "middle";
  for (const word of legend.querySelectorAll("strong, span")) {
    const box = word.getBoundingClientRect(),
      style = getComputedStyle(word);
    c.font = `${style.fontWeight} ${parseFloat(style.fontSize) * ratio}px ${style.fontFamily}`;
    c.fillStyle = "#e8edf4";
    c.fillText(word.textContent, (box.left - all.left) * ratio, (box.top + box.height / 2 - all.top) * ratio);
  }
}
