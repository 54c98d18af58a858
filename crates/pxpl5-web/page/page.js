// The page: stories, and the laboratory with settings from the form or the address. A worker runs the machines in short pieces, and
// the page shows the state between two pieces.
import { buildAside, endAside } from "./aside.js";
import { Live, Recorder, csv } from "./recording.js";
import { Headset, hasHeadset } from "./headset.js";
import { keepLecture, lecture } from "./lecture.js";
import { Sensor, sensorRefused } from "./sensor.js";
import { drawAge, drawBoards, drawFaces, drawLatency, drawOver, drawRing, drawTimeline, humane, inMs, layOutEyes, nameOf, picture } from "./draw.js";
import { Busy } from "./busy.js";
import { Diagram } from "./diagram.js";
import { explain } from "./hints.js";
import { drawHeavy, drawLimits } from "./limits.js";
import { save, wholePicture } from "./save.js";
import { spinningScreen } from "./spin.js";
import { FIRST_SCREEN, STORIES, inPs, storyOf } from "./stories.js";

const at = (id) => document.getElementById(id);
const form = at("settings");

/** Settings that the address can have, in the order of the link. */
const KEYS = ["pipeline", "scene", "triangles", "display", "head.motion", "head.tracker", "head.predict", "head.added_latency", "level", "fields"];
const FIRST = { pipeline: "slats", scene: "aircraft", display: "ntsc", fields: "3600" };
/** Other keys that the address can have. */
const OTHERS = ["beside", "motion", "at", "story", "step", "lecture"];
/** Name of a recording of the visitor, in settings and files. */
const RECORDED = "recorded.csv";
/** Name of the motion of a head that the visitor moves while the machine runs. */
const LIVE = "live.csv";
/** Names of motions in the list, for settings that do not explain themselves. */
const MOTION_NAMES = { "": "scene's own", [LIVE]: "live: you move it", "synthetic:1": "synthetic:1 (computed viewer)" };
/** Maximum simulated time of one piece in picoseconds: four fields. */
const LONGEST = 66.7e9;
/** Milliseconds between two updates of boards and errors, and of timeline and latency. */
const BOARDS_EVERY = 100;
const TIMELINE_EVERY = 500;
/** Milliseconds between two updates of the waits and the use of boards, which take longer to compute. */
const LIMITS_EVERY = 2000;

let settings = {};
let beside = "";
/** Recording of the visitor, in the form of the address. */
let motion = "";
/** The head that the visitor moves while the machine runs; null for another head. */
let live = null;
/** The files that were dropped last, name and bytes: a `scene`, and a `head.motion`. */
let dropped = {};
let machines = [];
let of = 0;
let chosen = null;
let pixel = null;
let running = false;
let updatedAt = { boards: 0, timeline: 0, limits: 0 };
/** Input from which the machines were built: `runs` and `files`. */
let source = null;
/** Mode of the page: `start`, `story` or `lab`. */
let mode = "start";
/** Visible parts besides the pictures: `wire`, `beam`, `regions`, `age`, `latency`, `faces`, `diagram`. */
let show = new Set();
/** Number of eyes that are drawn for each machine. */
let eyesShown = 2;
/** Messages that began after this instant have not been drawn yet, picoseconds. */
let messagesAfter = 0;
/** Last data of the machines, for texts and reports. */
let seenLast = null;
let lastTimeline = "";
const still = matchMedia("(prefers-reduced-motion: reduce)");

// The worker with the machines.

let worker;
let asked = new Map();
let numbers = 0;

function startWorker() {
  worker?.terminate();
  worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  asked = new Map();
  worker.onerror = (event) => cannotStart(event.message || "the worker of this page does not start");
  worker.onmessage = ({ data }) => {
    if (data.loaded !== undefined) return loading(data.loaded, data.all);
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
    // Tests wait until no request is open.
    document.documentElement.dataset.asked = asked.size;
  });
}

/** Shows the loaded share of the machine. */
function loading(bytes, all) {
  const had = `${(bytes / 1e6).toFixed(1)} MB`;
  at("loading-says").textContent = all ? `Loading the machine: ${had} of ${(all / 1e6).toFixed(1)} MB` : `Loading the machine: ${had} so far`;
  if (all) at("loading-share").value = bytes / all;
  else at("loading-share").removeAttribute("value");
}

/** Shows the reason for which the machine cannot start, and a link to the gallery. */
function cannotStart(why) {
  const book = Object.assign(document.createElement("a"), { href: "../docs/gallery.html", textContent: "The gallery of the book" });
  at("loading").hidden = false;
  at("loading-share").hidden = true;
  at("loading").className = "wrong";
  at("loading-says").replaceChildren(`The machine cannot start here: ${why}. Load the page again, or use another browser. `, book, " has pictures of every pipeline.");
  document.documentElement.dataset.ready = "failed";
}

// Settings.

function choices(name, all) {
  form.elements[name].replaceChildren(...all.map(({ name: value, about, label }) => {
    const option = new Option(label ?? value, value);
    option.title = about ?? "";
    return option;
  }));
}

/** Unknown keys of the address. */
let unknown = [];

function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const keys = KEYS.filter((key) => given.get(key));
  unknown = [...given.keys()].filter((key) => !KEYS.includes(key) && !OTHERS.includes(key));
  if (given.has("story") && !storyOf(given)) unknown.push(`story=${given.get("story")}`);
  beside = given.get("beside") ?? "";
  motion = given.get("motion") ?? "";
  return { ...FIRST, ...Object.fromEntries(keys.map((key) => [key, given.get(key)])) };
}

function intoForm() {
  for (const key of [...KEYS, "beside"]) {
    const field = form.elements[key];
    const value = (key === "beside" ? beside : settings[key]) ?? "";
    // The address can have a value that is not in the list, such as another number of triangles in the name of a scene.
    if (field.options && ![...field.options].some((option) => option.value === value)) field.add(new Option(value, value));
    field.value = value;
  }
  at("added").value = settings["head.added_latency"] ?? 0;
  showAdded();
  mark();
}

/** Marks changed settings for which no machine has been built yet. */
function mark() {
  const wanted = { ...fromForm(), beside: form.elements.beside.value };
  const built = { ...settings, beside };
  const names = [...KEYS, "beside"].filter((key) => (wanted[key] ?? "") !== (built[key] ?? ""));
  for (const key of [...KEYS, "beside"]) form.elements[key].closest("label").classList.toggle("changed", names.includes(key));
  at("build").classList.toggle("main", names.length > 0);
  const chosen = ["scene", "pipeline", "head.motion"].map((key) => [form.elements[key].closest("label").textContent.trim().split(/\s/)[0], form.elements[key].selectedOptions[0]?.title]);
  at("about").textContent = chosen.filter(([, about]) => about).map(([name, about]) => `${name}: ${about.replace(/\.$/, "")}.`).join(" ");
  at("changed").textContent = names.length > 0 ? "Changed: press Build. The pictures above show the previous settings." : "";
}

function fromForm() {
  const pairs = KEYS.map((key) => [key, form.elements[key].value.trim()]);
  if (at("added").value === "0") pairs.find(([key]) => key === at("added").name)[1] = "";
  return Object.fromEntries(pairs.filter(([, value]) => value !== ""));
}

/** Returns the settings of the experiment under a pipeline. Some settings follow from others, for example the display from the pipeline. */
function settingsOf(pipeline) {
  const all = { ...settings, pipeline };
  if (pipeline.startsWith("arp") !== (all.display === "arp")) all.display = pipeline.startsWith("arp") ? "arp" : "ntsc";
  if (!all["head.motion"]) ["head.tracker", "head.predict", "head.added_latency"].forEach((key) => delete all[key]);
  if (all["head.motion"]?.endsWith(".csv")) all["head.end"] = "hold";
  // The motion of the visitor cannot be predicted.
  if (all["head.motion"] === LIVE) all["head.predict"] = "none";
  return all;
}

const pipelines = () => (beside ? [settings.pipeline, beside] : [settings.pipeline]);

function say(message) {
  at("error").textContent = message;
  at("error").hidden = !message;
}

/** Shows an error. After a fault of the emulator itself, a new worker starts. */
async function refused(error) {
  if (error.broken) {
    await startWorker();
    machines = [];
    at("run").inert = true;
    say(`The emulator itself has failed (${error.message}). Build another experiment.`);
    return;
  }
  say(error.message);
}

/** Builds machines for the settings. If a setting is wrong, the page shows the error, and the previous machines stay. `kept` is a live
 *  head with earlier samples, which the new machines get again. The new machines run to the instant `begin` before they are shown. */
async function build(kept = null, begin = 0) {
  pause();
  await piece;
  const files = [];
  for (const [key, { name, bytes }] of Object.entries(dropped)) if (settings[key] === name) files.push([name, bytes]);
  if (settings["head.motion"] === RECORDED) {
    const text = csv(motion);
    if (text === null) return say("expected motion=~... or motion=yaw,pitch_yaw,pitch_... (tenths of a degree, at most 1,200 samples) in the address"), false;
    files.push([RECORDED, new TextEncoder().encode(text)]);
  }
  const begun = settings["head.motion"] === LIVE ? kept ?? new Live() : null;
  if (begun) files.push([LIVE, new TextEncoder().encode(csv("0,0"))]);
  const texts = pipelines().map((name) => Object.entries(settingsOf(name)).map(([key, value]) => `${key}=${value}`).join("\n"));
  say(unknown.length > 0 ? `The link has ${unknown.map((key) => `"${key}"`).join(", ")}, which is unknown: expected ${[...KEYS, ...OTHERS].join(", ")}.` : "");
  unknown = [];
  document.body.dataset.busy = "true";
  endAside();
  try {
    await ask("build", { runs: texts, files });
    source = { runs: texts, files };
  } catch (error) {
    await refused(error);
    return false;
  } finally {
    delete document.body.dataset.busy;
  }
  at("run").inert = false;
  live = begun;
  reached = 0;
  messagesAfter = 0;
  seenLast = null;
  chosen = null;
  pixel = null;
  of = 0;
  at("board").textContent = "";
  at("board-name").textContent = "Choose a board to see its state";
  at("pixel").hidden = true;
  at("volume").hidden = true;
  at("volume-says").textContent = "";
  at("heavy").hidden = true;
  heavy = null;
  machines = [];
  diagram.clear();
  busy.clear();
  await go({ to: begin });
  if (mode === "lab") intoForm();
  return true;
}

/** Goes back to an instant: from the last checkpoint before the instant, or from the start if there is no checkpoint. Both ways give the
 *  same run. */
async function rewind(to) {
  pause();
  await piece;
  const found = await ask("back", { to });
  if (found) {
    live?.again(to, found.note);
    reached = found.at;
    busy.clear();
    messagesAfter = to;
    seenLast = null;
  } else {
    await build(live);
    live?.again(to);
  }
  // Tests read the repeated simulated time.
  document.documentElement.dataset.repeatedPs = to - reached;
  await go({ to });
}

// Data for the page.

/** Returns the data that the page needs now: always the pictures, and the other data at intervals. A paused run shows all data. */
function wanted(now) {
  const stands = !running;
  const inLab = mode === "lab";
  const want = { of, surfaces: eyesShown, wire: shows("wire"), regions: shows("regions"), ideal: at("show-ideal").checked && inLab, error: at("show-error").checked && inLab };
  if (stands || now - updatedAt.boards > BOARDS_EVERY) {
    updatedAt.boards = now;
    const open = inLab && at("machine-part").open;
    Object.assign(want, { boards: open || shows("diagram"), renderers: open, board: chosen, pixel, age: true });
    if (want.boards) want.messages = messagesAfter;
    if (shows("faces")) want.faces = at("memory").value === "" || !inLab ? null : Number(at("memory").value);
  } else {
    want.ideal = want.error = false;
  }
  if (stands || now - updatedAt.timeline > TIMELINE_EVERY) {
    updatedAt.timeline = now;
    if (inLab && at("timeline-part").open) want.timeline = Number(at("span").value);
    if (shows("latency")) want.latencies = inLab ? 8 : 1;
  }
  want.busy = inLab && at("busy-part").open;
  if (inLab && at("limits-part").open && (stands || now - updatedAt.limits > LIMITS_EVERY)) {
    updatedAt.limits = now;
    want.limits = true;
  }
  return want;
}

/** Returns true if a part is visible. In a story, the step names the visible parts. */
function shows(part) {
  if (mode !== "lab") return show.has(part);
  if (part === "added" || part === "age") return Boolean(settings["head.motion"]);
  if (part === "alone" || part === "hand") return false;
  if (part === "wire") return at("show-wire").checked;
  if (part === "faces") return machines.memories > 0;
  // At full speed, the beam and the regions are too fast for the eye.
  if (part === "beam" || part === "regions") return !running || slowness() >= 30;
  return true;
}

let piece = Promise.resolve();
/** Instant that the run has reached, in picoseconds. */
let reached = 0;
/** Maximum simulated time of one step in picoseconds. An event is not later than the next field. */
const STEP = 35e9;

/** Maximum simulated time of one piece of a long run in picoseconds, so the page can show the progress. */
const WAY = 2e12;

/** Runs one piece after the previous piece has ended. Shows an error if the machine cannot continue. */
function go(how) {
  piece = piece.then(async () => {
    try {
      // A long run consists of several pieces. The page shows only the state after the last piece.
      while (how.to !== undefined && !how.stop && how.to - reached > WAY) {
        const to = reached + WAY;
        const { machines: all } = await ask("go", { to, rows: live?.until(to) ?? null, note: live?.sent, want: null });
        const before = reached;
        reached = Math.max(...all.map(({ state }) => state.now_ps));
        at("failure").hidden = false;
        at("failure").textContent = `Running to ${inMs(how.to / 1e9)}: ${Math.round((100 * reached) / how.to)} % done`;
        if (reached === before) break;
      }
      const rows = live?.until(how.to ?? reached + (how.by ?? (how.step ? STEP : 0))) ?? null;
      const seen = await ask("go", { ...how, rows, note: live?.sent, want: wanted(performance.now()) });
      draw(seen);
      return seen;
    } catch (error) {
      pause();
      await refused(error);
      return null;
    }
  });
  return piece;
}

/** Returns a time as text. In slow runs and after steps, the text has microseconds. */
function readable(ps) {
  const ms = ps / 1e9;
  const digits = ms < 10 || (mode === "lab" && (slowness() > 10 || stepped)) ? 3 : 0;
  return `${ms.toLocaleString("en", { minimumFractionDigits: digits, maximumFractionDigits: digits })} ms`;
}

function draw(seen) {
  seenLast = seen;
  const states = seen.machines.map((machine) => machine.state);
  const state = states[0];
  reached = Math.max(...states.map((one) => one.now_ps));
  if (machines.length === 0) layOut(states);
  machines.forEach(({ eyes, age }, n) => {
    const { age: found, offset, regions } = seen.machines[n];
    if (found !== undefined) drawAge(age, found, offset);
    seen.machines[n].surfaces.forEach((surface, number) => {
      const { canvas, over, ideal, heat, numbers } = eyes[number];
      if (surface.seen) picture(canvas, surface.seen);
      // All machines have the same head, so the wire frame of the first machine is valid for all.
      const wire = surface.wire ?? seen.machines[0].surfaces[number]?.wire;
      const mine = regions?.filter((region) => region.surface === number);
      drawOver(over, { wire, regions: mine, line: shows("beam") ? states[n].line : null });
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
  at("time").textContent = readable(state.now_ps);
  at("time").dataset.ps = state.now_ps;
  at("field").textContent = `${state.field.toLocaleString("en")} of ${state.fields.toLocaleString("en")}`;
  at("line").textContent = state.line ?? "-";
  at("bytes").textContent = `${Math.round(seen.bytes / 1e6)} MB`;
  at("hash").textContent = states.map((one) => one.trace_hash).join(" ");
  const failed = states.find((one) => one.failure);
  const says = failed ? `The machine cannot go on: ${failed.failure}` : state.over ? "All fields have been simulated. The button Begin again goes back to the first field." : mode === "lab" ? state.last : null;
  at("failure").textContent = says ?? "";
  at("failure").hidden = !says;
  at("failure").className = failed ? "wrong" : "";
  if (seen.boards) {
    messagesAfter = state.now_ps;
    if (shows("diagram")) diagram.draw(seen, chosen);
    if (mode === "lab" && at("machine-part").open) {
      drawRing(at("ring"), seen.channels);
      drawBoards(seen, chosen, choose);
    }
    if (seen.board !== null) {
      at("board-name").textContent = chosen;
      at("board").textContent = humane(seen.board);
    }
    at("pixel").hidden = pixel === null;
    if (pixel) at("pixel").textContent = seen.pixel || "Nothing has been drawn at this pixel yet, or the pixel does not exist.";
  }
  if (seen.timeline !== null) {
    lastTimeline = seen.timeline;
    drawTimeline(at("timeline"), seen.timeline);
  }
  if (seen.machines[0].latencies) drawLatency(at("latency"), seen.machines, names());
  if (seen.faces) drawFaces(at("faces"), seen.faces, eyesShown);
  at("beam-legend").hidden = !shows("beam");
  at("wire-legend").hidden = !shows("wire");
  at("region-legend").hidden = !shows("regions");
  if (seen.busy) {
    busy.add(seen);
    if (seen.boards) busy.draw(at("busy"), names());
  }
  if (seen.machines[0].limits) drawLimits(at("limits"), seen.machines, names());
  if (seen.machines[0].missesAll !== undefined) tellHeavy(seen.machines);
  if (mode === "lab") drawLink(state);
  if (!running) describe();
  if ((failed || state.over) && running) pause();
}

/** The machine that shows no picture: its number and the answer of the second worker; null without such a machine. */
let heavy = null;

/** Shows the reason for which a machine shows no picture, and the number of primitives in time. The search for the number runs once. */
async function tellHeavy(seen) {
  const number = seen.findIndex(({ missesAll, state }) => missesAll && !state.failure);
  at("heavy").hidden = number < 0;
  if (number < 0 || mode !== "lab" || heavy || !source) return;
  const mine = { number, found: null };
  heavy = mine;
  const name = names()[number];
  const use = (primitives) => {
    form.elements.triangles.value = primitives;
    form.requestSubmit();
  };
  drawHeavy(at("heavy"), name, null, use);
  try {
    const askAside = await buildAside(source);
    mine.found = await askAside("fitting", { of: number });
    if (heavy === mine) drawHeavy(at("heavy"), name, mine.found, use);
  } catch {
    // Other machines were built, or the browser has no memory for a second worker. The page then shows only the reason.
    if (heavy === mine) at("heavy").textContent = `${nameOf(name)} finishes no picture in time. Choose fewer primitives.`;
  }
}

/** Describes the pictures in words for screen readers, when the run is paused. */
function describe() {
  machines.forEach(({ eyes }, n) => {
    const { state, age, surfaces } = seenLast.machines[n];
    eyes.forEach(({ canvas, label }, number) => {
      const parts = [`${label} eye under ${nameOf(names()[n])}, scene ${settings.scene}, at ${inMs(state.now_ps / 1e9)}, field ${state.field}`];
      if (age) parts.push(`the picture is ${inMs(age.age_ms)} old`);
      if (state.line !== null) parts.push(`the beam is in line ${state.line}`);
      const difference = surfaces[number]?.difference;
      if (difference) parts.push(`${difference.differing_percent.toFixed(1)} % of the pixels differ from the ideal picture`);
      if (live) parts.push("arrow keys turn the head");
      canvas.setAttribute("aria-label", `${parts.join("; ")}.`);
    });
  });
}

const names = () => pipelines();

function layOut(states) {
  machines = layOutEyes(at("eyes"), states, names(), record);
  machines.forEach(({ section }) => (section.dataset.eyes = eyesShown));
  at("faces").replaceChildren();
  ["processors", "renderers", "displays"].forEach((place) => at(place).replaceChildren());
  const memories = states[0].memories;
  machines.memories = memories;
  at("memory").replaceChildren(new Option("all, the nearest of each", ""), ...Array.from({ length: memories }, (_, n) => new Option(n > 0 && n + 1 === memories ? `${n} (background)` : n, n)));
  layOutParts();
  at("whose").textContent = machines.length > 1 ? `of ${nameOf(names()[0])}` : "";
}

/** Shows the parts of the mode. */
function layOutParts() {
  document.body.dataset.mode = mode;
  at("start").hidden = mode !== "start";
  at("story").hidden = mode !== "story";
  at("tell").hidden = mode === "lab";
  at("lag").hidden = !shows("added");
  document.body.classList.toggle("alone", shows("alone"));
  document.body.classList.toggle("can-drag", shows("hand"));
  at("latency-part").hidden = !shows("latency");
  at("faces-part").hidden = !shows("faces");
  at("diagram-part").hidden = !shows("diagram");
  at("to-start").setAttribute("aria-current", String(mode === "start"));
  at("to-lab").setAttribute("aria-current", String(mode === "lab"));
  document.body.classList.toggle("ages", shows("age"));
  document.body.classList.toggle("with-faces", shows("faces") && mode === "story");
  document.body.classList.toggle("with-diagram", shows("diagram") && mode === "story");
}

const busy = new Busy();
const diagram = new Diagram(at("diagram"), at("diagram-legend"), choose);

function choose(name) {
  chosen = name;
  if (name.startsWith("renderer")) at("pixel-form").elements.renderer.value = name.split(" ")[1];
  if (!running) go({});
}

function drawLink(state) {
  // The motion of a live head is now a recording.
  if (live) motion = live.text();
  const shared = live ? { ...settings, "head.motion": RECORDED, "head.predict": "none" } : settings;
  const address = addressOf(shared);
  if (state.now_ps > 0) address.set("at", String(state.now_ps));
  at("again-link").hidden = shared["head.motion"] === RECORDED && motion === null;
  at("link").href = `#${address}`;
  const commands = pipelines().map((name) => {
    const all = live ? { ...settingsOf(name), "head.motion": RECORDED } : settingsOf(name);
    const options = Object.entries(all).map(([key, value]) => `--set ${key}=${value}`);
    return `pxpl5 debug ${options.join(" ")} --do "run to ${state.now_ps}ps; show time"`;
  });
  at("command").textContent = commands.join("\n");
  drawNeeds();
}

/** Returns the address of settings, without the default settings of the page. */
function addressOf(all) {
  const kept = KEYS.filter((key) => all[key] && (all[key] !== FIRST[key] || key === "pipeline")).map((key) => [key, all[key]]);
  const address = new URLSearchParams(kept);
  if (beside) address.set("beside", beside);
  if (all["head.motion"] === RECORDED) address.set("motion", motion);
  return address;
}

/** Names of the files that the command needs, as they were last shown. */
let needed = "";
function drawNeeds() {
  const isRecorded = (live || settings["head.motion"] === RECORDED) && !running;
  const recorded = isRecorded ? live?.csv() ?? csv(motion) : "";
  const used = Object.entries(dropped).filter(([key, { name }]) => settings[key] === name);
  const yours = used.map(([, { name }]) => `file ${name}`).join(" and your ");
  if (needed === `${recorded} ${yours}`) return;
  needed = `${recorded} ${yours}`;
  at("needs").replaceChildren();
  if (recorded) {
    const blob = new Blob([recorded], { type: "text/csv" });
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: RECORDED, textContent: RECORDED });
    at("needs").append(", beside the file ", link, ",");
  }
  if (yours) at("needs").append(`, beside your ${yours}, which the link does not contain,`);
}

// Running.

function pause() {
  running = false;
  at("go").textContent = "Run";
  at("go").setAttribute("aria-pressed", "false");
  at("speed").textContent = "paused";
  runs += 1;
}

const slowness = () => 10 ** Number(at("slower").value);
const nextFrame = () => headset?.nextFrame() ?? new Promise((done) => requestAnimationFrame(done));

/** Number of starts and ends of runs. A run whose number differs is not the present run any more. */
let runs = 0;
/** True if the last action was a step of an event or a line. */
let stepped = false;

/** Runs the machines at the chosen speed, to an instant (`end`) or an event (`stop`). A slow computer runs them more slowly. Returns true
 *  if the run has reached its end. */
async function run({ end = Infinity, stop = null } = {}) {
  if (machines.length === 0) return false;
  running = true;
  runs += 1;
  const mine = runs;
  stepped = false;
  at("go").textContent = "Pause";
  at("go").setAttribute("aria-pressed", "true");
  at("speed").textContent = "runs";
  let last = performance.now();
  let counted = { at: last, ps: null };
  let isThere = false;
  while (running && mine === runs && !isThere) {
    await nextFrame();
    if (mine !== runs) break;
    const now = performance.now();
    const by = Math.min(((now - last) * 1e9) / slowness(), LONGEST, end - reached);
    last = now;
    const watch = stop && { ...stop, piece: Math.max(by / 100, 10e6) };
    const seen = await go(watch ? { by, stop: watch } : { by });
    isThere = Boolean(seen?.stopped) || reached >= end;
    if (counted.ps === null) counted = { at: now, ps: reached };
    if (now - counted.at > 1000) {
      const share = (reached - counted.ps) / ((now - counted.at) * 1e9);
      if (running && mine === runs) at("speed").textContent = share > 0.95 ? "real time" : share > 0.1 ? `${share.toFixed(2)} of real time` : `${Math.round(1 / share).toLocaleString("en")} times slower`;
      counted = { at: now, ps: reached };
    }
  }
  if (mine !== runs && !isThere) {
    // The visitor has paused the run, so the page shows all data.
    if (!running) await go({});
    return false;
  }
  pause();
  await go({});
  return isThere;
}

at("go").addEventListener("click", () => (running ? pause() : run()));
at("rewind").addEventListener("click", () => rewind(0));
at("back").addEventListener("click", back);

/** Goes back by one field of the first display. */
async function back() {
  pause();
  await piece;
  const state = seenLast?.machines[0].state;
  if (!state || state.back_ps === null) return;
  await rewind(state.back_ps);
}

for (const button of document.querySelectorAll("[data-step]")) {
  button.addEventListener("click", () => {
    pause();
    stepped = button.dataset.step !== "field";
    go({ step: button.dataset.step });
  });
}

at("slower").addEventListener("input", () => {
  at("factor").textContent = Math.round(slowness()).toLocaleString("en");
});

for (const id of ["show-wire", "show-ideal", "show-error", "span", "memory"]) at(id).addEventListener("input", () => running || go({}));
for (const part of document.querySelectorAll("details")) part.addEventListener("toggle", () => running || machines.length === 0 || go({}));

at("pixel-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const { renderer, x, y } = at("pixel-form").elements;
  pixel = [renderer, x, y].map((field) => Number(field.value));
  if (!running) go({});
});

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  const before = { settings, beside };
  settings = fromForm();
  beside = form.elements.beside.value;
  if (await build()) return remember();
  // The previous machines stay, and the form keeps the refused settings.
  ({ settings, beside } = before);
  mark();
});
form.addEventListener("input", mark);

function remember() {
  const address = addressOf(settings);
  history.replaceState(null, "", `#${address}`);
}

// The visitor's own head and files.

/** Angle in degrees by which a drag across the whole width of a picture turns the head. */
const WIDE = 60;

/** Lets the visitor turn a live head by a drag across a canvas. With another head, the drag is recorded. */
function record(canvas) {
  let recorder = null;
  let from = null;
  let before = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    recorder = new Recorder();
    from = event;
    before = live?.angles;
    takeInHand();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!recorder) return;
    const degrees = (pixels) => (pixels / canvas.clientWidth) * WIDE;
    const turned = [degrees(event.clientX - from.clientX), degrees(event.clientY - from.clientY)];
    if (live) return live.turn(...turned.map((angle, n) => before[n] + angle));
    recorder.turn(...turned);
    at("recorded").textContent = `Recording: ${recorder.angles.length} samples`;
  });
  const end = () => {
    if (!live && recorder && recorder.angles.length > 3) follow(recorder);
    recorder = null;
  };
  canvas.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [2, 0], ArrowRight: [-2, 0], ArrowUp: [0, 2], ArrowDown: [0, -2] }[event.key];
    if (!turn || !live) return;
    event.preventDefault();
    event.stopPropagation();
    takeInHand();
    live.turn(...turn.map((angle, n) => live.angles[n] + angle));
  });
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
}

/** Lets a paused story run again, because the visitor moves the head. */
function takeInHand() {
  document.body.classList.add("dragged");
  if (!live || running || mode === "lab") return;
  slowDown(1);
  run();
}

async function follow(recorder) {
  motion = recorder.text();
  settings = { ...settings, "head.motion": RECORDED };
  settings["head.tracker"] ??= form.elements["head.tracker"].value || "optical";
  settings["head.predict"] ??= form.elements["head.predict"].value || "none";
  intoForm();
  at("recorded").textContent = `Recorded ${(recorder.angles.length / 60).toFixed(1)} s. The machine replays this motion.`;
  if (await build()) {
    remember();
    run();
  }
}

// A phone or tablet that is turned, and a headset.

/** The sensor that moves the head now; null without one. */
let sensor = null;
/** The headset that moves the head and shows the pictures now; null without one. */
let headset = null;

/** Builds the machines with a head that the visitor moves, both eyes, at the speed of the machine. */
async function becomeLive() {
  if (mode !== "lab") await toLab();
  slowDown(1);
  settings = { ...settings, "head.motion": LIVE, "head.tracker": settings["head.tracker"] || "fastrak" };
  settings["head.predict"] = "none";
  return build(null, FIRST_PICTURE);
}

/** Turns the head with the orientation sensor. In a holder, both eyes fill the screen side by side. */
async function turnWithDevice(isHeld) {
  const why = await sensorRefused();
  if (why) return say(why);
  sensor?.stop();
  document.body.classList.add("turned");
  document.body.classList.toggle("held", isHeld);
  // The browser allows a full screen only in answer to the press of the button, so it comes first.
  if (isHeld) await holdScreen();
  sensor = new Sensor((orientation) => live?.pose([0, 0, 0], orientation), isHeld);
  const mine = sensor;
  if (!(live && mode === "lab") && !(await becomeLive())) return leaveDevice();
  setTimeout(() => sensor === mine && !mine.reported && (leaveDevice(), say("This device reports no orientation.")), 3000);
  run();
}

async function holdScreen() {
  await document.documentElement.requestFullscreen?.().catch(() => {});
  await screen.orientation?.lock?.("landscape").catch(() => {});
}

function leaveDevice() {
  if (!sensor) return;
  sensor.stop();
  sensor = null;
  document.body.classList.remove("turned", "held");
  if (document.fullscreenElement === document.documentElement) document.exitFullscreen();
  pause();
}

if (window.DeviceOrientationEvent && matchMedia("(pointer: coarse)").matches) at("tilt").hidden = at("hold").hidden = false;
at("tilt").addEventListener("click", () => turnWithDevice(false));
at("hold").addEventListener("click", () => turnWithDevice(true));
for (const id of ["centre", "held-centre"]) at(id).addEventListener("click", () => sensor?.centre());
for (const id of ["off", "held-off"]) at(id).addEventListener("click", leaveDevice);
document.addEventListener("fullscreenchange", () => document.fullscreenElement || (document.body.classList.contains("held") && leaveDevice()));

hasHeadset().then((isThere) => (at("headset").hidden = !isThere));
at("headset").addEventListener("click", async () => {
  if (headset) return headset.leave();
  try {
    // The browser allows a session only in answer to the press of the button, so it comes first.
    const session = await navigator.xr.requestSession("immersive-vr");
    if (!(await becomeLive())) return session.end();
    headset = await Headset.enter({
      session,
      edges: await ask("edges"),
      fieldOfView: seenLast.machines[0].state.field_of_view_deg,
      pictures: () => machines[0].eyes.map(({ canvas }) => canvas),
      moved: (position, orientation) => live?.pose(position, orientation),
      ended() {
        headset = null;
        at("headset").textContent = "Enter VR";
        pause();
      },
    });
  } catch (error) {
    return say(`The headset cannot be used: ${error.message}`);
  }
  at("headset").textContent = "Leave VR";
  run();
});

// Latency that the visitor adds.

/** Simulated picoseconds after which every pipeline has shown a picture of the small scenes, without added latency. */
const FIRST_PICTURE = 300e9;

function showAdded() {
  at("added-says").textContent = `+${at("added").value} ms`;
  at("added").setAttribute("aria-valuetext", `${at("added").value} milliseconds`);
  at("added").disabled = !settings["head.motion"];
}

let addSoon = 0;
at("added").addEventListener("input", () => {
  showAdded();
  clearTimeout(addSoon);
  addSoon = setTimeout(addLatency, 200);
});

/** Builds the machines with the added latency. A head that the visitor moves stays where it is, and a run goes on. */
async function addLatency() {
  const wasRunning = running || mode === "story";
  settings = { ...settings, "head.added_latency": at("added").value };
  if (at("added").value === "0") delete settings["head.added_latency"];
  turns += 1;
  let kept = null;
  if (live) {
    kept = new Live(live.path);
    kept.now = live.now;
  }
  if (!(await build(kept, FIRST_PICTURE + Number(at("added").value) * 1e9))) return;
  if (mode === "lab") remember();
  if (wasRunning) run();
}

// Files of the visitor.

async function take(file) {
  if (!/\.(ply|obj|stl|pdb|ent|csv|txt|tum)$/i.test(file.name)) {
    return say(`${file.name} cannot be used: expected a model (.ply, .obj, .stl, .pdb, .ent) or a recorded head motion (.csv, .txt, .tum).`);
  }
  if (mode !== "lab") toLab();
  const before = { settings, dropped };
  at("dropped").textContent = `Reading ${file.name}, ${(file.size / 1e6).toFixed(1)} MB ...`;
  const isMotion = /\.(csv|txt|tum)$/i.test(file.name);
  const key = isMotion ? "head.motion" : "scene";
  const name = file.name.replaceAll(/\s+/g, "-");
  dropped = { ...dropped, [key]: { name, bytes: new Uint8Array(await file.arrayBuffer()) } };
  settings = { ...settings, [key]: name };
  if (!isMotion) delete settings.triangles;
  if (isMotion) settings["head.tracker"] ??= "optical";
  if (await build()) {
    intoForm();
    remember();
    at("dropped").textContent = `${name} is used as ${isMotion ? "the head's motion" : "the scene"}.`;
    // A machine shows its first picture only after some fields.
    if (still.matches) await go({ to: FIRST_PICTURE });
    else run();
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

addEventListener("keydown", (event) => {
  if (event.key === "Escape") at("hint").hidden = true;
  if (event.ctrlKey || event.altKey || event.metaKey || machines.length === 0) return;
  const target = event.target.closest?.("input, select, textarea, button, summary, a, pre, [role=group]");
  const isField = target?.matches("input:not([type=checkbox]), select, textarea, pre, [role=group]");
  const keys = { ArrowRight: forth, ArrowLeft: backwards, PageDown: forth, PageUp: backwards };
  const jump = mode === "story" && !isField && at("story-dots").children[Number(event.key) - 1];
  // On a button the space key presses that button.
  if (event.key === " " && !target) at("go").click();
  else if (jump) tell(telling.name, Number(event.key) - 1);
  else if (keys[event.key] && !isField && mode !== "start") keys[event.key]();
  else return;
  event.preventDefault();
});

function backwards() {
  if (mode === "story") at("story-back").click();
  else back();
}

function forth() {
  if (mode === "story") return at("story-next").click();
  pause();
  go({ step: "field" });
}

// Files to save.

const stamp = () => `pxpl5-${pipelines().join("-and-")}-${Math.round(reached / 1e9)}ms`;

at("save-picture").addEventListener("click", async () => save(await wholePicture(machines, eyesShown), `${stamp()}.png`));

/** Returns the report. A value that was not measured is null. */
function report() {
  return {
    machines: pipelines().map((name, n) => {
      const { state, age, latencies, surfaces } = seenLast.machines[n];
      return {
        settings: settingsOf(name),
        time_ms: state.now_ps / 1e9,
        field: state.field,
        trace_hash: state.trace_hash,
        config_hash: state.config_hash,
        failure: state.failure,
        shown_picture: age,
        latency_parts_ms: latencies,
        difference_from_ideal: surfaces.map((surface, eye) => ({ eye: state.surfaces[eye].label, ...(surface.difference ?? { differing_percent: null, mean_percent: null }) })),
      };
    }),
    command: at("command").textContent.split("\n"),
    link: at("link").href,
  };
}

at("save-report").addEventListener("click", async () => {
  pause();
  await go({});
  save(new Blob([JSON.stringify(report(), null, 2)], { type: "application/json" }), `${stamp()}.json`);
});

at("save-timeline").addEventListener("click", async () => {
  pause();
  at("timeline-part").open = true;
  await go({});
  save(new Blob([lastTimeline], { type: "image/svg+xml" }), `${stamp()}-timeline.svg`);
});

at("copy").addEventListener("click", async () => {
  try {
    await navigator.clipboard.writeText(at("link").href);
    at("copied").textContent = "Copied.";
  } catch {
    at("copied").textContent = "The browser does not allow this page to copy. Use the menu of the link.";
  }
});

/** Starts the second worker for the volume, and returns a function that sends requests to this worker. */
async function volumeWorker() {
  // This ends a search for the number of primitives. The search starts again at the next update.
  if (heavy && !heavy.found) heavy = null;
  return buildAside({ ...source, runs: source.runs.slice(0, 1) });
}
spinningScreen({ volumeWorker, refused });

// Stories.

/** The current story and its step. */
let telling = null;
/** Number of starts and ends of steps. A step whose number differs is not the present step any more. */
let turns = 0;
/** Number of events for which stories have waited. */
let watches = 0;

const slowDown = (times) => {
  at("slower").value = Math.log10(times);
  at("factor").textContent = Math.round(slowness()).toLocaleString("en");
};

/** Moves the head along a path that begins now. The head approaches the path gradually from its present direction. */
function move(path) {
  if (!live || !path) return;
  const [from, base] = [live.samples.length / 60, live.angles];
  live.path = (seconds) => path(seconds - from).map((way, n) => way + (base[n] ?? 0) * Math.exp(-2 * (seconds - from)));
}

/** Runs a step to its end, at the speed of the step or as fast as possible. */
async function perform(tale, number, isFast) {
  const step = tale.steps[number];
  move(step.path);
  slowDown(step.slower ?? 1);
  const end = reached + inPs(step.ms);
  watches += 1;
  const stop = step.until ? { what: step.until, value: step.value, key: watches } : null;
  const later = inPs(step.then ?? 0);
  if (!isFast) {
    if (!(await run({ end, stop }))) return false;
    if (step.thenSlower) slowDown(step.thenSlower);
    return later > 0 ? run({ end: reached + later }) : true;
  }
  if (step.hand) return true;
  await go(stop ? { to: end, stop: { ...stop, piece: 20e6 } } : { to: end });
  if (later > 0) await go({ to: reached + later });
  return true;
}

/** Builds the machines of a story and runs them to the start of a step. */
async function prepare(tale, number) {
  settings = { ...tale.settings };
  beside = tale.beside ?? "";
  eyesShown = tale.eyes ?? 2;
  at("added").value = 0;
  showAdded();
  show = new Set(tale.steps[number].show);
  if (!(await build())) return false;
  if (tale.begin) await go({ to: inPs(tale.begin) });
  for (let before = 0; before < number; before += 1) {
    await perform(tale, before, true);
  }
  return true;
}

/** Returns true if the machine has been loaded. */
const isReady = () => document.documentElement.dataset.ready === "true";

async function tell(name, number, isNext = false) {
  if (!isReady()) return;
  turns += 1;
  const mine = turns;
  const tale = STORIES[name];
  const step = tale.steps[number];
  mode = "story";
  telling = { name, step: number };
  document.documentElement.dataset.story = `${name} ${number + 1} begun`;
  pause();
  at("story-name").textContent = tale.name;
  at("story-step").textContent = `${number + 1} of ${tale.steps.length}`;
  at("story-title").textContent = step.title;
  at("story-say").textContent = step.say;
  at("story-paused").textContent = "";
  at("story-back").disabled = number === 0;
  at("story-next").textContent = number + 1 < tale.steps.length ? "Next" : "To the laboratory";
  at("story-dots").replaceChildren(...tale.steps.map(({ title }, n) => {
    const link = Object.assign(document.createElement("a"), { href: keepLecture(`#story=${name}&step=${n + 1}`), textContent: n + 1, title });
    link.setAttribute("aria-label", `Step ${n + 1}: ${title}`);
    if (n === number) link.setAttribute("aria-current", "step");
    const item = document.createElement("li");
    item.append(link);
    return item;
  }));
  at("story-keep").textContent = "";
  history.replaceState(null, "", keepLecture(`#story=${name}&step=${number + 1}`));
  show = new Set(step.show);
  layOutParts();
  // The next step goes on with the same machines, unless the visitor has added latency.
  if (isNext && !settings["head.added_latency"]) await piece;
  else if (!(await prepare(tale, number))) return;
  if (mine !== turns) return;
  // A number to keep comes from the run itself, before the head is handed over.
  if (step.keep && step.hand) at("story-keep").textContent = step.keep(seenLast.machines) ?? "";
  const isThere = await perform(tale, number, still.matches);
  if (!isThere || mine !== turns) return;
  await go({});
  if (step.keep) at("story-keep").textContent = step.keep(seenLast.machines) ?? "";
  at("story-paused").textContent = step.paused;
  document.documentElement.dataset.story = `${name} ${number + 1} paused`;
}

function toLab() {
  if (!isReady()) return null;
  turns += 1;
  const wasStart = mode === "start";
  mode = "lab";
  telling = null;
  eyesShown = 2;
  if (live) live.path = null;
  slowDown(1);
  machines.forEach(({ section }) => (section.dataset.eyes = eyesShown));
  if (wasStart) pause();
  intoForm();
  layOutParts();
  remember();
  pause();
  return go({});
}

async function toStart() {
  if (!isReady()) return;
  turns += 1;
  mode = "start";
  telling = null;
  show = new Set(FIRST_SCREEN.show);
  eyesShown = 1;
  settings = { ...FIRST_SCREEN.settings };
  beside = "";
  layOutParts();
  slowDown(1);
  if (!(await build(new Live(FIRST_SCREEN.path), inPs(FIRST_SCREEN.begin)))) return;
  if (still.matches) return go({ to: inPs(900) });
  first();
}

/** Runs the picture of the first screen. After a minute, the run begins again. */
async function first() {
  const mine = turns;
  await run();
  if (mode !== "start" || mine !== turns || !seenLast?.machines[0].state.over) return;
  toStart();
}

for (const button of document.querySelectorAll("[data-story]")) {
  button.addEventListener("click", async () => {
    await tell(button.dataset.story, 0);
  });
}
at("story-next").addEventListener("click", () => {
  if (!telling) return;
  const { name, step } = telling;
  if (step + 1 < STORIES[name].steps.length) tell(name, step + 1, true);
  else toLab();
});
at("story-back").addEventListener("click", () => telling && telling.step > 0 && tell(telling.name, telling.step - 1));
at("story-again").addEventListener("click", () => telling && tell(telling.name, telling.step));
for (const id of ["to-lab", "to-lab-too"]) at(id).addEventListener("click", toLab);
at("to-start").addEventListener("click", () => {
  history.replaceState(null, "", location.pathname);
  toStart();
});

async function open() {
  const given = new URLSearchParams(location.hash.slice(1));
  const story = storyOf(given);
  if (story) return tell(story.name, story.step);
  if ([...given.keys()].length === 0) {
    fromAddress();
    return toStart();
  }
  mode = "lab";
  turns += 1;
  telling = null;
  eyesShown = 2;
  slowDown(1);
  settings = fromAddress();
  intoForm();
  layOutParts();
  if (!(await build())) return;
  const instant = Number(given.get("at"));
  if (instant > 0) await go({ to: instant });
}

try {
  const { catalog, glossary } = await startWorker();
  const none = { name: "", label: "none" };
  choices("pipeline", catalog.pipelines);
  choices("beside", [none, ...catalog.pipelines]);
  choices("scene", catalog.scenes);
  choices("display", catalog.displays.map((name) => ({ name })));
  choices("head.motion", catalog.motions.map((one) => ({ ...one, label: MOTION_NAMES[one.name] ?? one.name })));
  choices("head.tracker", [{ name: "", label: "usual" }, ...catalog.trackers.map((name) => ({ name }))]);
  choices("head.predict", [{ name: "", label: "usual" }, ...catalog.predictors.map((name) => ({ name }))]);
  choices("level", [{ name: "", label: "transaction" }, { name: "cycle", about: glossary["cycle level"] }]);
  explain(glossary);
  at("loading").hidden = true;
  document.documentElement.dataset.ready = "true";
  lecture();
  addEventListener("hashchange", open);
  await open();
} catch (error) {
  cannotStart(error.message);
}
