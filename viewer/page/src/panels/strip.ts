// SPDX-License-Identifier: Apache-2.0
/** Under the views: radius along the selected vessel with a cursor, and the vessel laid straight. */
import type { Actions } from "./actions";
import { toCss } from "../base/colour";
import type { Flight } from "../scene/flight";
import { colourOf, type CursorPart, type View } from "../model/model";
import { findPlaces, reference, type Place } from "../case/narrowing";
import { followVessel, goToNode, stepAlong } from "../model/selection";
import { clearedContext, niceLength } from "../overlay/over";
import { reformat, straighten, type Straight } from "../case/straightened";
import { brief, button, h, slider } from "../base/ui";

interface Curve {
  branch: number;
  tree: View["document"]["tree"];
  nodes: number[];
  s: number[];
  r: number[];
  places: Place[];
  reference: Float64Array;
}

const kLeft = 34,
  kRight = 10,
  kTop = 8,
  kBottom = 18; // pixels around the plot

export class Strip {
  private readonly plot = h("canvas", {
    class: "plot",
    id: "radius-plot",
    tabindex: 0,
    role: "slider",
    "aria-label": "Position along the vessel",
    title: "Click or use the arrow keys to move the cursor along the vessel",
  });
  private readonly image = h("canvas", {
    class: "cpr",
    id: "straightened",
    role: "img",
    "aria-label": "The vessel laid straight",
    title: "The volume along the vessel, laid straight; click to go there",
  });
  private readonly name = h("strong", { id: "strip-name" });
  private readonly figures = h("span", { class: "note", id: "strip-figures" });
  private readonly places = h("span", { class: "places", id: "places" });
  private curve: Curve | null = null;
  private straight: Straight | null = null;
  private turn = 0;
  private scheduled = false;

  constructor(
    readonly element: HTMLElement,
    private readonly app: CursorPart<"page">,
    actions: Pick<Actions, "fly">,
    flight: Flight,
  ) {
    const seek = slider("flight-position", "Position of the flight", [0, 1, 0.001], 0, value =>
      flight.seek(value),
    );
    const pause = button(
      { icon: "play", label: "Pause or go on with the flight", id: "flight-pause", class: "button" },
      () => flight.pause(),
    );
    const controls = h(
      "span",
      { class: "row flight", hidden: true },
      pause,
      seek,
      button({ icon: "close", label: "End the flight", class: "button", id: "flight-end" }, () =>
        flight.stop(),
      ),
    );
    flight.onChange = () => {
      controls.hidden = !flight.running;
      seek.value = String(flight.share);
    };
    element.append(
      h(
        "div",
        { class: "striphead" },
        this.name,
        this.figures,
        this.places,
        h("span", { class: "spring" }),
        controls,
        button(
          {
            icon: "section",
            label: "Slices across and along this vessel",
            key: "Q",
            id: "follow",
            class: "button",
          },
          () => followVessel(app),
        ),
        button({ icon: "flight", label: "Fly through this vessel", key: "F", class: "button" }, () =>
          actions.fly(),
        ),
        h(
          "label",
          { class: "line turn" },
          "Turn",
          slider(
            "cpr-turn",
            "Turn the straightened view about the vessel, degrees",
            [0, 180, 1],
            0,
            value => {
              this.turn = (value * Math.PI) / 180;
              this.draw();
            },
          ),
        ),
        button(
          { icon: "close", label: "Close this strip", key: "B", class: "button", id: "strip-close" },
          () => app.store.set({ page: { strip: false } }),
        ),
      ),
      h("div", { class: "stripbody" }, this.plot, this.image),
    );
    for (const canvas of [this.plot, this.image]) {
      const to = (e: PointerEvent): void => this.go(e.clientX - canvas.getBoundingClientRect().left);
      canvas.addEventListener("pointerdown", e => {
        canvas.setPointerCapture(e.pointerId);
        to(e);
      });
      canvas.addEventListener("pointermove", e => {
        if (e.buttons === 1) to(e);
      });
    }
    this.plot.addEventListener("keydown", e => {
      const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[e.key];
      if (step === undefined) return;
      stepAlong(app, step);
      e.preventDefault();
      e.stopPropagation();
    });
    new ResizeObserver(() => this.draw()).observe(element);
    app.store.watch(["document.tree", "selection.selected", "page.strip"], view => this.take(view));
    app.store.watch(
      [
        "selection.node",
        "document.volume",
        "document.volumeReady",
        "slices.window",
        "selection.colours",
        "page.theme",
      ],
      () => this.draw(),
    );
  }

  private take(view: Pick<View, "document" | "selection" | "page">): void {
    const shown = view.page.strip && view.document.tree !== null && view.selection.selected >= 0;
    this.element.hidden = !shown;
    this.straight = null;
    if (!shown) {
      this.curve = null;
      return;
    }
    const tree = view.document.tree!,
      b = tree.branches[view.selection.selected],
      nodes = Array.from({ length: b.node_count }, (_, i) => b.first_node + i),
      s = tree.alongOf(b),
      r = nodes.map(n => tree.radius[n]),
      places = b.kind === "vessel" ? findPlaces(s, r, view.document.tree?.voxelSize ?? 0) : [];
    this.curve = { branch: b.index, tree, nodes, s, r, places, reference: reference(s, r) };
    this.name.textContent = b.label;
    this.places.replaceChildren(
      ...places.map(p =>
        h(
          "button",
          {
            type: "button",
            class: `mark ${p.kind}`,
            title: `Go to this ${p.kind}`,
            onclick: () => goToNode(this.app, nodes[p.at]),
          },
          `${p.kind === "stenosis" ? "Stenosis" : "Dilation"} ${Math.round(100 * p.share)} %`,
        ),
      ),
    );
    this.draw();
  }

  private get scale(): {
    x: (s: number) => number;
    y: (r: number) => number;
    most: number;
    end: number;
    width: number;
    height: number;
  } {
    const width = this.plot.clientWidth,
      height = this.plot.clientHeight,
      c = this.curve!,
      end = c.s.at(-1)! || 1,
      most = 1.1 * Math.max(...c.r);
    return {
      width,
      height,
      end,
      most,
      x: s => kLeft + (s / end) * (width - kLeft - kRight),
      y: r => height - kBottom - (r / most) * (height - kTop - kBottom),
    };
  }
  private go(x: number): void {
    if (this.curve === null) return;
    const { s, nodes } = this.curve,
      { width, end } = this.scale,
      at = ((x - kLeft) / (width - kLeft - kRight)) * end;
    let best = 0;
    for (let i = 1; i < s.length; ++i) if (Math.abs(s[i] - at) < Math.abs(s[best] - at)) best = i;
    goToNode(this.app, nodes[best]);
  }

  draw(): void {
    if (this.scheduled || this.curve === null) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      if (this.curve === null || this.element.hidden) return;
      this.drawPlot(this.curve);
      this.drawImage(this.curve);
    });
  }

  private drawPlot(curve: Curve): void {
    const view = this.app.store.get(),
      c = clearedContext(this.plot, this.plot.clientWidth, this.plot.clientHeight),
      { x, y, most, end, width, height } = this.scale,
      style = getComputedStyle(this.element);
    const ink = style.getPropertyValue("--ink-2"),
      grid = style.getPropertyValue("--line"),
      { s, r, nodes } = curve;
    c.font = "10px system-ui, sans-serif";
    c.textBaseline = "middle";
    c.strokeStyle = grid;
    c.fillStyle = ink;
    c.lineWidth = 1;
    const stepY = niceLength(most, 0.55),
      stepX = niceLength(end, 0.22);
    c.textAlign = "right";
    for (let v = 0; v <= most; v += stepY) {
      line(c, kLeft, y(v), width - kRight, y(v));
      c.fillText(brief(v).replace(/\.?0+$/, ""), kLeft - 5, y(v));
    }
    c.textAlign = "center";
    for (let v = 0; v <= end + 1e-9; v += stepX)
      c.fillText(`${Number(v.toPrecision(6))}${v === 0 ? " mm" : ""}`, x(v), height - 8);
    for (const p of curve.places) {
      c.fillStyle = p.kind === "stenosis" ? "rgb(226 96 92 / 0.28)" : "rgb(90 150 255 / 0.28)";
      c.fillRect(x(s[p.from]) - 1, kTop, Math.max(3, x(s[p.to]) - x(s[p.from]) + 2), height - kTop - kBottom);
    }
    c.strokeStyle = ink;
    c.setLineDash([3, 3]);
    trace(c, s.map(x), Array.from(curve.reference, y));
    c.stroke();
    c.setLineDash([]);
    const colour = colourOf(view, curve.branch);
    trace(c, s.map(x), r.map(y));
    c.strokeStyle = toCss(colour);
    c.lineWidth = 1.8;
    c.stroke();
    c.lineTo(x(s.at(-1)!), y(0));
    c.lineTo(x(0), y(0));
    c.fillStyle = toCss(colour, 0.16);
    c.fill();
    const i = nodes.indexOf(view.selection.node);
    this.plot.setAttribute("aria-valuemin", "0");
    this.plot.setAttribute("aria-valuemax", String(nodes.length - 1));
    this.plot.setAttribute("aria-valuenow", String(Math.max(0, i)));
    this.plot.setAttribute(
      "aria-valuetext",
      i < 0 ? "no cursor" : `${brief(s[i])} mm, radius ${brief(r[i])} mm`,
    );
    this.figures.textContent =
      i < 0 ? `radius over ${brief(end)} mm` : `${brief(s[i])} mm along, radius ${brief(r[i])} mm`;
    if (i < 0) return;
    c.strokeStyle = c.fillStyle = style.getPropertyValue("--ink");
    c.lineWidth = 1;
    line(c, x(s[i]), kTop, x(s[i]), height - kBottom);
    c.beginPath();
    c.arc(x(s[i]), y(r[i]), 3.5, 0, 2 * Math.PI);
    c.fill();
  }

  private drawImage(curve: Curve): void {
    const view = this.app.store.get(),
      { volume, tree } = view.document;
    this.image.hidden = volume === null || view.document.volumeReady < volume.size[2];
    if (volume === null || tree === null || this.image.hidden || this.image.clientWidth < 2) return;
    const c = clearedContext(this.image, this.image.clientWidth, this.image.clientHeight),
      width = this.image.clientWidth - kLeft - kRight,
      height = this.image.clientHeight;
    const columns = Math.max(
      2,
      Math.min(Math.round(width), Math.ceil((2 * curve.s.at(-1)!) / Math.min(...volume.spacing))),
    );
    if (this.straight?.path.length !== columns) this.straight = straighten(tree, curve.branch, columns);
    const half = Math.max(
      3 * tree.branches[curve.branch].mean,
      1.3 * tree.branches[curve.branch].greatest,
      4 * Math.min(...volume.spacing),
    );
    const rows = Math.max(
        8,
        Math.min(Math.round(height), Math.ceil((3 * half) / Math.min(...volume.spacing))),
      ),
      picture = document.createElement("canvas");
    picture.width = columns;
    picture.height = rows;
    picture
      .getContext("2d")!
      .putImageData(reformat(volume, this.straight, rows, half, this.turn, view.slices.window), 0, 0);
    c.imageSmoothingEnabled = true;
    c.drawImage(picture, kLeft, 0, width, height);
    const y = (mm: number): number => height / 2 - (mm / half) * (height / 2),
      x = (s: number): number => kLeft + (s / (curve.s.at(-1)! || 1)) * width;
    c.strokeStyle = toCss(colourOf(view, curve.branch), 0.9);
    c.lineWidth = 1;
    for (const side of [1, -1]) {
      trace(
        c,
        curve.s.map(x),
        curve.r.map(r => y(side * r)),
      );
      c.stroke();
    }
    const i = curve.nodes.indexOf(view.selection.node);
    c.strokeStyle = "rgb(255 255 255 / 0.8)";
    if (i >= 0) line(c, x(curve.s[i]), 0, x(curve.s[i]), height);
    c.fillStyle = getComputedStyle(this.element).getPropertyValue("--ink-2");
    c.font = "10px system-ui, sans-serif";
    c.textAlign = "right";
    c.fillText(`±${brief(half)}`, kLeft - 3, height / 2 + 3);
  }
}

function line(c: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  c.beginPath();
  c.moveTo(x0, y0);
  c.lineTo(x1, y1);
  c.stroke();
}
function trace(c: CanvasRenderingContext2D, x: number[], y: number[]): void {
  c.beginPath();
  x.forEach((at, i) => {
    if (i === 0) c.moveTo(at, y[i]);
    else c.lineTo(at, y[i]);
  });
}
