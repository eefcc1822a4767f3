// SPDX-License-Identifier: Apache-2.0
// Turns the eye about its target by mouse, touch and keys.
export type Vector = [number, number, number];
export interface Camera {
  width: number; height: number;
  eye: Vector; target: Vector; up: Vector;
  angle: number; orthographic: boolean;
  near?: number; far?: number; samples?: number; culling?: number; world_up?: Vector;
}

export const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const plus = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const times = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a: Vector): Vector => times(a, 1 / (Math.hypot(...a) || 1));

function turned(v: Vector, axis: Vector, angle: number): Vector {
  const c = Math.cos(angle), s = Math.sin(angle);
  return plus(plus(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

/** Turns about the model's up axis, then up and down, but never over the poles. */
export function orbit(camera: Camera, worldUp: Vector, right: number, up: number): void {
  let from = turned(minus(camera.eye, camera.target), worldUp, -right);
  const side = unit(cross(worldUp, from));
  const height = Math.asin(Math.max(-1, Math.min(1, dot(unit(from), worldUp))));
  const most = Math.PI / 2 - 0.01;
  const lifted = Math.max(-most, Math.min(most, height + up));
  from = turned(from, side, -(lifted - height));
  camera.eye = plus(camera.target, from);
  camera.up = worldUp;
}

export function dolly(camera: Camera, factor: number): void {
  camera.eye = plus(camera.target, times(minus(camera.eye, camera.target), factor));
}

/** Moves by shares of the picture's height. */
export function pan(camera: Camera, right: number, up: number): void {
  const away = minus(camera.target, camera.eye);
  const height = 2 * Math.hypot(...away) * Math.tan((camera.angle * Math.PI) / 360);
  const side = unit(cross(away, camera.up)), above = unit(cross(side, away));
  const by = plus(times(side, -right * height), times(above, -up * height));
  camera.eye = plus(camera.eye, by);
  camera.target = plus(camera.target, by);
}

export interface OrbitOptions {
  camera: () => Camera | undefined;
  worldUp: () => Vector;
  moved: () => void;
  pointed?: (x: number, y: number) => void;
  /** For a page with text: one finger up and down scrolls it (style.css), and so does the wheel until the picture is
   * clicked. */
  isInPage?: boolean;
}

/** Listens to an element, which should be focusable. */
export function listen(target: HTMLElement, { camera, worldUp, moved, pointed, isInPage }: OrbitOptions): void {
  const fingers = new Map<number, { x: number; y: number }>();
  let travelled = 0, atFirst: Camera | undefined;
  // Screen readers leave the keys of an application to it.
  target.setAttribute("role", "application");

  target.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    target.setPointerCapture(event.pointerId);
    travelled = fingers.size === 1 ? 0 : Infinity;
    if (fingers.size === 1) atFirst = structuredClone(camera());
  });
  target.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId), now = camera();
    if (!last || !now) return;
    const x = event.offsetX, y = event.offsetY, size = target.clientHeight || 1;
    const dx = (x - last.x) / size, dy = (y - last.y) / size;
    travelled += Math.abs(x - last.x) + Math.abs(y - last.y);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)![1];
      const before = Math.hypot(last.x - other.x, last.y - other.y), after = Math.hypot(x - other.x, y - other.y);
      if (after > 1) dolly(now, before / after);
      pan(now, dx / 2, -dy / 2);
    } else if (event.buttons & 2 || event.shiftKey) pan(now, dx, -dy);
    else orbit(now, worldUp(), dx * 4, dy * 4);
    fingers.set(event.pointerId, { x, y });
    moved();
  });
  const lift = (event: PointerEvent) => {
    const wasOne = fingers.size === 1 && fingers.delete(event.pointerId);
    fingers.delete(event.pointerId);
    if (wasOne && travelled < 5 && event.type === "pointerup") pointed?.(event.offsetX, event.offsetY);
  };
  target.addEventListener("pointerup", lift);
  // The browser takes over the touch to scroll the page: a turn that began meanwhile is undone.
  target.addEventListener("pointercancel", (event) => {
    const now = camera();
    if (fingers.size === 1 && travelled > 0 && now && atFirst) {
      Object.assign(now, atFirst);
      moved();
    }
    lift(event);
  });
  // Two fingers belong to the picture, wherever they go.
  target.addEventListener("touchmove", (event) => event.touches.length > 1 && event.cancelable && event.preventDefault(), { passive: false });
  target.addEventListener("contextmenu", (event) => event.preventDefault());
  target.addEventListener("wheel", (event) => {
    const now = camera();
    if (!now || (isInPage && !event.ctrlKey && document.activeElement !== target)) return;
    event.preventDefault();
    dolly(now, Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * 0.0015))));
    moved();
  }, { passive: false });
  target.addEventListener("keydown", (event) => {
    const now = camera();
    if (!now) return;
    const go = (right: number, up: number) => (event.shiftKey ? pan(now, right, up) : orbit(now, worldUp(), right, up)), step = 0.12;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => go(-step, 0), ArrowRight: () => go(step, 0), ArrowUp: () => go(0, step), ArrowDown: () => go(0, -step),
      "+": () => dolly(now, 0.9), "=": () => dolly(now, 0.9), "-": () => dolly(now, 1 / 0.9),
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    moved();
  });
}
