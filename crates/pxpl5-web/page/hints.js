// Explanations of terms, shown beside them.

const at = (id) => document.getElementById(id);

/** Has every marked term explained by its sentence of the glossary: on the pointer's rest, and on the focus. */
export function explain(glossary) {
  for (const term of document.querySelectorAll("[data-term]")) {
    const sentence = glossary[term.dataset.term];
    if (!sentence) continue;
    // Inside of what has the focus anyway the term itself needs none.
    if (!term.closest("button, label, summary")) term.tabIndex = 0;
    term.setAttribute("aria-description", sentence);
    const show = () => {
      const place = term.getBoundingClientRect();
      const hint = at("hint");
      hint.textContent = sentence;
      hint.hidden = false;
      // Above the term, where there is room, so that what stands below it stays in sight.
      const isRoom = place.top > hint.offsetHeight + 12;
      hint.style.left = `${Math.max(8, Math.min(place.left, innerWidth - hint.offsetWidth - 8))}px`;
      hint.style.top = `${(isRoom ? place.top - hint.offsetHeight - 6 : place.bottom + 6) + scrollY}px`;
    };
    const hide = () => (at("hint").hidden = true);
    const holder = term.closest("label")?.querySelector("select, input") ?? term.closest("button, summary") ?? term;
    // Not at once, so that nothing is covered on the way to something else; what is pressed is not explained.
    let soon = 0;
    term.addEventListener("pointerenter", () => (soon = setTimeout(show, 350)));
    term.addEventListener("pointerleave", () => { clearTimeout(soon); hide(); });
    holder.addEventListener("pointerdown", () => { clearTimeout(soon); hide(); });
    holder.addEventListener("focus", () => holder.matches(":focus-visible") && show());
    holder.addEventListener("blur", hide);
  }
}
