// The place under the path: charts, the spread of a quantity, or the numbers themselves.

P.lower = {};

P.lower.button = (name, title, key) => {
  const button = P.el("button", { type: "button", title: `${title} (${key})`, onclick: () => P.views.show(name) }, title);
  return button;
};

// Spread: how many blocks deviate by how much, both by powers of ten.
P.spread = { bins: [] };

P.spread.build = (view) => {
  const { el } = P;
  const { column, unit, meta } = P.m;
  const tolerances = meta.tolerances || {};
  const all = [["deviation", "Tip deviation", tolerances.tip], ["axis_deviation", "Tool axis deviation", tolerances.axis], ["contour", "Contour error", 0]];
  P.spread.kinds = all.filter(([name]) => column(name)).map(([name, title, limit]) => ({ name, title, limit, values: column(name), unit: unit(name) }));
  P.spread.kind = 0;
  const tabs = el("div", { class: "tabs", role: "tablist", "aria-label": "Spread of" });
  P.spread.kinds.forEach(({ title }, at) => {
    tabs.append(el("button", { type: "button", role: "tab", "aria-selected": String(at === 0), onclick: () => {
      P.spread.kind = at;
      [...tabs.children].forEach((tab, place) => tab.setAttribute("aria-selected", String(place === at)));
      P.spread.draw();
    } }, title));
  });
  const canvas = el("canvas", { tabindex: "0", role: "img", "aria-label": "Spread of the deviation over the blocks" });
  P.spread.canvas = canvas;
  P.spread.plot = el("div", { class: "plot" }, canvas);
  view.append(el("div", { class: "bar" }, el("h2", { id: "spread-title" }, "Spread"), tabs, P.lower.button("charts", "Charts", "5"), P.lower.button("table", "Table", "7")), P.spread.plot);
  canvas.addEventListener("click", (event) => {
    const bin = P.spread.bins.find(({ from, to }) => event.offsetX >= from && event.offsetX < to);
    if (bin && bin.worst >= 0) P.select(bin.worst);
  });
  new ResizeObserver(() => P.spread.resize()).observe(P.spread.plot);
  P.listen("brush", () => P.spread.draw());
};

P.spread.resize = () => {
  const { plot, canvas } = P.spread;
  const { clientWidth: width, clientHeight: height } = plot;
  if (!width || !height) return;
  const dense = Math.min(window.devicePixelRatio || 1, 2);
  Object.assign(P.spread, { width, height, dense });
  canvas.width = Math.round(width * dense);
  canvas.height = Math.round(height * dense);
  P.spread.draw();
};

// Four bins a power of ten; what is smaller than the first goes into it.
P.spread.count = ({ values, limit }) => {
  const [first, last] = P.state.brush || [0, P.m.rows - 1];
  let most = limit || 0;
  for (let row = first; row <= last; row++) if (values[row] > most) most = values[row];
  const top = Math.ceil(Math.log10(most || 1e-6) * 4 + 1e-9);
  const low = top - 24;
  const counts = new Int32Array(24);
  const worst = new Int32Array(24).fill(-1);
  for (let row = first; row <= last; row++) {
    const value = values[row];
    const bin = P.clamp(Math.floor(Math.log10(Math.max(value, 1e-300)) * 4) - low, 0, 23);
    counts[bin] += 1;
    if (worst[bin] < 0 || value > values[worst[bin]]) worst[bin] = row;
  }
  return { counts, worst, low };
};

P.spread.draw = () => {
  const { canvas, width, height, dense, kinds, kind } = P.spread;
  if (!width || !kinds.length) return;
  const { colour } = P;
  const paint = canvas.getContext("2d");
  const chosen = kinds[kind];
  const { counts, worst, low } = P.spread.count(chosen);
  paint.setTransform(dense, 0, 0, dense, 0, 0);
  paint.fillStyle = colour.panel.css;
  paint.fillRect(0, 0, width, height);
  paint.font = "11px system-ui, sans-serif";
  const [left, right, top, bottom] = [58, 16, 22, 38];
  const step = (width - left - right) / 24;
  const most = Math.max(...counts, 10);
  const rise = Math.log10(most) + 0.15;
  const floor = height - bottom;
  const y_of = (count) => floor - (count > 0 ? ((Math.log10(count) + 0.12) / rise) * (floor - top) : 0);
  for (let power = 1; power <= most; power *= 10) {
    const y = Math.round(y_of(power)) + 0.5;
    paint.strokeStyle = colour.grid.css;
    paint.beginPath();
    paint.moveTo(left, y);
    paint.lineTo(width - right, y);
    paint.stroke();
    paint.fillStyle = colour.quiet.css;
    paint.textAlign = "right";
    paint.textBaseline = "middle";
    paint.fillText(power.toLocaleString("en"), left - 6, y);
  }
  const limit_x = chosen.limit > 0 ? left + (Math.log10(chosen.limit) * 4 - low) * step : null;
  P.spread.bins = [];
  for (let bin = 0; bin < 24; bin++) {
    const x = left + bin * step;
    const over = limit_x !== null && x + step / 2 > limit_x && worst[bin] >= 0 && chosen.values[worst[bin]] > chosen.limit;
    paint.fillStyle = over ? colour.bad.css : colour.accent.css;
    if (counts[bin]) paint.fillRect(x + 1, y_of(counts[bin]), step - 2, floor - y_of(counts[bin]));
    paint.textAlign = "center";
    paint.textBaseline = "alphabetic";
    paint.fillStyle = colour.quiet.css;
    if (counts[bin] && paint.measureText(counts[bin].toLocaleString("en")).width < step + 6) paint.fillText(counts[bin].toLocaleString("en"), x + step / 2, y_of(counts[bin]) - 4);
    if ((bin + low) % 4 === 0) {
      paint.fillText(P.short(Number((10 ** ((bin + low) / 4)).toPrecision(6))), x, floor + 14);
      paint.fillRect(Math.round(x), floor, 1, 4);
    }
    P.spread.bins.push({ from: x, to: x + step, worst: worst[bin], count: counts[bin] });
  }
  paint.strokeStyle = colour.line.css;
  paint.beginPath();
  paint.moveTo(left, floor + 0.5);
  paint.lineTo(width - right, floor + 0.5);
  paint.stroke();
  paint.fillStyle = colour.quiet.css;
  paint.textAlign = "center";
  paint.fillText(`${chosen.title.toLowerCase()}, ${P.unit(chosen.unit)}; bars: blocks; the first holds all that is smaller`, (left + width - right) / 2, height - 7);
  if (limit_x !== null) {
    paint.strokeStyle = colour.bad.css;
    paint.setLineDash([6, 4]);
    paint.beginPath();
    paint.moveTo(limit_x, top - 8);
    paint.lineTo(limit_x, floor);
    paint.stroke();
    paint.setLineDash([]);
    paint.fillStyle = colour.bad.css;
    paint.textAlign = limit_x > width - 120 ? "right" : "left";
    paint.fillText(`tolerance ${P.short(chosen.limit)}`, limit_x + (limit_x > width - 120 ? -5 : 5), top - 4);
  }
};

// The numbers behind charts and path, a row a block.
P.table_view = { build: (view) => {
  const { el, m } = P;
  const words = { kind: P.KINDS, reason: P.REASONS, limit: m.meta.limits };
  const columns = [...m.blocks.columns.values()];
  const box = el("div", { class: "grid", role: "grid", tabindex: "0", "aria-label": "Blocks", "aria-rowcount": String(m.rows + 1), "aria-colcount": String(columns.length + 1) });
  const title = ({ name, unit }) => name.replace("_", " ") + (unit ? `, ${P.unit(unit)}` : "");
  box.append(el("div", { class: "row top", role: "row" }, el("span", { class: "cell", role: "columnheader" }, "block"), columns.map((one) => el("span", { class: "cell", role: "columnheader", title: title(one) }, title(one)))));
  const text = (one, row) => {
    const value = one.values[row];
    const named = words[one.name];
    if (named) return named[value] || "";
    return one.values instanceof Int32Array ? String(value) : P.number(value, one.unit);
  };
  const list = P.virtual(box, {
    count: m.rows,
    height: 20,
    make: (row) => {
      const made = el("div", { class: "row", role: "row", "aria-rowindex": String(row + 2), "aria-selected": String(row === P.state.row) }, el("span", { class: "cell", role: "rowheader" }, String(row + 1)), columns.map((one) => el("span", { class: "cell", role: "gridcell" }, text(one, row))));
      made.addEventListener("click", () => P.select(row));
      return made;
    },
  });
  box.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 }[event.key];
    if (!step) return;
    event.preventDefault();
    P.select(P.state.row + step);
  });
  view.append(el("div", { class: "bar" }, el("h2", { id: "table-title" }, "Table"), P.lower.button("charts", "Charts", "5"), P.lower.button("spread", "Spread", "6")), box);
  // Out of sight nothing is shown: the columns are not even unpacked.
  P.table_view.follow = () => box.clientHeight > 0 && list.show(P.state.row);
  P.listen("row", P.table_view.follow);
} };
