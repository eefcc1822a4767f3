// SPDX-License-Identifier: Apache-2.0
// The painter's algorithm: polygons one over the other, in an order that is right or is not.
import type { Answer } from "../answer.ts";
import { choices, element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { Eye, figure, ink, Latest, plate, steps } from "./figure.ts";
import type { Lesson } from "./list.ts";

const methods: [string, Text][] = [
  ["depth_sort", { en: "Newell, Newell, Sancha", zh: "Newell、Newell、Sancha" }],
  ["bsp", { en: "BSP tree", zh: "BSP 树" }],
  ["farthest", { en: "farthest points", zh: "按最远点" }],
  ["centroid", { en: "centroids", zh: "按重心" }],
];
const size: [number, number] = [400, 300];

function paintFigure(): HTMLElement {
  const painted = plate(say({ en: "Painted so far. Drag to turn", zh: "已画部分。拖动旋转" })), wrong = plate(say({ en: "Wrong when all are painted", zh: "全部画完后错误的像素" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const facts = element("dl", { class: "facts" });
  let scene = "cycle", method = "centroid", most = -1;
  const eye = new Eye(painted.canvas, () => show(stepper.step));
  const latest = new Latest(draw);

  function outline(answer: Answer): void {
    const corners: [number, number, boolean][] = answer.polygon.corners;
    const pen = painted.canvas.getContext("2d")!;
    corners.forEach(([x, y, isCut], i) => {
      const [toX, toY] = corners[(i + 1) % corners.length];
      pen.beginPath();
      pen.strokeStyle = isCut ? ink("--bad") : "#fff";
      pen.lineWidth = isCut ? 3 : 2;
      pen.moveTo(x, y);
      pen.lineTo(toX, toY);
      pen.stroke();
    });
  }
  function draw(answer: Answer): void {
    painted.show(answer);
    wrong.show(answer, "wrong");
    if (answer.polygons !== most) {
      most = answer.polygons;
      stepper.limit(most);
      stepper.set(most);
      return;
    }
    const { polygon, steps: took } = answer;
    if (polygon) {
      outline(answer);
      said.textContent = say({ en: `Triangle ${polygon.triangle}, ${polygon.near.toFixed(2)} to ${polygon.far.toFixed(2)} away.`, zh: `三角形 ${polygon.triangle}，距离 ${polygon.near.toFixed(2)} 至 ${polygon.far.toFixed(2)}。` })
        + (polygon.corners.some((corner: Answer) => corner[2]) ? say({ en: " A piece: red sides are cuts.", zh: "这是碎片：红边为切口。" }) : "");
    } else said.textContent = say({ en: "An empty canvas. What is painted later covers what was there before.", zh: "空白画布。后画者盖住先画者。" });
    const rows: [string, number][] = [
      [say({ en: "wrong pixels", zh: "错误像素" }), answer.wrong_count], [say({ en: "triangles", zh: "三角形" }), answer.triangles], [say({ en: "polygons painted", zh: "所画多边形" }), answer.polygons],
      [say({ en: "1. apart in depth", zh: "1. 深度区间不重叠" }), took.depths_apart], [say({ en: "2. boxes apart on the screen", zh: "2. 屏幕包围盒不重叠" }), took.boxes_apart],
      [say({ en: "3. behind the other's plane", zh: "3. 在对方平面之后" }), took.behind], [say({ en: "4. the other before its plane", zh: "4. 对方在其平面之前" }), took.before],
      [say({ en: "5. apart on the screen", zh: "5. 投影不重叠" }), took.projections_apart], [say({ en: "exchanges", zh: "交换" }), took.exchanges],
      [say({ en: "groups without an order", zh: "无次序的组" }), took.cycles], [say({ en: "cuts", zh: "切割" }), took.cuts]];
    facts.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value.toLocaleString())]));
  }
  function show(step: number): void {
    if (eye.camera) latest.ask({ ask: "lesson.painter", scene, method, step, camera: eye.camera });
  }
  const stepper = steps(0, show, 400);
  async function place(): Promise<void> {
    most = -1;
    await eye.place(scene, scene === "cycle" ? [-0.05, -0.1, -1] : [-0.6, -0.45, -0.8], size);
    show(100000);
  }
  void place();
  return figure([painted.root, wrong.root, element("div", {}, facts)], [
    stepper.root, said,
    choices("method", say({ en: "Sorted by", zh: "排序方法" }), methods.map(([id, text]) => [id, say(text)]), method, (value) => {
      method = value;
      most = -1;
      show(100000);
    }),
    choices("pscene", say({ en: "Scene", zh: "场景" }), [["cycle", say({ en: "three in a ring", zh: "三者成环" })], ["cubes", say({ en: "two cubes that intersect", zh: "相交的立方体" })], ["concave", say({ en: "a concave body", zh: "凹体" })]], scene, (value) => {
      scene = value;
      void place();
    }),
  ]);
}

export const painter: Lesson = {
  id: "painter",
  title: { en: "The painter's algorithm", zh: "画家算法" },
  lead: { en: "Paint what is far away first, and what is near over it. All that is hard is the order.", zh: "先画远处，再把近处盖在上面。难的只有次序。" },
  parts: [
    {
      prose: [
        { en: "Painters begin with the sky. If polygons can be put into an order in which each covers only what was painted before it, nothing has to be compared pixel by pixel, and the picture can be one of shapes instead of pixels, as SVG and PDF want it.", zh: "画家从天空画起。若能给多边形排出一个次序，使每个只盖住先画的，就无需逐像素比较，画面也可以由形状而非像素组成，正合 SVG 与 PDF 之用。" },
        { en: "Sorting by *centroids* is what many programs do, and it is wrong wherever a large polygon reaches past a small one. Newell, Newell and Sancha (1972) ask five questions of two polygons, from the cheapest on, until one of them says that the farther may be painted first: are they apart in depth, do their boxes on the screen miss each other, is this one wholly *behind the plane* of that, is that one wholly *before the plane* of this, do their outlines miss each other? If none does, the two are *exchanged*, and if that leads back to where it began, one is *cut*.", zh: "许多程序按*重心*排序，只要大多边形伸过小多边形就会出错。Newell、Newell 与 Sancha（1972）对两个多边形由易到难问五个问题，直到有一个表明可以先画较远的：深度是否不重叠？屏幕包围盒是否不相交？这个是否完全在那个的*平面之后*？那个是否完全在这个的*平面之前*？轮廓是否不相交？若都不成立，则*交换*二者；若因此绕回原处，就把其中一个*切开*。" },
        { en: "Three bars in a ring have no order. See what each method makes of them.", zh: "成环的三根条没有次序。看看各种方法如何处理。" },
      ],
      figure: paintFigure,
    },
  ],
};
