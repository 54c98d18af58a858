// A head motion of a visitor, sixty times a second. The motion is stored in the address, and as a recording for the command.
//
// A sample is a list of yaw and pitch in tenths of a degree, to the left and upwards, and sometimes of a way to the right in millimetres.
// A headset or a phone gives whole poses instead: `{ position, orientation }` with metres (x, y, z) and a quaternion (w, x, y, z).

/** Samples a second, and the maximum number of samples (20 s). */
const RATE = 60;
const MOST = 1200;

export class Recorder {
  constructor() {
    this.begun = performance.now();
    this.angles = [[0, 0]];
  }

  /** Records a turn of the head since the start, in degrees to the left and upwards. Missing samples repeat the last sample. */
  turn(yaw, pitch) {
    const due = Math.min(Math.floor(((performance.now() - this.begun) / 1000) * RATE), MOST - 1);
    while (this.angles.length < due) this.angles.push(this.angles.at(-1));
    this.angles[due] = [yaw, pitch];
  }

  /** Returns the motion as text for the address. */
  text() {
    return packed(this.angles.map((angles) => angles.map((angle) => Math.round(angle * 10))));
  }
}

function poseOf(sample) {
  if (!Array.isArray(sample)) return sample;
  const [yaw, pitch, right = 0] = sample;
  const [y, p] = [yaw, pitch].map((tenths) => (tenths * Math.PI) / 3600);
  // The first rotation is about y, and the second rotation is about the turned x axis.
  const orientation = [Math.cos(y) * Math.cos(p), Math.cos(y) * Math.sin(p), Math.sin(y) * Math.cos(p), -Math.sin(y) * Math.sin(p)];
  return { position: [right / 1000, 0, 0], orientation };
}

/** Returns samples as rows of a recording for the command. `first` is the number of the first sample. */
function rows(samples, first) {
  const of = (sample, n) => {
    const { position, orientation } = poseOf(sample);
    return [((first + n) / RATE).toFixed(6), ...position.map((way) => way && way.toFixed(6)), ...orientation.map((part) => part.toFixed(9))].join(",");
  };
  return `time_s,x,y,z,qw,qx,qy,qz\n${samples.map(of).join("\n")}\n`;
}

/** Digits of the packed form, six bits each. The lower five bits belong to a number, and the sixth bit is 1 if more digits follow. */
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

/** Returns samples as short text: differences of successive samples, and numbers of samples without a change. */
export function packed(samples) {
  const folded = (value) => (value < 0 ? -2 * value - 1 : 2 * value);
  let text = "~";
  let before = [0, 0];
  for (let n = 0; n < samples.length; ) {
    let same = 0;
    while (n + same < samples.length && samples[n + same][0] === before[0] && samples[n + same][1] === before[1]) same += 1;
    if (same > 0) {
      // The number 0 marks a count of equal samples.
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

/** Returns the samples of a text in the address, packed or as pairs of decimal numbers. Returns null for any other text. */
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

/** Returns the recording of a text in the address, or null for any other text. */
export function csv(text) {
  const samples = samplesOf(text);
  return samples && rows(samples, 0);
}

/** A head that a visitor moves while the machine runs, with its present angles and its angles at each sample of simulated time. */
export class Live {
  /** `path` is a function of seconds that moves the head until the visitor moves the head; null for none. */
  constructor(path = null) {
    this.path = path;
    this.samples = [[0, 0]];
    this.now = [0, 0];
    /** Number of samples that the machines have received. */
    this.sent = 1;
  }

  /** Turns the head to angles in degrees, to the left and upwards. */
  turn(yaw, pitch) {
    this.path = null;
    this.now = [yaw, pitch].map((angle) => Math.round(angle * 10));
  }

  /** Moves the head to a whole pose, which a headset or a phone has measured. */
  pose(position, orientation) {
    this.path = null;
    this.now = { position, orientation };
  }

  /** The present angles in degrees, to the left and upwards. They are zero after a whole pose. */
  get angles() {
    return Array.isArray(this.now) ? [this.now[0] / 10, this.now[1] / 10] : [0, 0];
  }

  /** Returns the rows that the machines need for a run to an instant in picoseconds, or null if they have all rows. */
  until(ps) {
    const first = this.sent;
    const last = Math.ceil((ps * RATE) / 1e12) + 1;
    while (this.samples.length <= last) {
      if (this.path) this.now = this.path(this.samples.length / RATE).map((angle) => Math.round(angle * 10));
      this.samples.push(this.now);
    }
    if (last < first) return null;
    this.sent = last + 1;
    return rows(this.samples.slice(first, last + 1), first);
  }

  /** Prepares a return of the machines to an instant at which they have the first `sent` samples. Up to this instant, the machines get
   *  the same samples again. */
  again(ps, sent = 1) {
    this.samples.length = Math.min(this.samples.length, Math.max(sent, Math.ceil((ps * RATE) / 1e12) + 2));
    this.now = this.samples.at(-1);
    this.sent = sent;
  }

  /** Returns the motion so far as a recording for the command. */
  csv() {
    return rows(this.samples, 0);
  }

  /** Returns the motion as text for the address, or null if the motion is too long for the address, or more than turns of the head. */
  text() {
    return this.samples.length <= MOST && this.samples.every((sample) => sample.length === 2) ? packed(this.samples) : null;
  }
}
