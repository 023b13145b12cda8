"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const make = (tag, text, kind) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (kind) element.className = kind;
  return element;
};
const state = { time: 0, playing: false, last: 0, pointed: null, dirty: true, hidden: new Set() };
const times = new Float32Array(bytes(data.times)), rows = new Float32Array(bytes(data.rows));
const duration = times[times.length - 1], WIDTH = data.robot.arms.reduce((width, arm) => width + arm.joints.length + 1, 3);

// ---- where everything is

function rowAt(time) {
  let low = 0, high = times.length - 1;
  if (time >= times[high]) return rows.slice(WIDTH * high, WIDTH * (high + 1));
  while (high - low > 1) { const middle = (low + high) >> 1; if (times[middle] <= time) low = middle; else high = middle; }
  const span = times[high] - times[low] || 1, share = Math.min(1, Math.max(0, (time - times[low]) / span));
  return Float32Array.from({ length: WIDTH }, (_, i) => rows[WIDTH * low + i] * (1 - share) + rows[WIDTH * high + i] * share);
}

// What the sliders of a robot alone say, else where the film is.
const rowNow = () => inspected.row || rowAt(state.time);

function linksAt(row) {
  const robot = data.robot, T = M.mul(M.move(row[0], row[1], 0), M.rotZ(row[2]));
  const places = { [robot.links[0].name]: T }, tools = [];
  let first = 3;
  for (const arm of robot.arms) {
    let at = places[arm.foot] = M.mul(T, arm.T_base_arm);
    arm.joints.forEach((joint, i) => {
      const q = row[first + i];
      at = places[joint.link] = M.mul(M.mul(at, joint.origin), joint.slides ? M.move(0, 0, q) : M.rotZ(q));
    });
    const hand = places[arm.hand] = M.mul(at, arm.T_flange_hand), opening = row[first + arm.joints.length];
    for (const finger of arm.fingers) {
      const [x, y, z] = finger.axis.map((part) => (part * opening) / 2);
      places[finger.link] = M.mul(M.mul(hand, finger.origin), M.move(x, y, z));
    }
    tools.push(M.mul(hand, arm.T_hand_tool));
    first += arm.joints.length + 1;
  }
  return { places, tools, tool: tools[0] };
}

function placeOf(body, time, tools) {
  let stay = body.stays[0];
  for (const other of body.stays) if (other.since <= time) stay = other;
  return stay.held ? M.mul(tools[stay.arm], stay.T) : stay.T;
}

function actionAt(time) {
  let found = -1;
  data.actions.forEach((action, i) => { if (action.start <= time + 1e-6) found = i; });
  return found;
}

// ---- what is drawn

let drawer;
try { drawer = new Drawer(byId("picture")); } catch (error) {
  byId("trouble").textContent = error.message;
  byId("trouble").hidden = false;
}

const COLOURS = { empty: [0.2, 0.45, 0.85], full: [0.95, 0.45, 0.1], drive: [0.3, 0.3, 0.35], place: [0.2, 0.62, 0.35] };
const PALETTE = ["#d62728", "#ff7f0e", "#9467bd", "#8c564b", "#e377c2", "#17becf", "#7f7f7f", "#b8a000"];
const KEPT = { "in the plan": "#1a9641", accepted: "#2b7de9" };
const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
const pack = (points, colour) => {
  const out = new Float32Array(6 * points.length);
  points.forEach((p, i) => { out.set(p, 6 * i); out.set(Array.isArray(colour[0]) ? colour[i] : colour, 6 * i + 3); });
  return out;
};
const drawn = {};

function prepare() {
  const meshes = (list) => list.map((mesh) => ({ mesh: drawer.buffer(corners(mesh)), colour: mesh.colour }));
  drawn.links = data.robot.links.map((link) => ({ name: link.name, meshes: meshes(link.meshes) }));
  drawn.bodies = data.bodies.map((body) => ({ body, meshes: meshes(body.meshes) }));
  const [x0, x1] = data.room.x, [y0, y1] = data.room.y, far = 4;
  const floor = [[x0 - far, y0 - far, 0], [x1 + far, y0 - far, 0], [x1 + far, y1 + far, 0], [x0 - far, y0 - far, 0], [x1 + far, y1 + far, 0], [x0 - far, y1 + far, 0]];
  drawn.floor = drawer.buffer(pack(floor, [0, 0, 1]));
  drawn.room = drawer.buffer(pack([[x0, y0, 0.002], [x1, y0, 0.002], [x1, y1, 0.002], [x0, y1, 0.002], [x0, y0, 0.002]], [0.6, 0.6, 0.65]));
  drawn.surfaces = data.surfaces.map(({ T, size: [w, d] }) => {
    const ring = [[-w / 2, -d / 2], [w / 2, -d / 2], [w / 2, d / 2], [-w / 2, d / 2], [-w / 2, -d / 2]];
    return drawer.buffer(pack(ring.map(([x, y]) => M.at(T, [x, y, 0.003])), COLOURS.place));
  });
  if (data.actions.length) preparePaths();
  prepareInspection();
  prepareSamples();
}

function preparePaths() {
  const hands = data.robot.arms.map(() => []), tints = data.robot.arms.map(() => []), base = [], held = [];
  for (const body of data.bodies) body.stays.forEach((stay, i) => {
    if (stay.held) held.push([stay.since, body.stays[i + 1] ? body.stays[i + 1].since : duration, stay.arm]);
  });
  for (let i = 0; i < times.length; i++) {
    const row = rows.subarray(WIDTH * i, WIDTH * (i + 1)), tools = linksAt(row).tools;
    tools.forEach((T, arm) => {
      hands[arm].push([T[3], T[7], T[11]]);
      const full = held.some(([a, b, of]) => of === arm && a <= times[i] && times[i] <= b);
      tints[arm].push(full ? COLOURS.full : COLOURS.empty);
    });
    base.push([row[0], row[1], 0.01]);
  }
  drawn.hands = hands.map((hand, arm) => drawer.buffer(pack(hand, tints[arm])));
  drawn.base = drawer.buffer(pack(base, COLOURS.drive));
}

// Samples by what became of them: those of the plan, the accepted ones, and the rejected ones by the test that said no.
const groups = new Map();

function prepareSamples() {
  const tests = [...new Set(data.samples.filter((s) => s.kind === "placement" && s.test).map((s) => s.test))].sort();
  const colour = { ...KEPT };
  tests.forEach((test, i) => { colour["rejected by " + test] = PALETTE[i % PALETTE.length]; });
  for (const sample of data.samples) {
    sample.group = sample.used ? "in the plan" : sample.test ? "rejected by " + sample.test : "accepted";
    if (sample.kind !== "placement") continue;
    if (!groups.has(sample.group)) groups.set(sample.group, { colour: colour[sample.group], samples: [] });
    groups.get(sample.group).samples.push(sample);
  }
  for (const group of groups.values()) {
    const points = group.samples.map(({ T }) => [T[3], T[7], T[11]]);
    group.mesh = drawer.buffer(pack(points, rgb(group.colour)));
  }
  const w = 0.04, glyph = [[0, w, 0], [0, w, -0.045], [0, w, -0.045], [0, -w, -0.045], [0, -w, -0.045], [0, -w, 0], [0, 0, -0.045], [0, 0, -0.1]];
  drawn.grasps = data.samples.filter((s) => s.kind === "grasp").map((sample) => ({
    sample,
    mesh: drawer.buffer(pack(glyph, rgb(sample.used ? KEPT["in the plan"] : sample.test ? PALETTE[0] : KEPT.accepted))),
  }));
}

const shown = (layer) => !state.hidden.has(layer);

function scene() {
  const row = rowNow(), { places, tools, tool } = linksAt(row);
  const solids = [{ mesh: drawn.floor, place: M.one(), paint: [0.86, 0.85, 0.83, 1], floor: true }], lines = [];
  if (shown("links")) for (const link of drawn.links) for (const { mesh, colour } of link.meshes) solids.push({ mesh, place: places[link.name], paint: colour });
  const spots = {}, pointed = state.pointed;
  for (const { body, meshes } of drawn.bodies) {
    const place = spots[body.name] = placeOf(body, state.time, tools);
    const hit = pointed && pointed.others.includes(body.name);
    for (const { mesh, colour } of meshes) solids.push({ mesh, place, paint: hit ? [0.9, 0.1, 0.1, 1] : colour });
    if (pointed && pointed.body === body.name && pointed.kind === "placement")
      for (const { mesh, colour } of meshes) solids.push({ mesh, place: pointed.T, paint: [...colour.slice(0, 3), 0.55] });
  }
  solids.push(...inspectionSolids(places));
  lines.push({ mesh: drawn.room, kind: "LINE_STRIP" }, ...inspectionLines(places));
  if (shown("surfaces")) for (const mesh of drawn.surfaces) lines.push({ mesh, kind: "LINE_STRIP" });
  if (drawn.hands && shown("hand path")) for (const mesh of drawn.hands) lines.push({ mesh, kind: "LINE_STRIP" });
  if (drawn.base && shown("base path")) lines.push({ mesh: drawn.base, kind: "LINE_STRIP" });
  for (const [name, group] of groups) if (shown(name)) lines.push({ mesh: group.mesh, kind: "POINTS", size: 9, round: true, alpha: 0.9 });
  if (shown("grasps")) for (const { sample, mesh } of drawn.grasps)
    lines.push({ mesh, kind: "LINES", place: M.mul(spots[sample.body], M.inverse(sample.T)) });
  return { solids, lines, spots, tool, places };
}

// ---- the camera

const camera = { target: data.view.target.slice(), yaw: data.view.yaw, pitch: data.view.pitch, distance: data.view.distance };

function viewNow() {
  return viewFrom(camera, byId("picture"), data.view.angle, 0.05, 60);
}

function onScreen(view, [x, y, z]) {
  const m = view.matrix, canvas = byId("picture");
  const [a, b, , w] = [0, 1, 2, 3].map((i) => m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z + m[4 * i + 3]);
  return w <= 0.05 ? null : [((a / w + 1) / 2) * canvas.clientWidth, ((1 - b / w) / 2) * canvas.clientHeight];
}

// ---- every frame

const labels = new Map();

function label(view, key, text, point, kind) {
  if (!labels.has(key)) { labels.set(key, byId("names").appendChild(make("span", text, kind))); }
  const spot = onScreen(view, point), element = labels.get(key);
  element.hidden = !spot;
  if (spot) { element.style.left = spot[0].toFixed(1) + "px"; element.style.top = spot[1].toFixed(1) + "px"; }
}

function show() {
  const view = viewNow(), now = scene();
  drawer.draw(now.solids, now.lines, view, data.view.radius, data.view.middle);
  byId("names").hidden = !shown("names");
  if (shown("names")) {
    for (const body of data.bodies) {
      const T = now.spots[body.name];
      if (body.movable) label(view, "body " + body.name, body.name, [T[3], T[7], T[11] + body.height], "");
    }
    for (const { name, T } of data.surfaces) label(view, "place " + name, name, [T[3], T[7], T[11]], "place");
  }
  showSliders(rowNow());
  byId("slider").value = state.time;
  byId("clock").textContent = state.time.toFixed(1) + " / " + duration.toFixed(1) + " s";
  const at = actionAt(state.time);
  byId("now").textContent = at < 0 ? "" : (at + 1) + "  " + data.actions[at].text;
  byId("play").textContent = state.playing ? "\u23F8" : "\u25B6";
  [...byId("actions").children].forEach((item, i) => item.classList.toggle("now", i === at));
}

function tick(stamp) {
  if (state.playing) {
    const passed = state.last ? Math.min(0.25, (stamp - state.last) / 1000) : 0;
    state.time = Math.min(duration, state.time + passed * Number(byId("speed").value));
    if (state.time >= duration) state.playing = false;
    state.dirty = true;
  }
  state.last = stamp;
  if (state.dirty && drawer) { state.dirty = false; show(); }
  requestAnimationFrame(tick);
}

function go(time) { inspected.row = null; state.time = Math.min(duration, Math.max(0, time)); state.dirty = true; }
function play() { inspected.row = null; if (state.time >= duration) state.time = 0; state.playing = !state.playing; state.dirty = true; }
function jump(step) {
  const at = actionAt(state.time), here = data.actions[Math.max(at, 0)];
  const back = step < 0 && state.time > here.start + 0.05;
  const next = data.actions[Math.max(0, back ? at : at + step)];
  go(next ? next.start : duration);
}

// ---- the panel

function check(into, layer, text, colour, note) {
  const row = make("label"), box = make("input");
  box.type = "checkbox"; box.checked = true; box.dataset.layer = layer;
  box.addEventListener("change", () => { if (box.checked) state.hidden.delete(layer); else state.hidden.add(layer); state.dirty = true; });
  row.append(box);
  if (colour) { const dot = make("i"); dot.style.background = colour; row.append(dot); }
  row.append(" " + text);
  if (note) row.append(make("small", note));
  into.append(row);
}

// The most frequent reasons of samples, with their counts.
function reasons(samples) {
  const counts = new Map();
  for (const { why } of samples) if (why) counts.set(why, (counts.get(why) || 0) + 1);
  return [...counts].sort(([, a], [, b]) => b - a).slice(0, 4).map(([why, count]) => count + " " + why).join(", ");
}

function panel() {
  byId("title").textContent = data.title;
  byId("head").textContent = data.story.head;
  data.actions.forEach((action, i) => {
    const item = make("li"), length = make("i", (action.end - action.start).toFixed(1) + " s");
    item.append(length, make("b", action.name), " " + action.about);
    item.addEventListener("click", () => go(action.start));
    item.dataset.number = i + 1;
    byId("actions").append(item);
  });
  if (!data.actions.length) byId("actions").parentElement.hidden = true;
  const layers = byId("layers");
  check(layers, "names", "names");
  check(layers, "surfaces", "surfaces and compartments", "#339e59");
  if (data.actions.length) {
    check(layers, "hand path", "path of the hand (orange: something in it)", "#3373d9");
    check(layers, "base path", "path of the base", "#4d4d59");
  }
  if (data.samples.some((s) => s.kind === "grasp")) check(layers, "grasps", "grasps (green: in the plan)", "#1a9641");
  byId("samples").hidden = groups.size === 0;
  for (const [name, group] of [...groups].sort(([a], [b]) => (a in KEPT ? 0 : 1) - (b in KEPT ? 0 : 1) || (a < b ? -1 : 1)))
    check(byId("tests"), name, name + ": " + group.samples.length, group.colour, name in KEPT ? "" : reasons(group.samples));
  inspectionPanel();
  story();
}

function table(head, lines) {
  const result = make("table"), top = result.appendChild(make("tr"));
  head.forEach((text, i) => top.append(make("th", text, i ? "n" : "")));
  for (const [first, note, ...numbers] of lines) {
    const line = result.appendChild(make("tr")), cell = line.appendChild(make("td", first));
    if (note) cell.append(make("small", note));
    numbers.forEach((text) => line.append(make("td", text, "n")));
  }
  return result;
}

function story() {
  const into = byId("story"), told = data.story;
  if (told.why.length) {
    into.append(make("h2", "Why there is no plan"));
    for (const line of told.why) into.append(make("p", line));
  }
  if (told.skeletons.length) {
    into.append(make("h2", "Skeletons tried"));
    for (const skeleton of told.skeletons) {
      const details = make("details"), list = make("ul");
      details.append(make("summary", skeleton.text), list);
      for (const line of skeleton.lines) list.append(make("li", line));
      into.append(details);
    }
  }
  if (told.search) into.append(make("h2", "Search"), make("p", told.search));
  if (told.streams.length) into.append(make("h2", "Streams"), table(["stream", "tried", "kept", "time"], told.streams));
  if (told.time.length) into.append(make("h2", "Time"), table(["", "seconds"], told.time));
}

// ---- the hands of who looks

function pointing(event) {
  const view = viewNow(), box = byId("picture").getBoundingClientRect();
  const x = event.clientX - box.left, y = event.clientY - box.top;
  let best = null, nearest = 12;
  for (const [name, group] of groups) if (shown(name)) for (const sample of group.samples) {
    const spot = onScreen(view, [sample.T[3], sample.T[7], sample.T[11]]);
    const away = spot ? Math.hypot(spot[0] - x, spot[1] - y) : Infinity;
    if (away < nearest) { nearest = away; best = sample; }
  }
  point(best, x, y);
}

function point(sample, x, y) {
  const tip = byId("tip");
  if (sample !== state.pointed) { state.pointed = sample; state.dirty = true; }
  tip.hidden = !sample;
  if (!sample) return;
  tip.textContent = sample.text;
  tip.style.left = x + 14 + "px"; tip.style.top = y + 14 + "px";
}

function hands() {
  const canvas = byId("picture"), down = new Map();
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.clientX, event.clientY]);
    point(null);
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => down.delete(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) { pointing(event); return; }
    const dx = event.clientX - before[0], dy = event.clientY - before[1];
    down.set(event.pointerId, [event.clientX, event.clientY]);
    lookAround(camera, event, [dx, dy], down.size, viewNow(), (camera.distance * 1.2) / canvas.clientHeight, -0.3);
    state.dirty = true;
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.distance = Math.min(30, Math.max(0.2, camera.distance * Math.exp(event.deltaY * 0.001)));
    state.dirty = true;
  }, { passive: false });
  byId("slider").addEventListener("input", () => { state.playing = false; go(Number(byId("slider").value)); });
  byId("play").addEventListener("click", play);
  byId("back").addEventListener("click", () => jump(-1));
  byId("next").addEventListener("click", () => jump(1));
  window.addEventListener("resize", () => { state.dirty = true; });
  window.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName) || !data.actions.length) return;
    if (event.key === " ") play();
    else if (event.key === "ArrowRight") jump(1);
    else if (event.key === "ArrowLeft") jump(-1);
    else return;
    event.preventDefault();
  });
}
