// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium without windows, through playwright-core, without a network except the page's own server.
import { createRequire } from "node:module";
import { serve } from "../../scripts/page/server.mjs";

export async function openBrowser(folder, more = ["--disable-gpu", "--enable-unsafe-swiftshader"]) {
  const { chromium } = createRequire(new URL("../../web/page/package.json", import.meta.url))("playwright-core");
  const { server, address } = await serve(folder);
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium-headless-shell", headless: true,
    args: ["--no-sandbox", ...more, "--host-resolver-rules=MAP plain.test 127.0.0.1", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"] });
  return { browser, address, async close() {
    await browser.close();
    server.close();
  } };
}

const blocked = "Service Worker registration blocked by Playwright";

/** Opens a page and collects its errors and warnings. Without its service worker the page keeps no files for later, which
 * takes longer than it does to show most pages; tests of hosts have the worker. A page that goes on to another address
 * of its server finds the module compiled, as a new context does not. */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, serviceWorkers: "block", ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && message.text() !== blocked && complaints.push(`${message.type()}: ${message.text()} (${message.location().url})`));
  page.on("pageerror", (error) => complaints.push(`error: ${error.message}`));
  return { page, complaints, context };
}
