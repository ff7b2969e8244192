// Draws what the program laid out: charts as they are, long series thinned for what is seen of them.
"use strict";
const servoid = (() => {
  const CONFIG = {
    displaylogo: false,
    // Plotly's own way forgets the height with the width; `watched` sees to it.
    responsive: false,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
    toImageButtonOptions: { format: "svg" },
  };
  // More points than this a pixel show nothing more.
  const POINTS_A_PIXEL = 2;
  // Width on paper, in the pixels of a sheet of A4 within its margins.
  const PRINTED = 680;
  // Below this width two drawings side by side have no room for the titles of their axes.
  const NARROW = 520;
  // Width and height where nothing says them.
  const [WIDTH, HEIGHT] = [700, 360];
  // A window that is being dragged is drawn for when it rests.
  const RESTS_MS = 80;
  const all = new Map();
  let printing = false;

  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Ground, text and grid in the colours of light or dark.
  function themed(layout) {
    const out = { ...layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)" };
    out.font = { ...layout.font, color: style("--text") };
    out.hoverlabel = { bgcolor: style("--raised"), font: { color: style("--text") }, bordercolor: style("--line") };
    out.modebar = { bgcolor: "rgba(0,0,0,0)", color: style("--quiet"), activecolor: style("--accent") };
    for (const key of Object.keys(layout)) {
      if (/^[xy]axis\d*$/.test(key)) {
        out[key] = {
          ...layout[key],
          gridcolor: style("--grid"),
          linecolor: style("--line"),
          zerolinecolor: style("--quiet"),
        };
      }
    }
    return out;
  }

  // The layout with both of its sides, which the place has, too, whatever happens inside it.
  function sized(div, layout) {
    const width = printing ? PRINTED : div.clientWidth || WIDTH;
    const out = { height: HEIGHT, ...layout, width };
    const { grid } = layout;
    if (grid && grid.columns > 1 && width < NARROW) {
      out.grid = { ...grid, rows: grid.rows * grid.columns, columns: 1 };
      out.height *= 1.7;
    }
    div.style.height = `${out.height}px`;
    return out;
  }

  function unpacked(text, Kind) {
    const raw = atob(text);
    const bytes = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k += 1) bytes[k] = raw.charCodeAt(k);
    return new Kind(bytes.buffer);
  }

  function times(time) {
    if (time.even) {
      const [step, count] = time.even;
      return Float64Array.from({ length: count }, (_, k) => k * step);
    }
    return unpacked(time.each, Float64Array);
  }

  // First index at or behind `t`.
  function indexOf(time, t) {
    let [low, high] = [0, time.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle] < t) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // The extremes of each of `blocks` between two samples: what a line as wide as the drawing would show.
  function thinned(time, values, from, to, blocks) {
    if (to - from <= 2 * blocks) {
      return { x: Array.from(time.subarray(from, to)), y: Array.from(values.subarray(from, to)) };
    }
    const [x, y] = [[], []];
    for (let block = 0; block < blocks; block += 1) {
      const begin = from + Math.floor(((to - from) * block) / blocks);
      const end = from + Math.floor(((to - from) * (block + 1)) / blocks);
      let [least, most] = [begin, begin];
      for (let k = begin; k < end; k += 1) {
        if (values[k] < values[least]) least = k;
        if (values[k] > values[most]) most = k;
      }
      for (const k of least < most ? [least, most] : [most, least]) {
        x.push(time[k]);
        y.push(values[k]);
        if (least === most) break;
      }
    }
    return { x, y };
  }

  // A timeline's arrays, unpacked once.
  function series(timeline) {
    const measured = unpacked(timeline.measured, Float32Array);
    const turns = (counts) => Float32Array.from(counts, (c) => c / timeline.countsPerRev);
    return {
      time: times(timeline.time),
      measured: turns(measured),
      runs: timeline.runs.map((run) => {
        const residual = unpacked(run.residual, Float32Array);
        return { name: run.name, colour: run.colour, residual, model: turns(measured.map((c, k) => c + residual[k])) };
      }),
      command: unpacked(timeline.command, Float32Array),
      current: timeline.current ? unpacked(timeline.current, Float32Array) : null,
    };
  }

  // The lanes of a timeline from top to bottom, with their shares of the height and their axes. A recording without a model
  // has no residual, and gets no lane for one: plotly draws the frame of a lane without data at no height at all.
  function lanesOf(timeline) {
    const lanes = [
      { name: "angle", title: "angle, turns", share: 45 },
      timeline.runs.length ? { name: "residual", title: "residual, counts", share: 27 } : null,
      { name: "command", title: timeline.commandName, share: 19 },
      timeline.current ? { name: "current", title: "current, A", share: 19 } : null,
    ].filter(Boolean);
    lanes.forEach((lane, k) => { lane.axis = k === 0 ? "y" : `y${k + 1}`; });
    return lanes;
  }

  function timelineLayout(timeline, cursors) {
    const lanes = lanesOf(timeline);
    const residual = lanes.find((lane) => lane.name === "residual");
    const layout = {
      height: 530 + 90 * (lanes.length - 2),
      margin: { l: 64, r: 16, t: 36, b: 48 },
      font: { family: "system-ui, sans-serif", size: 13 },
      hovermode: "x",
      legend: { orientation: "h", x: 0, y: 1.02, xanchor: "left", yanchor: "bottom" },
      uirevision: "same",
      xaxis: { title: { text: "time, s" }, anchor: lanes[lanes.length - 1].axis, automargin: true },
      shapes: [],
      annotations: [],
    };
    const gap = 0.03;
    const height = (1 - gap * (lanes.length - 1)) / lanes.reduce((sum, lane) => sum + lane.share, 0);
    let top = 1;
    for (const lane of lanes) {
      const bottom = Math.max(0, top - lane.share * height);
      layout[lane.axis.replace("y", "yaxis")] = {
        title: { text: lane.title }, domain: [bottom, top], zeroline: lane !== lanes[0], automargin: true,
      };
      top = bottom - gap;
    }
    if (timeline.band > 0 && residual) {
      layout.shapes.push({
        type: "rect", xref: "x domain", yref: residual.axis, x0: 0, x1: 1, y0: -timeline.band, y1: timeline.band,
        fillcolor: "#009e73", opacity: 0.25, line: { width: 0 }, layer: "below",
      });
    }
    if (timeline.worst && residual) {
      layout.shapes.push({
        type: "rect", xref: "x", yref: `${residual.axis} domain`, x0: timeline.worst[0], x1: timeline.worst[1], y0: 0, y1: 1,
        fillcolor: "#e69f00", opacity: 0.22, line: { width: 0 }, layer: "below",
      });
    }
    if (timeline.heldOutFrom !== null && timeline.heldOutFrom !== undefined) {
      layout.shapes.push({
        type: "line", xref: "x", yref: "paper", x0: timeline.heldOutFrom, x1: timeline.heldOutFrom, y0: 0, y1: 1,
        line: { color: "#009e73", dash: "dash", width: 1.5 },
      });
      layout.annotations.push({
        xref: "x", yref: "paper", x: timeline.heldOutFrom, y: 1, xanchor: "left", yanchor: "top", showarrow: false,
        text: "held out from here",
      });
    }
    for (const [name, t] of Object.entries(cursors)) {
      if (t === null) continue;
      layout.shapes.push({
        type: "line", xref: "x", yref: "paper", x0: t, x1: t, y0: 0, y1: 1, line: { color: style("--text"), width: 1 },
      });
      layout.annotations.push({
        xref: "x", yref: "paper", x: t, y: 1, yanchor: "bottom", showarrow: false, text: name,
        font: { color: style("--text") },
      });
    }
    return layout;
  }

  function timelineTraces(timeline, found, range, width) {
    const { time } = found;
    const axis = Object.fromEntries(lanesOf(timeline).map((lane) => [lane.name, lane.axis]));
    const [from, to] = range
      ? [Math.max(0, indexOf(time, range[0]) - 1), Math.min(time.length, indexOf(time, range[1]) + 2)]
      : [0, time.length];
    const blocks = Math.max(200, Math.round(width * 0.5 * POINTS_A_PIXEL));
    const line = (values, name, colour, lane, extra) => ({
      type: "scatter", mode: "lines", name, yaxis: axis[lane], line: { color: colour, width: 1.5 }, ...extra,
      ...thinned(time, values, from, to, blocks),
    });
    const traces = [line(found.measured, "measured", "#7f8790", "angle", { line: { color: "#7f8790", width: 6 }, opacity: 0.6 })];
    for (const run of found.runs) traces.push(line(run.model, run.name, run.colour, "angle", { legendgroup: run.name }));
    for (const run of found.runs) {
      traces.push(line(run.residual, `${run.name} less measured`, run.colour, "residual", { legendgroup: run.name, showlegend: false }));
    }
    const stairs = { showlegend: false, line: { color: "#7f8790", width: 1.2, shape: "hv" } };
    traces.push(line(found.command, "command", "#7f8790", "command", stairs));
    if (found.current) traces.push(line(found.current, "current", "#e69f00", "current", { showlegend: false }));
    return traces;
  }

  // What stands at the cursors, and the difference.
  function readout(state) {
    const { found, cursors, box } = state;
    box.replaceChildren();
    if (cursors.A === null && cursors.B === null) return;
    const at = (t) => Math.min(found.time.length - 1, indexOf(found.time, t));
    const rows = [["time, s", (k) => found.time[k], 4], ["measured, turns", (k) => found.measured[k], 4]];
    for (const run of found.runs) {
      rows.push([`${run.name}, turns`, (k) => run.model[k], 4]);
      rows.push([`${run.name} less measured, counts`, (k) => run.residual[k], 3]);
    }
    rows.push(["command", (k) => found.command[k], 3]);
    if (found.current) rows.push(["current, A", (k) => found.current[k], 3]);
    const table = document.createElement("table");
    const row = (cells, tag) => {
      const line = table.insertRow();
      cells.forEach((text, k) => {
        const cell = document.createElement(tag || (k === 0 ? "th" : "td"));
        if (tag) cell.scope = "col";
        else if (k === 0) cell.scope = "row";
        cell.textContent = text;
        line.append(cell);
      });
    };
    row(["", "A", "B", "B - A"], "th");
    for (const [name, of, digits] of rows) {
      const value = (t) => (t === null ? null : of(at(t)));
      const [a, b] = [value(cursors.A), value(cursors.B)];
      const text = (x) => (x === null ? "" : x.toFixed(digits));
      row([name, text(a), text(b), a === null || b === null ? "" : text(b - a)]);
    }
    box.append(table);
  }

  function redraw(state) {
    const { div, timeline, found, cursors } = state;
    const traces = timelineTraces(timeline, found, state.range, div.clientWidth || WIDTH);
    const layout = timelineLayout(timeline, cursors);
    if (state.range) layout.xaxis.range = state.range.slice();
    return Plotly.react(div, traces, themed(sized(div, layout)), CONFIG);
  }

  function paint(state) {
    if (state.timeline) return redraw(state);
    const { data, layout } = state.chart;
    return Plotly.react(state.div, data, themed(sized(state.div, { uirevision: "same", ...layout })), CONFIG);
  }

  // Draws again what has got another width, once that rests.
  const resting = new Map();
  const watched = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      clearTimeout(resting.get(target));
      resting.set(target, setTimeout(() => {
        resting.delete(target);
        const state = all.get(target);
        const width = target.clientWidth;
        if (!state || printing || width === 0 || (target.layout && target.layout.width === width)) return;
        // A legend that now needs fewer rows is put in its place by the second drawing only, when margins have followed it.
        paint(state).then(() => Plotly.redraw(target));
      }, RESTS_MS));
    }
  });

  // Every time axis on the page shows the same stretch.
  function follow(leader, range) {
    for (const state of all.values()) {
      if (state === leader || !state.onTime) continue;
      state.range = range;
      if (state.timeline) redraw(state);
      else Plotly.relayout(state.div, range ? { "xaxis.range": range } : { "xaxis.autorange": true });
    }
  }

  function rangeOf(event) {
    if ("xaxis.range[0]" in event) return [event["xaxis.range[0]"], event["xaxis.range[1]"]];
    if (Array.isArray(event["xaxis.range"])) return event["xaxis.range"].slice();
    if (event["xaxis.autorange"]) return null;
    return undefined;
  }

  function listen(state) {
    if (!state.onTime) return;
    state.div.on("plotly_relayout", (event) => {
      const range = rangeOf(event);
      const same = JSON.stringify(range) === JSON.stringify(state.range ?? null);
      if (range === undefined || same) return;
      state.range = range;
      if (state.timeline) redraw(state);
      follow(state, range);
    });
    if (!state.timeline) return;
    const put = (name, t) => {
      const time = state.found.time;
      state.cursors[name] = Math.min(time[time.length - 1], Math.max(time[0], t));
      state.active = name;
      redraw(state);
      readout(state);
    };
    state.div.on("plotly_click", (event) => put(event.event.shiftKey ? "B" : "A", event.points[0].x));
    // A and B put a cursor in the middle, the arrows move the last one; with shift by tenfold, Escape takes them away.
    // Assigned, since what was drawn here before had its own keys.
    state.div.onkeydown = (event) => {
      const time = state.found.time;
      const [from, to] = state.range || [time[0], time[time.length - 1]];
      const name = event.key.toUpperCase();
      if (name === "A" || name === "B") {
        put(name, state.cursors[name] ?? (from + to) / 2);
      } else if ((event.key === "ArrowLeft" || event.key === "ArrowRight") && state.active) {
        const step = ((to - from) / 500) * (event.shiftKey ? 10 : 1);
        put(state.active, state.cursors[state.active] + (event.key === "ArrowLeft" ? -step : step));
      } else if (event.key === "Escape") {
        state.cursors.A = null;
        state.cursors.B = null;
        redraw(state);
        readout(state);
      } else {
        return;
      }
      event.preventDefault();
    };
  }

  // Draws into `div`; drawing there again replaces what it shows and keeps the stretch of time.
  async function draw(div, drawing) {
    const before = all.get(div);
    const state = { div, ...drawing, onTime: Boolean(drawing.timeline) || div.dataset.time === "yes", range: before ? before.range : null };
    all.set(div, state);
    if (drawing.timeline) {
      state.found = series(drawing.timeline);
      state.cursors = before && before.cursors ? before.cursors : { A: null, B: null };
      state.active = before ? before.active : null;
      state.box = div.parentElement.querySelector(".cursors");
      div.tabIndex = 0;
      await redraw(state);
      readout(state);
    } else {
      await paint(state);
    }
    watched.observe(div);
    if (before) div.removeAllListeners("plotly_relayout"), div.removeAllListeners("plotly_click");
    listen(state);
    return state;
  }

  function forget(div) {
    watched.unobserve(div);
    if (all.delete(div)) Plotly.purge(div);
  }

  function repaint() {
    for (const state of all.values()) paint(state);
  }

  function theme(name) {
    document.documentElement.dataset.theme = name;
    repaint();
  }

  const dark = matchMedia("(prefers-color-scheme: dark)");
  const usual = () => (dark.matches ? "dark" : "light");
  document.documentElement.dataset.theme = usual();
  dark.addEventListener("change", () => theme(usual()));
  let before = null;
  addEventListener("beforeprint", () => {
    before = document.documentElement.dataset.theme;
    printing = true;
    theme("light");
  });
  addEventListener("afterprint", () => {
    printing = false;
    theme(before || usual());
  });
  document.addEventListener("click", (event) => {
    if (event.target.closest("[data-switch-theme]")) {
      theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
    }
  });

  return { draw, forget, theme, thinned };
})();
