// The machines, apart from the page, so that it stays awake: one request after the other, each answered by what there is to see.
import init, { Files, WebMachine, catalog, glossary } from "./pxpl5_web.js";

/** Milliseconds that a piece of a run may take before the page is told. */
const PATIENCE = 40;

let wasm = null;
let machines = [];
let volume = null;

const OPERATIONS = {
  async open() {
    wasm = await init({ module_or_path: new URL("pxpl5_web_bg.wasm", import.meta.url) });
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
    return null;
  },
  /** Goes on to an instant, as far as it comes in time, or by a step, and looks. */
  go({ by, to, step, rows, want }) {
    if (rows) machines.forEach((machine) => machine.moved(rows));
    if (step) machines.forEach((machine) => machine.step(step));
    const goal = to ?? (by ? Math.min(...machines.map((machine) => machine.now())) + by : 0);
    const begun = performance.now();
    const from = machines.map((machine) => machine.now());
    const patience = to === undefined ? PATIENCE : Infinity;
    for (let part = 1; part <= 8 && performance.now() - begun < patience; part += 1) {
      machines.forEach((machine, n) => machine.run_to(Math.round(from[n] + ((goal - from[n]) * part) / 8)));
    }
    return look(want);
  },
  volume() {
    volume?.free();
    volume = machines[0].volume();
    return [...volume.size()];
  },
  slice: ({ number }) => volume.slice(number),
  round: ({ azimuth, elevation, side }) => volume.seen(azimuth, elevation, side),
};

/** What is wanted of the machines; boards, timeline and latency of one of them. */
function look(want) {
  const seen = machines.map((machine) => {
    const state = JSON.parse(machine.state());
    const surfaces = state.surfaces.map((_, surface) => ({
      seen: machine.seen(surface),
      ideal: want.ideal ? machine.ideal(surface) : null,
      heat: want.error ? machine.heat(surface) : null,
      difference: want.error ? JSON.parse(machine.difference(surface)) : null,
    }));
    return { state, surfaces, latencies: want.latencies ? JSON.parse(machine.latencies(want.latencies)) : null };
  });
  const machine = machines[want.of ?? 0] ?? machines[0];
  const boards = want.boards ? JSON.parse(machine.boards()) : null;
  const renderers = want.renderers ? boards.filter((board) => board.kind === "renderer") : [];
  return {
    machines: seen,
    bytes: wasm.memory.buffer.byteLength,
    boards,
    channels: want.boards ? JSON.parse(machine.channels()) : null,
    renderers: want.renderers ? renderers.map((_, number) => machine.renderer(number)) : null,
    board: want.board ? machine.board(want.board) : null,
    pixel: want.pixel ? machine.pixel(...want.pixel) : null,
    timeline: want.timeline ? machine.timeline(want.timeline) : null,
    faces: want.faces === undefined ? null : [0, 1].map((eye) => machine.faces(eye, want.faces)),
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
