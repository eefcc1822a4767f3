// SPDX-License-Identifier: Apache-2.0
// access.mjs FOLDER [all]: tests every page in Chromium without a mouse and without sight, with languages in turn, or
// in both. Checks the names in the accessibility tree, the places that the tab key reaches and their focus marks, the
// effect of keys, announcements of changes, and the contrast of texts in both colour schemes.
import assert from "node:assert/strict";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, all] = process.argv.slice(2);
const { browser, address, close } = await openBrowser(folder);
const patience = { timeout: 300000 };
const complaints = [];
let names = 0, stops = 0, texts = 0, keyed = 0;

function check(holds, otherwise) {
  if (!holds) complaints.push(otherwise);
}

const operable = new Set(["button", "link", "radio", "checkbox", "slider", "combobox", "textbox", "application", "radiogroup", "image"]);
// Names of formats, people and programs are equal in all languages.
const international = /^(Frontmost|English|中文|PNG|SVG|PDF|DXF|[\w.-]+\.(npy|exr|pfm)|D16|D24|F32|Newell, Newell, Sancha|Newell、Newell、Sancha|[A-Z]+|builtin:.*|[\d.]+)$/;
const chinese = /[\u4e00-\u9fff]/;

async function makeReady(page, path, lang) {
  await page.goto(`${address}${path}${path.includes("?") ? "&" : "?"}lang=${lang}`);
  if (path.startsWith("index")) await page.waitForFunction(() => /[0-9a-f]{16}/.test(document.querySelector(".state").textContent), undefined, patience);
  await page.waitForFunction(() => [...document.querySelectorAll(".steps output")].every((output) => /\/ [1-9]/.test(output.textContent)), undefined, patience);
  await page.waitForTimeout(500);
}

/** Checks that every control and picture has a name in the page's language. */
async function checkNames({ page, cdp }, lang, where) {
  check(await page.evaluate(() => document.documentElement.lang) === (lang === "zh" ? "zh-Hans" : "en"), `${where}: lang`);
  const { nodes } = await cdp.send("Accessibility.getFullAXTree");
  for (const { role, name, ignored, properties = [] } of nodes) {
    if (ignored || !operable.has(role?.value)) continue;
    const text = name?.value?.trim() ?? "", isFocusable = properties.some((one) => one.name === "focusable" && one.value.value);
    check(text, `${where}: a ${role.value} without a name`);
    if (!international.test(text)) check(chinese.test(text) === (lang === "zh"), `${where}: ${role.value} '${text}'`);
    // The name must describe the picture and the keys that it takes.
    if (role.value === "application") check(isFocusable && text.length > (lang === "zh" ? 6 : 15), `${where}: '${text}'`);
    ++names;
  }
  const levels = nodes.filter((one) => !one.ignored && one.role?.value === "heading").map((one) => one.properties.find((property) => property.name === "level").value.value);
  check(levels[0] === 1 && levels.lastIndexOf(1) === 0 && levels.every((level, i) => i === 0 || level <= levels[i - 1] + 1), `${where}: headings ${levels.join(" ")}`);
}

/** Collects the elements that the tab key should reach; a group of radio buttons counts once. */
const focusable = () => {
  const seen = new Set(), found = [];
  for (const one of document.querySelectorAll("a[href], button, input, select, [tabindex]")) {
    if (one.tabIndex < 0 || one.disabled || !one.checkVisibility()) continue;
    const group = one.type === "radio" ? `radio ${one.name}` : undefined;
    if (group && seen.has(group)) continue;
    seen.add(group);
    found.push(group ?? one);
  }
  window.expected = found;
  return found.length;
};

/** Collects the element that has the focus after each tab, and whether the focus is visible. */
const focused = () => {
  const one = document.activeElement;
  if (one === document.body) return undefined;
  const outlined = [one, one.nextElementSibling, one.closest("label")].filter(Boolean).some((at) => {
    const { outlineStyle, outlineWidth } = getComputedStyle(at);
    return outlineStyle !== "none" && parseFloat(outlineWidth) >= 2 && at.getBoundingClientRect().width > 4;
  });
  return { number: window.expected.indexOf(one.type === "radio" ? `radio ${one.name}` : one), outlined, what: one.outerHTML.slice(0, 120) };
};

async function checkTabs(page, where) {
  const count = await page.evaluate(focusable), reached = new Set();
  for (let i = 0; i <= count; ++i) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(focused);
    if (!at || (at.number === 0 && reached.size === count)) break; // after the last one: out of the page, or to the first
    check(at.outlined, `${where}: no outline around ${at.what}`);
    check(at.number >= reached.size - 1, `${where}: out of order: ${at.what}`);
    reached.add(at.number);
  }
  const missed = await page.evaluate((numbers) => window.expected.filter((_, i) => !numbers.includes(i)).map((one) => one.outerHTML?.slice(0, 120) ?? one), [...reached]);
  check(missed.length === 0, `${where}: not reached by tab: ${missed.join(", ")}`);
  stops += count;
}

/** Finds visible texts with too little contrast to their background: below 4.5, or below 3 for large text. */
const faintTexts = () => {
  const parse = (color) => {
    const numbers = color.match(/-?[\d.]+(?:e-?\d+)?/g).map(Number), scale = color.startsWith("color(") ? 1 : 255;
    return [...numbers.slice(0, 3).map((n) => n / scale), numbers[3] ?? 1];
  };
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  const behind = (element) => {
    const layers = [];
    for (let at = element; at; at = at.parentElement) {
      const color = parse(getComputedStyle(at).backgroundColor);
      if (color[3] > 0) layers.push(color);
      if (color[3] === 1) break;
    }
    return layers.reverse().reduce((below, above) => over(above, below), [1, 1, 1, 1]);
  };
  const light = (color) => color.slice(0, 3).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
  const faint = [];
  let count = 0;
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const one = walker.currentNode.parentElement;
    if (!walker.currentNode.textContent.trim() || !one.checkVisibility() || one.closest("svg, script, noscript, :disabled, option")) continue;
    const style = getComputedStyle(one), below = behind(one), size = parseFloat(style.fontSize);
    const ratio = contrast(over(parse(style.color), below), below), least = size >= 24 || (size >= 18.66 && style.fontWeight >= 700) ? 3 : 4.5;
    ++count;
    if (ratio < least) faint.push(`${ratio.toFixed(2)} '${walker.currentNode.textContent.slice(0, 40)}' ${style.color} on ${below.map((c) => Math.round(c * 255))}`);
  }
  // Colours of texts that figures write into pictures.
  const root = getComputedStyle(document.documentElement), ink = (name) => {
    const probe = document.createElement("i");
    probe.style.color = root.getPropertyValue(name);
    document.body.append(probe);
    const color = parse(getComputedStyle(probe).color);
    probe.remove();
    return color;
  };
  for (const [text, ground] of [["--ink", "--panel"], ["--soft", "--panel"], ["--accent", "--panel"], ["--blue", "--panel"], ["--bad", "--panel"], ["--green", "--panel"], ["--ink", "--line"], ["--accent-ink", "--accent"], ["--panel", "--blue"], ["--panel", "--accent"]]) {
    const ratio = contrast(ink(text), ink(ground));
    if (ratio < 4.5) faint.push(`${ratio.toFixed(2)} ${text} on ${ground}`);
  }
  return { faint, count };
};

/** The pictures and shapes of a figure, as text. */
const shown = (figure) => figure.evaluate((one) => [...one.querySelectorAll("canvas")].map((canvas) => canvas.toDataURL()).join() + [...one.querySelectorAll("svg")].map((svg) => svg.innerHTML).join());
const told = (figure) => figure.evaluate((one) => [...one.querySelectorAll("[aria-live], [role=status]")].map((region) => region.textContent).join(" | "));

async function becomes(look, before, what) {
  for (let i = 0; i < 1200; ++i) {
    if (await look() !== before) return;
    await new Promise((go) => setTimeout(go, 50));
  }
  check(false, what);
}

/** Checks that every picture with keys responds to them, that steps are announced, and that a file can be picked by a
 * key. */
async function checkKeys(page, where) {
  let choosers = 0;
  page.removeAllListeners("filechooser").on("filechooser", () => ++choosers);
  for (const figure of await page.locator(".figure").all()) {
    for (const picture of await figure.locator('[role="application"]').all()) {
      const before = await shown(figure);
      await picture.focus();
      await page.keyboard.press("ArrowRight");
      await becomes(() => shown(figure), before, `${where}: keys do nothing at ${await picture.getAttribute("aria-label")}`);
      ++keyed;
    }
    if (await figure.locator(".steps").count()) {
      await figure.locator("[data-begin]").focus();
      await page.keyboard.press("Enter");
      await page.waitForTimeout(300);
      const before = await told(figure);
      await figure.locator("[data-on]").focus();
      await page.keyboard.press("Enter");
      await becomes(() => told(figure), before, `${where}: a step is not told`);
      ++keyed;
    }
    for (const picker of await figure.locator("input[type=file]").all()) {
      await picker.focus();
      const before = choosers;
      await page.keyboard.press("Enter");
      await becomes(async () => choosers, before, `${where}: no file is asked for`);
      ++keyed;
    }
  }
}

try {
  const paths = ["index.html?scene=cubes", "lessons.html"];
  // The English page is tested in the light scheme, the Chinese one in the dark one.
  const kinds = [["en", "light"], ["zh", "dark"]], tabs = {};
  for (const [lang, colorScheme] of kinds) {
    const { page, context } = await openPage(browser, { viewport: { width: 1280, height: 900 }, colorScheme });
    tabs[lang] = { page, cdp: await context.newCDPSession(page) };
  }
  await tabs.en.page.goto(`${address}lessons.html?lang=en`);
  paths.push(...await tabs.en.page.locator(".contents a").evaluateAll((links) => links.map((link) => link.getAttribute("href"))));
  for (const [i, path] of paths.entries()) {
    for (const [lang, colorScheme] of all ? kinds : [kinds[i % 2]]) {
      const { page } = tabs[lang];
      await makeReady(page, path, lang);
      const { faint, count } = await page.evaluate(faintTexts);
      check(faint.length === 0, `${path}, ${lang}, ${colorScheme}: ${faint.join("; ")}`);
      texts += count;
      await checkNames(tabs[lang], lang, `${path}, ${lang}`);
      if (lang === "en" || !all) {
        await checkTabs(page, path);
        await checkKeys(page, path);
      }
    }
  }
} finally {
  await close();
}
assert.deepEqual(complaints, []);
console.log(`${names} names in two languages, ${stops} stops of the tab key, ${keyed} things done by keys, ${texts} texts that stand out in two schemes`);
