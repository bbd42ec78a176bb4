// The page: sliders, tables that move the model, tools. Texts come from the data and are set as text, never as markup.
import { Vector3 } from "three";
import { fromPose, IDENTITY, Mechanism, quaternionAt, quaternionFromVector, quaternionProduct } from "./kinematics.js";
import { Solver } from "./solver.js";
import { DIRECTIONS, View } from "./view.js";
import { save, shapesOf, stl } from "./files.js";
import { between, described } from "./features.js";
import { Cube } from "./cube.js";
import { gifOf } from "./gif.js";
import { Labels } from "./labels.js";
import { cycle, Player } from "./player.js";
import { watch } from "./watch.js";

const DEGREES = 180 / Math.PI;
const model = JSON.parse(document.getElementById("model").textContent);
const mechanism = new Mechanism(model);
const solver = new Solver(mechanism);
const $ = (id) => document.getElementById(id);
let Q = mechanism.rest.slice();
let lastArrived = Q; // the last coordinates that were reached as wanted: Q, unless the branch ended before
let view = null;
const measuring = { on: false, points: [] };

// ------------------------------------------------------------------ the model

const shown = (value, unit) => (unit === "rad" ? `${(value * DEGREES).toFixed(1)}°` : unit === "mm" ? `${value.toFixed(1)} mm` : value.toFixed(3));

// Move to coordinates given by name; the others stay, or go to rest. Loops follow; false where their branch ends before.
// Two branches meet at a dead point. The way back from one begins where the mechanism was before, so that it keeps its branch.
function set(values, { others = "stay" } = {}) {
  const wanted = others === "rest" ? mechanism.rest.slice() : Q.slice();
  mechanism.columns.forEach((column, index) => {
    if (column.name in values && (!solver.needed || !column.follows)) wanted[index] = values[column.name];
  });
  for (const joint of mechanism.joints) {
    const at = quaternionAt(joint);
    if (at < 0) continue;
    const first = joint.column + at, turn = wanted.slice(first, first + 4), norm = Math.hypot(...turn);
    turn.forEach((value, k) => (wanted[first + k] = norm ? value / norm : Number(k === 3)));
  }
  const reached = solver.follow(others === "rest" ? mechanism.rest.slice() : lastArrived, wanted);
  Q = reached.Q;
  if (reached.arrived) lastArrived = Q;
  update();
  if (!reached.arrived) say("The mechanism cannot go on from here: a dead point, or its branch ends.");
  return reached.arrived;
}

let quiet = false; // while several joints are written, the page is brought up to date once
function update() {
  if (quiet) return;
  view?.place(mechanism.poses(Q));
  view?.showOverlaps(isHere);
  refreshMeasure();
  if (!playing || performance.now() - refreshed > READ) refreshValues();
}

const READ = 100; // ms between values while joints play: the page is laid out for each, and nobody reads faster
let refreshed = 0;
function refreshValues() {
  refreshed = performance.now();
  for (const control of controls) control.refresh();
  refreshFollowers();
}

// Whether the model stands in a pose: named coordinates as given, the drivers that are not named at rest.
function isHere(pose) {
  return model.drivers.every((driver) => {
    const columns = driver.kind === "ball" ? [0, 1, 2, 3].map((k) => driver.column + k) : [driver.column];
    return columns.every((column) => Math.abs(Q[column] - (pose?.[mechanism.columns[column].name] ?? mechanism.rest[column])) < 1e-6);
  });
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
function slider({ label, unit, lower, upper, endless, read, write, restValue, driver }) {
  const factor = unit === "rad" ? DEGREES : 1;
  const id = `driver-${controls.length}`;
  const range = element("input", { type: "range", id, min: lower * factor, max: upper * factor, step: "any" });
  const number = element("input", { type: "number", step: "any", "aria-label": `${label} in ${unit === "rad" ? "degrees" : "mm"}` });
  if (!endless) Object.assign(number, { min: lower * factor, max: upper * factor });
  const name = element("label", { htmlFor: id, textContent: label });
  const play = element("button", { type: "button", className: "play", textContent: "▶", "aria-label": `Move ${label} to and fro`, "aria-pressed": "false" });
  const mover = { label, lower, upper, endless, rest: 0, read, write };
  const move = (value) => write(Math.min(Math.max(value, endless ? -Infinity : lower), endless ? Infinity : upper));
  range.dataset.driver = driver;
  range.addEventListener("input", () => move(range.valueAsNumber / factor));
  number.addEventListener("change", () => Number.isFinite(number.valueAsNumber) && move(number.valueAsNumber / factor));
  play.addEventListener("click", () => {
    const own = playing === play;
    stop();
    if (!own) start(play, [mover], read());
  });
  for (const target of [range, number]) target.addEventListener("focus", () => emphasise(driver));
  const limits = endless ? "no limits" : `${shown(lower, unit)} … ${shown(upper, unit)}`;
  name.append(element("small", { className: "limits", textContent: limits }));
  range.title = limits;
  const value = element("span", { className: "value" }, number, element("span", { className: "unit", textContent: unit === "rad" ? "°" : "mm" }));
  const row = element("div", { className: "driver" }, name, range, value, play);
  const control = {
    refresh() {
      const value = read() * factor;
      range.value = endless ? wrap(value, lower * factor, upper * factor) : value;
      if (document.activeElement !== number) number.value = Number(value.toFixed(2));
      range.setAttribute("aria-valuetext", `${value.toFixed(1)} ${unit === "rad" ? "degrees" : "millimetres"}`);
    },
  };
  mover.restValue = restValue;
  control.mover = mover;
  controls.push(control);
  return row;
}

const wrap = (value, lower, upper) => lower + ((((value - lower) % (upper - lower)) + (upper - lower)) % (upper - lower));

// One joint, or the whole product: every joint over its range and back, one after the other.
let playing = null;
const player = new Player();

function start(button, movers, from = null) {
  playing = button;
  pressed(button, true);
  button.textContent = button.id === "play" ? "❚❚ Pause" : "❚❚";
  for (const mover of movers) mover.rest = mover.restValue();
  if (view) view.busy = true;
  player.start(movers, { from, together: !solver.needed, write: atOnce });
}

// Write several joints, then bring the page up to date.
function atOnce(write) {
  quiet = true;
  try {
    write();
  } finally {
    quiet = false;
  }
  update();
}

function stop() {
  player.stop();
  cancelAnimationFrame(stepping);
  stepping = null;
  if (view) view.busy = false;
  if (playing) {
    pressed(playing, false);
    playing.textContent = playing.id === "play" ? "▶ Play" : "▶";
    refreshValues();
  }
  playing = null;
}

function buildDrivers() {
  const box = $("drivers");
  for (const driver of model.drivers) {
    if (driver.kind === "ball") box.append(...ballSliders(driver));
    else {
      box.append(slider({
        label: driver.name, unit: driver.unit, lower: driver.lower, upper: driver.upper, endless: driver.endless, driver: driver.name,
        read: () => Q[driver.column],
        restValue: () => mechanism.rest[driver.column],
        write: (value) => set({ [driver.name]: value }),
      }));
    }
  }
  if (!model.drivers.length) box.append(element("p", { className: "quiet", textContent: "Nothing moves: all parts are fixed to each other." }));
}

// A ball is swung about x and y of the parent connector, and twisted about z before that.
function ballSliders(driver) {
  const { column } = driver;
  const state = (at = Q) => {
    const [x, y, z, w] = at.slice(column, column + 4);
    const twist = 2 * Math.atan2(z, w);
    const [sx, sy, , sw] = quaternionProduct([x, y, z, w], [0, 0, -Math.sin(twist / 2), Math.cos(twist / 2)]);
    const angle = 2 * Math.atan2(Math.hypot(sx, sy), sw), sine = Math.hypot(sx, sy) || 1;
    return [(sx / sine) * angle, (sy / sine) * angle, Math.atan2(Math.sin(twist), Math.cos(twist))];
  };
  return ["swing x", "swing y", "twist"].map((what, k) => slider({
    label: `${driver.joint} ${what}`, unit: "rad", driver: driver.joint, endless: false,
    lower: k < 2 ? -driver.cone : driver.twist[0], upper: k < 2 ? driver.cone : driver.twist[1],
    read: () => state()[k],
    restValue: () => state(mechanism.rest)[k],
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

// ------------------------------------------------------------------ the steps of an assembly

const STEP = 1800, BEFORE = 500, AFTER = 900; // ms: along a path, before it, and until the next step
let stepping = null; // what was asked of the browser while a step is played
let assembled = true;

// A point of a path at a share of its length.
function along(path, share) {
  const lengths = path.slice(1).map((point, k) => Math.hypot(...point.map((value, axis) => value - path[k][axis])));
  let left = share * lengths.reduce((sum, length) => sum + length, 0);
  for (let k = 0; k < lengths.length; k++) {
    if (left <= lengths[k] && lengths[k]) return path[k].map((value, axis) => value + (left / lengths[k]) * (path[k + 1][axis] - value));
    left -= lengths[k];
  }
  return path[path.length - 1];
}

// Show what is in place at a step, and move what is new along its path; then the steps after it, if they are wanted.
function playStep(index, onwards = false) {
  if (!view) return;
  stop();
  const { parts, onto, path, at, poses: apart, text } = model.order.steps[index];
  view.shift([], [0, 0, 0]);
  set(at, { others: "rest" });
  view.place(mechanism.poses(Q).map((T, part) => apart[part] ?? T)); // what is left of an opened loop stands where the whole never has it
  assembled = false;
  mechanism.parts.forEach((_, part) => show(part, parts.includes(part) || onto.includes(part)));
  view.focus([]);
  $("unfocus").hidden = false;
  view.frame(onto, parts, path[0]);
  view.shift(parts, path[0]);
  say(text);
  for (const row of document.querySelectorAll("tr.shown")) row.classList.remove("shown");
  document.querySelector(`[data-step="${index}"]`)?.closest("tr")?.classList.add("shown");
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return; // as on paper: where the path begins
  const begun = performance.now(), moves = path.length > 1;
  const step = (now) => {
    const share = moves ? Math.min(Math.max((now - begun - BEFORE) / STEP, 0), 1) : 1;
    view.shift(parts, along(path, share * share * (3 - 2 * share)));
    if (share < 1 || (onwards && now - begun < BEFORE + (moves ? STEP : 0) + AFTER)) stepping = requestAnimationFrame(step);
    else if (onwards && index + 1 < model.order.steps.length) playStep(index + 1, true);
  };
  stepping = requestAnimationFrame(step);
}

function endSteps() {
  if (assembled) return;
  assembled = true;
  cancelAnimationFrame(stepping);
  mechanism.parts.forEach((_, part) => show(part, true));
  view.place(mechanism.poses(Q));
  view.shift([], [0, 0, 0]);
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
      flyToOverlap(partIndices(parts));
      if (arrived) say(`${text} ${pose ? `Moved to ${Object.entries(pose).map(([name, value]) => `${name} = ${shown(value, mechanism.columns.find((c) => c.name === name)?.unit)}`).join(", ")}.` : "Shown at rest."}`);
      for (const other of document.querySelectorAll("tr.shown")) other.classList.remove("shown");
      button.closest("tr")?.classList.add("shown");
      if (narrow.matches) $("stage").scrollIntoView();
    });
  }
  for (const button of document.querySelectorAll("[data-step]")) button.addEventListener("click", () => playStep(Number(button.dataset.step)));
  $("all-steps")?.addEventListener("click", () => playStep(0, true));
  for (const box of document.querySelectorAll("[data-visible]")) box.addEventListener("change", () => show(Number(box.dataset.visible), box.checked));
  for (const button of document.querySelectorAll("[data-part]")) {
    button.addEventListener("click", () => view && select(Number(button.dataset.part)));
  }
  for (const button of document.querySelectorAll("[data-stl]")) {
    button.addEventListener("click", () => {
      const index = Number(button.dataset.stl);
      save(`${mechanism.parts[index]}.stl`, stl(shapesOf(model, view.meshes, mechanism.parts.map(() => IDENTITY), index)), "model/stl");
    });
  }
}

const narrow = matchMedia("(max-width: 1000px)");

function show(part, visible) {
  view?.show(part, visible);
  for (const box of document.querySelectorAll(`[data-visible="${part}"]`)) box.checked = visible;
  refreshCard();
}

// The camera goes to the overlap of two parts that is seen in the present pose, if there is one.
function flyToOverlap(parts) {
  const overlap = view?.overlaps.find((each) => each.solid.visible && each.parts.every((part) => parts.includes(part)));
  if (!overlap) return;
  overlap.solid.geometry.computeBoundingSphere();
  const { center, radius } = overlap.solid.geometry.boundingSphere;
  view.fly(center, radius);
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
  $("tool-parallel").addEventListener("click", () => {
    view.project(view.camera !== view.parallel);
    pressed($("tool-parallel"), view.camera === view.parallel);
  });
  $("play").addEventListener("click", () => {
    const own = playing === $("play");
    stop();
    if (!own) start($("play"), controls.map((control) => control.mover));
  });
  $("play").hidden = !controls.length;
  $("explode").addEventListener("input", () => explode($("explode").valueAsNumber));
  for (const axis of "xyz") {
    for (const input of [$(`cut-${axis}`), $(`cut-${axis}-flip`)]) input.addEventListener("input", cut);
    $(`cut-${axis}-at`).addEventListener("input", () => {
      $(`cut-${axis}`).checked = true;
      cut();
    });
  }
  $("reset").addEventListener("click", reset);
  $("unfocus").addEventListener("click", unfocus);
  $("theme").addEventListener("click", () => {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
  });
  $("save-png").addEventListener("click", async () => save(`${model.name}.png`, await picture(), "image/png"));
  $("save-gif").addEventListener("click", () => film(async (frames) => save(`${model.name}.gif`, await gifOf(frames, { width: 480, centiseconds: 8, tell: say }), "image/gif")));
  $("save-webm").addEventListener("click", saveVideo);
  $("save-webm").hidden = !window.MediaRecorder?.isTypeSupported?.("video/webm");
  $("link").addEventListener("click", link);
  $("save-stl").addEventListener("click", () => save(`${model.name}.stl`, stl(shapesOf(model, view.meshes, mechanism.poses(Q))), "model/stl"));
  $("save-pose").addEventListener("click", () => save(`${model.name}.pose.json`, JSON.stringify({ schema: "articad.pose/1", q: named_q(), poses: poses() }, null, 1), "application/json"));
  $("save-plan")?.addEventListener("click", () => save("plan.json", $("plan").textContent, "application/json"));
}

function explode(amount) {
  $("explode").value = amount;
  view.explode(amount);
  view.showOverlaps(isHere);
  refreshMeasure();
}

// The sections as their controls have them.
function cut() {
  view.section(Object.fromEntries([..."xyz"].map((axis) => [
    axis, $(`cut-${axis}`).checked ? { share: $(`cut-${axis}-at`).valueAsNumber, flipped: $(`cut-${axis}-flip`).checked } : null,
  ])));
}

function setCuts(sections) {
  for (const axis of "xyz") {
    const given = sections?.[axis];
    $(`cut-${axis}`).checked = Boolean(given);
    if (given) {
      $(`cut-${axis}-at`).value = given.share;
      $(`cut-${axis}-flip`).checked = given.flipped;
    }
  }
  cut();
}

function reset() {
  stop();
  unfocus();
  set({}, { others: "rest" });
  say("At rest.");
}

function unfocus() {
  endSteps();
  view?.focus([]);
  $("unfocus").hidden = true;
  for (const row of document.querySelectorAll("tr.shown")) row.classList.remove("shown");
}

function refreshMeasure() {
  if (!view) return;
  $("measured").hidden = !measuring.on;
  const taken = measuring.points.map((one) => ({ ...one, at: view.worldOf(one), way: one.direction && view.directionOf(one) }));
  if (taken.length < 2) {
    $("measured").textContent = measuring.on ? `${taken.length} of 2 points${taken.length ? `: ${described(taken[0])}` : ""}` : "";
    return view.mark(taken.map(({ at }) => at));
  }
  const { distance, angle, delta, from, to } = between(...taken);
  view.mark(taken.map(({ at }) => at), from ? [[from, to]] : []);
  const names = taken.map(({ part }) => mechanism.parts[part]).join(" – ");
  const kinds = delta ? "" : ` (${taken.map(described).join("; ")})`;
  const told = [
    distance === undefined ? "" : `${distance.toFixed(3)} mm`,
    angle ? `${(angle * DEGREES).toFixed(2)}°` : angle === 0 ? "parallel" : "",
    delta ? `(Δx ${delta.x.toFixed(3)}, Δy ${delta.y.toFixed(3)}, Δz ${delta.z.toFixed(3)})` : "",
  ];
  $("measured").textContent = `${names}: ${told.filter(Boolean).join(delta ? " " : ", ")}${kinds}`;
}

// ------------------------------------------------------------------ pictures and films

// Paint the model on a canvas of its own, over the stage's background.
function painted(target, source, width, height) {
  Object.assign(target, { width, height });
  const pen = target.getContext("2d", { willReadFrequently: true }), [top, bottom] = getComputedStyle($("stage")).getPropertyValue("--stage-colors").split(",");
  const gradient = pen.createLinearGradient(0, 0, 0, height);
  gradient.addColorStop(0, top.trim());
  gradient.addColorStop(1, bottom.trim());
  pen.fillStyle = gradient;
  pen.fillRect(0, 0, width, height);
  pen.drawImage(source, 0, 0, width, height);
  return target;
}

function picture() {
  const target = document.createElement("canvas");
  view.picture((source, width, height) => painted(target, source, width, height));
  return new Promise((done) => target.toBlob(done, "image/png"));
}

const FILM_FRAMES = 40; // for each joint, of at most three

// The motion that Play shows, as so many painted pictures; then the model stands as before.
async function film(use) {
  stop();
  const before = [Q, lastArrived], movers = controls.map((control) => control.mover);
  for (const mover of movers) mover.rest = mover.restValue();
  const total = FILM_FRAMES * Math.min(3, Math.max(1, movers.length));
  const target = document.createElement("canvas");
  try {
    await use({
      count: movers.length ? total : 1,
      at: async (index, width) => {
        atOnce(() => cycle(movers, index / total, { together: !solver.needed }));
        view.picture((source, wide, high) => painted(target, source, wide, high), { width, fine: false });
        await new Promise((done) => setTimeout(done));
        return target;
      },
    });
    say("Saved.");
  } finally {
    [Q, lastArrived] = before;
    update();
  }
}

// A WebM film: frames are handed to the browser's own recorder one by one.
function saveVideo() {
  film(async ({ count, at }) => {
    const width = 720, stage = document.createElement("canvas");
    const copy = (made) => painted(stage, made, made.width, made.height);
    copy(await at(0, width));
    const stream = stage.captureStream(25), recorder = new MediaRecorder(stream, { mimeType: "video/webm", videoBitsPerSecond: 4e6 });
    const pieces = [];
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    const ended = new Promise((done) => (recorder.onstop = done));
    recorder.start();
    for (let index = 0; index < count; index++) {
      say(`Frame ${index + 1} of ${count}`);
      copy(await at(index, width));
      await new Promise((done) => setTimeout(done, 40));
    }
    recorder.stop();
    await ended;
    save(`${model.name}.webm`, new Blob(pieces), "video/webm");
  });
}

// ------------------------------------------------------------------ what is seen, as an address

const rounded = (value) => Number(value.toPrecision(7));

function state() {
  return {
    q: Object.fromEntries(mechanism.columns.map((column, index) => [column.name, Q[index]]).filter(([, value], index) => value !== mechanism.rest[index])),
    camera: view.camera.position.toArray().map(rounded), target: view.controls.target.toArray().map(rounded),
    ...(view.camera === view.parallel ? { parallel: true, zoom: rounded(view.parallel.zoom), distance: rounded(view.distance) } : {}),
    ...(view.explosion ? { explode: view.explosion } : {}),
    ...(view.cutting ? { sections: view.sections } : {}),
    ...(view.groups.every((group) => group.visible) ? {} : { hidden: view.groups.filter((group) => !group.visible).map((group) => group.name) }),
  };
}

function restore({ q, camera, target, parallel, zoom, distance, explode: apart, sections, hidden }) {
  if (apart) explode(apart);
  if (sections) setCuts(sections);
  for (const name of hidden ?? []) if (mechanism.parts.includes(name)) show(mechanism.parts.indexOf(name), false);
  if (q) set(q, { others: "rest" });
  if (!camera) return;
  view.controls.target.fromArray(target);
  view.perspective.position.fromArray(camera);
  if (parallel) {
    view.project(true);
    pressed($("tool-parallel"), true);
    Object.assign(view.parallel, { zoom });
    view.distance = distance;
    view.parallel.position.fromArray(camera);
  }
  view.controls.update();
  view.ask();
}

async function link() {
  const address = `#${encodeURIComponent(JSON.stringify(state()))}`;
  try {
    history.replaceState(null, "", address);
  } catch {
    location.hash = address;
  }
  await navigator.clipboard?.writeText(location.href).then(() => say("The link to this view is copied."), () => say("The address of this page now is a link to this view."));
}

function restoreLink() {
  const text = location.hash.slice(1);
  if (!text) return;
  if (text === "moving") { // no element has this name: the browser would scroll to it
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) $("play").click();
    return;
  }
  try {
    restore(JSON.parse(decodeURIComponent(text)));
  } catch {
    say("The link's view cannot be read.");
  }
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
    view.busy = true;
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
    view.busy = playing !== null;
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
    button.setAttribute("aria-pressed", String(own));
    if (own && !narrow.matches) row.scrollIntoView({ block: "nearest" });
  }
  refreshCard();
  say(selected < 0 ? "" : `${model.parts[selected].name} is selected.`);
}

// What is known about the selected part.
function refreshCard() {
  const card = $("card");
  card.hidden = selected < 0;
  if (selected < 0) return card.replaceChildren();
  const { name, material, mass, size, facts } = model.parts[selected];
  const joints = mechanism.joints.filter((joint) => joint.parent === selected || joint.child === selected);
  const listed = [
    ["material", material], ["mass", mass === null ? "unknown" : `${mass.toPrecision(4)} kg`],
    ["size", size ? `${size.map((value) => value.toFixed(1)).join(" × ")} mm` : ""],
    ["joints", joints.map((joint) => `${joint.name} (${joint.type})`).join(", ") || "none"],
    ...facts,
  ];
  const rows = listed.filter(([, value]) => value).flatMap(([key, value]) => [element("dt", { textContent: key }), element("dd", { textContent: value })]);
  const visible = view.groups[selected].visible, alone = view.focused?.size === 1 && view.focused.has(selected);
  const hide = element("button", { type: "button", id: "card-hide", textContent: visible ? "hide" : "show" });
  hide.addEventListener("click", () => show(selected, !visible));
  const only = element("button", { type: "button", id: "card-alone", textContent: alone ? "show all" : "alone" });
  only.addEventListener("click", () => {
    view.focus(alone ? [] : [selected]);
    $("unfocus").hidden = alone;
    refreshCard();
  });
  const close = element("button", { type: "button", textContent: "✕", "aria-label": "deselect" });
  close.addEventListener("click", () => select(selected));
  card.replaceChildren(element("div", { className: "card-head" }, element("h2", { textContent: name }), only, hide, close), element("dl", {}, ...rows));
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
  return solver.follow(lastArrived, wanted);
}

// Pixels by which the grabbed point moves for one unit of a driver: upwards, or downwards where it cannot go up.
function sensitivity(hit, driver) {
  const step = nudge(driver), value = Q[driver.column];
  let way = step, there = driver.endless || value + step <= driver.upper ? moved(driver, value + step) : null;
  if (!there?.arrived) [way, there] = [-step, moved(driver, value - step)];
  const [x0, y0] = seenAt(hit, Q), [x1, y1] = seenAt(hit, there.Q);
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
  " ": () => $("play").click(), o: () => $("tool-parallel").click(), h: () => selected >= 0 && show(selected, !view.groups[selected].visible),
  f: () => view.look("iso"), r: reset, a: () => $("tool-axes").click(), n: () => $("tool-names").click(), m: () => $("tool-measure").click(),
  Escape: () => (measuring.on ? $("tool-measure").click() : selected >= 0 ? select(selected) : unfocus()),
  "+": () => view.zoom(0.85), "-": () => view.zoom(1 / 0.85),
};
const TURNS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };

// On paper every section is open, and the model is drawn again: the browser keeps no picture of it.
function buildPrint() {
  const opened = [];
  addEventListener("beforeprint", () => {
    for (const section of document.querySelectorAll("details.section:not([open])")) {
      section.open = true;
      opened.push(section);
    }
    view?.resize();
    view?.finish();
  });
  addEventListener("afterprint", () => {
    for (const section of opened.splice(0)) section.open = false;
  });
}

function buildKeys() {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !view) return;
    const typing = event.target.matches("input, select, textarea") || (event.key === " " && event.target.matches("button, summary, a"));
    if (event.target === view.canvas && event.key in TURNS) view.turn(...TURNS[event.key]);
    else if (!typing && event.key in KEYS) KEYS[event.key]();
    else return;
    event.preventDefault();
  });
}

// ------------------------------------------------------------------ names over the picture

let named = false;
const labels = new Labels($("labels"), $("leaders"));
let cube = null;

function refreshLabels() {
  if (!view?.poses) return;
  mechanism.joints.forEach((joint, index) => {
    const wanted = joint.type !== "fixed" && (view.axes.visible || emphasised === joint.name || emphasised?.startsWith(`${joint.name}.`));
    if (!wanted) return;
    const e = view.triads[index].matrix.elements;
    labels.put(`joint ${index}`, joint.name, "joint", view.screen(new Vector3(e[12] + 1.15 * e[8], e[13] + 1.15 * e[9], e[14] + 1.15 * e[10])));
  });
  if (named) {
    view.groups.forEach((group, index) => {
      if (!group.visible || !model.parts[index].shapes.length) return;
      labels.put(`part ${index}`, mechanism.parts[index], "part", view.screen(new Vector3(...model.parts[index].middle).applyMatrix4(group.matrix)));
    });
  }
  labels.arrange();
  cube?.turn(view.camera.matrixWorldInverse.elements);
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
    cube = new Cube($("cube"), (side) => view.look(side));
    view.measure(mechanism.poses(Q));
    view.resize();
    view.look("iso");
    buildPointer();
    buildTools();
    buildKeys();
  }
  buildTables();
  buildPrint();
  update();
  if (view) {
    if (model.watch) {
      watch(model.watch, {
        busy: () => view.busy && playing === null,
        kept: () => ({ ...state(), playing: playing === $("play"), axes: view.axes.visible, named, theme: document.documentElement.dataset.theme ?? null, selected: mechanism.parts[selected] ?? null }),
        restore: (kept) => {
          restore(kept);
          if (kept.axes) $("tool-axes").click();
          if (kept.named) $("tool-names").click();
          if (kept.playing) $("play").click();
          if (kept.theme) document.documentElement.dataset.theme = kept.theme;
          if (mechanism.parts.includes(kept.selected)) select(mechanism.parts.indexOf(kept.selected));
        },
      });
    }
    restoreLink();
  }
  window.articad = { model, set, q: named_q, poses, drawn, view, reset, state, picture, directions: Object.keys(DIRECTIONS) };
  requestAnimationFrame(() => {
    view?.draw();
    window.articad.firstFrame = performance.now();
    document.documentElement.dataset.ready = "";
  });
}

begin();
