// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: objects from the eye outwards, the cells that they cover, and objects proved hidden.
import type { Answer } from "../answer.ts";
import { choices, element, slider } from "../dom.ts";
import { say } from "../language.ts";
import { dot, Eye, facts, figure, Latest, lines, plate, sceneChoices, steps } from "./figure.ts";
import { cross, minus, plus, times, unit } from "../orbit.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [480, 320];

/** A shape of the covered cells; adjacent cells of a row are joined. */
function mask(answer: Answer): string {
  const { cells, across, cell } = answer;
  let path = "";
  for (let begin = 0; begin < cells.length; ++begin) {
    if (cells[begin] !== "1") continue;
    let end = begin + 1;
    while (end % across !== 0 && cells[end] === "1") ++end;
    path += `M${(begin % across) * cell} ${Math.floor(begin / across) * cell}h${(end - begin) * cell}v${cell}h${-(end - begin) * cell}z`;
    begin = end - 1;
  }
  return `<path d="${path}" fill="var(--blue)" opacity=".4"/>`;
}

function sweepFigure(): HTMLElement {
  const seen = plate(say({ en: "The cells that are covered so far. Drag to turn", zh: "目前已覆盖的格子。拖动旋转" })), plan = plate(say({ en: "From above: objects in the order of visiting", zh: "俯视：按访问次序的物体" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const sums = facts();
  let scene = "town", cell = 8, isLow = true, isNew = true;
  [plan.canvas.width, plan.canvas.height] = size;
  const eye = new Eye(seen.canvas, () => show(stepper.step));
  const colors: Record<string, string> = { outside: "--line", hidden: "--blue", may_be_seen: "--accent" };

  function drawPlan(answer: Answer, step: number): void {
    const camera = eye.camera!, up = camera.world_up ?? [0, 1, 0];
    const flat = ([x, y, z]: number[]): [number, number] => (up[2] ? [x, -y] : [x, z]);
    const places: [number, number][] = [flat(camera.eye), ...answer.objects.flatMap(({ low, high }: Answer) => [flat(low), flat(high)])];
    const [from, to] = [Math.min, Math.max].map((least) => [0, 1].map((axis) => places.reduce((found, place) => least(found, place[axis]), places[0][axis])));
    const scale = Math.min((size[0] - 40) / (to[0] - from[0]), (size[1] - 40) / (to[1] - from[1]));
    const at = (place: number[]): [number, number] => flat(place).map((n, axis) => size[axis] / 2 + (n - (from[axis] + to[axis]) / 2) * scale) as [number, number];
    const forward = unit(minus(camera.target, camera.eye)), right = unit(cross(forward, up)), far = (2 * Math.max(...size)) / scale;
    const wide = Math.tan((camera.angle * Math.PI) / 360) * (size[0] / size[1]);
    const side = (sign: number): number[] => [...at(camera.eye), ...at(plus(camera.eye, times(plus(forward, times(right, sign * wide)), far)))];
    const isCrowded = answer.objects.length > 100;
    const boxes = answer.objects.map((object: Answer, i: number) => {
      const ends = [at(object.low), at(object.high)], [x, toX] = ends.map(([x]) => x), [y, toY] = ends.map(([, y]) => y).sort((a, b) => a - b), isVisited = i < step;
      return `<rect x="${x}" y="${y}" width="${toX - x}" height="${toY - y}" rx="2" fill="var(${isVisited ? colors[object.sight] : "--panel"})" fill-opacity="${scene === "town" ? 1 : 0.5}" stroke="var(${i === step - 1 ? "--ink" : "--soft"})" stroke-width="${i === step - 1 ? 3 : 1}"/>`
        + (isVisited && !isCrowded ? `<text x="${(x + toX) / 2}" y="${(y + toY) / 2 + 3.5}" text-anchor="middle" font-size="9.5" font-family="var(--mono)" fill="var(${object.sight === "outside" ? "--ink" : "--panel"})">${i + 1}</text>` : "");
    });
    plan.mark(lines([side(-1), side(1)], "--soft", 1, `stroke-dasharray="4 5"`), ...boxes, dot(...at(camera.eye), "--ink", 6));
  }
  const latest = new Latest((answer: Answer) => {
    const { objects } = answer;
    if (isNew) {
      isNew = false;
      stepper.limit(objects.length);
      stepper.set(Math.ceil(objects.length * 0.4));
      return;
    }
    const { step } = stepper;
    seen.show(answer);
    const now = objects[step - 1];
    seen.mark(mask(answer), now && answer.lines ? lines(answer.lines, now.sight === "hidden" ? "--bad" : "--accent", 2) : "");
    drawPlan(answer, step);
    said.textContent = !now ? say({ en: "Nothing has been visited, and nothing is covered.", zh: "尚未访问任何物体，也没有格子被覆盖。" })
      : now.sight === "outside" ? say({ en: `Object ${step} lies outside of the view.`, zh: `物体 ${step} 在视域之外。` })
      : now.sight === "hidden" ? say({ en: `Object ${step}: every cell that it reaches is covered by what is nearer. It is hidden, for certain, and need not be drawn.`, zh: `物体 ${step}：它所及的每个格子都已被更近者覆盖。它必定被遮挡，无需绘制。` })
      : say({ en: `Object ${step}: it reaches cells that are open, so it may be seen. Now it covers cells itself.`, zh: `物体 ${step}：它及于未覆盖的格子，可能可见。现在它也覆盖格子。` });
    const count = (of: Answer[], sight: string) => of.filter((object) => object.sight === sight).length, past = objects.slice(0, step);
    sums.set([[say({ en: "proved hidden so far", zh: "目前已证明被遮挡" }), `${count(past, "hidden")} / ${count(objects, "hidden")}`], [say({ en: "may be seen", zh: "可能可见" }), `${count(past, "may_be_seen")} / ${count(objects, "may_be_seen")}`],
      [say({ en: "outside of the view", zh: "视域之外" }), `${count(past, "outside")} / ${count(objects, "outside")}`], [say({ en: "really seen in the picture", zh: "画面中实际可见" }), objects.filter((object: Answer) => object.seen).length],
      ...(answer.object_count > objects.length ? [[say({ en: "objects there are, of which the nearest are visited here", zh: "物体总数，此处只访问其中最近的" }), answer.object_count] as [string, number]] : [])]);
  });
  function show(step: number): void {
    if (eye.camera) latest.ask({ ask: "lesson.occlusion", scene, camera: eye.camera, cell, step });
  }
  const stepper = steps(64, show, 450);
  async function place(): Promise<void> {
    if (scene === "town") eye.camera = { width: size[0], height: size[1], eye: [0.1, isLow ? 0.55 : 2.6, 2.4], target: [0.1, 0.5, -3.5], up: [0, 1, 0], angle: 46, orthographic: false };
    else await eye.place(scene, isLow ? [-0.6, -0.1, -0.8] : [-0.6, -0.6, -0.8], size);
    show(stepper.step);
  }
  void latest.during(place);
  const cells = slider(say({ en: "cell, pixels", zh: "格子（像素）" }), { min: 1, max: 5, step: 1, value: 3 }, (v) => `${2 ** v}²`, (v) => {
    cell = 2 ** v;
    show(stepper.step);
  });
  return figure([seen.root, plan.root], [stepper.root, said, sums.root,
    cells.field,
    choices("oview", say({ en: "Eye", zh: "眼睛" }), [["low", say({ en: "low, as in the street", zh: "低处，如在街上" })], ["high", say({ en: "above the roofs", zh: "在屋顶之上" })]], "low", (value) => {
      isLow = value === "low";
      void latest.during(place);
    }),
    sceneChoices("oscene", [["town", { en: "a town", zh: "小城" }], ["gallery", { en: "gallery", zh: "陈列" }], ["teapot", { en: "teapot", zh: "茶壶" }]], scene, (value) => {
      scene = value;
      isNew = true;
      eye.camera = undefined;
      // The other scenes have many triangles for a cell, which then cover no large cell.
      cells.input.value = value === "town" ? "3" : "1";
      cells.input.dispatchEvent(new Event("input"));
      void latest.during(place);
    })], latest);
}

export const occlusion: Lesson = {
  id: "occlusion-culling",
  title: { en: "Occlusion culling", zh: "遮挡剔除" },
  lead: { en: "What is surely hidden need not be drawn. The whole art is to know it for less than drawing costs.", zh: "必定被遮挡的无需绘制。关键在于以低于绘制的代价得知这一点。" },
  parts: [{
    prose: [
      { en: "In a street the nearest houses hide most of the town. Objects are *visited from the eye outwards*. The picture is divided into cells, and a *mask* says which of them are covered, wholly, by what has been visited. An object all of whose cells are covered is hidden: it lies behind.", zh: "在街上，最近的房屋遮住了城市的大部分。按*由近及远*的次序访问物体。画面分为格子，*掩码*记录哪些格子已被访问过的物体完全覆盖。若一个物体的所有格子都已覆盖，它就被遮挡：它在后面。" },
      { en: "A cell that an edge passes stays open, so errors go one way only: what is said to be hidden *is* hidden, at every point of every cell, while some of what may be seen is not. Smaller cells prove more, and cost more. The same mask answers for things that are not in the scene, such as the box around a crowd (N. Greene, M. Kass, G. Miller, 1993). A model of few objects, such as the teapot, is taken apart: into what hangs together, or into *clusters* of neighbouring triangles. What has more than one triangle for every two cells is not asked to cover any: hardly a cell is without an edge then.", zh: "有边穿过的格子保持敞开，因此错误只有一个方向：说被遮挡的*必定*被遮挡，在每个格子的每一点上都如此；而说可能可见的，有些其实看不见。格子越小，证明得越多，代价也越高。同一掩码还能回答不在场景中的东西，例如人群的包围盒（N. Greene、M. Kass、G. Miller，1993）。物体很少的模型，如茶壶，先拆开：按相连的部分，或按相邻三角形的*簇*。若三角形多于格子数的一半，就不再用它覆盖：那时几乎每个格子都有边穿过。" },
    ],
    figure: sweepFigure,
  }],
};
