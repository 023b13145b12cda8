// What a hand does to a scene: looking around, picking a body under the pointer, dragging it over what is below.
const TINTS = [[0.84, 0.2, 0.18], [0.16, 0.4, 0.86], [0.14, 0.6, 0.28], [0.95, 0.55, 0.1]];
const CSS = TINTS.map((rgb) => "rgb(" + rgb.map((x) => Math.round(255 * x)).join(",") + ")");
const ANGLE = 40, RING = 0.014;

const camera = { target: [0, 0, 0.7], yaw: 0, pitch: 0.55, distance: 2 };

function viewNow(canvas) {
  return viewFrom(camera, canvas, ANGLE, 0.02, 60);
}

function onScreen(canvas, view, [x, y, z]) {
  const m = view.matrix;
  const [a, b, , w] = [0, 1, 2, 3].map((i) => m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z + m[4 * i + 3]);
  return w <= 0.02 ? null : [((a / w + 1) / 2) * canvas.clientWidth, ((1 - b / w) / 2) * canvas.clientHeight];
}

// From the eye through a pixel.
function rayAt(canvas, view, x, y) {
  const sx = ((2 * x) / canvas.clientWidth - 1) * (view.aspect / view.f), sy = (1 - (2 * y) / canvas.clientHeight) / view.f;
  return { from: view.eye, along: V.unit(view.ahead.map((a, i) => a + sx * view.right[i] + sy * view.up[i])) };
}

const onPlane = (ray, height) => {
  const t = (height - ray.from[2]) / ray.along[2];
  return t > 0 && t < 50 ? ray.from.map((p, i) => p + t * ray.along[i]) : null;
};

// Where a ray first meets triangles (nine numbers of eighteen each: see corners in draw.js), by Möller and Trumbore.
function meet(data, from, along, nearest) {
  let best = null;
  for (let o = 0; o < data.length; o += 18) {
    const ax = data[o], ay = data[o + 1], az = data[o + 2];
    const ux = data[o + 6] - ax, uy = data[o + 7] - ay, uz = data[o + 8] - az, vx = data[o + 12] - ax, vy = data[o + 13] - ay, vz = data[o + 14] - az;
    const px = along[1] * vz - along[2] * vy, py = along[2] * vx - along[0] * vz, pz = along[0] * vy - along[1] * vx;
    const det = ux * px + uy * py + uz * pz;
    if (Math.abs(det) < 1e-12) continue;
    const tx = from[0] - ax, ty = from[1] - ay, tz = from[2] - az, u = (tx * px + ty * py + tz * pz) / det;
    if (u < 0 || u > 1) continue;
    const qx = ty * uz - tz * uy, qy = tz * ux - tx * uz, qz = tx * uy - ty * ux, v = (along[0] * qx + along[1] * qy + along[2] * qz) / det;
    if (v < 0 || u + v > 1) continue;
    const t = (vx * qx + vy * qy + vz * qz) / det;
    if (t > 1e-4 && t < nearest) { nearest = t; best = { t, normal: V.cross([ux, uy, uz], [vx, vy, vz]) }; }
  }
  return best;
}

// The body that a ray meets first: {body, point, normal, t}.
function pick(bodies, ray, except) {
  let best = null;
  for (const body of bodies) {
    if (body.name === except) continue;
    const back = M.inverse(body.T), from = M.at(back, ray.from), turned = [0, 1, 2].map((i) => V.dot(back.slice(4 * i, 4 * i + 3), ray.along));
    const middle = body.middle.map((m, i) => m - from[i]), ahead = V.dot(middle, turned);
    if (V.dot(middle, middle) - ahead * ahead > body.radius * body.radius) continue;
    for (const part of body.parts) {
      const hit = meet(part.data, from, turned, best ? best.t : Infinity);
      if (!hit) continue;
      const n = V.unit(hit.normal), normal = [0, 1, 2].map((i) => body.T[4 * i] * n[0] + body.T[4 * i + 1] * n[1] + body.T[4 * i + 2] * n[2]);
      const out = V.dot(normal, ray.along) > 0 ? normal.map((x) => -x) : normal;
      best = { body, t: hit.t, normal: out, point: ray.from.map((p, i) => p + hit.t * ray.along[i]) };
    }
  }
  return best;
}

// The box around a body where it is: its lowest and its highest corner.
function boxOf(body) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < 8; k++) {
    const corner = M.at(body.T, [0, 1, 2].map((i) => ((k >> i) & 1 ? body.high[i] : body.low[i])));
    for (let i = 0; i < 3; i++) { low[i] = Math.min(low[i], corner[i]); high[i] = Math.max(high[i], corner[i]); }
  }
  return { low, high };
}

const centreOf = (body) => M.at(body.T, body.middle);

// T turned by an angle about an axis through a point, all in the world.
function turnedAbout(T, axis, angle, point) {
  const [x, y, z] = V.unit(axis), c = Math.cos(angle), s = Math.sin(angle), k = 1 - c;
  const R = [c + x * x * k, x * y * k - z * s, x * z * k + y * s, 0, y * x * k + z * s, c + y * y * k, y * z * k - x * s, 0,
    z * x * k - y * s, z * y * k + x * s, c + z * z * k, 0, 0, 0, 0, 1];
  return M.mul(M.mul(M.move(...point), R), M.mul(M.move(...point.map((p) => -p)), T));
}

// Flat and round things that a hand can take hold of: six numbers a vertex.
function band(inner, outer) {
  const points = [], steps = 72, at = (r, i) => [r * Math.cos((2 * Math.PI * i) / steps), r * Math.sin((2 * Math.PI * i) / steps), 0];
  for (let i = 0; i < steps; i++) points.push(at(inner, i), at(outer, i), at(outer, i + 1), at(inner, i), at(outer, i + 1), at(inner, i + 1));
  return flatMesh(points);
}
const nose = (radius) => flatMesh([[radius + 0.004, -0.014, 0], [radius + 0.034, 0, 0], [radius + 0.004, 0.014, 0]]);
function flatMesh(points) {
  const data = new Float32Array(6 * points.length);
  points.forEach((p, i) => { data.set(p, 6 * i); data.set([0, 0, 1], 6 * i + 3); });
  return data;
}
function liftArrow() {
  const points = [], steps = 16, shaft = 0.004, head = 0.013;
  const at = (r, i, z) => [r * Math.cos((2 * Math.PI * i) / steps), r * Math.sin((2 * Math.PI * i) / steps), z];
  for (let i = 0; i < steps; i++) {
    points.push(at(shaft, i, 0), at(shaft, i + 1, 0), at(shaft, i + 1, 0.07), at(shaft, i, 0), at(shaft, i + 1, 0.07), at(shaft, i, 0.07));
    points.push(at(head, i, 0.07), at(head, i + 1, 0.07), [0, 0, 0.105]);
  }
  const data = new Float32Array(6 * points.length);
  points.forEach((p, i) => { data.set(p, 6 * i); data.set(V.unit([p[0], p[1], 0.01]), 6 * i + 3); });
  return data;
}
