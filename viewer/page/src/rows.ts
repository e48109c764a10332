// SPDX-License-Identifier: Apache-2.0
/** Lists whose rows are made anew with every state. */

/** The button that has the keys keeps them: in the row that comes to its place. */
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
