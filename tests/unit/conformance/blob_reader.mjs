// SPDX-License-Identifier: Apache-2.0
// libblob in WebAssembly behind the protocol of spec/conformance/README.md:
// blob_reader.mjs BLOB.wasm FILE < questions.json
import { readFileSync } from "node:fs";
import { Flags, NOWHERE, Status, load } from "../../../libblob/wasm/blob.mjs";

const [wasm, lumen] = process.argv.slice(2).map(file => readFileSync(file));
const questions = JSON.parse(readFileSync(0, "utf8"));
const blob = await load(wasm);

/** Answers to all questions at once, each from where its point came from. */
function ask(model, flags) {
  const batch = model.batch(questions.length);
  batch.points.set(questions.flatMap(question => question.point));
  batch.cursors.set(questions.map(question => question.current ?? NOWHERE));
  batch.query(flags);
  const answers = questions.map((_, i) => {
    const { node, value, gradient, inside } = batch.sample(i);
    return { node, value, gradient: [...gradient], inside };
  });
  batch.free();
  return answers;
}

function read() {
  let model;
  try {
    model = blob.open(lumen);
  } catch (error) {
    const code = { [Status.NO_MODELS]: "NO_MODELS", [Status.ENCODING]: "CHUNK_ENCODING" }[error.status];
    return { accepted: false, code: code ?? `STATUS_${error.status}`, message: error.message };
  }
  const local = ask(model, Flags.LOCAL), blended = ask(model, 0);
  model.close();
  const answers = local.map((answer, i) => ({ ...answer, blended: blended[i],
    node: answer.node === blended[i].node ? answer.node : null }));
  return { accepted: true, answers };
}

console.log(JSON.stringify(read()));
