// SPDX-License-Identifier: Apache-2.0
// The painter's algorithm: polygons painted one over another, in a right or a wrong order.
import type { Answer } from "../answer.ts";
import { choices, element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { Eye, facts, figure, ink, Latest, manyTriangles, plate, steps, sceneChoices } from "./figure.ts";
import { mostTriangles, treeFigure } from "./tree.ts";
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
    if (eye.camera) latest.ask({ ask: "lesson.painter", scene, most: manyTriangles, method, step, camera: eye.camera });
  }
  const stepper = steps(0, show, 400);
  async function place(): Promise<void> {
    most = -1;
    await eye.place(scene, scene === "cycle" ? [-0.05, -0.1, -1] : [-0.6, -0.45, -0.8], size, { most: manyTriangles });
    show(100000);
  }
  void latest.during(place);
  return figure([painted.root, wrong.root, element("div", {}, facts)], [
    stepper.root, said,
    choices("method", say({ en: "Sorted by", zh: "排序方法" }), methods.map(([id, text]) => [id, say(text)]), method, (value) => {
      method = value;
      most = -1;
      show(100000);
    }),
    sceneChoices("pscene", [["cycle", { en: "three in a ring", zh: "三者成环" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }], ["concave", { en: "a concave body", zh: "凹体" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    }, manyTriangles),
  ], latest);
}

const tests: Text[] = [
  { en: "1. Is P, the farther one, beyond all of Q in depth?", zh: "1. 较远的 P 在深度上是否完全超过 Q？" }, { en: "2. Are their boxes apart on the screen?", zh: "2. 屏幕包围盒是否分离？" },
  { en: "3. Is P wholly behind the plane of Q?", zh: "3. P 是否完全在 Q 的平面之后？" }, { en: "4. Is Q wholly before the plane of P?", zh: "4. Q 是否完全在 P 的平面之前？" }, { en: "5. Are they apart on the screen?", zh: "5. 投影是否分离？" },
  { en: "3, exchanged. Is Q wholly behind the plane of P?", zh: "交换后 3. Q 是否完全在 P 的平面之后？" }, { en: "4, exchanged. Is P wholly before the plane of Q?", zh: "交换后 4. P 是否完全在 Q 的平面之前？" }];
const verdicts: Record<string, Text> = { p: { en: "P is painted first.", zh: "先画 P。" }, q: { en: "They are exchanged: Q is painted first.", zh: "交换：先画 Q。" }, cut: { en: "No test holds, and the exchange does not help: one of them is cut.", zh: "无一成立，交换也无济于事：切开其中之一。" } };

/** Depth ranges of both triangles, as bars. */
function depthBars({ p, q }: Answer): string {
  const low = Math.min(p.near, q.near), high = Math.max(p.far, q.far), x = (depth: number) => 34 + ((depth - low) / (high - low || 1)) * (size[0] - 60);
  const bar = (one: Answer, name: string, y: number, color: string) => `<text x="12" y="${y + 11}" fill="var(${color})">${name}</text><rect x="${x(one.near)}" y="${y}" width="${Math.max(2, x(one.far) - x(one.near))}" height="12" rx="3" fill="var(${color})" opacity=".75"/>`;
  return `<g font-size="13" font-family="var(--serif)" font-style="italic">${bar(p, "P", size[1] - 44, "--blue")}${bar(q, "Q", size[1] - 24, "--accent")}</g>`;
}

function pairFigure(): HTMLElement {
  const pair = plate(say({ en: "P is blue, Q is orange; below, their depths. Drag to turn", zh: "P 为蓝色，Q 为橙色；下方为深度区间。拖动旋转" }));
  const list = element("ol", { class: "hits tests" });
  const said = element("p", { class: "said", "aria-live": "polite" });
  const sums = facts();
  let scene = "cubes", most = -1, answer: Answer;
  const eye = new Eye(pair.canvas, ask);
  const latest = new Latest((now) => {
    answer = now;
    pair.show(answer);
    pair.canvas.style.opacity = "0.35";
    if (answer.pairs.length !== most) {
      most = answer.pairs.length;
      stepper.limit(most);
      const hard = answer.pairs.findIndex((one: Answer) => one.first !== "p");
      stepper.set(hard + 1 || 1);
    } else show(stepper.step);
  });
  function outlines({ p, q, tests: asked }: Answer): string {
    const triangle = (one: Answer, color: string) => `<polygon points="${one.corners.map((corner: number[]) => corner.join(",")).join(" ")}" fill="var(${color})" fill-opacity=".35" stroke="var(${color})" stroke-width="2"/>`;
    const box = (one: Answer, color: string) => `<rect x="${one.box[0]}" y="${one.box[1]}" width="${one.box[2] - one.box[0]}" height="${one.box[3] - one.box[1]}" fill="none" stroke="var(${color})" stroke-dasharray="3 4"/>`;
    return triangle(p, "--blue") + triangle(q, "--accent") + (asked.length >= 2 ? box(p, "--blue") + box(q, "--accent") : "");
  }
  function show(step: number): void {
    if (!answer) return;
    const now = answer.pairs[step - 1];
    pair.mark(now ? outlines(now) + depthBars(now) : "");
    list.replaceChildren(...tests.map((text, i) => {
      const mark = !now || now.tests[i] === undefined ? "·" : now.tests[i] ? "✓" : "✗";
      return element("li", { class: mark === "✓" ? "holds" : undefined }, element("span", {}, say(text)), element("span", { class: "number" }, mark));
    }));
    const at = (one: Answer) => (one.position === null ? say({ en: "cut by the library", zh: "程序库将其切开" }) : say({ en: `painted as number ${one.position + 1} by the library`, zh: `程序库第 ${one.position + 1} 个画` }));
    said.textContent = !now ? say({ en: "Pairs of which neither depths nor boxes decide, the farthest first.", zh: "深度与包围盒都不能判定的对，最远者在先。" })
      : say({ en: `P is triangle ${now.p.triangle}, ${at(now.p)}; Q is triangle ${now.q.triangle}, ${at(now.q)}. ${say(verdicts[now.first])}`, zh: `P 为三角形 ${now.p.triangle}（${at(now.p)}），Q 为三角形 ${now.q.triangle}（${at(now.q)}）。${say(verdicts[now.first])}` });
    sums.set(answer.by_test.map((count: number, i: number): [string, number] => [say({ en: `pairs that test ${i + 1} decides`, zh: `由测试 ${i + 1} 判定的对` }), count]));
  }
  const stepper = steps(1, show, 900);
  function ask(): void {
    if (eye.camera) latest.ask({ ask: "lesson.newell", scene, most: mostTriangles, camera: eye.camera });
  }
  async function place(): Promise<void> {
    most = -1;
    await eye.place(scene, scene === "cycle" ? [-0.05, -0.1, -1] : [-0.6, -0.45, -0.8], size, { most: mostTriangles });
    ask();
  }
  void latest.during(place);
  return figure([pair.root, element("div", {}, list, sums.root)], [stepper.root, said,
    sceneChoices("nscene", [["cycle", { en: "three in a ring", zh: "三者成环" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }], ["concave", { en: "a concave body", zh: "凹体" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    }, mostTriangles)], latest);
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
    {
      title: { en: "Two triangles, five questions", zh: "两个三角形，五个问题" },
      prose: [
        { en: "Take the farthest triangle P, and another one, Q, that it may cover. One *yes* suffices, and P may be painted first. Five times *no*, and the roles are exchanged. If that does not help either, the plane of one cuts the other.", zh: "取最远的三角形 P，以及它可能盖住的 Q。只要有一个*是*，就可以先画 P。五个都*否*，则交换角色；若仍不行，就用其中一个的平面切开另一个。" },
      ],
      figure: pairFigure,
    },
    {
      title: { en: "A tree of planes", zh: "平面之树" },
      prose: [
        { en: "Fuchs, Kedem and Naylor (1980) do all the cutting beforehand, and then serve every eye. The plane of one triangle parts the others into those *before* it and those *behind*; what reaches across is cut. Each side is parted in the same way. To paint, one asks at each node on which side the eye is: first the other side, then the triangle, then the eye's own side.", zh: "Fuchs、Kedem 与 Naylor（1980）事先完成全部切割，此后适用于任何视点。一个三角形的平面把其余的分为在它*之前*与*之后*的，跨越平面的被切开；两侧再同样划分。绘制时，在每个节点问眼睛在哪一侧：先画另一侧，再画该三角形，最后画眼睛所在的一侧。" },
      ],
      figure: treeFigure,
    },
  ],
};
