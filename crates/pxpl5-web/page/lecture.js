// The lecture mode: pictures and text as large as the screen allows, in a full screen or with `lecture` in the address.

const at = (id) => document.getElementById(id);

export const isLecture = () => document.body.classList.contains("lecture");

/** Returns an address with `lecture` if the page is in this mode, so that each step has its link. */
export const keepLecture = (address) => (isLecture() ? `${address}&lecture` : address);

function show(isOn) {
  document.body.classList.toggle("lecture", isOn);
  at("full").setAttribute("aria-pressed", String(isOn));
  at("full").textContent = isOn ? "Leave full screen" : "Full screen";
}

/** Fills the screen, or leaves it. */
function fill() {
  if (document.fullscreenElement) return document.exitFullscreen();
  if (isLecture()) {
    show(false);
    return history.replaceState(null, "", location.hash.replace(/&?lecture(=[^&]*)?/, "") || location.pathname);
  }
  // Without a full screen, the lecture mode fills the window.
  return document.documentElement.requestFullscreen?.().catch(() => show(true)) ?? show(true);
}

/** Connects the button and the key F, and begins in lecture mode if the address has `lecture`. */
export function lecture() {
  at("full").addEventListener("click", fill);
  addEventListener("keydown", (event) => {
    const isText = event.target.matches?.("input:not([type=checkbox], [type=range]), select, textarea");
    if (event.key.toLowerCase() !== "f" || isText || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    fill();
  });
  document.addEventListener("fullscreenchange", () => show(document.fullscreenElement !== null && !document.body.classList.contains("held")));
  if (new URLSearchParams(location.hash.slice(1)).has("lecture")) show(true);
}
