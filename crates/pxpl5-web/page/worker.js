// The worker with the machines. The page stays responsive, because the machines run in this thread. The worker handles one request after
// the other, and answers most requests with data for the page.
import { Checkpoints } from "./checkpoints.js";
import init, { Files, WebMachine, catalog, glossary } from "./pxpl5_web.js";

/** Maximum milliseconds of computing for one piece of a run, before the worker answers. */
const PATIENCE = 40;

let wasm = null;
let machines = [];
let volume = null;
let checkpoints = null;

/** Milliseconds of computing since the last checkpoint. */
let worked = 0;

/** Takes a checkpoint if a checkpoint is due. The request `back` returns the `note`. */
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
  /** Builds a machine for each text of settings. If one text has an error, the previous machines stay. */
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
  /** Restores the machines from the last checkpoint at or before an instant. Returns the instant and the note of the checkpoint, or null. */
  back({ to }) {
    watched = { key: null, happened: null };
    worked = 0;
    return checkpoints.back(to);
  },
  /** Runs the machines to an instant (`to`), by a time (`by`) or by a step (`step`), and returns data for the page. A run by a time can
   *  end earlier, because its computing time is limited. With `stop`, the run ends at this event. Checkpoints of the run get the `note`. */
  go({ by, to, step, stop, rows, want, note }) {
    if (rows) machines.forEach((machine) => machine.moved(rows));
    checkpoint(note);
    const busy = want?.busy ? machines.map(() => []) : null;
    const sample = () => busy?.forEach((samples, n) => samples.push([machines[n].now(), machines[n].busy()]));
    sample();
    if (stop) {
      const end = to ?? machines[0].now() + by;
      const stopped = seek(stop, end);
      sample();
      return { ...snapshot(want), stopped, busy };
    }
    if (step) machines.forEach((machine) => machine.step(step));
    const goal = to ?? (by ? Math.min(...machines.map((machine) => machine.now())) + by : 0);
    const begun = performance.now();
    const from = machines.map((machine) => machine.now());
    const patience = to === undefined ? PATIENCE : Infinity;
    // Samples of busy boards are at most 2.1 ms of simulated time apart, unless the page runs to an instant.
    const parts = busy ? 32 : 8;
    for (let part = 1; part <= parts && performance.now() - begun < patience; part += 1) {
      const before = performance.now();
      machines.forEach((machine, n) => machine.run_to(Math.round(from[n] + ((goal - from[n]) * part) / parts)));
      worked += performance.now() - before;
      checkpoint(note);
      sample();
    }
    sample();
    return { ...snapshot(want), busy };
  },
  edges: () => machines[0].edges(),
  /** Returns the number of primitives in a machine's scene, and the number that the machine could show in time. */
  fitting: ({ of }) => JSON.parse(machines[of].fitting()),
  volume() {
    volume?.free();
    volume = machines[0].volume();
    return [...volume.size()];
  },
  slice: ({ number }) => volume.slice(number),
  round: ({ azimuth, elevation, side }) => volume.seen(azimuth, elevation, side),
};

/** Loads the bytes of a file, and reports the progress to the page. */
async function load(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.pathname.split("/").at(-1)} cannot be loaded (${response.status} ${response.statusText})`);
  // The length of an uncompressed file is unknown if the server compresses the file.
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
const staged = (stage) => (machine) => JSON.parse(machine.boards()).some((board) => board.kind === "processor" && board.name !== "host" && board.stages.includes(stage) && board.works);
const GP = /^GP/;

const copies = (machine) => JSON.parse(machine.regions()).some((region) => region.stage === "copy" && region.surface === 0);

/** Events that a story can wait for. Each entry returns a function that returns true after the event. */
const HAPPENINGS = {
  pose: () => ends(/^host/, GP),
  transform: () => staged("transform"),
  /** Renderers draw at least three regions of the first eye, and one renderer executes commands while it copies another region. */
  draw: () => (machine) => {
    const drawn = JSON.parse(machine.regions()).filter((region) => region.stage === "render" && region.surface === 0);
    if (drawn.length < 3 || !drawn.some((region) => region.works)) return false;
    return JSON.parse(machine.boards()).some((board) => board.kind === "renderer" && board.stages.length === 2);
  },
  /** A region of the first eye is copied. */
  copy: () => copies,
  swap(machine) {
    const before = JSON.parse(machine.age())?.picture;
    return () => {
      const picture = JSON.parse(machine.age())?.picture;
      return picture !== undefined && picture !== before;
    };
  },
  /** The beam reaches a line in a later field than the present field. */
  line(machine, line) {
    const before = JSON.parse(machine.state()).field;
    return () => {
      const state = JSON.parse(machine.state());
      return state.field > before && (state.line ?? -1) >= line;
    };
  },
  /** The beam has reached a line in a later field, and a region or strip of the first eye is copied. */
  strip(machine, line) {
    const isThere = HAPPENINGS.line(machine, line);
    return () => isThere() && copies(machine);
  },
};
let watched = { key: null, happened: null };

/** Runs in small pieces to an event in the first machine, at most to the instant `end`. Returns true if the event has happened. */
function seek({ what, value, key, piece }, end) {
  const machine = machines[0];
  // The state before the event is stored at the first call for a step.
  if (watched.key !== key) watched = { key, happened: HAPPENINGS[what](machine, value) };
  while (machine.now() < end) {
    const before = machine.now();
    machines.forEach((each) => each.run_to(Math.min(end, before + piece)));
    if (watched.happened(machine)) return true;
    if (machine.now() === before) return false;
  }
  return false;
}

/** Returns the requested data of all machines, and boards and timeline of one machine. */
function snapshot(want) {
  // On the way to an instant, the page needs only the states.
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
    return { state, surfaces, age: want.age ? JSON.parse(machine.age()) : undefined, offset: want.age ? JSON.parse(machine.misregistration()) : undefined, missesAll: want.age ? machine.misses_all() : undefined, regions: want.regions ? JSON.parse(machine.regions()) : null, latencies: want.latencies ? JSON.parse(machine.latencies(want.latencies)) : null, limits: want.limits ? JSON.parse(machine.limits()) : null };
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

/** Returns the buffers that are transferred to the page instead of copied. */
function buffers(value, found = []) {
  if (ArrayBuffer.isView(value)) found.push(value.buffer);
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
