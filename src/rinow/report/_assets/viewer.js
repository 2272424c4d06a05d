"use strict";
// The surface, or the points of a cloud, in three dimensions: drawing and moving.

const HALF_DIAGONAL = 0.9; // of the unit cube, and a little more
const MARGIN = 1.12; // around the surface at first
const DISC_WIDTH = 1.6; // over the root of the area that a point stands for: few gaps
const UP = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

class Viewer {
  /** Throws where there is no WebGL. */
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.arrays = scene.arrays;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setClearColor(0, 0);
    [this.places, this.unitsPerLength] = unitPlaces(scene.arrays.positions, scene.frame, scene.step);
    this.isCloud = !scene.arrays.turned;
    this.uniforms = { smoothing: { value: 1 }, scale: { value: 1 } };
    this.tints = new Uint8Array(4 * scene.vertices).fill(255);
    this.world = new THREE.Scene();
    this.layers = new Map();
    this.world.add((this.surface = this.makeSurface()));
    this.world.add((this.marker = this.makePoints([0], MARK_FRAGMENT, 15)));
    this.marker.visible = false;
    this.camera = new THREE.PerspectiveCamera(24, 1);
    this.picker = new Picker(this);
    this.reset(scene.up);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  defines() {
    return this.isCloud ? { DISCS: "" } : {};
  }

  makeSurface() {
    const { faces, turned, normals, areas } = this.arrays;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.places, 3));
    geometry.setAttribute("tint", new THREE.BufferAttribute(this.tints, 4, true));
    const smooth = this.isCloud ? [normals, 3] : [vertexNormals(this.places, faces, turned), 4];
    geometry.setAttribute("smoothNormal", new THREE.BufferAttribute(...smooth, true));
    if (this.isCloud) {
      const sizes = Float32Array.from(areas, (area) => DISC_WIDTH * Math.sqrt(area) * this.unitsPerLength);
      geometry.setAttribute("size", new THREE.BufferAttribute(sizes, 1));
    }
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    const material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: SURFACE_VERTEX, fragmentShader: SURFACE_FRAGMENT,
      side: THREE.DoubleSide, uniforms: this.uniforms, defines: this.defines(),
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    const surface = this.isCloud ? new THREE.Points(geometry, material) : new THREE.Mesh(geometry, material);
    surface.frustumCulled = false;
    return surface;
  }

  makePoints(vertices, fragmentShader, size, ink = [0, 0, 0]) {
    const places = new Float32Array(3 * vertices.length);
    vertices.forEach((v, i) => places.set(this.placeOf(v), 3 * i));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    const material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: POINT_VERTEX, fragmentShader,
      uniforms: { ink: { value: ink }, size: { value: size * Math.min(devicePixelRatio, 2) } },
    });
    const points = new THREE.Points(geometry, material);
    points.frustumCulled = false;
    return points;
  }

  makeLines(places, color, linewidth) {
    const geometry = new THREE.LineSegmentsGeometry().setPositions(places);
    const material = new THREE.LineMaterial({ color, linewidth, polygonOffset: true, polygonOffsetUnits: -4 });
    const lines = new THREE.LineSegments2(geometry, material);
    lines.frustumCulled = false;
    return lines;
  }

  placeOf(vertex) {
    return this.places.subarray(3 * vertex, 3 * vertex + 3);
  }

  /** Show or hide a layer; `make` builds its objects when it is shown for the first time. */
  toggle(name, shown, make) {
    if (shown && !this.layers.has(name)) {
      this.layers.set(name, make());
      this.world.add(...this.layers.get(name));
    }
    for (const object of this.layers.get(name) ?? []) object.visible = shown;
    this.draw();
  }

  showEdges(shown) {
    this.toggle("edges", shown, () => {
      const material = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, wireframe: true, transparent: true, depthWrite: false,
        vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
        fragmentShader: "precision highp float; layout(location = 0) out vec4 c; void main() { c = vec4(0, 0, 0, 0.28); }",
      });
      const edges = new THREE.Mesh(this.surface.geometry, material);
      edges.frustumCulled = false;
      return [edges];
    });
  }

  showDirections(shown, areas) {
    const { direction_vertices: vertices, direction1, direction2 } = this.arrays;
    const cell = 0.9 / Math.sqrt(vertices.length);
    const make = (directions, colour) => {
      const places = new Float32Array(6 * vertices.length);
      vertices.forEach((v, i) => {
        const half = 0.42 * Math.min(cell, Math.sqrt(areas[v]) * this.unitsPerLength);
        for (let c = 0; c < 3; c++) {
          const reach = (half * directions[3 * i + c]) / 127;
          places[6 * i + c] = this.places[3 * v + c] - reach;
          places[6 * i + 3 + c] = this.places[3 * v + c] + reach;
        }
      });
      return this.makeLines(places, colour, 1.5);
    };
    this.toggle("directions", shown, () => [make(direction1, 0x101010), make(direction2, 0x00a36c)]);
  }

  showFeatures(shown) {
    const { crease_edges: edges, corners, cone_points: cones } = this.arrays;
    this.toggle("features", shown, () => {
      const places = new Float32Array(3 * edges.length);
      edges.forEach((v, i) => places.set(this.placeOf(v), 3 * i));
      const lines = this.makeLines(places, 0xffb000, 2.5);
      return [lines, this.makePoints(cones, POINT_FRAGMENT, 12, [0.86, 0.15, 0.5]),
        this.makePoints(corners, POINT_FRAGMENT, 7, [0.1, 0.1, 0.1])];
    });
  }

  showSmooth(smooth) {
    this.uniforms.smoothing.value = smooth ? 1 : 0;
    this.draw();
  }

  coloursChanged() {
    this.surface.geometry.attributes.tint.needsUpdate = true;
    this.draw();
  }

  /** The view of the still picture: from a sixth of a turn aside and a little above. */
  reset(up) {
    const axis = new THREE.Vector3(...UP[up]);
    const east = new THREE.Vector3(...UP[up === "x" ? "y" : up === "y" ? "z" : "x"]);
    const north = new THREE.Vector3().crossVectors(axis, east);
    this.camera.up.copy(axis);
    this.camera.position.copy(axis).multiplyScalar(0.45)
      .addScaledVector(east, Math.cos(-Math.PI / 3)).addScaledVector(north, Math.sin(-Math.PI / 3));
    this.camera.position.normalize().multiplyScalar(this.distance());
    this.controls?.dispose();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    Object.assign(this.controls, { zoomToCursor: true, minDistance: 0.02, maxDistance: 20, rotateSpeed: 0.9 });
    this.controls.addEventListener("change", () => this.draw());
    this.draw();
  }

  /** Distance from which all of the surface is seen in the present direction. */
  distance() {
    const towards = this.camera.position.clone().normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, towards).normalize();
    const above = new THREE.Vector3().crossVectors(towards, right);
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    const place = new THREE.Vector3();
    let distance = 0;
    for (let i = 0; i < this.places.length; i += 3) {
      place.fromArray(this.places, i);
      if (place.length() > HALF_DIAGONAL) continue; // a vertex that no face has
      const reach = Math.max(Math.abs(place.dot(above)), Math.abs(place.dot(right)) / this.camera.aspect);
      distance = Math.max(distance, place.dot(towards) + (MARGIN * reach) / slope);
    }
    return distance || 1;
  }

  /** Turn by angles about the up axis and towards it, as with the arrow keys. */
  turn(sideways, upwards) {
    const towards = this.camera.position.clone().sub(this.controls.target);
    const right = new THREE.Vector3().crossVectors(this.camera.up, towards).normalize();
    const tilt = towards.angleTo(this.camera.up);
    const step = Math.min(tilt - 0.02, Math.max(tilt - Math.PI + 0.02, upwards));
    towards.applyAxisAngle(right, -step).applyAxisAngle(this.camera.up, sideways);
    this.camera.position.copy(this.controls.target).add(towards);
    this.controls.update();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
  }

  /** Look at a vertex from outside. */
  centre(vertex) {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const { array, itemSize } = this.surface.geometry.attributes.smoothNormal;
    const normal = new THREE.Vector3().fromArray(array, itemSize * vertex);
    const towards = this.camera.position.clone().sub(this.controls.target);
    if (normal.length() === 0) normal.copy(towards);
    if (this.isCloud && normal.dot(towards) < 0) normal.negate(); // its sign is not known
    this.controls.target.fromArray(this.places, 3 * vertex);
    this.camera.position.copy(this.controls.target).addScaledVector(normal.normalize(), distance);
    this.controls.update();
  }

  mark(vertex) {
    this.marker.visible = vertex >= 0;
    if (vertex >= 0) this.marker.position.set(...this.placeOf(vertex)).sub(new THREE.Vector3(...this.placeOf(0)));
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.picker.resize(width, height);
    this.drawNow();
  }

  /** Draw before the next frame of the screen, once however often it is asked for. */
  draw() {
    this.picker.isStale = true;
    this.frame ??= requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    if (this.frame) cancelAnimationFrame(this.frame);
    this.frame = undefined;
    this.picker.isStale = true;
    const distance = this.camera.position.length();
    this.camera.near = Math.max(0.003, distance - HALF_DIAGONAL);
    this.camera.far = distance + HALF_DIAGONAL;
    this.camera.updateProjectionMatrix();
    this.scaleDiscs(this.canvas.height);
    this.renderer.render(this.world, this.camera);
  }

  /** Tell the shaders how many pixels a unit of length is at distance 1. */
  scaleDiscs(height) {
    this.uniforms.scale.value = height / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
  }

  /** Picture of the present view. */
  snapshot() {
    this.drawNow();
    return this.canvas;
  }
}
