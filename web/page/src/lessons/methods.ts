// SPDX-License-Identifier: Apache-2.0
// When to use which method: times and memory of all methods, measured in the browser.
import { element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { client, figure, sceneChoices, Trouble } from "./figure.ts";
import type { Lesson } from "./list.ts";

const rows: [string, Text, Text][] = [
  ["zbuffer", { en: "z-buffer", zh: "Z 缓冲" }, { en: "pictures and maps of whatever there is", zh: "任何场景的画面与数据图" }],
  ["raycast", { en: "ray casting", zh: "光线投射" }, { en: "few rays in large scenes; shadows; any camera", zh: "大场景中的少量光线；阴影；任意相机" }],
  ["abuffer", { en: "A-buffer, 64 sub-samples", zh: "A 缓冲，64 子采样" }, { en: "glass, layers, smooth edges", zh: "玻璃、分层、平滑边缘" }],
  ["painter", { en: "painter's algorithm", zh: "画家算法" }, { en: "pictures of shapes: SVG, PDF", zh: "由形状组成的图：SVG、PDF" }],
  ["occlusion", { en: "occlusion culling", zh: "遮挡剔除" }, { en: "whatever draws afterwards has less to do", zh: "让随后的绘制少做些" }],
  ["lines", { en: "hidden lines", zh: "消隐线" }, { en: "drawings", zh: "线图" }],
];

function methodsFigure(): HTMLElement {
  const body = element("tbody");
  const said = element("p", { class: "said", "aria-live": "polite" });
  let run = 0, scene = "teapot";
  async function measure(): Promise<void> {
    const mine = ++run;
    body.replaceChildren();
    said.textContent = say({ en: "Measuring: the least of three runs, one thread.", zh: "正在测量：三次中的最小值，单线程。" });
    for (const [method, name, use] of rows) {
      const answer = await client().ask({ ask: "lesson.methods", scene, width: 640, height: 480, method });
      if (mine !== run) return;
      const number = (text: string) => element("td", { class: "share" }, text);
      const culled = answer.culled === undefined ? "" : say({ en: `: here ${((100 * answer.culled) / answer.triangles).toFixed(0)} % of all triangles are left out`, zh: `：此处略去 ${((100 * answer.culled) / answer.triangles).toFixed(0)} % 的三角形` });
      body.append(element("tr", {}, element("td", {}, say(name), element("small", {}, say(use) + culled)), number(answer.milliseconds.toFixed(1)), number(answer.ready ? answer.ready.toFixed(1) : "–"),
        number(answer.bytes === undefined ? "–" : (answer.bytes / 2 ** 20).toFixed(1)), number(answer.differing === undefined ? "–" : answer.differing.toLocaleString())));
      said.textContent = say({ en: `${answer.triangles.toLocaleString()} triangles, 640 × 480, in this page.`, zh: `${answer.triangles.toLocaleString()} 个三角形，640 × 480，在本页中测得。` });
    }
    body.dataset.done = "yes";
  }
  const trouble = new Trouble(), again = () => void trouble.during(measure);
  again();
  const head = (text: Text) => element("th", { style: "text-align:right" }, say(text));
  return figure([element("div", { class: "plate scroll", style: "padding:16px;max-height:none" }, element("table", { class: "measured" }, element("thead", {}, element("tr", {}, element("th", {}, say({ en: "method, and what it is for", zh: "方法与用途" })),
    head({ en: "ms", zh: "毫秒" }), head({ en: "ms to make ready", zh: "准备（毫秒）" }), head({ en: "MiB", zh: "MiB" }), head({ en: "pixels that differ", zh: "不同像素" }))), body))], [said,
    element("button", { class: "button", onclick: again }, say({ en: "Measure again", zh: "重新测量" })),
    sceneChoices("mscene", [["teapot", { en: "teapot", zh: "茶壶" }], ["gallery", { en: "gallery", zh: "陈列" }], ["spheres", { en: "spheres", zh: "球" }], ["cubes", { en: "two cubes", zh: "两个立方体" }]], scene, (value) => {
      scene = value;
      again();
    })], trouble);
}

export const methods: Lesson = {
  id: "which-method",
  title: { en: "Which method when", zh: "何时用何种方法" },
  lead: { en: "They answer the same question. What differs is what they can be asked beside it, and what that costs.", zh: "它们回答同一个问题。不同的是还能另外问什么，以及代价几何。" },
  parts: [{
    prose: [
      { en: "A z-buffer goes through all triangles once. Rays go through all pixels, and need an index that is made first; then they hardly mind how many triangles there are. The A-buffer and the painter keep everything, and pay for it. Occlusion culling shows nothing by itself: it says what the others may leave out, and is right. Where samples differ it is at edges: rays are not snapped to 1/256 of a pixel, as corners of the others are.", zh: "Z 缓冲把所有三角形过一遍。光线把所有像素过一遍，事先须建索引；此后三角形再多也几乎无妨。A 缓冲与画家算法什么都保留，也为此付出代价。遮挡剔除本身不显示什么：它说其他方法可以略去什么，而且说得对。采样若有不同，都在边缘：光线不像其他方法那样把顶点对齐到 1/256 像素。" },
    ],
    figure: methodsFigure,
  }],
};
