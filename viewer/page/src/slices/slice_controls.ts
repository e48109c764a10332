// SPDX-License-Identifier: Apache-2.0
/** The controls of a slice: its slab, by keys and fields, and the line between two volumes. */
import { h, select } from "../base/ui";
import type { Part } from "../model/model";
import { showsSecond } from "../model/beside";
import { kSlabKinds, type Slab, type Slabs } from "../model/slab";
import { kSliceNames, type SliceName } from "../model/slice_frame";

const kLeast = 0.5, // mm
  kMost = 200, // mm
  kStep = 1.25; // factor from one thickness to the next

const within = (mm: number): number => Math.min(kMost, Math.max(kLeast, mm));

/** Changes the slabs of the named slices; of all without a name. */
function change(app: Part<"slices">, name: SliceName | null, to: (slab: Slab) => Slab): void {
  const { slabs } = app.store.get().slices;
  app.store.set({
    slices: {
      slabs: Object.fromEntries(
        kSliceNames.map(each => [each, name === null || name === each ? to(slabs[each]) : slabs[each]]),
      ) as unknown as Slabs,
    },
  });
}

/** Slice, maximum, minimum, mean, and the slice again; all slices follow the first of them. */
function nextKind(app: Part<"slices">, name: SliceName | null): void {
  const now = app.store.get().slices.slabs[name ?? "axial"].kind,
    next = kSlabKinds[(kSlabKinds.findIndex(([kind]) => kind === now) + 1) % kSlabKinds.length][0];
  change(app, name, slab => ({ ...slab, kind: next }));
}

/** Makes slabs thinner (-1) or thicker (1). */
function thicken(app: Part<"slices">, name: SliceName | null, way: 1 | -1): void {
  change(app, name, slab => ({
    kind: slab.kind === "off" ? "max" : slab.kind,
    mm: Number(within(slab.mm * kStep ** way).toPrecision(2)),
  }));
}

/** The keys of slabs; false for another key. Without a name they act on all slices. */
export function slabKey(app: Part<"slices">, name: SliceName | null, key: string): boolean {
  if (key === "7") nextKind(app, name);
  else if (key === "8") thicken(app, name, -1);
  else if (key === "9") thicken(app, name, 1);
  else return false;
  return true;
}

/** The control of a slice. */
export function slabControl(app: Part<"slices">, name: SliceName): HTMLElement {
  const kind = select(
    `slab-${name}`,
    `${name.charAt(0).toUpperCase()}${name.slice(1)}: one plane, or a slab of a thickness  (7)`,
    kSlabKinds,
    "off",
    value => change(app, name, slab => ({ ...slab, kind: value })),
  );
  const mm = h("input", {
    type: "number",
    id: `slab-${name}-mm`,
    class: "slabmm",
    min: kLeast,
    max: kMost,
    step: 0.5,
    "aria-label": `Thickness of the ${name} slab, mm`,
    title: "Thickness, mm  (8 and 9)",
  });
  mm.addEventListener("change", () => {
    const wanted = Number(mm.value);
    if (wanted > 0) change(app, name, slab => ({ ...slab, mm: within(wanted) }));
    else mm.value = String(app.store.get().slices.slabs[name].mm);
  });
  app.store.watch(["slices.slabs"], ({ slices: { slabs } }) => {
    const slab = slabs[name];
    kind.value = slab.kind;
    mm.value = String(slab.mm);
    mm.hidden = slab.kind === "off";
  });
  const box = h("div", { class: "slab" }, kind, mm);
  for (const event of ["pointerdown", "dblclick", "wheel"])
    box.addEventListener(event, e => e.stopPropagation());
  box.addEventListener("keydown", e => {
    if (!e.ctrlKey && e.key !== "Escape") e.stopPropagation(); // arrows choose here
  });
  return box;
}

/** The line between both volumes of a slice, and their names above it. */
export function splitLine(app: Part<"document" | "slices">, view: HTMLElement): HTMLElement {
  const { store } = app,
    before = h("span", { class: "before" }),
    after = h("span", { class: "after" }),
    line = h(
      "div",
      {
        class: "splitline",
        title: "Drag the line between both volumes",
        "aria-hidden": "true",
        hidden: true,
      },
      before,
      after,
    );
  line.addEventListener("pointerdown", e => {
    if (e.button !== 0) return;
    line.setPointerCapture(e.pointerId);
    e.stopPropagation();
    e.preventDefault();
  });
  line.addEventListener("pointermove", e => {
    if (!line.hasPointerCapture(e.pointerId)) return;
    const box = view.getBoundingClientRect(),
      share = Math.min(1, Math.max(0, (e.clientX - box.left) / Math.max(box.width, 1)));
    store.set({ slices: { beside: { ...store.get().slices.beside, share } } });
    e.stopPropagation();
  });
  store.watch(["slices.beside", "document.second", "document.volume"], view => {
    line.hidden = !(showsSecond(view) && view.slices.beside.mode === "split");
    line.style.left = `${100 * view.slices.beside.share}%`;
    before.textContent = view.document.volume?.meta.name ?? "";
    after.textContent = view.document.second?.meta.name ?? "";
  });
  return line;
}
