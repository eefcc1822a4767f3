// SPDX-License-Identifier: Apache-2.0
// The page's side of the worker.
import type { Answer, Answered, Asked, Question } from "./answer.ts";

export class AskError extends Error {}

export class Client {
  private hasLoaded!: () => void;
  /** Resolves when the first question is answered, or cannot be: the module's files have arrived by then. */
  readonly loaded = new Promise<void>((done) => (this.hasLoaded = done));
  private worker = this.start();
  private waiting = new Map<number, { resolve: (answer: Answer) => void; reject: (error: Error) => void }>();
  private next = 1;

  private start(): Worker {
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    worker.onmessage = (event: MessageEvent<Answered>) => this.take(event.data);
    worker.onerror = (event) => this.fail(event.message || "the module could not be loaded");
    return worker;
  }

  private take({ id, answer }: Answered): void {
    const one = this.waiting.get(id);
    this.waiting.delete(id);
    this.hasLoaded();
    if (answer.error) one?.reject(new AskError(answer.error));
    else one?.resolve(answer);
    // After running out of memory or stack the module cannot continue; the next question starts a new one.
    if (answer.fatal) this.restart();
  }

  private fail(reason: string): void {
    this.hasLoaded();
    for (const one of this.waiting.values()) one.reject(new AskError(reason));
    this.waiting.clear();
  }

  /** Stops the current work and forgets the model. */
  restart(): void {
    this.worker.terminate();
    this.fail("stopped");
    this.worker = this.start();
  }

  /** Asks a question; `bytes` are transferred to the worker. */
  ask(question: Question, bytes?: ArrayBuffer): Promise<Answer> {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      const asked: Asked = { id, base: new URL("./", document.baseURI).href, question, bytes };
      this.worker.postMessage(asked, bytes ? [bytes] : []);
    });
  }
}

export function toImage(answer: Answer, key = "pixels"): ImageData {
  return new ImageData(new Uint8ClampedArray(answer[key]), answer.width, answer.height);
}
