// SPDX-License-Identifier: Apache-2.0
// page.mjs FOLDER PROGRAM: the page as people use it, in Chromium: every view, every download, a broken file, every lesson
// stepped to its end, in both languages, without a complaint of the browser. The command that the page shows, given to
// the program, prints the hash that the page shows.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, program] = process.argv.slice(2);
const { browser, address, close } = await openBrowser(folder);
const patience = { timeout: 60000 };
let downloads = 0, steps = 0, lessons = 0, ownModels = 0;

const settled = (page) => page.waitForFunction(() => /[0-9a-f]{16}/.test(document.querySelector(".state")?.textContent ?? "") && document.querySelector(".busy")?.hidden, undefined, patience);
const hashOf = async (page) => (await page.locator(".state").textContent()).match(/[0-9a-f]{16}$/)[0];

/** Runs the command of the page; not its picture, which would be a file. */
async function nativeHash(page) {
  const command = await page.locator("pre.command").textContent();
  const words = command.replace("-o picture.png", "").trim().split(" ").slice(1);
  return execFileSync(program, words, { encoding: "utf8" }).match(/visible ([0-9a-f]{16})/)[1];
}

/** What must be true of a file by its name. */
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

async function drop(page, name, content) {
  await page.evaluate(([file, text]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], file));
    dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, cancelable: true }));
  }, [name, content]);
}

async function tryWorkbench(lang, viewport) {
  const { page, complaints, context } = await openPage(browser, { viewport });
  await page.goto(`${address}index.html?lang=${lang}&scene=cubes`);
  await settled(page);
  assert.equal(await hashOf(page), await nativeHash(page), "the program prints another hash than the page");
  // Turned by keys, and it rests again.
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
  if (lang === "en") await takeAll(page);
  const [account, sphere] = await page.locator(".side .button").filter({ hasText: lang === "en" ? /^(Account|Never seen)/ : /^(统计|环绕)/ }).all();
  await account.click();
  await page.waitForSelector("table.hiding tbody tr", patience);
  await sphere.click();
  await page.waitForSelector("table.never tbody tr", patience);
  await drop(page, "broken.stl", "solid nothing\n facet normal 0 0 what");
  await page.waitForSelector(".message:not([hidden])", patience);
  assert.match(await page.locator(".message").textContent(), /broken\.stl/);
  await drop(page, "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  await page.waitForFunction(() => document.querySelector(".facts").textContent.includes("triangle"), undefined, patience);
  await settled(page);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} pixels too wide at ${viewport.width}`);
  assert.deepEqual(complaints, []);
  await context.close();
}

const cornerOf = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n";
/** Every figure that takes a model of one's own is given a broken one, and a good one. */
async function giveOwnModels(page, id) {
  for (const picker of await page.locator(".figure input[type=file]").all()) {
    const around = picker.locator("xpath=..");
    await picker.setInputFiles({ name: "broken.stl", mimeType: "model/stl", buffer: Buffer.from("solid nothing\n facet normal 0 0 what") });
    await around.locator("[role=alert]:not([hidden])").waitFor(patience);
    assert.match(await around.locator("[role=alert]").textContent(), /broken\.stl/, id);
    await picker.setInputFiles({ name: "corner.obj", mimeType: "model/obj", buffer: Buffer.from(cornerOf) });
    await around.locator('input[value="own"]:checked').waitFor({ ...patience, state: "attached" });
    ++ownModels;
  }
}

async function tryLesson(id, lang, viewport) {
  const { page, complaints, context } = await openPage(browser, { viewport });
  await page.goto(`${address}lesson.html?lesson=${id}&lang=${lang}`);
  await page.waitForSelector(".figure", patience);
  // Figures have asked, and were answered.
  await page.waitForFunction(() => [...document.querySelectorAll(".steps output")].every((output) => /\/ [1-9]/.test(output.textContent)), undefined, patience);
  for (const stepper of await page.locator(".steps").all()) {
    await stepper.locator("[data-begin]").click();
    for (;;) {
      const [at, most] = (await stepper.locator("output").textContent()).split("/").map(Number);
      assert.ok(most > 0, `${id}: nothing to step through`);
      if (at === most) break;
      await stepper.locator("[data-on]").click();
      ++steps;
    }
    await stepper.locator("[data-back]").click();
  }
  for (const choice of await page.locator('.choices input:not([value="own"])').all()) await choice.evaluate((input) => input.click());
  await giveOwnModels(page, id);
  await page.waitForTimeout(300);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${id}: the page is ${wide} pixels too wide at ${viewport.width}`);
  assert.deepEqual(complaints, [], id);
  await context.close();
  ++lessons;
}

try {
  await tryWorkbench("en", { width: 1280, height: 720 });
  await tryWorkbench("zh", { width: 390, height: 844 });
  const { page, context } = await openPage(browser);
  await page.goto(`${address}lessons.html?lang=en`);
  const ids = await page.locator(".contents a").evaluateAll((links) => links.map((link) => new URL(link.href).searchParams.get("lesson")));
  await context.close();
  assert.ok(ids.length >= 4);
  for (const id of ids)
    for (const [lang, viewport] of [["en", { width: 1280, height: 900 }], ["zh", { width: 390, height: 844 }]]) await tryLesson(id, lang, viewport);
} finally {
  await close();
}
console.log(`${downloads} downloads opened, ${lessons} lessons with ${steps} steps, ${ownModels} figures with a model of one's own, no complaint`);
