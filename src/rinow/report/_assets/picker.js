"use strict";
// Which vertex is under the pointer: every vertex drawn in a colour that is its number, to be read back.

class Picker {
  constructor(viewer) {
    this.viewer = viewer;
    this.target = new THREE.WebGLRenderTarget(1, 1);
    this.material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: PICK_VERTEX, fragmentShader: PICK_FRAGMENT,
      side: THREE.DoubleSide, blending: THREE.NoBlending, uniforms: viewer.uniforms, defines: viewer.defines(),
    });
    this.isStale = true;
  }

  resize(width, height) {
    this.target.setSize(width, height);
    this.isStale = true;
  }

  /** The vertex nearest to a place on the canvas, of the face seen there; -1 beside the surface. */
  vertexAt(x, y) {
    const { renderer, camera, isCloud } = this.viewer;
    const { width, height } = this.target;
    if (this.isStale) this.draw();
    const bytes = new Uint8Array(4);
    renderer.readRenderTargetPixels(this.target, Math.floor(x), height - 1 - Math.floor(y), 1, 1, bytes);
    const last = (bytes[0] | (bytes[1] << 8) | (bytes[2] << 16) | (bytes[3] << 24)) - 1;
    if (last < 0 || isCloud) return last;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), camera);
    return this.nearestCorner(last, ray.ray);
  }

  /** Draw the surface alone, each face in the number of its last corner. */
  draw() {
    const { renderer, camera, surface, world } = this.viewer;
    const hidden = world.children.filter((object) => object !== surface && object.visible);
    for (const object of hidden) object.visible = false;
    const material = surface.material;
    surface.material = this.material;
    this.viewer.scaleDiscs(this.target.height);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(world, camera);
    renderer.setRenderTarget(null);
    surface.material = material;
    for (const object of hidden) object.visible = true;
    this.isStale = false;
  }

  /** Among the faces whose last corner is `last`, the one that the ray meets first; its corner nearest to there. */
  nearestCorner(last, ray) {
    const { places, arrays: { faces } } = this.viewer;
    this.facesByLast ??= rowsByLastCorner(faces, places.length / 3);
    const { offsets, rows } = this.facesByLast;
    const corners = [0, 1, 2].map(() => new THREE.Vector3());
    const hit = new THREE.Vector3();
    let best = last;
    let nearest = Infinity;
    for (let r = offsets[last]; r < offsets[last + 1]; r++) {
      const face = faces.subarray(3 * rows[r], 3 * rows[r] + 3);
      corners.forEach((corner, k) => corner.set(...this.viewer.placeOf(face[k])));
      if (!ray.intersectTriangle(...corners, false, hit)) continue;
      const distance = hit.distanceTo(ray.origin);
      if (distance >= nearest) continue;
      nearest = distance;
      const gaps = corners.map((corner) => corner.distanceTo(hit));
      best = face[gaps.indexOf(Math.min(...gaps))];
    }
    return best;
  }
}
