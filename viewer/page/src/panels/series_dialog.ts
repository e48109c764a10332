// SPDX-License-Identifier: Apache-2.0
/** The series of a folder of DICOM, in the middle of the page: one of them is opened as the volume. */
import type { Part } from "../model/model";
import { Pack } from "../case/pack";
import type { DicomSeries, SeriesList } from "../base/types";
import { isLabelMap } from "../net/dropped_files";
import type { OpenAs } from "../net/source";
import { brief, button, choose, h } from "../base/ui";

/** What these functions take of the page. */
type Needs = Part<"document" | "tools", "source" | "perform">;

const kEdge = 128; // pixels of a picture's canvas

/** A line about a series: modality, slices, spacing, size. */
export function aboutSeries({ modality, files, size, spacing_mm: spacing }: DicomSeries): string {
  return [
    modality || "no modality",
    size[2] === 1 ? "1 slice" : `${size[2]} slices`,
    ...(files === size[2] ? [] : [files === 1 ? "1 file" : `${files} files`]),
    ...(spacing === null ? [] : [`${spacing.map(brief).join(" × ")} mm`]),
    `${size[0]} × ${size[1]} pixels`,
  ].join(", ");
}

/** Sentences on the files that belong to no series. */
export function aboutOthers({ faulty, others }: SeriesList): string {
  const is = (n: number, one: string, many: string): string =>
    n === 1 ? `1 file ${one}` : `${n} files ${many}`;
  return [
    ...(faulty > 0 ? [is(faulty, "cannot be read", "cannot be read")] : []),
    ...(others > 0 ? [is(others, "is no image", "are no images")] : []),
  ].join("; ");
}

function paint(canvas: HTMLCanvasElement, pixel: Uint8Array, width: number, height: number): void {
  const image = new ImageData(width, height);
  pixel.forEach((grey, i) => image.data.set([grey, grey, grey, 255], 4 * i));
  canvas.width = width;
  canvas.height = height;
  canvas.getContext("2d")!.putImageData(image, 0, 0);
}

async function fetchPicture(app: Needs, index: number, canvas: HTMLCanvasElement): Promise<void> {
  const revision = app.store.get().document.state.revisions.series ?? 0,
    bytes = await app.source.bytes("series_picture", { series: String(index), of: String(revision) });
  if (bytes === null) return;
  const pack = new Pack(bytes),
    [height, width] = pack.shape("pixel");
  paint(canvas, pack.get("pixel", "u8"), width, height);
}

const kParts = [
    { value: "auto", label: "Replace it" },
    { value: "second", label: "Put over it" },
  ] as const,
  kLabelsOf = { value: "labels", label: "Labels of it" } as const;

/** Asks whether a volume takes the place of the one that is open or is seen beside it; a file may also hold its labels.
 * Null: neither. Without an open volume there is nothing to ask. */
export async function askPart(app: Part<"document">, name: string, isFile = false): Promise<OpenAs | null> {
  const { volume, state } = app.store.get().document;
  if (!state.has_volume) return "auto";
  const parts = !isFile ? kParts : isLabelMap(name) ? [...kParts, kLabelsOf] : [kLabelsOf, ...kParts];
  return (await choose(
    "Replace the volume, or put this one over it?",
    `${volume?.meta.name ?? "A volume"} is open. ${name} can take its place, or be seen over or beside it, where its file places it${isFile ? ", or state by labels what lies where in it" : ""}. Vessels are tracked in the first volume alone.`,
    parts,
  )) as OpenAs | null;
}

/** Opens a series of the list `of` as the part that was chosen when its files were dropped; otherwise asks. */
async function openSeries(app: Needs, series: DicomSeries, index: number, of: number): Promise<void> {
  const part =
    app.store.get().tools.seriesAs ?? (await askPart(app, series.description || `Series ${index + 1}`));
  if (part !== null) await app.perform({ op: "open_series", series: index, of, second: part === "second" });
}

function row(app: Needs, series: DicomSeries, index: number, choose: () => void): HTMLElement {
  const picture = h("canvas", { width: kEdge, height: kEdge, "aria-hidden": "true" }),
    name = series.description || `Series ${index + 1}`,
    action = h(
      "button",
      { type: "button", class: "series", disabled: series.fault !== null, onclick: choose },
      picture,
      h(
        "span",
        {},
        h("strong", {}, name),
        h("span", {}, aboutSeries(series)),
        series.fault === null ? null : h("span", { class: "note changed" }, series.fault),
      ),
    );
  void fetchPicture(app, index, picture).catch(() => undefined); // a series without a picture can be chosen
  return h("li", {}, action);
}

export function openSeriesDialog(app: Needs): void {
  const { series, revisions } = app.store.get().document.state,
    of = revisions.series ?? 0;
  document.getElementById("series-dialog")?.remove();
  if (series === null) return;
  const others = aboutOthers(series);
  const dialog = h(
    "dialog",
    { class: "dialog", id: "series-dialog", "aria-labelledby": "series-title" },
    h("h2", { id: "series-title" }, `Choose a series of ${series.folder}`),
    h(
      "ul",
      { class: "list serieslist" },
      ...series.list.map((each, index) =>
        row(app, each, index, () => {
          dialog.close();
          void openSeries(app, each, index, of);
        }),
      ),
    ),
    others === ""
      ? null
      : h(
          "details",
          { id: "series-others" },
          h("summary", {}, `${others}.`),
          h("ul", { class: "list" }, ...series.faults.map(text => h("li", { class: "hint" }, text))),
        ),
    h(
      "div",
      { class: "row end" },
      button({ text: "Not now", label: "Not now", class: "button text" }, () => dialog.close()),
    ),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/** Shows the list whenever the server has another one of several series, or of one that cannot be opened. */
export function offerSeries(app: Needs): void {
  let seen = 0;
  app.store.watch(["document.state"], ({ document: { state } }) => {
    const now = state.revisions.series ?? 0;
    if (now === seen) return;
    seen = now;
    const list = state.series?.list ?? [];
    if (list.length > 1 || (list.length === 1 && list[0].fault !== null)) openSeriesDialog(app);
  });
}
