// SPDX-License-Identifier: Apache-2.0
// The lessons there are, in their order.
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

/** A part of a lesson: words, and a figure where there is one. */
export interface Part { title?: Text; prose: Text[]; figure?: () => HTMLElement }
export interface Lesson { id: string; title: Text; lead: Text; parts: Part[] }

export const lessons: Lesson[] = [culling, projection, zbuffer, painter, rays, layers, clipping, hiddenLines, shadows, occlusion, methods];
