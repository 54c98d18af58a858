// The scene of the run on a spinning screen, slice by slice and from any side.
import { picture } from "./draw.js";

const at = (id) => document.getElementById(id);

/** Connects the controls of the spinning screen. `volumeWorker` starts the worker that draws the slices, and `refused` shows an error. */
export function spinningScreen({ volumeWorker, refused }) {
  let ask = null;
  at("volume-draw").addEventListener("click", async () => {
    at("volume-says").textContent = "Drawing ...";
    try {
      ask = await volumeWorker();
      const begun = performance.now();
      const [slices, width, height] = await ask("volume");
      at("volume-says").textContent = `${slices} slices drawn in ${((performance.now() - begun) / 1000).toFixed(1)} s`;
      Object.assign(at("slice"), { max: slices - 1, value: Math.round(slices / 4) });
      Object.assign(at("slice-picture"), { width, height });
      await Promise.all([slice(), round()]);
      at("volume").hidden = false;
    } catch (error) {
      at("volume-says").textContent = "";
      await refused(error);
    }
  });

  async function slice() {
    at("slice-number").textContent = at("slice").value;
    picture(at("slice-picture"), await ask("slice", { number: Number(at("slice").value) }));
  }

  async function round() {
    const [azimuth, elevation] = ["azimuth", "elevation"].map((id) => Number(at(id).value));
    picture(at("volume-picture"), await ask("round", { azimuth, elevation, side: at("volume-picture").width }));
  }

  at("slice").addEventListener("input", slice);
  for (const id of ["azimuth", "elevation"]) at(id).addEventListener("change", round);
}
