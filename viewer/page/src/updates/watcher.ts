// SPDX-License-Identifier: Apache-2.0
/** Listens to the server and to what is dropped; shows what goes on. */
import type { Actions } from "../panels/actions";
import { droppedFiles } from "../net/dropped_files";
import type { Loader } from "./loader";
import type { Part } from "../model/model";
import type { Shell } from "../panels/shell";
import type { Event, State } from "../base/types";
import { button, errorText, h } from "../base/ui";

export class Watcher {
  private taking: Promise<void> = Promise.resolve();
  private isLost = false; // the server does not answer

  constructor(
    private readonly app: Part<"document" | "page", "source" | "inform">,
    private readonly shell: Shell,
    private readonly loader: Loader,
    private readonly actions: Pick<Actions, "cancel" | "open" | "openFolder" | "openDropped">,
  ) {
    this.showProgress();
    this.showEmpty();
    this.takeDrops();
    window.addEventListener("beforeunload", e => {
      if (app.source.live && app.store.get().document.state.unsaved) e.preventDefault();
    });
  }

  async begin(state: Promise<State>): Promise<void> {
    const { app, shell } = this;
    let theme: string | null = null;
    try {
      theme = localStorage.getItem("lumen-theme");
    } catch {
      /* a page from disk may keep nothing */
    }
    app.store.set({
      page: {
        theme:
          theme === "light" || (theme === null && matchMedia("(prefers-color-scheme: light)").matches)
            ? "light"
            : "dark",
      },
    });
    this.take(await state);
    await this.taking;
    app.source.listen(event => this.hear(event));
    shell.status.textContent = app.source.where;
    document.body.dataset.ready = "1";
  }

  /** States one after the other: the last one wins. */
  private take(state: State): void {
    this.taking = this.taking
      .then(() => this.loader.take(state))
      .catch((error: unknown) => this.app.inform(`Not all could be shown: ${errorText(error)}`, "error"));
  }

  private hear(event: Event): void {
    const { store } = this.app;
    switch (event.type) {
      case "state":
        this.tellChanged(event.state);
        this.take(event.state);
        if (event.state.job === null) store.set({ document: { job: null } });
        else if (store.get().document.job?.job !== event.state.job.job)
          store.set({ document: { job: { ...event.state.job, stage: "", done: 0, total: 0 } } });
        break;
      case "progress":
        store.set({
          document: {
            job: {
              job: event.job,
              name: store.get().document.job?.name ?? "",
              stage: event.stage,
              done: event.done,
              total: event.total,
            },
          },
        });
        break;
      case "done":
        store.set({ document: { job: null } });
        if (event.text !== "") this.app.inform(event.text, event.ok ? "note" : "error");
        break;
      case "message":
        this.app.inform(event.text, event.severity);
        break;
      case "lost":
        this.isLost = true;
        this.shell.status.classList.add("lost");
        this.shell.status.textContent =
          "The engine does not answer: what you see can be looked at, not changed.";
        break;
      case "back":
        if (this.isLost) {
          this.shell.status.classList.remove("lost");
          this.shell.status.textContent = this.app.source.where;
          this.isLost = false;
          void this.app.source.state().then(state => this.take(state));
        }
        break;
    }
  }

  private tellChanged(state: State): void {
    const known = new Set(
      this.app.store
        .get()
        .document.state.files.filter(f => f.changed)
        .map(f => f.id),
    );
    for (const file of state.files)
      if (file.changed && !known.has(file.id))
        this.app.inform(`Another program has written ${file.name}: here it is as it was read.`, "warning");
  }

  private showProgress(): void {
    const { progress } = this.shell,
      bar = h("progress", { max: 1, "aria-hidden": "true" }),
      text = h("span", {});
    progress.append(
      text,
      bar,
      button(
        {
          icon: "stop",
          text: "Cancel",
          label: "Cancel what runs",
          key: "Escape",
          id: "cancel",
          class: "button text",
        },
        () => void this.actions.cancel(),
      ),
    );
    this.app.store.watch(["document.job"], ({ document: { job } }) => {
      progress.hidden = job === null;
      if (job === null) return;
      text.textContent = [job.name, job.stage].filter(x => x !== "").join(": ");
      if (job.total > 0) {
        bar.value = job.done / job.total;
        progress.setAttribute("aria-valuenow", String(Math.round((100 * job.done) / job.total)));
      } else {
        bar.removeAttribute("value");
        progress.removeAttribute("aria-valuenow");
      }
      progress.setAttribute("aria-label", text.textContent);
    });
  }

  private showEmpty(): void {
    const { empty } = this.shell,
      { app } = this;
    empty.append(
      h("h1", {}, "lumen"),
      h("p", {}, "Drop a volume, a case, seeds or a mesh here"),
      h(
        "p",
        { class: "hint" },
        "NRRD, NIfTI, MetaImage, files or a folder of DICOM; .lumen; seeds of lumen or 3D Slicer; STL, OBJ, PLY, GLB, VTP",
      ),
      button({ icon: "open", text: "Open files…", label: "Open files", class: "button primary" }, () =>
        this.actions.open(),
      ),
      button(
        {
          text: "Open a folder of DICOM…",
          label: "Open a folder of DICOM",
          id: "open-folder",
          class: "button text",
        },
        () => this.actions.openFolder(),
      ),
    );
    app.store.watch(["document.state"], ({ document: { state } }) => {
      empty.hidden =
        !app.source.live ||
        state.has_case ||
        state.has_volume ||
        state.meshes.length > 0 ||
        document.body.dataset.ready === undefined;
    });
    new MutationObserver(() => {
      const { state } = app.store.get().document;
      empty.hidden = !app.source.live || state.has_case || state.has_volume || state.meshes.length > 0;
    }).observe(document.body, { attributes: true, attributeFilter: ["data-ready"] });
  }

  private takeDrops(): void {
    const { drop } = this.shell;
    let depth = 0;
    const files = (e: DragEvent): boolean => e.dataTransfer?.types.includes("Files") === true;
    const end = (): void => {
      depth = 0;
      drop.hidden = true;
    };
    window.addEventListener("dragenter", e => {
      if (!files(e)) return;
      e.preventDefault();
      ++depth;
      drop.hidden = false;
    });
    window.addEventListener("dragleave", () => {
      if (--depth <= 0) end();
    });
    window.addEventListener("dragover", e => {
      if (files(e)) e.preventDefault();
    });
    window.addEventListener("drop", e => {
      if (!files(e)) return;
      e.preventDefault();
      end();
      droppedFiles(e.dataTransfer!)
        .then(dropped => this.actions.openDropped(dropped))
        .catch((error: unknown) => this.app.inform(errorText(error), "error"));
    });
  }
}

/** Layout, theme and what hides with them are classes of the page. */
export function applyLayout(app: Part<"tools" | "page", "stage">, shell: Shell): void {
  app.store.watch(["page.layout"], view => {
    shell.views.dataset.layout = view.page.layout;
    app.stage.invalidate();
  });
  const narrow = window.matchMedia("(max-width: 900px)"), // as narrow.css has it
    foldIfNarrow = (): void => {
      if (narrow.matches) app.store.set({ page: { panels: { left: false, right: false } } });
    };
  foldIfNarrow();
  narrow.addEventListener("change", foldIfNarrow);
  app.store.watch(["page.panels"], ({ page: { panels } }) => {
    shell.left.classList.toggle("folded", !panels.left);
    shell.right.classList.toggle("folded", !panels.right);
    app.stage.invalidate();
  });
  app.store.watch(["page.theme"], view => {
    document.documentElement.dataset.theme = view.page.theme;
  });
  app.store.watch(["tools.tool"], view => {
    shell.views.dataset.tool = view.tools.tool;
  });
}
