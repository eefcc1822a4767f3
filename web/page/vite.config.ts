// SPDX-License-Identifier: Apache-2.0
// Builds three pages of static files with relative addresses, so that any folder of any host works. The module lies
// beside them unchanged: it is loaded by name at run time, because there are two of it.
import { defineConfig, type Plugin } from "vite";

/** files.json: the files that a browser keeps for use without a network. */
const listFiles: Plugin = {
  name: "list-files",
  generateBundle: {
    order: "post",
    handler(_, bundle) {
      this.emitFile({ type: "asset", fileName: "files.json", source: JSON.stringify(Object.keys(bundle)) });
    },
  },
};

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    rollupOptions: { input: { index: "index.html", lessons: "lessons.html", lesson: "lesson.html" } },
  },
  worker: { format: "es" },
  plugins: [listFiles],
});
