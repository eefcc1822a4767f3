// SPDX-License-Identifier: Apache-2.0
// peers.mjs PAGE: the module beside WebGL on SwiftShader and beside three.js's SVGRenderer, in one run of one Chromium,
// at 1280x720. Measures triangle ids, the least time of 30 frames each; and shaded polygons as SVG, the least time of
// 10, with the number of wrong pixels in 12 views all around.
import { readFileSync } from "node:fs";
import { openBrowser, openPage } from "../../tests/web/browser.mjs";

const [folder] = process.argv.slice(2);
const { browser, address, close } = await openBrowser(folder, ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
const { page } = await openPage(browser);
const modules = new URL("../../web/page/node_modules/", import.meta.url);
const imports = { three: "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/" };
const hand = (path, contentType, body) => page.route(`${address}${path}`, (route) => route.fulfill({ contentType, body: body(route.request().url().slice(address.length)) }));
await hand("bench.html", "text/html", () => `<script type="importmap">${JSON.stringify({ imports })}</script>`);
await hand("peers_page.mjs", "text/javascript", () => readFileSync(new URL("peers_page.mjs", import.meta.url)));
await hand("three/**", "text/javascript", (path) => readFileSync(new URL(path, modules)));
await page.goto(`${address}bench.html`);
const run = (what, ...args) => page.evaluate(async ([name, given]) => (await import("./peers_page.mjs"))[name](...given), [what, args]);

const columns = (...values) => console.log(values.map((value, i) => (i === 0 ? String(value).padEnd(12) : String(value).padStart(15))).join(""));
try {
  const { version } = JSON.parse(readFileSync(new URL("three/package.json", modules), "utf8"));
  columns("ids", "triangles", "module, ms", "WebGL, ms", "times", "other pixels");
  let renderer;
  for (const name of ["teapot", "gallery", "city"]) {
    const found = await run("compareIds", name, 30);
    columns(name, found.triangles, found.module.toFixed(1), found.webgl.toFixed(1), (found.webgl / found.module).toFixed(1), found.differing);
    ({ renderer } = found);
  }
  console.log(`Chromium ${browser.version()}, ${renderer}, three.js ${version}`);
  for (const name of ["cubes", "cycle", "teapot"]) {
    const { triangles, times, lengths, wrong } = await run("compareSvg", name, 10, 12);
    console.log();
    columns(name, `${triangles} triangles`, "ms", "kB", "wrong, median", "wrong, most");
    for (const who of ["module", "three"]) {
      const sorted = wrong[who].sort((a, b) => a - b);
      columns(who === "three" ? "SVGRenderer" : who, "", times[who].toFixed(1), (lengths[who] / 1000).toFixed(1), sorted[sorted.length / 2], sorted.at(-1));
    }
  }
} finally {
  await close();
}
