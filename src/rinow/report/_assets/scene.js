"use strict";
// The way back from report/scene.py: text of the page -> typed arrays.

const ARRAY_TYPES = {
  uint8: Uint8Array, int8: Int8Array, uint32: Uint32Array, float32: Float32Array, float64: Float64Array,
};

/** Header of the scene with `arrays` replaced by an object of typed arrays by name. */
async function readScene() {
  const header = JSON.parse(document.getElementById("scene-header").textContent);
  const text = document.getElementById("scene-data");
  const bytes = await decompressed(bytesOfBase64(text.textContent.trim()));
  text.remove();
  const arrays = {};
  let start = 0;
  for (const entry of header.arrays) {
    const Type = ARRAY_TYPES[entry.type];
    const count = entry.rows * entry.columns;
    const values = unshuffled(bytes.subarray(start, start + count * Type.BYTES_PER_ELEMENT), Type);
    if (entry.differences) sumUp(values, entry.columns);
    arrays[entry.name] = values;
    start += count * Type.BYTES_PER_ELEMENT;
  }
  return { ...header, arrays };
}

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const block = 4 * 65536;
  const parts = [];
  for (let i = 0; i < text.length; i += block) {
    parts.push(Uint8Array.from(atob(text.slice(i, i + block)), (c) => c.charCodeAt(0)));
  }
  return new Blob(parts);
}

async function decompressed(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Numbers whose first bytes come first, then the second bytes, and so on. */
function unshuffled(bytes, Type) {
  const size = Type.BYTES_PER_ELEMENT;
  const count = bytes.length / size;
  const out = new Uint8Array(bytes.length);
  for (let b = 0; b < size; b++) {
    for (let i = 0, from = b * count, to = b; i < count; i++, from++, to += size) out[to] = bytes[from];
  }
  return new Type(out.buffer);
}

/** Rows from their differences, which are written as 0, -1, 1, -2 ... -> 0, 1, 2, 3 ...; all modulo 2^32. */
function sumUp(values, columns) {
  for (let i = 0; i < values.length; i++) {
    const z = values[i];
    values[i] = ((z >>> 1) ^ -(z & 1)) + (i < columns ? 0 : values[i - columns]);
  }
}
