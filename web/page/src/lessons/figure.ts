// SPDX-License-Identifier: Apache-2.0
// What figures of lessons are made of: plates with pictures, steps that play, a line that says what happens, and
// questions of which the last alone is answered.
import type { Answer, Question } from "../answer.ts";
import { Client, toImage } from "../client.ts";
import { choices, element } from "../dom.ts";
import { say, type Text } from "../language.ts";
import { listen, type Camera, type Vector } from "../orbit.ts";

let shared: Client | undefined;
/** One module for all figures of a page. */
export function client(): Client {
  return (shared ??= new Client());
}

/** Asks with what is wanted last, when the one before is answered. */
export class Latest {
  private next: Question | undefined;
  private isBusy = false;
  constructor(private take: (answer: Answer) => void) {}

  ask(question: Question): void {
    this.next = question;
    if (!this.isBusy) void this.run();
  }

  private async run(): Promise<void> {
    this.isBusy = true;
    while (this.next) {
      const question = this.next;
      this.next = undefined;
      try {
        const answer = await client().ask(question);
        if (!this.next) this.take(answer);
      } catch (error) {
        console.error(error);
      }
    }
    this.isBusy = false;
  }
}

export interface Plate {
  root: HTMLElement;
  canvas: HTMLCanvasElement;
  show(answer: Answer, key?: string, size?: [number, number]): void;
  /** Shapes of SVG over the picture, in its pixels. */
  mark(...shapes: string[]): void;
}
export function plate(title: string, label = title): Plate {
  const canvas = element("canvas", { width: 320, height: 240, role: "img", "aria-label": label });
  const marks = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  marks.setAttribute("class", "marks");
  marks.setAttribute("aria-hidden", "true");
  return {
    root: element("div", { class: "plate" }, element("h3", {}, title), element("div", { class: "pane" }, canvas, marks)),
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

/** Lines [x, y, x, y] of an answer, as a shape. */
export function lines(of: number[][], color: string, width = 1.5, more = ""): string {
  const path = of.map(([x, y, toX, toY]) => `M${x.toFixed(2)} ${y.toFixed(2)}L${toX.toFixed(2)} ${toY.toFixed(2)}`).join("");
  return `<path d="${path}" fill="none" stroke="var(${color})" stroke-width="${width}" stroke-linecap="round" ${more}/>`;
}
export function dot(x: number, y: number, color: string, radius = 4): string {
  return `<circle cx="${x.toFixed(2)}" cy="${y.toFixed(2)}" r="${radius}" fill="var(${color})" stroke="var(--panel)"/>`;
}

/** A pixel that is chosen by pointing, by touch, and by the arrow keys. */
export function pointing({ canvas }: Plate, [x, y]: [number, number], take: (x: number, y: number) => void): void {
  const go = (toX: number, toY: number) => {
    [x, y] = [Math.max(0, Math.min(canvas.width - 1, toX)), Math.max(0, Math.min(canvas.height - 1, toY))];
    take(x, y);
  };
  const point = (event: PointerEvent) =>
    go(Math.floor((event.offsetX / canvas.clientWidth) * canvas.width), Math.floor((event.offsetY / canvas.clientHeight) * canvas.height));
  canvas.tabIndex = 0;
  canvas.style.cursor = "crosshair";
  canvas.addEventListener("pointermove", point);
  canvas.addEventListener("pointerdown", point);
  canvas.addEventListener("keydown", (event) => {
    const by: Record<string, [number, number]> = { ArrowLeft: [-2, 0], ArrowRight: [2, 0], ArrowUp: [0, -2], ArrowDown: [0, 2] };
    if (!by[event.key]) return;
    event.preventDefault();
    go(x + by[event.key][0], y + by[event.key][1]);
  });
}

/** Names and values, one below the other. */
export function facts(): { root: HTMLElement; set(rows: [string, string | number][]): void } {
  const root = element("dl", { class: "facts" });
  return {
    root,
    set: (rows) => root.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value.toLocaleString())])),
  };
}

export interface Steps { root: HTMLElement; set(step: number): void; limit(most: number): void; readonly step: number }
/** Play, pause, forwards, back, and a slider. `show` is called for every step. */
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

export function figure(pictures: HTMLElement[], controls: HTMLElement[]): HTMLElement {
  return element("figure", { class: "figure" }, element("div", { class: pictures.length > 3 ? "picture pairs" : "picture" }, ...pictures), element("div", { class: "controls" }, ...controls));
}

/** Scenes to choose from, and a file of one's own. */
export function sceneChoices(name: string, scenes: [string, Text][], chosen: string, change: (scene: string) => void): HTMLElement {
  const picker = element("input", { type: "file", accept: ".stl,.ply,.obj,.off,.glb,.gltf", class: "sr", tabindex: -1, "aria-label": say(own) });
  const complaint = element("p", { class: "soft", role: "alert", hidden: true });
  const restore = () => (group.querySelector<HTMLInputElement>(`input[value="${chosen}"]`)!.checked = true);
  const group = choices(name, say({ en: "Scene", zh: "场景" }), [...scenes, ["own", own] as [string, Text]].map(([id, text]) => [id, say(text)]), chosen, (value) => {
    complaint.hidden = true;
    if (value === "own") return picker.click();
    chosen = value;
    change(value);
  });
  picker.addEventListener("cancel", restore);
  picker.addEventListener("change", async () => {
    const file = picker.files?.[0];
    if (!file) return restore();
    try {
      await client().ask({ ask: "lesson.open", name: file.name }, await file.arrayBuffer());
      group.querySelector<HTMLInputElement>(`input[value="own"]`)!.checked = true;
      chosen = "own";
      change("own");
    } catch (error) {
      complaint.textContent = error instanceof Error ? error.message : String(error);
      complaint.hidden = false;
      restore();
    }
    picker.value = "";
  });
  return element("div", {}, group, picker, complaint);
}
const own: Text = { en: "your own model…", zh: "自己的模型…" };

interface Framing { angle?: number; beside?: Vector[] }
/** A camera that shows all of a scene from a direction, and points beside it. */
export async function framed(scene: string, forward: Vector, [width, height]: [number, number], more: Framing = {}): Promise<Camera> {
  return client().ask({ ask: "lesson.frame", scene, width, height, forward, ...more });
}

/** A camera that goes once around a scene when it is dragged. `moved` is called with what it is now. */
export class Eye {
  camera: Camera | undefined;
  constructor(target: HTMLElement, moved: () => void) {
    target.tabIndex = 0;
    target.style.cursor = "grab";
    listen(target, { camera: () => this.camera, worldUp: () => this.camera?.world_up ?? ([0, 1, 0] as Vector), moved });
  }

  /** Shows all of a scene, from a direction. */
  async place(scene: string, forward: Vector, size: [number, number], more: Framing = {}): Promise<void> {
    this.camera = undefined;
    this.camera = await framed(scene, forward, size, more);
  }
}

/** A colour of the page's. */
export function ink(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
