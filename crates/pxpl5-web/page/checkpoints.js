// Checkpoints of the machines: copies of their memory, from which a run goes back.
//
// Between two requests, all state of the machines is in the memory of WebAssembly. A copy of this memory is therefore a whole
// checkpoint. Only the newest copy is whole. Each older checkpoint has the pages that differ from the next newer one.

/** Bytes of a page, the unit in which memories are compared and stored. */
const PAGE = 4096;
const WORDS = PAGE / 4;

/** Limits that a caller can change. Times are simulated, in picoseconds. */
const LIMITS = {
  /** Time between two checkpoints. */
  every: 1e12,
  /** Milliseconds of computing after which a checkpoint is due too. So a step back also takes a short time on slow machines. */
  work: 500,
  /** Maximum sum of the bytes of older checkpoints. One older checkpoint always remains, even if it exceeds the maximum. The newest
   *  checkpoint needs as many bytes as the memory. */
  bytes: 160e6,
  /** Maximum number of checkpoints. */
  count: 64,
  /** Maximum number of lost bytes. After a return to an instant with a smaller memory, the allocator cannot use the rest of the memory. */
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
    /** Checkpoints, the oldest first. Each has the instant, the note of the caller, the size of the memory, the number of lost bytes in
     *  this size, and the pages that turn the next newer checkpoint into this checkpoint. */
    this.all = [];
    this.newest = new Uint8Array(0);
  }

  /** Sum of the bytes of older checkpoints. */
  get bytes() {
    return this.all.reduce((sum, { pages }) => sum + pages.size * PAGE, 0);
  }

  /** Takes a checkpoint at an instant if a checkpoint is due. A checkpoint is also due if the memory has grown, because a return to a
   *  smaller memory loses the difference. Returns true if a checkpoint was taken. `back` returns the `note`. `worked`
   *  is the number of milliseconds of computing since the last checkpoint. */
  take(at, note, worked = 0) {
    const last = this.all.at(-1);
    const size = this.memory.buffer.byteLength;
    const due = !last || at >= last.at + this.limits.every || worked >= this.limits.work || size > last.size;
    if (!due || at <= last?.at) return false;
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
      // The previous checkpoint keeps the old content of a changed page.
      if (page * PAGE < (last?.size ?? 0)) pages.set(page, this.newest.slice(page * PAGE, (page + 1) * PAGE));
      this.newest.set(bytes.subarray(page * PAGE, (page + 1) * PAGE), page * PAGE);
    }
    this.all.push({ at, note, size, lost: this.lost, pages: new Map() });
    this.thin(at);
    return true;
  }

  /** Removes checkpoints until the limits hold. The checkpoint with the smallest distance to its neighbours, relative to its age, is
   *  removed first, so recent checkpoints stay close together. The newest three are never chosen, so a short way back is always short.
   *  If there are no others, the oldest is removed, because new machines also begin at the start. */
  thin(now) {
    const { bytes, count, every } = this.limits;
    while (this.all.length > 2 && (this.all.length > count || this.bytes > bytes)) {
      const gap = (n) => (this.all[n + 1].at - this.all[n - 1].at) / (now - this.all[n - 1].at + every);
      let closest = 0;
      for (let n = 1; n < this.all.length - 3; n += 1) if (closest === 0 || gap(n) < gap(closest)) closest = n;
      const [gone] = this.all.splice(closest, 1);
      if (closest === 0) continue;
      // The previous checkpoint takes over the pages of the removed checkpoint.
      const older = this.all[closest - 1];
      for (const [page, content] of gone.pages) if (!older.pages.has(page) && page * PAGE < older.size) older.pages.set(page, content);
    }
  }

  /** Restores the memory from the last checkpoint at or before an instant, and discards later checkpoints. Returns `{ at, note }`, or null
   *  without such a checkpoint. */
  back(to) {
    const found = this.all.findLastIndex(({ at }) => at <= to);
    if (found < 0) return null;
    const { at, note, size, lost: before } = this.all[found];
    // Bytes that were lost before the checkpoint are part of its size.
    const lost = before + this.memory.buffer.byteLength - size;
    if (lost > this.limits.lost) return null;
    for (let n = this.all.length - 2; n >= found; n -= 1) {
      for (const [page, content] of this.all[n].pages) this.newest.set(content, page * PAGE);
    }
    this.all.length = found + 1;
    this.all[found].pages = new Map();
    this.newest = this.newest.slice(0, size);
    new Uint8Array(this.memory.buffer).set(this.newest);
    this.lost = lost;
    return { at, note };
  }
}
