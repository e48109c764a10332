// SPDX-License-Identifier: Apache-2.0
/** The page's frame: bar, panels and views, still empty. */
import { h } from "../base/ui";

export interface Shell {
  bar: HTMLElement;
  left: HTMLElement;
  right: HTMLElement;
  strip: HTMLElement;
  views: HTMLElement;
  canvas: HTMLCanvasElement;
  axial: HTMLElement;
  coronal: HTMLElement;
  sagittal: HTMLElement;
  scene: HTMLElement;
  legend: HTMLElement;
  deviations: HTMLElement;
  status: HTMLElement;
  probe: HTMLElement;
  progress: HTMLElement;
  toasts: HTMLElement;
  empty: HTMLElement;
  drop: HTMLElement;
}

function viewElement(id: string, label: string, help: string): HTMLElement {
  return h(
    "section",
    {
      class: "view",
      id: `view-${id}`,
      role: "application",
      "aria-roledescription": "view",
      "aria-label": `${label}. ${help}`,
      tabindex: 0,
      "data-view": id,
    },
    h("canvas", { class: "over", "aria-hidden": "true" }),
    h("div", { class: "viewtools" }),
  );
}

const kSliceHelp =
  "Arrow keys move the crosshair, page up and down step through slices, plus and minus zoom.";

/** The frame, which becomes the content of `root`. */
export function makeShell(root: HTMLElement): Shell {
  const shell: Shell = {
    bar: h("div", { class: "bar", role: "toolbar", "aria-label": "Tools" }),
    left: h("aside", { class: "panel left", "aria-label": "Vessels" }),
    right: h("aside", { class: "panel right", "aria-label": "Display and work" }),
    strip: h("section", { class: "strip", id: "strip", "aria-label": "Radius along the vessel" }),
    views: h("main", { class: "views", id: "views", "aria-label": "Views" }),
    canvas: h("canvas", { class: "stage", "aria-hidden": "true" }),
    axial: viewElement("axial", "Axial slice", kSliceHelp),
    coronal: viewElement("coronal", "Coronal slice", kSliceHelp),
    sagittal: viewElement("sagittal", "Sagittal slice", kSliceHelp),
    scene: viewElement("scene", "3D view", "Arrow keys turn, with shift they move, plus and minus zoom."),
    legend: h("div", { class: "legend", id: "legend", role: "img" }),
    deviations: h("div", { class: "legend", id: "deviation-legend", role: "img" }),
    status: h("span", { class: "status", id: "status", role: "status" }),
    probe: h("output", { class: "probe", id: "probe", "aria-live": "off" }),
    progress: h("div", { class: "progress", id: "progress", role: "progressbar", hidden: true }),
    toasts: h("div", { class: "toasts", id: "toasts", role: "log", "aria-live": "polite" }),
    empty: h("div", { class: "empty", id: "empty" }),
    drop: h("div", { class: "drop", id: "drop", hidden: true }, h("p", {}, "Drop to open")),
  };
  shell.scene.append(h("div", { class: "legends" }, shell.legend, shell.deviations));
  shell.views.append(shell.canvas, shell.axial, shell.scene, shell.coronal, shell.sagittal, shell.empty);
  root.append(
    h("a", { class: "skip", href: "#tree-list" }, "To the list of vessels"),
    h("header", {}, h("h1", { class: "unseen" }, "lumen"), shell.bar),
    h(
      "div",
      { class: "work" },
      shell.left,
      h("div", { class: "middle" }, shell.views, shell.strip),
      shell.right,
    ),
    h("footer", { class: "foot" }, shell.probe, shell.progress, shell.status, shell.toasts),
    shell.drop,
  );
  return shell;
}

const kShown = 6000; // ms that a note stays; errors stay until they are closed

/** A message in the last line, where it covers no view; the pointer or the keys on it unfold those before. */
export function toast(shell: Shell, text: string, severity: "note" | "warning" | "error" = "note"): void {
  for (const old of shell.toasts.children) if (old.firstElementChild?.textContent === text) old.remove(); // a repeated message shows once
  const close = (): void => element.remove();
  const element = h(
    "div",
    { class: `toast ${severity}`, role: severity === "error" ? "alert" : "status" },
    h("span", {}, text),
    h("button", { type: "button", class: "button", "aria-label": "Close this message", onclick: close }, "×"),
  );
  shell.toasts.append(element);
  while (shell.toasts.childElementCount > 5) shell.toasts.firstElementChild!.remove();
  if (severity !== "error") window.setTimeout(close, severity === "warning" ? 2 * kShown : kShown);
}
