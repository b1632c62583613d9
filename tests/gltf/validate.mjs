// node validate.mjs FILE...: runs the Khronos validator, prints the counts of each file, exits 1 on any error
// or warning.
// The validator is looked for beside this script, or in the folder named by SWARF_GLTF_MODULES.
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const modules = process.env.SWARF_GLTF_MODULES;
const require = createRequire(modules ? join(modules, 'package.json') : import.meta.url);
const validator = require('gltf-validator');

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: validate.mjs FILE...');
  process.exit(1);
}
let errors = 0;
for (const file of files) {
  try {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { uri: file });
    const { numErrors, numWarnings, numInfos, messages } = report.issues;
    // What our own extension is named for is not looked into: information, no warning.
    errors += numErrors + numWarnings;
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
    for (const message of messages.slice(0, 20)) {
      console.log(`  ${message.code} at ${message.pointer ?? message.offset}: ${message.message}`);
    }
  } catch (problem) {
    errors += 1;
    console.log(`${file}: not glTF: ${problem}`);
  }
}
process.exit(errors > 0 ? 1 : 0);
