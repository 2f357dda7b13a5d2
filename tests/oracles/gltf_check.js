// Holds binary glTF files against the validator of Khronos: no error, no warning, no hint, no information.
const fs = require('fs');
const validator = require('gltf-validator');

async function main() {
  let bad = 0;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const { numErrors, numWarnings, numHints, numInfos, messages } = report.issues;
    if (numErrors + numWarnings + numHints + numInfos > 0) {
      bad += 1;
      console.error(file, JSON.stringify(messages.slice(0, 5)));
    }
  }
  process.exit(bad ? 1 : 0);
}
main();
