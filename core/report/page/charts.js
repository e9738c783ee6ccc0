// Charts over time or block, one lane a quantity: each column of pixels holds the least and the largest, so that no peak
// is lost. Dragging chooses a part of the program, which the path shows alone.

P.charts = { groups: [], places: [], from: 0, to: 1, left: 88, right: 10 };

// What can be drawn with the columns at hand.
P.charts.find = () => {
  const { column, has, unit, axes, meta, tolerance, turn, report } = P.m;
  const lane = (name, title, more) => (has(name) ? [{ title, unit: unit(name), digits: P.digits_of(report.tables.blocks.columns.get(name)), get: (key) => column(key || name), ...more }] : []);
  // What is predicted of every set-point, over its time.
  const { series } = report.tables;
  const timed = (name, title, more) => {
    const values = (of) => series.columns.get(of).values;
    return series ? [{ title, unit: series.columns.get(name).unit, digits: P.digits_of(series.columns.get(name)), get: () => values(name), times: () => values("t"), zero: true, ...more }] : [];
  };
  // What the machine file allows an axis, in the unit of the column.
  const rate = (name, key, over) => {
    const found = meta.machine && meta.machine.axes.find((one) => one.name === name);
    return found && found[key] ? found[key] / over : null;
  };
  return [
    { title: "Deviation in cuts", lanes: [lane("deviation", "tip", { limit: tolerance, limits: "tolerance", log: true, cuts: true }), lane("axis_deviation", "axis", { limit: turn, limits: "axis", log: true, cuts: true })] },
    { title: "Feed", lanes: lane("feed", "feed", { other: has("asked") && "asked", bands: has("limit") && "limit", zero: true }) },
    { title: "Positions", lanes: axes.map((name) => lane("q." + name, name)) },
    { title: "Velocities", lanes: axes.map((name) => lane("v." + name, name, { zero: true, limit: rate(name, "max_feed", 60) })) },
    { title: "Accelerations", lanes: axes.map((name) => lane("a." + name, name, { zero: true, limit: rate(name, "max_accel", 1) })) },
    { title: "Clearance", lanes: lane("clearance", "clear by", { zero: true }) },
    { title: "Engagement", lanes: [lane("chip", "cut", { zero: true }), lane("cut_depth", "depth", { zero: true }), lane("cut_width", "width", { zero: true })] },
    { title: "Prediction", lanes: [series ? timed("contour", "contour", { limit: tolerance }) : lane("contour", "contour", { zero: true, limit: tolerance }), timed("feed", "feed")] },
  ]
    .map(({ title, lanes }) => ({ title, lanes: lanes.flat() }))
    .filter(({ lanes }) => lanes.length);
};

P.charts.build = (view) => {
  const { el, charts } = P;
  charts.groups = charts.find();
  const tabs = P.tabs("Charts", charts.groups.map(({ title }) => title), (chart) => P.set({ chart }));
  const by = P.button("", "Time or block (b)", () => P.keys.by());
  charts.canvas = el("canvas", { tabindex: "0", role: "img" });
  charts.over = el("canvas", { class: "over", "aria-hidden": "true" });
  charts.plot = el("div", { class: "plot" }, charts.canvas, charts.over);
  view.append(el("div", { class: "bar" }, el("h2", { id: "charts-title" }, "Charts"), tabs, by, P.button("All", "Show all (Esc)", charts.reset), P.lower("spread"), P.lower("table")), charts.plot);
  if (!charts.groups.length) return;
  const name = () => {
    const over = P.state.by === "time" ? "over time" : "over blocks";
    const { title, lanes } = charts.groups[P.state.chart];
    tabs.choose(P.state.chart);
    by.textContent = over;
    charts.canvas.setAttribute("aria-label", `${title} ${over}: ${lanes.map((one) => one.title).join(", ")}. The numbers are in the table (7).`);
    charts.draw();
  };
  name();
  P.listen("chart by", name);
  P.listen("row share brush", charts.cursor);
  charts.fit = P.surface(charts.plot, [charts.canvas, charts.over], (size) => {
    Object.assign(charts, size);
    charts.draw();
  });
  charts.handle();
};

P.charts.room = () => P.charts.width - P.charts.left - P.charts.right;
P.charts.x_of = (place) => {
  const { left, from, to, room } = P.charts;
  return left + ((place / P.whole() - from) / (to - from)) * room();
};
P.charts.row_at = (x) => {
  const { left, from, to, room } = P.charts;
  const place = (from + ((x - left) / room()) * (to - from)) * P.whole();
  return P.state.by === "time" ? P.m.rowAt(P.clamp(place, 0, P.m.total)) : P.clamp(Math.floor(place), 0, P.m.rows - 1);
};

// The place in the values of a lane under a pixel: a block, or the set-point of that time.
P.charts.index = ({ times }, x) => {
  const { left, from, to, room, row_at } = P.charts;
  if (!times) return row_at(x);
  const { start, end, rows } = P.m;
  let time = (from + ((x - left) / room()) * (to - from)) * P.whole();
  if (P.state.by === "block") {
    const row = P.clamp(Math.floor(time), 0, rows - 1);
    time = start(row) + (end(row) - start(row)) * P.clamp(time - row, 0, 1);
  }
  return P.charts.sample(times(), time);
};

// The last set-point that is not after a time.
P.charts.sample = (times, time) => Math.max(P.first(times.length, (at) => times[at] > time) - 1, 0);

// Ticks of an axis: round numbers, few.
P.charts.ticks = (low, high, most) => {
  const raw = (high - low) / Math.max(most, 1);
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((by) => by * power).find((by) => by >= raw);
  const ticks = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + step * 1e-6; at++) ticks.push(Number((at * step).toPrecision(10)));
  return ticks;
};

P.charts.draw = () => {
  const { charts } = P;
  const { width, height, left, canvas, groups } = charts;
  if (!width || !groups.length) return;
  const paint = P.paint(canvas, charts, P.colour.panel.css);
  const { lanes } = groups[P.state.chart];
  // The first block of every column of pixels; the last entry ends the last column.
  const count = Math.max(1, Math.floor(charts.room()));
  const under = (lane) => Int32Array.from({ length: count + 1 }, (_, x) => charts.index(lane, left + x));
  const rows = under({});
  const room = (height - 28) / lanes.length;
  charts.places = lanes.map((lane, at) => ({ lane, top: 9 + at * room, bottom: (at + 1) * room - 1 }));
  charts.along(paint);
  for (const place of charts.places) P.lane.draw(paint, place, place.lane.times ? under(place.lane) : rows);
  charts.cursor();
};

// The axis that the lanes share.
P.charts.along = (paint) => {
  const { width, height, left, right, from, to, room, ticks, x_of } = P.charts;
  const { grid, quiet } = P.colour;
  const timed = P.state.by === "time";
  const span = (to - from) * P.whole();
  for (const tick of ticks(from * P.whole(), to * P.whole(), room() / 90)) {
    const x = Math.round(x_of(tick)) + 0.5;
    if (x < left || x > width - right + 1) continue;
    P.stroke(paint, grid.css, 1, [x, 4, x, height - 22]);
    if (x < width - 60) P.write(paint, timed ? P.clock(tick, span < 2 ? 3 : span < 60 ? 1 : 0) : P.short(tick), Math.max(x, left + 8), height - 11, quiet.css);
  }
  P.write(paint, timed ? "time" : "block", width - 6, height - 11, quiet.css, "right");
};

// The selected place and the brush, over the charts.
P.charts.cursor = () => {
  const { over, width, height, left, right, x_of, places } = P.charts;
  if (!width) return;
  const { colour, state, m } = P;
  const paint = P.paint(over, P.charts);
  const floor = height - 22;
  if (state.brush) {
    const ends = state.by === "time" ? [m.start(state.brush[0]), m.end(state.brush[1])] : [state.brush[0], state.brush[1] + 1];
    const [a, b] = ends.map((place) => P.clamp(x_of(place), left, width - right));
    paint.fillStyle = colour.ground.css;
    paint.globalAlpha = 0.72;
    paint.fillRect(left, 0, a - left, floor);
    paint.fillRect(b, 0, width - right - b, floor);
    paint.globalAlpha = 1;
    for (const x of [a, b]) P.stroke(paint, colour.accent.css, 2, [x, 0, x, floor]);
  }
  const x = x_of(P.play.at());
  if (x < left - 1 || x > width - right + 1) return;
  P.stroke(paint, colour.select.css, 1.5, [x, 0, x, floor]);
  for (const { lane, top } of places) {
    const limit = lane.bands && m.meta.limits[lane.get(lane.bands)[state.row]];
    const { start, end } = m;
    const at = lane.times ? P.charts.sample(lane.times(), start(state.row) + (end(state.row) - start(state.row)) * state.share) : state.row;
    const text = P.quantity(lane.get()[at], lane.unit, false, lane.digits) + (limit ? ` by ${limit}` : "");
    const wide = paint.measureText(text).width + 8;
    const to = x + wide + 8 > width - right ? x - wide - 5 : x + 5;
    paint.globalAlpha = 0.88;
    paint.fillStyle = colour.panel.css;
    paint.fillRect(to, top - 3, wide, 16);
    paint.globalAlpha = 1;
    P.write(paint, text, to + 4, top + 5.5, colour.text.css, "left");
  }
};

// Mouse: a click selects, a drag chooses a part, the wheel draws it out, with shift it shifts.
P.charts.handle = () => {
  const { canvas, row_at, range } = P.charts;
  let start = null;
  const on = (name, run) => canvas.addEventListener(name, run, { passive: false });
  on("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    start = { x: event.offsetX, moved: false };
  });
  on("pointermove", ({ offsetX }) => {
    if (!start) return;
    if (Math.abs(offsetX - start.x) > 4) start.moved = true;
    if (start.moved) P.set({ brush: [start.x, offsetX].map(row_at).sort((a, b) => a - b) });
  });
  on("pointerup", ({ offsetX }) => {
    if (start && !start.moved) P.charts.click(offsetX);
    start = null;
  });
  on("pointercancel", () => (start = null));
  on("dblclick", P.charts.reset);
  on("wheel", (event) => {
    event.preventDefault();
    const { from, to, left, room } = P.charts;
    const { deltaX, deltaY } = event;
    const size = to - from;
    if (event.shiftKey || Math.abs(deltaX) > Math.abs(deltaY)) return range(from + (deltaX || deltaY) * 0.001 * size, size);
    const at = from + ((event.offsetX - left) / room()) * size;
    const factor = Math.exp(P.clamp(deltaY, -240, 240) * 0.002);
    return range(at - (at - from) * factor, size * factor);
  });
};

// Of the blocks under a pixel the one that stands out in the first lane.
P.charts.click = (x) => {
  const { places, index } = P.charts;
  const { lane } = places[0];
  const values = lane.get();
  let best = index(lane, x + 0.5);
  for (let at = index(lane, x - 0.5), last = best; at <= last; at++) if (Math.abs(values[at]) > Math.abs(values[best])) best = at;
  P.select(lane.times ? P.m.rowAt(lane.times()[best]) : best);
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
