"use strict";
// Matrices are arrays of 16 numbers, row by row; T_a_b takes points of frame b to frame a.
const M = {
  one: () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  mul(a, b) {
    const c = new Array(16);
    for (let i = 0; i < 4; i++)
      for (let j = 0; j < 4; j++) {
        let s = 0;
        for (let k = 0; k < 4; k++) s += a[4 * i + k] * b[4 * k + j];
        c[4 * i + j] = s;
      }
    return c;
  },
  rotZ(q) { const c = Math.cos(q), s = Math.sin(q); return [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]; },
  move(x, y, z) { return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1]; },
  inverse(T) {  // of a rigid one
    const r = [T[0], T[4], T[8], T[1], T[5], T[9], T[2], T[6], T[10]], p = [T[3], T[7], T[11]];
    const o = [0, 1, 2].map((i) => -(r[3 * i] * p[0] + r[3 * i + 1] * p[1] + r[3 * i + 2] * p[2]));
    return [r[0], r[1], r[2], o[0], r[3], r[4], r[5], o[1], r[6], r[7], r[8], o[2], 0, 0, 0, 1];
  },
  at(T, p) {
    return [0, 1, 2].map((i) => T[4 * i] * p[0] + T[4 * i + 1] * p[1] + T[4 * i + 2] * p[2] + T[4 * i + 3]);
  },
};
const V = {
  sub: (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  unit: (a) => { const n = Math.hypot(a[0], a[1], a[2]) || 1; return [a[0] / n, a[1] / n, a[2] / n]; },
};

// A camera looks at `target` from `distance` metres, in the direction of yaw and pitch; `angle` is the height of its picture in degrees.
function viewFrom(camera, canvas, angle, near, far) {
  const { target, yaw, pitch, distance } = camera;
  const out = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
  const eye = target.map((x, i) => x + distance * out[i]), ahead = out.map((x) => -x);
  const right = V.unit(V.cross(ahead, [0, 0, 1])), up = V.cross(right, ahead);
  const f = 1 / Math.tan((angle * Math.PI) / 360);
  const aspect = (canvas.clientWidth || 1) / (canvas.clientHeight || 1);
  const turn = [...right, -V.dot(right, eye), ...up, -V.dot(up, eye), ...out, -V.dot(out, eye), 0, 0, 0, 1];
  const lens = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), (2 * far * near) / (near - far), 0, 0, -1, 0];
  return { matrix: M.mul(lens, turn), eye, right, up, ahead, f, aspect };
}

// What a drag by pixels does to it: two fingers come near, Shift or another button moves, else it turns.
function lookAround(camera, event, [dx, dy], fingers, { right, up }, scale, lowest) {
  if (fingers > 1) camera.distance *= Math.exp((-dy * 0.01) / fingers);
  else if (event.shiftKey || event.buttons & 6) camera.target = camera.target.map((p, i) => p - scale * (dx * right[i] - dy * up[i]));
  else {
    camera.yaw -= dx * 0.007;
    camera.pitch = Math.min(1.55, Math.max(lowest, camera.pitch + dy * 0.007));
  }
}

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

// A mesh of the page's data as corners and normals: shared where faces meet smoothly, a face's own at its edges.
function corners(mesh) {
  const grid = new Uint16Array(bytes(mesh.vertices)), faces = new Uint32Array(bytes(mesh.faces));
  const count = grid.length / 3, at = new Float32Array(grid.length), keys = new Map(), member = new Uint32Array(count);
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 3; k++) at[3 * i + k] = mesh.low[k] + grid[3 * i + k] * mesh.step[k];
    const key = grid[3 * i] + "," + grid[3 * i + 1] + "," + grid[3 * i + 2];
    if (!keys.has(key)) keys.set(key, keys.size);
    member[i] = keys.get(key);
  }
  const summed = new Float32Array(3 * keys.size), own = new Float32Array(faces.length);
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => at.subarray(3 * faces[f + k], 3 * faces[f + k] + 3));
    const n = V.cross(V.sub(b, a), V.sub(c, a)), u = V.unit(n);
    for (let k = 0; k < 3; k++) {
      own[f + k] = u[k];
      for (let corner = 0; corner < 3; corner++) summed[3 * member[faces[f + corner]] + k] += n[k];
    }
  }
  const data = new Float32Array(6 * faces.length);
  for (let f = 0; f < faces.length; f += 3) {
    const face = own.subarray(f, f + 3);
    for (let corner = 0; corner < 3; corner++) {
      const v = faces[f + corner], m = member[v], shared = V.unit(summed.subarray(3 * m, 3 * m + 3));
      const normal = V.dot(shared, face) > 0.75 ? shared : face, o = 6 * (f + corner);
      for (let k = 0; k < 3; k++) { data[o + k] = at[3 * v + k]; data[o + 3 + k] = normal[k]; }
    }
  }
  return data;
}

const SURFACE = [`#version 300 es
layout(location = 0) in vec3 at; layout(location = 1) in vec3 normal;
uniform mat4 camera, place, sun; out vec3 n, p; out vec4 s;
void main() { vec4 w = place * vec4(at, 1.0); p = w.xyz; n = mat3(place) * normal; s = sun * w; gl_Position = camera * w; }`,
`#version 300 es
precision highp float; precision highp sampler2DShadow;
in vec3 n, p; in vec4 s; out vec4 colour; uniform vec4 paint; uniform vec3 eye, light; uniform sampler2DShadow shadows; uniform float floored;
void main() {
  vec3 m = normalize(n); if (dot(m, eye - p) < 0.0) m = -m;
  vec3 q = s.xyz * 0.5 + 0.5; float lit = 0.0;
  for (int i = -1; i < 2; i++) for (int j = -1; j < 2; j++) lit += texture(shadows, vec3(q.xy + vec2(i, j) / 2048.0, q.z - 0.002)) / 9.0;
  if (any(lessThan(q, vec3(0.0))) || any(greaterThan(q, vec3(1.0)))) lit = 1.0;
  float b = 0.5 + 0.12 * m.z + 0.45 * max(dot(m, light), 0.0) * mix(0.55, 1.0, lit);
  vec3 c = paint.rgb;
  if (floored > 0.5) c *= mod(floor(p.x) + floor(p.y), 2.0) < 0.5 ? 1.0 : 0.965;
  colour = vec4(c * b, paint.a);
}`];
const SHADE = [`#version 300 es
layout(location = 0) in vec3 at; uniform mat4 place, sun; void main() { gl_Position = sun * place * vec4(at, 1.0); }`,
`#version 300 es
precision highp float; void main() {}`];
const PLAIN = [`#version 300 es
layout(location = 0) in vec3 at; layout(location = 1) in vec3 tint; uniform mat4 camera, place; uniform float size; out vec3 t;
void main() { t = tint; gl_Position = camera * place * vec4(at, 1.0); gl_PointSize = size; }`,
`#version 300 es
precision highp float; in vec3 t; out vec4 colour; uniform float round, alpha;
void main() { if (round > 0.5 && length(gl_PointCoord - 0.5) > 0.5) discard; colour = vec4(t, alpha); }`];

class Drawer {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("This page draws with WebGL 2, which this browser does not offer.");
    this.surface = this.program(SURFACE); this.shade = this.program(SHADE); this.plain = this.program(PLAIN);
    this.sunward = V.unit([0.35, -0.5, 0.8]);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 2048, 2048);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    this.map = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.map);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }
  program([vertex, fragment]) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const name = gl.getActiveUniform(program, i).name;
      places[name] = gl.getUniformLocation(program, name);
    }
    return { program, places };
  }
  // Six numbers a vertex: where it is, and its normal or its colour.
  buffer(data) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    for (const k of [0, 1]) { gl.enableVertexAttribArray(k); gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 24, 12 * k); }
    return { array, count: data.length / 6 };
  }
  matrix(place, T) { this.gl.uniformMatrix4fv(place, true, T); }

  // solids: {mesh, place, paint: [r, g, b, a], floor?}, clear ones last; lines: {mesh, place, kind, size, round, alpha}.
  draw(solids, lines, view, radius, middle) {
    const gl = this.gl, canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const sun = this.sunView(radius, middle);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.map);
    gl.viewport(0, 0, 2048, 2048);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.shade.program);
    this.matrix(this.shade.places.sun, sun);
    for (const { mesh, place, paint, floor } of solids) {
      if (floor || paint[3] < 1) continue;
      this.matrix(this.shade.places.place, place);
      gl.bindVertexArray(mesh.array); gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.94, 0.95, 0.96, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const { places } = this.surface;
    const paint = (clear) => {
      gl.useProgram(this.surface.program);
      this.matrix(places.camera, view.matrix); this.matrix(places.sun, sun);
      gl.uniform3fv(places.eye, view.eye); gl.uniform3fv(places.light, this.sunward);
      for (const solid of solids) {
        if (solid.paint[3] < 1 !== clear) continue;
        this.matrix(places.place, solid.place);
        gl.uniform4fv(places.paint, solid.paint); gl.uniform1f(places.floored, solid.floor ? 1 : 0);
        gl.bindVertexArray(solid.mesh.array); gl.drawArrays(gl.TRIANGLES, 0, solid.mesh.count);
      }
    };
    paint(false);
    gl.useProgram(this.plain.program);
    this.matrix(this.plain.places.camera, view.matrix);
    gl.enable(gl.BLEND);
    for (const line of lines) {
      this.matrix(this.plain.places.place, line.place || M.one());
      gl.uniform1f(this.plain.places.size, (line.size || 1) * ratio);
      gl.uniform1f(this.plain.places.round, line.round ? 1 : 0);
      gl.uniform1f(this.plain.places.alpha, line.alpha || 1);
      gl.bindVertexArray(line.mesh.array); gl.drawArrays(gl[line.kind], 0, line.mesh.count);
    }
    gl.depthMask(false); paint(true); gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
  sunView(radius, middle) {
    const ahead = this.sunward.map((x) => -x), side = V.unit(V.cross(ahead, [0, 0, 1])), up = V.cross(side, ahead);
    const row = (axis, sign) => [...axis.map((x) => (sign * x) / radius), (-sign * V.dot(axis, middle)) / radius];
    return [...row(side, 1), ...row(up, 1), ...row(ahead, 1), 0, 0, 0, 1];
  }
}
