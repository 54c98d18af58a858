// Explanations of terms, shown beside the terms.

const at = (id) => document.getElementById(id);

/** Shows the sentence of the glossary for a marked term while the pointer or the focus is on the term. */
export function explain(glossary) {
  for (const term of document.querySelectorAll("[data-term]")) {
    const sentence = glossary[term.dataset.term];
    if (!sentence) continue;
    // A term within a button, a label or a summary needs no focus, because that element can have the focus.
    if (!term.closest("button, label, summary")) term.tabIndex = 0;
    term.setAttribute("aria-description", sentence);
    const show = () => {
      const place = term.getBoundingClientRect();
      const hint = at("hint");
      hint.textContent = sentence;
      hint.hidden = false;
      // If there is room, the hint is above the term, so the content below the term stays visible.
      const isRoom = place.top > hint.offsetHeight + 12;
      hint.style.left = `${Math.max(8, Math.min(place.left, innerWidth - hint.offsetWidth - 8))}px`;
      hint.style.top = `${(isRoom ? place.top - hint.offsetHeight - 6 : place.bottom + 6) + scrollY}px`;
    };
    const hide = () => (at("hint").hidden = true);
    const holder = term.closest("label")?.querySelector("select, input") ?? term.closest("button, summary") ?? term;
    // The hint appears after a delay, so a passing pointer shows no hint. A pressed button shows no hint.
    let soon = 0;
    term.addEventListener("pointerenter", () => (soon = setTimeout(show, 350)));
    term.addEventListener("pointerleave", () => { clearTimeout(soon); hide(); });
    holder.addEventListener("pointerdown", () => { clearTimeout(soon); hide(); });
    holder.addEventListener("focus", () => holder.matches(":focus-visible") && show());
    holder.addEventListener("blur", hide);
  }
}
