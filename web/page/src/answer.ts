// SPDX-License-Identifier: Apache-2.0
// Questions to the module and its answers. A plane of numbers comes as the buffer of its bytes.

export type Question = { ask: string } & Record<string, unknown>;
// What an answer holds depends on the question; web/workbench.h and web/lessons/ say what.
export type Answer = any;

/** What the page and its worker tell each other. */
export interface Asked { id: number; base: string; question: Question; bytes?: ArrayBuffer }
export interface Answered { id: number; answer: Answer }
