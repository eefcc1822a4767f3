// SPDX-License-Identifier: Apache-2.0
// Projection and depth: 1/z along a segment, the resolution of formats, and plates that fight.
import type { Answer } from "../answer.ts";
import { choices, element, slider, sliders } from "../dom.ts";
import { say } from "../language.ts";
import type { Camera, Vector } from "../orbit.ts";
import { dot, Eye, figure, framed, ink, Latest, lines, plate } from "./figure.ts";
import type { Lesson } from "./list.ts";

/** A wall seen from above, whose ends can be dragged, and beside it the depths in the picture. */
function segmentFigure(): HTMLElement {
  const plan = plate(say({ en: "From above: drag the ends. Arrow keys move the left one, with Shift the right one", zh: "俯视：拖动两端。方向键移动左端，按住 Shift 移动右端" })), graph = plate(say({ en: "Depth across the picture", zh: "画面上的深度" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const ends = [{ x: -4, d: 2 }, { x: 2, d: 5 }];
  const width = 480, height = 360, unitOf = 44, eye = { x: width / 2, y: height - 30 };
  let held = -1;
  for (const { canvas } of [plan, graph]) [canvas.width, canvas.height] = [width, height];
  const at = (end: { x: number; d: number }): [number, number] => [eye.x + end.x * unitOf, eye.y - end.d * unitOf];

  function drawPlan(): void {
    const pen = plan.canvas.getContext("2d")!;
    pen.clearRect(0, 0, width, height);
    pen.strokeStyle = ink("--line");
    pen.beginPath();
    for (const side of [-1, 1]) {
      pen.moveTo(eye.x, eye.y);
      pen.lineTo(eye.x + side * 2.2 * 7 * unitOf, eye.y - 7 * unitOf);
    }
    pen.stroke();
    pen.setLineDash([4, 6]);
    pen.strokeStyle = ink("--soft");
    pen.beginPath();
    pen.moveTo(eye.x, eye.y);
    pen.lineTo(eye.x, 10);
    pen.stroke();
    pen.setLineDash([]);
    pen.strokeStyle = ink("--blue");
    pen.lineWidth = 2;
    pen.beginPath(); // the picture plane, at unit distance
    pen.moveTo(eye.x - 2.2 * unitOf, eye.y - unitOf);
    pen.lineTo(eye.x + 2.2 * unitOf, eye.y - unitOf);
    pen.stroke();
    pen.strokeStyle = ink("--accent");
    pen.lineWidth = 4;
    pen.beginPath();
    pen.moveTo(...at(ends[0]));
    pen.lineTo(...at(ends[1]));
    pen.stroke();
    pen.fillStyle = ink("--accent");
    for (const end of ends) {
      pen.beginPath();
      pen.arc(...at(end), 9, 0, 7);
      pen.fill();
    }
    pen.fillStyle = ink("--ink");
    pen.beginPath();
    pen.arc(eye.x, eye.y, 6, 0, 7);
    pen.fill();
  }
  function drawGraph(answer: Answer): void {
    const pen = graph.canvas.getContext("2d")!, most = 7;
    pen.clearRect(0, 0, width, height);
    const place = (i: number, depth: number): [number, number] => [(i / (answer.depth.length - 1)) * (width - 40) + 30, height - 30 - (depth / most) * (height - 50)];
    pen.font = "13px system-ui";
    pen.fillStyle = ink("--soft");
    pen.strokeStyle = ink("--line");
    for (let depth = 0; depth <= most; ++depth) {
      pen.beginPath();
      pen.moveTo(...place(0, depth));
      pen.lineTo(...place(answer.depth.length - 1, depth));
      pen.stroke();
      pen.fillText(String(depth), 10, place(0, depth)[1] + 4);
    }
    const middle = (answer.depth.length - 1) / 2;
    for (const [name, color, dash] of [["linear", "--blue", [6, 5]], ["depth", "--accent", []]] as [string, string, number[]][]) {
      pen.strokeStyle = pen.fillStyle = ink(color);
      pen.lineWidth = 2.5;
      pen.setLineDash(dash);
      pen.beginPath();
      let isDown = false;
      answer[name].forEach((depth: number | null, i: number) => {
        if (depth === null) isDown = false;
        else if (isDown) pen.lineTo(...place(i, depth));
        else {
          pen.moveTo(...place(i, depth));
          isDown = true;
        }
      });
      pen.stroke();
      if (answer[name][middle] !== null) {
        pen.beginPath();
        pen.arc(...place(middle, answer[name][middle]), 5, 0, 7);
        pen.fill();
      }
    }
    pen.setLineDash([]);
    const [depth, linear] = [answer.depth[middle], answer.linear[middle]];
    said.replaceChildren(depth === null ? say({ en: "Straight ahead there is nothing.", zh: "正前方什么也没有。" }) : say({ en: "Straight ahead, by 1/z: ", zh: "正前方，按 1/z：" }),
      depth === null ? "" : element("b", {}, depth.toFixed(3)), depth === null ? "" : say({ en: ". By z itself it would be ", zh: "。若直接对 z 插值则为 " }), depth === null ? "" : element("b", {}, (linear ?? NaN).toFixed(3)), depth === null ? "" : say({ en: ", which is wrong.", zh: "，是错的。" }));
  }
  const latest = new Latest(drawGraph);
  function update(): void {
    drawPlan();
    latest.ask({ ask: "lesson.projection", example: "segment", x0: ends[0].x, d0: ends[0].d, x1: ends[1].x, d1: ends[1].d });
  }
  const { canvas } = plan;
  const where = (event: PointerEvent): [number, number] => [(event.offsetX / canvas.clientWidth) * width, (event.offsetY / canvas.clientHeight) * height];
  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = where(event);
    const away = ends.map((end) => Math.hypot(at(end)[0] - x, at(end)[1] - y));
    held = away[0] < away[1] ? 0 : 1;
    if (away[held] > 60) held = -1;
    else canvas.setPointerCapture(event.pointerId);
  });
  // A finger on an end drags it; elsewhere it scrolls the page.
  canvas.addEventListener("touchstart", (event) => held >= 0 && event.preventDefault(), { passive: false });
  const move = (end: number, x: number, d: number) => {
    const round = (n: number) => Math.round(n * 4) / 4;
    ends[end] = { x: Math.max(-5, Math.min(5, round(x))), d: Math.max(1, Math.min(7, round(d))) };
    update();
  };
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = where(event);
    if (held >= 0) move(held, (x - eye.x) / unitOf, (eye.y - y) / unitOf);
  });
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application");
  canvas.addEventListener("keydown", (event) => {
    const by: Record<string, [number, number]> = { ArrowLeft: [-0.25, 0], ArrowRight: [0.25, 0], ArrowUp: [0, 0.25], ArrowDown: [0, -0.25] };
    if (!by[event.key]) return;
    event.preventDefault();
    const end = event.shiftKey ? 1 : 0;
    move(end, ends[end].x + by[event.key][0], ends[end].d + by[event.key][1]);
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => (held = -1));
  addEventListener("themechange", update);
  update();
  return figure([plan.root, graph.root], [said], latest);
}

const power = (value: number) => 10 ** value;
const short = (value: number) => (value >= 1000 || value < 0.001 ? value.toExponential(1) : String(Number(value.toPrecision(3))));

function formatFigure(): HTMLElement {
  const graph = plate(say({ en: "The smallest gap that is told apart, by distance (both scales logarithmic)", zh: "各距离上可分辨的最小间隔（双对数坐标）" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const setting = { near: 0.1, far: 1000 };
  const width = 720, height = 360;
  [graph.canvas.width, graph.canvas.height] = [width, height];
  const colors: Record<string, string> = { D16: "--bad", D24: "--accent", F32: "--blue", "F32 reversed": "--green" };

  function draw(answer: Answer): void {
    const pen = graph.canvas.getContext("2d")!;
    pen.clearRect(0, 0, width, height);
    const low = -9, high = 4, distances: number[] = answer.distances;
    const from = Math.log10(distances[0]), to = Math.log10(distances[distances.length - 1]);
    const place = (distance: number, gap: number): [number, number] => [50 + ((Math.log10(distance) - from) / (to - from)) * (width - 150), height - 30 - ((Math.max(low, Math.min(high, Math.log10(gap))) - low) / (high - low)) * (height - 50)];
    pen.font = "12px system-ui";
    pen.strokeStyle = ink("--line");
    pen.fillStyle = ink("--soft");
    for (let e = low; e <= high; e += 2) {
      const [, y] = place(distances[0], power(e));
      pen.beginPath();
      pen.moveTo(50, y);
      pen.lineTo(width - 100, y);
      pen.stroke();
      pen.fillText(`1e${e}`, 10, y + 4);
    }
    for (let e = Math.ceil(from); e <= to; ++e) pen.fillText(short(power(e)), place(power(e), 1)[0] - 8, height - 10);
    const taken: number[] = [];
    for (const [name, gaps] of Object.entries<(number | null)[]>(answer.gaps)) {
      pen.strokeStyle = pen.fillStyle = ink(colors[name]);
      pen.lineWidth = 2.5;
      pen.beginPath();
      gaps.forEach((gap, i) => pen[i ? "lineTo" : "moveTo"](...place(distances[i], gap ?? 1e9)));
      pen.stroke();
      let y = place(1, gaps[gaps.length - 1] ?? 1e9)[1] + 4;
      while (taken.some((other) => Math.abs(other - y) < 14)) y += 14;
      taken.push(y);
      pen.fillText(name, width - 94, y);
    }
    said.textContent = say({ en: `Of all values ${(100 * answer.share_of_first_tenth).toFixed(1)} % lie in the first tenth of the way from near to far.`, zh: `全部数值中有 ${(100 * answer.share_of_first_tenth).toFixed(1)} % 落在近平面到远平面路程的前十分之一。` });
  }
  const latest = new Latest(draw);
  const update = () => latest.ask({ ask: "lesson.projection", example: "gaps", ...setting });
  addEventListener("themechange", update);
  update();
  return figure([graph.root], [said,
    slider(say({ en: "near", zh: "近平面" }), { min: -3, max: 1, step: 0.05, value: -1 }, (v) => short(power(v)), (v) => {
      setting.near = power(v);
      update();
    }).field,
    slider(say({ en: "far", zh: "远平面" }), { min: 1.1, max: 5, step: 0.05, value: 3 }, (v) => short(power(v)), (v) => {
      setting.far = power(v);
      update();
    }).field], latest);
}

function fightFigure(): HTMLElement {
  const picture = plate(say({ en: "A stripe on a road", zh: "路面上的条带" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const setting = { near: 0.01, far: 1000, gap: 0.01, format: 1, reversed: false };
  const latest = new Latest((answer) => {
    picture.show(answer);
    said.replaceChildren(element("b", {}, answer.wrong.toLocaleString()), say({ en: ` of ${answer.covered.toLocaleString()} pixels show what is not the nearest.`, zh: ` 个像素（共 ${answer.covered.toLocaleString()}）显示的不是最近的面。` }));
  });
  const update = () => latest.ask({ ask: "lesson.projection", example: "fight", width: 640, height: 360, ...setting });
  const formats: [string, string][] = [["1", "D16"], ["2", "D24"], ["3", "F32"], ["3r", say({ en: "F32 reversed", zh: "F32 反向" })]];
  update();
  return figure([picture.root], [said,
    choices("format", say({ en: "Format", zh: "格式" }), formats, "1", (value) => {
      setting.format = Number(value[0]);
      setting.reversed = value.endsWith("r");
      update();
    }),
    slider(say({ en: "near", zh: "近平面" }), { min: -3, max: 0, step: 0.02, value: -2 }, (v) => short(power(v)), (v) => {
      setting.near = power(v);
      update();
    }).field,
    slider(say({ en: "gap", zh: "间隔" }), { min: -4, max: -0.5, step: 0.02, value: -2 }, (v) => short(power(v)), (v) => {
      setting.gap = power(v);
      update();
    }).field], latest);
}

/** A viewing volume that can be changed, and its picture. */
function frustumFigure(): HTMLElement {
  const seen = plate(say({ en: "The picture", zh: "画面" })), aside = plate(say({ en: "The viewing volume from beside. Drag to turn", zh: "从旁边看视域。拖动旋转" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const matrix = element("div", { class: "scroll" });
  const size: [number, number] = [480, 360];
  const setting = { angle: 40, near: 3.4, far: 7, away: 1 };
  let camera: Camera | undefined;
  const eye = new Eye(aside.canvas, ask);
  const latest = new Latest((answer: Answer) => {
    seen.show(answer);
    aside.show(answer, "beside", size);
    aside.mark(lines(answer.volume, "--accent", 1.8), dot(answer.eye[0], answer.eye[1], "--ink", 6));
    const [left, right, bottom, top] = answer.sides.map((side: number) => side.toFixed(3));
    said.textContent = say({ en: `At unit distance the picture reaches from ${left} to ${right}, and from ${bottom} to ${top}. Below, the matrix to clip space (OpenGL's).`, zh: `在单位距离处，画面横向从 ${left} 到 ${right}，纵向从 ${bottom} 到 ${top}。下面是到裁剪空间的矩阵（OpenGL 约定）。` });
    matrix.replaceChildren(element("table", {}, element("tbody", {}, ...answer.matrix.map((row: number[]) => element("tr", {}, ...row.map((entry) => element("td", { class: "share" }, entry.toFixed(3))))))));
  });
  function ask(): void {
    if (!camera || !eye.camera) return;
    const at = camera.eye.map((from, i) => camera!.target[i] + (from - camera!.target[i]) * setting.away);
    latest.ask({ ask: "lesson.projection", example: "frustum", scene: "blocks", camera: { ...camera, eye: at, angle: setting.angle, near: Math.min(setting.near, setting.far - 0.1), far: setting.far }, beside: eye.camera });
  }
  async function place(): Promise<void> {
    camera = await framed("blocks", [-0.6, -0.45, -0.8], size, { angle: 40 });
    const beyond = camera.target.map((at, i) => at + 0.45 * (at - camera!.eye[i])) as Vector;
    const around = [[0, 2.4, 0], [0, -2.4, 0], [2.2, 0, -2.2], [-2.2, 0, 2.2]].map((by) => by.map((n, i) => n + beyond[i]) as Vector);
    await eye.place("blocks", [0.9, -0.4, -0.35], size, { beside: [camera.eye, ...around] });
    ask();
  }
  void latest.during(place);
  const knob = sliders(setting, ask);
  return figure([seen.root, aside.root], [said,
    knob(say({ en: "angle", zh: "视角" }), "angle", 5, 110, 1, (v) => `${v}°`), knob(say({ en: "near", zh: "近平面" }), "near", 0.1, 8, 0.05, (v) => v.toFixed(2)), knob(say({ en: "far", zh: "远平面" }), "far", 1, 12, 0.05, (v) => v.toFixed(2)),
    knob(say({ en: "eye", zh: "眼睛远近" }), "away", 0.3, 1.6, 0.01, (v) => v.toFixed(2)), matrix], latest);
}

export const projection: Lesson = {
  id: "projection",
  title: { en: "Projection and depth", zh: "投影与深度" },
  lead: { en: "On the screen depth does not run evenly: its reciprocal does.", zh: "在屏幕上，均匀变化的不是深度，而是它的倒数。" },
  parts: [
    {
      title: { en: "The viewing volume", zh: "视域" },
      prose: [
        { en: "What a camera can see is a pyramid whose top is cut off: its sides go through the eye and the edges of the picture, and a *near* and a *far* plane end it. What comes too near is cut open; what is too far is gone. Come nearer and widen the angle, and things in front grow while those behind shrink.", zh: "相机能看见的是截去顶部的棱锥：侧面经过眼睛与画面边缘，*近平面*与*远平面*为其两端。太近的被切开，太远的消失。靠近并加大视角，前面的东西变大，后面的变小。" },
      ],
      figure: frustumFigure,
    },
    {
      title: { en: "One over z", zh: "z 分之一" },
      prose: [
        { en: "A wall goes from (−4, 2) to (2, 5): from four to the left and two away, to two to the right and five away. How far is it straight ahead? On the screen its ends are at −2 and 0.4. The middle of the screen is five sixths of the way, so z would be 4.5. It is 4.", zh: "一堵墙从 (−4, 2) 到 (2, 5)：从左四远二，到右二远五。正前方有多远？两端在屏幕上位于 −2 与 0.4，屏幕中央在六分之五处，按 z 插值得 4.5。实际是 4。" },
        { en: "*1/z* is what may be interpolated on the screen: 1/2 + 5/6 · (1/5 − 1/2) = 1/4. Everything that is to be right in perspective goes by it: depths, textures, colours.", zh: "可以在屏幕上插值的是 *1/z*：1/2 + 5/6 ·（1/5 − 1/2）= 1/4。凡要在透视下正确的量，深度、纹理、颜色，都按它计算。" },
      ],
      figure: segmentFigure,
    },
    {
      title: { en: "Near, far, and what is told apart", zh: "近、远与分辨率" },
      prose: [
        { en: "A buffer stores depth in so many bits. As it is 1/z that is stored, most values lie just before the eye. What decides is the *near* plane: twice as far away, twice as fine everywhere. The far plane hardly matters. Floats that count from the far end, *reversed*, spread their own fineness against that of 1/z, and resolve about the same share of any distance.", zh: "缓冲用有限的位数存深度。由于存的是 1/z，多数数值挤在眼前。起决定作用的是*近平面*：移远一倍，处处精细一倍；远平面几乎无关。*反向*的浮点数从远端计起，其自身的精细分布恰与 1/z 相抵，于是在任何距离上都分辨大致相同的比例。" },
      ],
      figure: formatFigure,
    },
    {
      title: { en: "Where it fails", zh: "失败之处" },
      prose: [
        { en: "Two surfaces that are nearer to each other than the gap are stored as one depth. Then the order of drawing decides, and they seem to fight. Every wrong pixel here is counted against exact arithmetic.", zh: "两个面的距离小于可分辨间隔时，存成同一深度，于是由绘制次序决定，看起来像在打架。这里的每个错误像素都与精确算术比对后计数。" },
      ],
      figure: fightFigure,
    },
  ],
};
