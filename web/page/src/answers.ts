// SPDX-License-Identifier: Apache-2.0
// Answers about a view, as lists and tables.
import type { Answer } from "./answer.ts";
import { element } from "./dom.ts";
import { say } from "./language.ts";
import { words } from "./words.ts";

const mostRows = 200;

export function hitList(answer: Answer, x: number, y: number): HTMLElement {
  if (answer.hits.length === 0) return element("p", { class: "soft" }, `${say(words.nothing)} (${x}, ${y})`);
  const list = element("ol", { class: "hits" });
  for (const hit of answer.hits)
    list.append(element("li", {}, element("span", {}, `${hit.name || `#${hit.object}`}`, hit.material ? element("span", { class: "soft" }, ` · ${hit.material}`) : null),
      element("span", { class: "number" }, `${say(words.triangle)} ${hit.triangle} · ${hit.depth === null ? "∞" : hit.depth.toPrecision(6)}`)));
  return element("div", {}, element("p", { class: "soft number" }, `x ${x}, y ${y}`), list);
}

function shareCell(share: number): HTMLElement {
  const percent = 100 * share;
  const text = percent > 0 && percent < 0.05 ? "< 0.1 %" : `${percent.toFixed(1)} %`;
  return element("td", { class: "share" }, text, element("i", {}, element("b", { style: `width:${percent}%` })));
}

export function accountTable(answer: Answer): HTMLElement {
  const body = element("tbody");
  const objects = [...answer.objects].sort((a, b) => b.visible - a.visible);
  for (const object of objects.slice(0, mostRows))
    body.append(element("tr", {}, element("td", {}, object.name, element("small", {}, object.sentence)), shareCell(object.visible_share)));
  const more = objects.length - mostRows;
  return element("div", { class: "scroll", tabindex: 0 },
    element("table", {}, element("thead", {}, element("tr", {}, element("th", {}, say(words.object)), element("th", { style: "text-align:right" }, say(words.visible)))), body),
    more > 0 && element("p", { class: "soft" }, `+ ${more} ${say(words.more)}`));
}

/** A table of pairs of objects where one hides part of the other, the largest shares first. */
export function hidingTable(answer: Answer): HTMLElement | null {
  const pairs: Answer[] = answer.objects.flatMap((object: Answer) => object.hidden_by.map((hider: Answer) => ({ name: object.name, hider: hider.name, share: hider.share })));
  if (pairs.length === 0) return null;
  const body = element("tbody", {}, ...pairs.sort((a, b) => b.share - a.share).slice(0, mostRows).map(({ name, hider, share }) => element("tr", {}, element("td", {}, name), element("td", {}, hider), shareCell(share))));
  return element("div", { class: "scroll", tabindex: 0 },
    element("table", { class: "hiding" }, element("thead", {}, element("tr", {}, element("th", {}, say(words.object)), element("th", {}, say(words.hiddenBy)), element("th", { style: "text-align:right" }, say(words.share)))), body));
}

/** A table of the number of triangles of each object that no view sees. */
export function neverSeenTable(answer: Answer): HTMLElement {
  const rows: [string, number, number][] = answer.names.map((name: string, i: number) => [name, answer.triangles_by_object[i] - answer.seen_by_object[i], answer.triangles_by_object[i]]);
  const body = element("tbody", {}, ...rows.sort((a, b) => b[1] - a[1]).slice(0, mostRows).map(([name, never, all]) =>
    element("tr", {}, element("td", {}, name, element("small", {}, `${never.toLocaleString()} / ${all.toLocaleString()}`)), shareCell(never / Math.max(1, all)))));
  return element("div", { class: "scroll", tabindex: 0 }, element("table", { class: "never" }, element("thead", {}, element("tr", {}, element("th", {}, say(words.object)), element("th", { style: "text-align:right" }, say(words.never)))), body));
}
