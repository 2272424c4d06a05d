"use strict";
// The present view with title and legend, as a picture to save or to print.

/** A canvas with the view of a page, its title and its legend, on paper of a colour; by default as the screen. */
function pictureOf(page, { paper, ink } = screenColours()) {
  const view = page.viewer.snapshot();
  const scale = view.width / view.clientWidth;
  const picture = document.createElement("canvas");
  const [head, foot] = [44 * scale, 84 * scale];
  picture.width = view.width;
  picture.height = view.height + head + foot;
  const pen = picture.getContext("2d");
  pen.fillStyle = paper;
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.drawImage(view, 0, head);
  pen.fillStyle = ink;
  pen.textBaseline = "middle";
  const font = (size, weight = 400) => `${weight} ${size * scale}px system-ui, sans-serif`;
  pen.font = font(16, 600);
  pen.fillText(document.querySelector("h1").textContent, 18 * scale, head / 2);
  pen.font = font(12);
  pen.textAlign = "right";
  pen.fillText(document.querySelector(".summary").textContent, picture.width - 18 * scale, head / 2);
  drawBar(pen, page, { top: head + view.height, scale, font, ink });
  return picture;
}

function screenColours() {
  const style = getComputedStyle(document.documentElement);
  return { paper: style.getPropertyValue("--card"), ink: style.getPropertyValue("--ink") };
}

function drawBar(pen, page, { top, scale, font, ink }) {
  const { field, low, high } = page;
  const wide = Math.min(460 * scale, pen.canvas.width - 80 * scale);
  const left = (pen.canvas.width - wide) / 2;
  pen.textAlign = "center";
  pen.font = font(12.5);
  const sign = field.signed ? ", convex positive" : "";
  const unit = field.unit && field.unit !== "1" ? `, in ${field.unit}` : "";
  const grey = !field.categories && page.undefinedVertices > 0 ? "; grey: undefined" : "";
  pen.fillText(`${field.title}${unit}${sign}${grey}`, pen.canvas.width / 2, top + 12 * scale);
  if (field.categories) return drawKeys(pen, page, { top, scale, font, ink });
  for (let i = 0; i < 256; i++) {
    pen.fillStyle = cssColour(field.map, 3 * i);
    pen.fillRect(left + (wide * i) / 256, top + 26 * scale, wide / 256 + 1, 15 * scale);
  }
  pen.fillStyle = ink;
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    pen.fillText(short(low + share * (high - low)), left + wide * share, top + 54 * scale);
  }
}

function drawKeys(pen, page, { top, scale, font, ink }) {
  const present = [...new Set(page.field.values)].sort();
  const cell = Math.min(150 * scale, pen.canvas.width / present.length);
  let left = (pen.canvas.width - cell * present.length) / 2;
  pen.textAlign = "left";
  pen.font = font(11);
  for (const code of present) {
    pen.fillStyle = cssColour(STATUS_COLOURS[code]);
    pen.fillRect(left, top + 30 * scale, 14 * scale, 14 * scale);
    pen.fillStyle = ink;
    pen.fillText(page.field.categories[code], left + 20 * scale, top + 38 * scale);
    left += cell;
  }
}
