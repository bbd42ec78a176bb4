// The page: sliders, tables that move the model, tools. Texts come from the data and are set as text, never as markup.
import { Vector3 } from "three";
import { fromPose, IDENTITY, Mechanism, quaternionAt, quaternionFromVector, quaternionProduct } from "./kinematics.js";
import { Solver } from "./solver.js";
import { DIRECTIONS, View } from "./view.js";
import { save, shapesOf, stl } from "./files.js";

const DEGREES = 180 / Math.PI;
const model = JSON.parse(document.getElementById("model").textContent);
const mechanism = new Mechanism(model);
const solver = new Solver(mechanism);
const $ = (id) => document.getElementById(id);
let Q = mechanism.rest.slice();
let view = null;
const measuring = { on: false, points: [] };
const playing = new Map();

// ------------------------------------------------------------------ the model

const shown = (value, unit) => (unit === "rad" ? `${(value * DEGREES).toFixed(1)}°` : unit === "mm" ? `${value.toFixed(1)} mm` : value.toFixed(3));

// Move to coordinates given by name; the others stay, or go to rest. Loops follow; false where their branch ends before.
function set(values, { others = "stay" } = {}) {
  const from = others === "rest" ? mechanism.rest.slice() : Q;
  const wanted = from.slice();
  mechanism.columns.forEach((column, index) => {
    if (column.name in values && (!solver.needed || !column.follows)) wanted[index] = values[column.name];
  });
  for (const joint of mechanism.joints) {
    const at = quaternionAt(joint);
    if (at < 0) continue;
    const first = joint.column + at, turn = wanted.slice(first, first + 4), norm = Math.hypot(...turn);
    turn.forEach((value, k) => (wanted[first + k] = norm ? value / norm : Number(k === 3)));
  }
  const { Q: reached, arrived } = solver.follow(from, wanted);
  Q = reached;
  update();
  if (!arrived) say("The mechanism cannot go on from here: a dead point, or its branch ends.");
  return arrived;
}

function update() {
  view?.place(mechanism.poses(Q));
  for (const control of controls) control.refresh();
  refreshFollowers();
  refreshMeasure();
}

function say(text) {
  $("status").textContent = text;
}

// ------------------------------------------------------------------ sliders

const controls = [];

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in made && key !== "list" && key !== "form") made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

// A slider with a number beside it, for a value in rad or mm.
function slider({ label, unit, lower, upper, endless, read, write, driver }) {
  const factor = unit === "rad" ? DEGREES : 1;
  const id = `driver-${controls.length}`;
  const range = element("input", { type: "range", id, min: lower * factor, max: upper * factor, step: "any" });
  const number = element("input", { type: "number", step: "any", "aria-label": `${label} in ${unit === "rad" ? "degrees" : "mm"}` });
  if (!endless) Object.assign(number, { min: lower * factor, max: upper * factor });
  const name = element("label", { htmlFor: id, textContent: label });
  const play = element("button", { type: "button", className: "play", textContent: "▶", "aria-label": `Move ${label} to and fro`, "aria-pressed": "false" });
  const move = (value) => write(Math.min(Math.max(value, endless ? -Infinity : lower), endless ? Infinity : upper));
  range.dataset.driver = driver;
  range.addEventListener("input", () => move(range.valueAsNumber / factor));
  number.addEventListener("change", () => Number.isFinite(number.valueAsNumber) && move(number.valueAsNumber / factor));
  play.addEventListener("click", () => toggle(play, { lower, upper, read, move, endless }));
  for (const target of [range, number]) target.addEventListener("focus", () => emphasise(driver));
  const limits = endless ? "no limits" : `${shown(lower, unit)} … ${shown(upper, unit)}`;
  name.append(element("small", { className: "limits", textContent: limits }));
  range.title = limits;
  const row = element("div", { className: "driver" }, name, range, number, element("span", { className: "unit", textContent: unit === "rad" ? "°" : "mm" }), play);
  const control = {
    refresh() {
      const value = read() * factor;
      range.value = endless ? wrap(value, lower * factor, upper * factor) : value;
      if (document.activeElement !== number) number.value = Number(value.toFixed(2));
      range.setAttribute("aria-valuetext", `${value.toFixed(1)} ${unit === "rad" ? "degrees" : "millimetres"}`);
    },
  };
  controls.push(control);
  return row;
}

const wrap = (value, lower, upper) => lower + ((((value - lower) % (upper - lower)) + (upper - lower)) % (upper - lower));

function toggle(button, { lower, upper, read, move, endless }) {
  if (playing.has(button)) {
    cancelAnimationFrame(playing.get(button));
    playing.delete(button);
  } else {
    let way = 1, before = performance.now();
    const step = (now) => {
      const share = Math.min(now - before, 100) / 4000;
      before = now;
      const next = read() + way * share * (upper - lower);
      const arrived = move(next);
      if (!arrived || (!endless && (next >= upper || next <= lower))) way = -way;
      playing.set(button, requestAnimationFrame(step));
    };
    playing.set(button, requestAnimationFrame(step));
  }
  button.textContent = playing.has(button) ? "❚❚" : "▶";
  button.setAttribute("aria-pressed", String(playing.has(button)));
}

function buildDrivers() {
  const box = $("drivers");
  for (const driver of model.drivers) {
    if (driver.kind === "ball") box.append(...ballSliders(driver));
    else {
      box.append(slider({
        label: driver.name, unit: driver.unit, lower: driver.lower, upper: driver.upper, endless: driver.endless, driver: driver.name,
        read: () => Q[driver.column],
        write: (value) => set({ [driver.name]: value }),
      }));
    }
  }
  if (!model.drivers.length) box.append(element("p", { className: "quiet", textContent: "Nothing moves: all parts are fixed to each other." }));
}

// A ball is swung about x and y of the parent connector, and twisted about z before that.
function ballSliders(driver) {
  const { column } = driver;
  const state = () => {
    const [x, y, z, w] = Q.slice(column, column + 4);
    const twist = 2 * Math.atan2(z, w);
    const [sx, sy, , sw] = quaternionProduct([x, y, z, w], [0, 0, -Math.sin(twist / 2), Math.cos(twist / 2)]);
    const angle = 2 * Math.atan2(Math.hypot(sx, sy), sw), sine = Math.hypot(sx, sy) || 1;
    return [(sx / sine) * angle, (sy / sine) * angle, Math.atan2(Math.sin(twist), Math.cos(twist))];
  };
  return ["swing x", "swing y", "twist"].map((what, k) => slider({
    label: `${driver.joint} ${what}`, unit: "rad", driver: driver.joint, endless: false,
    lower: k < 2 ? -driver.cone : driver.twist[0], upper: k < 2 ? driver.cone : driver.twist[1],
    read: () => state()[k],
    write: (value) => {
      const next = state();
      next[k] = value;
      const swung = Math.hypot(next[0], next[1]);
      if (swung > driver.cone && k < 2) next[1 - k] *= Math.sqrt(Math.max(driver.cone ** 2 - value ** 2, 0)) / (Math.abs(next[1 - k]) || 1);
      const turn = quaternionProduct(quaternionFromVector([next[0], next[1], 0]), quaternionFromVector([0, 0, next[2]]));
      return set(Object.fromEntries(turn.map((component, i) => [mechanism.columns[column + i].name, component])));
    },
  }));
}

const followers = [];
function buildFollowers() {
  const following = mechanism.columns.map((column, index) => ({ ...column, index })).filter((column) => column.follows && column.unit !== "1");
  $("followers").hidden = !following.length;
  for (const column of following) {
    const cell = element("td", { className: "number" });
    $("followers-rows").append(element("tr", {}, element("td", { textContent: column.name }), cell));
    followers.push({ column, cell });
  }
}

function refreshFollowers() {
  for (const { column, cell } of followers) {
    const value = Q[column.index];
    const outside = (column.lower !== null && value < column.lower - 1e-6) || (column.upper !== null && value > column.upper + 1e-6);
    cell.textContent = shown(value, column.unit) + (outside ? " — beyond its limit" : "");
    cell.classList.toggle("bad", outside);
  }
}

let emphasised = null;
function emphasise(name) {
  emphasised = name;
  view?.ask();
}

// ------------------------------------------------------------------ tables that move the model

function partIndices(names) {
  return names.map((name) => mechanism.parts.indexOf(name)).filter((index) => index >= 0);
}

function buildTables() {
  for (const button of document.querySelectorAll("[data-show]")) {
    button.addEventListener("click", () => {
      const { pose, parts, text } = JSON.parse(button.dataset.show);
      stop();
      const arrived = set(pose ?? {}, { others: "rest" });
      view?.focus(partIndices(parts));
      $("unfocus").hidden = false;
      if (arrived) say(`${text} ${pose ? `Moved to ${Object.entries(pose).map(([name, value]) => `${name} = ${shown(value, mechanism.columns.find((c) => c.name === name)?.unit)}`).join(", ")}.` : "Shown at rest."}`);
      for (const other of document.querySelectorAll("tr.shown")) other.classList.remove("shown");
      button.closest("tr")?.classList.add("shown");
      if (matchMedia("(max-width: 800px)").matches) $("stage").scrollIntoView();
    });
  }
  for (const box of document.querySelectorAll("[data-visible]")) {
    box.addEventListener("change", () => view?.show(Number(box.dataset.visible), box.checked));
  }
  for (const button of document.querySelectorAll("[data-part]")) {
    button.addEventListener("click", () => {
      const index = Number(button.dataset.part);
      const alone = view?.focused?.size === 1 && view.focused.has(index);
      view?.focus(alone ? [] : [index]);
      $("unfocus").hidden = alone;
    });
  }
  for (const button of document.querySelectorAll("[data-stl]")) {
    button.addEventListener("click", () => {
      const index = Number(button.dataset.stl);
      save(`${mechanism.parts[index]}.stl`, stl(shapesOf(model, view.meshes, mechanism.parts.map(() => IDENTITY), index)), "model/stl");
    });
  }
}

function stop() {
  for (const button of [...playing.keys()]) button.click();
}

// ------------------------------------------------------------------ tools

function pressed(button, on) {
  button.setAttribute("aria-pressed", String(on));
}

function buildTools() {
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => view?.look(button.dataset.view));
  $("tool-axes").addEventListener("click", () => {
    view.axes.visible = !view.axes.visible;
    pressed($("tool-axes"), view.axes.visible);
    view.ask();
  });
  $("tool-names").addEventListener("click", () => {
    named = !named;
    pressed($("tool-names"), named);
    view.ask();
  });
  $("tool-measure").addEventListener("click", () => {
    measuring.on = !measuring.on;
    measuring.points = [];
    pressed($("tool-measure"), measuring.on);
    view.canvas.classList.toggle("measuring", measuring.on);
    refreshMeasure();
    if (measuring.on) say("Click two points; clicks snap to corners.");
  });
  $("explode").addEventListener("input", () => {
    view.explode($("explode").valueAsNumber);
    refreshMeasure();
  });
  const cut = () => view.section("xyz".indexOf($("section-axis").value || "-"), $("section-at").valueAsNumber, $("section-flip").checked);
  for (const id of ["section-axis", "section-at", "section-flip"]) $(id).addEventListener("input", cut);
  $("reset").addEventListener("click", reset);
  $("unfocus").addEventListener("click", unfocus);
  $("theme").addEventListener("click", () => {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
  });
  $("save-png").addEventListener("click", async () => save(`${model.name}.png`, Uint8Array.from(atob(view.picture().split(",")[1]), (c) => c.charCodeAt(0)), "image/png"));
  $("save-stl").addEventListener("click", () => save(`${model.name}.stl`, stl(shapesOf(model, view.meshes, mechanism.poses(Q))), "model/stl"));
  $("save-pose").addEventListener("click", () => save(`${model.name}.pose.json`, JSON.stringify({ schema: "articad.pose/1", q: named_q(), poses: poses() }, null, 1), "application/json"));
  $("save-plan")?.addEventListener("click", () => save("plan.json", $("plan").textContent, "application/json"));
}

function reset() {
  stop();
  unfocus();
  set({}, { others: "rest" });
  say("At rest.");
}

function unfocus() {
  view?.focus([]);
  $("unfocus").hidden = true;
  for (const row of document.querySelectorAll("tr.shown")) row.classList.remove("shown");
}

function refreshMeasure() {
  if (!view) return;
  const points = measuring.points.map((point) => view.worldOf(point));
  view.mark(points);
  if (points.length === 2) {
    const [dx, dy, dz] = points[1].clone().sub(points[0]).toArray();
    const between = measuring.points.map(({ part }) => mechanism.parts[part]).join(" – ");
    $("measured").textContent = `${between}: ${points[0].distanceTo(points[1]).toFixed(3)} mm (Δx ${dx.toFixed(3)}, Δy ${dy.toFixed(3)}, Δz ${dz.toFixed(3)})`;
  } else $("measured").textContent = measuring.on ? `${points.length} of 2 points` : "";
  $("measured").hidden = !measuring.on;
}

// A part lights up under the pointer, a click selects it here and in the table, and a drag moves the joint that carries it.
function buildPointer() {
  const { canvas } = view;
  const stage = $("stage");
  let down = null, drag = null;
  // In the capture phase: a part that is grabbed does not turn the camera as well.
  stage.addEventListener("pointerdown", (event) => {
    if (event.target !== canvas || event.button !== 0 || !event.isPrimary) return;
    down = [event.clientX, event.clientY];
    const hit = measuring.on ? null : view.pick(event.clientX, event.clientY, { exact: true });
    const driver = hit && grabbed(hit);
    if (!driver) return;
    event.stopPropagation();
    canvas.setPointerCapture(event.pointerId);
    canvas.focus();
    stop();
    drag = { hit, driver };
    emphasise(driver.name);
    canvas.classList.add("dragging");
  }, { capture: true });
  canvas.addEventListener("pointermove", (event) => {
    if (drag && Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) drag.moved = true;
    if (drag?.moved) follow(drag, event.clientX, event.clientY);
    else if (!event.buttons && event.pointerType === "mouse") {
      const hit = measuring.on ? null : view.pick(event.clientX, event.clientY, { exact: true });
      view.hover(hit ? hit.part : -1);
      canvas.classList.toggle("grabbable", Boolean(hit && carriers(hit.part).length));
    }
  });
  canvas.addEventListener("pointerleave", () => view.hover(-1));
  const released = (event) => {
    const moved = !down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4;
    drag = down = null;
    canvas.classList.remove("dragging");
    if (moved || event.type === "pointercancel") return;
    const hit = view.pick(event.clientX, event.clientY);
    if (measuring.on) {
      if (hit) measuring.points = [...(measuring.points.length === 2 ? [] : measuring.points), hit];
      refreshMeasure();
    } else select(hit ? hit.part : -1);
  };
  canvas.addEventListener("pointerup", released);
  canvas.addEventListener("pointercancel", released);
}

let selected = -1;
function select(part) {
  selected = part === selected ? -1 : part;
  view.mark_part(selected);
  for (const button of document.querySelectorAll("[data-part]")) {
    const row = button.closest("tr"), own = Number(button.dataset.part) === selected;
    row.classList.toggle("selected", own);
    if (own) row.scrollIntoView({ block: "nearest" });
  }
  if (selected < 0) return say("");
  const { name, material } = model.parts[selected];
  const joints = mechanism.joints.filter((joint) => joint.parent === selected || joint.child === selected).map((joint) => `${joint.name} (${joint.type})`);
  say([name, material, joints.length ? `joints: ${joints.join(", ")}` : ""].filter(Boolean).join(", "));
}

// The drivers on the way from a part to the ground, the nearest first; with loops, all others after them.
function carriers(part) {
  const plain = model.drivers.filter((driver) => driver.kind === "plain");
  const ofJoint = (index) => plain.filter((driver) => {
    const joint = mechanism.joints[index];
    return driver.column >= joint.column && driver.column < joint.column + joint.coordinates;
  });
  const found = [];
  for (let at = part, edge; (edge = model.tree.find((entry) => entry.to === at)); at = edge.from) found.push(...ofJoint(edge.joint));
  return solver.needed ? [...found, ...plain.filter((driver) => !found.includes(driver))] : found;
}

const NUDGE = 1e-3; // rad; for mm the same share of the model's size
const nudge = (driver) => (driver.unit === "rad" ? NUDGE : NUDGE * view.size);

// Where a grabbed point is seen, in pixels, when a driver has a value.
function seenAt(hit, Q_there) {
  const point = new Vector3(...hit.local.toArray()).applyMatrix4(view.placed(hit.part, mechanism.poses(Q_there)));
  return view.screen(point);
}

function moved(driver, value) {
  const wanted = Q.slice();
  wanted[driver.column] = value;
  return solver.follow(Q, wanted).Q;
}

// Pixels by which the grabbed point moves for one unit of a driver.
function sensitivity(hit, driver) {
  const step = nudge(driver), value = Q[driver.column];
  const way = driver.endless || value + step <= driver.upper ? step : -step;
  const [x0, y0] = seenAt(hit, Q), [x1, y1] = seenAt(hit, moved(driver, value + way));
  return [(x1 - x0) / way, (y1 - y0) / way];
}

// The first driver, from the part to the ground, that visibly moves the grabbed point.
function grabbed(hit) {
  const strength = (driver) => Math.hypot(...sensitivity(hit, driver)) * (driver.unit === "rad" ? 1 : view.size);
  const candidates = carriers(hit.part).map((driver) => [driver, strength(driver)]);
  const most = Math.max(0, ...candidates.map(([, pixels]) => pixels));
  return candidates.find(([, pixels]) => pixels > 8 && pixels > 0.1 * most)?.[0];
}

// Move the driver until the grabbed point is as near to the pointer as its path allows: Gauss-Newton in one unknown.
function follow({ hit, driver }, clientX, clientY) {
  const bounds = view.canvas.getBoundingClientRect();
  const goal = [clientX - bounds.left, clientY - bounds.top];
  for (let round = 0; round < 6; round++) {
    const [x, y] = seenAt(hit, Q), [jx, jy] = sensitivity(hit, driver);
    const square = jx * jx + jy * jy;
    if (!square) return;
    const largest = driver.unit === "rad" ? 0.4 : 0.2 * view.size;
    const wanted = Math.min(Math.max(((goal[0] - x) * jx + (goal[1] - y) * jy) / square, -largest), largest);
    const value = Q[driver.column] + wanted;
    const next = driver.endless ? value : Math.min(Math.max(value, driver.lower), driver.upper);
    if (Math.abs(next - Q[driver.column]) < 1e-6 * (driver.unit === "rad" ? 1 : view.size)) break;
    if (!set({ [driver.name]: next })) return;
  }
  const value = Q[driver.column], at = !driver.endless && (value <= driver.lower || value >= driver.upper);
  say(`${driver.name} ${shown(value, driver.unit)}${at ? ", at its limit" : ""}`);
}

const KEYS = {
  1: () => view.look("iso"), 2: () => view.look("front"), 3: () => view.look("right"), 4: () => view.look("top"),
  5: () => view.look("back"), 6: () => view.look("left"), 7: () => view.look("bottom"),
  f: () => view.look("iso"), r: reset, a: () => $("tool-axes").click(), n: () => $("tool-names").click(), m: () => $("tool-measure").click(),
  Escape: () => (measuring.on ? $("tool-measure").click() : unfocus()),
  "+": () => view.zoom(0.85), "-": () => view.zoom(1 / 0.85),
};
const TURNS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };

function buildKeys() {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !view) return;
    const typing = event.target.matches("input, select, textarea");
    if (event.target === view.canvas && event.key in TURNS) view.turn(...TURNS[event.key]);
    else if (!typing && event.key in KEYS) KEYS[event.key]();
    else return;
    event.preventDefault();
  });
}

// ------------------------------------------------------------------ names over the picture

let named = false;
const labels = new Map();

function label(key, text, className) {
  if (!labels.has(key)) labels.set(key, $("labels").appendChild(element("span", { textContent: text, className })));
  return labels.get(key);
}

function refreshLabels() {
  if (!view?.poses) return;
  for (const made of labels.values()) made.hidden = true;
  const put = (made, point) => {
    const [x, y, before] = view.screen(point);
    made.hidden = !before;
    made.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
  };
  mechanism.joints.forEach((joint, index) => {
    const wanted = joint.type !== "fixed" && (view.axes.visible || emphasised === joint.name || emphasised?.startsWith(`${joint.name}.`));
    if (!wanted) return;
    const e = view.triads[index].matrix.elements;
    put(label(`joint ${index}`, joint.name, "joint"), new Vector3(e[12] + 1.15 * e[8], e[13] + 1.15 * e[9], e[14] + 1.15 * e[10]));
  });
  if (named) {
    view.groups.forEach((group, index) => {
      if (!group.visible || !model.parts[index].shapes.length) return;
      put(label(`part ${index}`, mechanism.parts[index], "part"), new Vector3(...model.parts[index].middle).applyMatrix4(group.matrix));
    });
  }
  const turned = view.camera.matrixWorldInverse.elements;
  ["x", "y", "z"].forEach((axis, k) => {
    const x = 30 + 20 * turned[4 * k], y = 30 - 20 * turned[4 * k + 1];
    const line = $(`triad-${axis}`), text = $(`triad-${axis}-name`);
    line.setAttribute("x2", x.toFixed(1));
    line.setAttribute("y2", y.toFixed(1));
    text.setAttribute("x", (30 + 27 * turned[4 * k]).toFixed(1));
    text.setAttribute("y", (33 - 27 * turned[4 * k + 1]).toFixed(1));
  });
}

// ------------------------------------------------------------------ what tests and consoles may ask

const rows = (T) => [T.slice(0, 4), T.slice(4, 8), T.slice(8, 12), [0, 0, 0, 1]];
const poses = () => Object.fromEntries(mechanism.poses(Q).map((T, index) => [mechanism.parts[index], rows(T)]));
const named_q = () => Object.fromEntries(mechanism.columns.map((column, index) => [column.name, Q[index]]));

// Poses as they are drawn, taken from the groups that the picture is made of.
const drawn = () => Object.fromEntries(view.groups.map((group) => {
  group.updateMatrixWorld(true);
  const e = group.matrixWorld.elements;
  return [group.name, [0, 1, 2, 3].map((row) => [e[row], e[row + 4], e[row + 8], e[row + 12]])];
}));

// ------------------------------------------------------------------ beginning

function begin() {
  buildDrivers();
  buildFollowers();
  try {
    view = new View($("canvas"), mechanism, refreshLabels);
  } catch (error) {
    $("stage").classList.add("flat");
    say("This browser cannot draw in three dimensions (no WebGL); the numbers and tables are all here.");
    console.warn(String(error));
  }
  if (view) {
    view.measure(mechanism.poses(Q));
    view.resize();
    view.look("iso");
    buildPointer();
    buildTools();
    buildKeys();
  }
  buildTables();
  update();
  if (model.watch) watch();
  window.articad = { model, set, q: named_q, poses, drawn, view, reset, directions: Object.keys(DIRECTIONS) };
  requestAnimationFrame(() => {
    view?.draw();
    window.articad.firstFrame = performance.now();
    document.documentElement.dataset.ready = "";
  });
}

// `articad watch` serves the page and says when it has changed; pose and view are kept.
function watch() {
  const kept = sessionStorage.getItem("articad");
  if (kept && view) {
    const { q, camera, target } = JSON.parse(kept);
    sessionStorage.removeItem("articad");
    set(q);
    view.camera.position.fromArray(camera);
    view.controls.target.fromArray(target);
    view.controls.update();
  }
  setInterval(async () => {
    const answer = await fetch("version").catch(() => null);
    if (!answer?.ok) return;
    const { version, message } = await answer.json();
    if (message) say(message);
    if (version === model.watch) return;
    if (view) sessionStorage.setItem("articad", JSON.stringify({ q: named_q(), camera: view.camera.position.toArray(), target: view.controls.target.toArray() }));
    location.reload();
  }, 700);
}

begin();
