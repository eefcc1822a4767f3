// SPDX-License-Identifier: Apache-2.0
// Files of the view to download, and the command that reproduces it.
import type { Client } from "./client.ts";
import { element } from "./dom.ts";
import { say } from "./language.ts";
import { plus, type Camera, type Vector } from "./orbit.ts";
import { png } from "./png.ts";
import { words } from "./words.ts";

/** The `frontmost render` command that gives the same picture, to the bit. Numbers have all of their digits. */
export function commandLine(model: string, camera: Camera, origin: Vector): string {
  const list = (v: Vector) => v.map((n) => String(n)).join(",");
  const quoted = /^[\w.:/-]+$/.test(model) ? model : `'${model.replaceAll("'", `'\\''`)}'`;
  const flags = [`--resolution ${camera.width},${camera.height}`, `--camera-position ${list(plus(camera.eye, origin))}`, `--camera-focal-point ${list(plus(camera.target, origin))}`,
    `--camera-view-up ${list(camera.up)}`, `--camera-view-angle ${camera.angle}`];
  if (camera.orthographic) flags.push("--camera-orthographic");
  flags.push(`--near ${camera.near}`, `--far ${camera.far}`, "--background transparent --hash -o picture.png");
  return `frontmost render ${quoted} ${flags.join(" ")}`;
}

export function hand(blob: Blob, name: string): void {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export interface Bench {
  client: Client;
  working: <T>(work: () => Promise<T>) => Promise<T | undefined>;
  settle: () => Promise<void>;
  name: () => string;
  image: () => ImageData | undefined;
  hidden: () => boolean;
}

export function downloads(bench: Bench): HTMLElement {
  const file = (label: string, name: string, make: () => Promise<Blob | undefined>) => {
    const run = () => bench.working(async () => {
      await bench.settle();
      const blob = await make();
      if (blob) hand(blob, name.replace("*", bench.name()));
    });
    return element("button", { class: "button", "data-file": name.replace("*", ""), onclick: () => void run() }, label);
  };
  const written = (what: string, format: string, type: string) => async () => {
    const answer = await bench.client.ask({ ask: "write", what, format, hidden: bench.hidden() });
    return new Blob([answer.file], { type });
  };
  const json = async (ask: string) => new Blob([JSON.stringify(await bench.client.ask({ ask }), null, 2)], { type: "application/json" });
  const row = (title: string, ...buttons: HTMLElement[]) => element("div", {}, element("p", { class: "soft" }, title), element("div", { class: "row" }, ...buttons));
  return element("div", { class: "files", style: "display:grid;gap:12px" },
    row(say(words.picture), file("PNG", "*.png", async () => {
      const image = bench.image();
      return image && png(image);
    })),
    row(say(words.drawing), file("SVG", "*-lines.svg", written("lines", "svg", "image/svg+xml")), file("PDF", "*-lines.pdf", written("lines", "pdf", "application/pdf")), file("DXF", "*-lines.dxf", written("lines", "dxf", "image/vnd.dxf"))),
    row(say(words.figure), file("SVG", "*-figure.svg", written("figure", "svg", "image/svg+xml")), file("PDF", "*-figure.pdf", written("figure", "pdf", "application/pdf"))),
    row(say(words.maps), ...["depth", "objects", "primitives", "materials", "normals"].map((map) => file(`${map}.npy`, `*-${map}.npy`, written(map, "npy", "application/octet-stream"))), file("depth.pfm", "*-depth.pfm", written("depth", "pfm", "application/octet-stream")),
      ...["depth", "objects", "primitives", "materials", "normals"].map((map) => file(`${map}.exr`, `*-${map}.exr`, written(map, "exr", "image/x-exr")))),
    row(say(words.facts), file(say(words.reportFile), "*-report.json", () => json("report")), file(say(words.cameraFile), "*-camera.json", () => json("conventions"))));
}
