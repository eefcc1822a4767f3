// SPDX-License-Identifier: Apache-2.0
// Building blocks of the lessons' figures: plates with pictures, steps that play, a status line, and questions of which
// only the last is answered.
import type { Answer, Question } from "../answer.ts";
import { Client, toImage } from "../client.ts";
import { choices, element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { listen, type Camera, type Vector } from "../orbit.ts";

let shared: Client | undefined;
/** The module, shared by all figures of a page. */
export function client(): Client {
  return (shared ??= new Client());
}

/** Resolves when the module's files have arrived, if a figure has asked for them. */
export const moduleLoaded = (): Promise<void> => shared?.loaded ?? Promise.resolve();

/** Shows in a figure why there is no answer. */
export class Trouble {
  readonly root = element("p", { class: "trouble", role: "alert", hidden: true });

  async during(work: () => Promise<void>): Promise<void> {
    try {
      await work();
      this.root.hidden = true;
    } catch (error) {
      this.root.textContent = `${say({ en: "There is no answer", zh: "没有得到答案" })}: ${error instanceof Error ? error.message : error}`;
      this.root.hidden = false;
    }
  }
}

/** Sends the latest request once the previous one is answered. */
export class Latest extends Trouble {
  private next: Question | undefined;
  private isBusy = false;
  constructor(private take: (answer: Answer) => void) {
    super();
  }

  ask(question: Question): void {
    this.next = question;
    if (!this.isBusy) void this.run();
  }

  private async run(): Promise<void> {
    this.isBusy = true;
    while (this.next) {
      const question = this.next;
      this.next = undefined;
      await this.during(async () => {
        const answer = await client().ask(question);
        if (!this.next) this.take(answer);
      });
    }
    this.isBusy = false;
  }
}

export interface Plate {
  root: HTMLElement;
  canvas: HTMLCanvasElement;
  show(answer: Answer, key?: string, size?: [number, number]): void;
  /** Draws SVG shapes over the picture, in its pixel coordinates. */
  mark(...shapes: string[]): void;
}
export function plate(title: string, label = title): Plate {
  const canvas = element("canvas", { width: 320, height: 240, role: "img", "aria-label": label });
  const marks = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  marks.setAttribute("class", "marks");
  marks.setAttribute("aria-hidden", "true");
  return {
    root: element("div", { class: "plate" }, element("p", { class: "caption" }, title), element("div", { class: "pane" }, canvas, marks)),
    canvas,
    show(answer, key = "pixels", [width, height] = [answer.width, answer.height]) {
      canvas.width = width;
      canvas.height = height;
      canvas.getContext("2d")!.putImageData(toImage({ ...answer, width, height }, key), 0, 0);
    },
    mark(...shapes) {
      marks.setAttribute("viewBox", `0 0 ${canvas.width} ${canvas.height}`);
      marks.innerHTML = shapes.join("");
    },
  };
}

/** An SVG shape of an answer's lines [x, y, x, y]. */
export function lines(of: number[][], color: string, width = 1.5, more = ""): string {
  const path = of.map(([x, y, toX, toY]) => `M${x.toFixed(2)} ${y.toFixed(2)}L${toX.toFixed(2)} ${toY.toFixed(2)}`).join("");
  return `<path d="${path}" fill="none" stroke="var(${color})" stroke-width="${width}" stroke-linecap="round" ${more}/>`;
}
export function dot(x: number, y: number, color: string, radius = 4): string {
  return `<circle cx="${x.toFixed(2)}" cy="${y.toFixed(2)}" r="${radius}" fill="var(${color})" stroke="var(--panel)"/>`;
}

/** Adds a canvas's keys to its label, for screen readers. */
function named(canvas: HTMLCanvasElement, keys: Text): void {
  canvas.setAttribute("aria-label", `${canvas.getAttribute("aria-label")}. ${say(keys)}`);
}

/** The picture's pixel at a position of the element. */
export function pixelAt(canvas: HTMLCanvasElement, { offsetX, offsetY }: { offsetX: number; offsetY: number }): [number, number] {
  const within = (at: number, length: number, count: number) => Math.max(0, Math.min(count - 1, Math.floor((at / length) * count)));
  return [within(offsetX, canvas.clientWidth, canvas.width), within(offsetY, canvas.clientHeight, canvas.height)];
}

/** Lets users choose a pixel in pictures of one size, by pointing, by touch, and by the arrow keys. */
export function pointing(plates: Plate[], [x, y]: [number, number], take: (x: number, y: number) => void): void {
  for (const { canvas } of plates) {
    const go = (toX: number, toY: number) => {
      [x, y] = [Math.max(0, Math.min(canvas.width - 1, toX)), Math.max(0, Math.min(canvas.height - 1, toY))];
      take(x, y);
    };
    const point = (event: PointerEvent) => go(...pixelAt(canvas, event));
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.style.cursor = "crosshair";
    named(canvas, { en: "Arrow keys choose the pixel.", zh: "用方向键选择像素。" });
    canvas.addEventListener("pointermove", point);
    canvas.addEventListener("pointerdown", point);
    canvas.addEventListener("keydown", (event) => {
      const by: Record<string, [number, number]> = { ArrowLeft: [-2, 0], ArrowRight: [2, 0], ArrowUp: [0, -2], ArrowDown: [0, 2] };
      if (!by[event.key]) return;
      event.preventDefault();
      go(x + by[event.key][0], y + by[event.key][1]);
    });
  }
}

/** A list of names and values, one pair a line. */
export function facts(): { root: HTMLElement; set(rows: [string, string | number][]): void } {
  const root = element("dl", { class: "facts" });
  return {
    root,
    set: (rows) => root.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value.toLocaleString())])),
  };
}

export interface Steps { root: HTMLElement; set(step: number): void; limit(most: number): void; readonly step: number }
/** Buttons for play, pause, forward and back, and a slider. `show` is called for every step. */
export function steps(most: number, show: (step: number) => void, pause = 350): Steps {
  let step = 0, timer = 0;
  const words = {
    play: say({ en: "Play", zh: "播放" }), pause: say({ en: "Pause", zh: "暂停" }), back: say({ en: "Back", zh: "后退" }),
    on: say({ en: "Forwards", zh: "前进" }), step: say({ en: "Step", zh: "步" }), begin: say({ en: "To the beginning", zh: "回到开头" }),
  };
  const slider = element("input", { type: "range", min: 0, max: most, value: 0, "aria-label": words.step });
  const count = element("output", { class: "number" });
  const play = element("button", { class: "button main", "data-play": true, "aria-label": words.play }, "▶");
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = "▶";
    play.setAttribute("aria-label", words.play);
  };
  const go = (to: number) => {
    step = Math.max(0, Math.min(most, to));
    slider.value = String(step);
    count.textContent = `${step} / ${most}`;
    if (step === most) stop();
    show(step);
  };
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (step === most) go(0);
    play.textContent = "❚❚";
    play.setAttribute("aria-label", words.pause);
    timer = window.setInterval(() => go(step + 1), pause);
  });
  slider.addEventListener("input", () => {
    stop();
    go(Number(slider.value));
  });
  const button = (text: string, label: string, to: () => number, mark: string) =>
    element("button", { class: "button", "aria-label": label, [`data-${mark}`]: true, onclick: () => {
      stop();
      go(to());
    } }, text);
  const root = element("div", { class: "steps" }, button("|◀", words.begin, () => 0, "begin"), button("◀", words.back, () => step - 1, "back"), play,
    button("▶|", words.on, () => step + 1, "on"), slider, count);
  return {
    root,
    set: go,
    limit(now) {
      most = now;
      slider.max = String(now);
      stop();
      go(Math.min(step, most));
    },
    get step() {
      return step;
    },
  };
}

export function figure(pictures: HTMLElement[], controls: HTMLElement[], trouble?: Trouble): HTMLElement {
  return element("figure", { class: "figure" }, element("div", { class: pictures.length > 3 ? "picture pairs" : "picture" }, ...pictures), element("div", { class: "controls" }, trouble?.root, ...controls));
}

/** Most triangles for a figure that computes everything again at every step. */
export const manyTriangles = 10000;

/** The user's model, opened last by any figure of the page: the module holds only one. */
let own: { name: string; triangles: number } | undefined;

/** A choice of scenes, and of a user's file, where the figure shows at most `most` triangles. */
export function sceneChoices(name: string, scenes: [string, Text][], chosen: string, change: (scene: string) => void, most = Infinity): HTMLElement {
  const picker = element("input", { type: "file", accept: ".stl,.ply,.obj,.off,.glb,.gltf", class: "sr" });
  const note = element("p", { class: "soft", role: "status" }), trouble = new Trouble();
  const group = choices(name, say({ en: "Scene", zh: "场景" }), [...scenes.map(([id, text]): [string, string] => [id, say(text)]), ["own", ""]], chosen, choose);
  const ownInput = group.querySelector<HTMLInputElement>('input[value="own"]')!, ownLabel = ownInput.parentElement!;
  function choose(scene: string): void {
    chosen = scene;
    const count = own?.triangles.toLocaleString();
    note.textContent = scene !== "own" ? "" : own!.triangles <= most ? say({ en: `${count} triangles.`, zh: `${count} 个三角形。` })
      : say({ en: `Of its ${count} triangles this figure shows the ${most.toLocaleString()} that lie foremost, numbered anew.`, zh: `它有 ${count} 个三角形；此图只显示最靠前的 ${most.toLocaleString()} 个，并重新编号。` });
    change(scene);
  }
  function showOwn(): void {
    ownLabel.hidden = !own;
    ownLabel.querySelector("span")!.textContent = own?.name ?? "";
    if (own && chosen === "own") choose("own");
  }
  picker.addEventListener("change", () => void trouble.during(async () => {
    const file = picker.files?.[0];
    if (!file) return;
    try {
      const { triangles } = await client().ask({ ask: "lesson.open", name: file.name }, await file.arrayBuffer());
      own = { name: file.name, triangles };
    } finally {
      picker.value = "";
    }
    ownInput.checked = true;
    chosen = "own";
    dispatchEvent(new Event("ownmodel"));
  }));
  addEventListener("ownmodel", showOwn);
  showOwn();
  return element("div", { class: "scenes" }, group, element("label", { class: "button" }, say({ en: "Your own model…", zh: "自己的模型…" }), picker), trouble.root, note);
}

interface Framing { angle?: number; beside?: Vector[]; most?: number }
/** A camera that shows the whole scene from a direction, and the points beside it. */
export async function framed(scene: string, forward: Vector, [width, height]: [number, number], more: Framing = {}): Promise<Camera> {
  return client().ask({ ask: "lesson.frame", scene, width, height, forward, ...more });
}

/** A camera that dragging moves around a scene. `moved` is called after each change. */
export class Eye {
  camera: Camera | undefined;
  constructor(target: HTMLCanvasElement, moved: () => void, pointed?: (x: number, y: number) => void) {
    target.tabIndex = 0;
    target.style.cursor = "grab";
    named(target, { en: "Arrow keys turn it, with Shift they move it, plus and minus come nearer.", zh: "方向键旋转，按住 Shift 平移，加减键缩放。" });
    listen(target, { camera: () => this.camera, worldUp: () => this.camera?.world_up ?? ([0, 1, 0] as Vector), moved, pointed, isInPage: true });
  }

  /** Moves the camera so that it shows the whole scene from a direction. */
  async place(scene: string, forward: Vector, size: [number, number], more: Framing = {}): Promise<void> {
    this.camera = undefined;
    this.camera = await framed(scene, forward, size, more);
  }
}

/** A colour of the page's style sheet. */
export function ink(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
