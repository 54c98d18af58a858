// Files that a visitor can save.

/** Saves a file with the browser. */
export function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Returns the pictures of all machines side by side as a PNG, with wire frame, beam and regions. */
export function wholePicture(machines, eyesShown) {
  const all = machines.flatMap(({ eyes }) => eyes.slice(0, eyesShown));
  const whole = document.createElement("canvas");
  whole.width = all.reduce((sum, { canvas }) => sum + canvas.width, 0);
  whole.height = Math.max(...all.map(({ canvas }) => canvas.height));
  const context = whole.getContext("2d");
  let left = 0;
  for (const { canvas, over } of all) {
    context.drawImage(canvas, left, 0);
    context.drawImage(over, left, 0);
    left += canvas.width;
  }
  return new Promise((done) => whole.toBlob(done));
}
