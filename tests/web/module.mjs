// SPDX-License-Identifier: Apache-2.0
// Loads the WebAssembly module in Node and asks it questions.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname } from "node:path";
import { pathToFileURL } from "node:url";

export async function loadModule(path) {
  // Emscripten's loader expects these names in Node, but ES modules do not have them.
  globalThis.require = createRequire(pathToFileURL(path));
  globalThis.__filename = path;
  globalThis.__dirname = dirname(path);
  const { default: create } = await import(pathToFileURL(path));
  const m = await create({ wasmBinary: readFileSync(path.replace(/\.mjs$/, ".wasm")) });
  // The view of memory is made anew each time: a thread may have grown the memory without notice.
  const memory = () => (m.wasmMemory ? new Uint8Array(m.wasmMemory.buffer) : m.HEAPU8);
  const text = (question) => {
    const json = JSON.stringify(question);
    const size = m.lengthBytesUTF8(json) + 1;
    const at = m._malloc(size);
    m.stringToUTF8(json, at, size);
    const answer = m.UTF8ToString(m._frontmost_ask(at));
    m._free(at);
    return answer;
  };
  return {
    memory,
    ask(question) {
      const answer = JSON.parse(text(question));
      if (answer.error) throw new Error(answer.error);
      return answer;
    },
    /** Asks a question that comes with bytes. */
    give(question, bytes) {
      const room = m._frontmost_room(bytes.length);
      if (room === 0) throw new Error("no room");
      memory().set(bytes, room);
      return this.ask(question);
    },
    open(name, bytes) {
      return this.give({ ask: "open", name }, bytes);
    },
    plane: (place) => memory().slice(place.at, place.at + place.bytes),
  };
}
