// Spread: how many blocks deviate by how much, both by powers of ten.

P.spread = { kind: 0, bins: [], BINS: 20, left: 58, right: 16, top: 34, bottom: 38 };

P.spread.build = (view) => {
  const { el, spread } = P;
  const { column, has, unit, meta } = P.m;
  const { tip, axis } = meta.tolerances;
  const all = [["deviation", "Tip deviation", tip], ["axis_deviation", "Tool axis deviation", axis], ["contour", "Contour error", tip]];
  spread.kinds = all.filter(([name]) => has(name)).map(([name, title, limit]) => ({ title, limit, get: () => column(name), unit: unit(name) }));
  const tabs = P.tabs("Spread of", spread.kinds.map(({ title }) => title), (at) => {
    spread.kind = at;
    tabs.choose(at);
    spread.draw();
  });
  spread.canvas = el("canvas", { tabindex: "0", role: "img", "aria-label": "How many blocks deviate by how much. The numbers are in the table (7)." });
  const plot = el("div", { class: "plot" }, spread.canvas);
  view.append(el("div", { class: "bar" }, el("h2", { id: "spread-title" }, "Spread"), tabs, P.lower("charts"), P.lower("table")), plot);
  spread.canvas.addEventListener("click", ({ offsetX }) => {
    const bin = spread.bins.find(({ from, to }) => offsetX >= from && offsetX < to);
    if (bin && bin.worst >= 0) P.select(bin.worst);
  });
  spread.fit = P.surface(plot, [spread.canvas], (size) => {
    Object.assign(spread, size);
    spread.draw();
  });
  P.listen("brush", spread.draw);
};

// Four bins a power of ten, one of which ends at the limit; what is smaller than the first goes into it.
P.spread.count = ({ get, limit }) => {
  const values = get();
  const { BINS } = P.spread;
  const [first, last] = P.state.brush || [0, P.m.rows - 1];
  // Rapids have a tolerance of their own.
  const kind = P.m.column("kind");
  const most = Math.max(P.largest(values.subarray(first, last + 1).filter((_, at) => !kind || kind[first + at] > 2)), limit || 0) || 1e-6;
  const place = (value) => Math.log10(Math.max(value, 1e-300)) * 4;
  const shift = limit > 0 ? place(limit) : 0;
  const low = Math.ceil(place(most) - shift - 1e-9) - BINS + shift;
  const counts = new Int32Array(BINS);
  const worst = new Int32Array(BINS).fill(-1);
  for (let row = first; row <= last; row++) {
    if (kind && kind[row] <= 2) continue;
    const bin = P.clamp(Math.ceil(place(values[row]) - low - 1e-9) - 1, 0, BINS - 1);
    counts[bin] += 1;
    if (worst[bin] < 0 || values[row] > values[worst[bin]]) worst[bin] = row;
  }
  return { counts, worst, low };
};

P.spread.draw = () => {
  const { canvas, width, height, kinds, kind, left, right, top, bottom, BINS } = P.spread;
  if (!width || !kinds.length) return;
  const { panel, grid, quiet, bad, accent, line } = P.colour;
  const chosen = kinds[kind];
  const { counts, worst, low } = P.spread.count(chosen);
  const paint = P.paint(canvas, P.spread, panel.css);
  const step = (width - left - right) / BINS;
  const most = Math.max(...counts, 10);
  const floor = height - bottom;
  const y_of = (count) => floor - (count > 0 ? ((Math.log10(count) + 0.12) / (Math.log10(most) + 0.15)) * (floor - top) : 0);
  for (let power = 1; power <= most; power *= 10) {
    const y = Math.round(y_of(power)) + 0.5;
    P.stroke(paint, grid.css, 1, [left, y, width - right, y]);
    P.write(paint, power.toLocaleString("en"), left - 6, y, quiet.css, "right");
  }
  P.spread.bins = Array.from(counts, (count, bin) => {
    const x = left + bin * step;
    const over = chosen.limit > 0 && worst[bin] >= 0 && chosen.get()[worst[bin]] > chosen.limit;
    const text = count.toLocaleString("en");
    paint.fillStyle = over ? bad.css : accent.css;
    if (count) paint.fillRect(x + 1, y_of(count), step - 2, floor - y_of(count));
    if (count && paint.measureText(text).width < step + 6) P.write(paint, text, x + step / 2, y_of(count) - 8, quiet.css);
    return { from: x, to: x + step, worst: worst[bin], count };
  });
  for (let power = Math.ceil(low / 4); power * 4 <= low + BINS; power++) {
    const x = Math.round(left + (power * 4 - low) * step) + 0.5;
    P.write(paint, P.short(Number(`1e${power}`)), x, floor + 11, quiet.css);
    P.stroke(paint, quiet.css, 1, [x, floor, x, floor + 4]);
  }
  P.stroke(paint, line.css, 1, [left, floor + 0.5, width - right, floor + 0.5]);
  P.write(paint, `${chosen.title.toLowerCase()}, ${P.unit(chosen.unit)}; bars: blocks of cuts; the first holds all that is smaller`, (left + width - right) / 2, height - 11, quiet.css);
  if (!(chosen.limit > 0)) return;
  const x = left + (Math.log10(chosen.limit) * 4 - low) * step;
  const end = x > width - 120;
  P.stroke(paint, bad.css, 1.2, [x, 6, x, floor], [6, 4]);
  P.write(paint, `tolerance ${P.short(chosen.limit)}`, x + (end ? -5 : 5), 11, bad.css, end ? "right" : "left");
};
