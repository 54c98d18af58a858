// Busy renderers over time as a map, and the error of the pictures beside the speed of the head.
import { canvasOf, inMs, make, nameOf } from "./draw.js";
import { percent } from "./limits.js";

/** Simulated picoseconds that the map of renderers shows: six fields. */
const MAP_PS = 100.1e9;
/** Simulated picoseconds that the curves show. */
const CURVES_PS = 5e12;
/** Simulated picoseconds without a picture after which a curve begins again. */
const GAP_PS = 250e9;
/** Size of both drawings in pixels: the whole width, the space for names on the left, and the height of a row. */
const [WIDTH, LEFT, ROW] = [1000, 110, 14];

/** The share of each stage in each span of time for each renderer, and the curves, of all machines. */
export class Busy {
  #rows = [];
  #curves = [];

  clear() {
    this.#rows = [];
    this.#curves = [];
  }

  /** Adds samples of each machine: an instant, and the time for which each renderer has executed and copied until then. */
  add({ busy, machines }) {
    busy.forEach((samples, n) => {
      const rows = (this.#rows[n] ??= []);
      for (const [ps, spans] of samples) {
        while (rows.length > 0 && rows.at(-1).ps >= ps) rows.pop();
        rows.push({ ps, spans });
      }
      while (rows.length > 2 && rows[1].ps < rows.at(-1).ps - MAP_PS) rows.shift();
    });
    machines.forEach(({ state, offset }, n) => {
      if (offset === undefined) return;
      const points = (this.#curves[n] ??= []);
      while (points.length > 0 && points.at(-1).ps >= state.now_ps) points.pop();
      points.push({ ps: state.now_ps, px: offset?.pixels ?? null, speed: state.turn_deg_s ?? null });
      while (points[0].ps < state.now_ps - CURVES_PS) points.shift();
    });
  }

  /** Draws the map and the curves. Names are those of the pipelines. */
  draw(place, names) {
    if (place.children.length !== names.length + 1) {
      const figure = (label) => make("figure", {}, canvasOf(WIDTH, 10, label), make("figcaption"));
      place.replaceChildren(...names.map((name) => figure(`Busy renderers of ${nameOf(name)}`)), figure("Error of the pictures and speed of the head"));
    }
    names.forEach((name, n) => this.#map(place.children[n], this.#rows[n] ?? [], names.length > 1 ? `${nameOf(name)}: ` : ""));
    this.#lines(place.children[names.length], names);
  }

  #map(figure, rows, name) {
    const last = rows.at(-1);
    figure.hidden = rows.length < 2;
    if (figure.hidden) return;
    const [canvas, caption] = figure.children;
    const boards = last.spans.length / 2;
    const from = last.ps - MAP_PS;
    const { context, colour, across } = begin(canvas, boards * ROW, from, last.ps);
    const total = [0, 0];
    for (let k = 1; k < rows.length; k += 1) {
      const [before, after] = [rows[k - 1], rows[k]];
      const ps = after.ps - before.ps;
      const [x, end] = [across(Math.max(from, before.ps)), across(after.ps)];
      for (let board = 0; board < boards; board += 1) {
        // A renderer executes, copies or waits, so the heights of the two colours are shares of the row.
        let y = (board + 1) * ROW - 1;
        ["render", "copy"].forEach((stage, n) => {
          const share = Math.min(1, (after.spans[n * boards + board] - before.spans[n * boards + board]) / ps);
          total[n] += share * ps;
          context.fillStyle = colour(stage);
          context.fillRect(x, y - share * (ROW - 2), end - x + 0.5, share * (ROW - 2));
          y -= share * (ROW - 2);
        });
      }
    }
    context.fillStyle = colour();
    for (let board = 0; board < boards; board += 1) context.fillText(`renderer ${board}`, LEFT - 8, (board + 0.5) * ROW);
    const [executing, copying] = total.map((ps) => ps / boards / (last.ps - rows[0].ps));
    canvas.dataset.executing = executing;
    canvas.dataset.copying = copying;
    caption.textContent = `${name}in the last ${inMs((last.ps - rows[0].ps) / 1e9)}, renderers executed commands for ${percent(executing)} of the time and copied for ${percent(copying)}`;
  }

  #lines(figure, names) {
    const [canvas, caption] = figure.children;
    const all = this.#curves.filter((points) => points.length > 1);
    figure.hidden = !all.some((points) => points.some(({ px }) => px !== null));
    if (figure.hidden) return;
    const now = all[0].at(-1).ps;
    const high = 90;
    const { context, colour, across } = begin(canvas, 2 * high + 20, all[0].find(({ px }) => px !== null)?.ps ?? all[0][0].ps, now);
    const most = [Math.max(1, ...all.flat().map(({ px }) => px ?? 0)), Math.max(1, ...all[0].map(({ speed }) => speed ?? 0))];
    const strip = (top, points, value, greatest, dashes) => {
      context.setLineDash(dashes);
      context.beginPath();
      let before = -GAP_PS;
      for (const point of points.filter((one) => one[value] !== null)) {
        const y = top + high * (1 - point[value] / greatest);
        context[point.ps - before < GAP_PS ? "lineTo" : "moveTo"](across(point.ps), y);
        before = point.ps;
      }
      context.stroke();
    };
    context.lineWidth = 2;
    context.strokeStyle = context.fillStyle = colour();
    all.forEach((points, n) => strip(10, points, "px", most[0], n === 0 ? [] : [6, 4]));
    strip(high + 20, all[0], "speed", most[1], []);
    context.setLineDash([]);
    [["error, px", most[0], 10], ["head, deg/s", most[1], high + 20]].forEach(([name, greatest, top]) => {
      context.fillText(greatest.toFixed(greatest < 10 ? 1 : 0), LEFT - 8, top + 6);
      context.fillText(name, LEFT - 8, top + high / 2);
      context.fillText("0", LEFT - 8, top + high - 6);
    });
    Object.assign(canvas.dataset, all[0].at(-1));
    const beside = names.length > 1 ? ` (${nameOf(names[0])} as a line, ${nameOf(names[1])} with dashes)` : "";
    caption.textContent = `Error in the middle of the picture${beside}, and below it the speed with which the head turns`;
  }
}

/** Sizes a canvas for a height and its axis of time, and clears it. Returns the context, the colour of a stage or of text, and the place of an instant. */
function begin(canvas, high, from, to) {
  if (canvas.height !== high + 22) canvas.height = high + 22;
  const context = canvas.getContext("2d");
  const styles = getComputedStyle(canvas);
  const colour = (stage) => (stage ? styles.getPropertyValue(`--${stage}`).trim() : styles.color);
  context.clearRect(0, 0, WIDTH, canvas.height);
  Object.assign(context, { font: "12px system-ui, sans-serif", textBaseline: "middle", fillStyle: colour(), strokeStyle: colour("waiting") });
  const across = (ps) => LEFT + ((ps - from) / (to - from)) * (WIDTH - LEFT - 40);
  // Marks at round instants: five to ten.
  const step = [1, 2, 5, 10].map((times) => times * 10 ** Math.floor(Math.log10((to - from) / 10))).find((one) => (to - from) / one <= 10);
  context.textAlign = "center";
  for (let ps = Math.ceil(Math.max(0, from) / step) * step; ps <= to; ps += step) {
    context.fillText(`${(ps / 1e9).toLocaleString("en")} ms`, across(ps), high + 12);
    context.globalAlpha = 0.25;
    context.fillRect(across(ps), 0, 1, high);
    context.globalAlpha = 1;
  }
  context.textAlign = "right";
  return { context, colour, across };
}
