// SPDX-License-Identifier: Apache-2.0
/** Elements without markup: texts are texts, whatever a case calls its vessels. */

type Attributes = Record<string, string | number | boolean | ((e: Event) => void) | undefined>;
type Child = Node | string | null | undefined;

/** An element with attributes ("class", "aria-label", "onclick": function, ...) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child !== null && child !== undefined) element.append(child);
  return element;
}

const kIcons: Record<string, string> = {
  // paths on a grid of 16, drawn as lines
  left: "M2 3h12v10H2zM6 3v10",
  right: "M2 3h12v10H2zM10 3v10",
  open: "M2 4h4l1.5 2H14v7H2z",
  save: "M3 2h8l2 2v10H3zM5 2v4h5V2M5 14v-4h6v4",
  undo: "M6 4L3 7l3 3M3 7h6a4 4 0 0 1 0 8H7",
  redo: "M10 4l3 3-3 3M13 7H7a4 4 0 0 0 0 8h2",
  navigate: "M8 2v12M2 8h12M8 5.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5",
  seed: "M8 14s4-4 4-7.5A4 4 0 0 0 4 6.5C4 10 8 14 8 14zM8 5v3M6.5 6.5h3",
  probe: "M13 3l-1.5-1.5L9 4l3 3 2.5-2.5zM10 5.5L4 11.5V13H2.5L2 14M4 13h1.5l6-6",
  distance: "M2 11L11 2l3 3-9 9zM5 8l1.5 1.5M7.5 5.5L9 7M10 3l1.5 1.5",
  angle: "M13 13H3L11 3M7 13a5 5 0 0 0-1-3.800",
  section: "M8 3c4 0 6 2 6 5s-2 5-6 5-6-2-6-5 2-5 6-5M2 8h12",
  touch: "M5.5 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8M10.5 4a4 4 0 1 1 0 8 4 4 0 0 1 0-8",
  brush: "M13.5 2.5L8 8M8 8c-2.5-.5-4 1-4 3 0 1-.8 1.800-2 2 3 1.500 7 .5 7-2.500 0-1-.4-1.900-1-2.500",
  move: "M8 2v12M2 8h12M8 2L6.5 3.5M8 2l1.5 1.5M8 14l-1.5-1.5M8 14l1.5-1.5M2 8l1.5-1.5M2 8l1.5 1.5M14 8l-1.5-1.5M14 8l-1.5 1.5",
  eye: "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6a2 2 0 1 0 0 4 2 2 0 0 0 0-4",
  hidden:
    "M2 2l12 12M4 5C2.5 6.300 1.5 8 1.5 8S4 12.5 8 12.5c1 0 2-.3 2.800-.7M7 3.600c.3 0 .7-.1 1-.1 4 0 6.5 4.5 6.5 4.5s-.6 1-1.600 2.100",
  solo: "M8 2l1.800 4 4.200.5-3.200 2.800.9 4.200L8 11.300l-3.700 2.200.9-4.200L2 6.5 6.200 6z",
  camera: "M2 5h3l1-2h4l1 2h3v8H2zM8 7a2 2 0 1 0 0 4 2 2 0 0 0 0-4",
  help: "M6 6a2 2 0 1 1 2.800 1.800C8.200 8.200 8 8.600 8 9.5M8 12v.3M8 1.5a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13",
  theme: "M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 0 1 0 12",
  layout: "M2 2h5v5H2zM9 2h5v5H9zM2 9h5v5H2zM9 9h5v5H9z",
  find: "M6.5 2a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9M10 10l4 4M4.5 7.5l2-2 2 2",
  fit: "M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4",
  flight: "M2 8l12-6-4 12-3-5z",
  close: "M4 4l8 8M12 4l-8 8",
  check: "M3 8.5L6.5 12 13 4.5",
  play: "M4 3l9 5-9 5z",
  stop: "M4 4h8v8H4z",
  pause: "M5 3v10M11 3v10",
  edit: "M3 13l1-3 7-7 2 2-7 7z",
  trash: "M3 4h10M6 4V2.5h4V4M4.5 4l.5 9.5h6l.5-9.5",
  cut: "M5 3l6 7M11 3L5 10M4 10a2 2 0 1 0 0 4 2 2 0 0 0 0-4M12 10a2 2 0 1 0 0 4 2 2 0 0 0 0-4",
  more: "M3 8h.1M8 8h.1M13 8h.1",
  compare: "M6 3v10M10 3v10M2 5h4M2 11h4M10 5h4M10 11h4",
};

export function icon(name: string): SVGSVGElement {
  const kSvg = "http://www.w3.org/2000/svg",
    svg = document.createElementNS(kSvg, "svg"),
    path = document.createElementNS(kSvg, "path");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  svg.classList.add("icon");
  path.setAttribute("d", kIcons[name] ?? "");
  svg.append(path);
  return svg;
}

/** A button with an icon, a label for assistive technology and a tip with its key. */
export function button(
  options: {
    icon?: string;
    text?: string;
    label: string;
    key?: string;
    id?: string;
    class?: string;
    pressed?: boolean;
  },
  action: () => void,
): HTMLButtonElement {
  const { label, key, text = "" } = options,
    name = label.toLowerCase().includes(text.toLowerCase()) ? label : `${text}: ${label}`, // speech says what it sees
    tip = key === undefined ? label : `${label}  (${key})`;
  const element = h("button", {
    type: "button",
    id: options.id,
    class: options.class ?? "button",
    title: tip,
    "aria-label": name,
    "aria-keyshortcuts": key,
    "aria-pressed": options.pressed === undefined ? undefined : String(options.pressed),
    onclick: action,
  });
  if (options.icon !== undefined) element.append(icon(options.icon));
  if (options.text !== undefined) element.append(h("span", {}, options.text));
  return element;
}

export function checkbox(
  id: string,
  text: string,
  tip: string,
  on: boolean,
  change: (on: boolean) => void,
): HTMLLabelElement {
  const box = h("input", { type: "checkbox", id });
  box.checked = on;
  box.addEventListener("change", () => change(box.checked));
  return h("label", { class: "check", title: tip }, box, h("span", {}, text));
}

export function select<T extends string>(
  id: string,
  label: string,
  options: [T, string][],
  value: T,
  change: (value: T) => void,
): HTMLSelectElement {
  const element = h(
    "select",
    { id, "aria-label": label, title: label },
    ...options.map(([name, text]) => h("option", { value: name }, text)),
  );
  element.value = value;
  element.addEventListener("change", () => change(element.value as T));
  return element;
}

export function slider(
  id: string,
  label: string,
  range: [number, number, number],
  value: number,
  change: (value: number) => void,
): HTMLInputElement {
  const element = h("input", {
    type: "range",
    id,
    "aria-label": label,
    title: label,
    min: range[0],
    max: range[1],
    step: range[2],
  });
  element.value = String(value);
  element.addEventListener("input", () => change(Number(element.value)));
  return element;
}

/** A titled group of a panel; closes by its title. */
export function section(id: string, title: string, open: boolean, ...children: Child[]): HTMLDetailsElement {
  return h(
    "details",
    { class: "section", id, open },
    h("summary", {}, title),
    h("div", { class: "body" }, ...children),
  );
}

/** Three significant digits or so: what a person reads. */
export function brief(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  return size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : value.toFixed(2);
}
export const mm = (value: number | null | undefined): string => `${brief(value)} mm`;

/** The words of what was thrown. */
export const errorText = (error: unknown): string => (error instanceof Error ? error.message : String(error));

const kIdleBy = 300; // ms after which idle work is done anyway

/** Calls when nothing else is to be done, or soon. */
export function idle(call: () => void): void {
  if ("requestIdleCallback" in window) window.requestIdleCallback(call, { timeout: kIdleBy });
  else setTimeout(call, 0);
}

/** A name in a row of a list, which shows what it names. */
export const link = (text: string, show: () => void): HTMLButtonElement =>
  h("button", { type: "button", class: "link", title: "Show it", onclick: show }, text);

/** Asks for one line of text; null: cancelled. */
export function askText(title: string, label: string, value: string): Promise<string | null> {
  return new Promise(resolve => {
    const input = h("input", { type: "text", id: "ask-text", value, maxlength: 200, "aria-label": label });
    input.value = value;
    const dialog = h(
      "dialog",
      { class: "dialog", "aria-label": title },
      h("h2", {}, title),
      h(
        "form",
        { method: "dialog" },
        h("label", {}, label, input),
        h(
          "div",
          { class: "row end" },
          h("button", { type: "button", class: "button text", onclick: () => dialog.close("") }, "Cancel"),
          h("button", { type: "submit", class: "button primary", value: "ok" }, "OK"),
        ),
      ),
    );
    dialog.addEventListener("close", () => {
      resolve(dialog.returnValue === "ok" ? input.value : null);
      dialog.remove();
    });
    document.body.append(dialog);
    dialog.showModal();
    input.select();
  });
}

/** Asks whether to do something; false: no. */
export async function askYes(title: string, text: string, yes: string): Promise<boolean> {
  return (await choose(title, text, [{ value: "yes", label: yes }])) === "yes";
}

/** The value of the choice that was taken, the last of which is the main one; null for none of them. */
export function choose(
  title: string,
  text: string,
  choices: readonly { value: string; label: string }[],
): Promise<string | null> {
  return new Promise(resolve => {
    const dialog = h(
      "dialog",
      { class: "dialog", "aria-label": title },
      h("h2", {}, title),
      h("p", {}, text),
      h(
        "form",
        { method: "dialog" },
        h(
          "div",
          { class: "row end" },
          h("button", { type: "submit", class: "button text", value: "" }, "Cancel"),
          ...choices.map(({ value, label }, i) =>
            h(
              "button",
              {
                type: "submit",
                class: i + 1 === choices.length ? "button primary" : "button text",
                value,
                id: `ask-${value}`,
              },
              label,
            ),
          ),
        ),
      ),
    );
    dialog.addEventListener("close", () => {
      resolve(dialog.returnValue === "" ? null : dialog.returnValue);
      dialog.remove();
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** Gives the user a text as a file to download. */
export function saveText(name: string, text: string): void {
  saveBlob(name, new Blob([text], { type: "text/plain;charset=utf-8" }));
}
export function saveBlob(name: string, blob: Blob): void {
  const kKept = 10_000, // ms until the bytes are given up
    address = URL.createObjectURL(blob),
    link = h("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  window.setTimeout(() => URL.revokeObjectURL(address), kKept);
}

/** Makes the rows of a list anew. The button that has the keys keeps them: in the row that comes to its place. */
export function replaceRows(list: HTMLElement, rows: HTMLElement[]): void {
  const row = document.activeElement?.closest("li"),
    at = row?.parentElement === list ? [...list.children].indexOf(row) : -1,
    button =
      at < 0 ? -1 : [...row!.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
  const top = list.scrollTop;
  list.replaceChildren(...rows);
  list.scrollTop = top;
  if (button >= 0) rows[Math.min(at, rows.length - 1)]?.querySelectorAll("button")[button]?.focus();
}
