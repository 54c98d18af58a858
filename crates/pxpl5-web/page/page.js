// The page: settings from the form or the address, a run in pieces, and what there is to see of it between them.
import init, { WebMachine, catalog } from "./pxpl5_web.js";

const at = (id) => document.getElementById(id);
const form = at("settings");

/** The settings that the address may have, in the order of the link. */
const KEYS = ["pipeline", "scene", "triangles", "display", "head.motion", "fields"];
const FIRST = { pipeline: "slats", scene: "aircraft", display: "ntsc", fields: "120" };
/** Most simulated time of one piece, picoseconds, so that the page stays awake: a field. */
const LONGEST = 16.7e9;
/** Milliseconds that a piece of a run may take before the page is drawn again. */
const PATIENCE = 40;

let machine = null;
let settings = {};
let running = false;
let chosen = null;
let state = null;
let shown = { eyes: [], boards: new Map() };
let last = 0;

function choices(name, all) {
  form.elements[name].replaceChildren(...all.map(({ name, about }) => {
    const option = new Option(name === "" ? "scene's own" : name, name);
    option.title = about;
    return option;
  }));
}

function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const known = KEYS.filter((key) => given.get(key));
  return { ...FIRST, ...Object.fromEntries(known.map((key) => [key, given.get(key)])) };
}

function intoForm() {
  for (const key of KEYS) {
    const field = form.elements[key];
    const value = settings[key] ?? "";
    // A setting of the address that the lists do not have, such as another number of triangles in a scene's name.
    if (field.options && ![...field.options].some((option) => option.value === value)) field.add(new Option(value, value));
    field.value = value;
  }
}

function fromForm() {
  const pairs = KEYS.map((key) => [key, form.elements[key].value.trim()]);
  return Object.fromEntries(pairs.filter(([, value]) => value !== ""));
}

/** Builds the machine of the settings; what is wrong with them is said, and the machine before stays. */
function build() {
  try {
    const next = new WebMachine(Object.entries(settings).map(([key, value]) => `${key}=${value}`).join("\n"));
    machine?.free();
    machine = next;
    at("error").hidden = true;
    at("run").inert = false;
  } catch (error) {
    at("error").textContent = error.message;
    at("error").hidden = false;
    return false;
  }
  pause();
  chosen = null;
  state = JSON.parse(machine.state());
  layOut();
  draw();
  return true;
}

function layOut() {
  shown.eyes = state.surfaces.map(({ label, width, height }) => {
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `What the beam has drawn: ${label}`);
    const caption = Object.assign(document.createElement("figcaption"), { textContent: label });
    const figure = document.createElement("figure");
    figure.append(canvas, caption);
    return { canvas, figure };
  });
  at("eyes").replaceChildren(...shown.eyes.map((eye) => eye.figure));
  shown.boards = new Map();
  for (const [kind, place] of [["processor", "processors"], ["renderer", "renderers"]]) {
    const boards = state.boards.filter((board) => board.kind === kind);
    at(place).replaceChildren(...boards.map((board, number) => card(board, kind, number)));
  }
  at("board").textContent = "";
  at("board-name").textContent = "Choose a board for its state";
}

function card(board, kind, number) {
  const button = Object.assign(document.createElement("button"), { type: "button" });
  button.setAttribute("aria-pressed", "false");
  const name = Object.assign(document.createElement("strong"), { textContent: board.name });
  const does = Object.assign(document.createElement("span"), { className: "does" });
  const parts = { button, name, does, number };
  button.append(name);
  if (kind === "renderer") {
    parts.canvas = Object.assign(document.createElement("canvas"), { width: 128, height: 128 });
    parts.canvas.setAttribute("aria-hidden", "true");
    parts.fifo = Object.assign(document.createElement("meter"), { min: 0, max: board.depth });
    parts.fifo.setAttribute("aria-label", `words in the FIFO of ${board.name}`);
    button.append(parts.canvas, parts.fifo);
  }
  button.append(does);
  button.addEventListener("click", () => {
    chosen = board.name;
    draw();
  });
  shown.boards.set(board.name, parts);
  return button;
}

function picture(canvas, bytes) {
  if (bytes.length === 0) return;
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes), canvas.width, canvas.height), 0, 0);
}

function enabledPixels(canvas, bits) {
  if (bits.length === 0) return;
  const image = new ImageData(128, 128);
  for (let pixel = 0; pixel < 128 * 128; pixel += 1) {
    const on = (bits[pixel >> 3] >> (pixel & 7)) & 1;
    image.data.set(on ? [79, 209, 165, 255] : [0, 0, 0, 255], 4 * pixel);
  }
  canvas.getContext("2d").putImageData(image, 0, 0);
}

function draw() {
  state = JSON.parse(machine.state());
  at("time").textContent = `${(state.now_ps / 1e9).toFixed(6)} ms`;
  at("field").textContent = `${state.field} of ${state.fields}`;
  at("line").textContent = state.line ?? "-";
  at("hash").textContent = state.trace_hash;
  const says = state.failure ? `The machine cannot go on: ${state.failure}` : state.over ? "All fields have been simulated." : state.last;
  at("failure").textContent = says ?? "";
  at("failure").hidden = !says;
  shown.eyes.forEach(({ canvas }, surface) => picture(canvas, machine.seen(surface)));
  drawRing();
  state.boards.forEach(drawBoard);
  if (chosen) {
    at("board-name").textContent = chosen;
    at("board").textContent = machine.board(chosen);
  }
  drawLink();
  if ((state.over || state.failure) && running) pause();
}

function drawRing() {
  at("ring").replaceChildren(...state.channels.map((message) => {
    const item = document.createElement("li");
    item.className = message ? "busy" : "idle";
    item.textContent = message ? `${message.from} to ${message.to}, ${message.words} words` : "free";
    return item;
  }));
}

function drawBoard(board) {
  const { button, name, does, canvas, fifo, number } = shown.boards.get(board.name);
  name.className = board.works ? "works" : "";
  does.textContent = board.does;
  button.setAttribute("aria-pressed", String(board.name === chosen));
  if (fifo) fifo.value = board.fifo;
  if (canvas) enabledPixels(canvas, machine.enabled(number));
}

function drawLink() {
  const address = new URLSearchParams({ ...settings, at: String(state.now_ps) });
  at("link").href = `#${address}`;
  const options = Object.entries(settings).map(([key, value]) => `--set ${key}=${value}`);
  at("command").textContent = `pxpl5 debug ${options.join(" ")} --do "run to ${state.now_ps}ps; show time"`;
}

function pause() {
  running = false;
  at("go").textContent = "Run";
  at("go").setAttribute("aria-pressed", "false");
}

const slowness = () => 10 ** Number(at("slower").value);

/** Goes on by as much simulated time as has passed, divided by how much slower it shall be, as far as the computer comes. */
function frame(now) {
  if (!running) return;
  const wanted = Math.min(((now - last) * 1e9) / slowness(), LONGEST);
  last = now;
  const begun = performance.now();
  const goal = state.now_ps + wanted;
  for (let part = 1; part <= 8 && performance.now() - begun < PATIENCE; part += 1) {
    machine.run_to(Math.round(state.now_ps + ((goal - state.now_ps) * part) / 8));
  }
  draw();
  requestAnimationFrame(frame);
}

at("go").addEventListener("click", () => {
  if (running) return pause();
  running = true;
  at("go").textContent = "Pause";
  at("go").setAttribute("aria-pressed", "true");
  last = performance.now();
  requestAnimationFrame(frame);
});

for (const button of document.querySelectorAll("[data-step]")) {
  button.addEventListener("click", () => {
    pause();
    machine.step(button.dataset.step);
    draw();
  });
}

at("slower").addEventListener("input", () => {
  at("factor").textContent = Math.round(slowness()).toLocaleString("en");
});

form.addEventListener("submit", (event) => {
  event.preventDefault();
  settings = fromForm();
  if (build()) history.replaceState(null, "", `#${new URLSearchParams(settings)}`);
});

function open() {
  settings = fromAddress();
  intoForm();
  if (!build()) return;
  const instant = Number(new URLSearchParams(location.hash.slice(1)).get("at"));
  if (instant > 0) machine.run_to(instant);
  draw();
}

addEventListener("hashchange", open);
await init({ module_or_path: new URL("pxpl5_web_bg.wasm", import.meta.url) });
const all = JSON.parse(catalog());
choices("pipeline", all.pipelines);
choices("scene", all.scenes);
choices("display", all.displays.map((name) => ({ name, about: "" })));
choices("head.motion", all.motions);
open();
document.documentElement.dataset.ready = "true";
