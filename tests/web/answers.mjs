// SPDX-License-Identifier: Apache-2.0
// answers.mjs MODULE: tests the module's answers apart from hashes: known numbers of the lessons, broken files, written
// files, and memory that does not grow with every model.
import assert from "node:assert/strict";
import { loadModule } from "./module.mjs";

const frontmost = await loadModule(process.argv[2]);
const { ask, plane } = frontmost;
const text = (place) => new TextDecoder("latin1").decode(plane(place));

// The classic table, nearer triangle first, as in textbooks.
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

// Two surfaces in one plane: without an offset, label and board both win pixels. A polygon offset of the board by its
// slope and one step gives the label all of its pixels, in every format. The comparisons of a pixel decide what it shows.
for (const format of [1, 2, 3])
  for (const [factor, units] of [[0, 0], [1, 1]]) {
    const { all, shown, pixels, comparisons: [board, label, ...others] } = ask({ ask: "lesson.zbuffer", example: "coplanar", format, factor, units, pixel: [178, 120] });
    assert.ok(factor === 1 ? shown === all : shown > 0 && shown < all, `${shown} of ${all}`);
    assert.ok(board.triangle < 2 && board.passes && label.triangle >= 2 && label.stored_before === board.stored);
    assert.equal(label.passes, label.stored < board.stored);
    const [red, , blue] = plane(pixels).slice(4 * (120 * 320 + 178));
    assert.deepEqual([blue > red, all, others], [label.passes, 22078, []], "blue is the label");
    if (format === 2 && factor === 0) assert.equal(label.stored - board.stored, 1);
  }

for (const format of [1, 2, 3])
  for (const near of [0.05, 1])
    for (const turn of [-40, 15, 40]) {
      const { all, shown } = ask({ ask: "lesson.zbuffer", example: "coplanar", format, factor: 1, units: 1, near, turn, pixel: [0, 0] });
      assert.ok(all > 10000 && shown === all, `${shown} of ${all}`);
    }

// Interpolating 1 / z gives 4, and not 4.5.
{
  const { depth, linear } = ask({ ask: "lesson.projection", example: "segment" });
  assert.ok(Math.abs(depth[200] - 4) < 1e-3 && Math.abs(linear[200] - 4.5) < 1e-9);
  const coarse = ask({ ask: "lesson.projection", example: "fight", near: 0.001, format: 1 });
  const fine = ask({ ask: "lesson.projection", example: "fight", near: 0.1, format: 3, reversed: true });
  assert.ok(coarse.wrong > 1000 && fine.wrong === 0, `${coarse.wrong} and ${fine.wrong} wrong pixels`);
}

// A ring of three: wrong by any sorting, right after cuts.
{
  const wrong = (method) => ask({ ask: "lesson.painter", scene: "cycle", method });
  assert.ok(wrong("centroid").wrong_count > 100 && wrong("farthest").wrong_count > 100);
  const sorted = wrong("depth_sort");
  assert.equal(sorted.wrong_count, 0);
  assert.ok(sorted.steps.cuts > 0 && sorted.polygons > sorted.triangles);
  assert.equal(wrong("bsp").wrong_count, 0);
}

// The BSP tree paints every scene correctly from every side. Where Newell's tests decide an overlapping pair, the
// library, which has tests of its own, paints the pair in that order. Where no test holds, it cuts.
for (const scene of ["cycle", "cubes", "concave", "cube"])
  for (const forward of [[-0.6, -0.45, -0.8], [0.3, -0.2, -1], [-0.05, -0.1, -1]]) {
    const camera = ask({ ask: "lesson.frame", scene, width: 240, height: 180, forward });
    const tree = ask({ ask: "lesson.bsp", scene, camera });
    assert.equal(tree.wrong_count, 0, scene);
    assert.deepEqual([...tree.order].sort((a, b) => a - b), tree.nodes.map((_, i) => i));
    assert.equal(tree.polygons > tree.triangles, scene === "cycle" || scene === "cubes", `${scene}: ${tree.polygons} pieces`);
    const { pairs } = ask({ ask: "lesson.newell", scene, camera });
    for (const { p, q, first, overlap } of pairs) {
      assert.ok(p.far >= q.far);
      if (overlap && first !== "cut" && p.position !== null && q.position !== null) assert.equal(p.position < q.position, first === "p", `${scene}: ${p.triangle} and ${q.triangle}`);
    }
    if (scene === "concave" || scene === "cube") assert.ok(pairs.every(({ first }) => first !== "cut"));
  }
assert.ok(ask({ ask: "lesson.newell", scene: "cubes", width: 240, height: 180 }).pairs.some(({ first }) => first === "cut"));

// At 90 degrees, the viewing volume is as wide as its distance, and the matrix agrees.
{
  const camera = { width: 200, height: 200, eye: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], angle: 90, near: 1, far: 9 };
  const { matrix, sides, volume } = ask({ ask: "lesson.projection", example: "frustum", scene: "blocks", camera, beside: { ...camera, eye: [30, 0, 5] } });
  [-1, 1, -1, 1].forEach((side, i) => assert.ok(Math.abs(sides[i] - side) < 1e-9));
  assert.ok(Math.abs(matrix[0][0] - 1) < 1e-9 && Math.abs(matrix[2][2] + 10 / 8) < 1e-9 && Math.abs(matrix[2][3] + 18 / 8) < 1e-9);
  assert.equal(volume.length, 12);
}

// Half of a cube's triangles face the eye, and omitting the others changes nothing.
{
  const camera = { width: 200, height: 150, eye: [4, 3, 5], target: [0, 0, 0], up: [0, 1, 0], angle: 30 };
  const cube = ask({ ask: "lesson.culling", scene: "cube", camera: { ...camera, culling: 1 } });
  assert.deepEqual([cube.front, cube.back, cube.edge_on, cube.changed], [6, 6, 0, 0]);
  assert.equal(cube.reasons.hidden, 0);
  assert.ok(ask({ ask: "lesson.culling", scene: "cube", camera: { ...camera, culling: 2 } }).changed > 1000);
}

// A plain tree of boxes finds the hits of the library's rays, at every pixel and on every level. It does less work the
// further the tree is opened, and the result of the light test does not depend on the tree.
for (const scene of ["blocks", "cubes", "concave", "teapot"]) {
  const camera = ask({ ask: "lesson.frame", scene, width: 160, height: 120, forward: [-0.6, -0.45, -0.8] });
  const beside = ask({ ask: "lesson.frame", scene, width: 160, height: 120, forward: [0.75, -0.4, -0.75], beside: [camera.eye] });
  let before = Infinity;
  for (const level of [0, 3, 99]) {
    const tree = ask({ ask: "lesson.rays", example: "levels", scene, camera, level });
    assert.equal(tree.differing, 0, `${scene}, level ${level}`);
    assert.ok(tree.triangles_asked < before && tree.triangles_asked < tree.without);
    before = tree.triangles_asked;
  }
  for (const [x, y] of [[80, 60], [60, 80], [100, 70], [2, 2]]) {
    const one = ask({ ask: "lesson.rays", scene, camera, beside, x, y });
    const met = one.steps.filter((step) => step.kind === "triangle" && step.verdict === "met");
    assert.equal(one.hit?.triangle ?? 4294967295, one.library);
    assert.equal(met.at(-1)?.number, one.hit?.triangle);
    met.forEach((step, i) => assert.ok(i === 0 || step.t <= met[i - 1].t, "each that is met is nearer"));
    assert.equal(one.steps.filter((step) => step.kind === "triangle").length, one.asked);
  }
}

// The intervals that single triangles hide of an edge add up to the library's counts in every part. One surface hides
// three edges of a cube; behind blocks, some edges are hidden by two and more.
for (const [scene, least] of [["cube", 1], ["concave", 2], ["cubes", 2], ["blocks", 3]]) {
  const camera = ask({ ask: "lesson.frame", scene, width: 320, height: 240, forward: [-0.6, -0.45, -0.8] });
  const drawing = ask({ ask: "lesson.lines", scene, camera });
  const numbers = new Float32Array(plane(drawing.parts).buffer), parts = [];
  for (let i = 0; i < numbers.length; i += 9) parts.push({ edge: numbers[i], kind: numbers[i + 1], hiddenBy: numbers[i + 2], begin: numbers[i + 7], end: numbers[i + 8] });
  for (let edge = 0; edge < drawing.edges; ++edge) {
    const { intervals } = ask({ ask: "lesson.lines", scene, camera, edge });
    for (const part of parts.filter((one) => one.edge === edge)) {
      const middle = (part.begin + part.end) / 2;
      assert.equal(intervals.filter((one) => one.begin < middle && middle < one.end).length, part.hiddenBy, `${scene}, edge ${edge}`);
    }
  }
  assert.ok(Math.max(...parts.map((part) => part.hiddenBy)) >= least, scene);
  if (scene === "cube") assert.deepEqual([drawing.silhouettes, drawing.creases, parts.filter((part) => part.hiddenBy === 1).length], [6, 6, 3]);
}

// Sutherland-Hodgman clipping leaves what the library shows, to the last digits. Behind the eye w is negative, until
// the near plane has cut.
for (const [corners, most] of [[[[-1, -0.8, -3], [1, -0.5, -4], [0.3, 1, -3.5]], 3], [[[-4, -0.8, -3], [3, -1, -5], [0.6, 3.2, -3]], 6],
  [[[-2, -1.1, -5], [1.8, -0.6, -4], [0.5, 0.5, 1]], 6], [[[-2.2, -0.7, 1.5], [2, -0.8, 1], [0.3, 0.9, -4.5]], 6], [[[-1, -0.9, -8], [1.6, -0.2, -4], [0.2, 0.25, -0.6]], 7]]) {
  const beside = { width: 480, height: 360, eye: [9.5, 5.5, 4.5], target: [0, 0, -3], up: [0, 1, 0], angle: 37 };
  const cut = ask({ ask: "lesson.clipping", corners, beside });
  assert.equal(cut.steps.length, 7);
  assert.ok(Math.abs(cut.area - cut.library) <= 1e-9 * cut.library, `${cut.area} and ${cut.library}`);
  assert.equal(cut.steps[0].some(({ clip }) => clip[3] < 0), corners.some(([, , z]) => z > 0));
  assert.ok(cut.steps.slice(1).every((step) => step.length <= most && step.every(({ clip }) => clip[3] > 0)));
}

// Without a bias half of the pixels that face the light have acne; with one the acne disappears; with too much, light
// leaks. With fine texels and a small bias the map agrees with exact rays, except for a few pixels.
{
  const camera = ask({ ask: "lesson.frame", scene: "blocks", width: 360, height: 270, forward: [-0.6, -0.5, -0.8] });
  const light = [0.6, 0.8, 0.35];
  const errors = (size, bias) => ask({ ask: "lesson.shadows", scene: "blocks", camera, light, size, bias });
  const none = errors(128, 0), some = errors(128, 0.08), much = errors(128, 1), fine = errors(2048, 0.02);
  assert.ok(none.acne > 0.3 * none.facing && none.acne < 0.7 * none.facing, `${none.acne} of ${none.facing}`);
  assert.ok(some.acne < 0.05 * none.acne && much.acne <= some.acne);
  assert.ok(much.leaks > 4 * some.leaks, `${much.leaks} leaks, and ${some.leaks}`);
  assert.ok(fine.acne + fine.leaks < 0.003 * fine.facing, `${fine.acne} and ${fine.leaks} of ${fine.facing}`);
}

// Objects proved hidden are never seen; more objects cover no less; larger cells prove no more here; no objects cover
// nothing.
{
  const camera = { width: 480, height: 320, eye: [0.1, 0.55, 2.4], target: [0.1, 0.5, -3.5], up: [0, 1, 0], angle: 46 };
  const swept = (cell, step) => ask({ ask: "lesson.occlusion", scene: "town", camera, cell, step });
  const hidden = (answer) => answer.objects.filter((object) => object.sight === "hidden");
  let before = Infinity;
  for (const cell of [2, 4, 8, 16]) {
    const answer = swept(cell, 64);
    for (const object of hidden(answer)) assert.ok(!object.seen, `house ${object.object}`);
    assert.ok(hidden(answer).length > 10 && hidden(answer).length <= before);
    before = hidden(answer).length;
  }
  let covered = 0;
  for (const step of [0, 1, 8, 20, 64]) {
    const { cells } = swept(8, step), count = [...cells].filter((one) => one === "1").length;
    assert.ok(step === 0 ? count === 0 : count >= covered);
    covered = count;
  }
}

// Similar checks for models split into parts: 50 clusters of a teapot, and the nearest 300 houses of a city.
for (const [scene, least, visited] of [["teapot", 30, undefined], ["gallery", 8, undefined], ["city", 301, 300]]) {
  const camera = ask({ ask: "lesson.frame", scene, width: 480, height: 320, forward: [-0.6, -0.1, -0.8] });
  let covered = 0;
  for (const share of [0, 0.3, 0.6, 1]) {
    const { objects, object_count } = ask({ ask: "lesson.occlusion", scene, camera, step: 0 });
    assert.ok(object_count >= least && objects.length === (visited ?? object_count), `${scene}: ${object_count} objects`);
    const answer = ask({ ask: "lesson.occlusion", scene, camera, cell: 2, step: Math.round(share * objects.length) });
    assert.ok(answer.objects.every(({ sight, seen }) => sight === "may_be_seen" || !seen), scene);
    const count = [...answer.cells].filter((one) => one === "1").length;
    assert.ok(share === 0 ? count === 0 : count > 0 && count >= covered, `${scene}: ${count} cells`);
    covered = count;
  }
}

// Figures with room for 200 triangles show the foremost ones, and their BSP tree has no wrong pixel.
{
  assert.throws(() => ask({ ask: "lesson.bsp", scene: "teapot" }), /200/);
  const part = { scene: "teapot", most: 200 }, camera = ask({ ask: "lesson.frame", ...part, width: 240, height: 180, forward: [-0.6, -0.45, -0.8] });
  const whole = ask({ ask: "lesson.frame", scene: "teapot", width: 240, height: 180, forward: [-0.6, -0.45, -0.8] });
  assert.notDeepEqual(camera.eye, whole.eye);
  const tree = ask({ ask: "lesson.bsp", ...part, camera }), { pairs, by_test } = ask({ ask: "lesson.newell", ...part, camera });
  assert.deepEqual([tree.triangles, tree.wrong_count], [200, 0]);
  assert.ok(pairs.length > 0 && by_test[0] > 1000 && by_test[1] > 1000);
}

// Fragments come nearest first; in another order glass has other colours; every method gives the z-buffer's picture.
{
  const layers = ask({ ask: "lesson.layers", scene: "cubes", camera: { width: 160, height: 120, eye: [4, 3, 5], target: [0, 0, 0], up: [0, 1, 0], angle: 30 } });
  assert.ok(layers.list.length >= 2 && layers.differing > 100);
  layers.list.forEach((one, i) => assert.ok(i === 0 || one.depth >= layers.list[i - 1].depth));
  assert.ok(layers.list.every((one) => one.mask.length === 64 && one.covered === [...one.mask].filter((bit) => bit === "1").length / 64));
  for (const method of ["zbuffer", "abuffer", "painter"]) assert.equal(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method }).differing, 0, method);
  assert.ok(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method: "raycast" }).differing < 160, "rays differ at edges alone");
  assert.ok(ask({ ask: "lesson.methods", scene: "cubes", width: 160, height: 120, method: "lines" }).bytes > 0);
  for (const scene of ["cubes", "teapot", "gallery"]) {
    const { culled, differing } = ask({ ask: "lesson.methods", scene, width: 160, height: 120, method: "occlusion" });
    assert.equal(differing, 0, `${scene}: what is proved hidden is seen`);
    assert.ok(culled >= 0 && (scene !== "teapot" || culled >= 200), `${scene}: ${culled} left out`);
  }
}

// A user's file is a scene like the others, z up if its format says so, and stays while others are shown.
{
  const facets = new TextEncoder().encode("solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid one\n");
  assert.equal(frontmost.give({ ask: "lesson.open", name: "one.stl" }, facets).triangles, 1);
  const own = () => ask({ ask: "lesson.frame", scene: "own", width: 100, height: 100, forward: [0, -1, 0] });
  assert.deepEqual(own().world_up, [0, 0, 1]);
  ask({ ask: "lesson.frame", scene: "cubes", width: 100, height: 100, forward: [0, -1, 0] });
  assert.equal(ask({ ask: "lesson.lines", scene: "own", camera: own() }).boundaries, 3);
}

// A broken file ends in an error that names it, and the previous model stays.
ask({ ask: "builtin", name: "cubes" });
for (const [name, bytes] of [["cut.stl", new Uint8Array(90).fill(200)], ["bad.glb", new TextEncoder().encode("glTF????")], ["empty.ply", new Uint8Array()], ["what.xyz", new Uint8Array([1, 2, 3])]])
  assert.throws(() => frontmost.open(name, bytes), (error) => error.message.includes(name), name);
const camera = ask({ ask: "frame", width: 160, height: 120 });
ask({ ask: "draw", camera, hash: true });
assert.throws(() => ask({ ask: "draw", camera: { ...camera, width: 0 } }), /width/);

// Written files begin and end as their formats require.
const written = (what, format) => text(ask({ ask: "write", what, format }).file);
assert.match(written("lines", "svg"), /^<\?xml[\s\S]*<\/svg>\s*$/);
assert.match(written("figure", "svg"), /<path|<polygon/);
assert.match(written("lines", "pdf"), /^%PDF-1\.[\s\S]*%%EOF\s*$/);
assert.match(written("lines", "dxf"), /EOF\s*$/);
assert.equal(written("depth", "npy").slice(1, 6), "NUMPY");
assert.equal(written("objects", "npy").length, 128 + 160 * 120 * 4);
for (const [map, names] of [["depth", ["Z"]], ["objects", ["object"]], ["normals", ["N.X", "N.Y", "N.Z"]]]) {
  const exr = ask({ ask: "write", what: map, format: "exr" }).file, bytes = plane(exr), numbers = new DataView(bytes.buffer), latin = text(exr);
  const rows = bytes.length - 120 * (8 + 160 * 4 * names.length);
  assert.equal(numbers.getUint32(0, true), 20000630);
  names.forEach((name, i) => assert.ok(latin.indexOf(`${name}\0`) > (i ? latin.indexOf(`${names[i - 1]}\0`) : 0), "channels by name"));
  for (const y of [0, 60, 119]) {
    const at = Number(numbers.getBigUint64(rows - 8 * (120 - y), true));
    assert.deepEqual([numbers.getInt32(at, true), numbers.getInt32(at + 4, true)], [y, 160 * 4 * names.length]);
    // The EXR row equals the row of an NPY of the same map.
    if (names.length === 1) assert.equal(latin.slice(at + 8, at + 8 + 640), written(map, "npy").slice(128 + 640 * y, 128 + 640 * (y + 1)));
  }
}
assert.match(written("depth", "pfm"), /^Pf\n160 120\n/);
assert.equal(ask({ ask: "conventions" }).resolution[0], 160);

// Picks objects in a scene of two cubes, one behind the other.
{
  const { hits } = ask({ ask: "point", x: 80, y: 60 });
  assert.ok(hits.length >= 2 && hits[0].depth <= hits[1].depth);
  const { objects } = ask({ ask: "report" });
  assert.equal(objects.length, 2);
  for (const object of objects) assert.ok(Math.abs(object.visible_share + object.hidden_share + object.cut_share - 1) < 1e-9);
  const around = ask({ ask: "sphere", views: 8, size: 64 });
  assert.ok(around.ever_seen > 0 && around.ever_seen <= around.triangles);
  const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
  assert.deepEqual([sum(around.seen_by_object), sum(around.triangles_by_object), around.names.length], [around.ever_seen, around.triangles, 2]);
  assert.ok(objects.some((object) => object.hidden_by.some((hider) => hider.share > 0)));
}

// The library's own triangle numbers differ nowhere. If a number is replaced by that of the neighbour on the same side
// of a cube, only differences within two roundings of a border are explained by it.
{
  ask({ ask: "draw", camera });
  const { corners, matrix, view } = ask({ ask: "triangles" });
  const point = [...new Float32Array(plane(corners).buffer).slice(0, 3), 1], clip = matrix.map((row) => row.reduce((sum, value, i) => sum + value * point[i], 0));
  assert.ok(clip[3] > 0 && Math.abs(clip[2]) <= clip[3], "the first corner lies between near and far");
  const ids = new Uint32Array(plane(ask({ ask: "write", what: "primitives", format: "npy" }).file).slice(128).buffer), [width, height] = [160, 120];
  const numbers = ids.map((id) => id + 1);
  const compared = (given) => {
    const { counts, differences } = frontmost.give({ ask: "compare", view, subpixel_bits: 4 }, new Uint8Array(given.buffer));
    return { counts, list: new Float32Array(plane(differences).buffer) };
  };
  assert.deepEqual(compared(numbers).counts, { edge: 0, depth: 0, other: 0 });
  const moved = numbers.slice();
  let changed = 0;
  for (let i = 0; i + 1 < ids.length; ++i)
    if (i % width < width - 1 && numbers[i + 1] !== numbers[i]) {
      moved[i] = numbers[i + 1];
      ++changed;
    }
  const { counts, list } = compared(moved);
  assert.equal(counts.edge + counts.depth + counts.other, changed);
  assert.ok(counts.edge > 5 && counts.other > 5, JSON.stringify(counts));
  for (let i = 0; i < list.length; i += 7) {
    const [x, y, why, border, , ours, theirs] = list.subarray(i, i + 7);
    assert.deepEqual([ours + 1, theirs + 1], [numbers[y * width + x], moved[y * width + x]]);
    if (why === 0) assert.ok(border <= 2 / 16, `${border} pixels`);
  }
  // Takes a triangle behind the visible one, far from any border and from its depth.
  const far = numbers.slice(), at = (height / 2) * width + width / 2, [first, second] = ask({ ask: "point", x: width / 2, y: height / 2 }).hits;
  far[at] = second.primitive + 1;
  assert.equal(first.primitive, ids[at]);
  assert.deepEqual(compared(far).counts, { edge: 0, depth: 0, other: 1 });
  assert.throws(() => compared(numbers.slice(1)), /four bytes/);
  ask({ ask: "draw", camera });
  assert.throws(() => compared(numbers), /another view/);
}

// Files beside a model and in folders below it, and textures, which the page decodes.
{
  const bytes = (content) => new TextEncoder().encode(content), png = new Uint8Array([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10, 1, 2, 3]);
  const put = (name, content) => frontmost.give({ ask: "file", name }, content);
  const quad = "mtllib looks/quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3 4/4\n";
  const putAll = () => {
    put("quad.obj", bytes(quad));
    put("looks/quad.mtl", bytes("newmtl red\nmap_Kd red.png\n"));
    put("looks/red.png", png);
  };
  putAll();
  const { images } = ask({ ask: "open", name: "quad.obj" });
  assert.deepEqual(images.map((place) => [...plane(place)]), [[...png]]);
  assert.throws(() => frontmost.give({ ask: "image", number: 0, width: 2, height: 2 }, new Uint8Array(12)), /four bytes/);
  frontmost.give({ ask: "image", number: 0, width: 1, height: 2 }, new Uint8Array([10, 200, 30, 255, 10, 200, 30, 255]));
  const opened = ask({ ask: "open", again: true });
  assert.deepEqual([opened.name, opened.triangles, opened.warnings, opened.materials], ["quad", 2, [], ["red"]]);
  const flat = ask({ ask: "draw", camera: ask({ ask: "frame", width: 40, height: 40, view: "front" }), show: "flat" });
  assert.deepEqual([...plane(flat.pixels).slice(4 * (20 * 40 + 20), 4 * (20 * 40 + 20) + 4)], [10, 200, 30, 255]);
  // An undecodable image is a warning; the previous model's files are gone; names must not lead out of the folder.
  putAll();
  ask({ ask: "open", name: "quad.obj" });
  ask({ ask: "image", number: 0, problem: "not an image after all" });
  assert.match(ask({ ask: "open", again: true }).warnings.join(), /not an image after all/);
  put("quad.obj", bytes(quad));
  assert.match(ask({ ask: "open", name: "quad.obj" }).warnings.join(), /quad\.mtl/);
  // Files of a model that was never opened are gone, too.
  putAll();
  frontmost.give({ ask: "file", name: "quad.obj", first: true }, bytes(quad));
  assert.match(ask({ ask: "open", name: "quad.obj" }).warnings.join(), /quad\.mtl/);
  for (const name of ["../out.obj", "/out.obj", "-", ""]) assert.throws(() => put(name, bytes(quad)), /below the model's folder/, name);
  assert.throws(() => ask({ ask: "open", again: true }), /no model is being opened/);
}

// Opens fifty models in turn.
let after = 0;
for (let i = 0; i < 50; ++i) {
  ask({ ask: "builtin", name: i % 2 ? "teapot" : "gallery" });
  ask({ ask: "draw", camera, show: "flat" });
  if (i === 5) after = frontmost.memory().length;
}
assert.equal(frontmost.memory().length, after, "memory grows with every model");
console.log(`the lessons' numbers, four broken files, ten files written, 50 models in ${after / 2 ** 20} MiB`);
process.exit(0); // waiting threads would keep Node alive
