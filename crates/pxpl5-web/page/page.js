// The page: settings from the form or the address, a run in pieces, and what there is to see of it between them.
import { Live, Recorder, csv } from "./recording.js";
import { drawBoards, drawFaces, drawLatency, drawRing, drawTimeline, layOutEyes, picture } from "./draw.js";

const at = (id) => document.getElementById(id);
const form = at("settings");

/** The settings that the address may have, in the order of the link. */
const KEYS = ["pipeline", "scene", "triangles", "display", "head.motion", "head.tracker", "head.predict", "level", "fields"];
const FIRST = { pipeline: "slats", scene: "aircraft", display: "ntsc", fields: "3600" };
/** What a recording of the visitor is called in settings and files. */
const RECORDED = "recorded.csv";
/** The same of a head that is moved while the machine runs. */
const LIVE = "live.csv";
/** Most simulated time of one piece, picoseconds: four fields. */
const LONGEST = 66.7e9;
/** Milliseconds between two looks at boards and errors, and at timeline and latency. */
const BOARDS_EVERY = 100;
const TIMELINE_EVERY = 500;

let settings = {};
let beside = "";
/** What the visitor recorded, as the address has it. */
let motion = "";
/** The head that is moved while the machine runs; null for another. */
let live = null;
/** The file that was dropped last: name and bytes. */
let dropped = null;
let machines = [];
let of = 0;
let chosen = null;
let pixel = null;
let running = false;
let looked = { boards: 0, timeline: 0 };

// The worker that has the machines.

let worker;
let asked = new Map();
let numbers = 0;

function startWorker() {
  worker?.terminate();
  worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  asked = new Map();
  worker.onmessage = ({ data }) => {
    const { done, failed } = asked.get(data.id);
    asked.delete(data.id);
    document.documentElement.dataset.asked = asked.size;
    if (data.error === undefined) done(data.value);
    else failed(Object.assign(new Error(data.error), { broken: data.broken }));
  };
  return ask("open");
}

function ask(operation, given) {
  numbers += 1;
  worker.postMessage({ id: numbers, operation, given });
  return new Promise((done, failed) => {
    asked.set(numbers, { done, failed });
    // Tests wait until nothing is asked any more.
    document.documentElement.dataset.asked = asked.size;
  });
}

// Settings.

function choices(name, all) {
  form.elements[name].replaceChildren(...all.map(({ name: value, about, label }) => {
    const option = new Option(label ?? value, value);
    option.title = about ?? "";
    return option;
  }));
}

function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const known = KEYS.filter((key) => given.get(key));
  beside = given.get("beside") ?? "";
  motion = given.get("motion") ?? "";
  return { ...FIRST, ...Object.fromEntries(known.map((key) => [key, given.get(key)])) };
}

function intoForm() {
  for (const key of [...KEYS, "beside"]) {
    const field = form.elements[key];
    const value = (key === "beside" ? beside : settings[key]) ?? "";
    // A setting of the address that the lists do not have, such as another number of triangles in a scene's name.
    if (field.options && ![...field.options].some((option) => option.value === value)) field.add(new Option(value, value));
    field.value = value;
  }
}

function fromForm() {
  const pairs = KEYS.map((key) => [key, form.elements[key].value.trim()]);
  beside = form.elements.beside.value;
  return Object.fromEntries(pairs.filter(([, value]) => value !== ""));
}

/** Settings of the experiment under a pipeline, with what follows from others: a display that turns with the head for its pipelines. */
function settingsOf(pipeline) {
  const all = { ...settings, pipeline };
  if (pipeline.startsWith("arp") !== (all.display === "arp")) all.display = pipeline.startsWith("arp") ? "arp" : "ntsc";
  if (!all["head.motion"]) ["head.tracker", "head.predict"].forEach((key) => delete all[key]);
  if (all["head.motion"]?.endsWith(".csv")) all["head.end"] = "hold";
  // What is done now is not known ahead.
  if (all["head.motion"] === LIVE) all["head.predict"] = "none";
  return all;
}

const pipelines = () => (beside ? [settings.pipeline, beside] : [settings.pipeline]);

function say(message) {
  at("error").textContent = message;
  at("error").hidden = !message;
}

/** A fault of the emulator itself leaves nothing to go on with: a new worker is started. */
async function refused(error) {
  if (error.broken) {
    await startWorker();
    machines = [];
    at("run").inert = true;
    say(`The emulator has met a fault of its own (${error.message}). Build another experiment.`);
    return;
  }
  say(error.message);
}

/** Builds the machines of the settings; what is wrong with them is said, and the machines before stay. */
async function build() {
  pause();
  await piece;
  const files = [];
  if (dropped) files.push([dropped.name, dropped.bytes]);
  if (settings["head.motion"] === RECORDED) {
    const text = csv(motion);
    if (text === null) return say("expected motion=yaw,pitch_yaw,pitch_... in tenths of a degree in the address"), false;
    files.push([RECORDED, new TextEncoder().encode(text)]);
  }
  const begun = settings["head.motion"] === LIVE ? new Live() : null;
  if (begun) files.push([LIVE, new TextEncoder().encode(csv("0,0"))]);
  const texts = pipelines().map((name) => Object.entries(settingsOf(name)).map(([key, value]) => `${key}=${value}`).join("\n"));
  say("");
  document.body.dataset.busy = "true";
  try {
    await ask("build", { runs: texts, files });
  } catch (error) {
    await refused(error);
    return false;
  } finally {
    delete document.body.dataset.busy;
  }
  at("run").inert = false;
  live = begun;
  reached = 0;
  chosen = null;
  pixel = null;
  of = 0;
  at("board").textContent = "";
  at("board-name").textContent = "Choose a board for its state";
  at("pixel").hidden = true;
  at("volume").hidden = true;
  machines = [];
  await go({ to: 0 });
  return true;
}

// Looks.

/** What is to be seen at this moment: pictures always, the rest now and then, or all of it when the run stands. */
function wanted(now) {
  const stands = !running;
  const want = { of, ideal: at("show-ideal").checked, error: at("show-error").checked };
  if (stands || now - looked.boards > BOARDS_EVERY) {
    looked.boards = now;
    const open = at("machine-part").open;
    Object.assign(want, { boards: open, renderers: open, board: chosen, pixel });
    if (at("faces-part").open) want.faces = Number(at("memory").value || 0);
  } else {
    want.ideal = want.error = false;
  }
  if (stands || now - looked.timeline > TIMELINE_EVERY) {
    looked.timeline = now;
    if (at("timeline-part").open) want.timeline = Number(at("span").value);
    if (at("latency-part").open) want.latencies = 8;
  }
  return want;
}

let piece = Promise.resolve();
/** Where the run stands, picoseconds. */
let reached = 0;
/** How far one step goes at most: an event is not later than the next field. */
const STEP = 35e9;

/** One piece of a run, one at a time; what cannot go on is said. */
function go(how) {
  piece = piece.then(async () => {
    try {
      const rows = live?.until(how.to ?? reached + (how.by ?? (how.step ? STEP : 0))) ?? null;
      draw(await ask("go", { ...how, rows, want: wanted(performance.now()) }));
    } catch (error) {
      pause();
      await refused(error);
    }
  });
  return piece;
}

function draw(seen) {
  const states = seen.machines.map((machine) => machine.state);
  const state = states[0];
  reached = Math.max(...states.map((one) => one.now_ps));
  if (machines.length === 0) layOut(states);
  machines.forEach(({ eyes }, n) => {
    seen.machines[n].surfaces.forEach((surface, number) => {
      const { canvas, ideal, heat, numbers } = eyes[number];
      picture(canvas, surface.seen);
      ideal.parentElement.hidden = !at("show-ideal").checked;
      heat.parentElement.hidden = !at("show-error").checked;
      if (surface.ideal) picture(ideal, surface.ideal);
      if (surface.heat) picture(heat, surface.heat);
      if (surface.difference) {
        const { differing_percent: share, mean_percent: mean } = surface.difference;
        numbers.textContent = `error: ${mean.toFixed(2)} % of full brightness in the mean, ${share.toFixed(1)} % of the pixels differ`;
      }
    });
  });
  at("time").textContent = `${(state.now_ps / 1e9).toFixed(6)} ms`;
  at("field").textContent = `${state.field} of ${state.fields}`;
  at("line").textContent = state.line ?? "-";
  at("bytes").textContent = `${Math.round(seen.bytes / 1e6)} MB`;
  at("hash").textContent = states.map((one) => one.trace_hash).join(" ");
  const failed = states.find((one) => one.failure);
  const says = failed ? `The machine cannot go on: ${failed.failure}` : state.over ? "All fields have been simulated." : state.last;
  at("failure").textContent = says ?? "";
  at("failure").hidden = !says;
  at("failure").className = failed ? "wrong" : "";
  if (seen.boards) {
    drawRing(at("ring"), seen.channels);
    drawBoards(seen, chosen, choose);
    if (seen.board !== null) {
      at("board-name").textContent = chosen;
      at("board").textContent = seen.board;
    }
    at("pixel").hidden = pixel === null;
    if (pixel) at("pixel").textContent = seen.pixel || "Nothing has been drawn there yet, or there is no such pixel.";
  }
  if (seen.timeline !== null) drawTimeline(at("timeline"), seen.timeline);
  if (seen.machines[0].latencies) drawLatency(at("latency"), seen.machines, names());
  if (seen.faces) drawFaces(at("faces"), seen.faces);
  drawLink(state);
  if ((failed || state.over) && running) pause();
}

const names = () => pipelines();

function layOut(states) {
  machines = layOutEyes(at("eyes"), states, names(), record);
  ["processors", "renderers", "displays"].forEach((place) => at(place).replaceChildren());
  const memories = states[0].memories;
  at("faces-part").hidden = memories === 0;
  at("memory").replaceChildren(...Array.from({ length: memories }, (_, n) => new Option(n > 0 && n + 1 === memories ? `${n} (background)` : n, n)));
  at("whose").textContent = machines.length > 1 ? `of ${names()[0]}` : "";
}

function choose(name) {
  chosen = name;
  if (name.startsWith("renderer")) at("pixel-form").elements.renderer.value = name.split(" ")[1];
  if (!running) go({});
}

function drawLink(state) {
  // What was moved while the machine ran is a recording now.
  if (live) motion = live.text();
  const told = live ? { ...settings, "head.motion": RECORDED, "head.predict": "none" } : settings;
  const address = new URLSearchParams({ ...told, at: String(state.now_ps) });
  if (beside) address.set("beside", beside);
  if (told["head.motion"] === RECORDED) address.set("motion", motion);
  at("again").hidden = told["head.motion"] === RECORDED && motion === null;
  at("link").href = `#${address}`;
  const commands = pipelines().map((name) => {
    const all = live ? { ...settingsOf(name), "head.motion": RECORDED } : settingsOf(name);
    const options = Object.entries(all).map(([key, value]) => `--set ${key}=${value}`);
    return `pxpl5 debug ${options.join(" ")} --do "run to ${state.now_ps}ps; show time"`;
  });
  at("command").textContent = commands.join("\n");
  drawNeeds();
}

/** Files that the command needs beside it. */
let needed = "";
function drawNeeds() {
  const recorded = (live || settings["head.motion"] === RECORDED) && !running ? motion : "";
  const model = dropped && Object.values(settings).includes(dropped.name) ? dropped.name : "";
  if (needed === `${recorded} ${model}`) return;
  needed = `${recorded} ${model}`;
  at("needs").replaceChildren();
  if (recorded) {
    const blob = new Blob([csv(recorded)], { type: "text/csv" });
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: RECORDED, textContent: RECORDED });
    at("needs").append(", beside the file ", link, ",");
  }
  if (model) at("needs").append(`, beside your file ${model}, which the link cannot carry,`);
}

// Running.

function pause() {
  running = false;
  at("go").textContent = "Run";
  at("go").setAttribute("aria-pressed", "false");
  at("speed").textContent = "stands";
}

const slowness = () => 10 ** Number(at("slower").value);
const nextFrame = () => new Promise((done) => requestAnimationFrame(done));

/** Goes on by as much simulated time as has passed, divided by how much slower it shall be, as far as the computer comes. */
async function run() {
  running = true;
  at("go").textContent = "Pause";
  at("go").setAttribute("aria-pressed", "true");
  let last = performance.now();
  let counted = { at: last, ps: null };
  while (running) {
    await nextFrame();
    const now = performance.now();
    const by = Math.min(((now - last) * 1e9) / slowness(), LONGEST);
    last = now;
    await go({ by });
    if (counted.ps === null) counted = { at: now, ps: reached };
    if (now - counted.at > 1000) {
      const share = (reached - counted.ps) / ((now - counted.at) * 1e9);
      if (running) at("speed").textContent = `${share.toPrecision(2)} of real time`;
      counted = { at: now, ps: reached };
    }
  }
  await go({});
}

at("go").addEventListener("click", () => (running ? pause() : run()));

for (const button of document.querySelectorAll("[data-step]")) {
  button.addEventListener("click", () => {
    pause();
    go({ step: button.dataset.step });
  });
}

at("slower").addEventListener("input", () => {
  at("factor").textContent = Math.round(slowness()).toLocaleString("en");
});

for (const id of ["show-ideal", "show-error", "span", "memory"]) at(id).addEventListener("input", () => running || go({}));
for (const part of document.querySelectorAll("details")) part.addEventListener("toggle", () => running || machines.length === 0 || go({}));

at("pixel-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const { renderer, x, y } = at("pixel-form").elements;
  pixel = [renderer, x, y].map((field) => Number(field.value));
  if (!running) go({});
});

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  settings = fromForm();
  if (await build()) remember();
});

function remember() {
  const address = new URLSearchParams(settings);
  if (beside) address.set("beside", beside);
  if (settings["head.motion"] === RECORDED) address.set("motion", motion);
  history.replaceState(null, "", `#${address}`);
}

// The visitor's own head and files.

/** Milliseconds of turning that are recorded, and after which a device that reports none is known. */
const TILTED = 5000;
/** Width of a picture in degrees, as a drag across it turns the head. */
const WIDE = 60;

/** Has a canvas move the head while somebody drags across it, or record a motion where the head is not moved live. */
function record(canvas) {
  let recorder = null;
  let from = null;
  let before = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    recorder = new Recorder();
    from = event;
    before = live?.now;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!recorder) return;
    const degrees = (pixels) => (pixels / canvas.clientWidth) * WIDE;
    const turned = [degrees(event.clientX - from.clientX), degrees(event.clientY - from.clientY)];
    if (live) return live.turn(...turned.map((angle, n) => before[n] / 10 + angle));
    recorder.turn(...turned);
    at("recorded").textContent = `Recording: ${recorder.angles.length} samples`;
  });
  const end = () => {
    if (!live && recorder && recorder.angles.length > 3) follow(recorder);
    recorder = null;
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
}

async function follow(recorder) {
  motion = recorder.text();
  settings = { ...settings, "head.motion": RECORDED };
  settings["head.tracker"] ??= form.elements["head.tracker"].value || "optical";
  settings["head.predict"] ??= form.elements["head.predict"].value || "none";
  intoForm();
  at("recorded").textContent = `Recorded ${(recorder.angles.length / 60).toFixed(1)} s. The machine follows it.`;
  if (await build()) {
    remember();
    run();
  }
}

if (window.DeviceOrientationEvent && matchMedia("(pointer: coarse)").matches) at("tilt").hidden = false;
at("tilt").addEventListener("click", async () => {
  const allowed = (await DeviceOrientationEvent.requestPermission?.()) ?? "granted";
  if (allowed !== "granted") return say("The device does not let this page know how it is turned.");
  const head = live ?? new Recorder();
  let from = null;
  const turned = ({ alpha, beta }) => {
    if (alpha === null) return;
    from ??= [alpha, beta];
    head.turn(((alpha - from[0] + 540) % 360) - 180, beta - from[1]);
  };
  addEventListener("deviceorientation", turned);
  await new Promise((later) => setTimeout(later, TILTED));
  if (from === null) say("This device reports no turning.");
  // A live head is turned by the device until another machine is built.
  else if (head === live) return;
  removeEventListener("deviceorientation", turned);
  if (from !== null) follow(head);
});

async function take(file) {
  const before = { settings, dropped };
  dropped = { name: file.name.replaceAll(/\s+/g, "-"), bytes: new Uint8Array(await file.arrayBuffer()) };
  const isMotion = /\.(csv|txt|tum)$/i.test(dropped.name);
  const key = isMotion ? "head.motion" : "scene";
  settings = { ...settings, [key]: dropped.name };
  if (!isMotion) delete settings.triangles;
  if (isMotion) settings["head.tracker"] ??= "optical";
  if (await build()) {
    intoForm();
    remember();
    at("dropped").textContent = `${dropped.name} is used as ${isMotion ? "the head's motion" : "the scene"}.`;
  } else {
    ({ settings, dropped } = before);
    at("dropped").textContent = "";
  }
}

at("file").addEventListener("change", () => at("file").files[0] && take(at("file").files[0]));
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  if (event.dataTransfer.files[0]) take(event.dataTransfer.files[0]);
});

// The spinning screen.

at("volume-draw").addEventListener("click", async () => {
  pause();
  at("volume-says").textContent = "Drawing ...";
  try {
    const begun = performance.now();
    const [slices, width, height] = await ask("volume");
    at("volume-says").textContent = `${slices} slices drawn in ${((performance.now() - begun) / 1000).toFixed(1)} s`;
    Object.assign(at("slice"), { max: slices - 1, value: Math.round(slices / 4) });
    Object.assign(at("slice-picture"), { width, height });
    at("volume").hidden = false;
    await Promise.all([slice(), round()]);
  } catch (error) {
    at("volume-says").textContent = "";
    await refused(error);
  }
});

async function slice() {
  at("slice-number").textContent = at("slice").value;
  picture(at("slice-picture"), await ask("slice", { number: Number(at("slice").value) }));
}

async function round() {
  const [azimuth, elevation] = ["azimuth", "elevation"].map((id) => Number(at(id).value));
  picture(at("volume-picture"), await ask("round", { azimuth, elevation, side: at("volume-picture").width }));
}

at("slice").addEventListener("input", slice);
for (const id of ["azimuth", "elevation"]) at(id).addEventListener("change", round);

// Explanations of terms.

function explain(glossary) {
  for (const term of document.querySelectorAll("[data-term]")) {
    const sentence = glossary[term.dataset.term];
    if (!sentence) continue;
    // Inside of what has the focus anyway the term itself needs none.
    if (!term.closest("button, label, summary")) term.tabIndex = 0;
    term.setAttribute("aria-description", sentence);
    const show = () => {
      const place = term.getBoundingClientRect();
      const hint = at("hint");
      hint.textContent = sentence;
      hint.hidden = false;
      hint.style.left = `${Math.max(8, Math.min(place.left, innerWidth - hint.offsetWidth - 8))}px`;
      hint.style.top = `${place.bottom + scrollY + 6}px`;
    };
    const hide = () => (at("hint").hidden = true);
    const holder = term.closest("label")?.querySelector("select, input") ?? term.closest("button, summary") ?? term;
    term.addEventListener("pointerenter", show);
    term.addEventListener("pointerleave", hide);
    holder.addEventListener("focus", show);
    holder.addEventListener("blur", hide);
  }
}

addEventListener("keydown", (event) => event.key === "Escape" && (at("hint").hidden = true));

async function open() {
  settings = fromAddress();
  intoForm();
  if (!(await build())) return;
  const instant = Number(new URLSearchParams(location.hash.slice(1)).get("at"));
  if (instant > 0) await go({ to: instant });
}

const { catalog, glossary } = await startWorker();
const none = { name: "", label: "none" };
choices("pipeline", catalog.pipelines);
choices("beside", [none, ...catalog.pipelines]);
choices("scene", catalog.scenes);
choices("display", catalog.displays.map((name) => ({ name })));
choices("head.motion", catalog.motions.map((one) => ({ ...one, label: one.name === LIVE ? "live" : one.name || "scene's own" })));
choices("head.tracker", [{ name: "", label: "usual" }, ...catalog.trackers.map((name) => ({ name }))]);
choices("head.predict", [{ name: "", label: "usual" }, ...catalog.predictors.map((name) => ({ name }))]);
choices("level", [{ name: "", label: "transaction" }, { name: "cycle", about: glossary["cycle level"] }]);
explain(glossary);
await open();
addEventListener("hashchange", open);
document.documentElement.dataset.ready = "true";
