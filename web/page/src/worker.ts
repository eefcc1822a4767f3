// SPDX-License-Identifier: Apache-2.0
// The worker: holds the module, and answers one question after another, so that the page never waits.
import type { Answer, Answered, Asked, Question } from "./answer.ts";
import { decodeImage, PixelBudget } from "./images.ts";

interface Module {
  HEAPU8: Uint8Array;
  wasmMemory?: WebAssembly.Memory;
  _malloc(bytes: number): number;
  _free(at: number): void;
  _frontmost_room(bytes: number): number;
  _frontmost_ask(question: number): number;
  UTF8ToString(at: number): string;
  stringToUTF8(text: string, at: number, bytes: number): void;
  lengthBytesUTF8(text: string): number;
}

async function loadModule(base: string, name: string): Promise<Module> {
  const { default: create } = await import(/* @vite-ignore */ `${base}${name}.mjs`);
  return create({ locateFile: (file: string) => base + file });
}
/** Loads the module with threads if the page may share memory and gets it: some phones provide less. */
async function load(base: string): Promise<Module> {
  if (self.crossOriginIsolated)
    try {
      return await loadModule(base, "frontmost-threads");
    } catch (error) {
      console.info(`without threads: ${error}`);
    }
  return loadModule(base, "frontmost");
}

/** A view of all memory, made each time, as a thread may have grown the memory without notice. */
const memory = (m: Module): Uint8Array => (m.wasmMemory ? new Uint8Array(m.wasmMemory.buffer) : m.HEAPU8);
const bytesAt = (m: Module, { at, bytes }: { at: number; bytes: number }) => memory(m).slice(at, at + bytes) as Uint8Array<ArrayBuffer>;

/** Loaded once, from the base address in the first question. */
let module: Promise<Module> | undefined;

/** Copies planes out of the module's memory, which the next question may free. */
function takePlanes(m: Module, answer: Answer, planes: ArrayBuffer[]): void {
  for (const [key, value] of Object.entries<Answer>(answer)) {
    if (value === null || typeof value !== "object" || typeof value.at !== "number" || typeof value.bytes !== "number") continue;
    const copy = bytesAt(m, value as { at: number; bytes: number }).buffer;
    answer[key] = copy;
    planes.push(copy);
  }
}

function ask(m: Module, question: Question, bytes?: Uint8Array): Answer {
  if (bytes) {
    const room = m._frontmost_room(bytes.byteLength);
    if (room === 0) return { error: "there is not enough memory for the file" };
    memory(m).set(bytes, room);
  }
  const text = JSON.stringify(question);
  const size = m.lengthBytesUTF8(text) + 1;
  const at = m._malloc(size);
  m.stringToUTF8(text, at, size);
  const answer = JSON.parse(m.UTF8ToString(m._frontmost_ask(at)));
  m._free(at);
  return answer;
}

/** Opens a model again after its textures have been decoded. */
async function withImages(m: Module, answer: Answer): Promise<Answer> {
  while (answer.images) {
    const files: Uint8Array<ArrayBuffer>[] = answer.images.map((place: { at: number; bytes: number }) => bytesAt(m, place));
    const budget = new PixelBudget();
    for (const [number, file] of files.entries())
      try {
        budget.take(file);
        const { width, height, rgba } = await decodeImage(file);
        const told = ask(m, { ask: "image", number, width, height }, rgba);
        if (told.error) throw new Error(told.error);
      } catch (error) {
        ask(m, { ask: "image", number, problem: error instanceof Error ? error.message : String(error) });
      }
    answer = ask(m, { ask: "open", again: true });
  }
  return answer;
}

async function answerTo({ base, question, bytes }: Asked): Promise<Answer> {
  module ??= load(base);
  const m = await module;
  return withImages(m, ask(m, question, bytes && new Uint8Array(bytes)));
}

let last: Promise<unknown> = Promise.resolve();
self.onmessage = (event: MessageEvent<Asked>) => {
  // Answers one question after another, even if a question waits for images.
  last = last.then(async () => {
    const planes: ArrayBuffer[] = [];
    let answer: Answer;
    try {
      answer = await answerTo(event.data);
      takePlanes(await module!, answer, planes);
    } catch (error) {
      answer = { error: String(error), fatal: true };
    }
    const told: Answered = { id: event.data.id, answer };
    self.postMessage(told, { transfer: planes });
  });
};
