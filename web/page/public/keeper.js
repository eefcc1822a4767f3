// SPDX-License-Identifier: Apache-2.0
// Keeps what was loaded, for when there is no network; with one, what is new replaces it. And isolates the page from
// others, where its host does not, so that the module may have threads: from the second visit on.
const store = "frontmost";

function isolated(response) {
  if (response.status === 0) return response; // a redirection, which the browser follows itself
  const headers = new Headers(response.headers);
  headers.set("cross-origin-opener-policy", "same-origin");
  headers.set("cross-origin-embedder-policy", "require-corp");
  return new Response(response.body, { status: response.status, statusText: response.statusText, headers });
}

self.addEventListener("install", () => self.skipWaiting());
self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));
self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || new URL(request.url).origin !== location.origin) return;
  event.respondWith((async () => {
    const kept = await caches.open(store);
    try {
      const fresh = await fetch(request);
      if (fresh.ok) await kept.put(request, fresh.clone());
      return isolated(fresh);
    } catch (error) {
      const found = await kept.match(request, { ignoreSearch: true });
      if (found) return isolated(found);
      throw error;
    }
  })());
});
