// The page of the workbench: shows what lies on the bench, and asks for work. The bench itself is kept by the program.
"use strict";
{
  const at = (id) => document.getElementById(id);
  let bench = null;
  let shown = null;
  let shownModels = null;
  let shownChosen = null;
  let picturesAsked = 0;
  let live = new Map();

  // ---- asking

  async function ask(path, body) {
    const options = body === undefined ? {} : {
      method: "POST",
      headers: { "content-type": typeof body === "string" ? "text/plain" : "application/json" },
      body: typeof body === "string" ? body : JSON.stringify(body),
    };
    const answer = await fetch(path, options);
    const text = await answer.text();
    let value = {};
    try {
      value = text ? JSON.parse(text) : {};
    } catch {
      value = { error: text };
    }
    if (!answer.ok) throw new Error(value.error || `${answer.status} ${answer.statusText}`);
    return value;
  }

  // What went wrong with what this page asked for, until something goes right; else what the bench says of its work.
  let wrong = "";
  const SILENT = "The workbench does not answer";

  function say(error) {
    wrong = error ? String(error.message || error) : "";
    showFault();
  }

  function showFault() {
    const text = wrong || (bench && bench.fault) || "";
    at("fault").hidden = !text;
    at("fault").textContent = text;
  }

  const act = (path, body) => ask(path, body).then(() => say(null), say);
  const work = (what) => act("work", what);

  // Whether something else may take the place of what is on the bench. It is asked where models would go.
  function putAway() {
    if (!bench || !bench.models.length) return Promise.resolve(true);
    const count = bench.models.length === 1 ? "One model" : `${bench.models.length} models`;
    at("put-away-what").textContent =
      `${count} of ${bench.recording.name} will make room. Undo brings everything back while this workbench runs; ` +
      "to keep it for longer, take it away as a session first.";
    at("put-away").returnValue = "";
    at("put-away").showModal();
    return new Promise((answer) => {
      at("put-away").addEventListener("close", () => answer(at("put-away").returnValue === "yes"), { once: true });
    });
  }

  // ---- making elements

  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
      else if (name in made && name !== "list") made[name] = value;
      else made.setAttribute(name, value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
  }

  // An error with the digits that tell.
  function counts(rms) {
    if (rms === null || rms === undefined) return "-";
    if (rms < 10) return rms.toFixed(3);
    return rms < 1e5 ? rms.toFixed(1) : rms.toExponential(2);
  }

  const digits = (x) => (x === 0 ? "0" : Number(x.toPrecision(5)).toString());

  // ---- showing

  function model(id) {
    return bench.models.find((one) => one.id === id);
  }

  function show() {
    const { recording, job } = bench;
    at("start").hidden = recording !== null;
    at("bench").hidden = recording === null;
    at("another").hidden = recording === null;
    at("undo").disabled = Boolean(job) || !bench.undo;
    at("redo").disabled = Boolean(job) || !bench.redo;
    if (wrong.startsWith(SILENT)) wrong = "";
    showFault();
    if (!recording) {
      at("about").textContent = "Identify a DC servo motor from a recording, and see which physics is missing.";
      return;
    }
    const heldOut = recording.held_out
      ? `held out, never fitted: ${recording.held_out}`
      : recording.held_out_from_s === null
        ? "nothing is held out: the recording is too short"
        : `its end is held out, from ${recording.held_out_from_s.toFixed(3)} s on`;
    at("about").textContent =
      `${recording.name}: ${recording.samples} samples, ${recording.seconds.toFixed(3)} s, ` +
      `${recording.counts_per_rev} counts a revolution; ${heldOut}`;
    const chosen = model(bench.chosen);
    const beside = model(bench.against);
    // A fit tells its error as it falls, until something else is looked at.
    if (job !== "fit" || shownChosen !== bench.chosen) at("error-now").textContent = chosen ? counts(chosen.rms_counts) : "-";
    shownChosen = bench.chosen;
    const notes = chosen ? chosen.notes : [];
    at("notes").replaceChildren(...notes.map((note) => element("li", {}, note)));
    at("notes-count").textContent = notes.length === 1 ? "One thing to know of this fit" : `${notes.length} things to know of this fit`;
    at("notes-panel").hidden = !notes.length;
    at("error-more").textContent = chosen ? more(chosen, beside) : "Nothing is fitted yet.";
    for (const id of ["diagnose", "suggest", "add", "refit", "race", "demo", "load"]) at(id).disabled = Boolean(job);
    at("suggest").disabled = Boolean(job) || !chosen;
    at("stop").hidden = !job;
    if (!job) at("progress").textContent = "";
    else if (!at("progress").textContent) at("progress").textContent = `${job} …`;
    at("verdict").textContent = bench.diagnosis ? bench.diagnosis.summary : "";
    showSecret();
    showModels();
    showEffects(chosen);
    showSuggestions();
    showSliders(chosen);
    showChoices();
  }

  function more(chosen, beside) {
    const parts = [`${counts(chosen.held_out_rms_counts)} held out`, `the encoder alone leaves ${counts(bench.floor_counts)}`];
    if (beside) {
      const fall = beside.rms_counts / chosen.rms_counts;
      if (fall > 1.05) parts.unshift(`${fall.toFixed(fall < 10 ? 1 : 0)} times less than the ${beside.name} (${counts(beside.rms_counts)})`);
    }
    return parts.join("; ");
  }

  function showSecret() {
    at("blind").hidden = !bench.secret;
    if (!bench.secret) return;
    at("reveal").hidden = bench.secret.told !== null;
    at("secret").textContent = bench.secret.told === null ? "" : `Hidden was ${bench.secret.told}`;
  }

  function showModels() {
    const rows = bench.models.map((one) => {
      const radio = (name, current, change) => element("input", {
        type: "radio", name, checked: current === one.id, "aria-label": `${name} ${one.name}`, onchange: change,
      });
      return element("tr", { className: one.id === bench.chosen ? "chosen" : "" },
        element("td", {}, radio("look at", bench.chosen, () => act("choose", { chosen: one.id, against: bench.against }))),
        element("td", {}, radio("beside", bench.against, () => act("choose", { chosen: bench.chosen, against: one.id }))),
        element("td", {}, one.name),
        element("td", {}, counts(one.rms_counts)),
        element("td", {}, counts(one.held_out_rms_counts)),
        element("td", {}, element("button", {
          type: "button", textContent: "×", "aria-label": `remove ${one.name}`,
          onclick: () => act("remove", { model: one.id }),
        })));
    });
    at("models").tBodies[0].replaceChildren(...rows);
  }

  const fit = (effects) => work({ what: "fit", effects, algorithm: at("algorithm").value || "lm" });

  function showEffects(chosen) {
    const effects = chosen ? chosen.effects : [];
    const without = (name) => effects.filter((other) => other !== name);
    at("effects").replaceChildren(...(effects.length
      ? effects.map((name) => element("li", {}, name, element("button", {
        type: "button", textContent: "×", "aria-label": `fit without ${name}`, onclick: () => fit(without(name)),
      })))
      : [element("li", { className: "quiet" }, "none: the linear motor")]));
  }

  function showSuggestions() {
    const box = at("suggestions");
    const found = bench.suggested;
    if (!found) {
      box.replaceChildren();
      return;
    }
    const of = model(found.of);
    if (!found.list.length) {
      box.replaceChildren(element("p", {}, "Nothing: this model leaves only what the encoder leaves."));
      return;
    }
    box.replaceChildren(...found.list.map((one) => {
      const rows = [
        ["foreseen", `${counts(one.foreseen_rms_counts)} counts RMS`],
        ["fitted", `${counts(one.rms_counts)}, held out ${counts(one.held_out_rms_counts)}`],
        ["evidence", one.evidence || "nothing that a drawing shows"],
        ["equation", one.equation],
        ["looks like", one.looks_like.join(", ") || "nothing else"],
        ["exposed by", one.exposed_by],
      ];
      const list = element("dl");
      for (const [name, text] of rows) list.append(element("dt", {}, name), element("dd", {}, text));
      const after = of ? of.effects : [];
      const swaps = after.map((old) => element("button", {
        type: "button", textContent: `In place of ${old}`, disabled: Boolean(bench.job),
        onclick: () => fit([...after.filter((other) => other !== old), one.effect]),
      }));
      return element("article", { className: one.believed ? "card believed" : "card" },
        element("h3", {}, `${one.effect}: ${one.title}`), list,
        element("div", { className: "row" }, element("button", {
          type: "button", className: "main", textContent: `Add ${one.effect}`, disabled: Boolean(bench.job),
          onclick: () => fit([...after, one.effect]),
        }), ...swaps));
    }));
  }

  let slidersOf = null;
  const moved = {};
  let trying = null;

  function showSliders(chosen) {
    const key = chosen ? `${chosen.id}:${chosen.rms_counts}` : null;
    if (key === slidersOf) return;
    slidersOf = key;
    for (const name of Object.keys(moved)) delete moved[name];
    at("by-hand").textContent = "";
    const sliders = chosen && chosen.sliders ? chosen.sliders : [];
    at("sliders").replaceChildren(...sliders.map((one, k) => {
      const value = element("output", {}, `${digits(one.value)} ${one.unit}`);
      const range = element("input", {
        type: "range", id: `slider-${k}`, min: "0", max: "1000", value: String(placeOf(one, one.value)),
        oninput: (event) => {
          const x = valueAt(one, Number(event.target.value));
          value.textContent = `${digits(x)} ${one.unit}`;
          moved[one.name] = x;
          tryMoved(chosen);
        },
      });
      return element("div", { className: "slider" }, element("label", { htmlFor: `slider-${k}` }, one.name), value, range);
    }));
  }

  // A slider moves by equal parts of the value; zero has none to move by.
  function valueAt(one, place) {
    const turn = Math.sign(one.value) || 1;
    const [low, high] = [Math.abs(one.value) / 3, Math.abs(one.value) * 3];
    return low === 0 ? 0 : turn * low * (high / low) ** (place / 1000);
  }
  const placeOf = () => 500;

  function tryMoved(chosen) {
    clearTimeout(trying);
    trying = setTimeout(async () => {
      try {
        const answer = await ask("trial", { model: chosen.id, values: moved });
        at("by-hand").textContent = `moved by hand: ${answer.said} counts RMS (fitted: ${counts(chosen.rms_counts)})`;
        await servoid.draw(at("bench-timeline"), answer.timeline);
        say(null);
      } catch (error) {
        say(error);
      }
    }, 40);
  }

  function showChoices() {
    const fill = (select, names) => {
      if (select.options.length === names.length) return;
      select.replaceChildren(...names.map(([value, text]) => element("option", { value }, text)));
    };
    fill(at("effect"), bench.effects.map((one) => [one.name, `${one.name}: ${one.title}`]));
    for (const name of bench.formats) {
      if (!at("format").querySelector(`option[value="${name}"]`)) at("format").append(element("option", { value: name }, name));
    }
    fill(at("algorithm"), bench.algorithms.map((name) => [name, name]));
    if (!at("racers").childElementCount) {
      const usual = ["ga", "pso", "firefly"];
      at("racers").replaceChildren(...bench.algorithms.map((name) => element("label", {},
        element("input", { type: "checkbox", value: name, checked: usual.includes(name) }), name)));
      if (bench.algorithms.includes("lm")) at("algorithm").value = "lm";
    }
  }

  // ---- drawings

  async function drawAll() {
    if (!bench.recording) return;
    const key = `${bench.revision}`;
    const models = JSON.stringify([bench.chosen, bench.against, bench.models.map((one) => [one.id, one.rms_counts])]);
    // While work goes on, only other models are worth the drawing.
    if (key === shown || (bench.job && models === shownModels)) return;
    shown = key;
    shownModels = models;
    picturesAsked += 1;
    const asked = picturesAsked;
    try {
      const answer = await ask("pictures");
      if (asked !== picturesAsked) return;
      await servoid.draw(at("bench-timeline"), answer.timeline);
      for (const div of document.querySelectorAll("#pictures .plot")) servoid.forget(div);
      at("pictures").innerHTML = answer.html;
      for (const [id, drawing] of Object.entries(answer.drawings)) await servoid.draw(at(id), drawing);
      document.body.dataset.drawn = key;
    } catch (error) {
      say(error);
    }
  }

  async function refresh() {
    try {
      bench = await ask("state");
      show();
      await drawAll();
    } catch (error) {
      say(`${SILENT} (${error.message}). If it was ended, start it again and open its new address.`);
    }
  }

  // ---- what goes on

  function progress(what) {
    const { job } = what;
    if (what.tried !== undefined) {
      at("progress").textContent = `${job}: ${what.tried} models tried`;
      return;
    }
    const name = what.algorithm || "error";
    at("progress").textContent = what.algorithm
      ? `race: ${name} after ${what.evaluations} evaluations`
      : `${job}: ${what.evaluations} evaluations`;
    if (what.rms_counts === null) return;
    if (job === "fit") at("error-now").textContent = counts(what.rms_counts);
    if (!live.has(name)) live.set(name, { x: [], y: [] });
    live.get(name).x.push(what.evaluations);
    live.get(name).y.push(what.rms_counts);
    drawLive();
  }

  let liveDrawn = 0;
  function drawLive() {
    if (performance.now() - liveDrawn < 60) return;
    liveDrawn = performance.now();
    at("live").hidden = false;
    const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b", "#7f8790"];
    const data = [...live.entries()].map(([name, line], k) => ({
      type: "scatter", mode: "lines", name, x: line.x.slice(), y: line.y.slice(), line: { color: colours[k % 8] },
    }));
    const layout = {
      height: 200, margin: { l: 56, r: 8, t: 8, b: 40 }, showlegend: data.length > 1,
      xaxis: { title: { text: "model evaluations" } }, yaxis: { type: "log", title: { text: "counts RMS" } },
    };
    servoid.draw(at("live"), { chart: { data, layout } });
  }

  const events = new EventSource("events");
  events.addEventListener("changed", async () => {
    const before = bench && bench.job;
    await refresh();
    if (bench && bench.job && bench.job !== before) live = new Map();
  });
  events.addEventListener("progress", (event) => progress(JSON.parse(event.data)));
  events.addEventListener("error", () => refresh());

  // ---- files

  let dropped = null;

  async function take(files) {
    say(null);
    if (bench && bench.job) {
      say(`The bench is busy (${bench.job}): wait for it, or stop it first.`);
      return;
    }
    const texts = await Promise.all(Array.from(files).map(async (file) => ({ name: file.name, text: await file.text() })));
    const session = texts.find((file) => /^[\s\uFEFF]*\{/.test(file.text) || file.name.toLowerCase().endsWith(".json"));
    if (session) {
      const text = session.text.replace(/^\uFEFF/, "");
      try {
        await ask("session?check=true", text);
      } catch (error) {
        say(error);
        return;
      }
      if (await putAway()) await act("session", text);
      return;
    }
    const motor = texts.find((file) => file.name.endsWith(".toml"));
    const csv = texts.filter((file) => file !== motor);
    if (!csv.length) {
      say("There is no recording among these files: drop a CSV with time, voltage and angle.");
      return;
    }
    dropped = { name: csv[0].name, csv: csv[0].text, motor: motor ? motor.text : null };
    if (motor) {
      try {
        await send({ motor: dropped.motor, check: true });
        if (!await putAway()) return;
        // As on the command line: of several the last judges, and the others are fitted together.
        for (const [place, file] of csv.entries()) {
          dropped = { name: file.name, csv: file.text, motor: motor.text };
          const last = place > 0 && place === csv.length - 1;
          await send({ motor: motor.text, role: place === 0 ? "fitted" : last ? "held_out" : "beside" });
        }
        await fitNow();
        return;
      } catch (error) {
        say(error);
      }
    }
    await openColumns();
  }

  const send = (more) => ask("recording", { name: dropped.name, csv: dropped.csv, ...more });

  async function load(more) {
    await send(more);
    await fitNow();
  }

  async function fitNow() {
    if (at("columns").open) at("columns").close();
    await work({ what: "fit", effects: [], algorithm: "lm" });
  }

  async function openColumns() {
    const preview = await ask("preview", dropped.csv.slice(0, 65536));
    at("file-name").textContent = dropped.name;
    const row = (cells, tag) => element("tr", {}, ...cells.map((text) => element(tag, {}, text)));
    at("first-rows").replaceChildren(
      element("thead", {}, row(preview.header, "th")),
      element("tbody", {}, ...preview.rows.map((cells) => row(cells, "td"))));
    for (const what of ["time", "voltage", "angle", "current", "enabled"]) {
      const select = at(`map-${what}`);
      select.replaceChildren(element("option", { value: "" }, "not there"),
        ...preview.header.map((name) => element("option", { value: name }, name)));
      select.value = preview.guess[what];
    }
    for (const unit of ["time_unit", "voltage_unit", "angle_unit"]) at(`map-${unit}`).value = preview.guess[unit];
    at("role-field").hidden = !bench.recording;
    at("role").value = "fitted";
    if (!at("columns").open) at("columns").showModal();
    await checkColumns();
  }

  function mapping() {
    const chosen = {};
    for (const key of ["time", "voltage", "angle", "current", "enabled", "time_unit", "voltage_unit", "angle_unit"]) {
      chosen[key] = at(`map-${key}`).value;
    }
    for (const key of ["counts_per_rev", "supply_v", "resistance_ohm"]) {
      const field = at(`map-${key}`);
      chosen[key] = field.value === "" ? null : Number(field.value);
      // What is no number has no value, and must not pass for a field that was left empty.
      if (field.validity.badInput) throw new Error(`${field.closest("label").firstChild.textContent.trim()}: this is not a number`);
    }
    return chosen;
  }

  let checks = 0;

  async function checkColumns() {
    checks += 1;
    const own = checks;
    let fault = "";
    try {
      await send({ mapping: mapping(), check: true });
    } catch (error) {
      // Fields have no lines.
      fault = error.message.replace(/^motor\.toml:\d+:\d+: /, "");
    }
    // An answer to what is no longer chosen says nothing.
    if (own !== checks) return;
    at("column-fault").hidden = !fault;
    at("column-fault").textContent = fault;
    at("load").disabled = Boolean(fault) || Boolean(bench && bench.job);
  }

  at("columns").addEventListener("change", checkColumns);
  at("load").addEventListener("click", () => {
    const role = bench.recording ? at("role").value : "fitted";
    const room = role === "fitted" ? putAway() : Promise.resolve(true);
    room.then((free) => free && load({ mapping: mapping(), role })).catch((error) => {
      at("column-fault").hidden = false;
      at("column-fault").textContent = error.message;
    });
  });
  at("file").addEventListener("change", (event) => take(event.target.files).catch(say));
  at("another").addEventListener("click", () => {
    const hidden = at("start").hidden;
    at("start").hidden = !hidden;
    if (hidden) at("start").scrollIntoView();
  });
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    at("drop").classList.add("over");
  });
  document.addEventListener("dragleave", () => at("drop").classList.remove("over"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    at("drop").classList.remove("over");
    if (event.dataTransfer.files.length) take(event.dataTransfer.files).catch(say);
  });

  // ---- buttons

  at("demo").addEventListener("click", async () => {
    if (!await putAway()) return;
    at("demo").disabled = true;
    try {
      await ask("demo", {});
      await work({ what: "fit", effects: [], algorithm: "lm" });
    } catch (error) {
      say(error);
    }
    at("demo").disabled = false;
  });
  at("put-away-yes").addEventListener("click", () => at("put-away").close("yes"));
  at("put-away-no").addEventListener("click", () => at("put-away").close(""));
  at("undo").addEventListener("click", () => act("undo", {}));
  at("redo").addEventListener("click", () => act("redo", {}));
  document.addEventListener("keydown", (event) => {
    const typing = event.target.matches("input:not([type=range]):not([type=checkbox]):not([type=radio]), textarea, select");
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || typing) return;
    event.preventDefault();
    const button = at(event.shiftKey ? "redo" : "undo");
    if (!button.disabled) button.click();
  });
  at("reveal").addEventListener("click", () => act("reveal", {}));
  at("diagnose").addEventListener("click", () => work({ what: "diagnose" }));
  at("stop").addEventListener("click", () => ask("stop", {}).catch(say));
  at("suggest").addEventListener("click", () => work({ what: "suggest", model: bench.chosen }));
  at("add").addEventListener("click", () => {
    const chosen = model(bench.chosen);
    fit([...(chosen ? chosen.effects : []), at("effect").value]);
  });
  at("refit").addEventListener("click", () => {
    const chosen = model(bench.chosen);
    fit(chosen ? chosen.effects : []);
  });
  at("put-back").addEventListener("click", () => {
    slidersOf = null;
    showSliders(model(bench.chosen));
    shown = null;
    drawAll();
  });
  at("take").addEventListener("click", async () => {
    const answer = await fetch(`export?format=${at("format").value}`);
    if (!answer.ok) {
      say((await answer.json()).error);
      return;
    }
    say(null);
    const name = /filename="([^"]+)"/.exec(answer.headers.get("content-disposition"))[1];
    const link = element("a", { href: URL.createObjectURL(await answer.blob()), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
  at("race").addEventListener("click", () => {
    const algorithms = Array.from(document.querySelectorAll("#racers input:checked"), (box) => box.value);
    const chosen = model(bench.chosen);
    work({
      what: "race", algorithms, effects: chosen ? chosen.effects : [],
      budget: Number(at("budget").value), seeds: Number(at("seeds").value),
    });
  });
}
