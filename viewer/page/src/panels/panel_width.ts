// SPDX-License-Identifier: Apache-2.0
/** The edge of the list of vessels, which makes it wider by the pointer or the arrow keys. */
import { h } from "../base/ui";

export const kWidths = { least: 240, usual: 300, most: 640 } as const; // px
const kStep = 20, // px of an arrow key
  kKept = "lumen-list-width";

/** A width in px that leaves names and views their room; the usual one for a text that is no number. */
export function widthOf(text: string | null): number {
  const width = text === null || text.trim() === "" ? NaN : Number(text);
  return Number.isFinite(width)
    ? Math.min(kWidths.most, Math.max(kWidths.least, Math.round(width)))
    : kWidths.usual;
}

function keptWidth(): string | null {
  try {
    return localStorage.getItem(kKept);
  } catch {
    return null; // a page from disk may keep nothing
  }
}

/** Makes the panel as wide as it was left, and gives the edge that changes it; `changed` is called with each width. */
export function panelEdge(panel: HTMLElement, changed: () => void): HTMLElement {
  const edge = h("div", {
    class: "edge",
    id: "panel-edge",
    role: "separator",
    tabindex: 0,
    title: "Wider or narrower: drag, or arrow keys",
    "aria-label": "Width of the list of vessels",
    "aria-orientation": "vertical",
    "aria-valuemin": kWidths.least,
    "aria-valuemax": kWidths.most,
  });
  let width = 0;
  const set = (wanted: number): void => {
    width = widthOf(String(wanted));
    panel.style.width = `${width}px`;
    edge.setAttribute("aria-valuenow", String(width));
    changed();
  };
  const keep = (): void => {
    try {
      localStorage.setItem(kKept, String(width));
    } catch {
      /* a page from disk may keep nothing */
    }
  };
  set(widthOf(keptWidth()));
  edge.addEventListener("pointerdown", e => {
    edge.setPointerCapture(e.pointerId);
    e.preventDefault();
  });
  edge.addEventListener("pointermove", e => {
    if (edge.hasPointerCapture(e.pointerId)) set(e.clientX - panel.getBoundingClientRect().left);
  });
  edge.addEventListener("pointerup", keep);
  edge.addEventListener("dblclick", () => {
    set(kWidths.usual);
    keep();
  });
  edge.addEventListener("keydown", e => {
    const by = { ArrowLeft: -kStep, ArrowRight: kStep }[e.key];
    if (by === undefined) return;
    e.preventDefault();
    e.stopPropagation();
    set(width + by);
    keep();
  });
  return edge;
}
