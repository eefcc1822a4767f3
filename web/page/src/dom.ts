// SPDX-License-Identifier: Apache-2.0
// Makes elements by one call, and the bar at the top of every page.
import { language, say, switchLanguage, type Text } from "./language.ts";

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | ((event: never) => void) | undefined>;

/** Attributes whose names begin with "on" are listeners; false ones are left out. */
export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name.slice(2), value as EventListener);
    else if (value !== false && value !== undefined) made.setAttribute(name, value === true ? "" : String(value));
  }
  made.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
  return made;
}

/** A choice of one among several options, as radio buttons. */
export function choices(name: string, label: string, options: [string, string][], chosen: string, change: (value: string) => void): HTMLElement {
  const group = element("div", { class: "choices", role: "radiogroup", "aria-label": label });
  for (const [value, text] of options) {
    const input = element("input", { type: "radio", name, value, checked: value === chosen });
    input.addEventListener("change", () => change(value));
    group.append(element("label", {}, input, element("span", {}, text)));
  }
  return group;
}

export interface Slider { field: HTMLElement; input: HTMLInputElement }
export function slider(label: string, range: { min: number; max: number; step: number; value: number }, show: (value: number) => string, change: (value: number) => void): Slider {
  const output = element("output", {}, show(range.value));
  const input = element("input", { type: "range", ...range, "aria-label": label });
  input.addEventListener("input", () => {
    output.textContent = show(Number(input.value));
    change(Number(input.value));
  });
  return { field: element("label", { class: "field" }, element("span", {}, label), input, output), input };
}

/** Sliders for a figure's settings: each changes its setting and then calls `changed`. */
export function sliders<K extends string>(settings: Record<K, number>, changed: () => void) {
  return (label: string, key: K, min: number, max: number, step: number, show: (value: number) => string): HTMLElement =>
    slider(label, { min, max, step, value: settings[key] }, show, (value) => {
      settings[key] = value;
      changed();
    }).field;
}

const titles = {
  workbench: { en: "Workbench", zh: "工作台" },
  lessons: { en: "Lessons", zh: "课程" },
  theme: { en: "Light or dark", zh: "浅色或深色" },
} satisfies Record<string, Text>;

function switchTheme(): void {
  const root = document.documentElement;
  const isDark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = isDark ? "light" : "dark";
  localStorage.setItem("theme", root.dataset.theme);
  dispatchEvent(new Event("themechange"));
}

const eye = `<svg viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="2" aria-hidden="true"><path d="M2 12c4-7 16-7 20 0-4 7-16 7-20 0z"/><circle cx="12" cy="12" r="3.2" fill="currentColor" stroke="none"/></svg>`;

export function bar(page: "workbench" | "lessons"): HTMLElement {
  const saved = localStorage.getItem("theme");
  if (saved) document.documentElement.dataset.theme = saved;
  const mark = element("a", { class: "mark", href: "index.html", "aria-label": "Frontmost" });
  mark.innerHTML = `${eye}<span>Frontmost</span>`;
  const link = (to: "workbench" | "lessons", href: string) =>
    element("a", { href, "aria-current": to === page ? "page" : undefined }, say(titles[to]));
  return element("header", { class: "bar" }, mark, page === "workbench" && element("h1", { class: "sr" }, say(titles.workbench)),
    element("nav", {}, link("workbench", "index.html"), link("lessons", "lessons.html")),
    element("div", { class: "tools" },
      element("button", { class: "button plain", title: say(titles.theme), "aria-label": say(titles.theme), onclick: switchTheme }, "◐"),
      element("button", { class: "button plain", lang: language === "en" ? "zh-Hans" : "en", onclick: switchLanguage }, language === "en" ? "中文" : "English")));
}

/** After one page has been loaded, all pages work without a network. Files loaded before the service worker existed are
 * requested again; the browser answers from its cache. Call it once the module's files have arrived: Chromium breaks off
 * one of two simultaneous requests for a file that is too large for its cache in memory. */
export async function keepForLater(): Promise<void> {
  if (!("serviceWorker" in navigator) || !isSecureContext) return;
  try {
    const isControlled = new Promise((done) => navigator.serviceWorker.addEventListener("controllerchange", done, { once: true }));
    await navigator.serviceWorker.register("keeper.js");
    if (!navigator.serviceWorker.controller) await isControlled;
    const name = crossOriginIsolated ? "frontmost-threads" : "frontmost";
    const files: string[] = await (await fetch("files.json")).json();
    files.push(location.href, `${name}.mjs`, `${name}.wasm`, ...(crossOriginIsolated ? [`${name}.worker.js`] : []));
    for (const file of files)
      if (file.endsWith(".html")) await fetch(file); // may have changed
      else if (!(await caches.match(file))) await fetch(file, { cache: "force-cache" });
  } catch {
    // The page then needs the network next time, too.
  }
}
