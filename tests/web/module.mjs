// SPDX-License-Identifier: Apache-2.0
// The WebAssembly module in Node: loads it, asks it.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname } from "node:path";
import { pathToFileURL } from "node:url";

export async function loadModule(path) {
  // What emscripten's loader takes for granted in Node, and modules do not have.
  globalThis.require = createRequire(pathToFileURL(path));
  globalThis.__filename = path;
  globalThis.__dirname = dirname(path);
  const { default: create } = await import(pathToFileURL(path));
  const m = await create({ wasmBinary: readFileSync(path.replace(/\.mjs$/, ".wasm")) });
  // Of a module with threads, one of which may have asked for more and told nobody.
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
    /** A question with bytes. */
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
