// Tests of the page in a headless Chromium, driven by chromedriver: node run.mjs SITE PICTURES [PART OF A CLAIM].
// Each test says what it claims; what was measured is printed. Pictures at 390, 1280 and 2560 pixels are to be looked at. With AXE,
// the path of axe.min.js of the package axe-core, pages are checked by it too.
import { spawn, spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, extname, join, normalize, resolve } from "node:path";
import assert from "node:assert/strict";
import { Checkpoints } from "../page/checkpoints.js";
import { packed, samplesOf } from "../page/recording.js";
import { STORIES } from "../page/stories.js";

const [site, pictures] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
const MODELS = { ply: triangle(), obj: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", pdb: "ATOM      1  C   ALA A   1       0.000   0.000   0.000\nATOM      2  O   ALA A   1       1.200   0.000   0.000\n", broken: "ply\nformat ascii 1.0\nelement vertex x\n" };
const KINDS = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".png": "image/png" };
/** How the server answers for the machine: `well`, `missing`, or `slow`, with each of ten parts after 150 ms. */
let answers = "well";
const server = createServer(async (request, response) => {
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
const page = `http://127.0.0.1:${server.address().port}/live/`;

const port = 20000 + Math.floor(Math.random() * 20000);
const driver = spawn("chromedriver", [`--port=${port}`], { stdio: "ignore" });
const base = `http://127.0.0.1:${port}`;

async function ask(method, path, body) {
  const response = await fetch(base + path, { method, body: body && JSON.stringify(body) });
  const { value } = await response.json();
  if (value?.error) throw new Error(`${path}: ${value.message}`);
  return value;
}

async function driverIsReady() {
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
const args = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"];
const wanted = { capabilities: { alwaysMatch: { "goog:chromeOptions": { args }, "goog:loggingPrefs": { browser: "ALL" } } } };
const { sessionId } = await ask("POST", "/session", wanted);
const session = `/session/${sessionId}`;
const run = (script, ...values) => ask("POST", `${session}/execute/sync`, { script, args: values });
const later = (ms) => new Promise((done) => setTimeout(done, ms));

async function until(what, script, ms = 20000) {
  const begun = Date.now();
  while (Date.now() - begun < ms) {
    if (await run(`return ${script}`)) return Date.now() - begun;
    await later(50);
  }
  throw new Error(`waited ${ms} ms for ${what}`);
}

/** Until the worker has answered all that was asked of it. */
const settled = (ms) => until("the worker", "document.documentElement.dataset.asked === '0' && document.documentElement.dataset.ready === 'true'", ms);

async function open(hash = "") {
  await ask("POST", `${session}/url`, { url: "about:blank" });
  const begun = Date.now();
  await ask("POST", `${session}/url`, { url: page + hash });
  await settled(20000);
  return Date.now() - begun;
}

const text = (id) => run(`return document.getElementById('${id}').textContent`);
async function click(selector) {
  await run(`document.querySelector(${JSON.stringify(selector)}).click()`);
}
async function press(selector) {
  await click(selector);
  await settled();
}
const set = (id, value) => run(`const s = document.getElementById('${id}'); s.value = ${value}; s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change'))`);
/** Colours other than black in a canvas. */
const lit = (selector = "#eyes canvas") => run(`
  const canvas = document.querySelector('${selector}');
  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
  colours.delete(0);
  return colours.size;`);

/** A file as if somebody had dropped it onto the page. */
const drop = (name, contents) => run(`
  const data = new DataTransfer();
  data.items.add(new File([${JSON.stringify(contents)}], '${name}'));
  dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }))`);

/** A drag of 60 pixels to the right across the first picture, in half a second. */
async function drag() {
  await run("document.querySelector('#eyes canvas').scrollIntoView({ block: 'center' })");
  const box = await run("const b = document.querySelector('#eyes canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]");
  const [x, y] = [Math.round(box[0] + box[2] / 2), Math.round(box[1] + box[3] / 2)];
  const moves = Array.from({ length: 12 }, (_, n) => ({ type: "pointerMove", duration: 40, x: x + 5 * (n + 1), y }));
  const actions = [{ type: "pointerMove", duration: 0, x, y }, { type: "pointerDown", button: 0 }, ...moves, { type: "pointerUp", button: 0 }];
  await ask("POST", `${session}/actions`, { actions: [{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }] });
}

/** The link of what was recorded finds the same hash on the page, and its command the same. */
async function recordedAgain() {
  const link = await run("return document.getElementById('link').hash");
  assert.match(link, /motion=/);
  const recording = await run("return fetch(document.querySelector('#needs a').href).then((file) => file.text())");
  const folder = resolve(pictures);
  writeFileSync(join(folder, "recorded.csv"), recording);
  await sameHash(folder);
  const hash = await text("hash");
  await open(link);
  assert.equal(await text("hash"), hash);
}

function triangle() {
  const head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  return `${head}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n`;
}

/** Simulated time that the page shows, milliseconds. */
const shownMs = async () => (await run("return Number(document.getElementById('time').dataset.ps)")) / 1e9;
const emulate = (name, value) => ask("POST", `${session}/goog/cdp/execute`, { cmd: "Emulation.setEmulatedMedia", params: { features: [{ name, value }] } });
const key = (value) => ask("POST", `${session}/actions`, { actions: [{ type: "key", id: "keys", actions: [{ type: "keyDown", value }, { type: "keyUp", value }] }] });
const LEFT = "\uE012";
const RIGHT = "\uE014";

/** What axe-core finds against WCAG 2.1 A and AA on the present page; null where it is not there. */
async function axe() {
  if (!process.env.AXE) return null;
  await run(readFileSync(process.env.AXE, "utf8"));
  const { violations } = await ask("POST", `${session}/execute/async`, {
    script: "const done = arguments[0]; axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }).then(done)", args: [],
  });
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(" ")).slice(0, 4).join(", ")}`);
}

async function accessible(what) {
  const found = await axe();
  if (found === null) return console.log("   axe-core is not there: not checked");
  assert.deepEqual(found, [], what);
}

/** Goes through a story; `look` is called at each step that has paused. */
async function tell(name, look) {
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

async function picture(name, width, height = 1400) {
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

/** What the command prints as the hash of an experiment's trace at an instant; null where it is not built. */
function hashOfTheCommand(command, folder) {
  const program = resolve(process.env.PXPL5 ?? "target/debug/pxpl5");
  const parts = command.split('"').flatMap((part, n) => (n % 2 ? [part] : part.trim().split(/\s+/).filter(Boolean)));
  const { stdout, error } = spawnSync(program, parts.slice(1), { encoding: "utf8", cwd: folder });
  if (error) return null;
  return /^trace {3}(\S+)$/m.exec(stdout)?.[1] ?? "none";
}

/** The command finds the hash that the page shows; said where it is not built. */
async function sameHash(folder) {
  const [hashes, commands] = [(await text("hash")).split(" "), (await text("command")).split("\n")];
  commands.forEach((command, n) => {
    const found = hashOfTheCommand(command, folder);
    console.log(found === null ? "   the command is not built: its hash was not compared" : `   ${command}\n   trace ${found}`);
    if (found !== null) assert.equal(found, hashes[n]);
  });
}

/** Simulated by real time over some seconds of running. */
async function speed(seconds) {
  await run("document.getElementById('slower').value = 0");
  await click("#go");
  await later(500);
  const [from, begun] = [await shownMs(), Date.now()];
  await later(seconds * 1000);
  const [to, ended] = [await shownMs(), Date.now()];
  await press("#go");
  return (to - from) / (ended - begun);
}

/** Seconds of CPU that all processes of the browser have taken. */
function cpuSeconds() {
  const { stdout } = spawnSync("ps", ["-eo", "pid,ppid,cputimes"], { encoding: "utf8" });
  const all = stdout.trim().split("\n").slice(1).map((line) => line.trim().split(/\s+/).map(Number));
  const mine = new Set([driver.pid]);
  for (let found = true; found; ) {
    found = false;
    for (const [pid, parent] of all) if (mine.has(parent) && !mine.has(pid)) found = Boolean(mine.add(pid));
  }
  return all.filter(([pid]) => mine.has(pid)).reduce((sum, [, , seconds]) => sum + seconds, 0);
}

const TESTS = {
  async "the first screen has a moving picture within 2 s, one sentence and four stories"() {
    await open();
    const begun = Date.now();
    await ask("POST", `${session}/url`, { url: "about:blank" });
    await ask("POST", `${session}/url`, { url: page });
    await until("a picture", "document.querySelector('#eyes canvas')");
    const took = Date.now() - begun;
    console.log(`   first picture after ${took} ms`);
    assert.ok(took < 2000);
    await later(500);
    const before = await run("return document.querySelector('#eyes canvas').toDataURL()");
    await later(500);
    assert.notEqual(await run("return document.querySelector('#eyes canvas').toDataURL()"), before, "the picture moves");
    assert.ok((await lit()) > 3);
    assert.equal(await run("return document.querySelectorAll('#start [data-story]').length"), 4);
    assert.equal(await run("return document.querySelectorAll('form:not([hidden]) select').length > 0 && getComputedStyle(document.getElementById('lab')).display"), "none");
    await accessible("first screen");
  },
  async "each story runs to its end and goes on in the laboratory with the same experiment"() {
    for (const [name, { settings, beside, steps }] of Object.entries(STORIES)) {
      assert.ok(steps.length >= 5 && steps.length <= 6, name);
      for (const { say } of steps) assert.equal(say.match(/[.?!](?= |$)/g).length, 2, `two sentences: ${say}`);
      await tell(name, async (n, step) => {
        if (!only || only.startsWith("each")) await picture(`story-${name}-${n + 1}`, 1280, 900);
        const shown = await run("return [...document.querySelectorAll('#front > section')].filter((part) => part.checkVisibility()).map((part) => part.id)");
        assert.equal(shown.includes("diagram-part"), step.show.includes("diagram"), `${name} ${n + 1}`);
        if (n === steps.length - 1) await accessible(name);
      });
      await settled();
      assert.equal(await run("return document.body.dataset.mode"), "lab");
      const given = await run("return Object.fromEntries([...document.querySelectorAll('#settings select, #settings input')].map((field) => [field.name, field.value]))");
      for (const [key, value] of Object.entries(settings)) assert.equal(given[key], value, `${name}: ${key}`);
      assert.equal(given.beside, beside ?? "");
      const stands = await shownMs();
      await press('[data-step="field"]');
      assert.ok((await shownMs()) > stands, "the same machine goes on");
    }
  },
  async "the lag of Slats is smaller than that of Rendering Control, and both are told"() {
    await open("#story=lag&step=3");
    await until("the step", "document.documentElement.dataset.story === 'lag 3 paused'", 60000);
    const ages = await run("return [...document.querySelectorAll('.age strong')].map((age) => parseFloat(age.textContent))");
    console.log(`   ages: ${ages.join(" and ")} ms`);
    assert.equal(ages.length, 2);
    assert.ok(ages[1] < ages[0]);
  },
  async "a story can be gone back in, and its steps have links"() {
    await open("#story=inside&step=3");
    await until("the step", "document.documentElement.dataset.story === 'inside 3 paused'", 60000);
    const hash = await text("hash");
    await click("#story-next");
    await until("the step", "document.documentElement.dataset.story === 'inside 4 paused'", 60000);
    await click("#story-back");
    await until("the step", "document.documentElement.dataset.story === 'inside 3 paused'", 60000);
    assert.equal((await run("return location.hash")), "#story=inside&step=3");
    assert.ok(hash.length > 8);
  },
  async "with reduced motion nothing moves by itself, and a step stands at once where something happens"() {
    await emulate("prefers-reduced-motion", "reduce");
    await open();
    await later(300);
    const stands = await shownMs();
    await later(500);
    assert.equal(await shownMs(), stands);
    assert.ok((await lit()) > 3);
    await open("#story=inside&step=4");
    await until("the step", "document.documentElement.dataset.story === 'inside 4 paused'", 20000);
    await emulate("prefers-reduced-motion", "no-preference");
  },
  async "keys run, pause, step, go back and turn the head; the pictures' words follow"() {
    await open("#head.motion=live.csv&fields=600");
    await run("document.activeElement.blur()");
    await key(" ");
    await later(600);
    assert.equal(await text("go"), "Pause");
    await key(" ");
    await settled();
    assert.equal(await text("go"), "Run");
    const [stands, words] = [await shownMs(), await run("return document.querySelector('#eyes canvas').ariaLabel")];
    assert.ok(stands > 100);
    await key(RIGHT);
    await settled();
    assert.ok(Math.abs((await shownMs()) - stands) <= 16.7 && (await shownMs()) > stands);
    const after = await run("return document.querySelector('#eyes canvas').ariaLabel");
    assert.notEqual(after, words);
    assert.match(after, /left eye under Slats, scene aircraft, at .* ms, field \d+; the picture is .* ms old/);
    await key(LEFT);
    await settled();
    assert.ok((await shownMs()) < stands + 0.001);
    await run("document.querySelector('#eyes canvas').focus()");
    for (let n = 0; n < 4; n += 1) await key(LEFT);
    await press('[data-step="field"]');
    const motion = new URLSearchParams((await run("return document.getElementById('link').hash")).slice(1)).get("motion");
    assert.deepEqual(samplesOf(motion).at(-1), [80, 0], "4 times 2 degrees to the left");
  },
  async "what is wrong is told: a key of the link, a file, a machine that does not load; a slow one too"() {
    await open("#pipeline=slats&colour=red&fields=60");
    assert.match(await text("error"), /"colour".*expected pipeline, scene/);
    await drop("photo.png", "x");
    await until("an error", "document.getElementById('error').textContent.includes('photo.png')");
    assert.match(await text("error"), /photo\.png cannot be used: expected a model/);
    answers = "missing";
    await ask("POST", `${session}/url`, { url: "about:blank" });
    await ask("POST", `${session}/url`, { url: page });
    await until("a message", "document.documentElement.dataset.ready === 'failed'");
    assert.match(await text("loading-says"), /cannot start here: .*wasm cannot be loaded \(404/);
    answers = "slow";
    await ask("POST", `${session}/url`, { url: "about:blank" });
    await ask("POST", `${session}/url`, { url: page });
    await later(700);
    assert.match(await text("loading-says"), /Loading the machine: \d\.\d MB of \d\.\d MB/);
    await until("the machine", "document.documentElement.dataset.ready === 'true'");
    answers = "well";
    // The missing file has been written to the console, as it must.
    await ask("POST", `${session}/se/log`, { type: "browser" });
  },
  async "settings that are not built yet are marked"() {
    await open("#fields=60");
    assert.equal(await text("changed"), "");
    await run("const s = document.querySelector('[name=scene]'); s.value = 'mig'; s.dispatchEvent(new Event('input', { bubbles: true }))");
    assert.match(await text("changed"), /press Build/);
    assert.equal(await run("return document.querySelectorAll('#settings .changed').length"), 1);
    await run("document.getElementById('settings').requestSubmit()");
    await settled();
    assert.equal(await text("changed"), "");
  },
  async "after the end, and before it, a run can be begun again and is the same"() {
    await open("#pipeline=slats&fields=12&head.motion=live.csv&at=150000000000");
    const hash = await text("hash");
    await press('[data-step="field"]');
    await press('[data-step="field"]');
    await press('[data-step="field"]');
    await press('[data-step="field"]');
    assert.match(await text("failure"), /Begin again/);
    await press("#rewind");
    assert.equal(await shownMs(), 0);
    for (let n = 0; n < 9; n += 1) await press('[data-step="field"]');
    await press("#back");
    assert.ok(Math.abs((await shownMs()) - 8 * 16.683333333) < 0.001);
    await open("#pipeline=slats&fields=12&head.motion=live.csv&at=150000000000");
    assert.equal(await text("hash"), hash);
  },
  async "checkpoints put a memory back bit for bit, and keep their bounds"() {
    const memory = new WebAssembly.Memory({ initial: 4 });
    const limits = { every: 10, work: Infinity, bytes: 40 * 4096, count: 12, lost: 50 * 65536 };
    const checkpoints = new Checkpoints(memory, limits);
    let seed = 1;
    const random = (below) => (seed = (seed * 48271) % 2147483647) % below;
    const images = new Map();
    let [now, backs] = [0, 0];
    for (let step = 0; step < 3000; step += 1) {
      const bytes = new Uint8Array(memory.buffer);
      for (let n = 0; n < 6; n += 1) bytes[random(bytes.length)] = random(256);
      if (random(200) === 0) memory.grow(1);
      now += 1 + random(7);
      if (checkpoints.take(now, step)) images.set(now, bytes.slice());
      assert.ok(checkpoints.bytes <= limits.bytes && checkpoints.all.length <= limits.count);
      if (random(40) > 0) continue;
      const to = now - random(400);
      const expected = checkpoints.all.findLast(({ at }) => at <= to);
      const found = checkpoints.back(to);
      assert.equal(found?.at, expected?.at);
      if (!found) continue;
      const image = images.get(found.at);
      assert.ok(Buffer.from(memory.buffer, 0, image.length).equals(Buffer.from(image)));
      now = found.at;
      backs += 1;
    }
    assert.ok(backs > 20, `${backs}`);
    // Recent checkpoints stay as close together as they were taken.
    const steady = new Checkpoints(memory, { ...limits, bytes: Infinity });
    for (let at = 0; at <= 10000; at += 10) steady.take(at, null);
    const ages = steady.all.map(({ at }) => 10000 - at);
    assert.equal(ages.length, limits.count);
    assert.deepEqual(ages.slice(-3), [20, 10, 0]);
    assert.ok(ages.every((age, n) => n === 0 || ages[n - 1] - age <= 10 + 0.9 * ages[n - 1]), `${ages}`);
    // A return that would lose too much is refused.
    const small = new Checkpoints(new WebAssembly.Memory({ initial: 1 }), { ...limits, lost: 65536 });
    small.take(0, "begin");
    small.memory.grow(2);
    assert.equal(small.back(5), null);
  },
  async "a step back shows the same pictures bit for bit, and runs little again"() {
    const look = () => run(`return JSON.stringify([
      document.getElementById('hash').textContent, document.getElementById('time').dataset.ps,
      [...document.querySelectorAll('#eyes .seen canvas')].map((canvas) => canvas.toDataURL()),
      [...document.querySelectorAll('#diagram .block')].map((block) => block.textContent)])`);
    for (const [hash, fields] of [
      ["pipeline=slats&beside=rendering-control&scene=aircraft&head.motion=live.csv&fields=600", 4],
      ["pipeline=jitp-scanline&scene=aircraft&triangles=30&head.motion=sine:20:0.5&fields=600", 3],
      ["pipeline=arp-priority-pixel&display=arp&scene=gallery&head.motion=sine:20:0.5&fields=600", 3],
    ]) {
      await open(`#${hash}&at=3700000000000`);
      const seen = [];
      for (let n = 0; n <= fields; n += 1) {
        await press('[data-step="field"]');
        seen.push(await look());
      }
      for (let n = fields - 1; n >= 0; n -= 1) {
        await press("#back");
        assert.equal(await look(), seen[n], `${hash}, ${n} fields after the begin`);
        const repeated = (await run("return Number(document.documentElement.dataset.repeatedPs)")) / 1e9;
        // A second between checkpoints, and the piece of the run at whose end one is taken.
        assert.ok(repeated <= 1300, `${repeated} ms are run again`);
      }
      // From the begin on it is the same run, and forth from there too.
      await press("#rewind");
      assert.equal(await shownMs(), 0);
      await run(`location.hash = ${JSON.stringify(hash)} + '&at=3700000000000'`);
      await until("the run", "document.getElementById('time').dataset.ps === '3700000000000'", 60000);
      await settled();
      await press('[data-step="field"]');
      assert.equal(await look(), seen[0]);
      console.log(`   ${hash.split("&")[0]}: ${fields} steps back, memory ${await text("bytes")}`);
    }
  },
  async "a step back after a long run is short, and the memory is bounded"() {
    await open("#pipeline=slats&scene=aircraft&fields=1000000&at=120000000000000");
    await until("the run", "document.getElementById('time').dataset.ps === '120000000000000'", 240000);
    await settled();
    const begun = await shownMs();
    for (let n = 0; n < 5; n += 1) {
      await press("#back");
      const repeated = (await run("return Number(document.documentElement.dataset.repeatedPs)")) / 1e9;
      assert.ok(repeated <= 1300, `${repeated} ms are run again`);
    }
    assert.ok(Math.abs(begun - (await shownMs()) - 5 * 16.683333) < 0.01);
    assert.ok(parseInt(await text("bytes"), 10) < 200);
  },
  async "in RENDER and COPY the regions that are drawn and copied are marked in two colours, with a legend"() {
    const colours = `
      const data = document.querySelector('#eyes .over').getContext('2d').getImageData(0, 0, 640, 480).data;
      const near = (at, [r, g, b]) => data[at + 3] > 200 && Math.abs(data[at] - r) + Math.abs(data[at + 1] - g) + Math.abs(data[at + 2] - b) < 24;
      const count = [0, 0];
      for (let at = 0; at < data.length; at += 4) [[127, 214, 168], [255, 209, 102]].forEach((colour, n) => near(at, colour) && (count[n] += 1));
      return count`;
    await open("#story=inside&step=4");
    await until("RENDER", "document.documentElement.dataset.story === 'inside 4 paused'", 60000);
    await settled();
    const [drawn] = await run(colours);
    await click("#story-next");
    await until("COPY", "document.documentElement.dataset.story === 'inside 5 paused'", 60000);
    await settled();
    const [also, copied] = await run(colours);
    console.log(`   marked pixels: drawn ${drawn} in RENDER, drawn ${also} and copied ${copied} in COPY`);
    assert.ok(drawn > 200 && copied > 200);
    assert.match(await text("region-legend"), /drawing.*on its way/s);
    assert.ok(await run("return document.getElementById('region-legend').checkVisibility()"));
  },
  async "where nothing is shown, the page says why and what would fit, and builds it"() {
    for (const [hash, name, least, most] of [["pipeline=slats&scene=mig", "Slats", 130, 160], ["pipeline=jitp-scanline&scene=aircraft", "jitp-scanline", 10, 60]]) {
      await open(`#${hash}&fields=600&head.motion=sine:10:0.5&at=600000000000`);
      await until("a number", "document.querySelector('#heavy button')", 60000);
      console.log(`   ${await text("heavy")}`);
      const [, would] = /About ([\d,]+) would do/.exec(await text("heavy"));
      assert.ok((await text("heavy")).startsWith(`${name} finishes no picture in time`));
      assert.ok(Number(would) >= least && Number(would) <= most, would);
      assert.doesNotMatch(await run("return document.body.innerText"), /NaN|undefined|Infinity/);
      await press("#heavy button");
      for (let n = 0; n < 12; n += 1) await press('[data-step="field"]');
      assert.ok((await lit()) > 1, "something is shown");
      assert.ok(await run("return document.getElementById('heavy').hidden"));
    }
  },
  async "the laboratory shows the waits of the pictures and the use of the boards"() {
    await open("#pipeline=rendering-control&beside=slats&scene=aircraft&fields=600");
    assert.match(await text("limits"), /No complete picture has been shown yet.*No time has passed yet/);
    await run("location.hash = 'pipeline=rendering-control&beside=slats&scene=aircraft&fields=600&at=900000000000'");
    await until("the run", "document.getElementById('time').dataset.ps === '900000000000'");
    await settled();
    const [limited, shares] = await run(`return [
      [...document.querySelectorAll('#limits > div > p')].map((p) => p.textContent),
      [...document.querySelectorAll('#limits > div')].map((part) => [...part.querySelectorAll('table:first-of-type tbody td:nth-child(2)')].map((cell) => parseFloat(cell.textContent)))]`);
    limited.forEach((sentence) => assert.match(sentence, /^Limited by .*, \d+ % of the latency/));
    assert.equal(limited.length, 2);
    // Each share is rounded to a whole number.
    for (const all of shares) assert.ok(Math.abs(all.reduce((sum, share) => sum + share, 0) - 100) <= all.length / 2 + 0.1, `${all}`);
    console.log(`   ${limited.join("\n   ")}`);
    await accessible("the block of limits");
  },
  async "picture, report and timeline can be saved"() {
    await open("#pipeline=slats&beside=rendering-control&scene=aircraft&head.motion=sine:5:0.5&fields=120&at=500000000000");
    await run(`window.saved = []; const make = URL.createObjectURL; URL.createObjectURL = (blob) => { window.saved.push(blob); return make(blob); };
      HTMLAnchorElement.prototype.click = function () { window.saved.push(this.download); };`);
    for (const id of ["save-picture", "save-report", "save-timeline"]) await press(`#${id}`);
    await until("three files", "window.saved.length >= 6");
    const [names, report, kinds] = await ask("POST", `${session}/execute/async`, { script: `const done = arguments[0];
      const names = window.saved.filter((one) => typeof one === "string");
      const blobs = window.saved.filter((one) => one instanceof Blob);
      blobs.find((blob) => blob.type === "application/json").text().then((text) => done([names, text, blobs.map((blob) => blob.type)]))`, args: [] });
    assert.deepEqual(names.map((name) => name.split(".").at(-1)).sort(), ["json", "png", "svg"]);
    assert.deepEqual([...kinds].sort(), ["application/json", "image/png", "image/svg+xml"]);
    const { machines } = JSON.parse(report);
    assert.deepEqual(machines.map((machine) => machine.trace_hash), (await text("hash")).split(" "));
    assert.equal(machines[0].time_ms, 500);
    assert.equal(machines[0].difference_from_ideal[0].mean_percent, null, "not measured");
  },
  async "a link with ten seconds of a moved head is short"() {
    const samples = Array.from({ length: 600 }, (_, n) => [Math.round(100 * Math.sin(n / 40)) + 0, n < 300 ? 0 : -20]);
    const text = packed(samples);
    assert.deepEqual(samplesOf(text), samples);
    assert.ok(text.length < 1300, `${text.length}`);
    for (const wrong of ["~", "~!", "~A", "1,2_3", "x"]) assert.equal(samplesOf(wrong), null, wrong);
  },
  async "steps go on by a field, a line and an event"() {
    await open("#fields=120");
    assert.equal(await text("time"), "0.000 ms");
    await press('[data-step="field"]');
    assert.equal(await text("field"), "1 of 120");
    // A field of NTSC takes 1001/60000 s.
    assert.equal(await text("time"), "17 ms");
    assert.equal(await run("return document.getElementById('time').dataset.ps"), "16683333333");
    await press('[data-step="line"]');
    assert.equal(await text("line"), "1");
    const before = await text("hash");
    for (let n = 0; n < 200; n += 1) await click('[data-step="event"]');
    await settled();
    assert.notEqual(await text("hash"), before);
    assert.equal(await run("return document.querySelectorAll('#diagram .block').length >= 2"), true);
    await run("document.getElementById('machine-part').open = true");
    await later(100);
    await settled();
    assert.equal(await run("return document.querySelectorAll('#ring li').length"), 8);
  },
  async "a run goes on by itself, slower when it shall, and stands when it is paused"() {
    await open("#pipeline=slats&scene=aircraft&fields=36000");
    const share = await speed(6);
    console.log(`   aircraft under Slats, both eyes drawn: ${share.toFixed(2)} of real time`);
    assert.ok(share > 0.1);
    assert.ok((await lit()) > 3, "the aircraft is seen");
    const stands = await shownMs();
    // The last messages have crossed the diagram then.
    await later(1500);
    assert.equal(await shownMs(), stands);
    const [cpu, begun] = [cpuSeconds(), Date.now()];
    await later(10000);
    const idle = (100 * (cpuSeconds() - cpu)) / ((Date.now() - begun) / 1000);
    console.log(`   paused: ${idle.toFixed(1)} % of a core`);
    assert.ok(idle <= 10, "counted in whole seconds of all processes");
    await set("slower", 3);
    await click("#go");
    await later(1000);
    await press("#go");
    const slow = (await shownMs()) - stands;
    assert.ok(slow > 0.2 && slow < 3, `a thousandth of 1 s, ${slow} ms`);
  },
  async "Rendering Control runs the Mig at the transaction level"() {
    await open("#pipeline=rendering-control&scene=mig&fields=36000");
    console.log(`   Mig under Rendering Control, both eyes drawn: ${(await speed(6)).toFixed(2)} of real time`);
  },
  async "every pipeline shows something, on its display"() {
    await open();
    const names = await run("return [...document.querySelectorAll('[name=pipeline] option')].map((option) => option.value)");
    for (const name of names) {
      const display = name.startsWith("arp") ? "arp" : "ntsc";
      await open(`#pipeline=${name}&scene=full-screen:2&display=${display}&fields=60&at=300000000000`);
      assert.equal(await run("return document.getElementById('error').hidden"), true, `${name}: ${await text("error")}`);
      assert.ok((await lit()) > 0, `${name}: all is black`);
      assert.ok((await run("return document.getElementById('timeline').shadowRoot.querySelectorAll('rect').length")) > 5, name);
    }
    await open("#pipeline=rendering-control&scene=full-screen:2&display=hires&fields=60&at=300000000000");
    assert.ok((await lit()) > 0, "hires");
    console.log(`   ${names.length} pipelines, 3 displays`);
  },
  async "renderers show what is in their pixels"() {
    await open("#pipeline=rendering-control&scene=mig&fields=60&at=200000000000");
    await run("document.getElementById('machine-part').open = true");
    await later(100);
    await settled();
    const colours = [];
    for (let n = 1; n <= 5; n += 1) colours.push(await lit(`#renderers button:nth-child(${n}) canvas`));
    assert.ok(colours.every((count) => count > 0), `all renderers but ${colours}`);
    await run("const f = document.getElementById('pixel-form'); f.requestSubmit()");
    await settled();
    assert.match(await text("pixel"), /^bits +0 to +\d+  context 0 colour/);
  },
  async "ideal picture and error stand beside each eye, with a number"() {
    await open("#pipeline=slats&scene=aircraft&fields=60&at=300000000000");
    await press("#show-ideal");
    await press("#show-error");
    assert.equal(await run("return document.querySelectorAll('#eyes figure:not([hidden])').length"), 6);
    assert.ok((await lit("#eyes .eye figure:nth-child(2) canvas")) > 3);
    const said = await run("return document.querySelector('#eyes .eye figure:nth-child(3) figcaption').textContent");
    assert.match(said, /^error: \d+\.\d\d % of full brightness in the mean, \d+\.\d % of the pixels differ$/);
  },
  async "the last pictures' latency is shown part by part, and the parts add up"() {
    await open("#pipeline=rendering-control&scene=mig&fields=120&at=900000000000");
    const [total, parts] = await run(`
      const bars = [...document.querySelectorAll('#latency .bar span')];
      const cells = [...document.querySelectorAll('#latency td')];
      return [Number(bars.at(-1).dataset.ms), cells.map((cell) => Number(cell.dataset.ms))];`);
    assert.ok(parts.length > 4);
    const sum = parts.reduce((a, b) => a + b);
    assert.ok(Math.abs(sum - total) < 0.01, `${sum} and ${total}`);
  },
  async "dragging across a picture records a head that the machine follows, and the link carries it"() {
    await open("#pipeline=slats&scene=aircraft&fields=120&head.tracker=fastrak&head.predict=none");
    await drag();
    await until("a run", "document.getElementById('go').textContent === 'Pause' || !document.getElementById('error').hidden");
    assert.equal(await text("error"), "");
    assert.match(await text("recorded"), /^Recorded 0\.\d s/);
    await later(500);
    await press("#go");
    await recordedAgain();
  },
  async "a live head moves while the machine runs, in two machines at once; its link replays it"() {
    const settings = "scene=aircraft&fields=1000&head.motion=live.csv&head.tracker=fastrak";
    await open(`#pipeline=slats&beside=rendering-control&${settings}`);
    assert.equal(await text("error"), "");
    const before = await run("return document.querySelector('#eyes canvas').toDataURL()");
    await click("#go");
    await drag();
    await later(700);
    await press("#go");
    assert.equal(await text("error"), "");
    assert.notEqual(await run("return document.querySelector('#eyes canvas').toDataURL()"), before);
    const moved = new URLSearchParams((await run("return document.getElementById('link').hash")).slice(1)).get("motion");
    const yaws = samplesOf(moved).map(([yaw]) => yaw);
    assert.ok(new Set(yaws).size > 3, `the head was turned bit by bit: ${yaws}`);
    await recordedAgain();
  },
  async "turning the device moves the head"() {
    const turn = (alpha) => ask("POST", `${session}/goog/cdp/execute`, {
      cmd: "DeviceOrientation.setDeviceOrientationOverride", params: { alpha, beta: 0, gamma: 0 },
    });
    await turn(10);
    await open("#pipeline=slats&scene=aircraft&fields=600&head.tracker=fastrak&head.predict=none");
    await click("#tilt");
    for (const alpha of [11, 13, 16, 18]) {
      await later(200);
      await turn(alpha);
    }
    await until("the recording", "document.getElementById('recorded').textContent.startsWith('Recorded')");
    await settled();
    await later(300);
    await press("#go");
    const motion = new URLSearchParams((await run("return document.getElementById('link').hash")).slice(1)).get("motion");
    assert.deepEqual(samplesOf(motion).at(-1), [80, 0], "8 degrees to the left");
  },
  async "a model that is dropped is drawn; a broken file is said, and the page lives on"() {
    for (const kind of ["ply", "obj", "pdb"]) {
      await open("#pipeline=slats&scene=aircraft&fields=60");
      await drop(`mine.${kind}`, MODELS[kind]);
      await until("the model", "document.getElementById('dropped').textContent !== ''");
      await settled();
      for (let n = 0; n < 12; n += 1) await press('[data-step="field"]');
      assert.ok((await lit()) > 0, kind);
    }
    writeFileSync(join(pictures, "mine.pdb"), MODELS.pdb);
    await sameHash(resolve(pictures));
    await drop("broken.ply", MODELS.broken);
    await until("an error", "document.getElementById('error').hidden === false");
    console.log(`   ${await text("error")}`);
    assert.match(await text("error"), /broken\.ply/);
    const before = await shownMs();
    await press('[data-step="field"]');
    assert.notEqual(await shownMs(), before, "the machine before stays");
  },
  async "two pipelines run side by side on the same input"() {
    await open("#pipeline=slats&beside=rendering-control&scene=aircraft&head.motion=sine:5:0.5&fields=120&at=400000000000");
    assert.equal(await run("return document.querySelectorAll('#eyes .machine').length"), 2);
    assert.ok((await lit("#eyes .machine:nth-child(2) canvas")) > 3);
    assert.equal((await text("hash")).split(" ").length, 2);
    await sameHash(".");
  },
  async "six faces are shown beside the eye that is looked up in them"() {
    await open("#pipeline=arp-full&display=arp&scene=mig&head.motion=sine:10:0.5&fields=60&at=600000000000");
    assert.ok((await lit("#faces canvas")) > 3);
  },
  async "the same scene is drawn as slices and seen from any side"() {
    await open("#pipeline=slats&scene=mig&fields=60");
    await run("document.getElementById('volume-part').open = true");
    await click("#volume-draw");
    await until("the volume", "document.getElementById('volume').hidden === false", 60000);
    await settled();
    console.log(`   ${await text("volume-says")}`);
    const first = await run("return document.getElementById('volume-picture').toDataURL()");
    await set("azimuth", 120);
    await settled();
    assert.notEqual(await run("return document.getElementById('volume-picture').toDataURL()"), first);
    await set("slice", 99);
    await settled();
    assert.ok((await lit("#volume-picture")) > 3);
  },
  async "the cycle level shows the code of a board with the current instruction"() {
    await open("#pipeline=slats&scene=aircraft&level=cycle&fields=20&at=60000000000");
    await press("[data-board='GP 0']");
    assert.match(await text("board"), /^> 0x[0-9a-f]{8}  [0-9a-f]{8}  \S+/m);
  },
  async "terms are explained on focus"() {
    await open("#fields=60");
    await run("document.getElementById('machine-part').open = true");
    await key("\uE004");
    await run("document.querySelector('#ring').closest('details').querySelector('h3 [data-term=ring]').focus()");
    assert.match(await text("hint"), /eight channels/);
    assert.equal(await run("return document.querySelectorAll('[data-term]:not([aria-description])').length"), 0);
  },
  async "a wrong setting is said and the machine stays"() {
    await open("#pipeline=slats&scene=migg&fields=10");
    assert.match(await text("error"), /mig/);
  },
  async "a machine that fails is a state"() {
    await open("#pipeline=slats&scene=full-screen:200000&fields=8&at=100000000000");
    assert.match(await text("failure"), /^The machine cannot go on: GP/);
  },
  async "a board that is clicked shows its state"() {
    await open("#pipeline=slats&scene=aircraft&fields=20&at=40000000000");
    await press("[data-board='GP 0']");
    assert.equal(await text("board-name"), "GP 0");
    assert.match(await text("board"), /busy/);
  },
  async "the link builds the same run, and the command has the same trace hash"() {
    await open("#pipeline=slats&scene=aircraft&fields=20");
    for (let n = 0; n < 5; n += 1) await press('[data-step="field"]');
    const [hash, link] = [await text("hash"), await run("return document.getElementById('link').hash")];
    await sameHash(".");
    await open(link);
    assert.equal(await text("hash"), hash);
  },
  async "memory does not grow while it runs"() {
    const used = [];
    for (const minutes of [1, 5]) {
      await open();
      await run(`location.hash = 'pipeline=slats&scene=aircraft&fields=1000000&at=${minutes * 60e12}'`);
      await until("the run", `document.getElementById('time').dataset.ps === '${minutes * 60e12}'`, 240000);
      await settled();
      used.push(parseInt(await text("bytes"), 10));
    }
    console.log(`   memory of the machines after 1 and 5 simulated minutes: ${used.join(" and ")} MB`);
    assert.ok(used[1] <= used[0] * 1.1 + 1);
  },
  async "it fits 390, 1280 and 2560 pixels, light and dark"() {
    for (const scheme of ["light", "dark"]) {
      await emulate("prefers-color-scheme", scheme);
      await open();
      await later(800);
      for (const width of [390, 1280, 2560]) await picture(`start-${scheme}-${width}`, width, width === 390 ? 844 : 1000);
      assert.ok((await run("return document.querySelector('#eyes canvas').getBoundingClientRect().top")) < 300, "the picture comes first");
      await accessible(`first screen, ${scheme}`);
      for (const name of ["inside", "lag"]) {
        await ask("POST", `${session}/goog/cdp/execute`, { cmd: "Emulation.clearDeviceMetricsOverride", params: {} });
        await open(`#story=${name}&step=4`);
        await until("the step", `document.documentElement.dataset.story === '${name} 4 paused'`, 60000);
        await later(300);
        for (const width of [390, 1280, 2560]) await picture(`${name}-${scheme}-${width}`, width, width === 390 ? 844 : 1000);
        await accessible(`${name}, ${scheme}`);
      }
      await open("#pipeline=rendering-control&scene=mig&fields=120&head.motion=sine:10:0.5&at=500000000000");
      await press("#show-ideal");
      await press("#show-error");
      await press("[data-board='GP 0']");
      await run("document.getElementById('machine-part').open = true");
      await later(200);
      await settled();
      for (const width of [390, 1280, 2560]) await picture(`lab-${scheme}-${width}`, width, 3600);
      await accessible(`laboratory, ${scheme}`);
    }
    await emulate("prefers-color-scheme", "light");
    await open("#pipeline=slats&beside=rendering-control&scene=aircraft&fields=120&head.motion=sine:10:0.5&at=500000000000");
    await picture("two-1280", 1280, 2000);
    await open("#pipeline=arp-full&display=arp&scene=mig&head.motion=sine:10:0.5&fields=60&at=600000000000");
    await run("document.getElementById('volume-part').open = true; document.getElementById('volume-draw').click()");
    await until("the volume", "document.getElementById('volume').hidden === false", 60000);
    await settled();
    await picture("faces-1280", 1280, 4000);
    await ask("POST", `${session}/url`, { url: new URL("../docs/gallery.html", page).href });
    await picture("gallery-1280", 1280, 4200);
    await open("#pipeline=slats&scene=mig&fields=600&head.motion=sine:10:0.5&at=600000000000");
    await until("a number", "document.querySelector('#heavy button')", 60000);
    await picture("heavy-1280", 1280, 1800);
    await picture("heavy-390", 390, 1800);
    await ask("POST", `${session}/url`, { url: new URL("../docs/index.html", page).href });
    await picture("book-1280", 1280, 1200);
    await picture("book-390", 390, 1200);
  },
  async "the search of the book finds a word and the page that explains it"() {
    await ask("POST", `${session}/goog/cdp/execute`, { cmd: "Emulation.clearDeviceMetricsOverride", params: {} });
    await ask("POST", `${session}/url`, { url: new URL("../docs/index.html?search=clump", page).href });
    await until("results", "document.querySelectorAll('#mdbook-searchresults a, #searchresults a').length > 0");
    const links = await run("return [...document.querySelectorAll('#mdbook-searchresults a, #searchresults a')].map((link) => link.getAttribute('href'))");
    console.log(`   ${links.length} results, the first: ${links[0]}`);
    assert.ok(links.some((link) => link.includes("glossary.html")), `${links}`);
  },
  async "every link of the site leads to a page and a place on it"() {
    const wrong = brokenLinks(site);
    assert.deepEqual(wrong, []);
  },
  async "nothing was written to the console"() {
    const entries = await ask("POST", `${session}/se/log`, { type: "browser" });
    const wrong = entries.filter((entry) => entry.level === "SEVERE" && !entry.message.includes("favicon"));
    assert.deepEqual(wrong.map((entry) => entry.message), []);
  },
};

/** Links of all pages of a folder that lead nowhere. */
function brokenLinks(folder) {
  const files = readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(".html") && !name.startsWith("api"));
  const places = (text) => new Set([...text.matchAll(/ id="([^"]*)"/g)].map((match) => match[1]));
  const wrong = [];
  for (const name of files) {
    const text = readFileSync(join(folder, name), "utf8");
    for (const [, link] of text.matchAll(/ (?:href|src)="([^"]*)"/g)) {
      if (/^[a-z]+:|^$/.test(link) || name === "print.html" || name === "404.html") continue;
      const [path, place] = link.replaceAll("&amp;", "&").split("#");
      let file = path === "" ? join(folder, name) : join(folder, dirname(name), decodeURI(path));
      if (file.startsWith(join(folder, "api"))) continue;
      if (existsSync(file) && statSync(file).isDirectory()) file = join(file, "index.html");
      if (!existsSync(file)) wrong.push(`${name}: ${link}`);
      else if (place && file.endsWith(".html") && !place.includes("=") && !places(readFileSync(file, "utf8")).has(decodeURI(place))) wrong.push(`${name}: ${link}`);
    }
  }
  return wrong;
}

const only = process.argv[4];
const started = Date.now();
let failed = 0;
for (const [claim, test] of Object.entries(TESTS)) {
  if (only && !claim.includes(only)) continue;
  try {
    await test();
    console.log(`ok    ${claim}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${claim}\n${error.stack}`);
    const entries = await ask("POST", `${session}/se/log`, { type: "browser" }).catch(() => []);
    entries.forEach((entry) => console.log(`   ${entry.level} ${entry.message}`));
    // A page that does not open fails everything.
    if (failed > 4) break;
  }
}
await ask("DELETE", session);
driver.kill();
server.close();
console.log(`${failed === 0 ? "all passed" : `${failed} failed`} after ${Math.round((Date.now() - started) / 1000)} s`);
process.exit(failed === 0 ? 0 : 1);
