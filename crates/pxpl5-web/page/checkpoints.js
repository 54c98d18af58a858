// Checkpoints of the machines: copies of their memory, from which a run goes back.
//
// Between two requests, all state of the machines is in the memory of WebAssembly. A copy of this memory is therefore a whole
// checkpoint. Only the newest copy is whole. Each older checkpoint has the pages that differ from the next newer one.

/** Bytes that are compared and kept together. */
const PAGE = 4096;
const WORDS = PAGE / 4;

/** Limits that a caller can change. Times are simulated, in picoseconds. */
const LIMITS = {
  /** Time between two checkpoints. */
  every: 1e12,
  /** Milliseconds of computing after which a checkpoint is due too, so that slow machines also go back soon. */
  work: 500,
  /** Most bytes of the pages of older checkpoints together, except that one older checkpoint always stays. The newest checkpoint
   *  needs as many bytes as the memory. */
  bytes: 160e6,
  /** Most checkpoints. */
  count: 64,
  /** Most bytes that can be lost. After a return to a time when the memory was smaller, the allocator cannot use the rest. */
  lost: 128e6,
};

export class Checkpoints {
  /** `memory` is the WebAssembly.Memory of the machines. */
  constructor(memory, limits = {}) {
    this.memory = memory;
    this.limits = { ...LIMITS, ...limits };
    this.lost = 0;
    this.clear();
  }

  /** Discards all checkpoints, for example because other machines were built. */
  clear() {
    /** Checkpoints, the oldest first: the instant, what the caller notes with it, the size of the memory, and the pages that turn
     *  the next newer checkpoint into this one. */
    this.all = [];
    this.newest = new Uint8Array(0);
  }

  /** Bytes of the pages of older checkpoints. */
  get bytes() {
    return this.all.reduce((sum, { pages }) => sum + pages.size * PAGE, 0);
  }

  /** Takes a checkpoint at an instant if one is due, and returns true if it was taken. `note` is returned by `back`. `worked` is the
   *  number of milliseconds of computing since the last checkpoint. */
  take(at, note, worked = 0) {
    const last = this.all.at(-1);
    if (last && (at <= last.at || (at < last.at + this.limits.every && worked < this.limits.work))) return false;
    const size = this.memory.buffer.byteLength;
    if (this.newest.length < size) {
      const larger = new Uint8Array(size);
      larger.set(this.newest);
      this.newest = larger;
    }
    const pages = last?.pages;
    const [now, before] = [new Int32Array(this.memory.buffer), new Int32Array(this.newest.buffer)];
    const bytes = new Uint8Array(this.memory.buffer);
    for (let page = 0; page * PAGE < size; page += 1) {
      const end = (page + 1) * WORDS;
      let word = page * WORDS;
      while (word < end && now[word] === before[word]) word += 1;
      if (word === end) continue;
      // The old page leads back to the checkpoint before, if there is one.
      if (page * PAGE < (last?.size ?? 0)) pages.set(page, this.newest.slice(page * PAGE, (page + 1) * PAGE));
      this.newest.set(bytes.subarray(page * PAGE, (page + 1) * PAGE), page * PAGE);
    }
    this.all.push({ at, note, size, pages: new Map() });
    this.thin(at);
    return true;
  }

  /** Removes checkpoints until the limits hold: those that lie closest together, relative to their age. Recent ones stay dense. Of
   *  three checkpoints the oldest is removed, because building the machines again also leads to the start. */
  thin(now) {
    const { bytes, count, every } = this.limits;
    while (this.all.length > 2 && (this.all.length > count || this.bytes > bytes)) {
      const gap = (n) => (this.all[n + 1].at - this.all[n - 1].at) / (now - this.all[n - 1].at + every);
      let closest = 0;
      if (this.all.length > 3) for (let n = 1; n < this.all.length - 1; n += 1) if (closest === 0 || gap(n) < gap(closest)) closest = n;
      const [gone] = this.all.splice(closest, 1);
      if (closest === 0) continue;
      // The checkpoint before is reached across the one that is gone.
      const older = this.all[closest - 1];
      for (const [page, content] of gone.pages) if (!older.pages.has(page) && page * PAGE < older.size) older.pages.set(page, content);
    }
  }

  /** Puts the memory back to the last checkpoint at or before an instant. Later checkpoints are discarded. Returns `{ at, note }`, or
   *  null without such a checkpoint. */
  back(to) {
    const found = this.all.findLastIndex(({ at }) => at <= to);
    if (found < 0) return null;
    const { at, note, size } = this.all[found];
    const lost = this.memory.buffer.byteLength - size;
    if (this.lost + lost > this.limits.lost) return null;
    for (let n = this.all.length - 2; n >= found; n -= 1) {
      for (const [page, content] of this.all[n].pages) this.newest.set(content, page * PAGE);
    }
    this.all.length = found + 1;
    this.all[found].pages = new Map();
    this.newest = this.newest.slice(0, size);
    new Uint8Array(this.memory.buffer).set(this.newest);
    this.lost += lost;
    return { at, note };
  }
}
