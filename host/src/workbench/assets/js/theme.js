// Light and dark.

const listeners = [];

/** Calls `does` when colours have changed. */
export const onTheme = (does) => listeners.push(does);

const media = matchMedia("(prefers-color-scheme: dark)");
const now = () => document.documentElement.dataset.theme ?? (media.matches ? "dark" : "light");

function set(theme) {
  document.documentElement.dataset.theme = theme;
  // What draws the tabs, once it is loaded.
  if (typeof servoid !== "undefined") servoid.theme(theme);
  for (const does of listeners) does();
}

/** The other one. */
export const turn = () => set(now() === "dark" ? "light" : "dark");

media.addEventListener("change", () => set(media.matches ? "dark" : "light"));
set(now());
