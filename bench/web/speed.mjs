// SPDX-License-Identifier: Apache-2.0
// speed.mjs MODULE PROGRAM [PAGE]: the z-buffer and shading in Node, and in Chromium where a page is given, beside the
// program on one thread with SSE4, on the same views: the least of 30 frames, in milliseconds, as machines are shared.
import { execFileSync } from "node:child_process";
import { openBrowser, openPage } from "../../tests/web/browser.mjs";
import { loadModule } from "../../tests/web/module.mjs";

const [path, program, folder] = process.argv.slice(2);
const scenes = ["teapot", "gallery", "city"], frames = 30;
const size = { width: 1280, height: 720 };

/** In Node and in Chromium alike: of a function that asks. */
function measure(ask, name, { width, height }, count) {
  ask({ ask: "builtin", name });
  const camera = ask({ ask: "frame", width, height, view: "three-quarter" });
  let see = Infinity, shade = Infinity;
  for (let i = 0; i < count; ++i) {
    const { milliseconds } = ask({ ask: "draw", camera, show: "picture" });
    see = Math.min(see, milliseconds.see);
    shade = Math.min(shade, milliseconds.shade);
  }
  return { see, shade };
}

function native(name) {
  const told = execFileSync(program, ["render", `builtin:${name}`, "--resolution", `${size.width},${size.height}`, "--threads", "1", "--isa", "sse4", "--samples", "1",
    "--repeat", String(frames), "--json"], { encoding: "utf8" });
  return JSON.parse(told).timings_ms.visible.min;
}

async function inChromium() {
  const { browser, address, close } = await openBrowser(folder);
  const { page } = await openPage(browser);
  await page.goto(`${address}lessons.html`);
  const found = await page.evaluate(async ([measured, names, one, count]) => {
    const { default: create } = await import(new URL("frontmost.mjs", location.href));
    const m = await create({});
    const ask = (question) => {
      const text = JSON.stringify(question), bytes = m.lengthBytesUTF8(text) + 1, at = m._malloc(bytes);
      m.stringToUTF8(text, at, bytes);
      const answer = JSON.parse(m.UTF8ToString(m._frontmost_ask(at)));
      m._free(at);
      return answer;
    };
    const run = new Function(`return ${measured}`)();
    return names.map((name) => run(ask, name, one, count));
  }, [measure.toString(), scenes, size, frames]);
  await close();
  return found;
}

const frontmost = await loadModule(path);
const inNode = scenes.map((name) => measure((question) => frontmost.ask(question), name, size, frames));
const chromium = folder ? await inChromium() : undefined;
console.log("scene     native  Node see  shade  Chromium see  shade");
scenes.forEach((name, i) => {
  const numbers = [native(name), inNode[i].see, inNode[i].shade, chromium?.[i].see, chromium?.[i].shade];
  console.log(name.padEnd(10), numbers.map((n) => (n === undefined ? "-" : n.toFixed(1)).padStart(7)).join(" "));
});
