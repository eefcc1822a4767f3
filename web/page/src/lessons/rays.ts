// SPDX-License-Identifier: Apache-2.0
// Ray casting: one ray through a tree of boxes and on to the light, and the savings of each level of the tree.
import type { Answer } from "../answer.ts";
import { element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import type { Camera } from "../orbit.ts";
import { dot, Eye, facts, figure, framed, Latest, lines, manyTriangles, plate, pointing, sceneChoices, steps } from "./figure.ts";
import type { Lesson } from "./list.ts";

const scenes: [string, Text][] = [["blocks", { en: "blocks on a floor", zh: "地面上的方块" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }],
  ["concave", { en: "a concave body", zh: "凹体" }], ["teapot", { en: "teapot", zh: "茶壶" }]];

function told(step: Answer, nearest: number): string {
  const at = step.t.toFixed(3);
  if (step.kind === "box") {
    const box = say({ en: `Box ${step.number} on level ${step.level}, ${step.triangles} triangles`, zh: `第 ${step.level} 层的盒子 ${step.number}，含 ${step.triangles} 个三角形` });
    if (step.verdict === "met") return box + say({ en: `: the ray enters it at ${at}.`, zh: `：光线在 ${at} 处进入。` });
    if (step.verdict === "missed") return box + say({ en: ": the ray passes by. None of them has to be asked.", zh: "：光线从旁边经过，其中的三角形都不必再问。" });
    return box + say({ en: `: it begins at ${at}, and something was met at ${nearest.toFixed(3)} already. None of them has to be asked.`, zh: `：它从 ${at} 处开始，而在 ${nearest.toFixed(3)} 处已有交点，其中的三角形都不必再问。` });
  }
  const triangle = say({ en: `Triangle ${step.number}`, zh: `三角形 ${step.number}` });
  if (step.verdict === "met") return triangle + say({ en: `: met at ${at}. That is the nearest so far.`, zh: `：交于 ${at}，是目前最近的。` });
  if (step.verdict === "missed") return triangle + say({ en: ": missed.", zh: "：未相交。" });
  return triangle + say({ en: `: met at ${at}, but something nearer is known.`, zh: `：交于 ${at}，但已有更近的。` });
}

function lightTold({ light }: Answer): string {
  if (light.is_lit) return say({ en: "From there a second ray goes to the light. Nothing is in its way: the point is lit.", zh: "再从交点向光源发出第二条光线。途中没有阻挡：该点被照亮。" });
  return say({ en: `From there a second ray goes to the light, and meets triangle ${light.blocker ?? "–"}: the point lies in shadow.`, zh: `再从交点向光源发出第二条光线，遇到三角形 ${light.blocker ?? "–"}：该点在阴影中。` });
}

function walkFigure(): HTMLElement {
  const seen = plate(say({ en: "What the eye sees. Point at a pixel", zh: "眼睛所见。指向一个像素" })), aside = plate(say({ en: "The same from beside. Drag to turn", zh: "从旁边看。拖动旋转" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const asked = facts();
  const size: [number, number] = [480, 360];
  let scene = "blocks", pixel: [number, number] = [196, 214], camera: Camera | undefined, answer: Answer, isNew = true;
  const eye = new Eye(aside.canvas, ask);
  const latest = new Latest((now) => {
    answer = now;
    seen.show(answer);
    aside.show(answer, "beside", size);
    seen.mark(`<circle cx="${pixel[0] + 0.5}" cy="${pixel[1] + 0.5}" r="7" fill="none" stroke="var(--panel)" stroke-width="4"/><circle cx="${pixel[0] + 0.5}" cy="${pixel[1] + 0.5}" r="7" fill="none" stroke="var(--accent)" stroke-width="2"/>`);
    stepper.limit(answer.steps.length + (answer.light ? 1 : 0));
    if (isNew) stepper.set(answer.steps.length + 1);
    isNew = false;
  });

  function show(step: number): void {
    if (!answer) return;
    const past: Answer[] = answer.steps.slice(0, step), now = past.pop(), isLight = step > answer.steps.length;
    const hits = past.filter((one) => one.kind === "triangle" && one.verdict === "met");
    const nearest = hits[hits.length - 1];
    const shapes = past.filter((one) => one.kind === "box" && one.verdict === "met").map((one) => lines(one.lines, "--blue", 1, `opacity=".55"`));
    shapes.push(lines(answer.ray, "--accent", 2));
    if (nearest) shapes.push(lines(nearest.lines, "--accent", 2.5));
    if (now && !isLight) shapes.push(lines(now.lines, now.verdict === "met" ? "--green" : "--bad", 2.5));
    if (isLight) {
      shapes.push(lines(answer.light.lines, answer.light.is_lit ? "--green" : "--bad", 2.5, `stroke-dasharray="6 5"`));
      for (const [x, y, toX, toY] of answer.light.lines) shapes.push(dot(x, y, "--accent"), answer.light.is_lit ? "" : dot(toX, toY, "--bad"));
    }
    shapes.push(dot(answer.eye[0], answer.eye[1], "--accent", 6));
    aside.mark(...shapes);
    if (isLight) said.textContent = lightTold(answer);
    else if (now) said.textContent = told(now, nearest?.t ?? Infinity);
    else said.textContent = say({ en: "A ray leaves the eye through the middle of the pixel.", zh: "一条光线从眼睛出发，穿过像素中心。" });
    const count = (kind: string) => answer.steps.slice(0, step).filter((one: Answer) => one.kind === kind && one.verdict !== (kind === "box" ? "farther" : "")).length;
    asked.set([[say({ en: "boxes asked", zh: "已问盒子" }), count("box")], [say({ en: "triangles asked", zh: "已问三角形" }), count("triangle")],
      [say({ en: "triangles there are", zh: "三角形总数" }), answer.triangles], [say({ en: "nearest", zh: "最近者" }), answer.hit ? say({ en: `triangle ${answer.hit.triangle}`, zh: `三角形 ${answer.hit.triangle}` }) : "–"]]);
  }
  const stepper = steps(1, show, 450);
  function ask(): void {
    if (camera && eye.camera) latest.ask({ ask: "lesson.rays", example: "walk", scene, camera, beside: eye.camera, x: pixel[0], y: pixel[1] });
  }
  pointing([seen], pixel, (x, y) => {
    pixel = [x, y];
    isNew = true;
    ask();
  });
  async function place(): Promise<void> {
    camera = await framed(scene, [-0.6, -0.5, -0.8], size, { angle: 42 });
    await eye.place(scene, [0.75, -0.4, -0.75], size, { beside: [camera.eye] });
    isNew = true;
    ask();
  }
  void latest.during(place);
  return figure([seen.root, aside.root], [stepper.root, said, asked.root,
    sceneChoices("rscene", scenes, scene, (value) => {
      scene = value;
      void latest.during(place);
    })], latest);
}

function levelFigure(): HTMLElement {
  const boxes = plate(say({ en: "Boxes on this level. Drag to turn", zh: "这一层的盒子。拖动旋转" })), heat = plate(say({ en: "What each ray asks: dark is little", zh: "每条光线所问之数：暗为少" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const asked = facts();
  let scene = "teapot", depth = -1;
  const eye = new Eye(boxes.canvas, () => show(stepper.step));
  const latest = new Latest((answer) => {
    boxes.show(answer);
    boxes.mark(lines(answer.lines, "--accent", answer.boxes > 64 ? 0.4 : 1));
    heat.show(answer, "heat");
    if (answer.depth !== depth) {
      depth = answer.depth;
      stepper.limit(depth);
    }
    const sum = answer.boxes_asked + answer.triangles_asked;
    said.replaceChildren(say({ en: "Opened down to this level, the tree answers ", zh: "展开到这一层，树只需 " }), element("b", {}, sum.toLocaleString()),
      say({ en: " questions in place of ", zh: " 次提问，而不用树需 " }), element("b", {}, answer.without.toLocaleString()), say({ en: `: ${(answer.without / sum).toFixed(1)} times less.`, zh: ` 次：少到 ${(answer.without / sum).toFixed(1)} 分之一。` }));
    asked.set([[say({ en: "boxes on this level", zh: "这一层的盒子" }), answer.boxes], [say({ en: "boxes asked", zh: "所问盒子" }), answer.boxes_asked], [say({ en: "triangles asked", zh: "所问三角形" }), answer.triangles_asked],
      [say({ en: "pixels that differ from the library's", zh: "与程序库不同的像素" }), answer.differing]]);
  });
  function show(level: number): void {
    if (eye.camera) latest.ask({ ask: "lesson.rays", example: "levels", scene, most: manyTriangles, camera: eye.camera, level });
  }
  const stepper = steps(12, show, 700);
  async function place(level: number): Promise<void> {
    await eye.place(scene, [-0.6, -0.45, -0.8], [240, 180], { most: manyTriangles });
    depth = -1;
    stepper.set(level);
  }
  void latest.during(() => place(4));
  return figure([boxes.root, heat.root], [stepper.root, said, asked.root,
    sceneChoices("lscene", scenes, scene, (value) => {
      scene = value;
      void latest.during(() => place(stepper.step));
    }, manyTriangles)], latest);
}

export const rays: Lesson = {
  id: "ray-casting",
  title: { en: "Ray casting", zh: "光线投射" },
  lead: { en: "Ask the other way round: not where each triangle falls on the picture, but what each pixel looks at.", zh: "反过来问：不问每个三角形落在画面何处，而问每个像素看见什么。" },
  parts: [
    {
      title: { en: "One ray", zh: "一条光线" },
      prose: [
        { en: "A *ray* leaves the eye through the middle of a pixel. Whatever it meets first is what the pixel shows (A. Appel, 1968). To ask every triangle would do. A tree of boxes makes it quick: around all triangles lies a box, in it two more with half of them each, and so on. A ray that passes by a box passes by everything in it.", zh: "*光线*从眼睛出发，穿过像素中心。最先遇到的，就是像素所显示的（A. Appel，1968）。逐一问每个三角形也行；用一棵盒子的树则快得多：所有三角形外有一个盒子，其中又有两个，各含一半，依此类推。光线若从盒子旁经过，也就从其中的一切旁经过。" },
        { en: "The *nearer* of two boxes is asked first. Once something has been met, boxes that begin behind it need not be opened.", zh: "两个盒子中先问*较近的*。一旦有了交点，起点在其后的盒子就不必打开。" },
        { en: "Rays may begin anywhere. From the point that was met another one goes to the light: whatever it meets throws a *shadow* there.", zh: "光线可以从任何地方出发。从交点向光源再发一条：只要遇到任何东西，该点便在*阴影*中。" },
      ],
      figure: walkFigure,
    },
    {
      title: { en: "The tree, level by level", zh: "逐层展开的树" },
      prose: [
        { en: "With the tree closed, a ray that enters the outermost box asks every triangle. Each level that is opened halves what is left to ask. A million triangles have twenty levels: that is why rays hardly mind how large a scene is. The library's own tree has sixteen boxes a node, of which all are asked at once.", zh: "树未展开时，光线只要进入最外层的盒子，就要问遍所有三角形。每展开一层，剩下要问的便减半。一百万个三角形有二十层：因此光线几乎不在乎场景多大。程序库自己的树每个节点有十六个盒子，一次全部问完。" },
      ],
      figure: levelFigure,
    },
  ],
};
