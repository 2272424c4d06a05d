"use strict";
// What the keys do; `#help` in template.html lists them.

const actionsOf = (page) => {
  const { viewer } = page;
  const layer = (name) => page.show(name, !$(name).checked);
  return {
    ArrowLeft: () => viewer?.turn(-0.1, 0),
    ArrowRight: () => viewer?.turn(0.1, 0),
    ArrowUp: () => viewer?.turn(0, 0.1),
    ArrowDown: () => viewer?.turn(0, -0.1),
    "+": () => viewer?.zoom(0.8),
    "=": () => viewer?.zoom(0.8),
    "-": () => viewer?.zoom(1.25),
    f: () => page.choose(neighbourOf(page, 1)),
    F: () => page.choose(neighbourOf(page, -1)),
    "[": () => scaleRange(page, 0.5),
    "]": () => scaleRange(page, 2),
    0: () => page.choose(page.field.name),
    e: () => layer("edges"),
    d: () => layer("directions"),
    s: () => layer("features"),
    r: () => page.reset(page.up),
    c: () => page.held >= 0 && viewer?.centre(page.held),
    p: () => page.save(),
    Escape: () => page.hold(-1),
    "?": () => $("help").showModal(),
  };
};

/** Name of the field after or before the present one. */
function neighbourOf(page, by) {
  const names = [...page.fields.keys()];
  return names[(names.indexOf(page.field.name) + by + names.length) % names.length];
}

/** Widen or narrow the colours: about their middle for a signed field, about 0 for others. */
function scaleRange(page, by) {
  if (page.field.categories) return;
  const middle = page.field.signed ? (page.low + page.high) / 2 : 0;
  page.setRange(middle + (page.low - middle) * by, middle + (page.high - middle) * by);
}

/** Do what a key means, unless somebody types into a field or scrolls the page. */
function pressed(page, event) {
  const typing = /^(INPUT|SELECT)$/.test(event.target.tagName) && event.target.type !== "checkbox";
  if (event.ctrlKey || event.metaKey || event.altKey || typing || $("help").open) return;
  const scrolling = event.key.startsWith("Arrow") && event.target !== $("canvas");
  const action = actionsOf(page)[event.key];
  if (!action || scrolling) return;
  event.preventDefault();
  action();
}
