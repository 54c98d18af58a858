// The limits of a run: the waits of the last pictures, the use of the boards, and the number of primitives that the machine can show.
import { canvasOf, inMs, make, nameOf } from "./draw.js";

/** Returns a share of 0 to 1 as text. A share that was not measured is a dash. */
export const percent = (share) => (typeof share === "number" && Number.isFinite(share) ? `${(100 * share).toFixed(share > 0 && share < 0.01 ? 1 : 0)} %` : "-");

const capital = (text) => text[0].toUpperCase() + text.slice(1);

/** Returns a row for each kind of board: name, share of busy time, and details. */
function busyRows({ host, gps, renderers, ring, ports }) {
  const idle = ({ idle: count }) => (count > 0 ? `, ${count} idle` : "");
  const most = (kind, shares) => `busiest: ${kind} ${shares.busiest} with ${percent(shares.max)}${idle(shares)}`;
  const millions = (rate) => (rate / 1e6).toFixed(rate < 1e7 ? 1 : 0);
  return [
    ["Host", host, ""],
    ["Graphics processors", gps.busy.mean, `${most("GP", gps.busy)}; on average EDIT and TRANSFORM ${percent(gps.work)}, messages ${percent(gps.messages)}, tokens ${percent(gps.tokens)}`],
    ["Renderers", renderers.executing.mean, `${most("renderer", renderers.executing)}; on average copying ${percent(renderers.copying)}, waiting for commands ${percent(renderers.waiting)}`],
    ["Ring", ring.channels.mean, `${most("channel", ring.channels)}; ${millions(ring.words_per_second)} of ${millions(ring.capacity)} million words a second`],
    ...ports.each.map(({ port, busy }) => [`Port: ${port}`, busy, ""]),
  ];
}

function pathPart(path) {
  if (!path) return [make("p", { textContent: "No complete picture has been shown yet, so there are no waits to show." })];
  const bar = make("div", { className: "stack" }, ...path.parts.map(({ what, share }, n) => {
    const piece = make("i", { className: `share${n}`, title: `${what}: ${percent(share)}` });
    piece.style.width = `${100 * share}%`;
    return piece;
  }));
  const rows = path.parts.map(({ what, share, ms, board }, n) => make("tr", {},
    make("th", { scope: "row" }, make("i", { className: `share${n}` }), capital(what)),
    make("td", { textContent: percent(share) }), make("td", { textContent: inMs(ms) }), make("td", { className: "text", textContent: board ? `mostly ${board}` : "" })));
  const head = make("thead", {}, make("tr", {}, ...["Wait", "Share", "Time", "Board"].map((textContent) => make("th", { scope: "col", textContent }))));
  return [
    make("p", {}, make("strong", { textContent: "Limited by " }), `${path.limited_by}.`), bar,
    make("table", {}, make("caption", { textContent: `Waits of the last ${path.pictures} pictures, ${inMs(path.latency_ms)} on average from TRANSFORM to the screen` }), head, make("tbody", {}, ...rows)),
  ];
}

function busyPart(utilisation) {
  if (!utilisation) return [make("p", { textContent: "No time has passed yet." })];
  const rows = busyRows(utilisation).map(([name, share, more]) => make("tr", {},
    make("th", { scope: "row", textContent: name }), make("td", {}, percent(share)), make("td", { className: "text", textContent: more })));
  const head = make("thead", {}, make("tr", {}, ...["Board", "Busy", "Details"].map((textContent) => make("th", { scope: "col", textContent }))));
  return [make("table", {}, make("caption", { textContent: "Share of the time since the start for which boards were busy" }), head, make("tbody", {}, ...rows))];
}

/** Draws the mean time that renderers needed for each region of the first eye. `regions` are those of the last pictures. A renderer must
 *  draw one region after the other: one that holds several regions at once, as in Slats, has all of its time in the region that it copies first. */
function regionLoads(regions) {
  const loads = new Map();
  for (const { region: { surface, rectangle, lines }, executed_us: us } of regions) {
    if (surface !== 0) continue;
    const key = `${rectangle} ${lines}`;
    const load = loads.get(key) ?? { rectangle, lines, us: 0, n: 0 };
    loads.set(key, { ...load, us: load.us + us, n: load.n + 1 });
  }
  const all = [...loads.values()].map((load) => ({ ...load, us: load.us / load.n }));
  if (all.length === 0) return [];
  const most = Math.max(...all.map(({ us }) => us));
  const mean = all.reduce((sum, { us }) => sum + us, 0) / all.length;
  const [wide, high] = [0, 1].map((axis) => Math.max(...all.map(({ rectangle: box, lines }) => (axis ? (box[1] + box[3]) * lines[1] : box[0] + box[2]))));
  const canvas = canvasOf(wide, high, `Load of the regions of the left eye: ${mean.toFixed(0)} microseconds in the mean, at most ${most.toFixed(0)}`);
  const context = canvas.getContext("2d");
  Object.assign(context, { font: "600 22px system-ui, sans-serif", textAlign: "center", textBaseline: "middle" });
  for (const { rectangle: [x, top, width, height], lines: [first, step], us } of all) {
    // The regions of two fields cover the same place, so each has one half of it.
    const [left, y, across, down] = step === 1 ? [x, top, width, height] : [x + (first * width) / 2, top * 2, width / 2, height * 2];
    context.fillStyle = `rgb(${[232, 151, 58].map((part) => Math.round(255 - (255 - part) * (us / most)))})`;
    context.fillRect(left, y, across, down);
    context.strokeRect(left, y, across, down);
    context.fillStyle = "#111";
    if (across >= 50 && down >= 30) context.fillText(us < 10 ? us.toFixed(1) : us.toFixed(0), left + across / 2, y + down / 2);
  }
  const about = `Load of the regions: microseconds of a renderer for each region of the left eye, as a mean over the last pictures. The heaviest has ${(most / mean).toFixed(1)} times the mean.`;
  return [make("figure", { className: "loads" }, canvas, make("figcaption", { textContent: about }))];
}

/** Shows the waits of the last pictures, the use of the boards and the load of the regions, for each machine. */
export function drawLimits(place, machines, names) {
  place.replaceChildren(...machines.map(({ limits: { path, utilisation, regions } }, n) =>
    make("div", {}, ...(machines.length > 1 ? [make("h3", { textContent: nameOf(names[n]) })] : []), ...pathPart(path), ...busyPart(utilisation), ...(names[n] === "rendering-control" ? regionLoads(regions) : []))));
}

/** Returns the meaning of "in time" for a pipeline with a deadline of its own, or an empty text. */
function deadlineOf(name) {
  if (name === "slats") return " (within one field, a sixtieth of a second)";
  return name.startsWith("jitp") ? " (before the beam reaches its lines)" : "";
}

/** Shows the reason for which a machine shows no picture, and the number of primitives that it could show. `found` is the answer of the
 *  worker, or null before the answer. `use` is called with the number of primitives of the scene to build. */
export function drawHeavy(place, name, found, use) {
  const why = `${nameOf(name)} finishes no picture in time${deadlineOf(name)}, so its screen is empty, incomplete or too old. `;
  if (found === null) return place.replaceChildren(why, "Searching for the number of primitives (triangles and spheres) that would be in time ...");
  const { primitives, in_time: fits } = found;
  const has = `The scene has ${primitives.toLocaleString("en")} ${primitives === 1 ? "primitive" : "primitives"}. `;
  if (!fits) return place.replaceChildren(why, has, "Not even one primitive of this scene would be in time: choose another scene or pipeline.");
  const button = make("button", { type: "button", textContent: `Use ${fits.toLocaleString("en")} primitives` });
  button.addEventListener("click", () => use(fits));
  return place.replaceChildren(why, has, `About ${fits.toLocaleString("en")} would do. `, button);
}
