// SPDX-License-Identifier: Apache-2.0
// The worker: holds the module, and answers one question after another, so that the page never waits.
import type { Answer, Answered, Asked } from "./answer.ts";

interface Module {
  HEAPU8: Uint8Array;
  _malloc(bytes: number): number;
  _free(at: number): void;
  _frontmost_room(bytes: number): number;
  _frontmost_ask(question: number): number;
  UTF8ToString(at: number): string;
  stringToUTF8(text: string, at: number, bytes: number): void;
  lengthBytesUTF8(text: string): number;
}

async function load(base: string): Promise<Module> {
  const { default: create } = await import(/* @vite-ignore */ `${base}frontmost.mjs`);
  return create({ locateFile: (file: string) => base + file });
}

/** Loaded once, from where the first question says that it is. */
let module: Promise<Module> | undefined;

/** Copies planes out of the module's memory, of which the next question may dispose. */
function takePlanes(m: Module, answer: Answer, planes: ArrayBuffer[]): void {
  for (const [key, value] of Object.entries<Answer>(answer)) {
    if (value === null || typeof value !== "object" || typeof value.at !== "number" || typeof value.bytes !== "number") continue;
    const copy = m.HEAPU8.slice(value.at, value.at + value.bytes).buffer as ArrayBuffer;
    answer[key] = copy;
    planes.push(copy);
  }
}

function ask(m: Module, { question, bytes }: Asked): { answer: Answer; planes: ArrayBuffer[] } {
  if (bytes) {
    const room = m._frontmost_room(bytes.byteLength);
    if (room === 0) return { answer: { error: "there is not enough memory for the file" }, planes: [] };
    m.HEAPU8.set(new Uint8Array(bytes), room);
  }
  const text = JSON.stringify(question);
  const size = m.lengthBytesUTF8(text) + 1;
  const at = m._malloc(size);
  m.stringToUTF8(text, at, size);
  const answer = JSON.parse(m.UTF8ToString(m._frontmost_ask(at)));
  m._free(at);
  const planes: ArrayBuffer[] = [];
  takePlanes(m, answer, planes);
  return { answer, planes };
}

self.onmessage = async (event: MessageEvent<Asked>) => {
  const { id } = event.data;
  let result: { answer: Answer; planes: ArrayBuffer[] };
  try {
    module ??= load(event.data.base);
    result = ask(await module, event.data);
  } catch (error) {
    result = { answer: { error: String(error), fatal: true }, planes: [] };
  }
  const told: Answered = { id, answer: result.answer };
  self.postMessage(told, { transfer: result.planes });
};
