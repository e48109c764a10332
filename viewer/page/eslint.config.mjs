// SPDX-License-Identifier: Apache-2.0
import js from "@eslint/js";
import tseslint from "typescript-eslint";

export default tseslint.config(
  { ignores: ["dist/", "node_modules/"] },
  js.configs.recommended,
  {
    files: ["src/**/*.ts"],
    extends: [...tseslint.configs.strict],
    rules: {
      "max-lines": ["error", { max: 400 }],
      "@typescript-eslint/no-non-null-assertion": "off",
      "no-restricted-properties": [
        "error",
        { property: "innerHTML", message: "Texts of a case are never markup: use textContent." },
        { property: "outerHTML", message: "Texts of a case are never markup: use textContent." },
        { property: "insertAdjacentHTML", message: "Texts of a case are never markup: use textContent." },
      ],
    },
  },
  {
    // Node's globals, and of the browser those that a test runs in the page
    files: ["people/*.mjs"],
    languageOptions: {
      globals: Object.fromEntries(
        [
          "process",
          "console",
          "Buffer",
          "setTimeout",
          "requestAnimationFrame",
          "atob",
          "btoa",
          "Blob",
          "File",
          "DataTransfer",
          "createImageBitmap",
          "OffscreenCanvas",
          "fetch",
          "URL",
          "DragEvent",
          "window",
          "document",
          "performance",
          "location",
          "getComputedStyle",
          "NodeFilter",
          "WebGL2RenderingContext",
          "URLSearchParams",
        ].map(name => [name, "readonly"]),
      ),
    },
    rules: { "max-lines": ["error", { max: 400 }] },
  },
  {
    // the scripts of a library's pages, which browsers take as they are; looked at from the root of the repository
    files: ["converters/library/site/*.js"],
    languageOptions: {
      sourceType: "script",
      globals: Object.fromEntries(
        [
          "document",
          "location",
          "history",
          "navigator",
          "matchMedia",
          "addEventListener",
          "setTimeout",
          "clearTimeout",
          "getSelection",
          "sessionStorage",
          "Image",
          "URL",
          "URLSearchParams",
        ].map(name => [name, "readonly"]),
      ),
    },
    rules: {
      "max-lines": ["error", { max: 400 }],
      "no-restricted-properties": [
        "error",
        ...["innerHTML", "outerHTML", "insertAdjacentHTML"].map(property => ({
          property,
          message: "Texts of a case are never markup: use textContent.",
        })),
      ],
    },
  },
  {
    files: ["*.mjs"],
    languageOptions: { globals: { process: "readonly", console: "readonly", URL: "readonly" } },
  },
);
