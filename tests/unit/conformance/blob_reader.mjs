// SPDX-License-Identifier: Apache-2.0
// libblob in WebAssembly behind the protocol of spec/conformance/README.md:
// blob_reader.mjs BLOB.wasm < lines
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { Flags, NOWHERE, Status, load } from "../../../libblob/wasm/blob.mjs";

const blob = await load(readFileSync(process.argv[2]));

/** Answers to all questions at once, each from where its point came from. */
function ask(model, questions, flags) {
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

function reply({ file, questions }) {
  let model;
  try {
    model = blob.open(readFileSync(file));
  } catch (error) {
    const code = { [Status.NO_MODELS]: "NO_MODELS", [Status.ENCODING]: "CHUNK_ENCODING" }[error.status];
    return { accepted: false, code: code ?? `STATUS_${error.status}`, message: error.message };
  }
  const local = ask(model, questions, Flags.LOCAL), blended = ask(model, questions, 0);
  model.close();
  const answers = local.map((answer, i) => ({ ...answer, blended: blended[i],
    node: answer.node === blended[i].node ? answer.node : null }));
  return { accepted: true, answers };
}

for await (const line of createInterface({ input: process.stdin })) console.log(JSON.stringify(reply(JSON.parse(line))));
