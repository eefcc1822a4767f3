// SPDX-License-Identifier: Apache-2.0
// hashes.mjs MODULE PROGRAM [MODEL...]: visibility hashes of scenes and views must equal those of the native program,
// called with the flags that the page shows.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { loadModule } from "./module.mjs";

const [path, program, ...models] = process.argv.slice(2);
const frontmost = await loadModule(path);
const { builtin, isa } = frontmost.ask({ ask: "about" });

const views = ["three-quarter", "front", "top", "iso", "left"];
const sizes = [[640, 480], [333, 217], [512, 512], [800, 450], [97, 301]];

function flags(camera, near, far) {
  const list = (numbers) => numbers.map(String).join(",");
  const made = ["--resolution", `${camera.width},${camera.height}`, "--camera-position", list(camera.eye), "--camera-focal-point", list(camera.target),
    "--camera-view-up", list(camera.up), "--camera-view-angle", String(camera.angle), "--near", String(near), "--far", String(far)];
  return camera.orthographic ? [...made, "--camera-orthographic"] : made;
}

let checked = 0;
const wrong = [];
function check(model) {
  views.forEach((view, i) => {
    const [width, height] = sizes[i];
    const camera = frontmost.ask({ ask: "frame", width, height, view, orthographic: i === 3 });
    const { hash, near, far } = frontmost.ask({ ask: "draw", camera, show: "flat", hash: true });
    const told = execFileSync(program, ["render", model, ...flags(camera, near, far), "--hash"], { encoding: "utf8" });
    const native = told.match(/visible ([0-9a-f]{16})/)[1];
    ++checked;
    if (native !== hash) wrong.push(`${model} ${view}: ${hash}, and native ${native}`);
  });
}

for (const name of builtin) {
  frontmost.ask({ ask: "builtin", name });
  check(`builtin:${name}`);
}
for (const model of models) {
  frontmost.open(basename(model), readFileSync(model));
  check(model);
}
if (checked < 30 || wrong.length > 0) {
  console.error(wrong.join("\n"));
  console.error(`${wrong.length} of ${checked} hashes differ (${isa})`);
  process.exit(1);
}
console.log(`${checked} hashes of scenes and views equal those of the program (${isa})`);
process.exit(0); // waiting threads would keep Node alive
