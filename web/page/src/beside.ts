// SPDX-License-Identifier: Apache-2.0
// Frontmost's and WebGL's pictures of one view side by side. Pixels where they show different triangles are marked, and
// each difference is explained.
import type { Answer } from "./answer.ts";
import type { Client } from "./client.ts";
import { element } from "./dom.ts";
import { say, type Text } from "./language.ts";
import type { Vector } from "./orbit.ts";
import { drawByWebGL, type Drawn } from "./webgl.ts";

const words = {
  ours: { en: "Frontmost", zh: "Frontmost" },
  theirs: { en: "WebGL, by", zh: "WebGL，由" },
  same: { en: "Not one pixel differs.", zh: "没有任何像素不同。" },
  differ: { en: "pixels see another triangle", zh: "个像素看到不同的三角形" },
  edge: { en: "at borders: WebGL rounds corners", zh: "在边界上：WebGL 对顶点取整" },
  depth: { en: "nearly as far: its roundings decide", zh: "距离几乎相等：由其取整决定" },
  other: { en: "for other reasons", zh: "其他原因" },
  choose: { en: "Choose a mark, or step through them.", zh: "点击标记，或逐个查看。" },
  some: { en: " Not all of them have one.", zh: "并非每个像素都有标记。" },
  on: { en: "Next", zh: "下一个" },
  back: { en: "Back", zh: "上一个" },
  close: { en: "Close", zh: "关闭" },
  nothing: { en: "nothing", zh: "空无" },
} satisfies Record<string, Text>;
const reasons = ["edge", "depth", "other"] as const;
const colors = ["--accent", "--blue", "--bad"];
const mostMarks = 3000;

interface PixelDifference { x: number; y: number; reason: number; border: number; steps: number; ours: number; theirs: number }
function differencesOf(answer: Answer): PixelDifference[] {
  const numbers = new Float32Array(answer.differences), found: PixelDifference[] = [];
  for (let i = 0; i < numbers.length; i += 7) {
    const [x, y, reason, border, steps, ours, theirs] = numbers.subarray(i, i + 7);
    found.push({ x, y, reason, border, steps, ours, theirs });
  }
  return found;
}

const brief = (value: number) => (value < 10 ? value.toPrecision(2) : Math.round(value).toLocaleString());
function explained(one: PixelDifference, { subpixelBits }: Drawn): string {
  const called = (triangle: number): Text => (triangle < 0 ? words.nothing : { en: `triangle ${triangle}`, zh: `三角形 ${triangle}` });
  const [ours, theirs] = [say(called(one.ours)), say(called(one.theirs))], far = brief(one.border), steps = brief(one.steps);
  const begin = say({ en: `At ${one.x}, ${one.y} Frontmost sees ${ours}, WebGL ${theirs}. `, zh: `在 ${one.x}, ${one.y} 处，Frontmost 看到${ours}，WebGL 看到${theirs}。` });
  return begin + say([
    { en: `The pixel's centre is ${far} pixels from the border. WebGL here rounds corners to 1/${2 ** subpixelBits} pixel, and the border moves with them.`, zh: `像素中心距边界 ${far} 像素。此处 WebGL 把顶点取整到 1/${2 ** subpixelBits} 像素，边界随之移动。` },
    { en: `Both cover the pixel, ${steps} steps of a 24-bit depth buffer apart: so little that WebGL's roundings decide which is nearer, of depths and of the corners between which surfaces slope.`, zh: `两者都覆盖该像素，深度相差 24 位深度缓冲的 ${steps} 级：远近由 WebGL 的取整决定，即深度的取整，以及决定曲面倾斜的顶点的取整。` },
    { en: `The border is ${far} pixels away, and the depths ${steps} steps of a 24-bit depth buffer apart.`, zh: `距边界 ${far} 像素，深度相差 24 位深度缓冲的 ${steps} 级。` },
  ][one.reason]);
}

/** An enlarged view of the pixels around one, with a unique colour for each triangle. */
function loupe(label: string, numberAt: (x: number, y: number) => number, { x, y }: PixelDifference): HTMLElement {
  const reach = 6, side = 2 * reach + 1, canvas = element("canvas", { width: side, height: side, role: "img", "aria-label": label });
  const pen = canvas.getContext("2d")!;
  for (let down = 0; down < side; ++down)
    for (let across = 0; across < side; ++across) {
      const number = numberAt(x + across - reach, y + down - reach);
      if (number < 0) continue;
      pen.fillStyle = `hsl(${(number * 137.508) % 360} 45% ${55 + (number % 3) * 9}%)`;
      pen.fillRect(across, down, 1, 1);
    }
  return element("figure", { class: "loupe" }, canvas, element("figcaption", { class: "soft" }, label));
}

interface Pane { root: HTMLElement; show(chosen: PixelDifference): void }
function pane(title: string, image: ImageData, differences: PixelDifference[], choose: (i: number) => void): Pane {
  const canvas = element("canvas", { width: image.width, height: image.height, role: "img", "aria-label": title });
  canvas.getContext("2d")!.putImageData(image, 0, 0);
  const marks = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  marks.setAttribute("viewBox", `0 0 ${image.width} ${image.height}`);
  marks.setAttribute("aria-hidden", "true");
  // With thousands of marks, dots can still be told apart; beyond `mostMarks`, only some are shown.
  const every = Math.ceil(differences.length / mostMarks);
  const radius = (image.width / 100) * Math.min(1, Math.max(0.2, Math.sqrt(60 / differences.length)));
  const circle = ({ x, y }: PixelDifference, color: string, wide: number) => `<circle cx="${x + 0.5}" cy="${y + 0.5}" r="${radius.toFixed(1)}" fill="none" stroke="var(${color})" stroke-width="${(radius * wide).toFixed(1)}"/>`;
  marks.innerHTML = differences.filter((_, i) => i % every === 0).map((one) => circle(one, colors[one.reason], 0.33)).join("") + `<g class="chosen"></g>`;
  marks.addEventListener("click", (event) => {
    const rect = marks.getBoundingClientRect(), x = ((event.clientX - rect.left) / rect.width) * image.width, y = ((event.clientY - rect.top) / rect.height) * image.height;
    let nearest = -1, least = Infinity;
    differences.forEach((one, i) => {
      const away = Math.hypot(one.x + 0.5 - x, one.y + 0.5 - y);
      if (away < least) [nearest, least] = [i, away];
    });
    if (nearest >= 0) choose(nearest);
  });
  return {
    root: element("div", { class: "plate" }, element("h3", {}, title), element("div", { class: "pane" }, canvas, marks)),
    show: (chosen) => (marks.querySelector(".chosen")!.innerHTML = circle(chosen, "--ink", 0.5)),
  };
}

export interface Seen { client: Client; image: ImageData; eye: Vector }
/** Compares the last view with WebGL's picture; `close` is called when the comparison is closed. */
export async function besideWebGL({ client, image, eye }: Seen, close: () => void): Promise<HTMLElement> {
  const view = await client.ask({ ask: "triangles" });
  const drawn = drawByWebGL(view, eye);
  const numbers = drawn.numbers.slice();
  const answer = await client.ask({ ask: "compare", view: view.view, subpixel_bits: drawn.subpixelBits }, drawn.numbers.buffer);
  const differences = differencesOf(answer);
  const ourNumbers = numbers.slice();
  for (const { x, y, ours } of differences) ourNumbers[y * view.width + x] = ours + 1;
  const at = (of: Uint32Array) => (x: number, y: number) => (x < 0 || y < 0 || x >= view.width || y >= view.height ? -1 : of[y * view.width + x] - 1);

  const said = element("p", { class: "said", "aria-live": "polite" }, differences.length > 0 && say(words.choose), differences.length > mostMarks && say(words.some));
  const loupes = element("div", { class: "row" });
  let chosen = -1;
  const choose = (i: number) => {
    chosen = (i + differences.length) % differences.length;
    const one = differences[chosen];
    said.textContent = explained(one, drawn);
    loupes.replaceChildren(loupe(say(words.ours), at(ourNumbers), one), loupe("WebGL", at(numbers), one));
    for (const pane of panes) pane.show(one);
  };
  const button = (text: Text, act: () => void) => element("button", { class: "button", onclick: act }, say(text));
  const count = (text: Text, many: number, color?: string) => element("li", {}, color && element("i", { class: "swatch", style: `background:var(${color})` }), element("b", { class: "number" }, many.toLocaleString()), ` ${say(text)}`);
  const panes = [pane(say(words.ours), image, differences, choose), pane(`${say(words.theirs)} ${drawn.renderer}`, drawn.picture, differences, choose)];
  return element("section", { class: "beside", tabindex: -1, "aria-label": "WebGL" },
    element("div", { class: "panes" }, ...panes.map((one) => one.root)),
    element("div", { class: "verdict" },
      element("div", {}, differences.length === 0 ? element("p", {}, say(words.same)) : element("ul", {}, count(words.differ, differences.length), ...reasons.map((reason, i) => answer.counts[reason] > 0 && count(words[reason], answer.counts[reason], colors[i]))), said),
      loupes,
      element("div", { class: "row" }, ...(differences.length > 0 ? [button(words.back, () => choose(Math.max(chosen, 0) - 1)), button(words.on, () => choose(chosen + 1))] : []), button(words.close, close))));
}
