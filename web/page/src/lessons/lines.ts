// SPDX-License-Identifier: Apache-2.0
// Hidden lines: which edges are drawn, and how each is cut where surfaces hide it.
import type { Answer } from "../answer.ts";
import { element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { Eye, facts, figure, Latest, lines, plate, steps, sceneChoices } from "./figure.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [480, 360];
const kinds: [string, Text][] = [["--soft", { en: "boundaries: a side of one triangle alone", zh: "边界：只属于一个三角形" }], ["--accent", { en: "silhouettes: one side faces you, the other does not", zh: "轮廓：一侧朝向你，另一侧不朝向" }],
  ["--soft", { en: "borders of objects and materials", zh: "物体与材质的边界" }], ["--blue", { en: "creases: sides meet at an angle", zh: "折痕：两侧成角" }], ["--green", { en: "intersections: surfaces pass through each other", zh: "交线：面相互穿过" }]];
const keys = ["boundaries", "silhouettes", "borders", "creases", "intersections"];

interface Part { edge: number; kind: number; hiddenBy: number; line: number[]; begin: number; end: number }
/** Parts of edges, nine numbers each, as web/lessons/lines.cpp writes them. */
function partsOf(answer: Answer): Part[] {
  const numbers = new Float32Array(answer.parts), parts: Part[] = [];
  for (let i = 0; i < numbers.length; i += 9) {
    const [edge, kind, hiddenBy, x, y, toX, toY, begin, end] = numbers.subarray(i, i + 9);
    parts.push({ edge, kind, hiddenBy, line: [x, y, toX, toY], begin, end });
  }
  return parts;
}

const scenes: [string, Text][] = [["concave", { en: "a concave body", zh: "凹体" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }], ["blocks", { en: "blocks on a floor", zh: "地面上的方块" }]];

function kindsFigure(): HTMLElement {
  const drawn = plate(say({ en: "What is seen of every edge. Drag to turn", zh: "每条边可见的部分。拖动旋转" }));
  const counts = element("dl", { class: "facts" });
  let scene = "concave";
  const eye = new Eye(drawn.canvas, show);
  const latest = new Latest((answer) => {
    drawn.canvas.width = answer.width;
    drawn.canvas.height = answer.height;
    const parts = partsOf(answer).filter((part) => part.hiddenBy === 0);
    drawn.mark(...kinds.map(([color], kind) => lines(parts.filter((part) => part.kind === kind).map((part) => part.line), color, kind === 1 ? 2.5 : 1.5)));
    counts.replaceChildren(...kinds.flatMap(([color, name], kind) => [element("dt", {}, element("i", { class: "swatch", style: `background:var(${color})` }), say(name)), element("dd", {}, answer[keys[kind]].toLocaleString())]));
  });
  function show(): void {
    if (eye.camera) latest.ask({ ask: "lesson.lines", scene, camera: eye.camera });
  }
  async function place(): Promise<void> {
    await eye.place(scene, [-0.6, -0.45, -0.8], size);
    show();
  }
  void latest.during(place);
  return figure([drawn.root, element("div", {}, counts)], [
    sceneChoices("kscene", [...scenes, ["teapot", { en: "teapot", zh: "茶壶" }] as [string, Text]], scene, (value) => {
      scene = value;
      void latest.during(place);
    })], latest);
}

/** The edge that is cut into most parts. */
function richest(parts: Part[]): number {
  const counts = new Map<number, number>();
  for (const { edge } of parts) counts.set(edge, (counts.get(edge) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? -1;
}

/** Colour, width and dashes of a part that `hiddenBy` surfaces hide. */
const styleOf = (hiddenBy: number): [string, number, string] => hiddenBy === 0 ? ["--ink", 2.2, ""] : hiddenBy === 1 ? ["--blue", 1.6, `stroke-dasharray="7 5"`] : ["--bad", 1.4, `stroke-dasharray="1.5 4.5"`];

const mostRows = 16;
/** A row for each triangle that hides part of an edge, the largest parts first, and the counts below. */
function chart(answer: Answer, parts: Part[]): string {
  const all: Answer[] = answer.intervals, rest = all.length - mostRows, shareOf = (row: Answer) => row.end - row.begin;
  const rows = rest > 0 ? [...all].sort((a, b) => shareOf(b) - shareOf(a)).slice(0, mostRows).sort((a, b) => a.begin - b.begin) : all, left = 104, width = size[0] - left - 24, height = Math.min(30, 250 / Math.max(1, rows.length));
  const x = (share: number) => left + share * width, top = 34, bottom = top + rows.length * height + 18;
  const ends = [...new Set([0, 1, ...parts.flatMap((part) => [part.begin, part.end])])];
  return `<g font-size="13" font-family="var(--sans)" fill="var(--soft)">${ends.map((end) => `<path d="M${x(end)} 26V${bottom + 22}" stroke="var(--line)"/>`).join("")}
<text x="${left}" y="18" text-anchor="middle">0</text><text x="${left + width}" y="18" text-anchor="middle">1</text>
${rows.map((row, i) => `<text x="12" y="${top + (i + 0.5) * height + 4}">${say({ en: "triangle", zh: "三角形" })} ${row.triangle}</text><rect x="${x(row.begin)}" y="${top + i * height + 3}" width="${Math.max(1, x(row.end) - x(row.begin))}" height="${height - 6}" rx="3" fill="var(--blue)" opacity=".45"/>`).join("")}
<text x="12" y="${bottom + 5}">${say({ en: "hidden by", zh: "遮挡数" })}</text>${rest > 0 ? `<text x="12" y="${size[1] - 10}">${say({ en: `and ${rest} triangles that hide less of it`, zh: `另有 ${rest} 个三角形，遮住的更少` })}</text>` : ""}</g>
${parts.map((part) => lines([[x(part.begin), bottom, x(part.end), bottom]], styleOf(part.hiddenBy)[0], 5)
    + (part.end - part.begin > 0.03 ? `<text x="${x((part.begin + part.end) / 2)}" y="${bottom + 22}" text-anchor="middle" font-size="14" font-family="var(--mono)" fill="var(${styleOf(part.hiddenBy)[0]})">${part.hiddenBy}</text>` : "")).join("")}`;
}

function intervalsFigure(): HTMLElement {
  const drawn = plate(say({ en: "Edge after edge. Drag to turn", zh: "逐条处理边。拖动旋转" })), along = plate(say({ en: "Along this edge, from its one end to the other", zh: "沿这条边，从一端到另一端" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const sums = facts();
  let scene = "concave", most = -1;
  [along.canvas.width, along.canvas.height] = size;
  const eye = new Eye(drawn.canvas, () => show(stepper.step));
  const latest = new Latest((answer) => {
    const parts = partsOf(answer);
    if (answer.edges !== most) {
      most = answer.edges;
      stepper.limit(most);
      stepper.set(1 + richest(parts));
      return;
    }
    const step = stepper.step, past = parts.filter((part) => part.edge < step), now = past.filter((part) => part.edge === step - 1);
    drawn.show(answer);
    drawn.canvas.style.opacity = "0.28";
    const shapes = (answer.intervals ?? []).map((one: Answer) => lines(one.lines, "--blue", 0.7));
    shapes.push(lines(now.map((part) => part.line), "--accent", 7, `opacity=".4"`));
    for (const level of [0, 1, 2]) shapes.push(lines(past.filter((part) => Math.min(2, part.hiddenBy) === level).map((part) => part.line), ...styleOf(level)));
    drawn.mark(...shapes);
    along.mark(step > 0 && answer.intervals ? chart(answer, now) : "");
    said.textContent = step === 0 ? say({ en: "Nothing is drawn yet.", zh: "尚未画任何边。" })
      : !answer.intervals?.length ? say({ en: `Edge ${step - 1}: no triangle hides any of it.`, zh: `边 ${step - 1}：没有三角形遮住它。` })
      : say({ en: `Edge ${step - 1}: ${answer.intervals.length} triangles hide something of it, and cut it into ${now.length} ${now.length === 1 ? "part" : "parts"}.`, zh: `边 ${step - 1}：有 ${answer.intervals.length} 个三角形遮住它的一部分，把它切成 ${now.length} 段。` });
    const count = (level: number) => past.filter((part) => Math.min(2, part.hiddenBy) === level).length;
    sums.set([[say({ en: "parts that are seen", zh: "可见的段" }), count(0)], [say({ en: "hidden by one surface", zh: "被一个面遮挡" }), count(1)], [say({ en: "hidden by two or more", zh: "被两个或更多面遮挡" }), count(2)]]);
  });
  function show(step: number): void {
    if (eye.camera) latest.ask({ ask: "lesson.lines", scene, camera: eye.camera, ...(step > 0 ? { edge: step - 1 } : {}) });
  }
  const stepper = steps(24, show, 600);
  async function place(): Promise<void> {
    await eye.place(scene, [-0.6, -0.45, -0.8], size);
    most = -1;
    show(0);
  }
  void latest.during(place);
  return figure([drawn.root, along.root], [stepper.root, said, sums.root,
    sceneChoices("iscene", scenes, scene, (value) => {
      scene = value;
      void latest.during(place);
    })], latest);
}

export const hiddenLines: Lesson = {
  id: "hidden-lines",
  title: { en: "Hidden lines", zh: "消隐线" },
  lead: { en: "A drawing has no pixels. What has to be found is where each line goes out of sight, exactly.", zh: "线图没有像素。要求的是每条线在何处消失，而且要精确。" },
  parts: [
    {
      title: { en: "Which edges", zh: "画哪些边" },
      prose: [
        { en: "Most edges of a mesh lie in smooth surfaces and are not drawn. *Creases* are, where two sides meet at an angle, and lines where surfaces pass through each other: they stay where they are. *Silhouettes* are others from everywhere: edges of which one side faces the eye, and the other does not.", zh: "网格的多数边位于光滑曲面之中，不画。要画的有*折痕*，即两侧成角之处，以及面相互穿过的交线：它们位置不变。*轮廓*则随视点而变：一侧朝向眼睛、另一侧不朝向的边。" },
      ],
      figure: kindsFigure,
    },
    {
      title: { en: "Where they go out of sight", zh: "在何处消失" },
      prose: [
        { en: "Arthur Appel counted in 1967 how many surfaces lie before each point of an edge, its *quantitative invisibility*. Seen from the eye, a triangle hides a pyramid without a top: everything within its three sides and beyond it. An edge lies in there from one point to another. All of these *intervals* together cut the edge into parts: where none covers it, it is seen; where one does, it is hidden by one.", zh: "Arthur Appel 于 1967 年计数边上每一点之前有多少个面，称为*定量不可见性*。从眼睛看去，一个三角形遮住一个截去顶部的棱锥：在它三条边之内且在它之后的一切。边从某点到另一点位于其中。所有这些*区间*合起来把边切成段：无区间覆盖处可见；有一个覆盖处，被一个面遮挡。" },
        { en: "Drawings dash what is hidden, or leave it out. The ends of parts are exact: they do not depend on any resolution.", zh: "线图把隐藏部分画成虚线，或略去。各段端点是精确的，不依赖任何分辨率。" },
      ],
      figure: intervalsFigure,
    },
  ],
};
