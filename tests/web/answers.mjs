// SPDX-License-Identifier: Apache-2.0
// answers.mjs MODULE: what the module answers beside hashes: known numbers of the lessons, broken files, files that are
// written, and memory that does not grow with every model.
import assert from "node:assert/strict";
import { loadModule } from "./module.mjs";

const frontmost = await loadModule(process.argv[2]);
const { ask, plane } = frontmost;
const text = (place) => new TextDecoder("latin1").decode(plane(place));

// The classic table, nearer first, as its books have it.
{
  const expected = [
    [64, 64, 64, 64, 64, 64, 64, 255], [64, 64, 64, 64, 64, 64, 255, 255], [64, 64, 64, 64, 64, 255, 255, 255], [64, 64, 64, 64, 255, 255, 255, 255],
    [64, 64, 64, 255, 255, 255, 255, 255], [64, 64, 127, 255, 255, 255, 255, 255], [64, 127, 127, 127, 255, 255, 255, 255], [127, 127, 127, 127, 127, 255, 255, 255]].flat();
  for (const [first, second] of [[64, 127], [127, 64]]) {
    const answer = ask({ ask: "lesson.zbuffer", example: "table", first, second });
    const table = new Array(64).fill(answer.clear);
    let failed = 0;
    for (const cell of answer.triangles.flat()) {
      assert.equal(cell.before, table[cell.y * 8 + cell.x]);
      assert.equal(cell.passes, cell.depth < cell.before);
      failed += !cell.passes;
      table[cell.y * 8 + cell.x] = cell.after;
    }
    if (first === 64) assert.deepEqual(table, expected);
    if (first === 64) assert.ok(failed > 0, "the farther triangle loses somewhere");
  }
  const greater = ask({ ask: "lesson.zbuffer", example: "table", first: 250, second: 254, greater: true });
  assert.equal(greater.clear, 0);
  assert.ok(greater.triangles[0].every((cell) => cell.depth === 5 && cell.passes), "255 less 250 is 5");
}

// 1 / z: 4, and not 4.5.
{
  const { depth, linear } = ask({ ask: "lesson.projection", example: "segment" });
  assert.ok(Math.abs(depth[200] - 4) < 1e-3 && Math.abs(linear[200] - 4.5) < 1e-9);
  const coarse = ask({ ask: "lesson.projection", example: "fight", near: 0.001, format: 1 });
  const fine = ask({ ask: "lesson.projection", example: "fight", near: 0.1, format: 3, reversed: true });
  assert.ok(coarse.wrong > 1000 && fine.wrong === 0, `${coarse.wrong} and ${fine.wrong} wrong pixels`);
}

// A ring of three: wrong by any sorting, right when it is cut.
{
  const wrong = (method) => ask({ ask: "lesson.painter", scene: "cycle", method });
  assert.ok(wrong("centroid").wrong_count > 100 && wrong("farthest").wrong_count > 100);
  const sorted = wrong("depth_sort");
  assert.equal(sorted.wrong_count, 0);
  assert.ok(sorted.steps.cuts > 0 && sorted.polygons > sorted.triangles);
  assert.equal(wrong("bsp").wrong_count, 0);
}

// Half of a cube's triangles face the eye, and leaving out the others changes nothing.
{
  const camera = { width: 200, height: 150, eye: [4, 3, 5], target: [0, 0, 0], up: [0, 1, 0], angle: 30 };
  const cube = ask({ ask: "lesson.culling", scene: "cube", camera: { ...camera, culling: 1 } });
  assert.deepEqual([cube.front, cube.back, cube.edge_on, cube.changed], [6, 6, 0, 0]);
  assert.equal(cube.reasons.hidden, 0);
  assert.ok(ask({ ask: "lesson.culling", scene: "cube", camera: { ...camera, culling: 2 } }).changed > 1000);
}

// Fragments come nearest first; without their order glass has other colours; every method shows what the z-buffer does.
{
  const layers = ask({ ask: "lesson.layers", scene: "cubes", camera: { width: 160, height: 120, eye: [4, 3, 5], target: [0, 0, 0], up: [0, 1, 0], angle: 30 } });
  assert.ok(layers.list.length >= 2 && layers.differing > 100);
  layers.list.forEach((one, i) => assert.ok(i === 0 || one.depth >= layers.list[i - 1].depth));
  assert.ok(layers.list.every((one) => one.mask.length === 64 && one.covered === [...one.mask].filter((bit) => bit === "1").length / 64));
  for (const method of ["zbuffer", "abuffer", "painter"]) assert.equal(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method }).differing, 0, method);
  assert.ok(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method: "raycast" }).differing < 160, "rays differ at edges alone");
  assert.ok(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method: "lines" }).bytes > 0);
}

// Broken files end in an error that names them, and the model before stays.
ask({ ask: "builtin", name: "cubes" });
for (const [name, bytes] of [["cut.stl", new Uint8Array(90).fill(200)], ["bad.glb", new TextEncoder().encode("glTF????")], ["empty.ply", new Uint8Array()], ["what.xyz", new Uint8Array([1, 2, 3])]])
  assert.throws(() => frontmost.open(name, bytes), (error) => error.message.includes(name), name);
const camera = ask({ ask: "frame", width: 160, height: 120 });
ask({ ask: "draw", camera, hash: true });
assert.throws(() => ask({ ask: "draw", camera: { ...camera, width: 0 } }), /width/);

// What is written begins and ends as its format does.
const written = (what, format) => text(ask({ ask: "write", what, format }).file);
assert.match(written("lines", "svg"), /^<\?xml[\s\S]*<\/svg>\s*$/);
assert.match(written("figure", "svg"), /<path|<polygon/);
assert.match(written("lines", "pdf"), /^%PDF-1\.[\s\S]*%%EOF\s*$/);
assert.match(written("lines", "dxf"), /EOF\s*$/);
assert.equal(written("depth", "npy").slice(1, 6), "NUMPY");
assert.equal(written("objects", "npy").length, 128 + 160 * 120 * 4);
assert.match(written("depth", "pfm"), /^Pf\n160 120\n/);
assert.equal(ask({ ask: "conventions" }).resolution[0], 160);

// Pointing: two cubes one behind the other.
{
  const { hits } = ask({ ask: "point", x: 80, y: 60 });
  assert.ok(hits.length >= 2 && hits[0].depth <= hits[1].depth);
  const { objects } = ask({ ask: "report" });
  assert.equal(objects.length, 2);
  for (const object of objects) assert.ok(Math.abs(object.visible_share + object.hidden_share + object.cut_share - 1) < 1e-9);
  const around = ask({ ask: "sphere", views: 8, size: 64 });
  assert.ok(around.ever_seen > 0 && around.ever_seen <= around.triangles);
}

// Fifty models, one after the other.
let after = 0;
for (let i = 0; i < 50; ++i) {
  ask({ ask: "builtin", name: i % 2 ? "teapot" : "gallery" });
  ask({ ask: "draw", camera, show: "flat" });
  if (i === 5) after = frontmost.module.HEAPU8.length;
}
assert.equal(frontmost.module.HEAPU8.length, after, "memory grows with every model");
console.log(`the lessons' numbers, four broken files, seven files written, 50 models in ${after / 2 ** 20} MiB`);
