// SPDX-License-Identifier: Apache-2.0
// The workbench: a model, its picture, and questions about it.
//
//   turning      a quick picture for every move: one sample, as fine as this machine can draw in time
//   at rest      the same view with four samples a pixel, its hash, and edges if requested
import type { Answer, Question } from "./answer.ts";
import { Client, toImage } from "./client.ts";
import { accepted, chosen, dropped, openFiles, type NamedFile } from "./files.ts";
import { bar, choices, element, keepForLater, slider } from "./dom.ts";
import { say } from "./language.ts";
import { listen, type Camera, type Vector } from "./orbit.ts";
import { commandLine, downloads } from "./takeaway.ts";
import { besideWebGL } from "./beside.ts";
import { accountTable, hidingTable, hitList, neverSeenTable } from "./answers.ts";
import { scenes, views, words } from "./words.ts";

/** Quality of pictures while the view turns, quickest first. The first steps grow up to the largest size that can be
 * drawn thirty times a second, with pixels sharing colours. If sixty pictures a second are possible, the next steps add
 * shadows, then a colour for every pixel. */
interface Quality {
  scale: number;
  coarse: boolean;
  shadows: boolean;
  milliseconds: number; // allowed time
  more: number; // approximate cost relative to the previous step
}
const qualities: Quality[] = [0.35, 0.39, 0.42, 0.47, 0.51, 0.56, 0.62, 0.68, 0.75, 0.83, 0.91, 1].map((scale) => ({ scale, coarse: true, shadows: false, milliseconds: 30, more: 1.21 }));
qualities.push({ scale: 1, coarse: true, shadows: true, milliseconds: 14, more: 1.3 }, { scale: 1, coarse: false, shadows: true, milliseconds: 14, more: 2 });

const client = new Client();
let model: Answer;
let modelArgument = "";
let camera: Camera | undefined;
let show = "picture", layer = 1, withHidden = false;
let quality = 4; // of pictures while turning; the first picture shows how fast this machine is
let requests = 0; // number of pictures requested so far
let isDrawing = false, wanted: "none" | "quick" | "fine" = "none";
let restTimer = 0;
let lastImage: ImageData | undefined;
let fineAnswer: Answer;

const canvas = element("canvas", { tabindex: 0, role: "img", "aria-label": say(words.stage) });
const overlay = element("canvas", { class: "overlay", "aria-hidden": "true" });
const state = element("div", { class: "state", role: "status" });
const busy = element("div", { class: "busy", hidden: true });
const message = element("div", { class: "message", role: "alert", hidden: true });
const stage = element("div", { class: "stage" }, canvas, overlay, state, busy, message);
const modelFacts = element("dl", { class: "facts" });
const hits = element("div", {}, element("p", { class: "soft" }, say(words.pointHint)));
const account = element("div");
const command = element("pre", { class: "command", tabindex: 0 });
const layerSlider = slider(say(words.layer), { min: 1, max: 8, step: 1, value: 1 }, String, (value) => {
  layer = value;
  request("fine");
});

function complain(error: unknown): void {
  const text = error instanceof Error ? error.message : String(error);
  if (text === "stopped") return;
  message.replaceChildren(text + " ", element("button", { class: "button", onclick: () => (message.hidden = true) }, say(words.close)));
  message.hidden = false;
}

/** Shows that work is in progress, and its error, if any. */
async function working<T>(work: () => Promise<T>): Promise<T | undefined> {
  busy.hidden = false;
  try {
    return await work();
  } catch (error) {
    complain(error);
    return undefined;
  } finally {
    busy.hidden = true;
  }
}

function pictureSize(): [number, number] {
  const dense = Math.min(devicePixelRatio || 1, 2);
  const width = Math.max(16, Math.round(stage.clientWidth * dense)), height = Math.max(16, Math.round(stage.clientHeight * dense));
  const shrink = Math.min(1, Math.sqrt((1920 * 1200) / (width * height)));
  return [Math.round(width * shrink), Math.round(height * shrink)];
}

function paint(image: ImageData): void {
  if (canvas.width !== image.width) canvas.width = image.width;
  if (canvas.height !== image.height) canvas.height = image.height;
  canvas.getContext("2d")!.putImageData(image, 0, 0);
}

function paintEdges(answer: Answer, width: number, height: number): void {
  overlay.width = width;
  overlay.height = height;
  const pen = overlay.getContext("2d")!;
  const parts = new Float32Array(answer.segments);
  pen.lineCap = "round";
  for (const hidden of withHidden ? [1, 0] : [0]) {
    pen.beginPath();
    pen.strokeStyle = getComputedStyle(document.body).color;
    pen.globalAlpha = hidden ? 0.35 : 1;
    // Where thousands of lines come together, thinner ones can still be told apart.
    pen.lineWidth = (hidden ? 1 : 1.6) * Math.min(1, Math.max(0.35, Math.sqrt(20000 / parts.length)));
    pen.setLineDash(hidden ? [5, 4] : []);
    for (let i = 0; i < parts.length; i += 5) {
      if (parts[i + 4] !== hidden) continue;
      pen.moveTo(parts[i], parts[i + 1]);
      pen.lineTo(parts[i + 2], parts[i + 3]);
    }
    pen.stroke();
  }
}

function drawQuestion(kind: "quick" | "fine"): Question {
  const [width, height] = pictureSize();
  const quick = qualities[quality], shrink = kind === "quick" ? quick.scale : 1;
  const one: Camera = { ...camera!, width: Math.max(8, Math.round(width * shrink)), height: Math.max(8, Math.round(height * shrink)) };
  delete one.near;
  delete one.far;
  // While the view turns, the depth map stands in for edges.
  const what = show === "edges" ? "depth" : show;
  if (kind === "fine" && what === "picture") one.samples = 4;
  return { ask: "draw", camera: one, show: what, layer, hash: kind === "fine", shadows: kind === "fine" || quick.shadows, coarse: kind === "quick" && quick.coarse };
}

function tell(answer: Answer, kind: "quick" | "fine"): void {
  const { see, shade } = answer.milliseconds;
  const part = (text: string) => element("span", {}, text);
  state.replaceChildren(part(`${answer.width} × ${answer.height}`), part(`${say(words.see)} ${see.toFixed(1)} ms`), part(`${say(words.shade)} ${shade.toFixed(1)} ms`),
    ...(kind === "fine" ? [part(`${say(words.hash)} ${answer.hash}`)] : []));
}

/** Raises quality by one step if the next picture would still be in time. Lowers it by as many steps as this picture
 * was late, but by at most three, as lateness may be accidental. */
function adaptQuality(passed: number): void {
  const next = qualities[quality + 1];
  if (next && passed * next.more < next.milliseconds) ++quality;
  for (let i = 0; i < 3 && quality > 0 && passed > qualities[quality].milliseconds * 1.2; ++i) passed /= qualities[quality--].more;
}

async function drawOnce(kind: "quick" | "fine"): Promise<void> {
  const question = drawQuestion(kind), begin = performance.now();
  const answer = await client.ask(question);
  if (wanted === "quick" && kind === "fine") return; // the view turns again
  lastImage = toImage(answer);
  paint(lastImage);
  tell(answer, kind);
  if (kind === "quick") {
    adaptQuality(performance.now() - begin);
    return;
  }
  fineAnswer = answer;
  const drawn = question.camera as Camera;
  drawn.near = answer.near;
  drawn.far = answer.far;
  command.textContent = commandLine(modelArgument, drawn, model.origin);
  if (show === "edges") {
    const found = await client.ask({ ask: "edges" });
    if (wanted === "none") {
      canvas.getContext("2d")!.clearRect(0, 0, canvas.width, canvas.height);
      paintEdges(found, answer.width, answer.height);
    }
  }
}

/** Draws one picture at a time; of the requests meanwhile, only the last is kept. */
function request(kind: "quick" | "fine"): void {
  if (!camera) return;
  closeBeside();
  ++requests;
  wanted = kind;
  if (kind === "quick" || show !== "edges") overlay.width = overlay.width;
  clearTimeout(restTimer);
  if (kind === "quick") restTimer = window.setTimeout(() => request("fine"), 220);
  if (!isDrawing) void drawWanted();
}

async function drawWanted(): Promise<void> {
  isDrawing = true;
  while (wanted !== "none" && camera) {
    const kind = wanted;
    wanted = "none";
    busy.hidden = kind === "quick" && lastImage !== undefined;
    const shown = new Promise(requestAnimationFrame);
    try {
      await drawOnce(kind);
    } catch (error) {
      complain(error);
    }
    // Makes at most one picture for each frame of the browser, which shows one while the next is drawn.
    await shown;
  }
  busy.hidden = true;
  isDrawing = false;
}

/** Waits for a view at rest, with its hash, which questions about the view need. */
async function settle(): Promise<void> {
  clearTimeout(restTimer);
  request("fine");
  while (isDrawing || wanted !== "none") await new Promise((resolve) => setTimeout(resolve, 10));
}

async function frame(view: string): Promise<void> {
  const [width, height] = pictureSize();
  const orthographic = camera?.orthographic ?? false;
  camera = await client.ask({ ask: "frame", width, height, view, orthographic });
  request("quick");
}

function showModel(opened: Answer): void {
  model = opened;
  message.hidden = true;
  hits.replaceChildren(element("p", { class: "soft" }, say(words.pointHint)));
  account.replaceChildren();
  const rows: [string, string][] = [[say(words.model), model.name], [say(words.triangles), model.triangles.toLocaleString()], [say(words.objects), model.object_count.toLocaleString()]];
  modelFacts.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
  if (model.warnings.length > 0) modelFacts.append(element("dt", {}, "⚠"), element("dd", {}, model.warnings.slice(0, 3).join("; ")));
}

async function openBuiltin(name: string): Promise<void> {
  await working(async () => {
    showModel(await client.ask({ ask: "builtin", name }));
    modelArgument = `builtin:${name}`;
    await frame("three-quarter");
  });
}

let opening: Promise<unknown> = Promise.resolve();
/** Opens models one after another, so that the files of one are not mistaken for those of another. */
function openAll(files: NamedFile[] | Promise<NamedFile[]>): Promise<unknown> {
  return (opening = opening.then(() => openThese(files)));
}
async function openThese(files: NamedFile[] | Promise<NamedFile[]>): Promise<void> {
  await working(async () => {
    const all = await files;
    if (all.length === 0) return;
    const { name, opened } = await openFiles(client, all);
    showModel(opened);
    modelArgument = name;
    scenePicker.value = "";
    await frame("three-quarter");
  });
}

async function askPoint(x: number, y: number): Promise<void> {
  if (!camera || !lastImage) return;
  await settle();
  const across = Math.floor((x / stage.clientWidth) * fineAnswer.width), down = Math.floor((y / stage.clientHeight) * fineAnswer.height);
  const answer = await working(() => client.ask({ ask: "point", x: across, y: down }));
  if (answer) hits.replaceChildren(hitList(answer, across, down));
}

async function askReport(): Promise<void> {
  const answer = await working(async () => {
    await settle();
    return client.ask({ ask: "report" });
  });
  if (!answer) return;
  const hiding = hidingTable(answer);
  account.replaceChildren(accountTable(answer), ...(hiding ? [element("h3", {}, say(words.whoHides)), hiding] : []));
}

let beside: HTMLElement | undefined;
function closeBeside(): void {
  beside?.remove();
  beside = undefined;
}
/** Shows WebGL's comparison over the stage, until it is closed or the view changes. */
async function askWebGL(): Promise<void> {
  await working(async () => {
    await settle();
    const asked = requests;
    try {
      const made = await besideWebGL({ client, image: lastImage!, eye: camera!.eye }, () => {
        closeBeside();
        canvas.focus();
      });
      if (requests !== asked) return; // the view turns again
      closeBeside();
      beside = made;
      stage.append(made);
      made.focus();
    } catch (error) {
      if (requests === asked) throw error;
    }
  });
}

async function askSphere(): Promise<void> {
  const answer = await working(() => client.ask({ ask: "sphere", views: 50 }));
  if (!answer) return;
  const never = answer.triangles - answer.ever_seen;
  account.replaceChildren(element("p", {}, element("b", { class: "number" }, `${((100 * never) / Math.max(1, answer.triangles)).toFixed(1)} %`),
    ` ${say(words.sphereDone)} `, element("b", { class: "number" }, never.toLocaleString())), neverSeenTable(answer));
}

const scenePicker = element("select", { "aria-label": say(words.builtin) }, element("option", { value: "", disabled: true }, say(words.builtin)),
  ...scenes.map(([name, text]) => element("option", { value: name }, say(text))));
scenePicker.addEventListener("change", () => void openBuiltin(scenePicker.value));
const filePicker = element("input", { type: "file", accept: accepted, multiple: true, class: "sr", tabindex: -1 });
filePicker.addEventListener("change", () => filePicker.files && void openAll(chosen(filePicker.files)));

const shows: [string, string][] = [["picture", say(words.picture)], ["depth", say(words.depth)], ["primitives", say(words.primitivesView)], ["objects", say(words.objectsView)],
  ["materials", say(words.materialsView)], ["normals", say(words.normals)], ["layer", say(words.layer)], ["edges", say(words.edges)]];
const hiddenBox = element("input", { type: "checkbox" });
hiddenBox.addEventListener("change", () => {
  withHidden = hiddenBox.checked;
  request("fine");
});
const hiddenField = element("label", { class: "row", hidden: true }, hiddenBox, say(words.hidden));
layerSlider.field.hidden = true;
const parallelBox = element("input", { type: "checkbox" });
parallelBox.addEventListener("change", () => {
  if (!camera) return;
  camera.orthographic = parallelBox.checked;
  request("fine");
});

function choose(value: string): void {
  show = value;
  layerSlider.field.hidden = value !== "layer";
  hiddenField.hidden = value !== "edges";
  request("fine");
}

const copyButton = element("button", { class: "button" }, say(words.copy));
copyButton.addEventListener("click", async () => {
  // Only secure pages may write to the clipboard; elsewhere the command is selected, to be copied by hand.
  if (!navigator.clipboard) return getSelection()?.selectAllChildren(command);
  await navigator.clipboard.writeText(command.textContent ?? "");
  copyButton.textContent = say(words.copied);
  setTimeout(() => (copyButton.textContent = say(words.copy)), 1500);
});

const side = element("aside", { class: "side" },
  element("section", {},
    element("div", { class: "row" }, element("button", { class: "button main", onclick: () => filePicker.click() }, say(words.open)), filePicker, scenePicker),
    element("p", { class: "soft" }, say(words.drop)), modelFacts),
  element("section", {}, element("h2", {}, say(words.show)), choices("show", say(words.show), shows, show, choose), layerSlider.field, hiddenField),
  element("section", {}, element("h2", {}, say(words.view)),
    element("div", { class: "row" }, ...views.map(([name, text]) => element("button", { class: "button", onclick: () => void working(() => frame(name)) }, say(text)))),
    element("label", { class: "row" }, parallelBox, say(words.parallel))),
  element("section", { "aria-live": "polite" }, element("h2", {}, say(words.point)), hits),
  element("section", { "aria-live": "polite" }, element("h2", {}, say(words.report)), element("p", { class: "soft" }, say(words.reportHint)),
    element("div", { class: "row" }, element("button", { class: "button", onclick: askReport }, say(words.ask)), element("button", { class: "button", onclick: askSphere }, say(words.sphere))), account),
  element("section", {}, element("h2", {}, say(words.webgl)), element("p", { class: "soft" }, say(words.webglHint)),
    element("div", { class: "row" }, element("button", { class: "button", "data-webgl": true, onclick: askWebGL }, say(words.webglAsk)))),
  element("section", {}, element("h2", {}, say(words.save)), element("p", { class: "soft" }, say(words.saveHint)),
    downloads({ client, working, settle, name: () => model?.name ?? "model", image: () => lastImage, hidden: () => withHidden })),
  element("section", {}, element("h2", {}, say(words.command)), element("p", { class: "soft" }, say(words.commandHint)), command, element("div", { class: "row" }, copyButton)));

document.title = `Frontmost · ${say(words.title)}`;
document.body.append(bar("workbench"), element("main", { class: "workbench" }, stage, side));
listen(canvas, { camera: () => camera, worldUp: () => (model?.up ?? [0, 1, 0]) as Vector, moved: () => request("quick"), pointed: (x, y) => void askPoint(x, y) });
for (const kind of ["dragenter", "dragover"]) addEventListener(kind, (event) => {
  event.preventDefault();
  stage.classList.add("drop");
});
addEventListener("dragleave", () => stage.classList.remove("drop"));
addEventListener("drop", (event) => {
  event.preventDefault();
  stage.classList.remove("drop");
  if (event.dataTransfer) void openAll(dropped(event.dataTransfer));
});
new ResizeObserver(() => request("quick")).observe(stage);
addEventListener("themechange", () => request("fine"));
const first = new URLSearchParams(location.search).get("scene") ?? "gallery";
scenePicker.value = first;
void openBuiltin(first);
void client.loaded.then(keepForLater);
