// The whole loop by keys.

const TYPES = "input:not([type=range]):not([type=checkbox]):not([type=radio]), textarea, select";

/** Listens; `does` holds what each key does. */
export function listen(does) {
  document.addEventListener("keydown", (event) => {
    if (event.target.matches(TYPES) || document.querySelector("dialog[open]")) return;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      event.preventDefault();
      if (event.shiftKey) does.redo();
      else does.undo();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // What has the focus has its own keys.
    const own = event.target.matches("button, [role=button], a, summary, input");
    const act = {
      ArrowUp: () => does.proposal(-1), ArrowDown: () => does.proposal(1),
      ArrowLeft: () => does.cursor(event.shiftKey ? -10 : -1), ArrowRight: () => does.cursor(event.shiftKey ? 10 : 1),
      Enter: own ? null : does.add, " ": own ? null : does.before,
      l: does.lock, t: does.theme, "+": () => does.window(0.5), "-": () => does.window(2),
      PageUp: () => does.pan(-0.5), PageDown: () => does.pan(0.5), Escape: does.escape,
    }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const tab = /^[1-9]$/.test(event.key) ? () => does.tab(Number(event.key) - 1) : null;
    if (!act && !tab) return;
    if (event.target.matches("input[type=range], input[type=radio], input[type=checkbox]") && event.key !== "Escape") return;
    event.preventDefault();
    (act ?? tab)();
  });
}
