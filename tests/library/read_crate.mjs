// SPDX-License-Identifier: Apache-2.0
// read_crate.mjs FILE...: RO-Crate metadata files as npm's ro-crate reads them; one JSON object of facts for each.
import {readFileSync} from "node:fs";
import {ROCrate} from "ro-crate";

for (const file of process.argv.slice(2)) {
  const crate = new ROCrate(JSON.parse(readFileSync(file, "utf8")), {array: true, link: true});
  const root = crate.rootDataset;
  const dangling = [];
  for (const entity of crate.entities())
    for (const part of entity.hasPart ?? []) if (!crate.getEntity(part["@id"])?.["@type"]) dangling.push(part["@id"]);
  console.log(JSON.stringify({
    file, dangling,
    name: root.name[0], license: root.license[0].name[0], datePublished: root.datePublished[0],
    parts: root.hasPart?.length ?? 0,
    terms: ["sha256", "contentSize", "encodingFormat", "creditText", "hasPart", "instrument"].filter(
      (term) => !crate.resolveTerm(term)),
  }));
}
