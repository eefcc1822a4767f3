// SPDX-License-Identifier: Apache-2.0
// speed.mjs MODULE PROGRAM [PAGE]: times of the z-buffer and of shading, for a picture at rest and while the view
// turns. Runs in Node, and in Chromium if a page is given, on one thread and on all, beside the program's z-buffer on
// one thread with SSE4 on the same views. Each time is the least of 30 frames in milliseconds, as machines are shared.
import { execFileSync } from "node:child_process";
import { openBrowser, openPage } from "../../tests/web/browser.mjs";
import { loadModule } from "../../tests/web/module.mjs";

const [path, program, folder] = process.argv.slice(2);
const scenes = ["teapot", "gallery", "city"], frames = 30;
const size = { width: 1280, height: 720 };

/** Measures with `ask`, in Node and in Chromium alike. */
function measure(ask, name, { width, height }, count) {
  ask({ ask: "builtin", name });
  const camera = ask({ ask: "frame", width, height, view: "three-quarter" });
  let see = Infinity, shade = Infinity, quick = Infinity;
  for (let i = 0; i < count; ++i) {
    const { milliseconds } = ask({ ask: "draw", camera, show: "picture" });
    see = Math.min(see, milliseconds.see);
    shade = Math.min(shade, milliseconds.shade);
    quick = Math.min(quick, ask({ ask: "draw", camera, show: "picture", coarse: true, shadows: false }).milliseconds.shade);
  }
  return { see, shade, quick };
}

function native(name) {
  const told = execFileSync(program, ["render", `builtin:${name}`, "--resolution", `${size.width},${size.height}`, "--threads", "1", "--isa", "sse4", "--samples", "1",
    "--repeat", String(frames), "--json"], { encoding: "utf8" });
  return JSON.parse(told).timings_ms.visible.min;
}

/** Runs in a worker, as the page does: only a worker may wait for threads. */
async function inChromium(module) {
  const { browser, address, close } = await openBrowser(folder);
  const { page } = await openPage(browser);
  await page.goto(`${address}lessons.html`);
  const found = await page.evaluate(([measured, name, names, one, count]) => {
    const body = `onmessage = async () => {
      const { default: create } = await import("${new URL(name, location.href)}");
      const m = await create({});
      const ask = (question) => {
        const text = JSON.stringify(question), bytes = m.lengthBytesUTF8(text) + 1, at = m._malloc(bytes);
        m.stringToUTF8(text, at, bytes);
        const answer = JSON.parse(m.UTF8ToString(m._frontmost_ask(at)));
        m._free(at);
        return answer;
      };
      const measure = ${measured};
      postMessage(${JSON.stringify(names)}.map((scene) => measure(ask, scene, ${JSON.stringify(one)}, ${count})));
    };`;
    const worker = new Worker(URL.createObjectURL(new Blob([body], { type: "text/javascript" })), { type: "module" });
    return new Promise((found, fail) => {
      worker.onmessage = (event) => found(event.data);
      worker.onerror = (event) => fail(new Error(event.message));
      worker.postMessage(0);
    });
  }, [measure.toString(), module, scenes, size, frames]);
  await close();
  return found;
}

async function inNode(module) {
  const frontmost = await loadModule(module);
  return scenes.map((name) => measure((question) => frontmost.ask(question), name, size, frames));
}

const columns = [await inNode(path), await inNode(path.replace(".mjs", "-threads.mjs"))];
if (folder) columns.push(await inChromium("frontmost.mjs"), await inChromium("frontmost-threads.mjs"));
console.log(`z-buffer + shading (while it turns), ms: program; Node, one thread, all; Chromium, one thread, all`);
scenes.forEach((name, i) => {
  const cells = columns.map((column) => `${column[i].see.toFixed(1).padStart(7)} +${column[i].shade.toFixed(1).padStart(6)} (${column[i].quick.toFixed(1)})`);
  console.log(name.padEnd(30), native(name).toFixed(1).padStart(8), ...cells);
});
process.exit(0); // waiting threads would keep Node alive
