// SPDX-License-Identifier: Apache-2.0
// screenshots.mjs PAGE FOLDER [NAME...]: takes pictures of every page, or of the named ones, at three widths, in both
// languages and both colour schemes, for inspection.
import { mkdirSync } from "node:fs";
import { openBrowser, openPage } from "./browser.mjs";

const [folder, to, ...names] = process.argv.slice(2);
mkdirSync(to, { recursive: true });
const { browser, address, close } = await openBrowser(folder);
const pages = { index: "index.html", lessons: "lessons.html" };
{
  const { page, context } = await openPage(browser);
  await page.goto(`${address}lessons.html?lang=en`);
  for (const link of await page.locator(".contents a").evaluateAll((links) => links.map((one) => one.getAttribute("href"))))
    pages[new URLSearchParams(link.split("?")[1]).get("lesson")] = link;
  await context.close();
}
for (const [width, height] of [[1400, 900], [820, 1100], [390, 844]])
  for (const [lang, colorScheme] of [["en", "light"], ["zh", "dark"]])
    for (const [name, path] of Object.entries(pages)) {
      if (names.length > 0 && !names.includes(name)) continue;
      const { page, complaints, context } = await openPage(browser, { viewport: { width, height }, colorScheme });
      await page.goto(`${address}${path}${path.includes("?") ? "&" : "?"}lang=${lang}`);
      await page.waitForTimeout(name === "index" ? 2500 : 1800);
      await page.screenshot({ path: `${to}/${name}-${lang}-${width}.png`, fullPage: name !== "index" });
      if (complaints.length > 0) console.log(name, lang, width, complaints);
      await context.close();
    }
await close();
