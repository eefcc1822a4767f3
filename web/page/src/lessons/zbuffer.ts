// SPDX-License-Identifier: Apache-2.0
// The z-buffer: the classic table of integers cell by cell, a picture triangle by triangle, and two surfaces in one plane.
import type { Answer } from "../answer.ts";
import { choices, element, sliders } from "../dom.ts";
import { say } from "../language.ts";
import { client, figure, Latest, lines, plate, type Plate, pointing, sceneChoices, steps, Trouble } from "./figure.ts";
import type { Lesson } from "./list.ts";

interface Cell { x: number; y: number; depth: number; before: number; after: number; passes: boolean }

function tableFigure(): HTMLElement {
  const cells = Array.from({ length: 64 }, () => element("div", {}));
  const grid = element("div", { class: "grid8", role: "img", "aria-label": say({ en: "A depth buffer of 8 by 8 integers", zh: "8×8 的整数深度缓冲" }) }, ...cells);
  const said = element("p", { class: "said", "aria-live": "polite" });
  let answer: Answer;
  let greater = false, reversed = false;
  let order: { triangle: number; cell: Cell }[] = [];

  function show(step: number): void {
    if (!answer) return;
    const values = new Array<number>(64).fill(answer.clear), owner = new Array<number>(64).fill(-1);
    for (const { triangle, cell } of order.slice(0, step)) {
      const i = cell.y * 8 + cell.x;
      values[i] = cell.after;
      if (cell.passes) owner[i] = triangle;
    }
    const last = order[step - 1];
    cells.forEach((cell, i) => {
      cell.textContent = String(values[i]);
      const isNow = last && last.cell.y * 8 + last.cell.x === i;
      cell.className = `${owner[i] >= 0 ? `t${owner[i]}` : ""}${isNow ? ` now${last.cell.passes ? "" : " fails"}` : ""}`;
    });
    const sign = greater ? ">" : "<";
    if (!last) {
      said.textContent = say({ en: `Cleared: ${answer.clear} everywhere, which is as far away as anything can be.`, zh: `清除：处处为 ${answer.clear}，即最远。` });
      return;
    }
    const { cell } = last, name = say({ en: `Triangle ${last.triangle + 1}`, zh: `三角形 ${last.triangle + 1}` });
    said.replaceChildren(`${name}, (${cell.x}, ${cell.y}): `, element("b", {}, `${cell.depth} ${sign} ${cell.before}`), cell.passes
      ? say({ en: "? Yes: it is nearer, so its depth is stored and its colour is drawn.", zh: "？是：更近，于是写入深度并画上颜色。" })
      : say({ en: "? No: something nearer is there already. Nothing changes.", zh: "？否：那里已有更近的东西，什么也不变。" }));
  }

  const stepper = steps(0, show, 160);
  async function load(): Promise<void> {
    // In the other convention 255 - depth is stored, as the far plane is 0.
    const near = 64, far = 127;
    answer = await client().ask({ ask: "lesson.zbuffer", example: "table", greater, first: reversed ? far : near, second: reversed ? near : far });
    order = answer.triangles.flatMap((list: Cell[], triangle: number) => list.map((cell) => ({ triangle, cell })));
    stepper.limit(order.length);
    stepper.set(0);
  }
  const trouble = new Trouble();
  void trouble.during(load);
  return figure([grid], [
    stepper.root, said,
    choices("convention", say({ en: "Convention", zh: "约定" }), [["less", say({ en: "near 0, far 255: less is nearer", zh: "近 0 远 255：小者近" })], ["greater", say({ en: "far 0: greater is nearer", zh: "远 0：大者近" })]], "less", (value) => {
      greater = value === "greater";
      void trouble.during(load);
    }),
    choices("order", say({ en: "Order", zh: "次序" }), [["near", say({ en: "the nearer first", zh: "先画近的" })], ["far", say({ en: "the farther first", zh: "先画远的" })]], "near", (value) => {
      reversed = value === "far";
      void trouble.during(load);
    }),
  ], trouble);
}

const functions = ["NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"];

/** Frames a pixel of the pictures, and lists the comparisons made there: words, the depth and the stored depth for each. */
function showPixel(plates: Plate[], [x, y]: [number, number], list: HTMLElement, comparisons: Answer[], tell: (one: Answer) => [string, string, string]): void {
  for (const { canvas } of plates) {
    const pen = canvas.getContext("2d")!;
    pen.strokeStyle = "#fff";
    pen.lineWidth = 1;
    pen.strokeRect(x - 3.5, y - 3.5, 8, 8);
  }
  list.replaceChildren(...comparisons.map((one) => {
    const [words, depth, before] = tell(one);
    return element("li", {}, element("span", {}, words), element("span", { class: "number" }, `${depth} : ${before} ${one.passes ? "✓" : "✗"}`));
  }));
}

function pictureFigure(): HTMLElement {
  const colors = plate(say({ en: "Which triangle", zh: "哪个三角形" })), depths = plate(say({ en: "Depth that is stored: near is dark", zh: "所存深度：近处暗" }));
  const said = element("p", { class: "said", "aria-live": "polite" }), hint = say({ en: "Point at a pixel to see every comparison that was made there.", zh: "指向一个像素，查看在那里进行的每次比较。" });
  const list = element("ol", { class: "hits" });
  let scene = "cubes", func = 1, pixel: [number, number] | undefined;
  const latest = new Latest((answer) => {
    colors.show(answer);
    depths.show(answer, "depths");
    if (answer.triangles !== most) {
      most = answer.triangles;
      stepper.limit(most);
      stepper.set(most);
    }
    mark(answer);
  });
  let most = -1;

  function mark(answer: Answer): void {
    const drawn = say({ en: `Triangles drawn: ${stepper.step}.`, zh: `已画三角形：${stepper.step}。` });
    if (!pixel) {
      said.textContent = `${drawn} ${hint}`;
      return;
    }
    said.textContent = drawn + say({ en: ` Pixel (${pixel[0]}, ${pixel[1]}), ${functions[func]}:`, zh: `像素 (${pixel[0]}, ${pixel[1]})，${functions[func]}：` });
    showPixel([colors, depths], pixel, list, answer.comparisons ?? [], (one) => [say({ en: `Triangle ${one.triangle}`, zh: `三角形 ${one.triangle}` }), one.depth.toFixed(5), one.before.toFixed(5)]);
  }
  function show(step: number): void {
    latest.ask({ ask: "lesson.zbuffer", example: "picture", scene, func, step, width: 320, height: 240, ...(pixel ? { pixel } : {}) });
  }
  const stepper = steps(24, show, 250);
  pointing([colors, depths], [160, 120], (x, y) => {
    pixel = [x, y];
    show(stepper.step);
  });
  const picker = element("select", { "aria-label": say({ en: "Depth function", zh: "深度函数" }) }, ...functions.map((name, i) => element("option", { value: i, selected: i === 1 }, name)));
  picker.addEventListener("change", () => {
    func = Number(picker.value);
    show(stepper.step);
  });
  setTimeout(() => stepper.set(24));
  return figure([colors.root, depths.root], [
    stepper.root, said, list,
    sceneChoices("zscene", [["cubes", { en: "two cubes that intersect", zh: "相交的两个立方体" }], ["cycle", { en: "three in a ring", zh: "三者成环" }], ["concave", { en: "a concave body", zh: "凹体" }]], scene, (value) => {
      scene = value;
      most = -1;
      pixel = undefined;
      list.replaceChildren();
      show(0);
    }),
    element("label", { class: "field" }, element("span", {}, say({ en: "Function", zh: "函数" })), picker),
  ], latest);
}

/** A label in the plane of a board, which fights with it, and the polygon offset of the board. */
function coplanarFigure(): HTMLElement {
  const colors = plate(say({ en: "What each pixel shows: label or board", zh: "每个像素显示标签还是木板" }));
  const map = plate(say({ en: "Label against board: blue nearer, grey equal, orange farther", zh: "标签与木板相比：蓝更近，灰相等，橙更远" }));
  const said = element("p", { class: "said", "aria-live": "polite" }), list = element("ol", { class: "hits" });
  const setting = { factor: 0, units: 0, format: 2, turn: 0, near: 0.15 };
  let pixel: [number, number] = [178, 120];

  function tell({ triangle, stored, stored_before: before }: Answer): [string, string, string] {
    const difference = Math.abs(stored - before), nearer = stored < before;
    const by = triangle < 2 ? "" : difference === 0 ? say({ en: ", equal", zh: "，相等" })
      : say({ en: `, ${difference.toLocaleString()} ${difference === 1 ? "step" : "steps"} ${nearer ? "nearer" : "farther"}`, zh: `，${nearer ? "近" : "远"} ${difference.toLocaleString()} 步` });
    const name = triangle < 2 ? say({ en: "Board", zh: "木板" }) : say({ en: "Label", zh: "标签" });
    return [name + say({ en: `, triangle ${triangle}`, zh: `，三角形 ${triangle}` }) + by, stored.toLocaleString(), before.toLocaleString()];
  }
  const latest = new Latest((answer) => {
    const [shown, all] = [answer.shown.toLocaleString(), answer.all.toLocaleString()];
    const kind = setting.format === 3 ? say({ en: "bits of the floats as integers", zh: "浮点数的位，读作整数" }) : say({ en: "stored integers", zh: "所存整数" });
    colors.show(answer);
    map.show(answer, "steps");
    map.mark(lines(answer.sides, "--panel", 0.7));
    said.replaceChildren(element("b", {}, shown), say({ en: ` of ${all} pixels of the label show the label. `, zh: ` 个像素（标签共 ${all} 个）显示标签。` }),
      say({ en: `Pixel (${pixel[0]}, ${pixel[1]}), LESS, ${kind}:`, zh: `像素 (${pixel[0]}, ${pixel[1]})，LESS，${kind}：` }));
    showPixel([colors, map], pixel, list, answer.comparisons, tell);
  });
  const update = () => latest.ask({ ask: "lesson.zbuffer", example: "coplanar", pixel, ...setting });
  pointing([colors, map], pixel, (x, y) => {
    pixel = [x, y];
    update();
  });
  update();
  const knob = sliders(setting, update);
  return figure([colors.root, map.root], [
    said, list,
    choices("offset", say({ en: "Polygon offset of the board", zh: "木板的多边形偏移" }), [["00", say({ en: "no offset", zh: "不偏移" })], ["01", say({ en: "units 1 alone", zh: "仅 units 1" })], ["10", say({ en: "factor 1 alone", zh: "仅 factor 1" })], ["11", say({ en: "factor 1, units 1", zh: "factor 1 与 units 1" })]], "00", (value) => {
      [setting.factor, setting.units] = [Number(value[0]), Number(value[1])];
      update();
    }),
    choices("bits", say({ en: "Format", zh: "格式" }), [["1", "D16"], ["2", "D24"], ["3", "F32"]], "2", (value) => {
      setting.format = Number(value);
      update();
    }),
    knob(say({ en: "near", zh: "近平面" }), "near", 0.05, 1, 0.05, (v) => v.toFixed(2)), knob(say({ en: "camera", zh: "相机" }), "turn", -40, 40, 1, (v) => `${v}°`),
  ], latest);
}

export const zbuffer: Lesson = {
  id: "z-buffer",
  title: { en: "The z-buffer", zh: "Z 缓冲" },
  lead: { en: "Keep, for every pixel, how deep the nearest surface so far is. Whatever comes next has to be nearer.", zh: "为每个像素记住目前最近的面有多深。后来者必须更近。" },
  parts: [
    {
      prose: [
        { en: "A *depth buffer* is a second picture that nobody sees: in place of colours it holds depths. Before anything is drawn it is cleared to the farthest depth there is.", zh: "*深度缓冲*是一幅谁也看不见的图：它存的不是颜色，而是深度。作画之前，先清除为最远的深度。" },
        { en: "Then triangles come, in any order. At every pixel that a triangle covers its depth is compared with the one that is stored. If it is nearer, both depth and colour are replaced; if not, nothing happens. That is the whole method (E. Catmull, 1974).", zh: "然后三角形以任意次序到来。在它覆盖的每个像素上，将其深度与所存深度比较：更近，则深度与颜色一并替换；否则什么也不做。这就是全部方法（E. Catmull，1974）。" },
      ],
      figure: tableFigure,
    },
    {
      title: { en: "The same on a picture", zh: "在画面上" },
      prose: [
        { en: "Cubes that pass through each other need no special care: at every pixel the comparison decides anew. Nor do three bars of which each lies over the next, although no order of painting them is right.", zh: "相互穿过的立方体无需特别处理：每个像素各自比较。三根互相叠压的条也一样，尽管没有任何绘制次序是对的。" },
        { en: "The comparison may be another one. With GREATER, and the buffer cleared as it is, nothing passes; with ALWAYS the last triangle wins, wherever it lies.", zh: "比较函数可以更换。用 GREATER 而清除值不变，则什么也通不过；用 ALWAYS，则最后画的三角形总是胜出。" },
      ],
      figure: pictureFigure,
    },
    {
      title: { en: "Z-fighting", zh: "深度冲突" },
      prose: [
        { en: "A label lies in the plane of a board, but the two share no triangle. Each triangle rounds its vertices to 1/256 pixel, and its depths to the format. At one pixel the two depths therefore differ by a few steps of the format, or are equal.", zh: "标签位于木板的平面上，但两者没有共同的三角形。每个三角形各自把顶点舍入到 1/256 像素，把深度舍入到存储格式。因此在同一像素上，两个深度相差几步，或者相等。" },
        { en: "Where the depths are equal, LESS keeps the board, which is drawn first. Label and board thus win in stripes, which change with every turn of the camera: *z-fighting*. A finer format has smaller steps, but does not end the fight.", zh: "深度相等处，LESS 保留先画的木板。于是标签与木板成条纹交替胜出，相机一转，条纹就变：这就是*深度冲突*（z-fighting）。更精细的格式步长更小，但冲突依旧。" },
        { en: "In OpenGL, glEnable(GL_POLYGON_OFFSET_FILL) and glPolygonOffset(factor, units) move the board back. They add factor · m + units · r to its depths. The slope m is the change of depth to the next pixel, sideways or up, whichever is greater; r is one step of the format.", zh: "在 OpenGL 中，glEnable(GL_POLYGON_OFFSET_FILL) 与 glPolygonOffset(factor, units) 把木板后移：其深度增加 factor · m + units · r。斜率 m 是到横向或纵向相邻像素的深度变化中较大者；r 是格式的一步。" },
        { en: "The factor outweighs the rounding of vertices, whose effect grows with the slope. The units outweigh the rounding of depths where the slope is less than a step: try D16 with the near plane at 0.05. With both at 1, all pixels of the label show the label, at every setting of this figure.", zh: "factor 胜过顶点的舍入，其影响随斜率增大。斜率不足一步时，units 胜过深度的舍入：试试 D16 与近平面 0.05。两者皆为 1 时，此图的任何设置下，标签的全部像素都显示标签。" },
      ],
      figure: coplanarFigure,
    },
  ],
};
