// validate.js FILE.glb...: what Khronos' validator says of each, one JSON object a line.
// Finds the package in NODE_PATH, where tools/gltf/install.sh puts it.
"use strict";
const fs = require("fs");
const validator = require("gltf-validator");

async function main(paths) {
  for (const path of paths) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)), { maxIssues: 20 });
    console.log(JSON.stringify({ path, issues: report.issues, info: report.info }));
  }
}

main(process.argv.slice(2)).catch((problem) => {
  console.error(String(problem));
  process.exit(1);
});
