// SPDX-License-Identifier: Apache-2.0
// page.mjs FOLDER PROGRAM [all]: uses the page in Chromium as people do: every view, every download, a broken file, and
// every lesson stepped to its end, without browser errors. The program, given the command that the page shows, must
// print the hash that the page shows. Languages and widths alternate over the lessons, and every fourth lesson is also
// tested without its module. `all` tests each lesson in both languages and without its module, and opens fifty models
// in a row.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { deflateSync } from "node:zlib";
import { serve } from "../../scripts/page/server.mjs";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, program, extent] = process.argv.slice(2);
const isWhole = extent === "all";
const { browser, address, close } = await openBrowser(folder);
const patience = { timeout: 300000 };
let downloads = 0, steps = 0, lessons = 0, ownModels = 0, memory = [];

const settled = (page) => page.waitForFunction(() => /[0-9a-f]{16}/.test(document.querySelector(".state")?.textContent ?? "") && document.querySelector(".busy")?.hidden, undefined, patience);
const hashOf = async (page) => (await page.locator(".state").textContent()).match(/[0-9a-f]{16}$/)[0];

/** Runs the page's command without its picture, which would be a file. */
async function nativeHash(page) {
  const command = await page.locator("pre.command").textContent();
  const words = command.replace("-o picture.png", "").trim().split(" ").slice(1);
  return execFileSync(program, words, { encoding: "utf8" }).match(/visible ([0-9a-f]{16})/)[1];
}

/** Checks of downloaded files, by file name. */
const checks = [
  [/-lines\.svg$|-figure\.svg$/, (bytes) => /<svg[\s\S]*<\/svg>\s*$/.test(bytes)],
  [/\.pdf$/, (bytes) => bytes.startsWith("%PDF-1.") && bytes.trimEnd().endsWith("%%EOF")],
  [/\.dxf$/, (bytes) => bytes.trimEnd().endsWith("EOF")],
  [/\.npy$/, (bytes) => bytes.slice(1, 6) === "NUMPY"],
  [/\.exr$/, (bytes) => bytes.startsWith("v/1\x01\x02\0\0\0channels\0chlist\0")],
  [/\.pfm$/, (bytes) => bytes.startsWith("Pf\n")],
  [/\.json$/, (bytes) => Object.keys(JSON.parse(bytes)).length > 3],
  [/\.png$/, (bytes) => bytes.slice(1, 4) === "PNG" && bytes.includes("IEND")],
];

async function takeAll(page) {
  for (const button of await page.locator("[data-file]").all()) {
    const [download] = await Promise.all([page.waitForEvent("download", patience), button.click()]);
    const name = download.suggestedFilename(), path = await download.path();
    const [, isGood] = checks.find(([pattern]) => pattern.test(name)) ?? [];
    assert.ok(isGood, `${name}: no check for it`);
    assert.ok(isGood(readFileSync(path, "latin1")), `${name} is not what its name says`);
      if (name.endsWith(".png")) await isReadable(page, path);
    ++downloads;
  }
}

async function isReadable(page, path) {
  const data = readFileSync(path).toString("base64");
  const size = await page.evaluate(async (bytes) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${bytes}`)).blob());
    return [image.width, image.height];
  }, data);
  const canvas = await page.evaluate(() => [document.querySelector("canvas").width, document.querySelector("canvas").height]);
  assert.deepEqual(size, canvas);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  return ~crc >>> 0;
}

/** A PNG of 8-bit red, green, blue and alpha. */
function pngOf(width, height, rgba) {
  const chunk = (name, data) => {
    const named = Buffer.concat([Buffer.from(name), data]), ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc32(named), 4);
    return Buffer.concat([ends.subarray(0, 4), named, ends.subarray(4)]);
  };
  const header = Buffer.alloc(13), rows = Buffer.concat(Array.from({ length: height }, (_, y) => Buffer.from([0, ...rgba.slice(4 * width * y, 4 * width * (y + 1))])));
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 6], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", header), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

/** Drops files on the page, given by name as texts or as bytes in base 64. */
async function drop(page, files) {
  await page.evaluate((all) => {
    const transfer = new DataTransfer();
    for (const [name, content] of Object.entries(all))
      transfer.items.add(new File([typeof content === "string" ? content : Uint8Array.from(atob(content.base64), (c) => c.charCodeAt(0))], name));
    dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, cancelable: true }));
  }, files);
}

/** Tests a square with a texture of 2 x 2 pixels, one nearly transparent: all colours must arrive as stored. */
async function tryTexture(page) {
  const texture = pngOf(2, 2, [255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 250, 128, 6, 255]);
  const files = { "quad.obj": "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n", "quad.mtl": "newmtl m\nmap_Kd texture.png\n" };
  // The header states more pixels than a model's textures may have, so it is refused before decoding.
  const huge = Buffer.from(texture);
  huge.writeUInt32BE(16000, 16);
  huge.writeUInt32BE(16000, 20);
  await drop(page, { ...files, "texture.png": { base64: huge.toString("base64") } });
  await page.waitForFunction(() => document.querySelector(".facts").textContent.includes("too many pixels"), undefined, patience);
  await drop(page, { ...files, "texture.png": { base64: texture.toString("base64") } });
  await page.waitForFunction(() => !document.querySelector(".facts").textContent.includes("too many pixels"), undefined, patience);
  await page.waitForFunction(() => document.querySelector(".facts").textContent.includes("quad"), undefined, patience);
  await settled(page);
  assert.doesNotMatch(await page.locator(".facts").textContent(), /⚠/);
  await page.locator(".row .button").filter({ hasText: /^(Front|前)$/ }).click();
  await settled(page);
  const hues = await page.evaluate(() => {
    const { width, height } = document.querySelector(".stage canvas"), { data } = document.querySelector(".stage canvas").getContext("2d").getImageData(0, 0, width, height);
    const reach = Math.round(Math.min(width, height) / 4.7), at = (x, y) => 4 * (((height >> 1) + y * reach) * width + (width >> 1) + x * reach);
    return [[-1, -1], [1, -1], [-1, 1]].map(([x, y]) => [...data.slice(at(x, y), at(x, y) + 4)]);
  });
  // Each quarter is lit, but has a single hue.
  hues.forEach((pixel, i) => assert.ok(pixel[i] > 80 && pixel.slice(0, 3).every((value, c) => c === i || value < 0.7 * pixel[i]), `${i}: ${pixel}`));
}

/** Compares WebGL's picture of the view; every differing pixel must be explained. */
async function tryWebGL(page) {
  // A double click requests it twice; one result is shown.
  await page.locator("[data-webgl]").dblclick();
  await page.waitForFunction(() => document.querySelectorAll(".beside").length === 1 && document.querySelector(".busy").hidden, undefined, patience);
  const { marks, counts } = await page.evaluate(() => ({ marks: document.querySelectorAll(".beside .plate:first-child circle").length, counts: [...document.querySelectorAll(".beside li b")].map((b) => Number(b.textContent.replaceAll(",", ""))) }));
  assert.ok(counts[0] > 0 && counts[0] < 2000 && marks === counts[0], `${counts} pixels, ${marks} marks`);
  assert.equal(counts.slice(1).reduce((a, b) => a + b, 0), counts[0]);
  assert.equal(await page.locator(".beside li .swatch[style*='--bad']").count(), 0, "a pixel differs for no known reason");
  const [, on, shut] = await page.locator(".beside .verdict .button").all();
  await on.click();
  assert.match(await page.locator(".beside .said").textContent(), /WebGL.*1\/16/);
  assert.equal(await page.locator(".beside .loupe").count(), 2);
  await shut.click();
  await page.waitForSelector(".beside", { ...patience, state: "detached" });
  assert.equal(await page.evaluate(() => document.activeElement === document.querySelector(".stage canvas")), true);
}

async function tryWorkbench(lang, viewport) {
  const { page, complaints, context } = await openPage(browser, { viewport });
  await page.goto(`${address}index.html?lang=${lang}&scene=cubes`);
  await settled(page);
  assert.equal(await hashOf(page), await nativeHash(page), "the program prints another hash than the page");
  // Keys turn the view, and it comes to rest again.
  await page.locator("canvas").first().focus();
  const before = await hashOf(page);
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((old) => !document.querySelector(".state").textContent.includes(old), before, patience);
  await settled(page);
  assert.equal(await hashOf(page), await nativeHash(page), "after it was turned");
  for (const show of await page.locator("input[name=show]").all()) {
    await show.evaluate((input) => input.click());
    await settled(page);
  }
  await page.locator("input[name=show][value=picture]").evaluate((input) => input.click());
  await settled(page);
  await page.locator(".stage canvas").first().click();
  await page.waitForSelector(".hits li", patience);
  await tryWebGL(page);
  if (lang === "en") await takeAll(page);
  const [account, sphere] = await page.locator(".side .button").filter({ hasText: lang === "en" ? /^(Account|Never seen)/ : /^(统计|环绕)/ }).all();
  await account.click();
  await page.waitForSelector("table.hiding tbody tr", patience);
  await sphere.click();
  await page.waitForSelector("table.never tbody tr", patience);
  await drop(page, { "broken.stl": "solid nothing\n facet normal 0 0 what" });
  await page.waitForSelector(".message:not([hidden])", patience);
  assert.match(await page.locator(".message").textContent(), /broken\.stl/);
  await drop(page, { "triangle.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" });
  await page.waitForFunction(() => document.querySelector(".facts").textContent.includes("triangle"), undefined, patience);
  await settled(page);
  await tryTexture(page);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} pixels too wide at ${viewport.width}`);
  assert.deepEqual(complaints, []);
  await context.close();
}

/** Tests a host that sends no headers. The page has no threads at first; from the second visit on it has them, as its
 * service worker adds the missing headers. The hash stays the same. */
async function tryPlainHost() {
  const { server, address: plain } = await serve(folder, 0, {});
  const { page, complaints, context } = await openPage(browser, { serviceWorkers: "allow" });
  const modules = [], hashes = [];
  context.on("request", (request) => /\.wasm$/.test(request.url()) && modules.push(request.url().split("/").at(-1)));
  for (const isIsolated of [false, true]) {
    await page.goto(`${plain}index.html?lang=en&scene=cubes`);
    await settled(page);
    hashes.push(await hashOf(page));
    assert.equal(await page.evaluate(() => crossOriginIsolated), isIsolated);
    await page.evaluate(() => navigator.serviceWorker.ready);
  }
  assert.equal(modules[0], "frontmost.wasm");
  assert.ok(modules.slice(1).includes("frontmost-threads.wasm"), modules.join());
  assert.equal(hashes[0], hashes[1]);
  // Plain http from another machine: the page is not isolated, and lacks the image decoder of secure pages.
  await page.goto(`${plain.replace("127.0.0.1", "plain.test")}index.html?lang=en&scene=cubes`);
  await settled(page);
  assert.deepEqual([await page.evaluate(() => "ImageDecoder" in self || isSecureContext), await hashOf(page)], [false, hashes[0]]);
  await tryTexture(page);
  await page.locator("button", { hasText: "Copy" }).click();
  await page.waitForFunction(() => getSelection().toString().startsWith("frontmost render"), undefined, patience);
  assert.deepEqual(complaints, []);
  await context.close();
  server.close();
}

/** Tests a host that redirects pages: they must be found on the second visit, too. */
async function tryRedirectingHost() {
  const host = createServer(async (request, response) => {
    const { pathname } = new URL(request.url, address);
    if (pathname === "/lessons.html") return response.writeHead(308, { location: "/lessons" }).end();
    const found = await fetch(new URL(pathname === "/lessons" ? "/lessons.html" : pathname, address));
    response.writeHead(found.status, { "content-type": found.headers.get("content-type") ?? "text/plain" }).end(Buffer.from(await found.arrayBuffer()));
  });
  await new Promise((go) => host.listen(0, "127.0.0.1", go));
  const { page, context } = await openPage(browser, { serviceWorkers: "allow" });
  for (let visit = 0; visit < 2; ++visit) {
    await page.goto(`http://127.0.0.1:${host.address().port}/lessons.html?lang=en`);
    await page.waitForSelector(".contents a", patience);
    await page.waitForFunction(() => navigator.serviceWorker.controller, undefined, patience);
  }
  await context.close();
  host.close();
}

/** After one visit, no page needs a network, not even unvisited ones. */
async function tryOffline() {
  const { server, address: gone } = await serve(folder), { page, complaints, context } = await openPage(browser, { serviceWorkers: "allow" });
  // The module takes a second to arrive. Until then the page must not request it again.
  const [answer] = server.listeners("request"), isModule = (request) => !request.serviceWorker() && request.url().endsWith(".wasm");
  server.off("request", answer).on("request", (request, response) => setTimeout(() => answer(request, response), request.url.endsWith(".wasm") ? 1000 : 0));
  let arriving = 0, most = 0;
  context.on("request", (request) => isModule(request) && (most = Math.max(most, ++arriving)));
  for (const end of ["requestfinished", "requestfailed"]) context.on(end, (request) => isModule(request) && --arriving);
  await page.goto(`${gone}index.html?lang=en&scene=cubes`);
  await settled(page);
  const hash = await hashOf(page);
  const areKept = () => page.evaluate(async () => {
    const kept = (await (await caches.open("frontmost")).keys()).map(({ url }) => url), files = await (await fetch("files.json")).json();
    return [...files, "frontmost-threads.mjs", "frontmost-threads.wasm", "frontmost-threads.worker.js"].every((file) => kept.some((url) => url.endsWith(file)));
  });
  while (!(await areKept())) await page.waitForTimeout(50);
  assert.equal(most, 1, "requests for the module at a time");
  server.close();
  server.closeAllConnections();
  await page.goto(`${gone}index.html?lang=en&scene=cubes`);
  await settled(page);
  assert.equal(await hashOf(page), hash);
  await page.goto(`${gone}lesson.html?lesson=z-buffer&lang=zh`);
  await page.waitForFunction(() => /\/ [1-9]/.test(document.querySelector(".steps output")?.textContent ?? ""), undefined, patience);
  assert.deepEqual(complaints.filter((text) => !/ERR_CONNECTION_REFUSED/.test(text)), []);
  await context.close();
}

/** Opens fifty models in turn: memory of the browser's processes must not grow after the first ten. */
async function tryManyModels() {
  const { page, complaints, context } = await openPage(browser, { viewport: { width: 700, height: 400 } });
  const session = await browser.newBrowserCDPSession();
  const mebibytes = async () => {
    const { processInfo } = await session.send("SystemInfo.getProcessInfo");
    const held = processInfo.filter(({ type }) => type === "renderer").map(({ id }) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, "latin1"))?.[1] ?? 0));
    return held.reduce((a, b) => a + b, 0) / 1024;
  };
  await page.goto(`${address}index.html?lang=en&scene=cubes`);
  await settled(page);
  let early = 0;
  for (let i = 0; i < 50; ++i) {
    if (i === 10) early = await mebibytes();
    const name = ["teapot", "gallery", "city", "cubes"][i % 4];
    await page.locator(".side select").selectOption(name);
    await page.waitForFunction((wanted) => document.querySelector(".facts dd").textContent === wanted, name, patience);
    await settled(page);
  }
  const late = await mebibytes();
  assert.ok(late < early + 60, `${early.toFixed(0)} MiB after 10 models, ${late.toFixed(0)} MiB after 50`);
  assert.deepEqual(complaints, []);
  await context.close();
  return [early, late].map(Math.round);
}

const cornerOf = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n";
/** A ball of 5000 triangles, as a file. */
function ballOf(rows = 50, columns = 51) {
  const text = [], corner = (row, column) => row * columns + (column % columns) + 1;
  for (let row = 0; row <= rows; ++row)
    for (let column = 0; column < columns; ++column) {
      const down = (Math.PI * row) / rows, around = (2 * Math.PI * column) / columns;
      text.push(`v ${Math.sin(down) * Math.cos(around)} ${Math.cos(down)} ${Math.sin(down) * Math.sin(around)}`);
    }
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column) {
      if (row > 0) text.push(`f ${corner(row, column)} ${corner(row, column + 1)} ${corner(row + 1, column)}`);
      if (row < rows - 1) text.push(`f ${corner(row, column + 1)} ${corner(row + 1, column + 1)} ${corner(row + 1, column)}`);
    }
  return text.join("\n");
}

const limited = { nscene: "200", bscene: "200" };
/** Gives every figure with scenes three models: a broken one, a small one, and a large one, which some figures show in
 * part. */
async function giveOwnModels(page, id) {
  for (const around of await page.locator(".figure .scenes").all()) {
    const picker = around.locator("input[type=file]"), alert = around.locator("[role=alert]"), own = around.locator('input[value="own"]'), note = around.locator("[role=status]");
    await picker.setInputFiles({ name: "broken.stl", mimeType: "model/stl", buffer: Buffer.from("solid nothing\n facet normal 0 0 what") });
    await around.locator("[role=alert]:not([hidden])").waitFor(patience);
    assert.match(await alert.textContent(), /broken\.stl/, id);
    for (const [name, text, count] of [["corner.obj", cornerOf, "2"], ["ball.obj", ballOf(), "4,998"]]) {
      await picker.setInputFiles({ name, mimeType: "model/obj", buffer: Buffer.from(text) });
      await around.getByText(name, { exact: true }).waitFor(patience);
      assert.ok(await own.isChecked() && await alert.isHidden(), id);
      const most = limited[await own.getAttribute("name")], told = await note.textContent();
      assert.ok(told.includes(count) && (count === "2" || !most || told.includes(most)), `${id}: ${told}`);
      await page.waitForTimeout(300);
    }
    ++ownModels;
  }
}

/** Records the reasons that figures show for missing answers. */
const watchTroubles = () => {
  window.troubles = new Set();
  new MutationObserver(() => document.querySelectorAll(".trouble:not([hidden])").forEach((one) => window.troubles.add(one.textContent)))
    .observe(document, { subtree: true, attributes: true, attributeFilter: ["hidden"] });
};

/** Without its module, every figure must give the reason why it shows nothing. */
async function tryWithoutModule({ page }, id) {
  await page.goto(`${address}lesson.html?lesson=${id}&lang=en`);
  for (const figure of await page.locator(".figure").all())
    if (await figure.locator(".trouble").count()) await figure.locator(".controls > .trouble:not([hidden])").waitFor(patience);
}

async function tryLesson({ page, complaints }, id, lang) {
  await page.goto(`${address}lesson.html?lesson=${id}&lang=${lang}`);
  await page.waitForSelector(".figure", patience);
  // Waits until all figures have their answers.
  await page.waitForFunction(() => [...document.querySelectorAll(".steps output")].every((output) => /\/ [1-9]/.test(output.textContent)), undefined, patience);
  for (const stepper of await page.locator(".steps").all()) {
    const reached = async () => (await stepper.locator("output").textContent()).split("/").map(Number);
    await stepper.locator("[data-begin]").click();
    const [first, most] = await reached();
    assert.ok(most > first, `${id}: nothing to step through`);
    await stepper.locator("[data-on]").click();
    // A step is drawn before its event ends, so these need no frames, which take longer than what they show.
    await stepper.evaluate((one, clicks) => Array.from({ length: clicks }, () => one.querySelector("[data-on]").click()), most - first - 1);
    assert.deepEqual(await reached(), [most, most], `${id}: steps to its end`);
    steps += most - first;
    await stepper.locator("[data-back]").click();
  }
  for (const choice of await page.locator('.choices input:not([value="own"])').all()) await choice.evaluate((input) => input.click());
  assert.ok(await page.evaluate(() => [...document.querySelectorAll(".choices")].every((group) => !group.querySelector('[value="concave"], [value="cubes"]') || group.closest(".scenes"))), `${id}: scenes without one's own`);
  await giveOwnModels(page, id);
  await page.waitForTimeout(300);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${id}: the page is ${wide} pixels too wide`);
  assert.deepEqual(complaints, [], id);
  assert.deepEqual((await page.evaluate(() => [...window.troubles])).filter((text) => !text.includes("broken.stl")), [], id);
  ++lessons;
}

try {
  if (isWhole) memory = await tryManyModels(); // runs alone, as other tests hold memory too
  await Promise.all([tryWorkbench("en", { width: 1280, height: 720 }), tryWorkbench("zh", { width: 390, height: 844 }), tryPlainHost(), tryRedirectingHost(), tryOffline()]);
  const en = await openPage(browser, { viewport: { width: 1280, height: 900 } }), zh = await openPage(browser, { viewport: { width: 390, height: 844 } }), bare = await openPage(browser);
  for (const { page } of [en, zh]) await page.addInitScript(watchTroubles);
  await bare.page.route("**/frontmost*.wasm", (route) => route.abort());
  await en.page.goto(`${address}lessons.html?lang=en`);
  const ids = await en.page.locator(".contents a").evaluateAll((links) => links.map((link) => new URL(link.href).searchParams.get("lesson")));
  assert.ok(ids.length >= 4);
  for (const [i, id] of ids.entries())
    await Promise.all([
      (isWhole || i % 2 === 0) && tryLesson(en, id, "en"),
      (isWhole || i % 2 === 1) && tryLesson(zh, id, "zh"),
      (isWhole || i % 4 === 0) && tryWithoutModule(bare, id),
    ]);
} finally {
  await close();
}
console.log(`${downloads} downloads opened, ${lessons} lessons with ${steps} steps, ${ownModels} figures with a model of one's own, ${isWhole ? `50 models in ${memory[1]} MiB (after 10: ${memory[0]}), ` : ""}no complaint`);
