"use strict";
// What the graphics processor runs, in GLSL.

// Points of a cloud are cones seen from the tip, with discs as large as the area that each stands for: of two that
// overlap the nearer centre is seen.  `scale` is how many pixels a unit has at distance 1.
const DISC = `
#ifdef DISCS
in float size;
uniform float scale;
out float vDepth;
void makeDisc(vec4 place) {
  vec4 behind = projectionMatrix * (place - vec4(0.0, 0.0, size, 0.0));
  gl_PointSize = clamp(size * scale / gl_Position.w, 2.0, 60.0);
  vDepth = 0.5 * (behind.z / behind.w - gl_Position.z / gl_Position.w);
}
#endif
`;
const CONE = `
#ifdef DISCS
in float vDepth;
void cutDisc() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  if (r > 1.0) discard;
  gl_FragDepth = gl_FragCoord.z + vDepth * r;
}
#endif
`;
const SURFACE_VERTEX = `${DISC}
in vec4 tint;
in vec4 smoothNormal;
out vec3 vTint;
out vec4 vNormal;
out vec3 vPlace;
void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vTint = tint.rgb;
  vNormal = vec4(normalMatrix * smoothNormal.xyz, smoothNormal.w);
  vPlace = place.xyz;
  gl_Position = projectionMatrix * place;
#ifdef DISCS
  makeDisc(place);
#endif
}`;
// Lit from the viewer, as the still picture.  Where the faces around a vertex disagree (an edge of a part) the normal
// of the face counts, elsewhere the mean normal of the vertices.  The inner side is darker.
const SURFACE_FRAGMENT = `
precision highp float;${CONE}
in vec3 vTint;
in vec4 vNormal;
in vec3 vPlace;
uniform float smoothing;
layout(location = 0) out vec4 colour;
void main() {
#ifdef DISCS
  cutDisc();
  float slope = length(vNormal.xyz) > 1e-4 ? abs(dot(normalize(vNormal.xyz), normalize(vPlace))) : 1.0;
  colour = vec4(vTint * (0.52 + 0.48 * slope), 1.0);
#else
  vec3 flatNormal = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
  float inner = dot(vNormal.xyz, flatNormal) < 0.0 ? 0.72 : 1.0;
  vec3 mean = length(vNormal.xyz) > 1e-4 ? normalize(vNormal.xyz) : flatNormal;
  vec3 normal = normalize(mix(flatNormal, mean * sign(dot(mean, flatNormal) + 1e-9), smoothing * vNormal.w));
  float facing = abs(dot(normal, normalize(vPlace)));
  colour = vec4(vTint * (0.52 + 0.48 * facing) * inner, 1.0);
#endif
}`;
// The last corner of the face that is seen, or the point, as a colour.
const PICK_VERTEX = `${DISC}
flat out uint vertex;
void main() {
  vertex = uint(gl_VertexID) + 1u;
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * place;
#ifdef DISCS
  makeDisc(place);
#endif
}`;
const PICK_FRAGMENT = `
precision highp float;${CONE}
precision highp int;
flat in uint vertex;
layout(location = 0) out vec4 colour;
void main() {
#ifdef DISCS
  cutDisc();
#endif
  colour = vec4(uvec4(vertex, vertex >> 8, vertex >> 16, vertex >> 24) & 255u) / 255.0;
}`;
const MARK_FRAGMENT = `
precision highp float;
layout(location = 0) out vec4 colour;
void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5) discard;
  colour = vec4(r < 0.2 ? vec3(1.0, 0.85, 0.1) : r < 0.38 ? vec3(0.0) : vec3(1.0), 1.0);
}`;
const POINT_FRAGMENT = `
precision highp float;
uniform vec3 ink;
layout(location = 0) out vec4 colour;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  colour = vec4(length(gl_PointCoord - 0.5) > 0.36 ? vec3(1.0) : ink, 1.0);
}`;
const POINT_VERTEX = `
uniform float size;
void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  place.xyz *= 0.999; // in front of the surface that it is on
  gl_Position = projectionMatrix * place;
  gl_PointSize = size;
}`;
