// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";

declare global {
  interface ImportMeta {
    glob(pattern: string, options: object): Record<string, string>;
  }
}
const sources = import.meta.glob("./**/*.ts", { query: "?raw", import: "default", eager: true });

/** The path that a relative import in a file of the folder `from` names, as the keys of `sources` have it. */
function resolved(from: string, to: string): string {
  const parts = from.split("/");
  for (const part of to.split("/"))
    if (part === "..") parts.pop();
    else if (part !== ".") parts.push(part);
  return `${parts.join("/")}.ts`;
}

function importsOf(file: string): string[] {
  const folder = file.slice(0, file.lastIndexOf("/"));
  return [...sources[file].matchAll(/^(?:import|export)\b[^;]*?"(\.[^"]+)";$/gm)]
    .map(([, to]) => resolved(folder, to))
    .filter(to => to in sources); // libblob's module is none of the page's files
}

/** The files of a circle of imports, types included, from one of them back to it; empty: there is none. */
function circle(): string[] {
  const done = new Set<string>();
  const from = (file: string, path: string[]): string[] => {
    if (path.includes(file)) return [...path.slice(path.indexOf(file)), file];
    if (done.has(file)) return [];
    for (const next of importsOf(file)) {
      const found = from(next, [...path, file]);
      if (found.length > 0) return found;
    }
    done.add(file);
    return [];
  };
  return Object.keys(sources).reduce<string[]>(
    (found, file) => (found.length > 0 ? found : from(file, [])),
    [],
  );
}

it("sees the imports of the page", () => {
  expect(importsOf("./main.ts")).toContain("./scene/scene_view.ts");
  expect(importsOf("./scene/scene_view.ts")).toContain("./base/vec.ts");
});
it("finds no circle of imports", () => {
  expect(circle()).toEqual([]);
});
