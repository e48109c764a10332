// SPDX-License-Identifier: Apache-2.0
/** Actions of buttons and keys. */
import type { Flight } from "../scene/flight";
import { divide, holdsSeeds, isLabelMap, isVolume, type Dropped } from "../net/dropped_files";
import type { App, Tool } from "../model/model";
import type { SceneView } from "../scene/scene_view";
import type { SliceView } from "../slices/slice_view";
import { openHelp } from "./help";
import { applyView, kViewEnding, kViewFormat, readView, takeView } from "../model/kept_view";
import { askPart } from "./series_dialog";
import { fitting } from "./too_large";
import { Refused, type OpenAs } from "../net/source";
import { askYes, errorText, h, saveBlob, saveText } from "../base/ui";

const kMostBatch = 999_999_999, // greatest number of a batch of files
  kBetween = 100, // files between two messages
  kLook = 100; // ms between two looks whether a file is open

export class Actions {
  private batch = -1;

  constructor(
    private readonly app: App,
    private readonly scene: SceneView,
    private readonly slices: SliceView[],
    readonly flight: Flight,
  ) {}

  tool(tool: Tool): void {
    this.app.store.set({ tools: { tool, pending: [] } });
  }
  async compare(): Promise<void> {
    if (await this.app.perform({ op: "compare" })) this.app.store.set({ scene: { colourBy: "compare" } });
  }

  /** To the file that it came from; a case without one is downloaded. */
  async save(): Promise<void> {
    const { state } = this.app.store.get().document;
    if (!state.has_case) {
      this.app.inform("There is no case to save yet: track a vessel first.", "warning");
      return;
    }
    if (state.save_as === null) this.download("lumen");
    else await this.saveFile(); // the message names the file
  }
  private async saveFile(): Promise<void> {
    const { source, store, inform } = this.app;
    try {
      await source.perform({ op: "save" }, store.get().document.state.revision);
    } catch (error) {
      const text = errorText(error),
        { files, save_as: saveAs } = store.get().document.state;
      if (
        !(error instanceof Refused) ||
        error.status !== 409 ||
        !files.some(f => f.name === saveAs && f.changed)
      ) {
        inform(text, "error");
        return;
      }
      if (await askYes("Overwrite the file?", text, "Overwrite"))
        await this.app.perform({ op: "save", force: true });
    }
  }
  download(format: string): void {
    if (format === kViewFormat) {
      const view = this.app.store.get();
      saveText(
        `${view.document.state.title || "lumen"}${kViewEnding}`,
        JSON.stringify(takeView(view), null, 1),
      );
      return;
    }
    this.app.source.download(format).catch((error: unknown) => this.app.inform(errorText(error), "error"));
  }

  open(as: OpenAs = "auto"): void {
    const input = h("input", { type: "file", multiple: true });
    input.addEventListener("change", () => void this.openFiles([...(input.files ?? [])], as));
    input.click();
  }
  /** A folder, all files below which the browser hands over. */
  openFolder(): void {
    const input = h("input", { type: "file", webkitdirectory: true });
    input.addEventListener(
      "change",
      () => void this.openDropped({ files: [], inFolders: [...(input.files ?? [])] }),
    );
    input.click();
  }
  /** Files and folders; those of DICOM go to the server together, which lists their series. */
  async openDropped(dropped: Dropped, as: OpenAs = "auto"): Promise<void> {
    const { dicom, others } = await divide(dropped);
    if (dicom.length > 0) await this.sendDicom(dicom);
    await this.openEach(others, as);
  }
  openFiles(files: File[], as: OpenAs = "auto"): Promise<void> {
    return this.openDropped({ files, inFolders: [] }, as);
  }
  private async sendDicom(files: File[]): Promise<void> {
    const part = await askPart(
      this.app,
      files.length === 1 ? files[0].name : `${files.length} files of DICOM`,
    );
    if (part === null) return;
    this.app.store.set({ tools: { seriesAs: part } });
    const batch = (this.batch = Math.floor(Math.random() * kMostBatch)),
      { source, inform } = this.app;
    try {
      for (const [i, file] of files.entries()) {
        if (i % kBetween === 0) inform(`Reading ${i} of ${files.length} files…`);
        await source.sendSeriesFile(batch, file);
        if (this.batch !== batch) return; // others were dropped meanwhile
      }
      await this.app.perform({ op: "list_series", batch, second: part === "second" });
    } catch (error) {
      inform(errorText(error), "error");
    }
  }
  private async openEach(files: File[], as: OpenAs): Promise<void> {
    const ordered = [...files].sort((a, b) => Number(isLabelMap(a.name)) - Number(isLabelMap(b.name)));
    for (const [i, file] of ordered.entries()) {
      if (i > 0) await this.opened();
      if (file.name.endsWith(kViewEnding)) {
        await this.openView(file);
        continue;
      }
      if (!(await this.mayReplaceSeeds(file))) continue;
      const part = as === "auto" && isVolume(file.name) ? await askPart(this.app, file.name, true) : as;
      if (part === null) continue;
      try {
        const bytes = await fitting(this.app, file);
        if (bytes === null) continue;
        this.app.inform(`Opening ${file.name}…`);
        // a smaller copy is not compressed
        await this.app.source.open(bytes === file ? file.name : file.name.replace(/\.gz$/i, ""), part, bytes);
      } catch (error) {
        this.app.inform(errorText(error), "error");
      }
    }
  }
  /** Waits until what was sent is open: the next file is asked about what there is then. */
  private async opened(): Promise<void> {
    const { source, store } = this.app;
    for (;;) {
      const { revision, job } = await source.state();
      if (job === null && store.get().document.state.revision >= revision) return;
      await new Promise(resolve => window.setTimeout(resolve, kLook));
    }
  }
  /** Asks before a file of seeds takes the place of seeds that wait. */
  private async mayReplaceSeeds(file: File): Promise<boolean> {
    const waiting = this.app.store.get().document.state.seeds.filter(seed => !seed.tracked).length,
      kHead = 4096; // bytes that show what a file is
    if (waiting === 0 || !holdsSeeds(file.name, await file.slice(0, kHead).text())) return true;
    return askYes(
      "Replace the seeds?",
      `${waiting === 1 ? "One seed waits" : `${waiting} seeds wait`} to be tracked. The seeds of ${file.name} take their place; undo brings them back.`,
      "Replace",
    );
  }
  private async openView(file: File): Promise<void> {
    try {
      applyView(this.app, readView(await file.text()));
      this.app.inform(`The view of ${file.name} is shown.`);
    } catch (error) {
      this.app.inform(`${file.name} is no view: ${errorText(error)}`, "error");
    }
  }
  async cancel(): Promise<void> {
    const { job } = this.app.store.get().document;
    if (job !== null) await this.app.source.cancel(job.job);
  }

  fly(): void {
    if (this.flight.running) {
      this.flight.stop();
      return;
    }
    const { layout } = this.app.store.get().page;
    if (layout !== "four" && layout !== "rows" && layout !== "scene")
      this.app.store.set({ page: { layout: "four" } });
    this.flight.start();
    this.scene.element.focus();
  }
  fit(): void {
    this.scene.fit();
    for (const slice of this.slices) slice.fit();
  }
  lookFrom(side: "A" | "P" | "L" | "R" | "S" | "I"): void {
    this.scene.camera.lookFrom(side);
    this.scene.moved();
  }
  parallel(): void {
    this.scene.camera.isParallel = !this.scene.camera.isParallel;
    this.scene.moved();
  }
  theme(): void {
    const theme = this.app.store.get().page.theme === "dark" ? "light" : "dark";
    this.app.store.set({ page: { theme } });
    try {
      localStorage.setItem("lumen-theme", theme);
    } catch {
      /* a page from disk may keep nothing */
    }
  }
  help(): void {
    openHelp(this.app.source.live);
  }

  picture(): void {
    const over = [...document.querySelectorAll<HTMLCanvasElement>("canvas.over")];
    const legends = [...document.querySelectorAll<HTMLElement>(".legend")];
    this.app.stage.picture(over, legends, "#07090c").toBlob(blob => {
      if (blob === null) return;
      saveBlob(`${this.app.store.get().document.state.title || "lumen"}.png`, blob);
    });
  }
}
