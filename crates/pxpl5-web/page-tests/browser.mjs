// A headless Chromium with the page, driven by chromedriver, and what tests do with it.
import { spawn, spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { extname, join, normalize, resolve } from "node:path";
import assert from "node:assert/strict";
import { STORIES } from "../page/stories.js";

export const [site, pictures, only] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
export const MODELS = { ply: triangle(), obj: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", pdb: "ATOM      1  C   ALA A   1       0.000   0.000   0.000\nATOM      2  O   ALA A   1       1.200   0.000   0.000\n", broken: "ply\nformat ascii 1.0\nelement vertex x\n" };
export const KINDS = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".png": "image/png" };
/** How the server answers for the machine: `well`, `missing`, or `slow`, with each of ten parts after 150 ms. */
let answers = "well";
export const answer = (how) => (answers = how);
export const server = createServer(async (request, response) => {
  const path = normalize(new URL(request.url, "http://x").pathname);
  if (path.endsWith(".wasm") && answers === "missing") return response.writeHead(404).end();
  try {
    const name = path.endsWith("/") ? `${path}index.html` : path;
    const bytes = readFileSync(join(site, name));
    response.writeHead(200, { "content-type": KINDS[extname(name)] ?? "application/octet-stream", "content-length": bytes.length, "cache-control": "no-store" });
    if (name.endsWith(".wasm") && answers === "slow") {
      for (let part = 0; part < 10; part += 1) {
        response.write(bytes.subarray(Math.floor((part * bytes.length) / 10), Math.floor(((part + 1) * bytes.length) / 10)));
        await new Promise((later) => setTimeout(later, 150));
      }
      return response.end();
    }
    response.end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
export const page = `http://127.0.0.1:${server.address().port}/live/`;

export const port = 20000 + Math.floor(Math.random() * 20000);
export const driver = spawn("chromedriver", [`--port=${port}`], { stdio: "ignore" });
export const base = `http://127.0.0.1:${port}`;

export async function ask(method, path, body) {
  const response = await fetch(base + path, { method, body: body && JSON.stringify(body) });
  const { value } = await response.json();
  if (value?.error) throw new Error(`${path}: ${value.message}`);
  return value;
}

export async function driverIsReady() {
  for (let tries = 0; tries < 100; tries += 1) {
    try {
      return await ask("GET", "/status");
    } catch {
      await new Promise((later) => setTimeout(later, 100));
    }
  }
  throw new Error("chromedriver does not answer");
}

await driverIsReady();
export const args = ["--headless=new", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--no-first-run", "--disable-quic", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
export const wanted = { capabilities: { alwaysMatch: { "goog:chromeOptions": { args }, "goog:loggingPrefs": { browser: "ALL" } } } };
const { sessionId } = await ask("POST", "/session", wanted);
export const session = `/session/${sessionId}`;
export const run = (script, ...values) => ask("POST", `${session}/execute/sync`, { script, args: values });
export const later = (ms) => new Promise((done) => setTimeout(done, ms));

export async function until(what, script, ms = 20000) {
  const begun = Date.now();
  while (Date.now() - begun < ms) {
    if (await run(`return ${script}`)) return Date.now() - begun;
    await later(50);
  }
  throw new Error(`waited ${ms} ms for ${what}`);
}

/** Until the simulated time is some milliseconds later than now, however fast this computer is. */
export async function advanced(ms) {
  const from = await shownMs();
  return until(`${ms} ms more`, `Number(document.getElementById('time').dataset.ps) / 1e9 >= ${from + ms}`, 120000);
}

/** Until the worker has answered all that was asked of it. */
export const settled = (ms) => until("the worker", "document.documentElement.dataset.asked === '0' && document.documentElement.dataset.ready === 'true'", ms);

export async function open(hash = "", ms = 60000) {
  await ask("POST", `${session}/url`, { url: "about:blank" });
  const begun = Date.now();
  await ask("POST", `${session}/url`, { url: page + hash });
  // A page that runs by itself has an open request at almost any time.
  await until("the machine", "document.documentElement.dataset.ready === 'true' && (document.documentElement.dataset.asked === '0' || document.getElementById('go').textContent === 'Pause')", ms);
  return Date.now() - begun;
}

export const text = (id) => run(`return document.getElementById('${id}').textContent`);
export async function click(selector) {
  await run(`document.querySelector(${JSON.stringify(selector)}).click()`);
}
export async function press(selector) {
  await click(selector);
  await settled();
}
export const set = (id, value) => run(`const s = document.getElementById('${id}'); s.value = ${value}; s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change'))`);
/** Colours other than black in a canvas. */
export const COLOURS = `(canvas) => {
  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
  colours.delete(0);
  return colours.size;
}`;
export const lit = (selector = "#eyes canvas") => run(`return (${COLOURS})(document.querySelector('${selector}'))`);

/** A file as if somebody had dropped it onto the page. */
export const drop = (name, contents) => run(`
  const data = new DataTransfer();
  data.items.add(new File([${JSON.stringify(contents)}], '${name}'));
  dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }))`);

/** A drag of 60 pixels to the right across the first picture, in half a second, or with `between` awaited after each of twelve parts. */
export async function drag(between) {
  await run("document.querySelector('#eyes canvas').scrollIntoView({ block: 'center' })");
  const box = await run("const b = document.querySelector('#eyes canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]");
  const [x, y] = [Math.round(box[0] + box[2] / 2), Math.round(box[1] + box[3] / 2)];
  const moves = Array.from({ length: 12 }, (_, n) => ({ type: "pointerMove", duration: 40, x: x + 5 * (n + 1), y }));
  const act = (...actions) => ask("POST", `${session}/actions`, { actions: [{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }] });
  const [down, up] = [[{ type: "pointerMove", duration: 0, x, y }, { type: "pointerDown", button: 0 }], { type: "pointerUp", button: 0 }];
  if (!between) return act(...down, ...moves, up);
  await act(...down);
  for (const move of moves) {
    await act(move);
    await between();
  }
  return act(up);
}

/** The link of what was recorded finds the same hash on the page, and its command the same. */
export async function recordedAgain() {
  const link = await run("return document.getElementById('link').hash");
  assert.match(link, /motion=/);
  await until("the recorded file", "document.querySelector('#needs a') !== null");
  const recording = await run("return fetch(document.querySelector('#needs a').href).then((file) => file.text())");
  const folder = resolve(pictures);
  writeFileSync(join(folder, "recorded.csv"), recording);
  await sameHash(folder);
  const hash = await text("hash");
  await open(link);
  assert.equal(await text("hash"), hash);
}

export function triangle() {
  const head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  return `${head}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n`;
}

/** Simulated time that the page shows, milliseconds. */
export const shownMs = async () => (await run("return Number(document.getElementById('time').dataset.ps)")) / 1e9;
export const emulate = (name, value) => ask("POST", `${session}/goog/cdp/execute`, { cmd: "Emulation.setEmulatedMedia", params: { features: [{ name, value }] } });
export const key = (value) => ask("POST", `${session}/actions`, { actions: [{ type: "key", id: "keys", actions: [{ type: "keyDown", value }, { type: "keyUp", value }] }] });
export const LEFT = "\uE012";
export const RIGHT = "\uE014";

/** What axe-core finds against WCAG 2.1 A and AA on the present page. */
async function axe() {
  await run(readFileSync(process.env.AXE, "utf8"));
  const { violations, passes } = await ask("POST", `${session}/execute/async`, {
    script: "const done = arguments[0]; axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }).then(done)", args: [],
  });
  assert.ok(passes.length > 5, `${passes.length} rules looked at something`);
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(" ")).slice(0, 4).join(", ")}`);
}

export async function accessible(what) {
  assert.deepEqual(await axe(), [], what);
}

/** Goes through a story; `look` is called at each step that has paused. */
export async function tell(name, look) {
  await open();
  await click(`[data-story=${name}]`);
  const { steps } = STORIES[name];
  for (const [n, step] of steps.entries()) {
    const begun = Date.now();
    if (step.hand) await later(1500);
    else await until(`step ${n + 1} of ${name}`, `document.documentElement.dataset.story === '${name} ${n + 1} paused'`, 60000);
    if (!step.hand) await settled();
    console.log(`   ${name} ${n + 1}: ${((Date.now() - begun) / 1000).toFixed(1)} s, stands at ${(await shownMs()).toFixed(1)} ms; ${await text("story-paused")}`);
    assert.equal(await text("error"), "");
    assert.equal(await text("story-say"), step.say);
    await look?.(n, step);
    await click("#story-next");
  }
}

export async function picture(name, width, height = 1400) {
  await ask("POST", `${session}/window/rect`, { width, height });
  await ask("POST", `${session}/goog/cdp/execute`, {
    cmd: "Emulation.setDeviceMetricsOverride",
    params: { width, height, deviceScaleFactor: 1, mobile: false },
  });
  const { data } = await ask("POST", `${session}/goog/cdp/execute`, {
    cmd: "Page.captureScreenshot", params: { captureBeyondViewport: true },
  });
  writeFileSync(join(pictures, `${name}.png`), Buffer.from(data, "base64"));
  const overflow = await run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
  assert.equal(overflow, 0, `nothing sticks out at ${width} pixels`);
}

/** What the command that the page names prints, or the reason for which it does not run. */
function outputOfTheCommand(command, folder) {
  const program = resolve(process.env.PXPL5 ?? "target/debug/pxpl5");
  const parts = command.split('"').flatMap((part, n) => (n % 2 ? [part] : part.trim().split(/\s+/).filter(Boolean)));
  const { stdout, stderr, error } = spawnSync(program, parts.slice(1), { encoding: "utf8", cwd: folder });
  assert.ok(!error, `${program}: ${error?.message}`);
  return stdout || stderr;
}

/** The command finds the hash that the page shows. */
export async function sameHash(folder) {
  const [hashes, commands] = [(await text("hash")).split(" "), (await text("command")).split("\n")];
  commands.forEach((command, n) => {
    const output = outputOfTheCommand(command, folder);
    const found = /^trace {3}(\S+)$/m.exec(output)?.[1] ?? `no hash: ${output}`;
    console.log(`   ${command}\n   trace ${found}`);
    assert.equal(found, hashes[n]);
  });
}

/** Pixels that differ between the first picture of the page and that of the command, which has other vector instructions. */
export async function otherPixels() {
  const folder = resolve(pictures);
  const output = outputOfTheCommand((await text("command")).replace("show time", "seen left seen.png"), folder);
  assert.match(output, /seen\.png/);
  const png = readFileSync(join(folder, "seen.png")).toString("base64");
  return ask("POST", `${session}/execute/async`, { args: [png], script: `const [png, done] = arguments;
    const shown = document.querySelector('#eyes canvas');
    const { width, height } = shown;
    const image = new Image();
    image.onload = () => {
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      canvas.getContext('2d').drawImage(image, 0, 0);
      const [one, other] = [shown, canvas].map((from) => new Uint32Array(from.getContext('2d').getImageData(0, 0, width, height).data.buffer));
      done([image.width === width && image.height === height, one.filter((pixel, n) => pixel !== other[n]).length]);
    };
    image.src = 'data:image/png;base64,' + png;` });
}

/** Runs for some seconds of the browser's clock, and returns simulated by real time. */
export async function speed(seconds) {
  const begun = await run("document.getElementById('go').click(); return [Number(document.getElementById('time').dataset.ps) / 1e9, performance.now()]");
  await later(seconds * 1000);
  const ended = await run("const end = performance.now(); document.getElementById('go').click(); return end");
  await settled();
  return ((await shownMs()) - begun[0]) / (ended - begun[1]);
}

/** Milliseconds in which a worker without a page loads the machine, builds a run, and simulates it to an instant. The page is left, because
 *  its machine is compiled already, and the browser would not compile it again. */
export async function alone(settings, recording, to) {
  await ask("POST", `${session}/url`, { url: `${page}recording.js` });
  return ask("POST", `${session}/execute/async`, { args: [settings, recording, to], script: `
  const [settings, recording, to, done] = arguments;
  const files = [['live.csv', new TextEncoder().encode(recording)]];
  const asks = [['open'], ['build', { runs: [settings], files }], ['go', { to, want: { of: 0, surfaces: 1 } }]];
  const worker = new Worker('worker.js', { type: 'module' });
  const ms = [];
  let begun;
  const next = () => {
    begun = performance.now();
    worker.postMessage({ operation: asks[ms.length][0], given: asks[ms.length][1] });
  };
  worker.onmessage = ({ data }) => {
    if (data.loaded !== undefined) return;
    ms.push(performance.now() - begun);
    if (!data.error && ms.length < 3) return next();
    worker.terminate();
    done(data.error ?? ms);
  };
  next();` });
}

/** Seconds of CPU that each process of the browser has taken, by its number. */
export function cpuSeconds() {
  const { stdout } = spawnSync("ps", ["-eo", "pid,ppid"], { encoding: "utf8" });
  const all = stdout.trim().split("\n").slice(1).map((line) => line.trim().split(/\s+/).map(Number));
  const mine = new Set([driver.pid]);
  for (let found = true; found; ) {
    found = false;
    for (const [pid, parent] of all) if (mine.has(parent) && !mine.has(pid)) found = Boolean(mine.add(pid));
  }
  // The 12th and 13th number after the name are ticks of 10 ms.
  const ticks = (pid) => readFileSync(`/proc/${pid}/stat`, "utf8").split(") ").at(-1).split(" ").slice(11, 13).reduce((sum, part) => sum + Number(part), 0);
  return new Map([...mine].flatMap((pid) => (existsSync(`/proc/${pid}/stat`) ? [[pid, ticks(pid) / 100]] : [])));
}

/** Share of a core that the browser takes for some seconds. A process that ends meanwhile does not count. */
export async function shareOfACore(seconds) {
  const [before, begun] = [cpuSeconds(), Date.now()];
  await later(seconds * 1000);
  const after = cpuSeconds();
  const took = [...before].map(([pid, from]) => (after.get(pid) ?? from) - from);
  assert.ok(took.every((one) => one >= 0) && after.size > 2, "time goes forward, and the browser is there");
  return took.reduce((sum, one) => sum + one, 0) / ((Date.now() - begun) / 1000);
}

/** A command of the browser's debugging protocol. */
export const cdp = (cmd, params = {}) => ask("POST", `${session}/goog/cdp/execute`, { cmd, params });
