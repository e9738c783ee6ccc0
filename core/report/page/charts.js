// Charts over time or block, one lane a quantity: each column of pixels holds the least and the largest, so that no peak
// is lost. Dragging chooses a part of the program, which the path shows alone.

P.charts = { groups: [], from: 0, to: 1, left: 76, right: 10 };

// What can be drawn with the columns at hand.
P.charts.find = () => {
  const { column, unit, axes, m } = { ...P.m, m: P.m };
  const tolerances = m.meta.tolerances || {};
  const lane = (name, title, more) => (column(name) ? [{ name, title, unit: unit(name), values: column(name), ...more }] : []);
  const groups = [
    ["Deviation", [lane("deviation", "tip", { limit: column("tolerance") || tolerances.tip, log: true }), lane("axis_deviation", "tool axis", { limit: tolerances.axis, log: true })]],
    ["Feed", [lane("feed", "feed", { other: column("asked"), bands: column("limit"), zero: true })]],
    ["Positions", axes.map((name) => lane("q." + name, name))],
    ["Velocities", axes.map((name) => lane("v." + name, name, { zero: true, limit: P.charts.rate(name, "max_feed", 60) }))],
    ["Accelerations", axes.map((name) => lane("a." + name, name, { zero: true, limit: P.charts.rate(name, "max_accel", 1) }))],
    ["Contour error", [lane("contour", "contour", { zero: true })]],
  ];
  return groups.map(([title, lanes]) => ({ title, lanes: lanes.flat() })).filter(({ lanes }) => lanes.length);
};

// What the machine file allows an axis, in the unit of the column.
P.charts.rate = (name, key, over) => {
  const { machine } = P.m.meta;
  const axis = machine && machine.axes.find((one) => one.name === name);
  return axis && axis[key] ? axis[key] / over : null;
};

P.charts.build = (view) => {
  const { el } = P;
  const charts = P.charts;
  charts.groups = charts.find();
  const tabs = el("div", { class: "tabs", role: "tablist", "aria-label": "Charts" });
  charts.groups.forEach(({ title }, at) => {
    const tab = el("button", { type: "button", role: "tab", "aria-selected": String(at === 0), onclick: () => P.set({ chart: at }) }, title);
    tabs.append(tab);
  });
  const by = el("button", { type: "button", title: "Time or block (b)", onclick: () => P.set({ by: P.state.by === "time" && P.m.timed ? "block" : P.m.timed ? "time" : "block" }) });
  const clear = el("button", { type: "button", title: "Show all (Esc)", onclick: () => charts.reset() }, "All");
  const bar = el("div", { class: "bar" }, el("h2", { id: "charts-title" }, "Charts"), tabs, by, clear, P.lower.button("spread", "Spread", "6"), P.lower.button("table", "Table", "7"));
  charts.canvas = el("canvas", { tabindex: "0", role: "img" });
  charts.over = el("canvas", { class: "over", "aria-hidden": "true" });
  charts.plot = el("div", { class: "plot" }, charts.canvas, charts.over);
  view.append(bar, charts.plot);
  if (!charts.groups.length) return;
  const name = () => {
    [...tabs.children].forEach((tab, at) => tab.setAttribute("aria-selected", String(at === P.state.chart)));
    by.textContent = P.state.by === "time" ? "over time" : "over blocks";
    const { title, lanes } = charts.groups[P.state.chart];
    charts.canvas.setAttribute("aria-label", `${title} over ${P.state.by === "time" ? "time" : "blocks"}: ${lanes.map((one) => one.title).join(", ")}. The numbers are in the table (7).`);
  };
  name();
  P.listen("chart by", () => {
    name();
    charts.draw();
  });
  P.listen("row share brush", () => charts.cursor());
  new ResizeObserver(() => charts.resize()).observe(charts.plot);
  charts.handle();
};

P.charts.resize = () => {
  const { plot, canvas, over } = P.charts;
  const { clientWidth: width, clientHeight: height } = plot;
  if (!width || !height) return;
  const dense = Math.min(window.devicePixelRatio || 1, 2);
  Object.assign(P.charts, { width, height, dense });
  for (const surface of [canvas, over]) {
    surface.width = Math.round(width * dense);
    surface.height = Math.round(height * dense);
  }
  P.charts.draw();
};

P.charts.whole = () => (P.state.by === "time" ? P.m.total : P.m.rows);
P.charts.x_of = (place) => {
  const { left, right, width, from, to } = P.charts;
  return left + ((place / P.charts.whole() - from) / (to - from)) * (width - left - right);
};
P.charts.place_of = (x) => {
  const { left, right, width, from, to } = P.charts;
  return (from + ((x - left) / (width - left - right)) * (to - from)) * P.charts.whole();
};
P.charts.row_of = (place) => (P.state.by === "time" ? P.m.rowAt(P.clamp(place, 0, P.m.total)) : P.clamp(Math.floor(place), 0, P.m.rows - 1));

// The first block of every column of pixels; the last entry ends the last column.
P.charts.columns = () => {
  const { left, right, width } = P.charts;
  const count = Math.max(1, Math.floor(width - left - right));
  const rows = new Int32Array(count + 1);
  for (let x = 0; x <= count; x++) rows[x] = P.charts.row_of(P.charts.place_of(left + x));
  return rows;
};

// Ticks of an axis: round numbers, few.
P.charts.ticks = (low, high, most) => {
  const raw = (high - low) / Math.max(most, 1);
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((by) => by * power).find((by) => by >= raw);
  const ticks = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + step * 1e-6; at++) ticks.push(at * step);
  return ticks;
};

P.charts.draw = (onto, paper) => {
  const charts = P.charts;
  if (!charts.width || !charts.groups.length) return;
  const { canvas, width, height, dense, left, right } = { ...charts, ...paper };
  const paint = (onto || canvas).getContext("2d");
  const { colour } = P;
  paint.setTransform(dense, 0, 0, dense, 0, 0);
  paint.fillStyle = colour.panel.css;
  paint.fillRect(0, 0, width, height);
  const { lanes } = charts.groups[P.state.chart];
  const rows = charts.columns();
  const room = (height - 24 - 4) / lanes.length;
  charts.places = lanes.map((lane, at) => ({ lane, top: 4 + at * room + 5, bottom: 4 + (at + 1) * room - 5 }));
  charts.time_axis(paint, { width, height, left, right });
  for (const place of charts.places) P.lane.draw(paint, place, rows, { width, left, right });
  charts.cursor();
};

P.charts.time_axis = (paint, { width, height, left, right }) => {
  const { colour } = P;
  const { from, to } = P.charts;
  const whole = P.charts.whole();
  const time = P.state.by === "time";
  paint.font = "11px system-ui, sans-serif";
  paint.textAlign = "center";
  paint.textBaseline = "alphabetic";
  for (const tick of P.charts.ticks(from * whole, to * whole, (width - left - right) / 90)) {
    const x = Math.round(P.charts.x_of(tick)) + 0.5;
    if (x < left || x > width - right + 1) continue;
    paint.strokeStyle = colour.grid.css;
    paint.lineWidth = 1;
    paint.beginPath();
    paint.moveTo(x, 4);
    paint.lineTo(x, height - 22);
    paint.stroke();
    paint.fillStyle = colour.quiet.css;
    paint.fillText(P.short(Number(tick.toPrecision(12))), P.clamp(x, left + 8, width - 34), height - 8);
  }
  paint.textAlign = "right";
  paint.fillText(time ? "s" : "block", width - 6, height - 8);
};

// The selected place and the brush, over the charts.
P.charts.cursor = () => {
  const { over, width, height, dense, left, right } = P.charts;
  if (!width || !over) return;
  const { colour, state } = P;
  const paint = over.getContext("2d");
  paint.setTransform(dense, 0, 0, dense, 0, 0);
  paint.clearRect(0, 0, width, height);
  const time = state.by === "time";
  if (state.brush) {
    const [first, last] = state.brush;
    const a = P.clamp(P.charts.x_of(time ? P.m.start(first) : first), left, width - right);
    const b = P.clamp(P.charts.x_of(time ? P.m.end(last) : last + 1), left, width - right);
    paint.fillStyle = colour.ground.css;
    paint.globalAlpha = 0.72;
    paint.fillRect(left, 0, a - left, height - 22);
    paint.fillRect(b, 0, width - right - b, height - 22);
    paint.globalAlpha = 1;
    paint.fillStyle = colour.accent.css;
    paint.fillRect(a - 1, 0, 2, height - 22);
    paint.fillRect(b - 1, 0, 2, height - 22);
  }
  const x = P.charts.x_of(P.play.at());
  if (x < left - 1 || x > width - right + 1) return;
  paint.strokeStyle = colour.select.css;
  paint.lineWidth = 1.5;
  paint.beginPath();
  paint.moveTo(x, 0);
  paint.lineTo(x, height - 22);
  paint.stroke();
  for (const { lane, top } of P.charts.places || []) {
    const text = P.quantity(lane.values[state.row], lane.unit);
    paint.font = "11px system-ui, sans-serif";
    const wide = paint.measureText(text).width + 8;
    const to = x + wide + 8 > width - right ? x - wide - 5 : x + 5;
    paint.fillStyle = colour.panel.css;
    paint.globalAlpha = 0.88;
    paint.fillRect(to, top - 3, wide, 16);
    paint.globalAlpha = 1;
    paint.fillStyle = colour.text.css;
    paint.textAlign = "left";
    paint.textBaseline = "middle";
    paint.fillText(text, to + 4, top + 5.5);
  }
};

// Mouse: a click selects, a drag chooses a part, the wheel draws it out, with shift it shifts.
P.charts.handle = () => {
  const { canvas } = P.charts;
  let start = null;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    start = { x: event.offsetX, moved: false };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!start) return;
    if (Math.abs(event.offsetX - start.x) > 4) start.moved = true;
    if (!start.moved) return;
    const ends = [start.x, event.offsetX].map((x) => P.charts.row_of(P.charts.place_of(x))).sort((a, b) => a - b);
    P.set({ brush: ends });
  });
  canvas.addEventListener("pointerup", (event) => {
    if (start && !start.moved) P.charts.click(event.offsetX);
    start = null;
  });
  canvas.addEventListener("pointercancel", () => (start = null));
  canvas.addEventListener("dblclick", () => P.charts.reset());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const { from, to, left, right, width } = P.charts;
    const at = from + ((event.offsetX - left) / (width - left - right)) * (to - from);
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) P.charts.range(from + (event.deltaX || event.deltaY) * 0.001 * (to - from), to - from);
    else {
      const factor = Math.exp(P.clamp(event.deltaY, -240, 240) * 0.002);
      P.charts.range(at - (at - from) * factor, (to - from) * factor);
    }
  }, { passive: false });
};

// Of the blocks under a pixel the one that stands out in the first lane.
P.charts.click = (x) => {
  const { places } = P.charts;
  const [first, next] = [x - 0.5, x + 0.5].map((at) => P.charts.row_of(P.charts.place_of(at)));
  const values = places[0].lane.values;
  let best = next;
  for (let row = first; row <= next; row++) if (Math.abs(values[row]) > Math.abs(values[best])) best = row;
  P.select(best);
};

P.charts.range = (from, size) => {
  const kept = P.clamp(size, Math.min(1, 8 / Math.max(P.m.rows, 8)), 1);
  P.charts.from = P.clamp(from, 0, 1 - kept);
  P.charts.to = P.charts.from + kept;
  P.charts.draw();
};

P.charts.reset = () => {
  P.set({ brush: null });
  P.charts.range(0, 1);
};
