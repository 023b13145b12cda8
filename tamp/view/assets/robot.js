// A robot alone: sliders of its joints, the spheres around its links, where its tool gets.

const BALL = (() => {
  const rings = 10, around = 16, out = [];
  const at = (i, j) => {
    const a = (Math.PI * i) / rings, b = (2 * Math.PI * j) / around;
    return [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
  };
  for (let i = 0; i < rings; i++) for (let j = 0; j < around; j++)
    for (const p of [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)]) out.push(...p, ...p);
  return new Float32Array(out);
})();

// The configuration that the sliders say, or null while the film goes on.
const inspected = { row: null, sliders: [] };

function prepareInspection() {
  if (!data.inspection) return;
  drawn.ball = drawer.buffer(BALL);
  const points = [], tints = [];
  for (const [far, high, share] of data.inspection.reach) {
    points.push([data.inspection.foot[0] + far, data.inspection.foot[1], high]);
    tints.push([0.15 + 0.8 * share, 0.3 + 0.5 * share, 0.85 - 0.75 * share]);
  }
  drawn.reach = drawer.buffer(pack(points, tints.length ? tints : [0, 0, 0]));
  for (const layer of ["spheres", "reach"]) state.hidden.add(layer);
}

function inspectionSolids(places) {
  if (!data.inspection || !shown("spheres")) return [];
  return Object.entries(data.inspection.spheres).flatMap(([link, balls]) => balls.map(([x, y, z, r]) => ({
    mesh: drawn.ball,
    place: M.mul(places[link], [r, 0, 0, x, 0, r, 0, y, 0, 0, r, z, 0, 0, 0, 1]),
    paint: [0.95, 0.55, 0.1, 0.3],
  })));
}

function inspectionLines(places) {
  if (!data.inspection || !shown("reach")) return [];
  return [{ mesh: drawn.reach, kind: "POINTS", size: 7, round: true, alpha: 0.85, place: places[data.robot.links[0].name] }];
}

function setJoint(column, value) {
  if (!inspected.row) inspected.row = rowAt(state.time);
  inspected.row[column] = value;
  state.playing = false;
  state.dirty = true;
}

function inspectionPanel() {
  byId("joints").hidden = !data.inspection;
  if (!data.inspection) return;
  check(byId("layers"), "links", "links");
  check(byId("layers"), "spheres", "spheres around the links", "#f28c19");
  check(byId("layers"), "reach", "where the tool gets straight ahead (yellow: in most directions)", "#e0b020");
  for (const box of byId("layers").querySelectorAll("input")) box.checked = shown(box.dataset.layer);
  for (const joint of data.inspection.joints) {
    const row = make("label", joint.name), slider = make("input"), value = make("output");
    slider.type = "range"; slider.min = joint.low; slider.max = joint.high; slider.step = (joint.high - joint.low) / 1000;
    slider.dataset.column = joint.column;
    slider.addEventListener("input", () => setJoint(joint.column, Number(slider.value)));
    row.append(slider, value);
    byId("sliders").append(row);
    inspected.sliders.push({ joint, slider, value });
  }
}

function showSliders(row) {
  for (const { joint, slider, value } of inspected.sliders) {
    if (document.activeElement !== slider) slider.value = row[joint.column];
    value.textContent = row[joint.column].toFixed(3) + " " + joint.unit;
  }
}
