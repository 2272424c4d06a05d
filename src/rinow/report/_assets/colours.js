"use strict";
// Colours of a field, and the histogram that doubles as its legend.

const STATUS_COLOURS = [
  [158, 182, 205], [230, 159, 0], [86, 180, 233], [204, 121, 167], [213, 94, 0], [60, 60, 60], [0, 158, 115],
];
const BINS = 64;

/** The fields of a scene by name, with their values, colour tables and a last one for the status. */
function fieldsOf(scene) {
  const maps = Object.fromEntries(Object.entries(scene.maps).map(([name, text]) => [name, mapOf(text)]));
  const fields = new Map();
  for (const f of scene.fields) fields.set(f.name, { ...f, values: scene.arrays[f.name], map: maps[f.map] });
  const status = { name: "status", title: `status of the ${scene.place}`, unit: "", values: scene.arrays.status };
  fields.set("status", { ...status, categories: Object.keys(scene.statuses) });
  return fields;
}

function mapOf(text) {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

/** Write four bytes of colour for every vertex to `out`. */
function paint(field, low, high, undefinedColour, out) {
  const { values, map } = field;
  for (let i = 0; i < values.length; i++) {
    let colour = undefinedColour;
    let at = 0;
    if (field.categories) {
      colour = STATUS_COLOURS[values[i]];
    } else if (!Number.isNaN(values[i])) {
      colour = map;
      at = 3 * placeInMap(values[i], low, high, map);
    }
    out[4 * i] = colour[at];
    out[4 * i + 1] = colour[at + 1];
    out[4 * i + 2] = colour[at + 2];
    out[4 * i + 3] = 255;
  }
}

function placeInMap(value, low, high, map) {
  const n = map.length / 3;
  return Math.min(n - 1, Math.max(0, Math.floor(((value - low) / (high - low)) * n)));
}

function cssColour(colour, at = 0) {
  return `rgb(${colour[at]},${colour[at + 1]},${colour[at + 2]})`;
}

/** Area in each of `BINS` bins between low and high, below, above, and without a value; shares of the whole. */
function histogram(values, areas, low, high) {
  const bins = new Float64Array(BINS);
  let below = 0, above = 0, without = 0, total = 0;
  for (let i = 0; i < values.length; i++) {
    const a = areas[i];
    if (!(a > 0)) continue;
    total += a;
    const v = values[i];
    if (Number.isNaN(v)) without += a;
    else if (v < low) below += a;
    else if (v > high) above += a;
    else bins[Math.min(BINS - 1, Math.floor(((v - low) / (high - low)) * BINS))] += a;
  }
  const share = total > 0 ? 1 / total : 0;
  return { bins: bins.map((b) => b * share), below: below * share, above: above * share, without: without * share };
}

/** Draw histogram and colour bar of a field into an <svg>. */
function drawLegend(svg, field, low, high, areas) {
  const h = histogram(field.values, areas, low, high);
  const [width, top, bar, height] = [320, 96, 14, 132];
  const [left, right] = [26, width - 26];
  const largest = Math.max(...h.bins, 1e-12);
  const x = (share) => left + (right - left) * share;
  const items = [];
  const colourAt = (share) => cssColour(field.map, 3 * placeInMap(share, 0, 1, field.map));
  h.bins.forEach((b, i) => {
    const tall = Math.max(b > 0 ? 1 : 0, (b / largest) * (top - 18));
    items.push(rectangle(x(i / BINS), top - tall, (right - left) / BINS - 0.6, tall, "", "bar"));
  });
  for (const [share, at, anchor, edge] of [[h.below, left - 14, "start", 0], [h.above, right + 4, "end", width]]) {
    if (share === 0) continue;
    const tall = Math.min(top - 18, Math.max(2, (share / largest) * (top - 18)));
    items.push(rectangle(at, top - tall, 10, tall, "", "tail"));
    items.push(label(edge, 10, `${percent(share)} ${anchor === "start" ? "below" : "above"}`, anchor));
  }
  for (let i = 0; i < 128; i++) {
    items.push(rectangle(x(i / 128), top + 3, (right - left) / 128 + 0.5, bar, colourAt((i + 0.5) / 128)));
  }
  for (const share of [0, 0.5, 1]) {
    items.push(`<line x1="${x(share)}" x2="${x(share)}" y1="${top + 3 + bar}" y2="${top + 7 + bar}" class="tick"/>`);
    const text = short(low + share * (high - low));
    const [at, anchor] = text.length < 9 || share === 0.5 ? [x(share), "middle"] : share ? [width, "end"] : [0, "start"];
    items.push(label(at, height - 3, text, anchor));
  }
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.innerHTML = items.join("");
  svg.setAttribute("aria-label",
    `Histogram of ${field.title} by area, from ${short(low)} to ${short(high)} ${field.unit}: ` +
    `${percent(h.below)} of the area below, ${percent(h.above)} above, ${percent(h.without)} without a value.`);
  return h;
}

/** A rectangle in a colour, or in that of a kind of the style sheet. */
function rectangle(x, y, width, height, colour, kind) {
  const place = `x="${x.toFixed(2)}" y="${y.toFixed(2)}" width="${width.toFixed(2)}" height="${height.toFixed(2)}"`;
  return `<rect ${place} ${kind ? `class="${kind}"` : `fill="${colour}"`}/>`;
}

function label(x, y, text, anchor) {
  return `<text x="${x}" y="${y}" text-anchor="${anchor}">${text}</text>`;
}

function percent(share) {
  if (share === 0) return "0 %";
  return share < 0.001 ? "under 0.1 %" : `${(100 * share).toFixed(1)} %`;
}

/** A number in four digits with a true minus sign. */
function short(value) {
  return written(value, 4);
}

/** A number to the place of the second digit of its standard error, at least in one digit and at most in so many. */
function rounded(value, error, digits) {
  const known = Math.floor(Math.log10(Math.abs(value))) - Math.floor(Math.log10(error)) + 2;
  return written(value, Number.isFinite(known) ? Math.min(Math.max(known, 1), digits) : digits);
}

/** A number in as many digits as asked for, without trailing zeros. */
function written(value, digits) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e7)
    ? value.toExponential(digits - 1).replace(/\.?0+e/, "e")
    : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}
