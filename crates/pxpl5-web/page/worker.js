// The machines, apart from the page, so that it stays awake: one request after the other, each answered by what there is to see.
import { Checkpoints } from "./checkpoints.js";
import init, { Files, WebMachine, catalog, glossary } from "./pxpl5_web.js";

/** Milliseconds that a piece of a run may take before the page is told. */
const PATIENCE = 40;

let wasm = null;
let machines = [];
let volume = null;
let checkpoints = null;

/** Milliseconds of computing since the last checkpoint. */
let worked = 0;

/** Takes a checkpoint if one is due; `note` comes back with it. */
function checkpoint(note) {
  if (checkpoints.take(Math.max(...machines.map((machine) => machine.now())), note, worked)) worked = 0;
}

const OPERATIONS = {
  async open() {
    if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly");
    wasm = await init({ module_or_path: await load(new URL("pxpl5_web_bg.wasm", import.meta.url)) });
    checkpoints = new Checkpoints(wasm.memory);
    return { catalog: JSON.parse(catalog()), glossary: JSON.parse(glossary()) };
  },
  /** Builds a machine for each of some settings; where one of them is refused, the machines before stay. */
  build({ runs, files }) {
    const held = new Files();
    files.forEach(([name, bytes]) => held.add(name, bytes));
    const built = [];
    try {
      runs.forEach((settings) => built.push(new WebMachine(settings, held)));
    } catch (error) {
      built.forEach((machine) => machine.free());
      throw error;
    } finally {
      held.free();
    }
    machines.forEach((machine) => machine.free());
    machines = built;
    volume?.free();
    volume = null;
    checkpoints.clear();
    return null;
  },
  /** Puts the machines back to the last checkpoint at or before an instant. Returns its instant and note, or null without one. */
  back({ to }) {
    watched = { key: null, happened: null };
    worked = 0;
    return checkpoints.back(to);
  },
  /** Goes on to an instant, as far as it comes in time, or by a step, and looks. With `stop` it ends where that happens. `note` is kept
   *  with a checkpoint on the way. */
  go({ by, to, step, stop, rows, want, note }) {
    if (rows) machines.forEach((machine) => machine.moved(rows));
    checkpoint(note);
    if (stop) {
      const end = to ?? machines[0].now() + by;
      const stopped = seek(stop, end);
      return { ...look(want), stopped };
    }
    if (step) machines.forEach((machine) => machine.step(step));
    const goal = to ?? (by ? Math.min(...machines.map((machine) => machine.now())) + by : 0);
    const begun = performance.now();
    const from = machines.map((machine) => machine.now());
    const patience = to === undefined ? PATIENCE : Infinity;
    for (let part = 1; part <= 8 && performance.now() - begun < patience; part += 1) {
      const before = performance.now();
      machines.forEach((machine, n) => machine.run_to(Math.round(from[n] + ((goal - from[n]) * part) / 8)));
      worked += performance.now() - before;
      checkpoint(note);
    }
    return look(want);
  },
  /** Primitives of a machine's scene, and how many of them would be shown in time. */
  fitting: ({ of }) => JSON.parse(machines[of].fitting()),
  volume() {
    volume?.free();
    volume = machines[0].volume();
    return [...volume.size()];
  },
  slice: ({ number }) => volume.slice(number),
  round: ({ azimuth, elevation, side }) => volume.seen(azimuth, elevation, side),
};

/** Bytes of a file; the page is told what share of them has come. */
async function load(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.pathname.split("/").at(-1)} cannot be loaded (${response.status} ${response.statusText})`);
  // A compressed file does not say how long it becomes.
  const all = response.headers.get("content-encoding") ? 0 : Number(response.headers.get("content-length") ?? 0);
  const reader = response.body.getReader();
  const parts = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    length += value.length;
    postMessage({ loaded: length, all });
  }
  return new Blob(parts).arrayBuffer();
}

const ends = (from, to) => (machine) => JSON.parse(machine.channels()).some((message) => message && from.test(message.from) && to.test(message.to));
const staged = (stage) => (machine) => JSON.parse(machine.boards()).some((board) => board.kind === "processor" && board.name !== "host" && board.stage === stage && board.works);
const GP = /^GP/;

const copies = (machine) => JSON.parse(machine.regions()).some((region) => region.stage === "copy" && region.surface === 0);

/** What a story can wait for: given what was before, a function that says whether it has happened. */
const HAPPENINGS = {
  pose: () => ends(/^host/, GP),
  transform: () => staged("transform"),
  /** Renderers draw some regions of the first eye, and execute commands for one of them. */
  draw: () => (machine) => {
    const drawn = JSON.parse(machine.regions()).filter((region) => region.stage === "render" && region.surface === 0);
    return drawn.length >= 3 && drawn.some((region) => region.works);
  },
  /** A region of the first eye is on its way. */
  copy: () => copies,
  swap(machine) {
    const before = JSON.parse(machine.age())?.picture;
    return () => {
      const picture = JSON.parse(machine.age())?.picture;
      return picture !== undefined && picture !== before;
    };
  },
  /** The beam comes to a line of a later field than the present one. */
  line(machine, line) {
    const before = JSON.parse(machine.state()).field;
    return () => {
      const state = JSON.parse(machine.state());
      return state.field > before && (state.line ?? -1) >= line;
    };
  },
  /** The same, while a region or a strip of the first eye is on its way. */
  strip(machine, line) {
    const isThere = HAPPENINGS.line(machine, line);
    return () => isThere() && copies(machine);
  },
};
let watched = { key: null, happened: null };

/** Runs in small pieces until something happens in the first machine, at most to an instant; says whether it has happened. */
function seek({ what, value, key, piece }, end) {
  const machine = machines[0];
  // What was before is remembered from the first call for a step on.
  if (watched.key !== key) watched = { key, happened: HAPPENINGS[what](machine, value) };
  while (machine.now() < end) {
    const before = machine.now();
    machines.forEach((each) => each.run_to(Math.min(end, before + piece)));
    if (watched.happened(machine)) return true;
    if (machine.now() === before) return false;
  }
  return false;
}

/** What is wanted of the machines; boards, timeline and latency of one of them. */
function look(want) {
  // On the way to an instant nobody looks.
  if (!want) return { machines: machines.map((machine) => ({ state: JSON.parse(machine.state()) })), blind: true };
  const seen = machines.map((machine, n) => {
    const state = JSON.parse(machine.state());
    const surfaces = state.surfaces.map((_, surface) => ({
      seen: surface < (want.surfaces ?? Infinity) ? machine.seen(surface) : null,
      wire: want.wire && n === 0 && surface < (want.surfaces ?? Infinity) ? machine.outlines(surface) : null,
      ideal: want.ideal ? machine.ideal(surface) : null,
      heat: want.error ? machine.heat(surface) : null,
      difference: want.error ? JSON.parse(machine.difference(surface)) : null,
    }));
    return { state, surfaces, age: want.age ? JSON.parse(machine.age()) : undefined, missesAll: want.age ? machine.misses_all() : undefined, regions: want.regions ? JSON.parse(machine.regions()) : null, latencies: want.latencies ? JSON.parse(machine.latencies(want.latencies)) : null, limits: want.limits ? JSON.parse(machine.limits()) : null };
  });
  const machine = machines[want.of ?? 0] ?? machines[0];
  const boards = want.boards ? JSON.parse(machine.boards()) : null;
  const renderers = want.renderers ? boards.filter((board) => board.kind === "renderer") : [];
  return {
    machines: seen,
    bytes: wasm.memory.buffer.byteLength,
    boards,
    messages: want.messages === undefined ? null : JSON.parse(machine.messages(want.messages, 12)),
    channels: want.boards ? JSON.parse(machine.channels()) : null,
    renderers: want.renderers ? renderers.map((_, number) => machine.renderer(number)) : null,
    board: want.board ? machine.board(want.board) : null,
    pixel: want.pixel ? machine.pixel(...want.pixel) : null,
    timeline: want.timeline ? machine.timeline(want.timeline) : null,
    faces: want.faces === undefined ? null : [0, 1].map((eye) => (eye < (want.surfaces ?? 2) ? machine.faces(eye, want.faces ?? undefined) : new Uint8Array())),
  };
}

/** Buffers that are handed over instead of copied. */
function buffers(value, found = []) {
  if (value instanceof Uint8Array) found.push(value.buffer);
  else if (value && typeof value === "object") Object.values(value).forEach((inner) => buffers(inner, found));
  return found;
}

onmessage = async ({ data: { id, operation, given } }) => {
  try {
    const value = await OPERATIONS[operation](given ?? {});
    postMessage({ id, value }, buffers(value));
  } catch (error) {
    postMessage({ id, error: error.message ?? String(error), broken: error instanceof WebAssembly.RuntimeError });
  }
};
