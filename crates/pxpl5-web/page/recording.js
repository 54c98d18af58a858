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

  /** As it stands in the address: tenths of a degree, yaw and pitch in turn. */
  text() {
    return this.angles.map((angles) => angles.map((angle) => Math.round(angle * 10)).join(",")).join("_");
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

/** The recording of a text in the address; null for what is none. */
export function csv(text) {
  const samples = text.split("_").map((pair) => pair.split(",").map(Number));
  if (samples.length > MOST || samples.some((pair) => pair.length !== 2 || !pair.every(Number.isFinite))) return null;
  return rows(samples, 0);
}

/** A head that is moved while the machine runs: where it is now, and where it was at each sample of simulated time. */
export class Live {
  constructor() {
    this.samples = [[0, 0]];
    this.now = [0, 0];
  }

  /** The head is turned so far, degrees to the left and upwards. */
  turn(yaw, pitch) {
    this.now = [yaw, pitch].map((angle) => Math.round(angle * 10));
  }

  /** The rows that are missing for a run to an instant, picoseconds; null where none is. */
  until(ps) {
    const first = this.samples.length;
    const last = Math.ceil((ps * RATE) / 1e12) + 1;
    while (this.samples.length <= last) this.samples.push(this.now);
    return this.samples.length > first ? rows(this.samples.slice(first), first) : null;
  }

  /** As it stands in the address; null where it has become too long for it. */
  text() {
    return this.samples.length <= MOST ? this.samples.join("_") : null;
  }
}
