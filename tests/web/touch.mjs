// SPDX-License-Identifier: Apache-2.0
// touch.mjs FOLDER [all]: tests the page and every second lesson, or all, by touch in Chromium. One finger turns the
// view, two zoom and move it, and a tap picks. Pages scroll, wherever a finger starts.
import assert from "node:assert/strict";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, all] = process.argv.slice(2);
const { browser, address, close } = await openBrowser(folder);
const patience = { timeout: 300000 }, phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
let pictures = 0;

async function openPhone(path, more = {}) {
  const { page, context } = await openPage(browser, { ...phone, ...more });
  await page.goto(address + path);
  return { page, context, cdp: await context.newCDPSession(page) };
}

/** Moves fingers at once, each [x, y, toX, toY]. */
async function drag(cdp, ...fingers) {
  const at = (share) => fingers.map(([x, y, toX, toY], id) => ({ x: x + (toX - x) * share, y: y + (toY - y) * share, id }));
  await cdp.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
  for (let i = 1; i <= 10; ++i) {
    await cdp.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(i / 10) });
    await new Promise((go) => setTimeout(go, 16));
  }
  await cdp.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

/** The middle of the picture, and how far fingers may move. */
async function middleOf(locator) {
  await locator.evaluate((one) => one.scrollIntoView({ block: "center" }));
  const { x, y, width, height } = await locator.boundingBox();
  return { x: x + width / 2, y: y + height / 2, far: Math.min(width, height) / 3 };
}

const settled = (page) => page.waitForFunction(() => /[0-9a-f]{16}/.test(document.querySelector(".state")?.textContent ?? "") && document.querySelector(".busy")?.hidden, undefined, patience);
/** Eye and target, from the command that the page shows. */
async function cameraOf(page) {
  const command = await page.locator("pre.command").textContent();
  const [eye, target] = ["position", "focal-point"].map((name) => command.match(new RegExp(`--camera-${name} (\\S+)`))[1].split(",").map(Number));
  return { eye, target, away: Math.hypot(...eye.map((n, i) => n - target[i])) };
}
const apart = (a, b) => Math.hypot(...a.map((n, i) => n - b[i]));

async function tryWorkbench() {
  const { page, context, cdp } = await openPhone("index.html?lang=en&scene=teapot");
  await settled(page);
  const { x, y, far } = await middleOf(page.locator(".stage canvas").first());
  const after = async (...fingers) => {
    const old = await page.locator("pre.command").textContent();
    await drag(cdp, ...fingers);
    await page.waitForFunction((before) => document.querySelector("pre.command").textContent !== before, old, patience);
    await settled(page);
    return cameraOf(page);
  };
  const before = await cameraOf(page);
  const turned = await after([x, y, x + far, y + far / 2]);
  assert.ok(apart(turned.eye, before.eye) > 0.1 * before.away && apart(turned.target, before.target) < 1e-9 * before.away, "one finger turns");
  assert.ok(Math.abs(turned.away / before.away - 1) < 1e-9);
  const near = await after([x - 30, y, x - far, y], [x + 30, y, x + far, y]);
  assert.ok(near.away < 0.6 * turned.away, "two fingers that part come nearer");
  const moved = await after([x - 30, y - far / 2, x - 30, y + far / 2], [x + 30, y - far / 2, x + 30, y + far / 2]);
  assert.ok(apart(moved.target, near.target) > 0.02 * near.away, "two fingers move");
  assert.ok(Math.abs(moved.away / near.away - 1) < 0.01);
  assert.equal(await page.evaluate(() => scrollY), 0, "the picture scrolls the page");
  await page.touchscreen.tap(x, y);
  await page.waitForSelector(".hits li", patience);
  await drag(cdp, [195, 800, 195, 560]);
  await page.waitForFunction(() => scrollY > 100, undefined, patience);
  await context.close();
  const lying = await openPhone("index.html?lang=en&scene=cubes", { viewport: { width: 844, height: 390 } });
  await settled(lying.page);
  const { y: top, height } = await lying.page.locator(".stage").boundingBox();
  assert.ok(top + height < 390 - 60, "a phone that lies has room to scroll");
  await lying.context.close();
}

/** All pictures of a figure, and the shapes over them. */
const shown = (figure) => figure.evaluate((one) => [...one.querySelectorAll("canvas")].map((canvas) => canvas.toDataURL()).join() + [...one.querySelectorAll("svg")].map((svg) => svg.innerHTML).join());

/** The figure's content after all requests have finished. */
async function atRest(figure) {
  for (let last = "", same = 0; ; await new Promise((go) => setTimeout(go, 200))) {
    const now = await shown(figure);
    same = now === last ? same + 1 : 0;
    if (same === 3) return now;
    last = now;
  }
}

async function changes(figure, act, what) {
  const before = await shown(figure);
  await act();
  for (let i = 0; i < 1200; ++i) {
    await new Promise((go) => setTimeout(go, 50));
    if (await shown(figure) !== before) return;
  }
  assert.fail(what);
}

async function tryLesson({ page, cdp }, id) {
  await page.goto(`${address}lesson.html?lesson=${id}&lang=en`);
  await page.waitForFunction(() => [...document.querySelectorAll(".steps output")].every((output) => /\/ [1-9]/.test(output.textContent)), undefined, patience);
  await page.waitForTimeout(500);
  const top = () => page.evaluate(() => Math.round(scrollY));
  for (const figure of await page.locator(".figure").all())
    for (const picture of await figure.locator(".picture canvas, .picture svg:not(.marks)").all()) {
      const name = `${id}: ${await picture.getAttribute("aria-label")}`;
      const keys = await picture.getAttribute("role") === "application", turns = keys && /turn/.test(name);
      let { x, y, far } = await middleOf(picture), at = await top();
      if (turns) {
        await changes(figure, () => drag(cdp, [x, y, x + far, y + 8]), `${name}: one finger`);
        await changes(figure, () => drag(cdp, [x - 20, y, x - far, y - 80], [x + 20, y, x + far, y - 80]), `${name}: two fingers`);
      } else if (keys && /pixel/.test(name)) await changes(figure, () => page.touchscreen.tap(x - far / 2, y), `${name}: a tap`);
      // Texts below and above may now take more lines.
      assert.ok(Math.abs(await top() - at) < 30, `${name}: the page went along`);
      at = await top();
      assert.equal(await page.evaluate(() => visualViewport.scale), 1, `${name}: the page grew`);
      const still = turns && await atRest(figure);
      // Scrolls down, or up if the page ends below.
      const room = await page.evaluate(() => document.documentElement.scrollHeight - innerHeight - scrollY);
      await drag(cdp, [x, y, x + 4, y + (room > 200 ? -120 : 120)]);
      await page.waitForFunction((old) => Math.abs(scrollY - old) > 60, at, patience).catch(() => assert.fail(`${name}: the page does not scroll`));
      if (still) assert.ok(await atRest(figure) === still, `${name}: turned while the page scrolls`);
      ++pictures;
    }
}

try {
  await tryWorkbench();
  const opened = await openPhone("lessons.html?lang=en");
  const ids = await opened.page.locator(".contents a").evaluateAll((links) => links.map((link) => new URL(link.href).searchParams.get("lesson")));
  for (const [i, id] of ids.entries()) if (all || i % 2 === 0) await tryLesson(opened, id);
} finally {
  await close();
}
console.log(`the workbench and ${pictures} pictures of lessons under one finger and two`);
