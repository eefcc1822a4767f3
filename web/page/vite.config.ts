// SPDX-License-Identifier: Apache-2.0
// Three pages of static files, with relative addresses, so that any folder of any host will do. The module lies beside
// them as it is: it is loaded by name, at run time, because there are two of it.
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    rollupOptions: { input: { index: "index.html", lessons: "lessons.html", lesson: "lesson.html" } },
  },
  worker: { format: "es" },
});
