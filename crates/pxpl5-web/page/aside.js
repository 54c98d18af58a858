// A second worker with its own machines, for long work. The run continues at the same time, and checkpoints of the run do not contain
// the memory of this worker.

let worker = null;
let asked = new Map();
let numbers = 0;

function ask(operation, given) {
  numbers += 1;
  worker.postMessage({ id: numbers, operation, given });
  return new Promise((done, failed) => asked.set(numbers, { done, failed }));
}

function fail(message) {
  asked.forEach(({ failed }) => failed(new Error(message)));
  asked = new Map();
}

/** Ends the worker. Requests without an answer fail. */
export function endAside() {
  worker?.terminate();
  worker = null;
  fail("other machines were built meanwhile");
}

/** Builds machines in a new worker. `runs` and `files` are as in the request `build` of worker.js. Returns a function that sends
 *  requests to this worker. */
export async function buildAside({ runs, files }) {
  endAside();
  worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  const mine = worker;
  mine.onerror = (event) => mine === worker && fail(event.message || "the second worker of this page does not start");
  mine.onmessage = ({ data }) => {
    const request = asked.get(data.id);
    if (mine !== worker || !request) return;
    asked.delete(data.id);
    if (data.error === undefined) request.done(data.value);
    else request.failed(Object.assign(new Error(data.error), { broken: false }));
  };
  await ask("open");
  await ask("build", { runs, files });
  return ask;
}
