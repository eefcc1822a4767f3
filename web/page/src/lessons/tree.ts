// SPDX-License-Identifier: Apache-2.0
// A binary tree of planes, drawn, and walked from back to front.
import type { Answer } from "../answer.ts";
import { element } from "../dom.ts";
import { say } from "../language.ts";
import { Eye, facts, figure, Latest, lines, plate, sceneChoices, steps } from "./figure.ts";

const size: [number, number] = [400, 300];
/** The number of pairs grows with the square, and nodes must stay distinguishable. */
export const mostTriangles = 200;

/** Draws the tree: painted nodes are filled, the next one has a ring; children before a plane hang to the left. */
function drawn({ nodes, order }: Answer, step: number): string {
  const inOrder: number[] = [], place = new Map<number, [number, number]>();
  const walk = (number: number): void => {
    if (number < 0) return;
    walk(nodes[number].before);
    inOrder.push(number);
    walk(nodes[number].behind);
  };
  walk(0);
  const deepest = Math.max(1, ...nodes.map((node: Answer) => node.level)), isCrowded = nodes.length > 40, radius = isCrowded ? Math.max(2.5, 200 / nodes.length) : Math.min(13, 150 / nodes.length + 5);
  inOrder.forEach((number, i) => place.set(number, [20 + (i / Math.max(1, nodes.length - 1)) * (size[0] - 40), 24 + (nodes[number].level / deepest) * (size[1] - 48)]));
  const painted = new Set(order.slice(0, step)), now = order[step - 1];
  const branches = nodes.flatMap((node: Answer, number: number) => (node.parent < 0 ? [] : [[...place.get(node.parent)!, ...place.get(number)!]]));
  return lines(branches, "--soft", 1) + nodes.map((node: Answer, number: number) => {
    const [x, y] = place.get(number)!, isPainted = painted.has(number);
    return `<circle cx="${x}" cy="${y}" r="${isCrowded && number === now ? 6 : radius}" fill="var(${isPainted ? "--accent" : "--panel"})" stroke="var(${number === now ? "--ink" : "--soft"})" stroke-width="${number === now ? 3 : isCrowded ? 0.5 : 1}"/>`
      + (isCrowded ? "" : `<text x="${x}" y="${y + radius / 3}" text-anchor="middle" font-size="${radius * 0.85}" font-family="var(--mono)" fill="var(${isPainted ? "--accent-ink" : "--soft"})">${node.triangles[0]}</text>`);
  }).join("");
}

export function treeFigure(): HTMLElement {
  const painted = plate(say({ en: "Painted so far. Drag to turn", zh: "已画部分。拖动旋转" })), tree = plate(say({ en: "The tree: what lies before a plane hangs to the left", zh: "树：平面之前的挂在左边" }));
  const said = element("p", { class: "said", "aria-live": "polite" });
  const sums = facts();
  [tree.canvas.width, tree.canvas.height] = size;
  let scene = "cubes", most = -1;
  const eye = new Eye(painted.canvas, () => show(stepper.step));
  const latest = new Latest((answer: Answer) => {
    if (answer.order.length !== most) {
      most = answer.order.length;
      stepper.limit(most);
      stepper.set(Math.ceil(most * 0.6));
      return;
    }
    const { step } = stepper, node = answer.nodes[answer.order[step - 1]];
    painted.show(answer);
    tree.mark(drawn(answer, step));
    said.textContent = !node ? say({ en: "The walk begins with what the eye is farthest from, plane by plane.", zh: "从每个平面背离眼睛的一侧开始。" })
      : say({ en: `The eye is ${node.eye_is_before ? "before" : "behind"} this plane: all that is ${node.eye_is_before ? "behind" : "before"} it has been painted. Now come its own triangles: ${node.triangles.join(", ")}.`, zh: `眼睛在此平面${node.eye_is_before ? "之前" : "之后"}：它${node.eye_is_before ? "之后" : "之前"}的一切都已画完。现在画它自己的三角形：${node.triangles.join("、")}。` });
    sums.set([[say({ en: "triangles", zh: "三角形" }), answer.triangles], [say({ en: "pieces after all cuts", zh: "切割后的块数" }), answer.polygons], [say({ en: "planes", zh: "平面" }), answer.nodes.length], [say({ en: "wrong pixels when all are painted", zh: "全部画完后错误的像素" }), answer.wrong_count]]);
  });
  function show(step: number): void {
    if (eye.camera) latest.ask({ ask: "lesson.bsp", scene, most: mostTriangles, camera: eye.camera, step });
  }
  const stepper = steps(1, show, 500);
  async function place(): Promise<void> {
    most = -1;
    await eye.place(scene, scene === "cycle" ? [-0.05, -0.1, -1] : [-0.6, -0.45, -0.8], size, { most: mostTriangles });
    show(1);
  }
  void latest.during(place);
  return figure([painted.root, tree.root], [stepper.root, said, sums.root,
    sceneChoices("bscene", [["cycle", { en: "three in a ring", zh: "三者成环" }], ["cubes", { en: "two cubes that intersect", zh: "相交的立方体" }], ["concave", { en: "a concave body", zh: "凹体" }], ["blocks", { en: "blocks on a floor", zh: "地面上的方块" }]], scene, (value) => {
      scene = value;
      void latest.during(place);
    }, mostTriangles)], latest);
}
