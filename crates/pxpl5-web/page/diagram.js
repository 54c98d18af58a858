// The block diagram: boards around the ring with the colours of their stages, and messages that move at a visible speed.

const SVG = "http://www.w3.org/2000/svg";
const make = (name, given = {}, ...inner) => {
  const element = Object.assign(document.createElement(name), given);
  element.append(...inner);
  return element;
};

/** Stages of boards. The first text is the CSS class of the colour, and the second text is for the legend. */
const STAGES = [
  ["waits", "waits"],
  ["send", "sends the pose of the head"],
  ["edit", "EDIT: moves objects"],
  ["transform", "TRANSFORM: places triangles on the screen"],
  ["render", "RENDER: sends or executes drawing commands"],
  ["copy", "COPY: moves finished pixels"],
];
/** Milliseconds in which a message crosses the diagram, at any speed of the machine. */
const CROSSING = 900;
/** Maximum number of messages that move at the same time. */
const MOST = 24;

const kindOf = (name) => name.split(" ")[0];

/** Returns the stage of a message, as far as it follows from the sender and the receiver. */
function cargo({ from, to }) {
  const ends = `${kindOf(from)} ${kindOf(to)}`.toLowerCase();
  if (ends.startsWith("host")) return "send";
  if (ends === "gp renderer") return "render";
  if (ends.startsWith("renderer display")) return "copy";
  return "note";
}

function label(name) {
  const [kind, number] = name.split(" ");
  if (kind === "host") return "Host";
  if (kind === "renderer") return `Renderer ${number}`;
  if (kind === "display") return number === "0" ? "Frame buffers" : `Display ${number}`;
  return name;
}

const still = matchMedia("(prefers-reduced-motion: reduce)");

export class Diagram {
  /** Draws into the element `place`. `choose` is called with the name of a chosen board. */
  constructor(place, legend, choose) {
    this.place = place;
    this.choose = choose;
    this.boards = new Map();
    this.moving = [];
    const chips = STAGES.map(([name, words]) => make("span", { className: "key" }, make("i", { className: `chip ${name}` }), ` ${words}`));
    legend.replaceChildren(...chips, make("span", { className: "key" }, make("i", { className: "chip dot note" }), " a dot is a message, slowed down to be visible"));
    new ResizeObserver(() => this.layOut()).observe(place);
  }

  /** Removes the boards, for example before another machine is drawn. */
  clear() {
    this.boards.clear();
    this.moving = [];
    this.place.replaceChildren();
    this.ring = document.createElementNS(SVG, "svg");
    this.ring.setAttribute("aria-hidden", "true");
    this.place.append(this.ring);
  }

  /** Arranges the boards around a rectangle, in the order in which a picture passes them. */
  layOut() {
    const count = this.boards.size;
    if (count === 0 || !this.ring) return;
    const [width, height] = [this.place.clientWidth, this.place.clientHeight];
    if (width === 0) return;
    const names = [...this.boards.keys()];
    // On a narrow page, boards have short names.
    names.forEach((name) => (this.boards.get(name).button.firstChild.textContent = width < 600 ? label(name).replace("Renderer", "Rend.").replace("Frame buffers", "Frames") : label(name)));
    const first = this.boards.get(names[0]).button;
    const inset = [first.offsetWidth / 2 + 4, first.offsetHeight / 2 + 4];
    const [a, b] = [width - 2 * inset[0], height - 2 * inset[1]];
    // A row has a board in each of its corners, and the columns are between the rows, so no two boards cover each other.
    const [across, down] = [a / first.offsetWidth, b / first.offsetHeight];
    const inRow = Math.min(Math.max(2, Math.round(1 + (count * across) / (across + down) / 2)), Math.floor(count / 2));
    const onRight = Math.ceil(count / 2) - inRow;
    const onLeft = count - 2 * inRow - onRight;
    const spread = (number, place) => Array.from({ length: number }, (_, n) => place(n)).map(([x, y]) => [inset[0] + a * x, inset[1] + b * y]);
    const places = [
      ...spread(inRow, (n) => [n / (inRow - 1), 0]),
      ...spread(onRight, (n) => [1, (n + 1) / (onRight + 1)]),
      ...spread(inRow, (n) => [1 - n / (inRow - 1), 1]),
      ...spread(onLeft, (n) => [0, 1 - (n + 1) / (onLeft + 1)]),
    ];
    // The host stands at the left of the upper row.
    names.forEach((name, n) => {
      const board = this.boards.get(name);
      board.at = places[n];
      board.button.style.left = `${board.at[0]}px`;
      board.button.style.top = `${board.at[1]}px`;
    });
    // The ring is inside the rectangle of boards, and a line connects each board to the ring.
    const gap = [inset[0] + 26, inset[1] + 26];
    this.box = [gap[0], gap[1], width - 2 * gap[0], height - 2 * gap[1]];
    this.ring.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const rings = Array.from({ length: 8 }, (_, n) => {
      const rect = document.createElementNS(SVG, "rect");
      const far = 3 * n;
      Object.entries({ x: this.box[0] + far, y: this.box[1] + far, width: Math.max(0, this.box[2] - 2 * far), height: Math.max(0, this.box[3] - 2 * far), rx: 18 })
        .forEach(([key, value]) => rect.setAttribute(key, value));
      rect.setAttribute("class", "channel");
      return rect;
    });
    const plugs = names.map((name) => {
      const line = document.createElementNS(SVG, "line");
      const board = this.boards.get(name);
      board.plug = this.nearest(board.at);
      Object.entries({ x1: board.at[0], y1: board.at[1], x2: board.plug[0], y2: board.plug[1] }).forEach(([key, value]) => line.setAttribute(key, value));
      line.setAttribute("class", "plug");
      return line;
    });
    const words = document.createElementNS(SVG, "text");
    Object.entries({ x: width / 2, y: height / 2, class: "middle", "text-anchor": "middle" }).forEach(([key, value]) => words.setAttribute(key, value));
    words.textContent = "ring of eight channels";
    this.dots = document.createElementNS(SVG, "g");
    this.ring.replaceChildren(...plugs, ...rings, words, this.dots);
  }

  /** Returns the point of the ring that is nearest to a position. */
  nearest([x, y]) {
    const [left, top, width, height] = this.box;
    return [Math.min(Math.max(x, left), left + width), Math.min(Math.max(y, top), top + height)];
  }

  /** Shows the current stage of each board, and starts to move new messages. */
  draw({ boards, messages, channels }, chosen) {
    if (boards.some((board) => !this.boards.has(board.name)) || boards.length !== this.boards.size) {
      this.clear();
      boards.forEach((board) => {
        const does = make("span", { className: "does" });
        const button = make("button", { type: "button", className: "block" }, make("strong", { textContent: label(board.name) }), " ", does);
        button.dataset.board = board.name;
        button.addEventListener("click", () => this.choose(board.name));
        this.boards.set(board.name, { button, does });
        this.place.append(button);
      });
      this.layOut();
    }
    const onRing = channels?.filter(Boolean) ?? [];
    for (const board of boards) {
      const { button, does } = this.boards.get(board.name);
      const sends = onRing.find((message) => message.from === board.name);
      const takes = onRing.some((message) => message.to === board.name);
      let stages = board.works ? board.stages ?? [] : ["waits"];
      if (board.kind === "display") stages = [takes ? "copy" : "waits"];
      if (board.kind === "processor" && sends) stages = [cargo(sends)];
      if (stages.length === 0) stages = ["note"];
      stages = stages.map((stage) => (stage === "sample" ? "send" : stage));
      // A renderer can execute commands and copy pixels at the same time.
      button.className = `block ${board.kind} ${stages.join(" ")}`;
      button.setAttribute("aria-pressed", String(board.name === chosen));
      const word = stages.map((stage) => (stage === "waits" ? "waits" : stage === "note" ? "works" : stage.toUpperCase())).join(" ");
      if (does.textContent !== word) does.textContent = word;
    }
    // First the messages that are on a channel now, then the messages that have ended since the last drawing.
    const news = [...onRing.map((message) => ({ ...message, key: `${message.from}>${message.to}` })), ...(messages ?? [])];
    for (const message of news) {
      if (this.moving.length >= MOST) break;
      if (message.key && this.moving.some((other) => other.key === message.key)) continue;
      this.launch(message);
    }
  }

  launch(message) {
    const [from, to] = [this.boards.get(message.from), this.boards.get(message.to)];
    if (!from?.plug || !to?.plug || !this.dots) return;
    const dot = document.createElementNS(SVG, "circle");
    dot.setAttribute("r", message.words > 200 ? 8 : 5);
    dot.setAttribute("class", `message ${cargo(message)}`);
    this.dots.append(dot);
    const path = [from.at, from.plug, ...this.corners(from.plug, to.plug), to.plug, to.at];
    const begun = performance.now();
    const entry = { key: message.key ?? "", dot };
    this.moving.push(entry);
    const lengths = path.slice(1).map((point, n) => Math.hypot(point[0] - path[n][0], point[1] - path[n][1]));
    const whole = lengths.reduce((sum, length) => sum + length, 0);
    const place = (share) => {
      let way = share * whole;
      let n = 0;
      while (n < lengths.length - 1 && way > lengths[n]) way -= lengths[n++];
      const part = lengths[n] ? Math.min(1, way / lengths[n]) : 1;
      dot.setAttribute("cx", path[n][0] + part * (path[n + 1][0] - path[n][0]));
      dot.setAttribute("cy", path[n][1] + part * (path[n + 1][1] - path[n][1]));
    };
    const end = () => {
      dot.remove();
      this.moving = this.moving.filter((other) => other !== entry);
    };
    // With reduced motion, a message stays in the middle of its path for the same time.
    if (still.matches) {
      place(0.5);
      return void setTimeout(end, CROSSING);
    }
    const tick = (now) => {
      const share = (now - begun) / CROSSING;
      if (share >= 1 || !dot.isConnected) return end();
      place(Math.max(0, share));
      requestAnimationFrame(tick);
    };
    place(0);
    requestAnimationFrame(tick);
  }

  /** Returns the corners between two points of the ring, along the shorter path. */
  corners(from, to) {
    const [left, top, width, height] = this.box;
    const all = [[left, top], [left + width, top], [left + width, top + height], [left, top + height]];
    const along = ([x, y]) => {
      if (y <= top) return x - left;
      if (x >= left + width) return width + y - top;
      if (y >= top + height) return width + height + left + width - x;
      return 2 * width + height + top + height - y;
    };
    const around = 2 * (width + height);
    const places = [0, width, width + height, 2 * width + height];
    const [a, b] = [along(from), along(to)];
    const forth = (b - a + around) % around;
    const isForth = forth <= around / 2;
    const [begin, length] = isForth ? [a, forth] : [b, around - forth];
    const inside = places.map((place, n) => [(place - begin + around) % around, all[n]]).filter(([far]) => far > 0 && far < length);
    inside.sort((one, other) => one[0] - other[0]);
    const points = inside.map(([, point]) => point);
    return isForth ? points : points.reverse();
  }
}
