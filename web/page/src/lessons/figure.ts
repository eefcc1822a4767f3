// SPDX-License-Identifier: Apache-2.0
// What figures of lessons are made of: plates with pictures, steps that play, a line that says what happens, and
// questions of which the last alone is answered.
import type { Answer, Question } from "../answer.ts";
import { Client, toImage } from "../client.ts";
import { element } from "../dom.ts";
import { say } from "../language.ts";
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

export interface Plate { root: HTMLElement; canvas: HTMLCanvasElement; show(answer: Answer, key?: string): void }
export function plate(title: string, label = title): Plate {
  const canvas = element("canvas", { width: 320, height: 240, role: "img", "aria-label": label });
  return {
    root: element("div", { class: "plate" }, element("h3", {}, title), canvas),
    canvas,
    show(answer, key = "pixels") {
      canvas.width = answer.width;
      canvas.height = answer.height;
      canvas.getContext("2d")!.putImageData(toImage(answer, key), 0, 0);
    },
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
  return element("figure", { class: "figure" }, element("div", { class: "picture" }, ...pictures), element("div", { class: "controls" }, ...controls));
}

/** A camera that goes once around a scene when it is dragged. `moved` is called with what it is now. */
export class Eye {
  camera: Camera | undefined;
  constructor(target: HTMLElement, moved: () => void) {
    target.tabIndex = 0;
    target.style.cursor = "grab";
    listen(target, { camera: () => this.camera, worldUp: () => [0, 1, 0] as Vector, moved });
  }

  /** Shows all of a scene, from a direction. */
  async place(scene: string, forward: Vector, [width, height]: [number, number]): Promise<void> {
    this.camera = undefined;
    this.camera = await client().ask({ ask: "lesson.frame", scene, width, height, forward });
  }
}

/** A colour of the page's. */
export function ink(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
