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

/** The recording of a text in the address, as pxpl5 reads it; null for what is none. */
export function csv(text) {
  const samples = text.split("_").map((pair) => pair.split(",").map(Number));
  if (samples.length > MOST || samples.some((pair) => pair.length !== 2 || !pair.every(Number.isFinite))) return null;
  const rows = samples.map(([yaw, pitch], n) => {
    const [y, p] = [yaw, pitch].map((tenths) => (tenths * Math.PI) / 3600);
    // First about y, then about the turned x.
    const q = [Math.cos(y) * Math.cos(p), Math.cos(y) * Math.sin(p), Math.sin(y) * Math.cos(p), -Math.sin(y) * Math.sin(p)];
    return [(n / RATE).toFixed(6), 0, 0, 0, ...q.map((part) => part.toFixed(9))].join(",");
  });
  return `time_s,x,y,z,qw,qx,qy,qz\n${rows.join("\n")}\n`;
}
