// What a model is called and drawn in: one colour and one letter over the whole page, in the order in which models were made.

const NAMES = ["a", "b", "c", "d", "e"];

/** Its letter. */
export const letter = (id) => {
  const k = id - 1;
  return (k >= 26 ? String.fromCharCode(64 + Math.floor(k / 26)) : "") + String.fromCharCode(65 + (k % 26));
};

/** The name of its colour among the style's variables. */
export const variable = (id) => `--model-${NAMES[(id - 1) % NAMES.length]}`;

/** Its colour, for what is drawn by the style. */
export const colour = (id) => `var(${variable(id)})`;

/** The value of a variable of the style, for a canvas. */
export const value = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The name of an effect or a parameter as it is said. */
export const spoken = (name) => name.replace(/_/g, " ");

/** What a model has that the one from which it was made has not: `+ Coulomb`, `− cogging`; of the first, its own name. */
export function step(model, parent) {
  if (!parent) return model.effects.length ? model.effects.join(", ") : "linear";
  const added = model.effects.filter((one) => !parent.effects.includes(one));
  const gone = parent.effects.filter((one) => !model.effects.includes(one));
  const parts = [...added.map((one) => `+ ${one}`), ...gone.map((one) => `− ${one}`)];
  if (!parts.length) return model.algorithm;
  return parts.join(", ");
}
