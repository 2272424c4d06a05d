"use strict";
// Controls, address and readout; the state of the page is in one object.

const $ = (id) => document.getElementById(id);
const LAYERS = ["smooth", "edges", "directions", "features"];
const READOUT = ["gaussian", "spread", "mean", "k1", "k2", "curvedness", "shape_index", "radius"];
const SHORT_NAMES = {
  gaussian: "K", spread: "spread of K", mean: "H", k1: "k1", k2: "k2", curvedness: "curvedness",
  shape_index: "shape index", radius: "radius used",
};
const DRAG = 5; // pixels that tell a drag from a click

class Page {
  constructor(scene) {
    this.scene = scene;
    this.fields = fieldsOf(scene);
    this.held = -1;
    try {
      this.viewer = new Viewer($("canvas"), scene);
    } catch (error) {
      console.warn(error);
    }
    this.fillControls();
    this.listen();
    this.followAddress();
  }

  fillControls() {
    for (const f of this.fields.values()) $("field").add(new Option(f.title, f.name));
    $("vertex").max = this.scene.vertices - 1;
    for (const label of document.querySelectorAll("[data-needs]")) {
      label.hidden = !this.scene.arrays[label.dataset.needs];
    }
  }

  listen() {
    $("field").onchange = () => this.choose($("field").value);
    $("low").onchange = () => this.readRange("low");
    $("high").onchange = () => this.readRange("high");
    $("symmetric").onchange = () => this.readRange("high");
    $("range-reset").onclick = () => this.choose(this.field.name);
    $("vertex").onchange = () => this.typeVertex();
    $("vertex-clear").onclick = () => this.hold(-1);
    $("save").onclick = () => this.save();
    $("help-open").onclick = () => $("help").showModal();
    $("help-close").onclick = () => $("help").close();
    $("reset").onclick = () => this.reset(this.up);
    for (const name of LAYERS) $(name).onchange = () => this.show(name, $(name).checked);
    for (const button of document.querySelectorAll("[data-up]")) button.onclick = () => this.reset(button.dataset.up);
    addEventListener("keydown", (event) => pressed(this, event));
    addEventListener("hashchange", () => this.followAddress());
    addEventListener("beforeprint", () => this.printView());
    this.listenToPointer($("canvas"));
  }

  listenToPointer(canvas) {
    let start;
    canvas.addEventListener("pointerdown", (event) => { start = event; });
    canvas.addEventListener("pointerup", (event) => {
      const moved = start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY);
      if (start && moved < DRAG && event.button === 0) {
        this.pointer = event;
        this.hold(this.viewer.picker.vertexAt(event.offsetX, event.offsetY));
        this.hover();
      }
      start = undefined;
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0 && event.pointerType !== "touch") this.pointer = event;
      this.hovering ??= requestAnimationFrame(() => this.hover());
    });
    canvas.addEventListener("pointerleave", () => { this.pointer = undefined; this.hover(); });
  }

  /** Follow an address such as #field=mean&low=-3&high=3&vertex=12&edges=1; every part may be missing. */
  followAddress() {
    const wish = new URLSearchParams(location.hash.slice(1));
    this.reset(wish.get("up") in UP ? wish.get("up") : this.scene.up);
    this.choose(this.fields.has(wish.get("field")) ? wish.get("field") : this.scene.field);
    const [low, high] = [wish.get("low"), wish.get("high")].map((text) => (text === null ? NaN : Number(text)));
    if (low < high) this.setRange(low, high);
    for (const name of LAYERS) if (wish.has(name)) this.show(name, wish.get(name) === "1");
    this.hold(this.vertexOf(wish.get("vertex")));
    if (this.held >= 0) this.viewer?.centre(this.held);
    if (wish.has("zoom")) this.viewer?.zoom(1 / Number(wish.get("zoom")));
  }

  vertexOf(text) {
    const v = /^\d+$/.test(text ?? "") ? Number(text) : -1;
    return v < this.scene.vertices ? v : -1;
  }

  /** Change to a field and its own range of colours. */
  choose(name) {
    this.field = this.fields.get(name);
    $("field").value = name;
    $("symmetric").checked = Boolean(this.field.signed);
    $("symmetric").parentElement.hidden = !this.field.signed;
    this.setRange(this.field.low, this.field.high);
  }

  setRange(low, high) {
    [this.low, this.high] = [low, high];
    if (this.field.signed) $("symmetric").checked = low === -high;
    for (const [id, value] of [["low", low], ["high", high]]) {
      if (!this.field.categories) $(id).value = String(Number(value.toPrecision(6)));
      $(id).removeAttribute("aria-invalid");
    }
    if (this.viewer) {
      paint(this.field, low, high, this.scene.undefined, this.viewer.tints);
      this.viewer.coloursChanged();
    }
    this.drawLegend();
    this.showVertex(this.held);
  }

  /** Take over what was typed into one end of the range. */
  readRange(changed) {
    const typed = typedNumber($(changed));
    if ($("symmetric").checked) $(changed === "low" ? "high" : "low").value = String(-typed);
    const [low, high] = [typedNumber($("low")), typedNumber($("high"))];
    if (low < high && Number.isFinite(high - low)) this.setRange(low, high);
    else $(changed).setAttribute("aria-invalid", "true");
  }

  drawLegend() {
    const { field, scene } = this;
    const isCategory = Boolean(field.categories);
    $("legend").toggleAttribute("hidden", isCategory);
    $("range").hidden = isCategory;
    $("categories").hidden = !isCategory;
    if (isCategory) return this.drawCategories();
    const { without } = drawLegend($("legend"), field, this.low, this.high, scene.arrays.areas);
    this.undefinedVertices = field.values.reduce((n, v) => n + Number.isNaN(v), 0);
    const parts = [
      field.unit === "1" ? "No unit." : `Unit ${field.unit}.`,
      field.signed ? "Convex is positive." : "",
      "Histogram by area; light bars at its ends: beyond the colours.",
      this.undefinedVertices > 0
        ? `Grey: undefined (nan) at ${this.undefinedVertices.toLocaleString("en")} ${scene.places}, ${percent(without)} of the area.`
        : `Defined at every ${scene.place}.`,
    ];
    $("legend-note").textContent = parts.filter(Boolean).join(" ");
  }

  drawCategories() {
    const counts = new Array(this.field.categories.length).fill(0);
    for (const s of this.field.values) counts[s]++;
    $("categories").replaceChildren();
    this.field.categories.forEach((name, code) => {
      if (counts[code] === 0) return;
      const item = document.createElement("li");
      const swatch = document.createElement("i");
      swatch.style.background = cssColour(STATUS_COLOURS[code]);
      const count = document.createElement("b");
      count.textContent = counts[code].toLocaleString("en");
      item.append(swatch, `${code} ${name}`, count);
      $("categories").append(item);
    });
    $("legend-note").textContent = `Number of ${this.scene.places} with each status; the table below says what each means.`;
  }

  show(name, shown) {
    $(name).checked = shown;
    if (name === "edges" && this.scene.arrays.turned) this.viewer?.showEdges(shown);
    if (name === "smooth") this.viewer?.showSmooth(shown);
    if (name === "directions" && this.scene.arrays.direction_vertices) {
      this.viewer?.showDirections(shown, this.scene.arrays.areas);
    }
    if (name === "features" && this.scene.arrays.crease_edges) this.viewer?.showFeatures(shown);
  }

  reset(up) {
    this.up = up;
    for (const button of document.querySelectorAll("[data-up]")) {
      button.setAttribute("aria-pressed", String(button.dataset.up === up));
    }
    this.viewer?.reset(up);
  }

  hover() {
    this.hovering = undefined;
    const at = this.pointer;
    const vertex = at ? this.viewer.picker.vertexAt(at.offsetX, at.offsetY) : -1;
    $("tip").hidden = vertex < 0;
    if (vertex >= 0) {
      const f = this.field;
      const value = f.categories ? f.categories[f.values[vertex]] : `${short(f.values[vertex])} ${f.unit === "1" ? "" : f.unit}`;
      $("tip").textContent = `${this.scene.place} ${vertex}\n${SHORT_NAMES[f.name] ?? f.name} ${value}`;
      const x = Math.min(at.offsetX + 16, $("view").clientWidth - $("tip").offsetWidth - 6);
      const y = at.offsetY > $("view").clientHeight - 80 ? at.offsetY - 58 : at.offsetY + 14;
      $("tip").style.transform = `translate(${x}px, ${y}px)`;
    }
    if (this.held < 0) this.showVertex(vertex);
  }

  /** Keep a vertex in the readout and marked; -1 for none. */
  hold(vertex) {
    this.held = vertex;
    $("vertex").value = vertex >= 0 ? vertex : "";
    $("vertex-clear").hidden = vertex < 0;
    $("vertex").removeAttribute("aria-invalid");
    $("readout").setAttribute("aria-live", vertex >= 0 ? "polite" : "off");
    const hasPlace = Object.keys(this.scene.statuses)[this.scene.arrays.status[vertex]] !== "NONFINITE";
    this.viewer?.mark(hasPlace ? vertex : -1);
    this.showVertex(vertex);
  }

  typeVertex() {
    const vertex = this.vertexOf($("vertex").value);
    if (vertex < 0 && $("vertex").value !== "") return $("vertex").setAttribute("aria-invalid", "true");
    this.hold(vertex);
    if (vertex >= 0 && this.viewer?.marker.visible) this.viewer.centre(vertex);
  }

  showVertex(vertex) {
    $("readout").replaceChildren();
    $("vertex-hint").hidden = vertex >= 0;
    if (vertex < 0) return;
    const { arrays, statuses, origin, step, unit } = this.scene;
    const code = arrays.status[vertex];
    const [name, meaning] = Object.entries(statuses)[code];
    const digits = Math.round(-Math.log10(this.scene.precision));
    const spread = this.fields.get("spread")?.values[vertex];
    const decimals = Math.ceil(-Math.log10(step));
    const place = [0, 1, 2].map((c) => {
      const x = origin[c] + step * arrays.positions[3 * vertex + c];
      return decimals >= 0 && decimals < 12 ? x.toFixed(decimals).replace("-", "−") : written(x, 6);
    });
    this.line(this.scene.place, `${vertex} (counted from 0)`);
    this.line("x, y, z", name === "NONFINITE" ? "not finite" : `${place.join(", ")} ${unit}`, undefined, "place");
    for (const id of READOUT) {
      const f = this.fields.get(id);
      if (!f) continue;
      const value = f.values[vertex];
      const text = { gaussian: rounded(value, spread, digits), spread: `± ${written(value, 2)}` }[id];
      this.line(SHORT_NAMES[id], text ?? written(value, digits), f.unit);
    }
    this.line("status", `${code} ${name}: ${meaning}`);
  }

  /** A line of the readout; without a unit the value has the room of both. */
  line(name, value, unit, kind = "") {
    const [term, number, of] = ["dt", "dd", "dd"].map((tag) => document.createElement(tag));
    term.textContent = name;
    number.textContent = value;
    of.textContent = unit === "1" ? "" : unit ?? "";
    of.className = "unit";
    if (unit === undefined) number.className = `wide ${kind}`;
    $("readout").append(term, number, ...(unit === undefined ? [] : [of]));
  }

  printView() {
    if (!this.viewer) return;
    const [picture, caption] = $("still").children;
    picture.src = pictureOf(this, { paper: "#fff", ink: "#000" }).toDataURL("image/png");
    picture.alt = caption.textContent = `The view when this page was printed, coloured by ${this.field.title}.`;
  }

  save() {
    if (!this.viewer) return;
    const link = document.createElement("a");
    link.href = pictureOf(this).toDataURL("image/png");
    link.download = `${document.querySelector("h1").textContent.replace(/\.\w+$/, "")}-${this.field.name}.png`;
    link.click();
  }
}

/** A number with a decimal point or comma; nan if it is none. */
function typedNumber(input) {
  const text = input.value.trim().replace("−", "-").replace(",", ".");
  return text === "" ? NaN : Number(text);
}

async function start() {
  $("message").textContent = "Unpacking the surface …";
  try {
    if (!window.DecompressionStream) throw new Error("this browser is too old (it lacks DecompressionStream)");
    const scene = await readScene();
    document.documentElement.className = "";
    const page = (window.page = new Page(scene));
    $("message").textContent = "";
    if (!page.viewer) {
      document.documentElement.className = "still data";
      $("message").textContent = "The picture is still: this browser has no WebGL 2. Type a number to read its values.";
    }
    document.documentElement.dataset.ready = "1";
  } catch (error) {
    document.documentElement.className = "still";
    $("message").textContent = `The picture is still: ${error.message}.`;
  }
}

start();
