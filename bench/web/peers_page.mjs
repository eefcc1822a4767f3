// SPDX-License-Identifier: Apache-2.0
// The browser's side of bench/web/peers.mjs: the module, WebGL and three.js draw the same triangles from the same
// cameras.
import * as three from "three";
import { SVGRenderer } from "three/addons/renderers/SVGRenderer.js";

const { default: create } = await import(new URL("frontmost.mjs", location.href));
const m = await create({});
const size = { width: 1280, height: 720 }, pixels = size.width * size.height;

function ask(question) {
  const text = JSON.stringify(question), bytes = m.lengthBytesUTF8(text) + 1, at = m._malloc(bytes);
  m.stringToUTF8(text, at, bytes);
  const answer = JSON.parse(m.UTF8ToString(m._frontmost_ask(at)));
  m._free(at);
  if (answer.error) throw new Error(answer.error);
  return answer;
}
const plane = (place) => m.HEAPU8.slice(place.at, place.at + place.bytes);

/** Returns a camera that shows the whole open model, with its near and far planes. */
function look(name, forward) {
  const camera = ask({ ask: "lesson.frame", scene: name, ...size, forward });
  const { near, far } = ask({ ask: "draw", camera, show: "primitives" });
  return { ...camera, near, far };
}

/** Opens a built-in scene; returns its vertices in world space and a camera. */
function open(name) {
  ask({ ask: "builtin", name });
  const camera = look(name, [-0.6, -0.45, -0.8]);
  return { positions: new Float32Array(plane(ask({ ask: "triangles" }).corners).buffer), camera };
}

/** Triangle id of each pixel, by the module: an NPY of uint32 without its header. */
function seenIds() {
  const file = plane(ask({ ask: "write", what: "primitives", format: "npy" }).file);
  return new Uint32Array(file.slice(file.length - 4 * pixels).buffer);
}

function threeCamera({ eye, target, up, angle, near, far }) {
  const made = new three.PerspectiveCamera(angle, size.width / size.height, near, far);
  made.position.set(...eye);
  made.up.set(...up);
  made.lookAt(...target);
  made.updateMatrixWorld();
  return made;
}

/** Triangle ids in a frame buffer, read back; positions are uploaded once. */
function glDrawing(positions, camera) {
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2");
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, `#version 300 es
    in vec3 at; uniform mat4 clip_from_world; flat out uint id;
    void main() { id = uint(gl_VertexID / 3 + 1); gl_Position = clip_from_world * vec4(at, 1); }`], [gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float; precision highp int; flat in uint id; out vec4 color;
    void main() { color = vec4(id & 255u, (id >> 8) & 255u, (id >> 16) & 255u, id >> 24) / 255.0; }`]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, size.width, size.height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
  }
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STATIC_DRAW);
  gl.bindAttribLocation(program, 0, "at");
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
  gl.useProgram(program);
  const seen = threeCamera(camera), clip = new three.Matrix4().multiplyMatrices(seen.projectionMatrix, seen.matrixWorldInverse);
  gl.uniformMatrix4fv(gl.getUniformLocation(program, "clip_from_world"), false, clip.elements);
  gl.viewport(0, 0, size.width, size.height);
  gl.enable(gl.DEPTH_TEST);
  const ids = new Uint32Array(pixels), bytes = new Uint8Array(ids.buffer);
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return { ids, renderer: gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER), draw() {
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.drawArrays(gl.TRIANGLES, 0, positions.length / 3);
    gl.readPixels(0, 0, size.width, size.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  } };
}

/** The least times of both, in turn, and the number of pixels where they show different triangles. */
export function compareIds(name, frames) {
  const { positions, camera } = open(name), gl = glDrawing(positions, camera);
  let module = Infinity, webgl = Infinity;
  for (let i = 0; i < frames; ++i) {
    module = Math.min(module, ask({ ask: "draw", camera, show: "primitives" }).milliseconds.see);
    const begin = performance.now();
    gl.draw();
    webgl = Math.min(webgl, performance.now() - begin);
  }
  const ids = seenIds();
  let differing = 0;
  // WebGL's first row is the lowest, and its 0 means no triangle.
  for (let y = 0; y < size.height; ++y)
    for (let x = 0; x < size.width; ++x) differing += ids[y * size.width + x] !== (gl.ids[(size.height - 1 - y) * size.width + x] - 1) >>> 0;
  return { triangles: positions.length / 9, module, webgl, differing, renderer: gl.renderer };
}

function svgDrawing(positions, colors, camera, side) {
  const geometry = new three.BufferGeometry();
  geometry.setAttribute("position", new three.BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  const scene = new three.Scene();
  if (colors) geometry.setAttribute("color", new three.BufferAttribute(colors, 3));
  scene.add(new three.Mesh(geometry, colors ? new three.MeshBasicMaterial({ vertexColors: true, side }) : new three.MeshLambertMaterial({ side })));
  const sun = new three.DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 3);
  scene.add(sun, new three.AmbientLight(0xffffff, 0.5));
  const renderer = new SVGRenderer(), seen = threeCamera(camera), writer = new XMLSerializer();
  renderer.setSize(size.width, size.height);
  renderer.setPrecision(3);
  renderer.setClearColor(0);
  return () => {
    renderer.render(scene, seen);
    return writer.serializeToString(renderer.domElement);
  };
}

const moduleSvg = () => new TextDecoder().decode(plane(ask({ ask: "write", what: "figure", format: "svg" }).file));

/** A unique colour for every triangle, as three bytes; 0 means no triangle. */
const colorOf = (id) => Math.imul(id + 1, 0x287f8d) & 0xffffff;
/** The triangles' colours as linear numbers, three for every vertex. */
function idColors(count) {
  const linear = (byte) => (byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4), colors = new Float32Array(9 * count);
  for (let i = 0; i < 3 * count; ++i) [16, 8, 0].forEach((shift, k) => (colors[3 * i + k] = linear((colorOf(Math.floor(i / 3)) >> shift) & 255)));
  return colors;
}

/** Opens the triangles as a glTF file, unlit, in these colours. */
function openColored(positions, colors) {
  const view = (byteOffset, { byteLength }) => ({ buffer: 0, byteOffset, byteLength }), vec3 = (bufferView, more) => ({ bufferView, componentType: 5126, count: positions.length / 3, type: "VEC3", ...more });
  const ends = [Math.min, Math.max].map((least) => [0, 1, 2].map((axis) => positions.reduce((found, n, i) => (i % 3 === axis ? least(found, n) : found), positions[axis])));
  const json = { asset: { version: "2.0" }, extensionsUsed: ["KHR_materials_unlit"], scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, COLOR_0: 1 }, material: 0 }] }], materials: [{ doubleSided: true, extensions: { KHR_materials_unlit: {} } }],
    accessors: [vec3(0, { min: ends[0], max: ends[1] }), vec3(1)], bufferViews: [view(0, positions), view(positions.byteLength, colors)], buffers: [{ byteLength: positions.byteLength + colors.byteLength }] };
  let text = JSON.stringify(json);
  text = text.padEnd(Math.ceil(text.length / 4) * 4);
  const head = new Uint32Array([0x46546c67, 2, 0, text.length, 0x4e4f534a]), binary = new Uint32Array([json.buffers[0].byteLength, 0x004e4942]);
  const parts = [head, new TextEncoder().encode(text), binary, positions, colors].map((one) => new Uint8Array(one.buffer, one.byteOffset, one.byteLength));
  head[2] = parts.reduce((sum, part) => sum + part.length, 0);
  let at = m._frontmost_room(head[2]);
  for (const part of parts) {
    m.HEAPU8.set(part, at);
    at += part.length;
  }
  ask({ ask: "open", name: "ids.glb" });
}

/** Draws an SVG as the browser shows it, one colour a pixel. The canvas is marked as read often, so the browser draws
 * without a GPU, whose edges are smooth. */
async function rastered(svg) {
  const image = new Image();
  image.src = URL.createObjectURL(new Blob([svg.replace("<svg ", '<svg shape-rendering="crispEdges" ')], { type: "image/svg+xml" }));
  await image.decode();
  const pen = new OffscreenCanvas(size.width, size.height).getContext("2d", { willReadFrequently: true });
  pen.drawImage(image, 0, 0, size.width, size.height);
  return new Uint32Array(pen.getImageData(0, 0, size.width, size.height).data.buffer);
}

/** Counts pixels whose triangle is seen neither there nor at one of the eight neighbours. */
async function countWrong(svg, ids) {
  const shown = await rastered(svg), { width, height } = size;
  const truth = Uint32Array.from(ids, (id) => (id === 0xffffffff ? 0 : colorOf(id)));
  let wrong = 0;
  for (let y = 1; y < height - 1; ++y)
    for (let x = 1; x < width - 1; ++x) {
      const at = y * width + x, [r, g, b] = [shown[at] & 255, (shown[at] >> 8) & 255, (shown[at] >> 16) & 255], color = (r << 16) | (g << 8) | b;
      wrong += ![0, -1, 1, -width, width, -width - 1, -width + 1, width - 1, width + 1].some((by) => truth[at + by] === color);
    }
  return wrong;
}

/** The least times to write a shaded file, in turn; the lengths of the files; and the number of wrong pixels of each,
 * drawn in id colours from `views` directions all around. */
export async function compareSvg(name, rounds, views) {
  const { positions, camera } = open(name), shade = svgDrawing(positions, undefined, camera, three.FrontSide);
  const times = { module: Infinity, three: Infinity }, lengths = {};
  for (let i = 0; i < rounds; ++i)
    for (const [who, write] of [["module", moduleSvg], ["three", shade]]) {
      const begin = performance.now();
      lengths[who] = write().length;
      times[who] = Math.min(times[who], performance.now() - begin);
    }
  const colors = idColors(positions.length / 9);
  openColored(positions, colors);
  const wrong = { module: [], three: [] };
  for (let i = 0; i < views; ++i) {
    const around = (2 * Math.PI * i) / views, seen = look(name, [Math.cos(around), -0.45, Math.sin(around)]), ids = seenIds();
    wrong.module.push(await countWrong(moduleSvg(), ids));
    // three.js gets the triangle sides that suit it better.
    const both = [three.FrontSide, three.DoubleSide].map((side) => countWrong(svgDrawing(positions, colors, seen, side)(), ids));
    wrong.three.push(Math.min(...await Promise.all(both)));
  }
  return { triangles: positions.length / 9, times, lengths, wrong };
}
