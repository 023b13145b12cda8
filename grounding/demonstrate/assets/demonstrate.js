// The page of tamp-demo: a scene, a hand, labels. The server keeps the scene and the files; the poses are ours until they are labelled.
const byId = (id) => document.getElementById(id);
const make = (tag, text, kind) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (kind) element.className = kind;
  return element;
};
const canvas = byId("picture");
const state = {
  records: null, stage: null, bodies: [], selected: null, over: null, hold: null, undo: [], redo: [], dirty: true, busy: 0, odd: null, ready: false,
};
let drawer, checking = 0, toasting = 0;

// ---- the server

async function ask(path, message) {
  state.busy++;
  try {
    const answer = await fetch("/" + path, message === undefined ? {} : {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(message),
    });
    const said = await answer.json();
    if (said.error) throw new Error(said.error);
    return said;
  } catch (error) {
    toast(error instanceof TypeError ? "tamp-demo does not answer: it has ended. Everything that was labelled is saved." : error.message, "error");
    return null;
  } finally { state.busy--; }
}

const poses = () => Object.fromEntries(state.bodies.filter((body) => body.movable).map((body) => [body.name, body.T]));
const about = (more) => ({ stage: state.stage.number, poses: poses(), ...more });

function take(said) {
  if (!said) return false;
  if (said.relation) { state.records = said; panel(); }
  if (said.stage) { state.asked = Boolean(said.asked); setStage(said.stage); todo(); }
  return true;
}

function toast(text, kind) {
  const element = byId("toast");
  element.textContent = text; element.className = kind || ""; element.hidden = false;
  clearTimeout(toasting);
  toasting = setTimeout(() => { element.hidden = true; }, kind === "error" ? 7000 : kind === "long" ? 60000 : 2200);
}

// ---- the scene

function setStage(stage) {
  const kept = state.stage && state.stage.number === stage.number;
  state.stage = stage; state.undo = []; state.redo = []; state.odd = null;
  byId("names").replaceChildren(); labels.clear();
  state.bodies = stage.bodies.map((body) => {
    const parts = body.meshes.map((mesh) => { const data = corners(mesh); return { data, mesh: drawer.buffer(data), colour: mesh.colour }; });
    const middle = body.low.map((x, i) => (x + body.high[i]) / 2), radius = Math.hypot(...body.high.map((x, i) => x - middle[i]));
    return { ...body, parts, middle, radius, argument: stage.arguments.indexOf(body.name) };
  });
  const first = state.bodies.find((body) => body.argument === 0 && body.movable) || state.bodies.find((body) => body.movable);
  select(first ? first.name : null);
  if (!kept) Object.assign(camera, { target: stage.view.target.slice(), yaw: stage.view.yaw, pitch: 0.62, distance: (1.15 * stage.view.radius) / Math.sin((ANGLE * Math.PI) / 360) });
  drawer.sunward = V.unit([Math.cos(camera.yaw - 0.7), Math.sin(camera.yaw - 0.7), 1.25]);  // over the viewer's left shoulder
  const [x, y] = stage.view.target, far = stage.floor;
  const corner = [[x - far, y - far, 0], [x + far, y - far, 0], [x + far, y + far, 0], [x - far, y - far, 0], [x + far, y + far, 0], [x - far, y + far, 0]];
  state.floor = drawer.buffer(flatMesh(corner));
  fact();
  trouble([]);
  checkSoon();
}

const named = (name) => state.bodies.find((body) => body.name === name);
const selected = () => named(state.selected);

function select(name) {
  state.selected = name;
  const body = named(name);
  if (body) {
    const size = [0, 1].map((i) => boxOf(body).high[i] - boxOf(body).low[i]);
    body.ring = Math.max(0.05, Math.hypot(...size) / 2 + 0.012);
    state.ring = drawer.buffer(band(body.ring, body.ring + RING));
    state.nose = drawer.buffer(nose(body.ring + RING));
    state.arrow = state.arrow || drawer.buffer(liftArrow());
  }
  state.dirty = true;
}

// Which way the body's own x axis points, from above; null where it stands on end.
function noseOf(body) {
  const [x, y] = [body.T[0], body.T[4]];
  return Math.hypot(x, y) > 0.5 ? Math.atan2(y, x) : null;
}

function drawn() {
  const solids = [{ mesh: state.floor, place: M.one(), paint: [0.84, 0.83, 0.81, 1], floor: true }], lines = [];
  for (const body of state.bodies) for (const part of body.parts) solids.push({ mesh: part.mesh, place: body.T, paint: part.colour });
  for (const body of state.bodies) {
    if (!body.movable || (body.argument < 0 && body.name !== state.selected)) continue;
    const chosen = body.name === state.selected, tint = body.argument < 0 ? [0.35, 0.38, 0.42] : TINTS[body.argument];
    const box = boxOf(body), centre = centreOf(body), angle = noseOf(body);
    if (!chosen) continue;
    const foot = M.mul(M.move(centre[0], centre[1], box.low[2] + 0.0015), M.rotZ(angle || 0));
    const lit = (kind) => (state.over === kind || (state.hold && state.hold.kind === kind) ? 0.95 : 0.55);
    solids.push({ mesh: state.ring, place: foot, paint: [...tint, lit("turn")] });
    if (angle !== null) solids.push({ mesh: state.nose, place: foot, paint: [...tint, lit("turn")] });
    solids.push({ mesh: state.arrow, place: M.move(centre[0], centre[1], box.high[2] + 0.012), paint: [...tint, lit("lift")] });
    if (box.low[2] > 0.002) {  // how high it is: a line down to what is below
      const under = pick(state.bodies, { from: [centre[0], centre[1], box.low[2] - 0.0005], along: [0, 0, -1] }, body.name);
      const to = under ? under.point[2] : 0;
      if (box.low[2] - to > 0.004) lines.push({ mesh: drawer.buffer(new Float32Array([centre[0], centre[1], box.low[2], ...tint, centre[0], centre[1], to, ...tint])), kind: "LINES" });
    }
  }
  return { solids, lines };
}

const labels = new Map();

function nameTags(view) {
  const shown = new Set();
  for (const body of state.bodies) {
    if (body.argument < 0 && body.name !== state.selected && body.name !== state.over) continue;
    if (!body.movable && body.argument < 0) continue;
    const argument = body.argument < 0 ? "" : state.records.relation.arguments[body.argument].name;
    tag(view, body.name, argument || body.name, [...centreOf(body).slice(0, 2), boxOf(body).high[2] + (body.name === state.selected ? 0.12 : 0.005)], body.argument, shown);
  }
  state.stage.places.forEach((place) => {
    const argument = state.stage.arguments.indexOf(place.name);
    if (argument >= 0 && !named(place.name)?.movable) {
      const at = M.at(place.T, [0, -place.size[1] / 2, 0]);
      tag(view, "place " + place.name, state.records.relation.arguments[argument].name + ": " + place.name, at, argument, shown);
    }
  });
  if (state.stage.front) tag(view, "front", "front", state.stage.front, -1, shown);
  for (const [key, element] of labels) if (!shown.has(key)) element.hidden = true;
}

function tag(view, key, text, point, argument, shown) {
  if (!labels.has(key)) labels.set(key, byId("names").appendChild(make("span")));
  const spot = onScreen(canvas, view, point), element = labels.get(key);
  element.textContent = text;
  element.className = argument < 0 ? "" : "argument";
  element.style.background = argument < 0 ? "" : CSS[argument];
  element.hidden = !spot;
  shown.add(key);
  if (spot) { element.style.left = spot[0].toFixed(1) + "px"; element.style.top = spot[1].toFixed(1) + "px"; }
}

function tick() {
  if (state.dirty && drawer && state.stage) {
    state.dirty = false;
    const view = viewNow(canvas), { solids, lines } = drawn();
    drawer.draw(solids, lines, view, 1.6, camera.target);
    nameTags(view);
  }
  requestAnimationFrame(tick);
}

// ---- moving bodies

const clone = () => new Map(state.bodies.map((body) => [body.name, body.T]));
const put = (kept) => { for (const body of state.bodies) body.T = kept.get(body.name); select(state.selected); };

function remember() { state.undo.push(clone()); if (state.undo.length > 200) state.undo.shift(); state.redo = []; }

function changed() { state.dirty = true; state.odd = null; checkSoon(); }

function back(from, to) {
  if (!from.length) return;
  to.push(clone());
  put(from.pop());
  changed();
}

// The server puts a body down or drops it; what a hand does to it meanwhile counts more.
function settle(body, action) {
  const stage = state.stage.number, sent = body.T;
  state.settling = ask(action, about({ body: body.name })).then((said) => {
    if (said && state.stage.number === stage && body.T === sent) { body.T = said.T; changed(); }
  });
  return state.settling;
}

function move(body, T) { remember(); body.T = T; changed(); }

function turn(body, angle) { move(body, turnedAbout(body.T, [0, 0, 1], angle, centreOf(body))); }

function otherFace(body) {
  if (!body.faces.length) return;
  const down = (R) => [R[6], R[7], R[8]], now = [body.T[8], body.T[9], body.T[10]];
  const at = body.faces.findIndex((R) => V.dot(down(R), now) > 0.97), next = body.faces[(at + 1) % body.faces.length];
  const from = at < 0 ? null : body.faces[at], T = body.T;
  // keep the turn about the vertical: R_now = yaw @ R_face
  let yaw = 0;
  if (from) {
    const Y = [0, 1].map((i) => [0, 1].map((j) => [0, 1, 2].reduce((sum, k) => sum + T[4 * i + k] * from[3 * j + k], 0)));
    yaw = Math.atan2(Y[1][0] - Y[0][1], Y[0][0] + Y[1][1]);
  }
  const centre = centreOf(body), foot = boxOf(body).low[2];
  const R = [next[0], next[1], next[2], 0, next[3], next[4], next[5], 0, next[6], next[7], next[8], 0, 0, 0, 0, 1];
  const turned = M.mul(M.rotZ(yaw), R), spot = M.at(turned, body.middle);
  remember();
  body.T = M.mul(M.move(centre[0] - spot[0], centre[1] - spot[1], 0), turned);
  body.T = M.mul(M.move(0, 0, foot - boxOf(body).low[2] + 0.001), body.T);
  select(body.name);
  changed();
  return settle(body, "put_down");
}

function tilt(body, away) {
  const view = viewNow(canvas);
  move(body, turnedAbout(body.T, view.right, (away ? -1 : 1) * (Math.PI / 18), centreOf(body)));
}

function nudge(body, right, ahead) {
  const view = viewNow(canvas), forward = V.unit([view.ahead[0], view.ahead[1], 0]);
  move(body, M.mul(M.move(right * view.right[0] + ahead * forward[0], right * view.right[1] + ahead * forward[1], 0), body.T));
}

const raise = (body, by) => move(body, M.mul(M.move(0, 0, by), body.T));

function nextBody(step) {
  const movable = state.bodies.filter((body) => body.movable).sort((a, b) => (a.argument + 9) % 9 - (b.argument + 9) % 9);
  const order = movable.filter((body) => body.argument >= 0).concat(movable.filter((body) => body.argument < 0));
  if (!order.length) return;
  const at = order.findIndex((body) => body.name === state.selected);
  select(order[(at + step + order.length) % order.length].name);
}

// What a pointer is over: "lift" and "turn" of the selected body, or a body's name.
function under(x, y) {
  const view = viewNow(canvas), ray = rayAt(canvas, view, x, y), hit = pick(state.bodies, ray), body = selected();
  if (body) {
    const box = boxOf(body), [cx, cy] = centreOf(body);
    const foot = onScreen(canvas, view, [cx, cy, box.high[2] + 0.012]), head = onScreen(canvas, view, [cx, cy, box.high[2] + 0.117]);
    if (foot && head) {
      const along = [head[0] - foot[0], head[1] - foot[1]], length = along[0] ** 2 + along[1] ** 2 || 1;
      const t = Math.max(0, Math.min(1, ((x - foot[0]) * along[0] + (y - foot[1]) * along[1]) / length));
      if (Math.hypot(x - foot[0] - t * along[0], y - foot[1] - t * along[1]) < 9) return { kind: "lift", body, ray };
    }
    const spot = onPlane(ray, box.low[2] + 0.0015);
    if (spot) {
      const away = Math.hypot(spot[0] - cx, spot[1] - cy), far = Math.hypot(...spot.map((p, i) => p - ray.from[i]));
      const covered = hit && hit.t < far - 0.01;
      if (!covered && away > body.ring - 0.006 && away < body.ring + RING + 0.036) return { kind: "turn", body, ray, angle: Math.atan2(spot[1] - cy, spot[0] - cx) };
    }
  }
  return hit && hit.body.movable ? { kind: "move", body: hit.body, ray, hit } : null;
}

function grab(x, y) {
  const found = under(x, y);
  if (!found) return null;
  const { body } = found, box = boxOf(body), centre = centreOf(body);
  if (body.name !== state.selected) select(body.name);
  const hold = { ...found, T: body.T, x, y, centre, moved: false, before: clone(), level: box.low[2] };
  if (found.kind === "move") {
    const spot = onPlane(found.ray, box.low[2]) || found.hit.point;
    hold.offset = [centre[0] - spot[0], centre[1] - spot[1]];
    if (Math.hypot(...hold.offset) > 0.5) hold.offset = [0, 0];
    const below = pick(state.bodies, { from: [centre[0], centre[1], box.low[2] + 0.001], along: [0, 0, -1] }, body.name);
    hold.below = below ? below.body.name : null;
  }
  return hold;
}

function drag(hold, x, y) {
  if (!hold.moved && Math.hypot(x - hold.x, y - hold.y) < 3) return;
  hold.moved = true;
  const view = viewNow(canvas), ray = rayAt(canvas, view, x, y), { body } = hold;
  if (hold.kind === "lift") {
    const away = Math.hypot(...hold.centre.map((p, i) => p - view.eye[i]));
    body.T = M.mul(M.move(0, 0, ((hold.y - y) * 2 * away) / (canvas.clientHeight * view.f)), hold.T);
  } else if (hold.kind === "turn") {
    const spot = onPlane(ray, hold.level);
    if (spot) body.T = turnedAbout(hold.T, [0, 0, 1], Math.atan2(spot[1] - hold.centre[1], spot[0] - hold.centre[0]) - hold.angle, hold.centre);
  } else {
    // Over what is under the pointer: a table, another body's top, the inside of a box; beside a wall it stays on its level.
    // Along what it stood on it goes as it was taken hold of; onto anything else, with its middle where the pointer is.
    const hit = pick(state.bodies, ray, body.name), floor = onPlane(ray, 0);
    let spot = hit && hit.normal[2] > 0.7 ? hit.point : null;
    if (!hit && floor) spot = floor;
    if (!spot) spot = onPlane(ray, hold.level);
    if (!spot) return;
    hold.level = spot[2];
    const same = !hit || hit.normal[2] <= 0.7 || hit.body.name === hold.below, [dx, dy] = same ? hold.offset : [0, 0];
    const low = boxOf(body).low[2], centre = centreOf(body);
    body.T = M.mul(M.move(spot[0] + dx - centre[0], spot[1] + dy - centre[1], spot[2] + 0.001 - low), body.T);
  }
  state.dirty = true;
}

function release(hold) {
  if (!hold.moved) return;
  state.undo.push(hold.before); state.redo = [];
  changed();
  if (hold.kind === "move") settle(hold.body, "put_down");
}

// ---- what is wrong, and labels

function checkSoon() { clearTimeout(checking); checking = setTimeout(check, 250); }

async function check() {
  if (state.hold || state.busy) { checkSoon(); return; }
  const stage = state.stage.number, kept = JSON.stringify(poses()), said = await ask("check", about({}));
  if (said && state.stage.number === stage && kept === JSON.stringify(poses()) && state.odd === null) { trouble(said.troubles); opinion(said.opinion); }
}

function trouble(lines, asked) {
  const element = byId("trouble");
  element.hidden = !lines.length;
  element.textContent = lines.join("\n");
  element.className = asked ? "asked" : "";
}

async function label(holds) {
  if (state.labelling) return;
  state.labelling = true;
  try {
    await state.settling;
    const anyway = state.odd === holds, said = await ask("label", about({ holds, anyway, next: byId("after").checked }));
    if (!said) return;
    if (said.odd) {
      state.odd = holds;
      trouble([...said.odd, "Mend it (D drops, S puts down, Z takes back), or press " + (holds ? "H" : "N") + " again to keep it as it is."], true);
      return;
    }
    take(said);
    state.odd = null;
    if (!said.stage) checkSoon();
    toast(said.saved + " saved: " + state.records.relation.name + (holds ? " holds" : " does not hold"));
  } finally { state.labelling = false; }
}

async function nextScene() { take(await ask("next", {})); }

// Left, right and behind are said by who stands before the furniture: on the side from which the picture is seen.
async function frontHere() {
  if (take(await ask("front", about({ yaw: camera.yaw })))) toast("the front is here now: left, right and behind are said from this side");
}

async function askMe() {
  if (!state.records.learned) return;
  toast("looking for a telling scene, some seconds \u2026", "long");
  if (take(await ask("ask", {}))) byId("toast").hidden = true;
}

// ---- the panel

function fact() {
  const { relation } = state.records, into = byId("fact");
  into.replaceChildren(make("span", relation.name + " ( "));
  state.stage.arguments.forEach((name, i) => {
    const dot = make("i"), choose = make("select");
    dot.style.background = CSS[i];
    for (const choice of state.stage.choices[i]) choose.append(new Option(choice, choice, false, choice === name));
    choose.title = "argument " + relation.arguments[i].name + ": choose another body or place of this scene";
    choose.setAttribute("aria-label", choose.title);
    choose.addEventListener("change", async () => {
      const kept = { ...camera };
      choose.blur();
      if (take(await ask("assign", about({ argument: i, name: choose.value })))) { Object.assign(camera, kept); state.dirty = true; }
    });
    if (i) into.append(make("span", " , "));
    into.append(dot, choose);
  });
  into.append(make("span", " )"));
}

function todo() {
  byId("todo").textContent = state.asked ? "Does " + state.records.relation.name + " hold here? Press H or N: what was learned is least sure of this one." : state.records.todo;
}

function panel() {
  const { relation, holding, other, cards } = state.records;
  byId("holds-text").textContent = relation.name + " holds";
  todo();
  document.title = relation.text + " \u00b7 tamp-demo";
  for (const [name, count] of [["holds", holding], ["fails", other]]) {
    byId("bar-" + name).style.width = Math.min(100, 10 * count) + "%";
    byId("count-" + name).textContent = count + " / 10";
  }
  byId("hints").replaceChildren(...state.records.hints.map((hint) => make("li", hint.text, hint.kind)));
  const contradicted = new Set(state.records.hints.filter((hint) => hint.kind === "contradiction").flatMap((hint) => hint.files));
  byId("cards").replaceChildren(...cards.map((one) => card(one, contradicted)).reverse());
  byId("saved").textContent = cards.length ? "All are saved in " + state.records.folder + ". Click one to show a variant of it." : "Each label is saved at once in " + state.records.folder + ".";
  byId("restore").hidden = !state.records.restorable;
  byId("learn-command").textContent = state.records.commands.learn;
  byId("plan-command").textContent = state.records.commands.plan;
  enable();
  byId("meaning").textContent = relation.meaning ? relation.text + ": " + relation.meaning : "";
  if (!byId("relation").classList.contains("changed")) form(relation);
}

function card(one, contradicted) {
  const kind = one.error ? "bad" : one.labels.every(Boolean) ? "" : one.labels.some(Boolean) ? "mixed" : "fails";
  const element = make("div", undefined, "card " + kind + (contradicted.has(one.name) ? " named" : ""));
  element.dataset.name = one.name;
  element.title = one.error ? one.name + ": " + one.error : one.name;
  if (!one.error) {
    const image = make("img");
    image.alt = one.name; image.src = "/thumbnails/" + encodeURIComponent(one.name) + "?" + one.stamp;
    element.append(image);
  }
  const said = one.labels.length === 1 ? (one.labels[0] ? "holds" : "does not") : one.labels.length + " labels";
  element.append(make("span", one.error ? "not readable" : said));
  const remove = make("button", "\u00d7"), flip = make("button", "\u21c4", "flip");
  remove.title = "Delete " + one.name; flip.title = "It was labelled by mistake: say the opposite";
  remove.addEventListener("click", async (event) => { event.stopPropagation(); take(await ask("delete", { name: one.name })); });
  flip.addEventListener("click", async (event) => { event.stopPropagation(); take(await ask("flip", { name: one.name })); });
  if (one.labels.length === 1) element.append(flip);
  element.append(remove);
  if (!one.error) element.addEventListener("click", async () => { if (take(await ask("open", { name: one.name }))) toast("a copy of " + one.name + ": show a variant of it"); });
  return element;
}

// The form that says what the relation is.
function form(relation) {
  const { presets } = state.records, choose = byId("presets");
  choose.replaceChildren(new Option("a relation of your own", ""), ...presets.map(({ text, meaning }) => new Option(text.split("(")[0] + ": " + meaning, text)));
  choose.value = presets.some(({ text }) => text === relation.text) ? relation.text : "";
  byId("name").value = relation.name;
  byId("arguments").replaceChildren();
  relation.arguments.forEach(argumentRow);
  byId("relation").classList.remove("changed");
}

function argumentRow({ name, kind }) {
  const rows = byId("arguments"), row = rows.appendChild(make("div", undefined, "row")), dot = row.appendChild(make("i"));
  dot.style.background = CSS[rows.children.length - 1];
  const input = row.appendChild(make("input"));
  input.value = name; input.maxLength = 40; input.spellcheck = false; input.setAttribute("aria-label", "Name of the argument");
  const choose = row.appendChild(make("select"));
  choose.setAttribute("aria-label", "Kind of the argument");
  for (const one of state.records.kinds) choose.append(new Option(one, one, false, one === kind));
  const remove = row.appendChild(make("button", "\u00d7"));
  remove.type = "button"; remove.title = "One argument fewer";
  remove.addEventListener("click", () => { row.remove(); edited(); });
  byId("more").disabled = rows.children.length >= TINTS.length;
}

function edited() {
  byId("relation").classList.add("changed");
  [...byId("arguments").children].forEach((row, i) => { row.firstChild.style.background = CSS[i]; });
  byId("more").disabled = byId("arguments").children.length >= TINTS.length;
}

const formText = () => byId("name").value.trim() + "(" + [...byId("arguments").children].map((row) => row.querySelector("input").value.trim() + ": " + row.querySelector("select").value).join(", ") + ")";

async function useRelation(text) {
  const said = await ask("relation", { text });
  if (!said) return;
  byId("relation").classList.remove("changed");
  for (const id of ["learned", "planned", "watch", "opinion"]) byId(id).hidden = true;
  take(said);
}

// ---- learning and planning

async function run(action, message) {
  const said = await ask(action, message);
  if (said) { showRun(said); follow(); }
}

async function follow() {
  await new Promise((done) => setTimeout(done, 300));
  const said = await ask("run");
  if (!said) return;
  showRun(said);
  if (said.running) { follow(); return; }
  take(await ask("records", {}));
  checkSoon();
}

// What a command says, in paragraphs; the change of a domain's file is folded away.
function showRun({ command, running, code, text }) {
  for (const id of ["learn", "plan"]) byId(id).dataset.running = running && command.endsWith(id === "learn" ? "learn" : "solve") ? "yes" : "";
  if (command) {
    const learning = command === "tamp-learn", into = byId(learning ? "learned" : "planned");
    into.hidden = false;
    into.className = "said" + (running || code === 0 ? "" : " failed");
    into.dataset.code = running ? "" : String(code);
    const news = text.split("\n").filter((line) => PROGRESS.test(line)).pop(), kept = text.split("\n").filter((line) => !PROGRESS.test(line)).join("\n").trim();
    into.replaceChildren(...(learning ? paragraphs(kept) : kept ? [make("pre", kept)] : []));
    if (running) into.append(make("p", news ? news.trim() : learning ? "learning \u2026" : "planning \u2026", "hint"));
    if (!learning) byId("watch").hidden = running || code !== 0;
  }
  enable();
}

const PROGRESS = /^ +\S.* \d+\.\d s$/;  // a line that says how long it has been searching

function paragraphs(text) {
  const lines = text.split("\n"), first = lines.findIndex((line) => line.startsWith("--- ")), elements = [];
  const last = first < 0 ? -1 : lines.findIndex((line, i) => i > first && !/^[-+@ ]/.test(line));
  lines.forEach((line, i) => {
    if (first >= 0 && i >= first && (last < 0 || i < last)) {
      if (i > first) return;
      const details = make("details");
      details.append(make("summary", "what was added to the domain"), make("pre", lines.slice(first, last < 0 ? lines.length : last).join("\n")));
      elements.push(details);
    } else if (line.trim()) elements.push(make("p", line.trim(), line.startsWith("missing:") ? "missing" : line.startsWith("  ") ? "inner" : ""));
  });
  return elements;
}

function enable() {
  const running = byId("learn").dataset.running || byId("plan").dataset.running, { records } = state;
  byId("learn").disabled = Boolean(running) || !(records.holding + records.other);
  byId("plan").disabled = Boolean(running) || !records.learned;
  byId("ask").hidden = !records.learned;
  byId("learn").textContent = byId("learn").dataset.running ? "learning \u2026" : "Learn";
  byId("plan").textContent = byId("plan").dataset.running ? "planning \u2026" : "Plan in this scene";
}

function opinion(chance) {
  const element = byId("opinion"), yes = chance >= 0.5;
  element.hidden = chance === null || chance === undefined;
  if (element.hidden) return;
  element.textContent = "learned so far: " + (yes ? "holds" : "does not hold") + ", " + Math.round(100 * (yes ? chance : 1 - chance)) + " % sure";
  element.className = yes ? "yes" : "no";
}

// ---- mouse and keys

const DO = {
  undo: () => back(state.undo, state.redo),
  redo: () => back(state.redo, state.undo),
  left: (body, fine) => turn(body, (fine ? 2 : 15) * (Math.PI / 180)),
  right: (body, fine) => turn(body, -(fine ? 2 : 15) * (Math.PI / 180)),
  face: otherFace,
  tilt: (body, back) => tilt(body, !back),
  raise: (body, fine) => raise(body, fine ? 0.002 : 0.02),
  lower: (body, fine) => raise(body, fine ? -0.002 : -0.02),
  snap: (body) => { remember(); return settle(body, "put_down"); },
  drop: (body) => { remember(); return settle(body, "drop"); },
  front: frontHere,
};
const KEYS = { z: "undo", y: "redo", q: "left", e: "right", f: "face", t: "tilt", r: "raise", v: "lower", s: "snap", d: "drop", g: "front" };
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function act(name, fine) {
  const body = selected();
  if (["undo", "redo", "front"].includes(name)) DO[name]();
  else if (body) DO[name](body, fine);
}

function pressed(event) {
  if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName) && event.target.type !== "checkbox") return;
  if (!state.stage || event.altKey) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.ctrlKey || event.metaKey) {
    if (key === "z") act(event.shiftKey ? "redo" : "undo");
    else if (key === "y") act("redo");
    else return;
  } else if (key in KEYS) act(KEYS[key], event.shiftKey);
  else if (key in ARROWS && selected()) nudge(selected(), ...ARROWS[key].map((part) => part * (event.shiftKey ? 0.001 : 0.01)));
  else if (key === "h") { if (!event.repeat) label(true); }
  else if (key === "n") { if (!event.repeat) label(false); }
  else if (key === " ") { if (!event.repeat) nextScene(); }
  else if (key === "a") { if (!event.repeat) askMe(); }
  else if (key === "Tab" && document.activeElement === canvas) nextBody(event.shiftKey ? -1 : 1);
  else if (key === "Escape") { select(null); trouble([]); state.odd = null; }
  else return;
  event.preventDefault();
}

function spotOf(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function hover(x, y) {
  const found = under(x, y), over = found ? (found.kind === "move" ? found.body.name : found.kind) : null;
  canvas.className = !found ? "" : { move: "over", turn: "turn", lift: "lift" }[found.kind];
  if (over !== state.over) { state.over = over; state.dirty = true; }
}

function hands() {
  const down = new Map();
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    if (!state.stage) return;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus();
    down.set(event.pointerId, [event.clientX, event.clientY]);
    if (event.button === 0 && !event.shiftKey && down.size === 1) state.hold = grab(...spotOf(event));
    canvas.classList.toggle("moving", Boolean(state.hold));
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => {
    down.delete(event.pointerId);
    const hold = state.hold;
    state.hold = null;
    if (hold) release(hold);
    canvas.classList.remove("moving");
    state.dirty = true;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!state.stage) return;
    const before = down.get(event.pointerId);
    if (!before) { hover(...spotOf(event)); return; }
    if (state.hold) { drag(state.hold, ...spotOf(event)); return; }
    const dx = event.clientX - before[0], dy = event.clientY - before[1];
    down.set(event.pointerId, [event.clientX, event.clientY]);
    lookAround(camera, event, [dx, dy], down.size, viewNow(canvas), (camera.distance * 0.75) / canvas.clientHeight, -0.2);
    state.dirty = true;
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.distance = Math.min(12, Math.max(0.15, camera.distance * Math.exp(event.deltaY * 0.001)));
    state.dirty = true;
  }, { passive: false });
  window.addEventListener("resize", () => { state.dirty = true; });
  window.addEventListener("keydown", pressed);
  document.addEventListener("click", (event) => {  // so that the space bar is the next scene's, not the last button's
    const button = event.target.closest("button");
    if (button && event.detail > 0) { button.blur(); canvas.focus(); }
  });
}

function buttons() {
  for (const button of document.querySelectorAll("#tools button")) button.addEventListener("click", (event) => act(button.dataset.do, event.shiftKey));
  byId("holds").addEventListener("click", () => label(true));
  byId("fails").addEventListener("click", () => label(false));
  byId("next").addEventListener("click", nextScene);
  byId("ask").addEventListener("click", askMe);
  byId("learn").addEventListener("click", () => run("learn", {}));
  byId("plan").addEventListener("click", () => run("plan", about({})));
  for (const button of document.querySelectorAll("[data-copy]")) button.addEventListener("click", () => {
    navigator.clipboard.writeText(byId(button.dataset.copy).textContent).then(() => toast("copied"), () => toast("select it and copy it", "error"));
  });
  byId("restore").addEventListener("click", async (event) => { event.preventDefault(); take(await ask("restore", {})); });
  byId("more").addEventListener("click", () => {
    const taken = [...document.querySelectorAll("#arguments input")].map((input) => input.value), name = [..."abcdefgh"].find((one) => !taken.includes(one));
    argumentRow({ name, kind: "object" });
    edited();
  });
  byId("relation").addEventListener("input", (event) => { if (event.target.id !== "presets") edited(); });
  byId("presets").addEventListener("change", () => {
    const text = byId("presets").value;
    byId("presets").blur();
    if (text) useRelation(text);
    else { byId("name").value = ""; byId("name").focus(); edited(); }
  });
  byId("relation").addEventListener("submit", (event) => { event.preventDefault(); document.activeElement.blur(); useRelation(formText()); });
}

async function begin() {
  try { drawer = new Drawer(canvas); } catch (error) {
    byId("broken").textContent = error.message;
    byId("broken").hidden = false;
    return;
  }
  hands();
  buttons();
  if (!take(await ask("state"))) return;
  const running = await ask("run");
  showRun(running);
  if (running.running) follow();
  canvas.focus();
  requestAnimationFrame(tick);
  state.ready = true;
}

// What scripts may ask the page: where bodies are, and at which pixel of the picture a point is.
window.tamp = {
  state, camera, poses,
  spot: (point) => onScreen(canvas, viewNow(canvas), point),
  box: (name) => boxOf(named(name)),
  centre: (name) => centreOf(named(name)),
  idle: () => state.ready && !state.busy && !state.hold && !state.labelling,
};
begin();
