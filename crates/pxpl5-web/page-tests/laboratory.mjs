// Tests of what the laboratory shows.
import assert from "node:assert/strict";
import { accessible, advanced, alone, click, key, later, lit, open, otherPixels, press, run, sameHash, set, settled, shareOfACore, shownMs, speed, text, until } from "./browser.mjs";

export default {
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
  async "the map of busy renderers has the shares of the table, and error and speed of the head are beside each other"() {
    await open("#pipeline=rendering-control&scene=aircraft&fields=600&head.motion=sine:20:0.5&head.tracker=ideal&head.predict=none&at=95000000000");
    // The map begins at time zero here, as the table does. The table has whole percents.
    const [executing, copying] = await run("const { executing, copying } = document.querySelector('#busy canvas').dataset; return [executing, copying].map((share) => 100 * share)");
    const row = await run("return [...document.querySelectorAll('#limits tr')].find((one) => one.firstChild.textContent === 'Renderers').textContent");
    console.log(`   map: ${executing.toFixed(2)} % executing, ${copying.toFixed(2)} % copying; table: ${row}`);
    assert.ok(executing > 1 && Math.abs(executing - parseFloat(/Renderers([\d.]+) %/.exec(row)[1])) <= 0.51);
    assert.ok(copying > 1 && Math.abs(copying - parseFloat(/copying ([\d.]+) %/.exec(row)[1])) <= 0.51);
    assert.ok((await lit("#limits .loads canvas")) > 3, "regions with different loads");
    assert.ok(await run("return document.getElementById('busy').lastChild.hidden"), "one instant is no curve");
    for (let n = 0; n < 20; n += 1) await press('[data-step="field"]');
    assert.ok(!(await run("return document.getElementById('busy').lastChild.hidden")));
    const [{ px, speed }, age] = await run("return [{ ...document.getElementById('busy').lastChild.firstChild.dataset }, document.querySelector('.age').textContent]");
    // A sine of 20 degrees and 0.5 Hz turns by at most 20 pi degrees a second.
    const turns = 20 * Math.PI * Math.abs(Math.cos((Math.PI * (await shownMs())) / 1000));
    console.log(`   curves end at ${px} px and ${speed} degrees a second; shown: ${age}; of the sine: ${turns.toFixed(2)}`);
    assert.ok(turns > 1 && Math.abs(speed - turns) < 0.01);
    assert.ok(Math.abs(px - parseFloat(/, ([\d.]+) px off/.exec(age)[1])) <= 0.5);
    await accessible("busy renderers");
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
    assert.ok((await lit()) > 3, "the aircraft is seen");
    const stands = await shownMs();
    // The last messages have crossed the diagram then.
    await later(1500);
    assert.equal(await shownMs(), stands);
    const idle = await shareOfACore(10);
    await click("#go");
    const busy = await shareOfACore(5);
    await press("#go");
    console.log(`   paused: ${(100 * idle).toFixed(1)} % of a core, running: ${(100 * busy).toFixed(1)} %`);
    assert.ok(idle <= busy / 5);
    await set("slower", 3);
    const slow = await speed(2);
    assert.ok(slow > 0.0005 && slow < 0.0015, `a thousandth of real time, ${slow}`);
    const [, , ms] = await alone("pipeline=slats\nscene=aircraft\nfields=36000", "", 6e12);
    console.log(`   aircraft under Slats, both eyes drawn: ${share.toFixed(2)} of real time, and ${(6000 / ms).toFixed(2)} without a page`);
    assert.ok(share > 0.25 * Math.min(1, 6000 / ms), "at least a quarter of the speed without a page, and a page does not go faster than real time");
  },
  async "Rendering Control runs the Mig at the transaction level"() {
    await open("#pipeline=rendering-control&scene=mig&fields=36000");
    await click("#go");
    await advanced(600);
    await press("#go");
    assert.ok((await lit()) > 3, "the Mig is seen");
    assert.match(await text("latency"), /render/i);
  },
  async "pictures are those of the command, pixel by pixel, though the browser has other vector instructions"() {
    for (const hash of ["pipeline=rendering-control&scene=mig", "pipeline=slats&scene=aircraft", "pipeline=rendering-control&scene=molecules&triangles=300"]) {
      await open(`#${hash}&fields=60&head.motion=sine:10:0.5&at=700000000000`);
      assert.equal(await text("error"), "");
      const colours = await lit();
      console.log(`   ${hash}: ${colours} colours`);
      assert.ok(colours > 3);
      assert.deepEqual(await otherPixels(), [true, 0]);
    }
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
    // A worker of its own draws the volume, so the main worker does not show when a view is drawn.
    await run("window.firstView = document.getElementById('volume-picture').toDataURL()");
    assert.ok((await lit("#volume-picture")) > 3);
    await set("azimuth", 120);
    await until("another view", "document.getElementById('volume-picture').toDataURL() !== window.firstView");
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
};
