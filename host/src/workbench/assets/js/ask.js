// Asks the program for what lies on the bench, and for work.

async function answer(path, body) {
  const text = typeof body === "string";
  const options = body === undefined ? {} : {
    method: "POST",
    headers: { "content-type": text ? "text/plain" : "application/json" },
    body: text ? body : JSON.stringify(body),
  };
  return answered(await fetch(path, options));
}

async function answered(response) {
  if (response.ok) return response;
  const said = await response.text();
  let error = said || `${response.status} ${response.statusText}`;
  try {
    error = JSON.parse(said).error ?? error;
  } catch {
    // It is no JSON: what was said is the error.
  }
  throw new Error(error);
}

/** The answer as JSON; with a body it is posted. */
export async function ask(path, body) {
  const text = await (await answer(path, body)).text();
  return text ? JSON.parse(text) : {};
}

/** Sends a file as it is; the answer as JSON. */
export async function send(path, file) {
  const response = await answered(await fetch(path, { method: "POST", headers: { "content-type": "application/octet-stream" }, body: file }));
  return response.json();
}

/** The answer as numbers of a kind: `Float32Array`, `Float64Array`, `Uint8Array`. */
export async function numbers(path, Kind, body) {
  return new Kind(await (await answer(path, body)).arrayBuffer());
}

const kept = new Map();

/** Numbers that never change under their key; asked for once. */
export function keptNumbers(key, path, Kind) {
  if (!kept.has(key)) {
    const asked = numbers(path, Kind);
    kept.set(key, asked);
    asked.catch(() => kept.delete(key));
    if (kept.size > 64) kept.delete(kept.keys().next().value);
  }
  return kept.get(key);
}
