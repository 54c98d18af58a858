// Drawing of the results of the machines: pictures, boards, latencies.

export const make = (name, given = {}, ...inner) => {
  const element = Object.assign(document.createElement(name), given);
  element.append(...inner);
  return element;
};

/** Returns a time as text: whole milliseconds from 100 on, otherwise three digits. */
export function inMs(ms) {
  if (Math.abs(ms) >= 100) return `${Math.round(ms).toLocaleString("en")} ms`;
  return `${ms.toFixed(Math.abs(ms) >= 10 ? 1 : 2)} ms`;
}

/** Returns the description of a board with readable numbers: 31.3 ms, not 31332.000 us. */
export function humane(text) {
  return text
    .replace(/(\d+\.\d{3}) us/g, (_, us) => (Number(us) >= 1000 ? inMs(Number(us) / 1000) : `${Number(us).toFixed(1)} us`))
    .replace(/\b(\d{4,}) bytes/g, (_, bytes) => `${Number(bytes).toLocaleString("en")} bytes`);
}

/** Draws the bytes of a picture into a canvas of the same size. */
export function picture(canvas, bytes) {
  if (bytes.length !== 4 * canvas.width * canvas.height) return;
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer), canvas.width, canvas.height), 0, 0);
}

/** A hand that shows that a picture can be dragged. */
const HAND = '<svg viewBox="0 0 24 24" width="44" height="44"><path d="M8 21 4 14c-.6-1.1.8-2 1.8-1.2L8 14.5V4.5a1.5 1.5 0 0 1 3 0V11 3a1.5 1.5 0 0 1 3 0v8-6a1.5 1.5 0 0 1 3 0v7-4a1.5 1.5 0 0 1 3 0v7c0 4-2 6-3 6z"/></svg><span>drag me</span>';

function screenOf(canvas, ...more) {
  const screen = make("div", { className: "screen" }, canvas, ...more);
  screen.style.setProperty("--aspect", canvas.width / canvas.height);
  return screen;
}

export function canvasOf(width, height, label) {
  const canvas = make("canvas", { width, height });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", label);
  return canvas;
}

/** Names of pipelines as in the papers. */
const NAMES = { slats: "Slats", "rendering-control": "Rendering Control", frameless: "Frameless rendering" };
const FAMILIES = [["jitp-", "Just-in-time pixels"], ["arp-", "Address recalculation"]];

/** Returns the name of a pipeline as in the papers. A variant of a family has its key in brackets. */
export function nameOf(pipeline) {
  const family = FAMILIES.find(([begin]) => pipeline.startsWith(begin));
  return NAMES[pipeline] ?? (family ? `${family[1]} (${pipeline})` : pipeline);
}

/** Shows the age of a picture and its error in pixels. A picture of many measurements has no age of its own. */
export function drawAge(place, age, offset) {
  const strong = (textContent) => make("strong", { textContent });
  const parts = [];
  if (age) parts.push(strong(inMs(age.age_ms)), " old");
  if (offset) parts.push(age ? ", " : "", strong(`${offset.pixels.toFixed(offset.pixels < 10 ? 1 : 0)} px`), " off");
  place.replaceChildren(...parts);
  place.title = offset ? `In the middle of the picture, the world is ${offset.degrees.toFixed(2)} degrees beside its true place.` : "";
}

/** Makes a row of pictures for each machine. `record` is called with each canvas on which a visitor can turn the head. */
export function layOutEyes(place, states, names, record) {
  const machines = states.map((state, n) => {
    const eyes = state.surfaces.map(({ label, width, height }) => {
      const canvas = canvasOf(width, height, `What the beam has drawn: ${label}`);
      canvas.tabIndex = 0;
      record(canvas);
      // This canvas has wire frame, beam and regions, and lies over the picture.
      const over = make("canvas", { width, height, className: "over" });
      over.setAttribute("aria-hidden", "true");
      const hand = make("div", { className: "hand", innerHTML: HAND });
      hand.setAttribute("aria-hidden", "true");
      const ideal = canvasOf(width, height, `Ideal picture: ${label}`);
      const heat = canvasOf(width, height, `Error: ${label}`);
      const numbers = make("figcaption");
      const figures = [
        make("figure", { className: "seen" }, screenOf(canvas, over, hand), make("figcaption", { textContent: `${label} eye, as the beam draws it` })),
        make("figure", { hidden: true }, ideal, make("figcaption", { textContent: `${label}: ideal picture now` })),
        make("figure", { hidden: true }, heat, numbers),
      ];
      return { label, canvas, over, ideal, heat, numbers, figures };
    });
    const row = make("div", { className: "eyes" }, ...eyes.map((eye) => make("div", { className: "eye" }, ...eye.figures)));
    const age = make("p", { className: "age" });
    const heading = make("div", { className: "whose" }, make("h2", { textContent: nameOf(names[n]) }), age);
    return { eyes, age, section: make("div", { className: "machine" }, heading, row) };
  });
  place.replaceChildren(...machines.map((machine) => machine.section));
  place.className = machines.length > 1 ? "two" : "";
  return machines;
}

/** Returns the colour of a region in a stage, the same as in the block diagram. */
const regionColour = (stage) => getComputedStyle(document.documentElement).getPropertyValue(`--${stage}`).trim();

/** Returns the classes of a part of the latency: its stage has a colour, and waiting is grey. */
const partClass = (name) => `part ${name.replace(/^last_/, "")}`;

/** Draws over a picture: the wire frame of the world, regions that are drawn or copied, and the line of the beam (null for none). */
export function drawOver(over, { wire, regions, line }) {
  const context = over.getContext("2d");
  context.clearRect(0, 0, over.width, over.height);
  if (wire?.length === 4 * over.width * over.height) {
    // Lines are several pixels wide, so they are visible in a small picture.
    const lines = new OffscreenCanvas(over.width, over.height);
    lines.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(wire.buffer), over.width, over.height), 0, 0);
    const thick = Math.min(6, Math.max(1, Math.round((1.6 * over.width) / Math.max(1, over.clientWidth))));
    for (let x = 0; x <= thick; x += 1) for (let y = 0; y <= thick; y += 1) context.drawImage(lines, x - thick / 2, y - thick / 2);
  }
  context.lineWidth = Math.max(3, over.width / 160);
  for (const { stage, works, rectangle: [left, top, width, height], lines: [first, step] } of regions ?? []) {
    const box = [left, first + top * step, width, Math.max(2, height * step)];
    // If the renderer of a region waits, the region has only a frame.
    context.fillStyle = `${regionColour(stage)}${works ? "59" : "00"}`;
    context.fillRect(...box);
    context.strokeStyle = regionColour(stage);
    // Dashes distinguish the stages without colours.
    context.setLineDash(stage === "render" ? [over.width / 40, over.width / 80] : []);
    context.strokeRect(...box);
  }
  if (line !== null && line !== undefined) {
    const glow = context.createLinearGradient(0, line - over.height / 16, 0, line);
    glow.addColorStop(0, "rgba(120, 220, 255, 0)");
    glow.addColorStop(1, "rgba(120, 220, 255, .35)");
    context.fillStyle = glow;
    context.fillRect(0, line - over.height / 16, over.width, over.height / 16);
    context.fillStyle = "#9be7ff";
    context.fillRect(0, line, over.width, Math.max(2, over.height / 200));
  }
}

export function drawRing(place, channels) {
  place.replaceChildren(...channels.map((message) => {
    const textContent = message ? `${message.from} to ${message.to}, ${message.words} words` : "free";
    return make("li", { className: message ? "busy" : "idle", textContent });
  }));
}

const PLACES = { processor: "processors", renderer: "renderers", display: "displays" };

/** Shows a card for each board. A new board gets a new card. */
export function drawBoards({ boards, renderers }, chosen, choose) {
  const numbers = { processor: 0, renderer: 0, display: 0 };
  for (const board of boards) {
    const number = numbers[board.kind];
    numbers[board.kind] += 1;
    const place = document.getElementById(PLACES[board.kind]);
    const button = place.children[number] ?? place.appendChild(card(board, choose));
    button.setAttribute("aria-pressed", String(board.name === chosen));
    button.querySelector("strong").className = board.works ? "works" : "";
    button.querySelector(".does").textContent = board.does;
    if (board.kind === "renderer") {
      button.querySelector("meter").value = board.fifo;
      if (renderers) picture(button.querySelector("canvas"), renderers[number]);
    }
  }
}

function card(board, choose) {
  const button = make("button", { type: "button" }, make("strong", { textContent: board.name }));
  if (board.kind === "renderer") {
    const canvas = make("canvas", { width: 128, height: 128 });
    canvas.setAttribute("aria-hidden", "true");
    const fifo = make("meter", { min: 0, max: board.depth });
    fifo.setAttribute("aria-label", `words in the FIFO of ${board.name}`);
    button.append(canvas, fifo);
  }
  button.append(make("span", { className: "does" }));
  button.addEventListener("click", () => choose(board.name));
  return button;
}

/** Height of the space for a title above the rows of a timeline. On the page, timelines have no title. */
const UNTITLED = 42;

/** Shows a timeline in a shadow root, so its style does not affect the rest of the page. */
export function drawTimeline(place, svg) {
  const root = place.shadowRoot ?? place.attachShadow({ mode: "open" });
  root.innerHTML = `<style>svg { display: block; width: 100%; min-width: 720px; max-width: 1400px; height: auto; margin: 0 auto }</style>${svg}`;
  const drawing = root.querySelector("svg");
  const [, , width, height] = drawing.getAttribute("viewBox").split(" ").map(Number);
  drawing.setAttribute("viewBox", `0 ${UNTITLED} ${width} ${height - UNTITLED}`);
  drawing.setAttribute("part", "drawing");
  drawing.setAttribute("aria-label", "Timeline: a row for each resource, time to the right, a bar for each piece of work at a picture");
  drawing.removeAttribute("width");
  drawing.removeAttribute("height");
}

/** Stores the exact time, which appears when the visitor points at the rounded time. */
const exact = (element, ms) => {
  element.dataset.ms = ms;
  element.title = `${ms} ms`;
  return element;
};

/** Draws a bar with the parts of the latency for each of the last pictures, and a table with the parts of the last picture. */
export function drawLatency(place, machines, names) {
  const longest = Math.max(1, ...machines.flatMap((machine) => machine.latencies.pictures.map((one) => one.total_ms)));
  place.replaceChildren(...machines.map((machine, n) => {
    const { parts, pictures } = machine.latencies;
    const name = machines.length > 1 ? `${nameOf(names[n])}: ` : "";
    if (pictures.length === 0) return make("p", { textContent: `${name}no picture has been shown yet` });
    const bars = pictures.map(({ picture: number, ms, total_ms: total }) => {
      const pieces = ms.map((span, part) => {
        const piece = make("i", { className: partClass(parts[part].name), title: `${parts[part].name.replaceAll("_", " ")}: ${inMs(span)}` });
        piece.style.width = `${(100 * span) / longest}%`;
        return piece;
      });
      return make("div", { className: "bar" }, exact(make("span", { textContent: `picture ${number}: ${inMs(total)}` }), total), make("div", {}, ...pieces));
    });
    const last = pictures.at(-1);
    const rows = parts.map((part, k) => [part, last.ms[k], k]).filter(([, span]) => span > 0);
    const table = make("table", {}, make("caption", { textContent: `${name}picture ${last.picture}, part by part` }), make("tbody", {},
      ...rows.map(([part, span, k]) => make("tr", { title: part.definition },
        make("th", { scope: "row" }, make("i", { className: partClass(part.name) }), part.name.replaceAll("_", " ")),
        exact(make("td", { textContent: inMs(span) }), span)))));
    return make("div", { className: "latency" }, make("div", {}, ...(name ? [make("h3", { textContent: nameOf(names[n]) })] : []), ...bars), table);
  }));
}

/** Faces in the unfolded cube: name, column and row. */
const FACES = [["above", 1, 0], ["left", 0, 1], ["ahead", 1, 1], ["right", 2, 1], ["behind", 3, 1], ["below", 1, 2]];

/** Draws the six faces of each eye's display memory. */
export function drawFaces(place, faces, eyes = 2) {
  if (place.children.length === 0) {
    place.append(...["left", "right"].map((eye) =>
      make("figure", {}, canvasOf(512, 384, `Six faces around the ${eye} eye, as an unfolded cube: left, ahead, right and behind in a row, above and below`), make("figcaption", { textContent: `around the ${eye} eye; black parts of a face have not been drawn` }))));
  }
  faces.forEach((bytes, eye) => {
    place.children[eye].hidden = bytes.length === 0 || eye >= eyes;
    const canvas = place.children[eye].querySelector("canvas");
    picture(canvas, bytes);
    const context = canvas.getContext("2d");
    context.font = "600 15px system-ui, sans-serif";
    context.textBaseline = "top";
    for (const [name, column, row] of FACES) {
      const [x, y] = [128 * column, 128 * row];
      context.strokeStyle = "#7f8b99";
      context.strokeRect(x + 0.5, y + 0.5, 127, 127);
      context.fillStyle = "rgba(0, 0, 0, .65)";
      context.fillRect(x + 4, y + 4, context.measureText(name).width + 8, 20);
      context.fillStyle = "#fff";
      context.fillText(name, x + 8, y + 7);
    }
  });
}
