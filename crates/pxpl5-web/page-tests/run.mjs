// Tests of the page in a headless Chromium, driven by chromedriver: node run.mjs SITE PICTURES [PART OF A CLAIM].
// Each test says what it claims; what was measured is printed. Pictures at 390, 1280 and 2560 pixels are for somebody to look at.
import { spawn, spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, extname, join, normalize, resolve } from "node:path";
import assert from "node:assert/strict";

const [site, pictures] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
const MODELS = { ply: triangle(), obj: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", pdb: "ATOM      1  C   ALA A   1       0.000   0.000   0.000\nATOM      2  O   ALA A   1       1.200   0.000   0.000\n", broken: "ply\nformat ascii 1.0\nelement vertex x\n" };
const KINDS = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, "http://x").pathname);
  try {
    const name = path.endsWith("/") ? `${path}index.html` : path;
    const bytes = readFileSync(join(site, name));
    response.writeHead(200, { "content-type": KINDS[extname(name)] ?? "application/octet-stream" }).end(bytes);
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
  await run(`document.querySelector('${selector}').click()`);
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
  const [from, begun] = [parseFloat(await text("time")), Date.now()];
  await later(seconds * 1000);
  const [to, ended] = [parseFloat(await text("time")), Date.now()];
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
  async "the page opens with a machine that stands at the begin, and its first picture within 2 s"() {
    await open();
    const begun = Date.now();
    await ask("POST", `${session}/url`, { url: "about:blank" });
    await ask("POST", `${session}/url`, { url: page });
    await until("a picture", "document.documentElement.dataset.asked === '0' && document.querySelector('#eyes canvas')");
    const took = Date.now() - begun;
    console.log(`   first picture after ${took} ms`);
    assert.ok(took < 2000);
    await settled();
    assert.equal(await text("time"), "0.000000 ms");
    assert.ok((await run("return document.querySelectorAll('#processors button').length")) >= 2);
    assert.equal(await run("return document.querySelectorAll('#ring li').length"), 8);
  },
  async "steps go on by a field, a line and an event"() {
    await open("#fields=120");
    await press('[data-step="field"]');
    assert.equal(await text("field"), "1 of 120");
    // A field of NTSC takes 1001/60000 s.
    assert.equal(await text("time"), "16.683333 ms");
    await press('[data-step="line"]');
    assert.equal(await text("line"), "1");
    const before = await text("hash");
    for (let n = 0; n < 200; n += 1) await click('[data-step="event"]');
    await settled();
    assert.notEqual(await text("hash"), before);
  },
  async "a run goes on by itself, slower when it shall, and stands when it is paused"() {
    await open("#pipeline=slats&scene=aircraft&fields=36000");
    const share = await speed(6);
    console.log(`   aircraft under Slats, both eyes drawn: ${share.toFixed(2)} of real time`);
    assert.ok(share > 0.1);
    assert.ok((await lit()) > 3, "the aircraft is seen");
    const stands = await text("time");
    await later(300);
    assert.equal(await text("time"), stands);
    const [cpu, begun] = [cpuSeconds(), Date.now()];
    await later(10000);
    const idle = (100 * (cpuSeconds() - cpu)) / ((Date.now() - begun) / 1000);
    console.log(`   paused: ${idle.toFixed(1)} % of a core`);
    assert.ok(idle <= 10, "counted in whole seconds of all processes");
    await set("slower", 3);
    await click("#go");
    await later(1000);
    await press("#go");
    const slow = parseFloat(await text("time")) - parseFloat(stands);
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
      return [parseFloat(bars.at(-1).textContent.split(': ')[1]), cells.map((cell) => parseFloat(cell.textContent))];`);
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
    const yaws = moved.split("_").map((pair) => Number(pair.split(",")[0]));
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
    assert.equal(motion.split("_").at(-1), "80,0", "8 degrees to the left");
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
    const before = await text("time");
    await press('[data-step="field"]');
    assert.notEqual(await text("time"), before, "the machine before stays");
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
    await run("document.getElementById('faces-part').open = true");
    await later(100);
    await settled();
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
    await press("#processors button:nth-child(2)");
    assert.match(await text("board"), /^> 0x[0-9a-f]{8}  [0-9a-f]{8}  \S+/m);
  },
  async "terms are explained on focus"() {
    await open();
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
    await press("#processors button:nth-child(2)");
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
      await until("the run", `document.getElementById('time').textContent === '${(minutes * 60000).toFixed(6)} ms'`, 120000);
      used.push(parseInt(await text("bytes"), 10));
    }
    console.log(`   memory of the machines after 1 and 5 simulated minutes: ${used.join(" and ")} MB`);
    assert.ok(used[1] <= used[0] * 1.1 + 1);
  },
  async "it fits 390, 1280 and 2560 pixels, light and dark"() {
    const media = (value) => ask("POST", `${session}/goog/cdp/execute`, {
      cmd: "Emulation.setEmulatedMedia", params: { features: [{ name: "prefers-color-scheme", value }] },
    });
    await open("#pipeline=rendering-control&scene=mig&fields=120&head.motion=sine:10:0.5&at=500000000000");
    await press("#show-ideal");
    await press("#show-error");
    await press("#processors button:nth-child(2)");
    for (const width of [390, 1280, 2560]) await picture(`page-${width}`, width, 3000);
    await media("dark");
    for (const width of [390, 1280, 2560]) await picture(`page-dark-${width}`, width, 3000);
    await media("light");
    await open("#pipeline=slats&beside=rendering-control&scene=aircraft&fields=120&head.motion=sine:10:0.5&at=500000000000");
    await picture("two-1280", 1280, 2000);
    await open("#pipeline=arp-full&display=arp&scene=mig&head.motion=sine:10:0.5&fields=60&at=600000000000");
    await run("document.getElementById('faces-part').open = true; document.getElementById('volume-part').open = true; document.getElementById('volume-draw').click()");
    await until("the volume", "document.getElementById('volume').hidden === false", 60000);
    await settled();
    await picture("faces-1280", 1280, 4000);
    await ask("POST", `${session}/url`, { url: new URL("../docs/gallery.html", page).href });
    await picture("gallery-1280", 1280, 4200);
    await ask("POST", `${session}/url`, { url: new URL("../docs/index.html", page).href });
    await picture("book-1280", 1280, 1200);
  },
  async "every link of the site leads to a page and a place on it"() {
    const wrong = brokenLinks(site);
    assert.deepEqual(wrong, []);
  },
  async "nothing was written to the console"() {
    const entries = await ask("POST", `${session}/se/log`, { type: "browser" });
    assert.deepEqual(entries.filter((entry) => entry.level === "SEVERE").map((entry) => entry.message), []);
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
