// SPDX-License-Identifier: Apache-2.0
// screenshots.mjs PAGE FOLDER: every page in both languages at three widths, to be looked at.
import { mkdirSync } from "node:fs";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, to] = process.argv.slice(2);
mkdirSync(to, { recursive: true });
const { browser, address, close } = await openBrowser(folder);
const pages = { index: "index.html", lessons: "lessons.html", zbuffer: "lesson.html?lesson=z-buffer", why: "lesson.html?lesson=why-hidden", projection: "lesson.html?lesson=projection", painter: "lesson.html?lesson=painter" };
for (const [width, height] of [[1400, 900], [820, 1100], [390, 844]])
  for (const lang of ["en", "zh"])
    for (const [name, path] of Object.entries(pages)) {
      const { page, complaints, context } = await openPage(browser, { viewport: { width, height }, colorScheme: lang === "zh" ? "dark" : "light" });
      await page.goto(`${address}${path}${path.includes("?") ? "&" : "?"}lang=${lang}`);
      await page.waitForTimeout(name === "index" ? 2500 : 1800);
      await page.screenshot({ path: `${to}/${name}-${lang}-${width}.png`, fullPage: name !== "index" });
      if (complaints.length > 0) console.log(name, lang, width, complaints);
      await context.close();
    }
await close();
