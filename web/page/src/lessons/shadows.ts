// SPDX-License-Identifier: Apache-2.0
// Shadows: a depth map from the light, its texels and its bias, beside exact rays.
import type { Answer } from "../answer.ts";
import { element, sliders } from "../dom.ts";
import { say } from "../language.ts";
import { type Camera, type Vector } from "../orbit.ts";
import { facts, figure, framed, Latest, plate, pointing, sceneChoices } from "./figure.ts";
import type { Lesson } from "./list.ts";

const size: [number, number] = [400, 300];

function shadowFigure(): HTMLElement {
  const mapped = plate(say({ en: "Shadows by the map. Point at a pixel", zh: "按阴影图。指向一个像素" })), cast = plate(say({ en: "Shadows by exact rays", zh: "按精确光线" }));
  const light = plate(say({ en: "What the light sees: near is bright", zh: "光源所见：近处亮" })), wrong = plate(say({ en: "Where the map is wrong", zh: "阴影图出错之处" }));
  light.canvas.style.imageRendering = "pixelated";
  const said = element("p", { class: "said", "aria-live": "polite" });
  const sums = facts();
  let scene = "blocks", camera: Camera | undefined, pixel: [number, number] = [170, 190];
  const setting = { texels: 6, bias: -4, around: 58, height: 48 };
  const toLight = (): Vector => {
    const around = (setting.around * Math.PI) / 180, height = (setting.height * Math.PI) / 180;
    return [Math.cos(height) * Math.sin(around), Math.sin(height), Math.cos(height) * Math.cos(around)];
  };
  const biasOf = (value: number) => (value <= -4 ? 0 : 10 ** value);
  const latest = new Latest((answer: Answer) => {
    mapped.show(answer);
    cast.show(answer, "rays");
    wrong.show(answer, "wrong");
    light.show(answer, "map", [answer.size, answer.size]);
    const ring = (x: number, y: number, r: number) => `<circle cx="${x}" cy="${y}" r="${r}" fill="none" stroke="var(--panel)" stroke-width="${r / 2}"/><circle cx="${x}" cy="${y}" r="${r}" fill="none" stroke="var(--accent)" stroke-width="${r / 3.5}"/>`;
    for (const one of [mapped, cast, wrong]) one.mark(ring(pixel[0] + 0.5, pixel[1] + 0.5, 6));
    const { point } = answer;
    light.mark(point ? ring(point.texel[0] + 0.5, point.texel[1] + 0.5, answer.size / 45) + `<rect x="${point.texel[0]}" y="${point.texel[1]}" width="1" height="1" fill="var(--accent)"/>` : "");
    const verdict = (isLit: boolean) => (isLit ? say({ en: "lit", zh: "受光" }) : say({ en: "in shadow", zh: "在阴影中" }));
    if (!point) said.textContent = say({ en: "Nothing is seen at this pixel.", zh: "此像素处什么也看不见。" });
    else if (!point.faces_light) said.textContent = say({ en: "This surface turns away from the light, and is dark without any shadow.", zh: "这个面背向光源，无需阴影就是暗的。" });
    else said.replaceChildren(say({ en: "From the light this point is ", zh: "从光源看，该点的距离为 " }), element("b", {}, point.distance.toFixed(4)), say({ en: " away. Its texel holds ", zh: "，其纹素所存为 " }), element("b", {}, point.stored === null ? "∞" : point.stored.toFixed(4)),
      say({ en: `: ${verdict(point.lit_by_map)} by the map, and ${verdict(point.lit_by_ray)} by the ray.`, zh: `：按阴影图${verdict(point.lit_by_map)}，按光线${verdict(point.lit_by_ray)}。` }));
    const share = (count: number) => `${count.toLocaleString()} · ${((100 * count) / Math.max(1, answer.facing)).toFixed(2)} %`;
    sums.set([[say({ en: "acne: lit, and dark by the map (red)", zh: "痤疮：本应受光，按图为暗（红）" }), share(answer.acne)], [say({ en: "leaks: in shadow, and lit by the map (blue)", zh: "漏光：本在阴影，按图受光（蓝）" }), share(answer.leaks)]]);
  });
  function ask(): void {
    if (camera) latest.ask({ ask: "lesson.shadows", scene, camera, light: toLight(), size: 2 ** setting.texels, bias: biasOf(setting.bias), x: pixel[0], y: pixel[1] });
  }
  pointing([mapped], pixel, (x, y) => {
    pixel = [x, y];
    ask();
  });
  async function place(): Promise<void> {
    camera = await framed(scene, [-0.6, -0.6, -0.8], size);
    ask();
  }
  void latest.during(place);
  const knob = sliders(setting, ask);
  return figure([mapped.root, cast.root, light.root, wrong.root], [said, sums.root,
    knob(say({ en: "texels", zh: "纹素" }), "texels", 4, 11, 1, (v) => `${2 ** v}²`), knob(say({ en: "bias", zh: "偏移" }), "bias", -4, 0, 0.05, (v) => biasOf(v).toPrecision(2)),
    knob(say({ en: "light, around", zh: "光源方位" }), "around", 0, 360, 2, (v) => `${v}°`), knob(say({ en: "light, height", zh: "光源高度" }), "height", 10, 88, 1, (v) => `${v}°`),
    sceneChoices("sscene", [["blocks", { en: "blocks on a floor", zh: "地面上的方块" }], ["concave", { en: "a concave body", zh: "凹体" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }], ["teapot", { en: "teapot", zh: "茶壶" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    })], latest);
}

export const shadows: Lesson = {
  id: "shadows",
  title: { en: "Shadows", zh: "阴影" },
  lead: { en: "A point is lit where the light sees it. Shadows are the visibility question once more, asked from the light.", zh: "光源看得见的点才受光。阴影就是从光源再问一次可见性。" },
  parts: [{
    prose: [
      { en: "Lance Williams (1978) draws the scene twice. First from the light, which keeps depths alone: a *shadow map*. Then from the eye: each point that is seen is taken to the map, and if it lies farther from the light than what the map holds, something is before it.", zh: "Lance Williams（1978）把场景画两次。先从光源画，只留深度：*阴影图*。再从眼睛画：把每个可见点变到阴影图中，若它到光源的距离大于图中所存，前面就有东西。" },
      { en: "A texel holds one depth for all of its width. On a slope one half of it lies behind that depth, and shadows itself in stripes, which is called *acne*. A *bias* is allowed to end it. Too much of it lets light *leak* under what stands on a floor. No value is right everywhere; more texels make both errors smaller.", zh: "一个纹素在整个宽度上只存一个深度。在斜面上，它的一半位于该深度之后，于是条纹状地遮住自己，称为*痤疮*。可以放宽一个*偏移*来消除它；放得太多，光就从立在地面上的物体下*漏*过去。没有处处都对的值；纹素越多，两种误差越小。" },
      { en: "A ray from the point to the light needs neither. The library decides it exactly: a surface does not shadow itself, however flat the light falls.", zh: "从该点向光源发一条光线，则两者都不需要。程序库对此作精确判定：无论光线多么斜，面都不会遮住自己。" },
    ],
    figure: shadowFigure,
  }],
};
