// SPDX-License-Identifier: Apache-2.0
/** Pointer and keys in a slice. Left: the tool (or the crosshair); right: window and level; middle or shift: pan; wheel:
 * slices, with control zoom; control and left: turns the planes. */
import { isSecondAt } from "../model/beside";
import { kFirst, kPatientFrame, kSecond, type Part, type VolumeKeys } from "../model/model";
import { slabKey } from "../slices/slice_controls";
import type { SliceView } from "../slices/slice_view";
import type { Tools } from "./tools";
import type { Vec3 } from "../base/types";
import { rotate, type Frame } from "../base/vec";

/** What these functions take of the page. */
type Needs = Part<"document" | "slices", "stage">;

function turnFrame(frame: Frame, axis: Vec3, angle: number): Frame {
  return {
    right: rotate(frame.right, axis, angle),
    up: rotate(frame.up, axis, angle),
    normal: rotate(frame.normal, axis, angle),
  };
}

/** Turns the shared planes about an axis; they are then neither the patient's nor the vessel's. */
export function turnPlanes(app: Part<"slices">, axis: Vec3, angle: number): void {
  app.store.set({ slices: { planes: "free", frame: turnFrame(app.store.get().slices.frame, axis, angle) } });
}
export const resetPlanes = (app: Part<"slices">): void =>
  app.store.set({ slices: { planes: "patient", frame: kPatientFrame } });

const kWindowStep = 1 / 300; // of the window for a pixel
const kZoomStep = 1.0015; // for a unit of the wheel

export function shiftWindow(app: Part<"slices">, dx: number, dy: number, keys: VolumeKeys = kFirst): void {
  const [low, high] = app.store.get().slices[keys.window],
    width = Math.max(high - low, 1e-6);
  const wider = width * Math.exp(dx * kWindowStep * 2),
    level = (low + high) / 2 + dy * kWindowStep * width;
  app.store.set({ slices: { [keys.window]: [level - wider / 2, level + wider / 2] } });
}

export function listenToSlice(slice: SliceView, app: Needs, tools: Tools): void {
  const element = slice.element,
    { store, stage } = app;
  let drag: {
    kind: "tool" | "window" | "pan" | "turn";
    x: number;
    y: number;
    angle: number;
    window: VolumeKeys; // the volume that is seen where a drag begins
  } | null = null;
  const place = (e: MouseEvent): { x: number; y: number } => {
    const box = element.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  };
  const angleAt = (x: number, y: number): number => {
    const c = slice.toPixel(store.get().slices.crosshair);
    return Math.atan2(c.y - y, x - c.x);
  };
  element.addEventListener("pointerdown", e => {
    if ((e.target as HTMLElement).closest("button, input, select") !== null) return;
    element.focus({ preventScroll: true });
    element.setPointerCapture(e.pointerId);
    const { x, y } = place(e),
      left = e.button === 0;
    const kind =
      e.button === 1 || (left && e.shiftKey)
        ? "pan"
        : e.button === 2
          ? "window"
          : left && (e.ctrlKey || e.metaKey)
            ? "turn"
            : "tool";
    const window = isSecondAt(store.get(), x / Math.max(element.clientWidth, 1)) ? kSecond : kFirst;
    drag = { kind, x, y, angle: angleAt(x, y), window };
    if (kind === "tool") tools.pressInSlice(slice, slice.toPosition(x, y));
    e.preventDefault();
  });
  element.addEventListener("pointermove", e => {
    const { x, y } = place(e);
    tools.hover(slice.picked(slice.toPosition(x, y)));
    if (drag === null) {
      tools.hoverInSlice(slice, slice.toPosition(x, y));
      return;
    }
    const dx = x - drag.x,
      dy = y - drag.y;
    if (drag.kind === "pan") slice.panBy(dx, dy);
    else if (drag.kind === "window") shiftWindow(app, dx, dy, drag.window);
    else if (drag.kind === "turn") {
      const angle = angleAt(x, y);
      turnPlanes(app, slice.frame.normal, angle - drag.angle);
      drag.angle = angle;
    } else tools.dragInSlice(slice, slice.toPosition(x, y));
    drag = { ...drag, x, y };
  });
  const end = (): void => {
    if (drag?.kind === "tool") tools.releaseInSlice(slice);
    drag = null;
  };
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  element.addEventListener("pointerleave", () => {
    if (drag === null) tools.leaveSlice();
    tools.leave();
  });
  element.addEventListener("contextmenu", e => e.preventDefault());
  element.addEventListener("dblclick", () => slice.fit());
  element.addEventListener(
    "wheel",
    e => {
      const { x, y } = place(e);
      if (e.shiftKey && tools.wheelInSlice(slice, slice.toPosition(x, y), -Math.sign(e.deltaY + e.deltaX))) {
        e.preventDefault();
        return;
      }
      if (e.ctrlKey || e.metaKey) slice.zoomBy(kZoomStep ** e.deltaY, x, y);
      else slice.step(-Math.sign(e.deltaY));
      e.preventDefault();
    },
    { passive: false },
  );
  element.addEventListener("keydown", e => {
    if (!sliceKey(slice, app, tools, e)) return;
    e.preventDefault();
    e.stopPropagation();
    stage.invalidate(slice);
  });
}

/** Handles a key in a slice; false if it has no meaning there. */
function sliceKey(slice: SliceView, app: Needs, tools: Tools, e: KeyboardEvent): boolean {
  const { store } = app,
    f = slice.frame,
    {
      slices: { crosshair },
      document: { volume },
    } = store.get();
  if (e.altKey || e.metaKey) return false;
  const each = (e.shiftKey ? 5 : 1) * (volume === null ? 0.5 : Math.min(...volume.spacing));
  const go = (d: Vec3, s: number): boolean => {
    slice.moveCrosshair(d, s * each);
    return true;
  };
  const turn = (angle: number): boolean => {
    turnPlanes(app, f.normal, angle);
    return true;
  };
  switch (e.key) {
    case "ArrowLeft":
      return e.ctrlKey ? turn(0.05) : go(f.right, -1);
    case "ArrowRight":
      return e.ctrlKey ? turn(-0.05) : go(f.right, 1);
    case "ArrowUp":
      return go(f.up, 1);
    case "ArrowDown":
      return go(f.up, -1);
    case "PageUp":
      slice.step(e.shiftKey ? 5 : 1);
      return true;
    case "PageDown":
      slice.step(e.shiftKey ? -5 : -1);
      return true;
    case "+":
    case "=":
      slice.zoomBy(0.8);
      return true;
    case "-":
      slice.zoomBy(1.25);
      return true;
    case "0":
      slice.fit();
      return true;
    case "Enter":
    case " ":
      if (e.key === "Enter" && tools.areClicksWaiting()) return false; // it finishes them
      tools.pressInSlice(slice, crosshair);
      tools.releaseInSlice(slice);
      return true;
    default:
      return slabKey(app, slice.name, e.key);
  }
}
