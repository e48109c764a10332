// SPDX-License-Identifier: Apache-2.0
// Cases of a library whose texts are what somebody might write to take a page over.
import { png } from "./make_library.mjs";

export const kTexts = [
  "<img src=x onerror=alert(1)>",
  '"><script>alert(1)</script>',
  "'><svg onload=alert(1)>",
  "</script><script>alert(1)</script>",
  "]]></title></style><h1>x</h1>",
  "<!--",
  "${alert(1)}`",
  "javascript:alert(1)",
  "\u202Edesrever",
  "\u2028\u2029",
  "&lt;b&gt;&amp;",
  "__proto__",
  "constructor",
  "END\nrm -rf /".replace("\n", " "),
  "'; rm -rf / #",
  "\\end{document} {{{ % $",
  "é".repeat(120),
];

/** Every text of a case is the hostile one. */
const hostile = (text, i) => ({
  id: ["constructor", "index", "0", "a--"][i] ?? `case-${i}`,
  title: text,
  description: text,
  anatomy: { text, codes: [{ system: "FMA", code: "1", name: text }] },
  licence: text,
  attribution: text,
  origin: text,
  doi: `10.1234/${text.replaceAll(/\s/g, "_")}`,
  consent: text,
  deidentification: text,
  labels: [text],
  provenance: {
    case_sha256: "0".repeat(64),
    generator: `lumen ${text}`,
    source: null,
    steps: [{ name: text, tool: text, parameters: { [text]: text } }],
  },
  files: {
    "picture.png": { role: "picture", bytes: png([9, 9, 9]) },
    "+a+/_b-.html": { role: "other", bytes: Buffer.from("<script>alert(1)</script>") },
    "exports/mujoco/scene.xml": { role: "export", target: "mujoco", bytes: Buffer.from("<x/>") },
  },
});

/** A case for each of kTexts. */
export const hostileCases = () => kTexts.map(hostile);

/** Elements of a page that no text of a case may have made, and attributes that run code. */
export const intruders = page =>
  page.evaluate(() =>
    [
      ...document.querySelectorAll(
        "svg, iframe, object, embed, style, script:not([src]), h1 ~ h1, body :not(html):is([onerror], [onload])",
      ),
    ]
      .map(e => e.outerHTML.slice(0, 80))
      .concat(
        [...document.querySelectorAll("a, img, script, link")]
          .map(e => e.getAttribute("href") ?? e.getAttribute("src"))
          .filter(
            address =>
              !/^(#|data:,|https:\/\/doi\.org\/|(\.\.\/)*[a-z][a-z0-9./%A-F+_-]*$|[a-z])/i.test(address) ||
              /^javascript:/i.test(address),
          ),
      ),
  );
