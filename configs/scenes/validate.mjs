#!/usr/bin/env node
// Runs the Khronos glTF validator on .glb files and prints a line for each.
// Needs the npm package `gltf-validator` in a node_modules folder above this
// file, above the current folder, or in a folder listed in NODE_PATH.
// Exits 1 if any file has an error or a warning, 2 on wrong usage.

import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { basename, join } from 'node:path';
import { fileURLToPath } from 'node:url';

function loadValidator() {
  // require(), unlike import, also looks into NODE_PATH.
  const places = [fileURLToPath(import.meta.url), join(process.cwd(), 'here.js')];
  for (const place of places) {
    try {
      return createRequire(place)('gltf-validator');
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  console.error('gltf-validator not found: npm install gltf-validator, or set NODE_PATH');
  process.exit(2);
}

const SEVERITIES = ['error', 'warning', 'info', 'hint'];

async function validate(validator, path) {
  const bytes = new Uint8Array(await readFile(path));
  const report = await validator.validateBytes(bytes, { uri: basename(path), maxIssues: 0 });
  const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, ` +
    `${numInfos} infos, ${numHints} hints, ${report.info?.totalTriangleCount ?? 0} triangles`);
  for (const { severity, code, message, pointer } of messages) {
    if (severity < 2 || process.env.VERBOSE) {
      console.log(`  ${SEVERITIES[severity]} ${code} ${pointer ?? ''}: ${message}`);
    }
  }
  return numErrors + numWarnings === 0;
}

const paths = process.argv.slice(2);
if (paths.length === 0) {
  console.error('usage: validate.mjs FILE.glb...   (VERBOSE=1 lists infos and hints too)');
  process.exit(2);
}
const validator = loadValidator();
let good = true;
for (const path of paths) {
  try {
    good = (await validate(validator, path)) && good;
  } catch (error) {
    console.log(`${path}: cannot be validated: ${error.message ?? error}`);
    good = false;
  }
}
process.exit(good ? 0 : 1);
