// SPDX-License-Identifier: Apache-2.0
// The list of lessons, in order.
import type { Text } from "../language.ts";
import { clipping } from "./clipping.ts";
import { culling } from "./culling.ts";
import { layers } from "./layers.ts";
import { hiddenLines } from "./lines.ts";
import { methods } from "./methods.ts";
import { occlusion } from "./occlusion.ts";
import { painter } from "./painter.ts";
import { projection } from "./projection.ts";
import { rays } from "./rays.ts";
import { shadows } from "./shadows.ts";
import { zbuffer } from "./zbuffer.ts";

/** A part of a lesson: paragraphs, and optionally a figure. */
export interface Part { title?: Text; prose: Text[]; figure?: () => HTMLElement }
export interface Lesson { id: string; title: Text; lead: Text; parts: Part[] }

export const lessons: Lesson[] = [culling, projection, zbuffer, painter, rays, layers, clipping, hiddenLines, shadows, occlusion, methods];
