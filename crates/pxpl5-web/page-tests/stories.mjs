// Tests of the first screen and of the stories.
import assert from "node:assert/strict";
import { FIRST_SCREEN, STORIES, inPs } from "../page/stories.js";
import { csv } from "../page/recording.js";
import { COLOURS, accessible, advanced, alone, ask, cdp, click, drag, emulate, key, later, lit, only, open, page, picture, press, run, session, settled, shownMs, tell, text, until } from "./browser.mjs";

export default {
  async "the first picture comes before seven fields, and within three times the time of a worker without a page"() {
    // The page itself notes when the first picture stands, and what has been simulated and loaded until then.
    const { identifier } = await cdp("Page.addScriptToEvaluateOnNewDocument", { source: `
      new MutationObserver((changes, watch) => {
        const canvas = document.querySelector('#eyes canvas');
        if (!canvas) return;
        watch.disconnect();
        window.first = { ms: performance.now(), ps: Number(document.getElementById('time').dataset.ps), colours: (${COLOURS})(canvas) };
      }).observe(document, { childList: true, subtree: true });` });
    const settings = Object.entries({ ...FIRST_SCREEN.settings, "head.end": "hold" }).map((pair) => pair.join("=")).join("\n");
    const times = [];
    for (let n = 0; n < 3; n += 1) {
      await open();
      const { ms, ps, colours } = await run("return window.first");
      // Seven fields of NTSC, 1001/60000 s each.
      assert.ok(ps > 0 && ps < (7 * 1001e12) / 60000, `${ps / 1e9} ms were simulated before the first picture`);
      assert.ok(colours > 3, `${colours} colours`);
      times.push([ms, (await alone(settings, csv("0,0"), inPs(FIRST_SCREEN.begin))).reduce((sum, one) => sum + one)]);
    }
    await cdp("Page.removeScriptToEvaluateOnNewDocument", { identifier });
    console.log(`   ms of page and of worker: ${times.map((pair) => pair.map(Math.round).join(" and ")).join(", ")}`);
    // Both are measured under the same load. The page itself has twice the time of its worker, for its document, layout and drawing.
    const [ofPage, ofWorker] = [0, 1].map((n) => Math.min(...times.map((pair) => pair[n])));
    assert.ok(ofPage < 3 * ofWorker, `${ofPage} and ${ofWorker} ms`);
  },
  async "the first screen has a moving picture, one sentence and four stories"() {
    await open();
    const before = await run("return document.querySelector('#eyes canvas').toDataURL()");
    await advanced(300);
    assert.notEqual(await run("return document.querySelector('#eyes canvas').toDataURL()"), before, "the picture moves");
    assert.ok((await lit()) > 3);
    // The lag is visible: the wire frame of the world, the age, and the error in pixels.
    assert.ok((await lit("#eyes .over")) > 0);
    await until("age and error", "/^\\d+(\\.\\d+)? ms old, \\d+(\\.\\d)? px off$/.test(document.querySelector('.age').textContent)");
    assert.ok(await run("return document.querySelector('.hand').checkVisibility()"), "a hand says that the picture can be dragged");
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
        if (n === steps.length - 1) {
          await accessible(name);
          assert.match(await text("story-keep"), /^To keep: .*\d/, `${name} ends with a number`);
          console.log(`   ${await text("story-keep")}`);
        }
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
    const told = await run("return [...document.querySelectorAll('.age')].map((age) => [...age.querySelectorAll('strong')].map((number) => parseFloat(number.textContent)))");
    console.log(`   ages and errors: ${told.map(([ms, px]) => `${ms} ms, ${px} px`).join(" and ")}`);
    assert.ok(told.length === 2 && told.every((numbers) => numbers.length === 2));
    assert.ok(told[1][0] < told[0][0] && told[1][1] < told[0][1]);
  },
  async "in the first step of Feel the lag, the hand turns the head of both machines"() {
    await open("#story=lag&step=1");
    await until("the step", "document.documentElement.dataset.story === 'lag 1 begun' && document.getElementById('go').textContent === 'Pause'");
    await drag();
    await advanced(200);
    assert.equal(await run("return document.querySelector('.hand').checkVisibility()"), false, "the hand has been understood");
    await press("#go");
    await press("#to-lab");
    const moved = new URLSearchParams((await run("return document.getElementById('link').hash")).slice(1)).get("motion");
    const width = await run("return document.querySelector('#eyes canvas').clientWidth");
    assert.ok(width > 0 && moved.length > 4);
  },
  async "in the story Turn for free, the step of the head is a step to the right"() {
    await open("#story=turn&step=4");
    await until("the step", "document.documentElement.dataset.story === 'turn 4 paused'", 60000);
    const off = await run("return parseFloat(/([\\d.]+) px/.exec(document.querySelector('.age').textContent)[1])");
    await click("#to-lab");
    await settled();
    await until("the recording", "document.querySelector('#needs a') !== null");
    const rows = (await run("return fetch(document.querySelector('#needs a').href).then((file) => file.text())")).trim().split("\n");
    const right = Number(rows.at(-1).split(",")[1]);
    assert.ok(right > 0.29 && right <= 0.3, `${right} m to the right`);
    console.log(`   ${off} px off after the step`);
    assert.ok(off > 1, "which is not free");
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
  async "in RENDER and COPY the regions that are drawn and copied are marked in two colours, with a legend"() {
    const colours = `
      const data = document.querySelector('#eyes .over').getContext('2d').getImageData(0, 0, 640, 480).data;
      const near = (at, [r, g, b]) => data[at + 3] > 200 && Math.abs(data[at] - r) + Math.abs(data[at + 1] - g) + Math.abs(data[at + 2] - b) < 24;
      const count = [0, 0];
      const stages = ['render', 'copy'].map((stage) => getComputedStyle(document.documentElement).getPropertyValue('--' + stage).trim());
      const parts = stages.map((colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)));
      for (let at = 0; at < data.length; at += 4) parts.forEach((colour, n) => near(at, colour) && (count[n] += 1));
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
    assert.match(await text("region-legend"), /renderer draws.*on its way/s);
    assert.ok(await run("return document.getElementById('region-legend').checkVisibility()"));
  },
};
