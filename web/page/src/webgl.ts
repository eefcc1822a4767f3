// SPDX-License-Identifier: Apache-2.0
// The triangles of a view drawn by WebGL: its picture, and the triangle number at each pixel.
import type { Answer } from "./answer.ts";

const vertexSource = `#version 300 es
uniform mat4 clip_from_world;
in vec3 corner;
in vec4 color;
out vec3 place;
flat out vec4 paint;
flat out uint number;
void main() {
  gl_Position = clip_from_world * vec4(corner, 1);
  place = corner;
  paint = color;
  number = uint(gl_VertexID / 3) + 1u;
}`;
const fragmentSource = `#version 300 es
precision highp float;
precision highp int;
uniform vec3 eye;
in vec3 place;
flat in vec4 paint;
flat in uint number;
layout(location = 0) out vec4 picture;
layout(location = 1) out uint triangle;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  picture = vec4(paint.rgb * (0.3 + 0.7 * abs(dot(normal, normalize(eye - place)))), 1);
  triangle = number;
}`;

export interface Drawn {
  picture: ImageData;
  /** Triangle numbers from 1 on; 0: none. Top row first. */
  numbers: Uint32Array<ArrayBuffer>;
  renderer: string;
  subpixelBits: number;
}

function program(gl: WebGL2RenderingContext): WebGLProgram {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]] as const) {
    const shader = gl.createShader(kind)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(`WebGL: ${gl.getProgramInfoLog(made)}`);
  return made;
}

function target(gl: WebGL2RenderingContext, width: number, height: number): void {
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  for (const [format, attachment] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.R32UI, gl.COLOR_ATTACHMENT1], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]] as const) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, gl.createRenderbuffer());
    gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, gl.getParameter(gl.RENDERBUFFER_BINDING));
  }
  gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
  gl.viewport(0, 0, width, height);
  gl.enable(gl.DEPTH_TEST);
  gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
  gl.clearBufferuiv(gl.COLOR, 1, [0, 0, 0, 0]);
  gl.clearBufferfv(gl.DEPTH, 0, [1]);
}

function attribute(gl: WebGL2RenderingContext, at: number, bytes: ArrayBuffer, size: number, type: number, normalized: boolean): void {
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
  gl.enableVertexAttribArray(at);
  gl.vertexAttribPointer(at, size, type, normalized, 0, 0);
}

/** Reverses the rows, as WebGL's first row is the lowest. */
function flipped<T extends Uint8Array<ArrayBuffer> | Uint32Array<ArrayBuffer>>(from: T, to: T, height: number): T {
  const row = from.length / height;
  for (let y = 0; y < height; ++y) to.set(from.subarray(y * row, (y + 1) * row), (height - 1 - y) * row);
  return to;
}

/** Draws `view`, the answer to the question "triangles". */
export function drawByWebGL(view: Answer, eye: readonly number[]): Drawn {
  const { width, height } = view;
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2", { antialias: false });
  if (!gl) throw new Error("WebGL 2 is not to be had in this browser");
  try {
    const made = program(gl);
    target(gl, width, height);
    gl.useProgram(made);
    attribute(gl, gl.getAttribLocation(made, "corner"), view.corners, 3, gl.FLOAT, false);
    attribute(gl, gl.getAttribLocation(made, "color"), view.colors, 4, gl.UNSIGNED_BYTE, true);
    gl.uniformMatrix4fv(gl.getUniformLocation(made, "clip_from_world"), true, view.matrix.flat());
    gl.uniform3fv(gl.getUniformLocation(made, "eye"), eye);
    gl.drawArrays(gl.TRIANGLES, 0, view.corners.byteLength / 12);
    const rgba = new Uint8Array(4 * width * height), wide = new Uint32Array(4 * width * height);
    gl.readBuffer(gl.COLOR_ATTACHMENT0);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, wide);
    if (gl.getError() !== gl.NO_ERROR) throw new Error("WebGL could not draw the model");
    const narrow = wide.filter((_, i) => i % 4 === 0);
    return {
      picture: new ImageData(new Uint8ClampedArray(flipped(rgba, new Uint8Array(rgba.length), height).buffer), width, height),
      numbers: flipped(narrow, new Uint32Array(narrow.length), height),
      renderer: String(gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER)),
      subpixelBits: gl.getParameter(gl.SUBPIXEL_BITS),
    };
  } finally {
    gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}
