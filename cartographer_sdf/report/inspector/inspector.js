// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Shows the document of a run (docs/inspection.schema.json). Poses are
// {x, y, yaw} in metres and radians; T_a_b takes coordinates in b to a.
"use strict";
(() => {
const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("document").textContent);

// --- Elements. ---

// Texts are set as texts, never as markup.
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === false) continue;
    if (name === "on") {
      for (const [event, handler] of Object.entries(value)) element.addEventListener(event, handler);
    } else {
      element.setAttribute(name, value === true ? "" : value);
    }
  }
  element.append(...children);
  return element;
}

const SIGNS = {good: "\u2713", neutral: "\u2022", caution: "!", bad: "\u2717"};

// --- Poses. ---

function compose(a, b) {
  const c = Math.cos(a.yaw), s = Math.sin(a.yaw);
  return {x: a.x + c * b.x - s * b.y, y: a.y + s * b.x + c * b.y, yaw: a.yaw + b.yaw};
}
function inverse(a) {
  const c = Math.cos(a.yaw), s = Math.sin(a.yaw);
  return {x: -c * a.x - s * a.y, y: s * a.x - c * a.y, yaw: -a.yaw};
}
function apply(a, [x, y]) {
  const c = Math.cos(a.yaw), s = Math.sin(a.yaw);
  return [a.x + c * x - s * y, a.y + s * x + c * y];
}

// --- Colours: Okabe and Ito; shapes and dashes say the same. ---

const TONE_COLORS = {good: "#0072b2", neutral: "#5b6570", caution: "#b36b00", bad: "#c23b00"};
const PHASES = {
  searching: {color: "#d55e00", dash: [7, 5]},
  located: {color: "#0072b2", dash: []},
  lost: {color: "#8a2be2", dash: [2, 4]}};
const PAPER = "#ffffff", INK = "#1b1f24";
const DASHES = [[], [8, 4], [2, 4], [10, 3, 2, 3]];
// Another dash where the colours of paths begin again.
const dashOf = (number) => DASHES[
  run.paths.slice(0, number).filter((path) => path.color === run.paths[number].color).length % DASHES.length];
const REFERENCE = [13, 59, 140], QUERY = [196, 78, 0], BOTH = [26, 26, 26], CONFLICT = [204, 0, 170];
// Cividis, from dark to light.
const SCALE = ["#00204d", "#31446b", "#666970", "#958f78", "#cab969", "#ffea46"];
const hex = (parts) => `#${parts.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
// Of "#rrggbb", as WCAG 2.1 defines it.
function brightnessOf(color) {
  const [r, g, b] = [1, 3, 5].map((k) => {
    const part = parseInt(color.slice(k, k + 2), 16) / 255;
    return part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
// What a line of this colour is edged with: it stands out from its edge, and so
// from any ground.
const edgeOf = (color) => brightnessOf(color) < 0.3 ? PAPER : INK;
const scaleColor = (fraction) =>
  SCALE[Math.min(SCALE.length - 1, Math.max(0, Math.floor(fraction * SCALE.length)))];

// --- The document. ---

const states = run.states;
const lastState = states.length - 1;
const statusOf = (table, row) =>
  table.statuses.find((status) => status.name === row.status) ||
  {name: row.status, label: row.status, tone: "neutral", meaning: "", option: ""};
const submapName = (k) => {
  const submap = run.submaps[k];
  if (!submap) return "?";
  const id = `${submap.trajectory},${submap.index}`;
  return run.sessions.length > 1 ? `${id} (${run.sessions[submap.session].name})` : id;
};
const shortName = (k) => run.submaps[k] ? `${run.submaps[k].trajectory},${run.submaps[k].index}` : "?";
const isPair = (row) => row.reference !== undefined;

run.tables.forEach((table) => table.rows.forEach((row, k) => {
  row.number = k + 1;
  row.table = table;
  row.state = statusOf(table, row);
  if (row.constraints) row.drop = row.constraints.some((c) => c.dropped);
}));

function formatValue(measure, value) {
  if (value === null || value === undefined) return "\u2013";
  const unit = measure.unit ? `\u00a0${measure.unit}` : "";
  const step = 10 ** -measure.decimals;
  // Nothing is certain, nor impossible.
  if (measure.name === "probability" && value >= 100 - step / 2) return `>\u00a0${(100 - step).toFixed(measure.decimals)}${unit}`;
  if (measure.name === "probability" && value < step / 2) return `<\u00a0${step.toFixed(measure.decimals)}${unit}`;
  return value.toFixed(measure.decimals) + unit;
}
function passes(measure, value) {
  if (measure.bound === "none" || value === null || value === undefined) return null;
  return measure.bound === "at_least" ? value >= measure.threshold : value <= measure.threshold;
}
function boundText(measure) {
  if (measure.bound === "none") return "";
  const words = measure.bound === "at_least" ? "at least" : "at most";
  return `${words} ${formatValue(measure, measure.threshold)}`;
}

// --- Where a row is on the map, in a state: the place where the walls overlap,
// by either submap. One point where both agree. ---

function placesOf(row, state) {
  if (row.T_map_robot) return [[row.T_map_robot.x, row.T_map_robot.y]];
  if (!isPair(row) || !row.p_reference_overlap) return [];
  const reference = run.submaps[row.reference], query = run.submaps[row.query];
  const T_reference = reference && reference.T_map_submap[state];
  const T_query = query && query.T_map_submap[state];
  if (!T_reference || !T_query) return [];
  const p_query = apply(inverse(row.T_reference_query), row.p_reference_overlap);
  return [apply(T_reference, row.p_reference_overlap), apply(T_query, p_query)];
}

// --- Pictures. ---

function loadImage(source) {
  return new Promise((resolve) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => resolve(null);
    image.src = source;
  });
}
function canvasOf(width, height) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  return canvas;
}
// 0: unknown, 1: free, 2: wall; null without a picture.
async function classesOf(k) {
  const picture = run.submaps[k] && run.submaps[k].picture;
  if (!picture) return null;
  if (!picture.classes) {
    const image = await loadImage(picture.data);
    if (!image) return null;
    const context = canvasOf(picture.width, picture.height).getContext("2d", {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    const {data} = context.getImageData(0, 0, picture.width, picture.height);
    picture.classes = new Uint8Array(picture.width * picture.height);
    for (let i = 0; i < picture.classes.length; ++i) {
      picture.classes[i] = data[4 * i + 3] < 128 ? 0 : data[4 * i] > 128 ? 1 : 2;
    }
  }
  return picture;
}
function tinted(picture, [r, g, b]) {
  const canvas = canvasOf(picture.width, picture.height);
  const context = canvas.getContext("2d");
  const pixels = context.createImageData(picture.width, picture.height);
  picture.classes.forEach((kind, i) => {
    pixels.data.set([r, g, b, kind === 2 ? 255 : kind === 1 ? 40 : 0], 4 * i);
  });
  context.putImageData(pixels, 0, 0);
  return canvas;
}

// --- The map. ---

const canvas = byId("map");
const view = {x: 0, y: 0, scale: 1, width: 1, height: 1};
const shown = {
  sessions: run.sessions.map(() => true), conflicts: true, paths: true, pathColor: "trajectory",
  statuses: new Set(), errors: false, candidates: true, changes: true};
const map = {images: [], conflicts: [], wipe: 50, wipeIsTouched: false};
let selected = null, pointed = null, current = run.tables.length > 0 ? run.tables[0] : null;
const statusKey = (row) => `${row.table.name}/${row.status}`;

const toScreen = ([x, y]) => [
  (x - view.x) * view.scale + view.width / 2, (view.y - y) * view.scale + view.height / 2];
const toMap = ([x, y]) => [
  (x - view.width / 2) / view.scale + view.x, view.y - (y - view.height / 2) / view.scale];

async function loadMaps() {
  for (let k = 0; k < states.length; ++k) {
    const picture = byId(`map-${k}`);
    if (!picture) continue;
    await picture.decode().catch(() => {});
    const images = states[k].pictures.length > 0
      ? await Promise.all(states[k].pictures.map(loadImage)) : [picture];
    map.images[k] = images.map((image) => image && levelsOf(image));
    map.conflicts[k] = states[k].pictures.length > 0 ? conflictsOf(picture) : null;
  }
}
// The picture, at a half and at a quarter of its size: of four pixels the
// darkest, so that thin walls do not fade.
function levelsOf(image) {
  const levels = [image];
  let pixels = pixelsOf(image, run.frame.width, run.frame.height);
  for (let k = 0; k < 2; ++k) {
    pixels = halfOf(pixels);
    const level = canvasOf(pixels.width, pixels.height);
    level.getContext("2d").putImageData(pixels, 0, 0);
    levels.push(level);
  }
  return levels;
}
function pixelsOf(image, width, height) {
  const context = canvasOf(width, height).getContext("2d", {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height);
}
function halfOf({data, width, height}) {
  const half = new ImageData(Math.max(1, width >> 1), Math.max(1, height >> 1));
  const source = new Uint32Array(data.buffer), target = new Uint32Array(half.data.buffer);
  // Unknown ones count as the brightest.
  const brightness = (k) => data[4 * k + 3] === 0 ? 1000 : data[4 * k] + data[4 * k + 1] + data[4 * k + 2];
  for (let y = 0; y < half.height; ++y) {
    for (let x = 0; x < half.width; ++x) {
      let best = Math.min(2 * y, height - 1) * width + Math.min(2 * x, width - 1);
      for (const [dx, dy] of [[1, 0], [0, 1], [1, 1]]) {
        if (2 * x + dx >= width || 2 * y + dy >= height) continue;
        const k = (2 * y + dy) * width + 2 * x + dx;
        if (brightness(k) < brightness(best)) best = k;
      }
      target[y * half.width + x] = source[best];
    }
  }
  return half;
}
// The pixels that the picture of all sessions has in the colour of conflicts.
function conflictsOf(picture) {
  const result = canvasOf(run.frame.width, run.frame.height);
  const pixels = pixelsOf(picture, result.width, result.height);
  const {data} = pixels;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] === 230 && data[i + 1] === 26 && data[i + 2] === 26) continue;
    data[i + 3] = 0;
  }
  result.getContext("2d").putImageData(pixels, 0, 0);
  return result;
}

function fit(left, bottom, right, top, margin) {
  view.x = (left + right) / 2;
  view.y = (bottom + top) / 2;
  view.scale = Math.min(view.width / Math.max(0.1, right - left + 2 * margin),
                        view.height / Math.max(0.1, top - bottom + 2 * margin));
}
function showAll() {
  if (!run.frame) return;
  const width = run.frame.width / run.frame.pixels_per_meter;
  const height = run.frame.height / run.frame.pixels_per_meter;
  fit(run.frame.left, run.frame.top - height, run.frame.left + width, run.frame.top, 0);
}
function zoom(factor, at) {
  const before = toMap(at);
  view.scale = Math.min(2000, Math.max(0.5, view.scale * factor));
  const after = toMap(at);
  view.x += before[0] - after[0];
  view.y += before[1] - after[1];
  draw();
}

function drawPictures(context, k) {
  if (!run.frame || !map.images[k]) return;
  const [left, top] = toScreen([run.frame.left, run.frame.top]);
  const factor = view.scale / run.frame.pixels_per_meter;
  context.imageSmoothingEnabled = factor * devicePixelRatio < 1.5;
  const put = (image) => context.drawImage(image, left, top, run.frame.width * factor, run.frame.height * factor);
  const level = factor * devicePixelRatio > 0.7 ? 0 : factor * devicePixelRatio > 0.35 ? 1 : 2;
  const putLevel = (levels) => put(levels[level]);
  const visible = map.images[k].filter((image, session) => image && shown.sessions[session]);
  visible.forEach(putLevel);
  if (visible.length > 1) {
    // Walls of one session show through the free space of another.
    context.globalCompositeOperation = "darken";
    visible.forEach(putLevel);
    context.globalCompositeOperation = "source-over";
  }
  if (map.conflicts[k] && shown.conflicts && visible.length > 1) put(map.conflicts[k]);
}

function strokePath(context, points, color, dash, width) {
  for (const [style, extra, pattern] of [[edgeOf(color), 2, []], [color, 0, dash]]) {
    context.beginPath();
    points.forEach(([x, y], k) => (k === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.strokeStyle = style;
    context.lineWidth = width + extra;
    context.setLineDash(pattern);
    context.stroke();
  }
  context.setLineDash([]);
}
// Pieces of a path that are drawn alike, each beginning where the last ended.
function* piecesOf(path, k, lookOf) {
  let piece = [], look = null;
  for (let n = 0; n < path.positions[k].length; ++n) {
    const position = path.positions[k][n];
    if (!position) continue;
    const point = toScreen(position), next = lookOf(n);
    if (look !== null && next.color !== look.color) {
      piece.push(point);
      yield [piece, look];
      piece = [];
    }
    piece.push(point);
    look = next;
  }
  if (look !== null) yield [piece, look];
}
function drawPaths(context, k) {
  if (!shown.paths) return;
  run.paths.forEach((path, number) => {
    if (!shown.sessions[path.session]) return;
    const longest = Math.max(1, path.seconds[path.seconds.length - 1]);
    const plain = {color: path.color, dash: dashOf(number)};
    const lookOf = (n) => {
      if (shown.pathColor === "time") return {color: scaleColor(path.seconds[n] / longest), dash: []};
      if (shown.pathColor === "state" && path.phases.length > 0) {
        return PHASES[run.phases[path.phases[n]]] || plain;
      }
      return plain;
    };
    for (const [points, look] of piecesOf(path, k, lookOf)) {
      strokePath(context, points, look.color, look.dash, 1.8);
    }
    const ends = path.positions[k].filter((position) => position);
    if (ends.length === 0) return;
    const {color} = lookOf(path.seconds.length - 1);
    dot(context, toScreen(ends[0]), 4, edgeOf(color), color);
    dot(context, toScreen(ends[ends.length - 1]), 4, color, edgeOf(color));
  });
}
function dot(context, [x, y], radius, fill, outline) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = outline;
  context.stroke();
}

// Circle: good; triangle: caution; cross: bad; square: neutral.
function mark(context, [x, y], tone, size) {
  const color = TONE_COLORS[tone];
  context.beginPath();
  if (tone === "good") {
    context.arc(x, y, size, 0, 2 * Math.PI);
  } else if (tone === "caution") {
    context.moveTo(x, y - 1.2 * size);
    context.lineTo(x + 1.15 * size, y + size);
    context.lineTo(x - 1.15 * size, y + size);
    context.closePath();
  } else if (tone === "bad") {
    for (const [width, style] of [[5, PAPER], [2.8, color]]) {
      context.beginPath();
      context.moveTo(x - size, y - size);
      context.lineTo(x + size, y + size);
      context.moveTo(x + size, y - size);
      context.lineTo(x - size, y + size);
      context.lineWidth = width;
      context.strokeStyle = style;
      context.stroke();
    }
    return;
  } else {
    context.rect(x - 0.8 * size, y - 0.8 * size, 1.6 * size, 1.6 * size);
  }
  context.fillStyle = tone === "neutral" ? PAPER : color;
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = tone === "neutral" ? color : PAPER;
  context.stroke();
}
function drawRow(context, row, k, size) {
  const points = placesOf(row, k).map(toScreen);
  if (points.length === 0) return;
  if (points.length === 2 && Math.hypot(points[0][0] - points[1][0], points[0][1] - points[1][1]) > size) {
    strokePath(context, points, TONE_COLORS[row.state.tone], row.state.tone === "good" ? [] : [5, 3], 1.5);
    mark(context, points[1], row.state.tone, size);
  }
  mark(context, points[0], row.state.tone, size);
}
// All rows with a place on the map that a layer shows.
function visibleRows() {
  return run.tables.flatMap((table) => table.rows.filter(
    (row) => isPair(row) && shown.statuses.has(statusKey(row)) && isRowShown(row)));
}
function isRowShown(row) {
  return [row.reference, row.query].every((k) => !run.submaps[k] || shown.sessions[run.submaps[k].session]);
}

function drawErrors(context, k) {
  if (!shown.errors) return;
  const largest = largestError();
  for (const submap of run.submaps) {
    const pose = submap.T_map_submap[k];
    const error = submap.mean_errors[k];
    if (!pose || !shown.sessions[submap.session] || (error === null && !submap.flaw)) continue;
    const point = toScreen(apply(pose, centreOf(submap)));
    if (error !== null) dot(context, point, 4 + 8 * Math.min(1, error / largest), scaleColor(error / largest), edgeOf(scaleColor(error / largest)));
    if (submap.flaw) text(context, "! torn", [point[0] + 8, point[1] - 8], "#c23b00");
  }
}
function largestError() {
  // Beyond it, all are bad alike.
  const errors = run.submaps.map((submap) => submap.mean_errors[lastState] || 0);
  return Math.max(0.1, ...errors);
}
function centreOf(submap) {
  const {picture} = submap;
  if (!picture) return [0, 0];
  return apply(picture.T_submap_picture, [picture.width * picture.resolution / 2, picture.height * picture.resolution / 2]);
}

function text(context, words, [x, y], color) {
  context.font = "600 13px system-ui, sans-serif";
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = PAPER;
  context.strokeText(words, x, y);
  context.fillStyle = color;
  context.fillText(words, x, y);
}
function drawArrow(context, row, isStrong) {
  const pose = row.T_map_robot;
  const length = Math.max(26, 1.2 * view.scale) / view.scale;
  const at = (x, y) => toScreen(apply(pose, [x * length, y * length]));
  const color = TONE_COLORS[row.state.tone];
  for (const [width, style] of [[isStrong ? 9 : 6, PAPER], [isStrong ? 5 : 2.5, color]]) {
    context.beginPath();
    context.moveTo(...at(0, 0));
    context.lineTo(...at(1, 0));
    context.moveTo(...at(0.65, 0.22));
    context.lineTo(...at(1, 0));
    context.lineTo(...at(0.65, -0.22));
    context.lineWidth = width;
    context.strokeStyle = style;
    context.lineCap = "round";
    context.setLineDash(row.state.tone === "neutral" && style === color ? [4, 4] : []);
    context.stroke();
  }
  context.setLineDash([]);
  context.lineCap = "butt";
  dot(context, at(0, 0), isStrong ? 6 : 4, color, PAPER);
  const [x, y] = at(0, 0);
  text(context, labelOfCandidate(row), [x + 9, y - 9], color);
}
function labelOfCandidate(row) {
  const k = row.table.measures.findIndex((measure) => measure.name === "probability");
  const share = k < 0 ? "" : ` ${formatValue(row.table.measures[k], row.values[k])}`;
  const sign = row.state.tone === "good" ? "\u2713 " : "";
  return `${sign}${row.number}${share ? ":" : ""}${share}`;
}
function candidateRows() {
  return run.tables.flatMap((table) => table.rows.filter((row) => row.T_map_robot));
}
function drawCandidates(context) {
  if (!shown.candidates) return;
  const rows = candidateRows();
  const k = rows.length > 0 ? rows[0].table.measures.findIndex((m) => m.name === "probability") : -1;
  // Improbable ones only where somebody points at them.
  const drawn = rows.filter((row, n) => n < 8 || k < 0 || row.values[k] >= 1 || row === selected || row === pointed);
  for (const row of [...drawn].reverse()) {
    if (row !== selected) drawArrow(context, row, row.state.tone === "good");
  }
  if (selected && selected.T_map_robot) drawArrow(context, selected, true);
  const best = selected && selected.T_map_robot ? selected : rows[0];
  if (best) drawEchoes(context, best.T_map_robot, toScreen, 2);
}
function drawEchoes(context, pose, project, size) {
  context.fillStyle = "rgb(196 78 0)";
  for (const echo of run.echoes) {
    const [x, y] = project(apply(pose, echo));
    context.fillRect(x - size / 2, y - size / 2, size, size);
  }
}

function drawTinted(context, k, tint, state) {
  const submap = run.submaps[k];
  if (!submap || !submap.picture || !submap.picture[tint] || !submap.T_map_submap[state]) return;
  const pose = compose(submap.T_map_submap[state], submap.picture.T_submap_picture);
  const [x, y] = toScreen([pose.x, pose.y]);
  const size = submap.picture.resolution * view.scale;
  const c = Math.cos(pose.yaw) * size, s = Math.sin(pose.yaw) * size;
  context.save();
  context.transform(c, -s, -s, -c, x, y);
  context.imageSmoothingEnabled = size * devicePixelRatio < 1;
  context.drawImage(submap.picture[tint], 0, 0);
  context.restore();
}
function drawSelection(context, k) {
  if (selected && isPair(selected)) {
    drawTinted(context, selected.reference, "asReference", k);
    drawTinted(context, selected.query, "asQuery", k);
  }
}
function drawPointed(context, k) {
  for (const row of [selected, pointed]) {
    if (!row) continue;
    // For programs that read the page, such as its test.
    if (row === selected) canvas.dataset.selection = JSON.stringify(placesOf(row, lastState).map(toScreen));
    if (isPair(row)) drawRow(context, row, k, 7);
    for (const place of placesOf(row, k)) {
      const [x, y] = toScreen(place);
      context.beginPath();
      context.arc(x, y, 15, 0, 2 * Math.PI);
      for (const [width, style] of [[5, PAPER], [2.5, INK]]) {
        context.lineWidth = width;
        context.strokeStyle = style;
        context.stroke();
      }
    }
  }
}

// Solid: appeared; dashed: vanished.
const CHANGES = {appeared: {color: "#c44e00", dash: []}, vanished: {color: "#0d3b8c", dash: [5, 4]}};
function drawChanges(context) {
  if (!shown.changes) return;
  for (const change of run.changes) {
    const look = CHANGES[change.kind] || CHANGES.appeared;
    const margin = 0.15;
    const corners = [[change.x_min - margin, change.y_min - margin], [change.x_max + margin, change.y_min - margin],
                     [change.x_max + margin, change.y_max + margin], [change.x_min - margin, change.y_max + margin],
                     [change.x_min - margin, change.y_min - margin]];
    strokePath(context, corners.map(toScreen), look.color, look.dash, 2);
  }
}
function drawState(context, k) {
  drawPictures(context, k);
  if (k === lastState) drawChanges(context);
  drawSelection(context, k);
  drawPaths(context, k);
  drawErrors(context, k);
  for (const row of visibleRows()) drawRow(context, row, k, 5);
  if (k === lastState) drawCandidates(context);
  drawPointed(context, k);
}
function roundLength(length) {
  const magnitude = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((factor) => factor * magnitude <= length) * magnitude;
}
function drawScale(context) {
  const length = roundLength(Math.min(160, 0.35 * view.width) / view.scale);
  const pixels = length * view.scale, x = 14, y = view.height - 14;
  context.fillStyle = PAPER;
  context.fillRect(x - 3, y - 5, pixels + 6, 10);
  context.fillStyle = INK;
  context.fillRect(x, y - 2, pixels, 4);
  text(context, length >= 1 ? `${length} m` : `${Math.round(100 * length)} cm`, [x, y - 9], INK);
}
function dividerX() { return view.width * map.wipe / 100; }
function drawDivider(context) {
  if (states.length < 2) return;
  const x = dividerX();
  if (map.wipe > 12) text(context, states[0].label, [12, 22], INK);
  if (map.wipe < 88) {
    const words = states[lastState].label;
    text(context, words, [Math.max(x + 10, 12), 22], INK);
  }
  if (map.wipe <= 0 || map.wipe >= 100) return;
  context.fillStyle = PAPER;
  context.fillRect(x - 2.5, 0, 5, view.height);
  context.fillStyle = "#005f99";
  context.fillRect(x - 1, 0, 2, view.height);
  dot(context, [x, view.height / 2], 11, "#005f99", PAPER);
  text(context, "\u2194", [x - 7, view.height / 2 + 5], "#005f99");
}
function drawNow() {
  const context = canvas.getContext("2d");
  const ratio = devicePixelRatio || 1;
  // A drawing starts with the same state whatever was drawn before it.
  context.save();
  context.lineJoin = "round";
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, view.width, view.height);
  const parts = states.length > 1
    ? [[0, 0, dividerX()], [lastState, dividerX(), view.width]] : [[0, 0, view.width]];
  for (const [k, begin, end] of parts) {
    if (end <= begin || states.length === 0) continue;
    context.save();
    context.beginPath();
    context.rect(begin, 0, end - begin, view.height);
    context.clip();
    drawState(context, k);
    context.restore();
  }
  drawDivider(context);
  drawScale(context);
  context.restore();
}
let isWaiting = false;
function draw() {
  if (isWaiting) return;
  isWaiting = true;
  requestAnimationFrame(() => {
    isWaiting = false;
    drawNow();
  });
}
function resize() {
  const {clientWidth, clientHeight} = canvas;
  if (clientWidth === 0) return;
  const ratio = devicePixelRatio || 1;
  const isFirst = view.width === 1;
  view.width = clientWidth;
  view.height = clientHeight;
  canvas.width = Math.round(clientWidth * ratio);
  canvas.height = Math.round(clientHeight * ratio);
  if (isFirst) showAll();
  draw();
}
function setWipe(percent, isByHand) {
  map.wipe = Math.min(100, Math.max(0, percent));
  map.wipeIsTouched = map.wipeIsTouched || isByHand;
  byId("wipe").value = map.wipe;
  draw();
}

// --- Pointers and keys on the map. ---

// The row whose place is nearest to a point of the screen, within reach.
function rowAt(point) {
  const state = states.length > 1 && point[0] < dividerX() ? 0 : lastState;
  const near = (rows, reach) => {
    let best = null, least = reach;
    for (const row of rows) {
      for (const place of placesOf(row, state)) {
        const [x, y] = toScreen(place);
        const distance = Math.hypot(x - point[0], y - point[1]);
        if (distance < least) [best, least] = [row, distance];
      }
    }
    return best;
  };
  return near([...visibleRows(), ...(shown.candidates ? candidateRows() : [])], 14) ||
    near(current ? currentRows().filter(isPair) : [], 20);
}
function listenToMap() {
  const pointers = new Map();
  let moved = 0, isWiping = false;
  const pointOf = (event) => [event.offsetX, event.offsetY];
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, pointOf(event));
    moved = 0;
    isWiping = states.length > 1 && map.wipe > 0 && map.wipe < 100 &&
      Math.abs(pointOf(event)[0] - dividerX()) < 12;
  });
  canvas.addEventListener("pointermove", (event) => {
    const point = pointOf(event), [x, y] = toMap(point);
    byId("coordinates").textContent = `x ${x.toFixed(2)} m, y ${y.toFixed(2)} m`;
    const last = pointers.get(event.pointerId);
    if (!last) return pointTo(rowAt(point));
    moved += Math.hypot(point[0] - last[0], point[1] - last[1]);
    if (isWiping) {
      setWipe(100 * point[0] / view.width, true);
    } else if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const span = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]);
      zoom(span(point) / Math.max(1, span(last)), other);
    } else {
      view.x -= (point[0] - last[0]) / view.scale;
      view.y += (point[1] - last[1]) / view.scale;
      draw();
    }
    pointers.set(event.pointerId, point);
  });
  const end = (event) => {
    if (pointers.delete(event.pointerId) && moved < 5 && event.type === "pointerup") {
      const row = rowAt(pointOf(event));
      if (row) select(row, false);
    }
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointerleave", () => {
    byId("coordinates").textContent = "";
    pointTo(null);
  });
  canvas.addEventListener("wheel", (event) => {
    // Otherwise the page could not be scrolled past the map.
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    zoom(Math.exp(-0.0015 * event.deltaY), pointOf(event));
  }, {passive: false});
  canvas.addEventListener("dblclick", (event) => zoom(2, pointOf(event)));
  canvas.addEventListener("keydown", (event) => {
    const step = 0.12, middle = [view.width / 2, view.height / 2];
    const actions = {
      "+": () => zoom(1.4, middle), "=": () => zoom(1.4, middle), "-": () => zoom(1 / 1.4, middle),
      "0": () => (showAll(), draw()),
      ArrowLeft: () => { view.x -= step * view.width / view.scale; draw(); },
      ArrowRight: () => { view.x += step * view.width / view.scale; draw(); },
      ArrowUp: () => { view.y += step * view.height / view.scale; draw(); },
      ArrowDown: () => { view.y -= step * view.height / view.scale; draw(); }};
    if (event.ctrlKey || event.altKey || event.metaKey || !actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
  byId("zoom-in").addEventListener("click", () => zoom(1.5, [view.width / 2, view.height / 2]));
  byId("zoom-out").addEventListener("click", () => zoom(1 / 1.5, [view.width / 2, view.height / 2]));
  byId("zoom-all").addEventListener("click", () => { showAll(); draw(); });
}
function listenToWipe() {
  if (states.length < 2) return;
  byId("wipe-row").hidden = false;
  const first = byId("wipe-first"), last = byId("wipe-last");
  first.textContent = `Only ${states[0].label.toLowerCase()}`;
  last.textContent = `Only ${states[lastState].label.toLowerCase()}`;
  first.addEventListener("click", () => setWipe(100, true));
  last.addEventListener("click", () => setWipe(0, true));
  byId("wipe").addEventListener("input", (event) => setWipe(Number(event.target.value), true));
}

// --- Layers. ---

function keyOf(drawKey) {
  const key = canvasOf(36, 36);
  key.className = "key";
  key.setAttribute("aria-hidden", "true");
  const context = key.getContext("2d");
  context.scale(2, 2);
  drawKey(context);
  return key;
}
function layerBox(label, isOn, onChange, key) {
  const box = make("input", {type: "checkbox", on: {change: (event) => { onChange(event.target.checked); draw(); }}});
  box.checked = isOn;
  return make("label", {}, box, " ", ...(key ? [key] : []), label);
}
function group(name, ...boxes) {
  byId("layers").append(make("fieldset", {}, make("legend", {}, name), ...boxes));
}
const swatch = (color) => keyOf((context) => {
  context.fillStyle = edgeOf(color);
  context.fillRect(1, 1, 16, 16);
  context.fillStyle = color;
  context.fillRect(2.5, 2.5, 13, 13);
});
function listSessions() {
  if (run.sessions.length < 2) return;
  group("Maps", ...run.sessions.map((session, k) => layerBox(
    `${k + 1}: ${session.name}`, true, (isOn) => { shown.sessions[k] = isOn; }, swatch(session.color))),
    layerBox("walls in free space of another", true, (isOn) => { shown.conflicts = isOn; }, swatch("#e61a1a")));
}
function listPaths() {
  if (run.paths.length === 0) return;
  const hasPhases = run.phases.length > 0;
  shown.pathColor = hasPhases ? "state" : "trajectory";
  const choices = [["trajectory", "by trajectory"], ["time", "by time (dark to light)"],
                   ...(hasPhases ? [["state", "by state"]] : [])];
  const choice = make("select", {"aria-label": "Colour of the paths", on: {change: (event) => {
    shown.pathColor = event.target.value;
    draw();
  }}}, ...choices.map(([value, label]) => make("option", {value}, label)));
  choice.value = shown.pathColor;
  const keys = run.phases.map((name) => make("span", {}, keyOf((context) => {
    const look = PHASES[name] || {color: "#000000", dash: []};
    strokePath(context, [[0, 9], [18, 9]], look.color, look.dash.map((d) => d / 2), 3);
  }), name));
  group("Paths", layerBox("driven paths", true, (isOn) => { shown.paths = isOn; }), choice, ...keys);
}
function listStatuses() {
  for (const table of run.tables) {
    const boxes = table.statuses.map((status) => {
      const rows = table.rows.filter((row) => row.status === status.name && isPair(row));
      if (rows.length === 0) return null;
      const key = `${table.name}/${status.name}`;
      return layerBox(`${status.label} (${rows.length})`, false, (isOn) => {
        if (isOn) shown.statuses.add(key); else shown.statuses.delete(key);
      }, keyOf((context) => mark(context, [9, 9], status.tone, 6)));
    }).filter((box) => box);
    if (boxes.length > 0) group(table.heading, ...boxes);
  }
}
function listOthers() {
  const boxes = [];
  if (run.submaps.some((submap) => submap.mean_errors.some((error) => error !== null) || submap.flaw)) {
    boxes.push(layerBox(`quality of submaps: mean error of constraints, dark and small 0, light and large ${
      largestError().toFixed(2)} m; ! torn`, false, (isOn) => { shown.errors = isOn; }));
  }
  for (const [kind, look] of run.changes.length > 0 ? Object.entries(CHANGES) : []) {
    const number = run.changes.filter((change) => change.kind === kind).length;
    boxes.push(make("span", {}, keyOf((context) => strokePath(
      context, [[2, 2], [16, 2], [16, 16], [2, 16], [2, 2]], look.color, look.dash.map((d) => d / 2), 2)), `${kind} (${number})`));
  }
  if (run.changes.length > 0) {
    boxes.push(layerBox("changed here", true, (isOn) => { shown.changes = isOn; }));
  }
  if (candidateRows().length > 0) {
    boxes.push(layerBox("candidates, with their probability", true, (isOn) => { shown.candidates = isOn; }));
  }
  if (boxes.length > 0) group("Also", ...boxes);
}

// --- The table. ---

const order = {measure: -1, isDescending: false};
function textOf(row) {
  const names = isPair(row) ? [submapName(row.reference), submapName(row.query)] : [];
  return [row.number, row.status, row.state.label, row.remark || "", ...names].join(" ").toLowerCase();
}
function currentRows() {
  const words = byId("filter").value.toLowerCase().split(/\s+/).filter((word) => word);
  const status = byId("status-filter").value;
  const rows = current.rows.filter((row) => (!status || row.status === status) &&
    words.every((word) => textOf(row).includes(word)));
  if (order.measure < 0) return rows;
  const value = (row) => {
    const number = row.values[order.measure];
    return number === null || number === undefined ? (order.isDescending ? -Infinity : Infinity) : number;
  };
  return rows.sort((a, b) => (order.isDescending ? value(b) - value(a) : value(a) - value(b)) || a.number - b.number);
}
function shownMeasures() {
  const showsAll = byId("all-columns").checked;
  return current.measures.map((measure, k) => [measure, k]).filter(([measure]) => showsAll || measure.column);
}
function headOf() {
  const cells = [make("th", {scope: "col"}, "status"),
                 make("th", {scope: "col"}, current.rows.some(isPair) ? "submaps" : "no.")];
  if (canDrop()) cells.push(make("th", {scope: "col"}, "drop"));
  for (const [measure, k] of shownMeasures()) {
    const isSorted = order.measure === k;
    const arrow = isSorted ? (order.isDescending ? " \u25bc" : " \u25b2") : "";
    cells.push(make("th", {scope: "col", "aria-sort": isSorted ? (order.isDescending ? "descending" : "ascending") : "none"},
      make("button", {type: "button", title: measure.meaning, on: {click: () => sortBy(k)}}, measure.label + arrow)));
  }
  return make("tr", {}, ...cells);
}
function sortBy(k) {
  if (order.measure === k) order.isDescending = !order.isDescending;
  else Object.assign(order, {measure: k, isDescending: true});
  fillTable();
}
const canDrop = () => current !== null && current.rows.some((row) => row.constraints);
function cellsOf(row, measures) {
  const cells = [
    make("td", {}, make("span", {class: `tone-${row.state.tone}`, "aria-hidden": "true"}, `${SIGNS[row.state.tone]} `), row.state.label),
    make("td", {}, isPair(row) ? `${shortName(row.reference)} \u2013 ${shortName(row.query)}` : `${row.number}`)];
  if (canDrop()) {
    const box = make("input", {type: "checkbox", "aria-label": `drop the constraints of ${shortName(row.reference)} and ${shortName(row.query)}`,
      on: {change: (event) => { row.drop = event.target.checked; row.isTouched = true; }}});
    box.checked = row.drop;
    cells.push(make("td", {}, box));
  }
  for (const [measure, k] of measures) {
    const value = row.values[k];
    const isPast = passes(measure, value) === false;
    cells.push(make("td", isPast ? {class: "tone-bad", title: boundText(measure)} : {},
      formatValue(measure, value) + (isPast ? " \u2717" : "")));
  }
  return cells;
}
function fillTable() {
  const table = byId("rows");
  table.tHead.replaceChildren(headOf());
  const rows = currentRows(), measures = shownMeasures();
  const body = document.createDocumentFragment();
  for (const row of rows) {
    row.element = make("tr", {"aria-selected": row === selected ? "true" : "false"}, ...cellsOf(row, measures));
    row.element.row = row;
    body.append(row.element);
  }
  table.tBodies[0].replaceChildren(body);
  const unlisted = current.unlisted > 0 ? `; ${current.unlisted} less likely ones are left out` : "";
  byId("row-count").textContent = rows.length === current.rows.length
    ? `${rows.length} ${rows.length === 1 ? "row" : "rows"}${unlisted}` : `${rows.length} of ${current.rows.length} rows${unlisted}`;
}
function chooseTable(table) {
  current = table;
  Object.assign(order, {measure: -1, isDescending: false});
  byId("table-note").textContent = table.note;
  byId("filter").value = "";
  const counts = table.statuses.map((status) => [status, table.rows.filter((row) => row.status === status.name).length]);
  byId("status-filter").replaceChildren(make("option", {value: ""}, "all"),
    ...counts.filter(([, count]) => count > 0).map(([status, count]) =>
      make("option", {value: status.name}, `${status.label} (${count})`)));
  for (const tab of byId("tabs").children) tab.setAttribute("aria-pressed", tab.table === table ? "true" : "false");
  byId("drop-row").hidden = !canDrop();
  fillTable();
}
function listTables() {
  for (const table of run.tables) {
    const tab = make("button", {type: "button", on: {click: () => chooseTable(table)}}, `${table.heading} (${table.rows.length})`);
    tab.table = table;
    byId("tabs").append(tab);
  }
}
function listenToTable() {
  const table = byId("rows");
  table.setAttribute("role", "grid");
  const rowOf = (event) => {
    const element = event.target.closest("tbody tr");
    return element ? element.row : null;
  };
  table.addEventListener("mouseover", (event) => pointTo(rowOf(event)));
  table.addEventListener("mouseleave", () => pointTo(null));
  table.addEventListener("click", (event) => {
    if (event.target.closest("input")) return;
    const row = rowOf(event);
    if (row) select(row, true);
  });
  byId("table-scroll").addEventListener("keydown", (event) => {
    const steps = {ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10, Home: -Infinity, End: Infinity};
    if (event.target.closest("input, button") || steps[event.key] === undefined) return;
    event.preventDefault();
    const rows = currentRows();
    if (rows.length === 0) return;
    const k = rows.indexOf(selected);
    select(rows[Math.min(rows.length - 1, Math.max(0, k < 0 ? 0 : k + steps[event.key]))], true);
  });
  byId("filter").addEventListener("input", fillTable);
  byId("status-filter").addEventListener("change", fillTable);
  byId("all-columns").addEventListener("change", fillTable);
  byId("export").addEventListener("click", saveDropList);
}

// --- What to drop. ---

function dropList() {
  const names = ["constraint", "submap_trajectory", "submap_index", "node_trajectory", "node_index"];
  const lines = [names.join(",")];
  for (const row of current.rows) {
    if (!row.drop) continue;
    // As proposed, or, where the reader ticked the box, all of the group.
    for (const constraint of row.constraints) {
      if (row.isTouched || constraint.dropped) lines.push(names.map((name) => constraint[name]).join(","));
    }
  }
  return `${lines.join("\n")}\n`;
}
function saveDropList() {
  const url = URL.createObjectURL(new Blob([dropList()], {type: "text/csv"}));
  const link = make("a", {href: url, download: "drop.csv"});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

// --- Pointing and selecting. ---

function pointTo(row) {
  if (row === pointed) return;
  if (pointed && pointed.element) pointed.element.classList.remove("pointed");
  pointed = row;
  canvas.style.cursor = row ? "pointer" : "";
  if (row && row.element) row.element.classList.add("pointed");
  draw();
}
function zoomTo(row) {
  if (!isPair(row)) {
    if (row.T_map_robot) fit(row.T_map_robot.x, row.T_map_robot.y, row.T_map_robot.x, row.T_map_robot.y, 12);
    return;
  }
  const points = [...placesOf(row, lastState)];
  for (const k of [row.reference, row.query]) {
    const submap = run.submaps[k];
    if (!submap || !submap.T_map_submap[lastState]) continue;
    const {picture} = submap;
    if (!picture) { points.push(apply(submap.T_map_submap[lastState], [0, 0])); continue; }
    const pose = compose(submap.T_map_submap[lastState], picture.T_submap_picture);
    for (const u of [0, picture.width]) {
      for (const v of [0, picture.height]) points.push(apply(pose, [u * picture.resolution, v * picture.resolution]));
    }
  }
  if (points.length === 0) return;
  const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
  fit(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys), 2);
}
// `zooms`: when chosen in the table, not on the map, where it is in view.
async function select(row, zooms) {
  const last = selected;
  selected = row;
  if (row.table !== current) chooseTable(row.table);
  if (last && last.element) last.element.setAttribute("aria-selected", "false");
  if (!row.element || !row.element.isConnected) {
    byId("filter").value = "";
    byId("status-filter").value = "";
    fillTable();
  }
  row.element.setAttribute("aria-selected", "true");
  scrollToRow(row.element);
  if (zooms) {
    zoomTo(row);
    if (!map.wipeIsTouched) setWipe(0, false);
  }
  showEvidence(row);
  if (isPair(row)) await tint(row);
  draw();
}
// Of the table alone, not of the page.
function scrollToRow(element) {
  const box = byId("table-scroll");
  const head = box.querySelector("thead").offsetHeight;
  if (element.offsetTop - head < box.scrollTop) box.scrollTop = element.offsetTop - head;
  const bottom = element.offsetTop + element.offsetHeight - box.clientHeight;
  if (bottom > box.scrollTop) box.scrollTop = bottom;
}
async function tint(row) {
  for (const [k, name, color] of [[row.reference, "asReference", REFERENCE], [row.query, "asQuery", QUERY]]) {
    const picture = await classesOf(k);
    if (picture && !picture[name]) picture[name] = tinted(picture, color);
  }
}

// --- Evidence. ---

// May be broken behind its dots.
function optionName(path) {
  const code = make("code");
  path.split(".").forEach((name, k) => {
    if (k > 0) code.append(".", make("wbr"));
    code.append(name);
  });
  return code;
}
function statusLine(row) {
  const words = [row.state.meaning, row.remark].filter((text) => text).join(" ");
  const line = make("p", {}, make("strong", {class: `tone-${row.state.tone}`}, `${SIGNS[row.state.tone]} ${row.state.label}. `), words);
  if (row.state.option) line.append(" The option that decides: ", optionName(row.state.option), ".");
  return line;
}
function numbersOf(row) {
  const body = make("tbody");
  row.table.measures.forEach((measure, k) => {
    const value = row.values[k];
    if (value === null || value === undefined) return;
    const passed = passes(measure, value);
    const verdict = passed === null ? "" : passed
      ? make("span", {class: "tone-good"}, `${SIGNS.good} ${boundText(measure)}`)
      : make("span", {class: "tone-bad"}, `${SIGNS.bad} ${boundText(measure)}`);
    body.append(make("tr", {title: measure.meaning},
      make("th", {scope: "row"}, measure.label),
      make("td", {class: "number"}, formatValue(measure, value)),
      make("td", {}, verdict, ...(measure.option ? [make("br"), optionName(measure.option)] : []))));
  });
  const head = make("thead", {}, make("tr", {}, make("th", {scope: "col"}, "number"),
    make("th", {scope: "col"}, "value"), make("th", {scope: "col"}, "bound, and the option that holds it")));
  return make("table", {}, head, body);
}
const degrees = (yaw) => {
  const turned = (yaw * 180 / Math.PI) % 360;
  return (turned > 180 ? turned - 360 : turned <= -180 ? turned + 360 : turned).toFixed(1);
};
const poseText = (pose) => `x ${pose.x.toFixed(2)} m, y ${pose.y.toFixed(2)} m, yaw ${degrees(pose.yaw)}\u00b0`;

function showEvidence(row) {
  const pane = byId("evidence");
  if (!row) {
    pane.replaceChildren(make("p", {class: "hint"}, "Choose a row, or a place on the map, to see its evidence."));
    return;
  }
  if (isPair(row)) showPair(pane, row);
  else showCandidate(pane, row);
}
function showPair(pane, row) {
  const picture = make("canvas", {class: "overlay", role: "img"});
  const area = make("div", {}, picture);
  pane.replaceChildren(
    make("h3", {}, `Submap ${submapName(row.query)} laid over ${submapName(row.reference)}`),
    statusLine(row), area,
    make("p", {class: "hint"}, `Pose of the first in the second: ${poseText(row.T_reference_query)}.`), numbersOf(row));
  drawPair(row, picture, area);
}
async function drawPair(row, picture, area) {
  const reference = await classesOf(row.reference), query = await classesOf(row.query);
  if (selected !== row) return;
  if (!reference || !query) {
    area.replaceChildren(make("p", {class: "hint"}, "Without a picture: the page would be too large with all submaps."));
    return;
  }
  const looks = ["both", "first", "second"];
  const labels = {both: "Both", first: `Only ${shortName(row.reference)}`, second: `Only ${shortName(row.query)}`};
  const overlay = overlayOf(row, reference, query);
  let blinking = 0;
  const show = (look) => {
    paintOverlay(overlay, picture, look);
    for (const button of buttons.children) {
      if (button.look) button.setAttribute("aria-pressed", button.look === look ? "true" : "false");
    }
  };
  const stop = () => { clearInterval(blinking); blinking = 0; };
  const buttons = make("div", {class: "buttons"}, ...looks.map((look) => {
    const button = make("button", {type: "button", on: {click: () => { stop(); show(look); }}}, labels[look]);
    button.look = look;
    return button;
  }));
  buttons.append(make("button", {type: "button", on: {click: () => {
    if (blinking) return stop();
    let k = 0;
    blinking = setInterval(() => {
      if (!picture.isConnected) return stop();
      show(looks[1 + (k++ % 2)]);
    }, 700);
  }}}, "Alternate"));
  area.append(buttons, pairLegend(row));
  picture.setAttribute("aria-label", `Walls of submap ${submapName(row.query)} over those of ${submapName(row.reference)}: ${
    overlay.numAgreeing} cells where walls of both coincide, ${overlay.numConflicts} where a wall stands in free space of the other`);
  show("both");
}
function pairLegend(row) {
  const entries = [[REFERENCE, `wall of ${shortName(row.reference)}`], [QUERY, `wall of ${shortName(row.query)}`],
                   [BOTH, "wall of both"], [CONFLICT, "wall in free space of the other, drawn larger"]];
  return make("div", {class: "legend"}, ...entries.map(([color, words]) => make("span", {}, swatch(hex(color)), words)));
}

// Samples both pictures in the frame of the reference. Cells: the class of the
// reference plus three times that of the query.
function overlayOf(row, reference, query) {
  const cell = Math.min(reference.resolution, query.resolution);
  const T_reference_picture = reference.T_submap_picture;
  const T_reference_query = compose(row.T_reference_query, query.T_submap_picture);
  const corners = [];
  for (const [picture, pose] of [[reference, T_reference_picture], [query, T_reference_query]]) {
    for (const u of [0, picture.width]) {
      for (const v of [0, picture.height]) corners.push(apply(pose, [u * picture.resolution, v * picture.resolution]));
    }
  }
  const left = Math.min(...corners.map((p) => p[0])), top = Math.max(...corners.map((p) => p[1]));
  const width = Math.ceil((Math.max(...corners.map((p) => p[0])) - left) / cell) + 1;
  const height = Math.ceil((top - Math.min(...corners.map((p) => p[1]))) / cell) + 1;
  const cells = new Uint8Array(width * height);
  for (const [picture, pose, weight] of [[reference, T_reference_picture, 1], [query, T_reference_query, 3]]) {
    const back = inverse(pose), c = Math.cos(back.yaw), s = Math.sin(back.yaw);
    for (let v = 0; v < height; ++v) {
      for (let u = 0; u < width; ++u) {
        const x = left + (u + 0.5) * cell, y = top - (v + 0.5) * cell;
        const i = Math.floor((back.x + c * x - s * y) / picture.resolution);
        const j = Math.floor((back.y + s * x + c * y) / picture.resolution);
        if (i < 0 || j < 0 || i >= picture.width || j >= picture.height) continue;
        cells[v * width + u] += weight * picture.classes[j * picture.width + i];
      }
    }
  }
  return findConflicts({width, height, cells, radius: Math.max(1, Math.round(0.3 / cell))});
}
// Walls of one whose surroundings are free in the other.
function findConflicts(overlay) {
  const {width, height, cells, radius} = overlay;
  const isFreeAround = (u, v, classOf) => {
    for (let y = v - radius; y <= v + radius; ++y) {
      for (let x = u - radius; x <= u + radius; ++x) {
        if (x < 0 || y < 0 || x >= width || y >= height || classOf(cells[y * width + x]) !== 1) return false;
      }
    }
    return true;
  };
  overlay.conflicts = [];
  overlay.numAgreeing = 0;
  for (let v = 0; v < height; ++v) {
    for (let u = 0; u < width; ++u) {
      const cell = cells[v * width + u], ofReference = cell % 3, ofQuery = Math.floor(cell / 3);
      if (ofReference === 2 && ofQuery === 2) ++overlay.numAgreeing;
      if ((ofReference === 2 && ofQuery === 1 && isFreeAround(u, v, (c) => Math.floor(c / 3))) ||
          (ofQuery === 2 && ofReference === 1 && isFreeAround(u, v, (c) => c % 3))) {
        overlay.conflicts.push([u, v]);
      }
    }
  }
  overlay.numConflicts = overlay.conflicts.length;
  return overlay;
}
function paintOverlay(overlay, picture, look) {
  const {width, height, cells} = overlay;
  picture.width = width;
  picture.height = height;
  const context = picture.getContext("2d");
  const pixels = context.createImageData(width, height);
  for (let i = 0; i < cells.length; ++i) {
    const ofReference = look === "second" ? 0 : cells[i] % 3;
    const ofQuery = look === "first" ? 0 : Math.floor(cells[i] / 3);
    const color = ofReference === 2 && ofQuery === 2 ? BOTH : ofReference === 2 ? REFERENCE : ofQuery === 2 ? QUERY
      : ofReference === 1 && ofQuery === 1 ? [255, 255, 255] : ofReference === 1 ? [220, 233, 247]
      : ofQuery === 1 ? [249, 230, 210] : null;
    if (color) pixels.data.set([...color, 255], 4 * i);
  }
  context.putImageData(pixels, 0, 0);
  if (look !== "both") return;
  context.fillStyle = hex(CONFLICT);
  for (const [u, v] of overlay.conflicts) context.fillRect(u - 1, v - 1, 3, 3);
}

// The map around a candidate, with what the robot saw.
function showCandidate(pane, row) {
  const children = [make("h3", {}, `${row.table.heading.replace(/(ch)es$|s$/, "$1")} ${row.number}`), statusLine(row)];
  if (row.T_map_robot) {
    const picture = make("canvas", {class: "overlay", role: "img", width: 640, height: 480,
      "aria-label": `The map around candidate ${row.number}${run.echoes.length > 0 ? ", with the echoes of the scan" : ""}`});
    paintCandidate(picture, row.T_map_robot);
    children.push(picture, make("p", {class: "hint"}, `Pose in the map: ${poseText(row.T_map_robot)}.`));
  }
  pane.replaceChildren(...children, numbersOf(row));
}
function paintCandidate(picture, pose) {
  const reach = Math.max(6, ...run.echoes.map(([x, y]) => Math.min(30, Math.hypot(x, y)))) + 1;
  const scale = picture.height / 2 / reach;
  const project = ([x, y]) => [(x - pose.x) * scale + picture.width / 2, (pose.y - y) * scale + picture.height / 2];
  const context = picture.getContext("2d");
  if (run.frame) {
    const [left, top] = project([run.frame.left, run.frame.top]);
    const factor = scale / run.frame.pixels_per_meter;
    context.imageSmoothingEnabled = false;
    const image = byId(`map-${lastState}`);
    if (image) context.drawImage(image, left, top, run.frame.width * factor, run.frame.height * factor);
  }
  drawEchoes(context, pose, project, 3);
  const tip = project(apply(pose, [reach / 8, 0]));
  strokePath(context, [project([pose.x, pose.y]), tip], "#0072b2", [], 4);
  dot(context, project([pose.x, pose.y]), 6, "#0072b2", PAPER);
}

// --- All together. ---

function describeMap() {
  if (!run.frame) return "No map";
  const size = `${(run.frame.width / run.frame.pixels_per_meter).toFixed(0)} by ${(run.frame.height / run.frame.pixels_per_meter).toFixed(0)} m`;
  const names = states.map((state) => state.label.toLowerCase()).join(" and ");
  return `Floor plan of ${size}, ${names}: ${run.submaps.length} submaps, ${run.paths.length} driven paths`;
}
async function begin() {
  byId("workbench").hidden = false;
  canvas.setAttribute("aria-label", describeMap());
  await loadMaps();
  listSessions();
  listPaths();
  listStatuses();
  listOthers();
  if (innerWidth < 800) byId("layers-box").open = false;
  listTables();
  const input = run.inputs.find((file) => file.flag === "input");
  byId("drop-command").textContent =
    `cartographer_sdf audit ${input ? input.path : "map.pbstream"} --drop drop.csv --output mended.pbstream`;
  listenToMap();
  listenToWipe();
  listenToTable();
  if (current) chooseTable(run.tables.find((table) => table.rows.length > 0) || current);
  else document.querySelector(".table-side").hidden = true;
  const best = candidateRows()[0];
  showEvidence(best || null);
  if (best) selected = best;
  new ResizeObserver(resize).observe(canvas);
  resize();
  byId("plain-maps").hidden = true;
  if (!run.frame) document.querySelector(".map-side").hidden = true;
  document.documentElement.dataset.ready = "true";
}
begin().catch((error) => {
  byId("workbench").hidden = true;
  byId("plain-maps").before(make("p", {class: "script-failed"}, `The inspector failed: ${error.message}`));
  throw error;
});
})();
