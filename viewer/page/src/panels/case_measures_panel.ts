// SPDX-License-Identifier: Apache-2.0
/** The measures of the whole case: a click on a number shows its place. */
import {
  figuresOf,
  kKinds,
  placeOf,
  splitColumn,
  titleOf,
  type Figure,
  type MeasureRow,
  type MeasureTables,
} from "../case/case_measures";
import type { Part } from "../model/model";
import { goTo, select } from "../model/selection";
import { button, h, replaceRows, saveBlob, section, select as selectBox } from "../base/ui";

const kMostRows = 500;

export function caseMeasuresPanel(
  app: Part<"document" | "selection" | "slices", "source" | "perform">,
): HTMLElement[] {
  return app.source.live ? [new CaseMeasures(app).section] : [];
}

class CaseMeasures {
  readonly section: HTMLDetailsElement;
  private tables: MeasureTables = {};
  private seen = 0;
  private kind = "vessels";
  private chosen = 0;
  private readonly note = h("p", { class: "hint", id: "geometry-note", role: "status" });
  private readonly list = h("ul", { class: "list proposals", id: "geometry-list", "aria-label": "Measured" });
  private readonly figures = h("ul", {
    class: "list figures-of-row",
    id: "geometry-figures",
    "aria-label": "Measures",
  });
  private readonly table = button(
    {
      text: "CSV",
      label: "Save this table as comma-separated values",
      id: "geometry-csv",
      class: "button text",
    },
    () => void this.save(),
  );

  constructor(private readonly app: Part<"document" | "selection" | "slices", "source" | "perform">) {
    const run = button(
      {
        icon: "section",
        text: "Measure",
        label: "Measure all vessels, paths, forks and narrowings",
        id: "geometry-run",
        class: "button primary",
      },
      () => void app.perform({ op: "measure" }),
    );
    const kinds = selectBox(
      "geometry-kind",
      "Kind of measures",
      kKinds.map(([kind, title]) => [kind, title] as [string, string]),
      this.kind,
      kind => {
        this.kind = kind;
        this.chosen = 0;
        this.list.replaceChildren(); // no row stands below the title of another table
        this.show();
      },
    );
    this.section = section(
      "section-geometry",
      "Geometry",
      false,
      h("div", { class: "row" }, run, kinds, this.table),
      this.note,
      this.list,
      this.figures,
    );
    app.store.watch(["document.state"], ({ document: { state } }) => {
      this.section.hidden = !state.has_case;
      run.disabled = state.job !== null;
      void this.take(state.revisions.measures ?? 0);
    });
    app.store.watch(["document.state", "document.treeRevision"], () => this.say());
  }

  /** Fetches the tables when there are others. */
  private async take(revision: number): Promise<void> {
    if (revision === this.seen) return;
    this.seen = revision;
    const bytes = revision === 0 ? null : await this.app.source.bytes("measures");
    if (revision !== this.seen) return;
    this.tables = bytes === null ? {} : (JSON.parse(new TextDecoder().decode(bytes)) as MeasureTables);
    this.chosen = 0;
    if (bytes !== null) this.section.open = true;
    this.show();
  }

  private get rows(): MeasureRow[] {
    return this.tables[this.kind] ?? [];
  }

  private say(): void {
    const { state } = this.app.store.get().document,
      count = this.rows.length;
    this.note.textContent =
      this.seen === 0
        ? "Lengths, tortuosity, calibres, forks, narrowings and aneurysms of the whole case, each with half of its 95 % interval."
        : state.measures_are_old
          ? "The case has changed since: measure again."
          : count === 0
            ? "There is none of this kind."
            : `${count} in all${count > kMostRows ? `; the first ${kMostRows} are listed` : ""}. A click shows the place.`;
  }

  private show(): void {
    this.table.disabled = this.rows.length === 0;
    replaceRows(
      this.list,
      this.rows.slice(0, kMostRows).map((row, i) => this.rowOf(row, i)),
    );
    this.showFigures();
    this.say();
  }

  private rowOf(row: MeasureRow, i: number): HTMLElement {
    const shown = kKinds.find(([kind]) => kind === this.kind)![2],
      figures = figuresOf(row).filter(f => shown.includes(f.column));
    return h(
      "li",
      { class: `row item${i === this.chosen ? " chosen" : ""}` },
      h(
        "button",
        { type: "button", class: "link what", title: "Show it", onclick: () => this.choose(i) },
        titleOf(row),
      ),
      h("span", { class: "figures" }, ...figures.map(f => h("span", { title: f.name }, f.text))),
    );
  }

  private choose(i: number): void {
    this.chosen = i;
    const row = this.rows[i],
      { tree } = this.app.store.get().document;
    const branch = tree?.branches.findIndex(b => b.label === (row.vessel ?? row.end ?? row.parent)) ?? -1;
    if (branch >= 0) select(this.app, branch);
    this.goTo(placeOf(row));
    [...this.list.children].forEach((each, k) => each.classList.toggle("chosen", k === i));
    this.showFigures();
  }

  private goTo(place: Figure["place"]): void {
    if (place !== null) goTo(this.app, place);
  }

  private showFigures(): void {
    const row = this.rows[this.chosen];
    replaceRows(
      this.figures,
      row === undefined
        ? []
        : figuresOf(row).map(figure =>
            h(
              "li",
              { class: "row item", "data-column": figure.column },
              h(
                "button",
                {
                  type: "button",
                  class: "link what",
                  title: `Show where: ${splitColumn(figure.column).name}`,
                  onclick: () => this.goTo(figure.place),
                },
                figure.name,
              ),
              h("span", { class: "figures" }, figure.text),
            ),
          ),
    );
  }

  private async save(): Promise<void> {
    const bytes = await this.app.source.bytes("measures", { kind: this.kind });
    if (bytes !== null) saveBlob(`${this.kind}.csv`, new Blob([bytes.slice()], { type: "text/csv" }));
  }
}
