// Tests of the page in a headless Chromium, driven by chromedriver: node run.mjs SITE PICTURES [PART OF A CLAIM].
// Each test says what it claims; what was measured is printed. Pictures at 390, 1280 and 2560 pixels are to be looked at. AXE is
// the path of axe.min.js of the package axe-core, and IWER the path of iwer.min.js of the package iwer, which emulates a headset.
import { ask, driver, only, server, session } from "./browser.mjs";
import felt from "./felt.mjs";
import goingBack from "./going-back.mjs";
import laboratory from "./laboratory.mjs";
import site from "./site.mjs";
import stories from "./stories.mjs";
import visitor from "./visitor.mjs";

const TESTS = { ...stories, ...visitor, ...felt, ...goingBack, ...laboratory, ...site };

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
