// SPDX-License-Identifier: Apache-2.0
/** Defines <lumen-case>. The page inside its frame, its style and libblob lie beside this module, where bundlers find them. */
import { LumenCase } from "../../../viewer/page/src/lumen_case";

LumenCase.files = {
  script: new URL("./page.js", import.meta.url).href,
  style: new URL("./page.css", import.meta.url).href,
  wasm: new URL("./blob.wasm", import.meta.url).href,
};
if (customElements.get("lumen-case") === undefined) customElements.define("lumen-case", LumenCase);

export { LumenCase };
