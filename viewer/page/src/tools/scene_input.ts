// SPDX-License-Identifier: Apache-2.0
/** Pointer and keys in the 3D view. Drag turns, with shift or the middle button moves, the wheel comes nearer; a click
 * picks a vessel or uses the tool. */
import type { Part } from "../model/model";
import type { SceneView } from "../scene/scene_view";
import { shiftWindow } from "./slice_input";
import type { Tools } from "./tools";

const kClick = 4; // pixels that a click may move
const kTurn = 0.008; // radians for a pixel
const kZoomStep = 1.0012;

export function listenToScene(scene: SceneView, app: Part<"slices">, tools: Tools): void {
  const { element, camera } = scene;
  let drag: { kind: "turn" | "pan" | "window"; x: number; y: number; far: number } | null = null;
  let pointers = 0;
  const place = (e: MouseEvent): { x: number; y: number } => {
    const box = element.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  };
  element.addEventListener("pointerdown", e => {
    if ((e.target as HTMLElement).closest("button, input, select, .legend") !== null) return;
    element.focus({ preventScroll: true });
    element.setPointerCapture(e.pointerId);
    ++pointers;
    scene.hold(true);
    const { x, y } = place(e);
    drag = {
      kind:
        e.button === 1 || (e.button === 0 && e.shiftKey) || pointers > 1
          ? "pan"
          : e.button === 2
            ? "window"
            : "turn",
      x,
      y,
      far: 0,
    };
    e.preventDefault();
  });
  element.addEventListener("pointermove", e => {
    const { x, y } = place(e);
    if (drag === null) {
      tools.hoverScene(scene, x, y);
      return;
    }
    const dx = x - drag.x,
      dy = y - drag.y;
    if (drag.far + Math.hypot(dx, dy) > kClick) {
      if (drag.kind === "turn") camera.turn(dx * kTurn, dy * kTurn);
      else if (drag.kind === "pan") camera.pan(dx, dy);
      else shiftWindow(app, dx, dy);
      scene.moved();
    }
    drag = { ...drag, x, y, far: drag.far + Math.hypot(dx, dy) };
  });
  const end = (e: PointerEvent): void => {
    pointers = Math.max(0, pointers - 1);
    scene.hold(pointers > 0);
    if (drag !== null && drag.kind !== "window" && drag.far <= kClick && e.type === "pointerup")
      tools.clickInScene(scene, drag.x, drag.y, 1);
    drag = null;
  };
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  element.addEventListener("pointerleave", () => tools.leave());
  element.addEventListener("contextmenu", e => e.preventDefault());
  element.addEventListener("dblclick", e => {
    const { x, y } = place(e);
    tools.centreInScene(scene, x, y);
  });
  element.addEventListener(
    "wheel",
    e => {
      const { x, y } = place(e);
      if (!tools.wheelInScene(Math.sign(e.deltaY))) {
        camera.zoom(kZoomStep ** e.deltaY, x, y);
        scene.moved();
      }
      e.preventDefault();
    },
    { passive: false },
  );
  element.addEventListener("keydown", e => {
    const isOnControl = (e.target as HTMLElement).closest("button, input, select") !== null; // has keys of its own
    if (isOnControl || e.altKey || e.metaKey || e.ctrlKey || !sceneKey(scene, tools, e)) return;
    scene.moved();
    e.preventDefault();
    e.stopPropagation();
  });
}

function sceneKey(scene: SceneView, tools: Tools, e: KeyboardEvent): boolean {
  const { camera } = scene,
    step = 0.1,
    pixels = 25;
  if (tools.keyInScene(e.key)) return true;
  const go = (x: number, y: number): boolean => {
    if (e.shiftKey) camera.pan(x * pixels, y * pixels);
    else camera.turn(x * step, y * step);
    return true;
  };
  switch (e.key) {
    case "ArrowLeft":
      return go(-1, 0);
    case "ArrowRight":
      return go(1, 0);
    case "ArrowUp":
      return go(0, -1);
    case "ArrowDown":
      return go(0, 1);
    case "+":
    case "=":
      camera.zoom(0.85);
      return true;
    case "-":
      camera.zoom(1 / 0.85);
      return true;
    case "0":
      scene.fit();
      return true;
    case "Enter":
      if (tools.areClicksWaiting()) return false; // it finishes them
      tools.clickInScene(scene, camera.width / 2, camera.height / 2, 1);
      return true;
    default:
      return false;
  }
}
