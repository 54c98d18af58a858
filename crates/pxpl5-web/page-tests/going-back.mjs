// Tests of going back in a run, and of the memory.
import assert from "node:assert/strict";
import { Checkpoints } from "../page/checkpoints.js";
import { open, press, run, settled, shownMs, text, until } from "./browser.mjs";

export default {
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
      if (checkpoints.take(now, step)) images.set(now, new Uint8Array(memory.buffer.slice(0)));
      assert.ok(checkpoints.bytes <= limits.bytes && checkpoints.all.length <= limits.count);
      if (random(40) > 0) continue;
      const to = now - random(60);
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
    // Each page that grew after a checkpoint is lost once, however often the run returns to this checkpoint.
    const grown = new Checkpoints(new WebAssembly.Memory({ initial: 1 }), { ...limits, every: 1000, lost: 3 * 65536 });
    grown.take(0, "begin");
    for (let lost = 1; lost <= 3; lost += 1) {
      grown.memory.grow(1);
      assert.equal(grown.back(5).at, 0);
      assert.equal(grown.lost, lost * 65536);
    }
    grown.memory.grow(1);
    assert.equal(grown.back(5), null);
    // A checkpoint is taken when the memory has grown, and a return to it loses nothing more.
    assert.ok(grown.take(7, "grown") && !grown.take(8, "same size"));
    assert.equal(grown.back(9).at, 7);
    assert.equal(grown.lost, 3 * 65536);
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
      // Forth from there it is the same run too, and so it is in a page that never went back.
      for (let n = 1; n <= fields; n += 1) {
        await press('[data-step="field"]');
        assert.equal(await look(), seen[n], `${hash}, forth again by ${n}`);
      }
      await press("#rewind");
      assert.equal(await shownMs(), 0);
      await open(`#${hash}&at=3700000000000`);
      await press('[data-step="field"]');
      assert.equal(await look(), seen[0]);
      console.log(`   ${hash.split("&")[0]}: ${fields} steps back, memory ${await text("bytes")}`);
    }
  },
  async "a step back after a long run is short, and the memory is bounded"() {
    await open("#pipeline=slats&scene=aircraft&fields=1000000&at=120000000000000", 240000);
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
};
