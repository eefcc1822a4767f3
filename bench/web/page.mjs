// SPDX-License-Identifier: Apache-2.0
// page.mjs PAGE: measures the page in Chromium: the time to the first picture over a line of 10 Mbit/s, with files
// compressed as hosts compress them; and the pictures a second while the view turns at 1280x720.
import { createServer } from "node:http";
import { brotliCompressSync } from "node:zlib";
import { openBrowser, openPage } from "../../tests/web/browser.mjs";

const [folder] = process.argv.slice(2);
const megabits = 10, delay = 20, seconds = 4;
const { browser, address, close } = await openBrowser(folder);

/** Serves the files over a slow line that all connections share. */
async function slowLine() {
  const kept = new Map(), chunk = 4096, pause = (chunk * 8) / (megabits * 1e6) * 1000;
  let free = 0, sent = 0;
  const server = createServer(async (request, response) => {
    if (!kept.has(request.url)) {
      const answer = await fetch(new URL(request.url, address));
      const headers = { "content-type": answer.headers.get("content-type") ?? "text/plain", "content-encoding": "br" };
      kept.set(request.url, [answer.status, headers, brotliCompressSync(Buffer.from(await answer.arrayBuffer()))]);
    }
    const [status, headers, bytes] = kept.get(request.url);
    await new Promise((go) => setTimeout(go, delay));
    response.writeHead(status, { ...headers, "content-length": bytes.length });
    for (let at = 0; at < bytes.length; at += chunk) {
      free = Math.max(free, performance.now()) + pause;
      await new Promise((go) => setTimeout(go, Math.max(0, free - performance.now())));
      response.write(bytes.subarray(at, at + chunk));
    }
    sent += bytes.length;
    response.end();
  });
  await new Promise((go) => server.listen(0, "127.0.0.1", go));
  return { at: `http://127.0.0.1:${server.address().port}/`, sent: () => sent, forget: () => (sent = 0), close: () => server.close() };
}

/** Counts pictures, and notes when the first one came. */
const count = () => {
  const put = CanvasRenderingContext2D.prototype.putImageData;
  window.pictures = [];
  CanvasRenderingContext2D.prototype.putImageData = function (image, ...rest) {
    window.pictures.push({ time: performance.now(), width: image.width, height: image.height });
    return put.call(this, image, ...rest);
  };
};

async function open(at, scene) {
  const { page, context } = await openPage(browser, { viewport: { width: 1280 + 380, height: 720 + 61 }, serviceWorkers: "block" });
  await page.addInitScript(count);
  await page.goto(`${at}index.html?lang=en&scene=${scene}`);
  await page.waitForFunction(() => window.pictures.length > 0, undefined, { timeout: 60000 });
  return { page, context };
}

const line = await slowLine();
for (const scene of ["teapot", "gallery"]) {
  // In the first round files are compressed, which no host does for every visitor.
  for (let round = 0; round < 4; ++round) {
    line.forget();
    const { page, context } = await open(line.at, scene);
    const first = await page.evaluate(() => window.pictures[0].time);
    if (round > 0) console.log(`${scene}: first picture after ${(first / 1000).toFixed(2)} s, ${(line.sent() / 1000).toFixed(0)} kB, ${megabits} Mbit/s`);
    await context.close();
  }
}
line.close();

for (const scene of ["teapot", "gallery", "city"]) {
  const { page, context } = await open(address, scene);
  await page.waitForTimeout(2500);
  const told = await page.evaluate(async (time) => {
    const canvas = document.querySelector(".stage canvas");
    const turn = () => canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    const until = performance.now() + time;
    // The size of pictures settles in the first second.
    let from = until - time + 1000;
    await new Promise((done) => {
      const next = () => {
        turn();
        if (performance.now() < until) requestAnimationFrame(next);
        else done();
      };
      next();
    });
    const shown = window.pictures.filter((one) => one.time > from && one.time <= until);
    return { rate: (shown.length * 1000) / (until - from), width: shown.at(-1).width, height: shown.at(-1).height };
  }, 1000 * (seconds + 1));
  console.log(`${scene}: ${told.rate.toFixed(1)} pictures a second while it turns, of ${told.width} x ${told.height}`);
  await context.close();
}
await close();
