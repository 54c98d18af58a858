// A head motion that a visitor made: angles sixty times a second, in the address and as the recording that the command reads.

/** Samples a second, and most of them: 20 s. */
const RATE = 60;
const MOST = 1200;

export class Recorder {
  constructor() {
    this.begun = performance.now();
    this.angles = [[0, 0]];
  }

  /** The head has turned so far since the begin, degrees to the left and upwards; what lies between two samples is held. */
  turn(yaw, pitch) {
    const due = Math.min(Math.floor(((performance.now() - this.begun) / 1000) * RATE), MOST - 1);
    while (this.angles.length < due) this.angles.push(this.angles.at(-1));
    this.angles[due] = [yaw, pitch];
  }

  /** As it stands in the address. */
  text() {
    return packed(this.angles.map((angles) => angles.map((angle) => Math.round(angle * 10))));
  }
}

/** Rows of a recording as pxpl5 reads it: samples of yaw and pitch in tenths of a degree, the first of which has this number. */
function rows(samples, first) {
  const of = ([yaw, pitch], n) => {
    const [y, p] = [yaw, pitch].map((tenths) => (tenths * Math.PI) / 3600);
    // First about y, then about the turned x.
    const q = [Math.cos(y) * Math.cos(p), Math.cos(y) * Math.sin(p), Math.sin(y) * Math.cos(p), -Math.sin(y) * Math.sin(p)];
    return [((first + n) / RATE).toFixed(6), 0, 0, 0, ...q.map((part) => part.toFixed(9))].join(",");
  };
  return `time_s,x,y,z,qw,qx,qy,qz\n${samples.map(of).join("\n")}\n`;
}

/** Digits of the packed form, six bits each: the lower five are of a number, the sixth says that more follow. */
const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

function digits(number) {
  let text = "";
  let rest = number;
  do {
    const low = rest % 32;
    rest = Math.floor(rest / 32);
    text += DIGITS[rest > 0 ? low + 32 : low];
  } while (rest > 0);
  return text;
}

/** Samples as short text: differences of one to the next, and the number of samples in which nothing changes. */
export function packed(samples) {
  const folded = (value) => (value < 0 ? -2 * value - 1 : 2 * value);
  let text = "~";
  let before = [0, 0];
  for (let n = 0; n < samples.length; ) {
    let same = 0;
    while (n + same < samples.length && samples[n + same][0] === before[0] && samples[n + same][1] === before[1]) same += 1;
    if (same > 0) {
      // Zero says that a number of equal samples follows.
      text += digits(0) + digits(same);
      n += same;
      continue;
    }
    const [yaw, pitch] = samples[n];
    text += digits(folded(yaw - before[0]) + 1) + digits(folded(pitch - before[1]));
    before = samples[n];
    n += 1;
  }
  return text;
}

/** Samples of a text in the address, packed or as pairs of decimal numbers; null for what is none. */
export function samplesOf(text) {
  if (!text.startsWith("~")) {
    const samples = text.split("_").map((pair) => pair.split(",").map(Number));
    const isWrong = samples.length > MOST || samples.some((pair) => pair.length !== 2 || !pair.every(Number.isFinite));
    return isWrong ? null : samples;
  }
  const unfolded = (value) => (value % 2 ? -(value + 1) / 2 : value / 2);
  let at = 1;
  const number = () => {
    let value = 0;
    for (let scale = 1; ; scale *= 32) {
      const digit = DIGITS.indexOf(text[at]);
      if (at >= text.length || digit < 0 || scale > 2 ** 30) return NaN;
      at += 1;
      value += (digit % 32) * scale;
      if (digit < 32) return value;
    }
  };
  const samples = [];
  let before = [0, 0];
  while (at < text.length) {
    const first = number();
    const second = number();
    if (Number.isNaN(first + second)) return null;
    if (first === 0) {
      if (samples.length + second > MOST) return null;
      for (let n = 0; n < second; n += 1) samples.push(before);
    } else {
      before = [before[0] + unfolded(first - 1), before[1] + unfolded(second)];
      samples.push(before);
    }
  }
  return samples.length > 0 && samples.length <= MOST ? samples : null;
}

/** The recording of a text in the address; null for what is none. */
export function csv(text) {
  const samples = samplesOf(text);
  return samples && rows(samples, 0);
}

/** A head that is moved while the machine runs: where it is now, and where it was at each sample of simulated time. */
export class Live {
  /** `path` is a function of seconds that moves the head until somebody takes it over; null for none. */
  constructor(path = null) {
    this.path = path;
    this.samples = [[0, 0]];
    this.now = [0, 0];
    /** Number of samples that the machines have. */
    this.told = 1;
  }

  /** The head is turned so far, degrees to the left and upwards. */
  turn(yaw, pitch) {
    this.path = null;
    this.now = [yaw, pitch].map((angle) => Math.round(angle * 10));
  }

  /** The rows that are missing for a run to an instant, picoseconds; null where none is. */
  until(ps) {
    const first = this.told;
    const last = Math.ceil((ps * RATE) / 1e12) + 1;
    while (this.samples.length <= last) {
      if (this.path) this.now = this.path(this.samples.length / RATE).map((angle) => Math.round(angle * 10));
      this.samples.push(this.now);
    }
    if (last < first) return null;
    this.told = last + 1;
    return rows(this.samples.slice(first, last + 1), first);
  }

  /** Machines go back to an instant, where they have the first `told` samples. The same samples follow up to this instant. */
  again(ps, told = 1) {
    this.samples.length = Math.min(this.samples.length, Math.max(told, Math.ceil((ps * RATE) / 1e12) + 2));
    this.now = this.samples.at(-1);
    this.told = told;
  }

  /** As it stands in the address; null where it has become too long for it. */
  text() {
    return this.samples.length <= MOST ? packed(this.samples) : null;
  }
}
