// Tests of latency that is felt: added latency, a lecture's full screen, a headset, a phone in a holder.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { orientationOf } from "../page/sensor.js";
import { accessible, advanced, ask, cdp, click, key, later, open, pictures, press, run, sameHash, session, set, settled, shownMs, text, until } from "./browser.mjs";

/** Ages in milliseconds and errors in pixels, as they are shown beside the machines. */
const shown = () => run(`return [...document.querySelectorAll('.age')].map((age) => [...age.querySelectorAll('strong')].map((number) => parseFloat(number.textContent)))`);

const screenOf = (width, height, more = {}) => cdp("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false, ...more });

/** The recording of the live head so far: rows of time, position and orientation. */
async function recorded() {
  await until("the recording", "document.querySelector('#needs a') !== null");
  const rows = (await run("return fetch(document.querySelector('#needs a').href).then((file) => file.text())")).trim().split("\n").slice(1);
  return rows.map((row) => row.split(",").map(Number));
}

/** A picture of the window, for the eyes of a reader. */
async function snapshot(name) {
  const { data } = await cdp("Page.captureScreenshot", {});
  writeFileSync(join(pictures, `${name}.png`), Buffer.from(data, "base64"));
  return data;
}

/** The colours of the first eye in a grid of 16 x 12 points. */
const GRID = `(canvas) => {
  const context = document.createElement('canvas').getContext('2d');
  Object.assign(context.canvas, { width: canvas.width, height: canvas.height });
  context.drawImage(canvas, 0, 0);
  const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
  return Array.from({ length: 192 }, (_, n) => {
    const at = 4 * (Math.floor(((n >> 4) + 0.5) * canvas.height / 12) * canvas.width + Math.floor(((n % 16) + 0.5) * canvas.width / 16));
    return [data[at], data[at + 1], data[at + 2]];
  });
}`;
/** Mean difference of two grids, in units of 1/255 of full brightness. */
const apart = (a, b) => a.flatMap((colour, n) => colour.map((part, k) => Math.abs(part - b[n][k]))).reduce((sum, one) => sum + one, 0) / (3 * a.length);

export default {
  async "the slider adds latency to every pipeline, in milliseconds and in pixels, and the command adds the same"() {
    const settings = "beside=rendering-control&scene=gallery&triangles=100&fields=600&head.motion=pan:20&head.tracker=ideal&head.predict=none";
    const found = [];
    for (const added of [0, 100]) {
      await open(`#pipeline=slats&${settings}${added ? `&head.added_latency=${added}` : ""}&at=500000000000`);
      assert.equal(await text("added-says"), `+${added} ms`);
      found.push(await shown());
    }
    console.log(`   ms and px without and with 100 ms more: ${JSON.stringify(found)}`);
    const focal = 320 / Math.tan(Math.PI / 6);
    for (const n of [0, 1]) {
      const [[age, px], [older, farther]] = [found[0][n], found[1][n]];
      assert.ok(Math.abs(older - age - 100) < 0.6, "100 ms older");
      // A head that turns by 20 degrees a second turns by 2 degrees in 100 ms. In the middle, that is as many pixels as the tangent says.
      const more = focal * (Math.tan((px / focal) + Math.PI / 90) - Math.tan(px / focal));
      assert.ok(Math.abs(farther - px - more) < 0.06 * more + 1.5, `${farther - px} px more, expected ${more}`);
    }
    await sameHash(".");
    await set("added", 50);
    await until("the new machines", "location.hash.includes('head.added_latency=50')");
    await settled();
    assert.ok(Math.abs((await shown())[0][0] - found[0][0][0] - 50) < 17, "about 50 ms older, at another instant of a field");
    await accessible("added latency");
  },
  async "in a lecture the pictures fill the screen, numbers and page keys change the step, and each step has a link"() {
    await screenOf(1920, 1080);
    await open("#story=lag&step=3&lecture");
    await until("the step", "document.documentElement.dataset.story === 'lag 3 paused'", 60000);
    const box = () => run("return [...document.querySelectorAll('#eyes .screen')].filter((one) => one.checkVisibility()).map((one) => { const b = one.getBoundingClientRect(); return [b.width, b.height, b.bottom] })");
    const both = await box();
    console.log(`   two pictures at 1920 x 1080: ${both.map(([w, h]) => `${Math.round(w)} x ${Math.round(h)}`).join(" and ")}`);
    // Before, they had 553 x 415.
    assert.ok(both.length === 2 && both.every(([width, height, bottom]) => width > 800 && height > 600 && bottom <= 1080));
    await snapshot("lecture-lag");
    assert.match(await run("return document.querySelector('#story-dots li:nth-child(2) a').href"), /#story=lag&step=2&lecture$/);
    await key("2");
    await until("step 2", "document.documentElement.dataset.story === 'lag 2 paused'", 60000);
    assert.equal(await run("return location.hash"), "#story=lag&step=2&lecture");
    await key("\uE00F");
    await until("step 3", "document.documentElement.dataset.story.startsWith('lag 3')", 60000);
    await key("\uE00E");
    await until("step 2", "document.documentElement.dataset.story.startsWith('lag 2')", 60000);
    await open("#story=inside&step=4&lecture");
    await until("the step", "document.documentElement.dataset.story === 'inside 4 paused'", 60000);
    const [one] = await box();
    const ring = await run("const b = document.getElementById('diagram').getBoundingClientRect(); return [b.width, b.bottom]");
    assert.ok(one[0] > 700 && ring[0] > 900 && ring[1] <= 1080 && one[2] <= 1080, `${one}, ${ring}`);
    await snapshot("lecture-inside");
    await open("#story=race&step=1&lecture");
    await until("the step", "document.documentElement.dataset.story === 'race 1 paused'", 60000);
    const [alone] = await box();
    assert.ok(alone[0] > 1100 && alone[2] <= 1080, `${alone}`);
    await snapshot("lecture-race");
    // The last steps have the most text: a number to keep, and parts of the latency.
    for (const [story, last] of [["lag", 5], ["inside", 6], ["race", 5], ["turn", 4]]) {
      await open(`#story=${story}&step=${last}&lecture`);
      await until("the step", `document.documentElement.dataset.story === '${story} ${last} paused'`, 60000);
      await snapshot(`lecture-${story}-${last}`);
      const over = await run("return document.documentElement.scrollHeight - innerHeight");
      assert.ok(over <= 0, `${story} ${last} is ${over} pixels higher than the screen`);
    }
    await accessible("lecture mode");
    await run("document.activeElement.blur()");
    await key("f");
    await until("the usual page", "!document.body.classList.contains('lecture')");
    await cdp("Emulation.clearDeviceMetricsOverride");
  },
  async "on a telephone on its side and on a wide screen, the pictures fit"() {
    await screenOf(844, 390);
    await open("#story=lag&step=3");
    await until("the step", "document.documentElement.dataset.story === 'lag 3 paused'", 60000);
    const fits = () => run("return [...document.querySelectorAll('#eyes .screen')].filter((one) => one.checkVisibility()).every((one) => one.getBoundingClientRect().bottom <= innerHeight)");
    assert.ok(await fits());
    await open("#story=turn&step=3");
    await until("the step", "document.documentElement.dataset.story === 'turn 3 paused'", 60000);
    assert.ok(await fits());
    await open();
    await later(500);
    assert.ok(await fits());
    await screenOf(2560, 1300);
    await open("#pipeline=slats&fields=60&at=300000000000");
    const [left, right] = await run("return [...document.querySelectorAll('#eyes .screen')].map((one) => { const b = one.getBoundingClientRect(); return [b.left, b.right, b.bottom] })");
    assert.ok(right[0] - left[1] <= 16 && left[1] - left[0] > 800, `${left}, ${right}`);
    await screenOf(1280, 900);
    await open("#story=inside&step=4");
    await until("the step", "document.documentElement.dataset.story === 'inside 4 paused'", 60000);
    assert.ok((await run("return document.getElementById('diagram').getBoundingClientRect().bottom")) <= 900, "the ring is on the screen");
    const covered = await run(`const all = [...document.querySelectorAll('#diagram .block')].map((block) => block.getBoundingClientRect());
      return all.filter((one, n) => all.some((other, k) => k > n && one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom)).length`);
    assert.equal(covered, 0, "no board covers another");
    // In this step, renderers execute commands and copy pixels at the same time.
    assert.ok((await run("return document.querySelectorAll('#diagram .block.renderer.render.copy').length")) > 0);
    assert.match(await run("return document.querySelector('#diagram .block.render.copy .does').textContent"), /^RENDER COPY$/);
    await cdp("Emulation.clearDeviceMetricsOverride");
  },
  async "a headset shows the machine's pictures, late, and the edges of the world at once"() {
    const { identifier } = await cdp("Page.addScriptToEvaluateOnNewDocument", { source: `${readFileSync(process.env.IWER, "utf8")};
      window.device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
      device.installRuntime({ forceInstall: true });
      device.position.set(0, 1.6, 0);
      // Tests read the projection of the eyes, and play an event of a controller.
      const viewer = XRFrame.prototype.getViewerPose;
      XRFrame.prototype.getViewerPose = function (space) { return (window.viewer = viewer.call(this, space)); };
      const request = navigator.xr.requestSession;
      navigator.xr.requestSession = async function (...given) { return (window.xrSession = await request.apply(this, given)); };` });
    await screenOf(1280, 640);
    const link = "#pipeline=rendering-control&scene=gallery&fields=3600&head.motion=live.csv&head.tracker=ideal&head.predict=none";
    await open(link);
    assert.ok(await run("return !document.getElementById('headset').hidden"));
    await click("#headset");
    await until("the session", "document.getElementById('headset').textContent === 'Leave VR' && document.getElementById('go').textContent === 'Pause'");
    await advanced(300);
    const wire = () => run("window.xrSession.dispatchEvent(new Event('select'))");
    const eye = () => run(`return (${GRID})(document.querySelector('#eyes canvas'))`);
    /** The grid of the picture in the left half of the window, where the projection of the eye puts a picture of 60 by 46.8 degrees. */
    const inHeadset = async (name) => {
      // The second frame shows all that was set before, and then the window shows it.
      await ask("POST", `${session}/execute/async`, { args: [], script: "const [done] = arguments; const { xrSession: one } = window; one.requestAnimationFrame(() => one.requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))" });
      const shot = await snapshot(name);
      return ask("POST", `${session}/execute/async`, { args: [shot], script: `const [shot, done] = arguments;
        const image = new Image();
        image.onload = () => {
          const project = window.viewer.views[0].projectionMatrix;
          const half = Math.tan(Math.PI / 6);
          const [x, y] = [image.width / 4 * (1 + project[8] * -1), image.height / 2 * (1 - project[9] * -1)];
          const [wide, high] = [project[0] * half * image.width / 4, project[5] * half * 0.75 * image.height / 2];
          const canvas = Object.assign(document.createElement('canvas'), { width: 640, height: 480 });
          canvas.getContext('2d').drawImage(image, x - wide, y - high, 2 * wide, 2 * high, 0, 0, 640, 480);
          const all = Object.assign(document.createElement('canvas'), { width: image.width / 2, height: image.height });
          all.getContext('2d').drawImage(image, 0, 0);
          const data = all.getContext('2d').getImageData(0, 0, all.width, all.height).data;
          const yellow = [];
          for (let at = 0; at < data.length; at += 4) if (data[at] > 200 && Math.abs(data[at + 1] - 196) < 30 && data[at + 2] < 100) yellow.push(at / 4);
          done({ grid: (${GRID})(canvas), yellow });
        };
        image.src = 'data:image/png;base64,' + shot;` });
    };
    // At rest, the headset shows what the machine shows, at the size of its display.
    await press("#go");
    await wire();
    const rest = await eye();
    const shown = await inHeadset("headset-rest");
    console.log(`   at rest, the headset's left picture differs from the machine's by ${apart(rest, shown.grid).toFixed(2)} of 255 in the mean`);
    assert.ok(apart(rest, shown.grid) < 6);
    assert.equal(shown.yellow.length, 0, "the trigger hides the edges");
    await wire();
    const edges = await inHeadset("headset-edges");
    assert.ok(edges.yellow.length > 300, `${edges.yellow.length} yellow points`);
    // While the machine stands, the headset turns by 20 degrees to the left: the edges follow at once, and the picture does not.
    const q = [Math.cos(Math.PI / 18), Math.sin(Math.PI / 18)];
    await run(`device.quaternion.set(0, ${q[1]}, 0, ${q[0]})`);
    const turning = await inHeadset("headset-turning");
    assert.ok(apart(rest, await eye()) === 0);
    const stayed = new Set(edges.yellow);
    assert.ok(turning.yellow.filter((at) => stayed.has(at)).length < turning.yellow.length / 2, "the edges have moved");
    // The machine goes on, and its picture follows.
    await click("#go");
    await advanced(500);
    await press("#go");
    const after = await eye();
    await wire();
    const turned = await inHeadset("headset-turned");
    assert.ok(apart(after, turned.grid) < 6 && apart(rest, after) > 5, "the picture has followed");
    await click("#headset");
    await until("the end", "document.getElementById('headset').textContent === 'Enter VR'");
    await settled();
    const last = (await recorded()).at(-1);
    [0, 0, 0, q[0], 0, q[1], 0].forEach((part, n) => assert.ok(Math.abs(last[n + 1] - part) < 1e-3, `${last}`));
    // The same turn by keys, in a page without a headset: ten times two degrees.
    await cdp("Page.removeScriptToEvaluateOnNewDocument", { identifier });
    await open(link);
    await run("document.querySelector('#eyes canvas').focus()");
    for (let n = 0; n < 10; n += 1) await key("\uE012");
    for (let n = 0; n < 20; n += 1) await press('[data-step="field"]');
    const same = await eye();
    console.log(`   mean difference to the same turn by keys: ${apart(after, same).toFixed(2)}, to the picture before: ${apart(rest, after).toFixed(2)} of 255`);
    assert.ok(apart(after, same) < 1);
    await cdp("Emulation.clearDeviceMetricsOverride");
  },
  async "the angles of a sensor become the direction of the view, on all three axes and with the screen on its side"() {
    // The rotation matrix of the specification of the event (Z, X', Y''), with rows east, north and up.
    const matrix = ({ alpha, beta, gamma }) => {
      const [a, b, g] = [alpha, beta, gamma].map((angle) => (angle * Math.PI) / 180);
      const [cA, sA, cB, sB, cG, sG] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b), Math.cos(g), Math.sin(g)];
      return [[cA * cG - sA * sB * sG, -cB * sA, cA * sG + cG * sA * sB], [cG * sA + cA * sB * sG, cA * cB, sA * sG - cA * cG * sB], [-cB * sG, sB, cB * cG]];
    };
    const turned = ([w, x, y, z], [a, b, c]) => {
      const [tx, ty, tz] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
      return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
    };
    for (const angles of [{ alpha: 0, beta: 90, gamma: 0 }, { alpha: 30, beta: 70, gamma: 10 }, { alpha: 200, beta: -20, gamma: -80 }, { alpha: 350, beta: 5, gamma: 60 }]) {
      for (const screen of [0, 90, 180, 270]) {
        const m = matrix(angles);
        const s = (screen * Math.PI) / 180;
        // Right, up and ahead of the screen in the axes of the device, then of the world; the head's y is up, and its z is to the south.
        const axes = [[[1, 0, 0], [Math.cos(s), -Math.sin(s), 0]], [[0, 1, 0], [Math.sin(s), Math.cos(s), 0]], [[0, 0, -1], [0, 0, -1]]];
        for (const [ofHead, ofDevice] of axes) {
          const [east, north, up] = m.map((row) => row.reduce((sum, part, k) => sum + part * ofDevice[k], 0));
          turned(orientationOf(angles, screen), ofHead).forEach((part, k) => assert.ok(Math.abs(part - [east, up, -north][k]) < 1e-9, `${JSON.stringify(angles)} ${screen}`));
        }
      }
    }
  },
  async "a phone in a holder shows both eyes side by side, and its sensor turns the head; Centre and Off work"() {
    await screenOf(844, 390, { mobile: true, screenOrientation: { type: "landscapePrimary", angle: 90 } });
    await cdp("Emulation.setTouchEmulationEnabled", { enabled: true });
    const turn = (alpha, beta, gamma) => cdp("DeviceOrientation.setDeviceOrientationOverride", { alpha, beta, gamma });
    // Upright on its side, the screen of a phone has a gamma of -90 degrees.
    await turn(40, 0, -90);
    await open("#pipeline=slats&scene=gallery&fields=3600&head.motion=live.csv&head.tracker=ideal&head.predict=none");
    assert.ok(await run("return !document.getElementById('hold').hidden && isSecureContext"));
    await click("#hold");
    await until("the run", "document.body.classList.contains('held') && document.getElementById('go').textContent === 'Pause'");
    await turn(41, 0, -90);
    await advanced(300);
    const screens = await run("return [...document.querySelectorAll('#eyes .screen')].map((one) => { const b = one.getBoundingClientRect(); return [b.left, b.right, b.top, b.bottom] })");
    console.log(`   eyes at ${JSON.stringify(screens)} of 844 x 390`);
    assert.ok(screens.length === 2 && screens[0][1] <= 422.5 && screens[1][0] >= 421.5 && screens.every(([left, right, top, bottom]) => right - left > 400 && top >= 0 && bottom <= 390));
    await snapshot("holder");
    for (const alpha of [43, 46, 49]) {
      await turn(alpha, 0, -90);
      await advanced(100);
    }
    await click("#held-off");
    await settled();
    const yaw = ([, , , , w, x, y, z]) => (Math.atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y)) * 180) / Math.PI;
    const rows = await recorded();
    console.log(`   turned by ${yaw(rows.at(-1)).toFixed(2)} degrees, from a first report of ${yaw(rows.find(([, , , , w]) => w !== 1) ?? rows[0]).toFixed(2)}`);
    assert.ok(Math.abs(yaw(rows.at(-1)) - 9) < 0.05 || Math.abs(yaw(rows.at(-1)) - 8) < 0.05, "49 - 40 or 41 degrees to the left");
    assert.equal(await run("return document.body.classList.contains('held')"), false);
    const stood = await shownMs();
    await later(300);
    assert.equal(await shownMs(), stood, "off");
    await click("#hold");
    await until("the run", "document.body.classList.contains('held') && document.getElementById('go').textContent === 'Pause'");
    await turn(80, 0, -80);
    await advanced(100);
    await click("#held-centre");
    await turn(90, 0, -80);
    await advanced(100);
    await turn(100, 0, -80);
    await advanced(100);
    await click("#held-off");
    await settled();
    const level = (await recorded()).at(-1);
    assert.ok(Math.abs(yaw(level) - 10) < 0.05, `${yaw(level)} degrees after the centre`);
    await cdp("DeviceOrientation.clearDeviceOrientationOverride");
    await cdp("Emulation.setTouchEmulationEnabled", { enabled: false });
    await cdp("Emulation.clearDeviceMetricsOverride");
  },
};
