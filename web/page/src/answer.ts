// SPDX-License-Identifier: Apache-2.0
// Questions to the module and its answers. A plane of numbers comes as the buffer of its bytes.

export type Question = { ask: string } & Record<string, unknown>;
// The fields of an answer depend on the question; web/workbench.h and web/lessons/ document them.
export type Answer = any;

/** Messages between the page and its worker. */
export interface Asked { id: number; base: string; question: Question; bytes?: ArrayBuffer }
export interface Answered { id: number; answer: Answer }
