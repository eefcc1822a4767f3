// SPDX-License-Identifier: Apache-2.0
// Clipping: a triangle against six planes, one after the other, and what happens through the plane of the eye.
import type { Answer } from "../answer.ts";
import { toImage } from "../client.ts";
import { choices, element, slider } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { dot, Eye, facts, figure, Latest, lines, plate, steps } from "./figure.ts";
import type { Vector } from "../orbit.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [480, 360];
/** Margin around the picture in its plate, so that parts outside the picture are visible. */
const margin: [number, number] = [120, 90];
const planes: Text[] = [{ en: "nothing yet", zh: "尚未裁剪" }, { en: "near: z + w ≥ 0", zh: "近平面：z + w ≥ 0" }, { en: "far: w − z ≥ 0", zh: "远平面：w − z ≥ 0" }, { en: "left: w + x ≥ 0", zh: "左：w + x ≥ 0" },
  { en: "right: w − x ≥ 0", zh: "右：w − x ≥ 0" }, { en: "bottom: w + y ≥ 0", zh: "下：w + y ≥ 0" }, { en: "top: w − y ≥ 0", zh: "上：w − y ≥ 0" }];
const triangles: [string, Text, [Vector, Vector, Vector]][] = [
  ["sides", { en: "beyond the sides", zh: "伸出两侧" }, [[-4, -0.8, -3], [3, -1, -5], [0.6, 3.2, -3]]],
  ["ends", { en: "too near, and too far", zh: "过近与过远" }, [[-1, -0.9, -8], [1.6, -0.2, -4], [0.2, 0.25, -0.6]]],
  ["behind", { en: "one corner behind the eye", zh: "一个顶点在眼后" }, [[-2, -1.1, -5], [1.8, -0.6, -4], [0.5, 0.5, 1]]],
  ["two", { en: "two corners behind the eye", zh: "两个顶点在眼后" }, [[-2.2, -0.7, 1.5], [2, -0.8, 1], [0.3, 0.9, -4.5]]],
];

type Point = [number, number];
function polygon(points: Point[], fill: string, stroke: string, more = ""): string {
  const within = (n: number) => Math.max(-20000, Math.min(20000, n)).toFixed(2);
  return points.length < 3 ? "" : `<polygon points="${points.map(([x, y]) => `${within(x)},${within(y)}`).join(" ")}" fill="${fill}" stroke="${stroke}" stroke-width="2" ${more}/>`;
}

function clipFigure(): HTMLElement {
  const aside = plate(say({ en: "The viewing volume from beside; red: the plane of the eye. Drag to turn", zh: "从旁边看视域；红线：眼睛所在平面。拖动旋转" })), screen = plate(say({ en: "After the division by w: the frame is the picture", zh: "除以 w 之后：方框为画面" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const table = element("div", { class: "scroll" }), sums = facts();
  let chosen = "behind", corners: Vector[] = triangles[2][2].map((corner) => [...corner] as Vector), answer: Answer;
  [aside.canvas.width, aside.canvas.height] = size;
  [screen.canvas.width, screen.canvas.height] = [400 + 2 * margin[0], 300 + 2 * margin[1]];
  const eye = new Eye(aside.canvas, ask);
  eye.camera = { width: size[0], height: size[1], eye: [9.5, 5.5, 4.5], target: [0, 0, -3], up: [0, 1, 0], angle: 37, orthographic: false };
  const latest = new Latest((now) => {
    answer = now;
    show(stepper.step);
  });

  function show(step: number): void {
    if (!answer) return;
    const whole: Answer[] = answer.steps[0], now: Answer[] = answer.steps[step], isDone = step === planes.length - 1;
    const beside = (of: Answer[]) => of.map((corner) => corner.beside as Point);
    const onScreen = (of: Answer[]) => of.map((corner): Point => [corner.screen[0] + margin[0], corner.screen[1] + margin[1]]);
    aside.mark(lines(answer.volume, "--soft", 1.2), lines(answer.eye_plane, "--bad", 1.5, `stroke-dasharray="4 5"`), polygon(beside(whole), "none", "var(--soft)", `stroke-dasharray="5 5"`),
      polygon(beside(now), "color-mix(in srgb, var(--accent) 30%, transparent)", "var(--accent)"), ...now.filter((corner) => corner.is_new).map((corner) => dot(corner.beside[0], corner.beside[1], "--blue")), dot(answer.eye[0], answer.eye[1], "--ink", 6));
    const pen = screen.canvas.getContext("2d")!;
    pen.clearRect(0, 0, screen.canvas.width, screen.canvas.height);
    if (isDone) pen.putImageData(toImage(answer), margin[0], margin[1]);
    const isWrong = now.some((corner) => corner.clip[3] <= 0);
    screen.mark(`<rect x="${margin[0]}" y="${margin[1]}" width="400" height="300" fill="none" stroke="var(--soft)" stroke-width="1.5"/>`,
      polygon(onScreen(now), isWrong ? "color-mix(in srgb, var(--bad) 18%, transparent)" : isDone ? "none" : "color-mix(in srgb, var(--accent) 30%, transparent)", isWrong ? "var(--bad)" : "var(--accent)", isWrong ? `stroke-dasharray="7 5"` : ""),
      ...onScreen(now).map(([x, y], i) => dot(Math.max(-99, Math.min(999, x)), Math.max(-99, Math.min(999, y)), now[i].is_new ? "--blue" : "--accent")));
    said.replaceChildren(element("b", {}, say(planes[step])), " · ", now.length === 0 ? say({ en: "Nothing is left.", zh: "什么也没留下。" }) : say({ en: `${now.length} corners.`, zh: `${now.length} 个顶点。` }), " ",
      isWrong ? say({ en: "A corner has w below 0: it lies behind the eye, and the division throws it to the other side of the picture. What is drawn here is not the triangle.", zh: "有顶点的 w 小于 0：它在眼睛之后，相除会把它抛到画面另一侧。此处画出的并不是那个三角形。" })
        : isDone ? say({ en: "What is left fills the picture's share exactly.", zh: "留下的正好是画面中的部分。" }) : "");
    const number = (n: number) => element("td", { class: "share" }, n.toFixed(2));
    table.replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, ...["x", "y", "z", "w", "x / w", "y / w"].map((name) => element("th", { style: "text-align:right" }, name)))),
      element("tbody", {}, ...now.map(({ clip }) => element("tr", { class: clip[3] <= 0 ? "bad" : undefined }, ...clip.map(number), number(clip[0] / clip[3]), number(clip[1] / clip[3]))))));
    sums.set([[say({ en: "area of what is left, in pixels", zh: "剩余面积（像素）" }), isDone ? answer.area.toFixed(3) : "–"], [say({ en: "visible area by the library", zh: "程序库求得的可见面积" }), answer.library.toFixed(3)]]);
  }
  const stepper = steps(planes.length - 1, show, 900);
  function ask(): void {
    latest.ask({ ask: "lesson.clipping", corners, beside: eye.camera });
  }
  const away = slider(say({ en: "third corner: z", zh: "第三个顶点的 z" }), { min: -8, max: 2, step: 0.05, value: corners[2][2] }, (z) => z.toFixed(2), (z) => {
    corners[2][2] = z;
    ask();
  });
  ask();
  setTimeout(() => stepper.set(1));
  return figure([aside.root, screen.root], [stepper.root, said, away.field, table, sums.root,
    choices("tscene", say({ en: "Triangle", zh: "三角形" }), triangles.map(([id, text]) => [id, say(text)]), chosen, (value) => {
      chosen = value;
      corners = triangles.find(([id]) => id === value)![2].map((corner) => [...corner] as Vector);
      away.input.value = String(corners[2][2]);
      away.field.querySelector("output")!.textContent = corners[2][2].toFixed(2);
      ask();
    })], latest);
}

export const clipping: Lesson = {
  id: "clipping",
  title: { en: "Clipping", zh: "裁剪" },
  lead: { en: "What lies outside of the viewing volume is cut off, and it has to be before anything is divided.", zh: "视域之外的部分要切掉，而且必须在相除之前。" },
  parts: [{
    prose: [
      { en: "A camera's matrix takes a point to *clip space*, four numbers x, y, z and w, of which w is how far it lies before the eye. Divided by w they are a place in the picture. The viewing volume is where all of them lie between −w and w: six planes.", zh: "相机矩阵把点变到*裁剪空间*：x、y、z、w 四个数，其中 w 是点在眼前的距离。除以 w 便得画面中的位置。视域就是三者都在 −w 与 w 之间之处：六个平面。" },
      { en: "Sutherland and Hodgman (1974) walk around the polygon once for each plane. Corners inside stay; where a side crosses the plane a *new corner* is put. A triangle can get up to six corners more, and what is left is convex, and may be drawn.", zh: "Sutherland 与 Hodgman（1974）对每个平面绕多边形走一圈：内侧的顶点保留，边与平面相交处放一个*新顶点*。三角形最多可增加六个顶点，剩下的仍是凸多边形，可以绘制。" },
      { en: "Points *behind the eye* have a negative w. Divided, they come out on the wrong side of the picture; at w = 0 there is no place at all. So the near plane comes first, and after it every w is positive. The other planes may be left to the edge of the picture: graphics hardware and this library cut at the sides only what reaches very far out.", zh: "*眼后*的点 w 为负，相除后会出现在画面错误的一侧；w = 0 时根本没有位置。所以先用近平面裁剪，此后所有 w 都为正。其余平面可以交给画面边缘处理：图形硬件与本程序库只在超出很远时才在侧面裁剪。" },
    ],
    figure: clipFigure,
  }],
};
