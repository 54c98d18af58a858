// Tests of the page in a headless Chromium, driven by chromedriver: node run.mjs SITE PICTURES.
// Each test says what it claims; what was measured is printed. Pictures at 390, 1280 and 2560 pixels are for somebody to look at.
import { spawn, spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { extname, join, normalize } from "node:path";
import assert from "node:assert/strict";

const [site, pictures] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
const KINDS = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, "http://x").pathname);
  try {
    const name = path === "/" ? "index.html" : path;
    const bytes = readFileSync(join(site, name));
    response.writeHead(200, { "content-type": KINDS[extname(name)] ?? "application/octet-stream" }).end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const page = `http://127.0.0.1:${server.address().port}/`;

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

async function open(hash = "") {
  await ask("POST", `${session}/url`, { url: "about:blank" });
  await ask("POST", `${session}/url`, { url: page + hash });
  return until("the page", "document.documentElement.dataset.ready === 'true'");
}

const text = (id) => run(`return document.getElementById('${id}').textContent`);
const click = (selector) => run(`document.querySelector('${selector}').click()`);
/** Colours other than black before the first eye. */
const lit = () => run(`
  const canvas = document.querySelector('#eyes canvas');
  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
  colours.delete(0);
  return colours.size;`);

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

/** What the command prints as the hash of an experiment's trace at an instant. */
function hashOfTheCommand(command) {
  const program = process.env.PXPL5 ?? "target/debug/pxpl5";
  const parts = command.split('"').flatMap((part, n) => (n % 2 ? [part] : part.trim().split(/\s+/).filter(Boolean)));
  const { stdout, error } = spawnSync(program, parts.slice(1), { encoding: "utf8" });
  if (error) return null;
  return /^trace {3}(\S+)$/m.exec(stdout)?.[1];
}

const TESTS = {
  async "the page opens with a machine that stands at the begin"() {
    console.log(`   ready after ${await open()} ms`);
    assert.equal(await text("time"), "0.000000 ms");
    assert.ok((await run("return document.querySelectorAll('#processors button').length")) >= 2);
    assert.equal(await run("return document.querySelectorAll('#ring li').length"), 8);
  },
  async "steps go on by a field, a line and an event"() {
    await open();
    await click('[data-step="field"]');
    assert.equal(await text("field"), "1 of 120");
    // A field of NTSC takes 1001/60000 s.
    assert.equal(await text("time"), "16.683333 ms");
    await click('[data-step="line"]');
    assert.equal(await text("line"), "1");
    const before = await text("hash");
    for (let n = 0; n < 200; n += 1) await click('[data-step="event"]');
    assert.notEqual(await text("hash"), before);
  },
  async "a run goes on by itself, slower when it shall, and stands when it is paused"() {
    await open("#pipeline=slats&scene=aircraft&fields=1000");
    await run("const s = document.getElementById('slower'); s.value = 0; s.dispatchEvent(new Event('input'))");
    await click("#go");
    await later(3000);
    await click("#go");
    const reached = parseFloat(await text("time"));
    console.log(`   aircraft under Slats, both eyes drawn: ${(reached / 3000).toFixed(2)} of real time`);
    assert.ok(reached > 100);
    const stands = await text("time");
    await later(300);
    assert.equal(await text("time"), stands);
    assert.ok((await lit()) > 3, "the aircraft is seen");
  },
  async "every pipeline shows something, on its display"() {
    await open();
    const names = await run("return [...document.querySelectorAll('[name=pipeline] option')].map((option) => option.value)");
    for (const name of names) {
      const display = name.startsWith("arp") ? "arp" : "ntsc";
      await open(`#pipeline=${name}&scene=full-screen:2&display=${display}&fields=60&at=300000000000`);
      assert.equal(await run("return document.getElementById('error').hidden"), true, `${name}: ${await text("error")}`);
      const colours = await lit();
      assert.ok(colours > 0, `${name}: all is black`);
    }
    console.log(`   ${names.length} pipelines`);
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
    await click("#processors button:nth-child(2)");
    assert.equal(await text("board-name"), "GP 0");
    assert.match(await text("board"), /CPU busy/);
  },
  async "the link builds the same run, and the command has the same trace hash"() {
    await open("#pipeline=slats&scene=aircraft&fields=20");
    for (let n = 0; n < 5; n += 1) await click('[data-step="field"]');
    const [hash, command, link] = [await text("hash"), await text("command"), await run("return document.getElementById('link').hash")];
    await open(link);
    assert.equal(await text("hash"), hash);
    const found = hashOfTheCommand(command);
    console.log(found === null ? "   the command is not built: its hash was not compared" : `   ${command}\n   trace ${found}`);
    if (found !== null) assert.equal(found, hash);
  },
  async "it fits 390, 1280 and 2560 pixels, light and dark"() {
    await open("#pipeline=slats&scene=aircraft&fields=20&at=60000000000");
    await click("#processors button:nth-child(2)");
    for (const width of [390, 1280, 2560]) await picture(`page-${width}`, width);
    await ask("POST", `${session}/goog/cdp/execute`, {
      cmd: "Emulation.setEmulatedMedia", params: { features: [{ name: "prefers-color-scheme", value: "dark" }] },
    });
    await picture("page-dark-1280", 1280);
  },
  async "nothing was written to the console"() {
    const entries = await ask("POST", `${session}/se/log`, { type: "browser" });
    assert.deepEqual(entries.filter((entry) => entry.level === "SEVERE").map((entry) => entry.message), []);
  },
};

let failed = 0;
for (const [claim, test] of Object.entries(TESTS)) {
  try {
    await test();
    console.log(`ok    ${claim}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${claim}\n${error.stack}`);
  }
}
await ask("DELETE", session);
driver.kill();
server.close();
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
