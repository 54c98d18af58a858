// Drawing of what the machines show: pictures, boards, latencies.

const make = (name, given = {}, ...inner) => {
  const element = Object.assign(document.createElement(name), given);
  element.append(...inner);
  return element;
};

/** Bytes of a picture into a canvas of its size. */
export function picture(canvas, bytes) {
  if (bytes.length !== 4 * canvas.width * canvas.height) return;
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer), canvas.width, canvas.height), 0, 0);
}

function canvasOf(width, height, label) {
  const canvas = make("canvas", { width, height });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", label);
  return canvas;
}

/** A row of pictures for each machine; `record` is told of each canvas that a head can be dragged on. */
export function layOutEyes(place, states, names, record) {
  const machines = states.map((state, n) => {
    const eyes = state.surfaces.map(({ label, width, height }) => {
      const canvas = canvasOf(width, height, `What the beam has drawn: ${label}`);
      record(canvas);
      const ideal = canvasOf(width, height, `Ideal picture: ${label}`);
      const heat = canvasOf(width, height, `Error: ${label}`);
      const numbers = make("figcaption");
      const figures = [
        make("figure", { className: "seen" }, canvas, make("figcaption", { textContent: `${label} eye, as the beam draws it` })),
        make("figure", { hidden: true }, ideal, make("figcaption", { textContent: `${label}: ideal picture now` })),
        make("figure", { hidden: true }, heat, numbers),
      ];
      return { canvas, ideal, heat, numbers, figures };
    });
    const row = make("div", { className: "eyes" }, ...eyes.map((eye) => make("div", { className: "eye" }, ...eye.figures)));
    return { eyes, section: make("div", { className: "machine" }, make("h2", { textContent: names[n] }), row) };
  });
  place.replaceChildren(...machines.map((machine) => machine.section));
  place.className = machines.length > 1 ? "two" : "";
  return machines;
}

export function drawRing(place, channels) {
  place.replaceChildren(...channels.map((message) => {
    const textContent = message ? `${message.from} to ${message.to}, ${message.words} words` : "free";
    return make("li", { className: message ? "busy" : "idle", textContent });
  }));
}

const PLACES = { processor: "processors", renderer: "renderers", display: "displays" };

/** A card for each board, made when it is first seen. */
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

/** Height of the place for a title above a timeline's rows, which it has none of here. */
const UNTITLED = 42;

/** A drawing of its own, whose style reaches nothing else of the page. */
export function drawTimeline(place, svg) {
  const root = place.shadowRoot ?? place.attachShadow({ mode: "open" });
  root.innerHTML = `<style>svg { display: block; width: 100%; min-width: 720px; max-width: 1400px; height: auto; margin: 0 auto }</style>${svg}`;
  const drawing = root.querySelector("svg");
  const [, , width, height] = drawing.getAttribute("viewBox").split(" ").map(Number);
  drawing.setAttribute("viewBox", `0 ${UNTITLED} ${width} ${height - UNTITLED}`);
  drawing.removeAttribute("width");
  drawing.removeAttribute("height");
}

/** A bar for each of the last pictures, its parts beside each other; the numbers of the last one as a table. */
export function drawLatency(place, machines, names) {
  const longest = Math.max(1, ...machines.flatMap((machine) => machine.latencies.pictures.map((one) => one.total_ms)));
  place.replaceChildren(...machines.map((machine, n) => {
    const { parts, pictures } = machine.latencies;
    const name = machines.length > 1 ? `${names[n]}: ` : "";
    if (pictures.length === 0) return make("p", { textContent: `${name}no picture has been shown yet` });
    const bars = pictures.map(({ picture: number, ms, total_ms: total }) => {
      const pieces = ms.map((span, part) => {
        const piece = make("i", { className: `part${part}`, title: `${parts[part].name}: ${span.toFixed(3)} ms` });
        piece.style.width = `${(100 * span) / longest}%`;
        return piece;
      });
      return make("div", { className: "bar" }, make("span", { textContent: `picture ${number}: ${total.toFixed(2)} ms` }), make("div", {}, ...pieces));
    });
    const last = pictures.at(-1);
    const rows = parts.map((part, k) => [part, last.ms[k], k]).filter(([, span]) => span > 0);
    const table = make("table", {}, make("caption", { textContent: `${name}picture ${last.picture}, part by part` }), make("tbody", {},
      ...rows.map(([part, span, k]) => make("tr", { title: part.definition },
        make("th", { scope: "row" }, make("i", { className: `part${k}` }), part.name.replaceAll("_", " ")),
        make("td", { textContent: `${span.toFixed(3)} ms` })))));
    return make("div", { className: "latency" }, make("div", {}, ...bars), table);
  }));
}

/** The six faces that each eye's display memory shows. */
export function drawFaces(place, faces) {
  if (place.children.length === 0) {
    place.append(...["left", "right"].map((eye) =>
      make("figure", {}, canvasOf(512, 384, `Six faces, ${eye} eye`), make("figcaption", { textContent: `${eye} eye: left, ahead, right, behind; above and below` }))));
  }
  faces.forEach((bytes, eye) => {
    place.children[eye].hidden = bytes.length === 0;
    picture(place.children[eye].querySelector("canvas"), bytes);
  });
}
