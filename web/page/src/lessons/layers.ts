// SPDX-License-Identifier: Apache-2.0
// The A-buffer: the list of one pixel, its masks, and the order of glass before glass.
import type { Answer } from "../answer.ts";
import { element, slider } from "../dom.ts";
import { say } from "../language.ts";
import { Eye, figure, ink, Latest, pixelAt, plate, pointing, sceneChoices } from "./figure.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [320, 240];

/** The 8 x 8 sub-samples of a pixel that a fragment covers. */
function maskPicture(mask: string): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 8 8");
  svg.setAttribute("style", "width:36px;height:36px;flex:none;border-radius:4px");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", say({ en: `Covers ${mask.replaceAll("0", "").length} of 64 sub-samples`, zh: `覆盖 64 个子采样中的 ${mask.replaceAll("0", "").length} 个` }));
  const cells = [...mask].map((bit, i) => `<rect x="${i % 8}" y="${Math.floor(i / 8)}" width=".9" height=".9" fill="${bit === "1" ? "var(--accent)" : "var(--line)"}"/>`);
  svg.innerHTML = cells.join("");
  return svg;
}

function layersFigure(): HTMLElement {
  const sorted = plate(say({ en: "In true order. Point at a pixel, drag to turn", zh: "按真实次序。指向像素查询，拖动旋转" })), unsorted = plate(say({ en: "In the order of the file. Point at a pixel", zh: "按文件中的次序。指向像素查询" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const list = element("ol", { class: "hits" });
  let scene = "cubes", opacity = 0.5, pixel: [number, number] = [150, 110];
  const choose = (x: number, y: number) => {
    pixel = [x, y];
    show();
  };
  const { canvas } = sorted;
  const eye = new Eye(canvas, show, (offsetX, offsetY) => choose(...pixelAt(canvas, { offsetX, offsetY })));
  const latest = new Latest((answer) => {
    sorted.show(answer);
    unsorted.show(answer, "unsorted");
    for (const { canvas } of [sorted, unsorted]) {
      const pen = canvas.getContext("2d")!;
      pen.strokeStyle = ink("--ink");
      pen.strokeRect(pixel[0] - 3.5, pixel[1] - 3.5, 8, 8);
    }
    said.replaceChildren(element("b", {}, answer.fragments.toLocaleString()), say({ en: " fragments, at most ", zh: " 个片段，单个像素最多 " }), element("b", {}, String(answer.longest)), say({ en: " in one pixel. In the order of the file ", zh: " 个。按文件次序有 " }),
      element("b", {}, answer.differing.toLocaleString()), say({ en: " pixels have another colour.", zh: " 个像素颜色不同。" }));
    list.replaceChildren(...answer.list.slice(0, 12).map((one: Answer) => element("li", {}, maskPicture(one.mask) as unknown as HTMLElement, element("span", { style: "margin-right:auto" }, say({ en: `Triangle ${one.triangle}`, zh: `三角形 ${one.triangle}` })),
      element("span", { class: "number" }, `${one.depth.toFixed(4)} · ${(100 * one.covered).toFixed(0)} %`))));
    if (answer.list.length === 0) list.append(element("li", {}, say({ en: "Nothing lies at this pixel.", zh: "此像素处什么也没有。" })));
  });
  function show(): void {
    if (eye.camera) latest.ask({ ask: "lesson.layers", scene, opacity, camera: eye.camera, x: pixel[0], y: pixel[1] });
  }
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) choose(...pixelAt(canvas, event));
  });
  pointing([unsorted], pixel, choose);
  async function place(): Promise<void> {
    await eye.place(scene, scene === "cycle" ? [-0.05, -0.1, -1] : [-0.6, -0.45, -0.8], size);
    show();
  }
  void latest.during(place);
  return figure([sorted.root, unsorted.root], [said, list,
    slider(say({ en: "opacity", zh: "不透明度" }), { min: 0.1, max: 1, step: 0.05, value: 0.5 }, (v) => `${Math.round(100 * v)} %`, (v) => {
      opacity = v;
      show();
    }).field,
    sceneChoices("ascene", [["cubes", { en: "two cubes", zh: "两个立方体" }], ["cycle", { en: "three in a ring", zh: "三者成环" }], ["concave", { en: "a concave body", zh: "凹体" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    })], latest);
}

export const layers: Lesson = {
  id: "a-buffer",
  title: { en: "The A-buffer", zh: "A 缓冲" },
  lead: { en: "Keep not the nearest surface of a pixel, but all of them: which part of it each covers, and how deep.", zh: "不只保留像素中最近的面，而是全部保留：各覆盖哪一部分，有多深。" },
  parts: [{
    prose: [
      { en: "A z-buffer can say what is nearest. It cannot say what shines through glass, for that what lies behind has to be there still. The A-buffer (L. Carpenter, 1984) keeps for every pixel a list of *fragments*: the triangle, its depth, and a *mask* of the 8 × 8 sub-samples that it covers.", zh: "Z 缓冲能说出最近者，却说不出透过玻璃看见什么：那需要保留后面的东西。A 缓冲（L. Carpenter，1984）为每个像素保存一列*片段*：三角形、深度，以及它所覆盖的 8×8 子采样的*掩码*。" },
      { en: "When all is there the list is sorted and composited from the front: each fragment hides its share of what is left. Masks make smooth edges. Without the sorting glass before glass is right by luck alone: whoever came last in the file lies on top.", zh: "收齐后，将列表排序，从前往后合成：每个片段遮住剩余部分中属于它的那份。掩码使边缘平滑。若不排序，玻璃叠玻璃只能碰运气：文件中最后出现的总在最上面。" },
    ],
    figure: layersFigure,
  }],
};
