// Prints one line a file given: "errors warnings infos hints name", then the messages. Khronos' validator does the work.
// usage: node validate_gltf.js FOLDER_OF_gltf-validator FILE...
const fs = require('fs');
const path = require('path');

const [modules, ...files] = process.argv.slice(2);
const validator = require(path.join(modules, 'gltf-validator'));

async function validate(file) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    externalResourceFunction: async (uri) =>
        new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
  });
  const found = report.issues;
  console.log(`${found.numErrors} ${found.numWarnings} ${found.numInfos} ${found.numHints} ${path.basename(file)}`);
  for (const message of found.messages) console.log(`  ${message.code} ${message.pointer}: ${message.message}`);
}

(async () => {
  for (const file of files) await validate(file);
})().catch((error) => {
  console.error(String(error));
  process.exit(1);
});
