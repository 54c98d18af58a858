// Tests of the whole site: its look, its links, its search.
import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync, statSync } from "node:fs";
import { dirname, join } from "node:path";
import { accessible, advanced, ask, emulate, later, open, page, picture, press, run, session, settled, site, text, until } from "./browser.mjs";

export default {
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
    // Pictures of the book, in docs/pictures.
    for (const [name, story, step, width, height] of [["live-lag", "lag", 3, 1000, 594], ["live-inside", "inside", 4, 1240, 900]]) {
      await open(`#story=${story}&step=${step}`);
      await until("the step", `document.documentElement.dataset.story === '${story} ${step} paused'`, 60000);
      await picture(name, width, height);
    }
    await open();
    await advanced(700);
    await picture("live-start", 1000, 620);
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
  assert.ok(files.length > 20, `${files.length} pages`);
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
