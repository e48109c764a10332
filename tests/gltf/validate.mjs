// SPDX-License-Identifier: Apache-2.0
// Runs the Khronos glTF validator on files: node validate.mjs FILE...
// Prints code, severity, place and message of each finding; exits 1 on any error or warning, 2 on misuse.
import { readFile } from 'node:fs/promises';
import { basename } from 'node:path';
import validator from 'gltf-validator';

const severities = ['error', 'warning', 'information', 'hint'];

async function check(file) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 0,
  });
  const { messages, numErrors, numWarnings } = report.issues;
  for (const m of messages) {
    const place = m.pointer ?? `byte ${m.offset ?? 0}`;
    console.log(`${basename(file)}: ${m.code} ${severities[m.severity]} ${place} ${m.message}`);
  }
  const { totalVertexCount, totalTriangleCount } = report.info;
  console.log(
    `${basename(file)}: ${numErrors} errors, ${numWarnings} warnings, ` +
      `${totalVertexCount} vertices, ${totalTriangleCount} triangles`,
  );
  return numErrors === 0 && numWarnings === 0;
}

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate.mjs FILE...');
  process.exit(2);
}
let clean = true;
for (const file of files) {
  try {
    clean = (await check(file)) && clean;
  } catch (error) {
    console.log(`${basename(file)}: ${error}`);
    clean = false;
  }
}
process.exit(clean ? 0 : 1);
