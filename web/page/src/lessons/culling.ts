// SPDX-License-Identifier: Apache-2.0
// Reasons why surfaces are hidden: back faces, the view volume, occlusion.
import type { Answer } from "../answer.ts";
import { choices, element } from "../dom.ts";
import { say } from "../language.ts";
import { Eye, figure, ink, Latest, plate, sceneChoices } from "./figure.ts";
import { dot, minus, unit, type Vector } from "../orbit.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [480, 360];

function cullingFigure(): HTMLElement {
  const picture = plate(say({ en: "Drag to turn. Arrows are normals: towards you, or away", zh: "拖动旋转。箭头为法线：朝向你，或背向你" }));
  const facts = element("dl", { class: "facts" });
  const said = element("p", { class: "said", "aria-live": "polite" });
  let scene = "cube", culling = 0;
  const eye = new Eye(picture.canvas, show);
  const latest = new Latest(draw);

  function arrows(answer: Answer): void {
    const pen = picture.canvas.getContext("2d")!;
    for (const arrow of answer.arrows) {
      pen.strokeStyle = arrow.cosine > 0 ? ink("--accent") : ink("--blue");
      pen.globalAlpha = arrow.cosine > 0 ? 1 : 0.45;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(arrow.from[0], arrow.from[1]);
      pen.lineTo(arrow.to[0], arrow.to[1]);
      pen.stroke();
      pen.beginPath();
      pen.arc(arrow.to[0], arrow.to[1], 3, 0, 7);
      pen.fillStyle = pen.strokeStyle;
      pen.fill();
    }
    pen.globalAlpha = 1;
  }
  function draw(answer: Answer): void {
    picture.show(answer);
    arrows(answer);
    const { reasons } = answer;
    const rows: [string, number][] = [
      [say({ en: "face you (N·V > 0)", zh: "朝向你（N·V > 0）" }), answer.front], [say({ en: "turn away (N·V < 0)", zh: "背向（N·V < 0）" }), answer.back],
      [say({ en: "edge on (N·V = 0)", zh: "侧对（N·V = 0）" }), answer.edge_on], [say({ en: "outside of the view", zh: "视域之外" }), reasons.outside + reasons.behind_eye],
      [say({ en: "in view, yet hidden by others", zh: "在视域内，但被遮挡" }), reasons.hidden], [say({ en: "seen", zh: "可见" }), reasons.seen]];
    facts.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value.toLocaleString())]));
    const isSame = answer.changed === 0;
    said.replaceChildren(culling === 0 ? say({ en: "Nothing is left out.", zh: "没有剔除任何面。" })
      : isSame ? say({ en: "The picture is the same, pixel for pixel: on closed bodies what turns away is always behind something that does not.", zh: "画面逐像素相同：在封闭的物体上，背向的面总在朝向的面之后。" })
      : say({ en: `${answer.changed.toLocaleString()} pixels show something else.`, zh: `${answer.changed.toLocaleString()} 个像素不同。` }));
  }
  function show(): void {
    if (eye.camera) latest.ask({ ask: "lesson.culling", scene, camera: { ...eye.camera, culling } });
  }
  async function place(): Promise<void> {
    await eye.place(scene, [-0.6, -0.45, -0.8], size);
    show();
  }
  void latest.during(place);
  return figure([picture.root, element("div", {}, facts)], [
    said,
    choices("culling", say({ en: "Leave out", zh: "剔除" }), [["0", say({ en: "nothing", zh: "不剔除" })], ["1", say({ en: "back faces", zh: "背面" })], ["2", say({ en: "front faces", zh: "正面" })]], "0", (value) => {
      culling = Number(value);
      show();
    }),
    sceneChoices("cscene", [["cube", { en: "one convex body", zh: "一个凸体" }], ["concave", { en: "a concave body", zh: "一个凹体" }], ["cubes", { en: "two cubes", zh: "两个立方体" }], ["teapot", { en: "teapot", zh: "茶壶" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    }),
  ], latest);
}

/** A wall with its normal, seen from above, and an eye that can be dragged around it. */
function facingFigure(): HTMLElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "-160 -110 320 220");
  svg.setAttribute("role", "application");
  svg.setAttribute("tabindex", "0");
  svg.setAttribute("aria-label", say({ en: "A wall from above, its normal, and the eye. Arrow keys move the eye.", zh: "墙的俯视图、法线与眼睛。方向键移动眼睛。" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  let angle = 0.5;
  const wall: Vector = [0, 0, 0], normal: Vector = [0, 0, 1];

  function draw(): void {
    const at: Vector = [95 * Math.sin(angle), 0, 95 * Math.cos(angle)];
    const cosine = dot(normal, unit(minus(at, wall)));
    const x = at[0], y = -at[2], color = cosine > 1e-9 ? "var(--accent)" : "var(--blue)";
    svg.innerHTML = `<g fill="none" stroke-width="2.5" stroke-linecap="round"><path d="M-46 0H46" stroke="var(--ink)" stroke-width="5"/>
<path d="M-40 7l8 8M-20 7l8 8M0 7l8 8M20 7l8 8" stroke="var(--soft)" stroke-width="1.2"/>
<path d="M0 0V-58m-6 10l6-10 6 10" stroke="var(--accent)"/><path d="M0 0L${x} ${y}" stroke="${color}" stroke-dasharray="5 6"/></g>
<circle cx="${x}" cy="${y}" r="12" fill="${color}"/><circle cx="${x}" cy="${y}" r="4.5" fill="var(--panel)"/>
<g fill="var(--ink)" font-family="var(--serif)" font-style="italic" font-size="17"><text x="8" y="-62">N</text><text x="${x * 0.55 + 8}" y="${y * 0.55}">V</text></g>`;
    said.replaceChildren(element("b", {}, `N·V = ${cosine.toFixed(3)}`), " ", cosine > 5e-4 ? say({ en: "The eye is before the wall: its front is seen.", zh: "眼睛在墙的前方：看见正面。" })
      : cosine < -5e-4 ? say({ en: "The eye is behind it. If the wall is part of a closed body, its inside would be seen, and never is.", zh: "眼睛在墙的后方。若墙属于封闭物体，此处是内侧，永远看不见。" })
      : say({ en: "Edge on: it covers nothing, and faces nobody.", zh: "侧对：不覆盖任何像素，也不朝向任何人。" }));
  }
  const follow = (event: PointerEvent) => {
    if (event.buttons === 0) return;
    const box = svg.getBoundingClientRect();
    angle = Math.atan2((event.clientX - box.left) / box.width - 0.5, (0.5 - (event.clientY - box.top) / box.height) * (box.height / box.width));
    draw();
  };
  svg.addEventListener("pointerdown", (event) => {
    svg.setPointerCapture(event.pointerId);
    follow(event);
  });
  svg.addEventListener("pointermove", follow);
  // A finger on the eye drags it; elsewhere it scrolls the page.
  svg.addEventListener("touchstart", (event) => {
    const box = svg.getBoundingClientRect(), scale = box.width / 320, [{ clientX, clientY }] = event.touches;
    const away = Math.hypot(clientX - box.left - (160 + 95 * Math.sin(angle)) * scale, clientY - box.top - (110 - 95 * Math.cos(angle)) * scale);
    if (away < 40) event.preventDefault();
  }, { passive: false });
  svg.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    event.preventDefault();
    angle += event.key === "ArrowRight" ? 0.1 : -0.1;
    draw();
  });
  draw();
  const plateOf = element("div", { class: "plate", style: "max-width:560px" });
  plateOf.append(svg);
  return figure([plateOf], [said]);
}

export const culling: Lesson = {
  id: "why-hidden",
  title: { en: "Why anything is hidden", zh: "为什么会看不见" },
  lead: { en: "A surface is not seen for one of three reasons: it turns away, it lies outside of the view, or something is before it.", zh: "一个面看不见，原因有三：它背过身去，它在视域之外，或前面有东西。" },
  parts: [
    {
      title: { en: "Which way it faces", zh: "朝向" },
      prose: [
        { en: "A triangle has a front: the side from which its corners run counter-clockwise. Its *normal* N points out of it. Let V be the way to the eye; then the sign of *N·V* says which side the eye is on.", zh: "三角形有正面：从这一侧看，顶点逆时针排列。*法线* N 由此指出。设 V 为指向眼睛的方向，则 *N·V* 的符号说明眼睛在哪一侧。" },
        { en: "V goes to the eye from the triangle, and is not the direction in which the camera looks: in perspective it is another one for every triangle.", zh: "V 是从三角形到眼睛的方向，而不是相机的朝向：在透视中，每个三角形的 V 都不同。" },
      ],
      figure: facingFigure,
    },
    {
      title: { en: "Where that suffices, and where not", zh: "何时足够，何时不够" },
      prose: [
        { en: "On one convex body leaving out back faces is all there is to do: of the faces that are left, none hides another. On a concave one, or as soon as there are two, some faces turn towards you and are hidden all the same. That is *occlusion*, and what the other lessons are about.", zh: "对一个凸体，剔除背面就够了：剩下的面互不遮挡。对凹体，或一旦有两个物体，有些面虽朝向你，仍被挡住。这就是*遮挡*，其余各课都讲它。" },
      ],
      figure: cullingFigure,
    },
  ],
};
