// ---- off it goes

if (drawer) {
  prepare();
  byId("slider").max = duration;
  byId("player").hidden = !data.actions.length;
  panel();
  hands();
  requestAnimationFrame(tick);
}
// What scripts may ask the page.
window.tamp = {
  data, state, go, camera, groups,
  tool: () => linksAt(rowNow()).tool,
  links: () => linksAt(rowNow()).places,
  bodies: () => Object.fromEntries(data.bodies.map((body) => [body.name, placeOf(body, state.time, linksAt(rowNow()).tools)])),
};
