// SPDX-License-Identifier: Apache-2.0
// Three pages of static files, with relative addresses, so that any folder of any host will do. The module lies beside
// them as it is: it is loaded by name, at run time, because there are two of it.
import { defineConfig, type Plugin } from "vite";

/** files.json: what a browser is to keep for when there is no network. */
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
