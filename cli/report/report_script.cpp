// SPDX-License-Identifier: Apache-2.0
// The script of the page. Names reach the page only as text nodes. Masks and the map of objects are runs. A run of the
// map is an object + 1 (0: none) and its number of pixels. A mask's runs are the numbers of outside, hidden and visible
// pixels of its box, in turn.
#include "cli/report/report_page.h"

namespace frontmost::cli {

std::string_view report_script() {
  return R"JS('use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const objects = new Map(data.objects.map(object => [object.object, object]));
const hides = new Map();
for (const object of data.objects)
  for (const [hider, count] of object.hidden_by) {
    if (!hides.has(hider)) hides.set(hider, []);
    hides.get(hider).push([object.object, count]);
  }
const map = new Int32Array(data.width * data.height);
for (let i = 0, at = 0; i < data.map.length; i += 2) {
  map.fill(data.map[i] - 1, at, at + data.map[i + 1]);
  at += data.map[i + 1];
}
const canvas = document.getElementById('overlay'), context = canvas.getContext('2d');
const outlines = document.getElementById('outlines'), panel = document.getElementById('panel');
let chosen = -1;

function hue(object) { return (object * 137 + 200) % 360; }
function rgb(object) {
  const f = n => {
    const k = (n + hue(object) / 30) % 12;
    return 255 * (0.55 - 0.4 * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  };
  return [f(0), f(8), f(4)];
}
function paint(pixels, i, color, alpha) {
  pixels[4 * i] = color[0], pixels[4 * i + 1] = color[1], pixels[4 * i + 2] = color[2], pixels[4 * i + 3] = alpha;
}
function drawMask(pixels, object) {
  const [x0, y0, width] = object.in_frame.box;
  let i = 0, kind = 0;
  for (const run of object.mask) {
    for (const end = i + run; i < end; ++i) {
      const at = (y0 + Math.floor(i / width)) * data.width + x0 + i % width;
      if (kind === 1) paint(pixels, at, rgb(map[at]), 190);
      if (kind === 2) paint(pixels, at, [255, 140, 0], 110);
    }
    kind = (kind + 1) % 3;
  }
}
function drawOutlines(pixels) {
  const t = Math.max(1, Math.round(data.width / 900));
  for (let y = 0; y + t < data.height; ++y)
    for (let x = 0; x + t < data.width; ++x) {
      const i = y * data.width + x;
      if (map[i] !== map[i + t] || map[i] !== map[i + t * data.width]) paint(pixels, i, [16, 18, 24], 200);
    }
}
function draw() {
  const image = context.createImageData(data.width, data.height);
  const object = objects.get(chosen);
  if (object) {
    for (let i = 0; i < map.length; ++i) image.data[4 * i + 3] = 120;
    if (object.mask) drawMask(image.data, object);
  }
  if (outlines.checked) drawOutlines(image.data);
  context.putImageData(image, 0, 0);
}

function element(tag, text, parent) {
  const made = document.createElement(tag);
  made.textContent = text;
  parent.append(made);
  return made;
}
function share(value) { return (100 * value).toFixed(1) + ' %'; }
function box(set) { return set.box ? set.box.slice(0, 2).join(', ') + ' · ' + set.box.slice(2).join(' × ') : ''; }
function listPairs(title, pairs, whole) {
  if (!pairs || pairs.length === 0) return;
  element('h3', title, panel);
  const list = element('ul', '', panel);
  for (const [number, count] of [...pairs].sort((a, b) => b[1] - a[1]).slice(0, 50)) {
    const item = element('li', '', list), key = element('i', '', item);
    key.className = 'key';
    key.style.background = 'rgb(' + rgb(number).map(Math.round).join(',') + ')';
    const button = element('button', objects.get(number).name, item);
    button.onclick = () => choose(number);
    element('span', count.toLocaleString('en') + (whole ? ' · ' + share(count / whole) : ''), item);
  }
  if (pairs.length > 50) element('li', pairs.length - 50 + ' more', list);
}
function describe(object) {
  panel.replaceChildren();
  if (!object) {
    element('p', panel.dataset.empty, panel);
    return;
  }
  element('h2', object.name, panel);
  element('p', 'object ' + object.object + (object.cut_by_near ? ', cut by the near plane' : ''), panel);
  element('p', object.why, panel).className = 'why';
  const list = element('dl', '', panel);
  const row = (name, text) => {
    element('dt', name, list);
    element('dd', text, list);
  };
  for (const [name, set] of [['visible samples', object.visible], ['in frame', object.in_frame], ['alone', object.alone]]) {
    row(name, set.samples.toLocaleString('en'));
    if (set.box) row('box', box(set));
  }
  row('visible share', share(object.visible_share));
  row('hidden share', share(object.hidden_share));
  row('cut by the frame', share(object.cut_share));
  if (object.distance !== null) row('distance', String(+object.distance.toPrecision(6)));
  if (object.centroid) row('centroid', object.centroid.map(c => c.toFixed(1)).join(', '));
  listPairs('Hidden by', object.hidden_by, object.alone.samples);
  listPairs('Hides', hides.get(object.object), 0);
}
function choose(number) {
  chosen = number === chosen ? -1 : number;
  for (const marked of document.querySelectorAll('.chosen')) marked.classList.remove('chosen');
  for (const found of document.querySelectorAll(
      'tr[data-object="' + chosen + '"], g[data-object="' + chosen + '"], path[data-hider="' + chosen +
      '"], path[data-hidden="' + chosen + '"]'))
    found.classList.add('chosen');
  describe(objects.get(chosen));
  draw();
}
canvas.onclick = event => {
  const x = Math.floor(event.offsetX * data.width / canvas.clientWidth);
  const y = Math.floor(event.offsetY * data.height / canvas.clientHeight);
  const found = map[Math.min(y, data.height - 1) * data.width + Math.min(x, data.width - 1)];
  if (found >= 0 || chosen >= 0) choose(found >= 0 ? found : chosen);
};
for (const place of document.querySelectorAll('tbody tr, g.node'))
  place.onclick = () => {
    choose(Number(place.dataset.object));
    canvas.scrollIntoView({block: 'nearest', behavior: 'smooth'});
  };
outlines.onchange = draw;

function cellKey(row, column) {
  const text = row.cells[column].textContent;
  const number = parseFloat(text.replaceAll(',', ''));
  return column === 0 || column === row.cells.length - 1 ? text : isNaN(number) ? Infinity : number;
}
document.querySelectorAll('thead button').forEach((button, column) => {
  button.onclick = () => {
    const head = button.parentNode, body = document.querySelector('tbody');
    // Names go up first, numbers down.
    const isText = column === 0 || column === head.parentNode.cells.length - 1;
    const before = head.getAttribute('aria-sort');
    const sign = (before ? before === 'descending' : isText) ? 1 : -1;
    for (const other of head.parentNode.cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
    const rows = [...body.rows].map(row => [cellKey(row, column), row]);
    rows.sort(([a], [b]) => sign * (isText ? a.localeCompare(b, 'en', {numeric: true}) : a === b ? 0 : a < b ? -1 : 1));
    body.append(...rows.map(pair => pair[1]));
  };
});
describe(null);
draw();
)JS";
}

}  // namespace frontmost::cli
