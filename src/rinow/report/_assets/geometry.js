"use strict";
// Positions, normals and adjacency that drawing needs; quantities of the report come from the header and the arrays.

/** Positions such that the frame fills a cube of side 1 about the origin, and what a unit of length is in it. */
function unitPlaces(positions, [low, high], step) {
  const middle = high.map((h, c) => (low[c] + h) / 2);
  const longest = Math.max(...high.map((h, c) => h - low[c]), 1);
  const places = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; i++) places[i] = (positions[i] - middle[i % 3]) / longest;
  return [places, 1 / (longest * step)];
}

/** Mean outward normals by area as signed bytes; the fourth tells how far the faces around agree. */
function vertexNormals(places, faces, turned) {
  const sums = new Float32Array(places.length);
  const areas = new Float32Array(places.length / 3);
  for (let f = 0; f < turned.length; f++) {
    const [a, b, c] = [3 * faces[3 * f], 3 * faces[3 * f + 1], 3 * faces[3 * f + 2]];
    const ux = places[b] - places[a], uy = places[b + 1] - places[a + 1], uz = places[b + 2] - places[a + 2];
    const vx = places[c] - places[a], vy = places[c + 1] - places[a + 1], vz = places[c + 2] - places[a + 2];
    const s = turned[f] ? -1 : 1;
    const nx = s * (uy * vz - uz * vy), ny = s * (uz * vx - ux * vz), nz = s * (ux * vy - uy * vx);
    const area = Math.sqrt(nx * nx + ny * ny + nz * nz);
    for (const v of [a, b, c]) {
      sums[v] += nx;
      sums[v + 1] += ny;
      sums[v + 2] += nz;
      areas[v / 3] += area;
    }
  }
  const normals = new Int8Array(4 * areas.length);
  for (let i = 0; i < areas.length; i++) {
    const size = Math.hypot(sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]);
    if (!(size > 0)) continue;
    for (let c = 0; c < 3; c++) normals[4 * i + c] = Math.round((127 * sums[3 * i + c]) / size);
    const agreement = Math.min(1, Math.max(0, (size / areas[i] - 0.93) / 0.04));
    normals[4 * i + 3] = Math.round(127 * agreement);
  }
  return normals;
}

/** The faces sorted by their last corner. */
function rowsByLastCorner(faces, n) {
  const offsets = new Uint32Array(n + 2);
  for (let i = 2; i < faces.length; i += 3) offsets[faces[i] + 2]++;
  for (let v = 0; v < n; v++) offsets[v + 2] += offsets[v + 1];
  const rows = new Uint32Array(faces.length / 3);
  for (let f = 0; f < rows.length; f++) rows[offsets[faces[3 * f + 2] + 1]++] = f;
  return { offsets, rows };
}
