// One lane of the charts: a quantity over the columns of pixels.

P.lane = {};

// Least and largest of every column, with the value the column begins from, and over all.
// Of cuts alone where `kind` is told: rapids have a tolerance of their own.
P.lane.spans = (values, rows, kind) => {
  const count = rows.length - 1;
  const low = new Float64Array(count).fill(Infinity);
  const high = new Float64Array(count).fill(-Infinity);
  for (let x = 0; x < count; x++) {
    for (let row = Math.max(rows[x] - (x > 0 ? 1 : 0), 0); row <= Math.max(rows[x + 1] - 1, rows[x]); row++) {
      const value = values[row];
      if (kind && kind[row] <= 2) continue;
      if (value < low[x]) low[x] = value;
      if (value > high[x]) high[x] = value;
    }
    if (low[x] > high[x]) low[x] = high[x] = 0;
  }
  return { low, high, least: low.reduce((a, b) => Math.min(a, b)), most: high.reduce((a, b) => Math.max(a, b)) };
};

P.lane.draw = (paint, { lane, top, bottom }, rows) => {
  const { left, width, right, room } = P.charts;
  const { colour } = P;
  const { low, high, least, most } = P.lane.spans(lane.get(), rows, P.lane.kinds(lane));
  const { limit } = lane;
  const other = lane.other ? P.lane.spans(lane.get(lane.other), rows) : null;
  const band = lane.bands && P.m.meta.limits.length ? 7 : 0;
  const floor = bottom - (band ? band + 3 : 0);
  let from = lane.zero ? Math.min(0, least) : least;
  let to = Math.max(most, other ? other.most : -Infinity);
  // The limit is shown where the values come near it; a far one would press them flat.
  const near = limit > 0 && (lane.log || most > limit * 0.25);
  if (near) to = Math.max(to, limit * 1.08);
  if (!(to > from)) [from, to] = [from - 0.5, from + 0.5];
  const deepest = lane.log ? P.lane.deepest(lane, limit) : 0;
  const rise = lane.log ? Math.log((Math.max(to, deepest * 10) * 1.3) / deepest) : 0;
  const y_of = (value) => {
    const share = lane.log ? Math.log(Math.max(value, deepest) / deepest) / rise : (value - from) / (to - from);
    return floor - P.clamp(share, 0, 1) * (floor - top);
  };
  const ticks = lane.log ? [1, 10, 100, 1000].map((by) => deepest * by).filter((value) => y_of(value) > top - 1) : P.charts.ticks(from, to, P.clamp((floor - top) / 26, 1, 5));
  P.lane.frame(paint, lane, top, floor, ticks, y_of);
  paint.save();
  paint.beginPath();
  paint.rect(left, top - 3, room(), bottom - top + 6);
  paint.clip();
  const edge = (values) => Array.from(values, (value, x) => [left + x + 0.5, y_of(value)]);
  if (other) P.stroke(paint, colour.strong.css, 1.3, edge(other.high).flat(), [5, 4]);
  const around = [...edge(high), ...edge(low).reverse()].flat();
  P.stroke(paint, colour.accent.css, 1.2, around);
  paint.globalAlpha = 0.28;
  paint.fillStyle = colour.accent.css;
  paint.fill();
  paint.globalAlpha = 1;
  if (near) {
    const y = Math.round(y_of(limit)) + 0.5;
    P.stroke(paint, colour.bad.css, 1.2, [left, y, width - right, y], [6, 4]);
    P.lane.over(paint, lane, { low, high, rows }, y_of);
  }
  paint.restore();
  if (band) P.lane.bands(paint, lane.get(lane.bands), rows, bottom - band, band);
};

P.lane.kinds = ({ cuts }) => cuts && P.m.column("kind");

// A logarithm begins at the least value, but no more than three decades under the largest.
P.lane.deepest = (lane, limit) => {
  if (lane.low) return lane.low;
  const kind = P.lane.kinds(lane);
  const shown = kind ? lane.get().filter((_, row) => kind[row] > 2) : lane.get();
  const most = Math.max(P.largest(shown), limit || 0, 1e-9);
  const least = shown.reduce((low, value) => (value > 0 && value < low ? value : low), most);
  lane.low = 10 ** Math.max(Math.floor(Math.log10(least)), Math.floor(Math.log10(most) - 3));
  // The limit stands above what is far below it.
  if (limit > 0) lane.low = Math.min(lane.low, limit / 10);
  return lane.low;
};

P.lane.frame = (paint, lane, top, floor, ticks, y_of) => {
  const { left, right, width } = P.charts;
  const { grid, quiet, line, text } = P.colour;
  let last = Infinity;
  for (const tick of ticks) {
    const y = Math.round(y_of(tick)) + 0.5;
    P.stroke(paint, grid.css, 1, [left, y, width - right, y]);
    if (last - y < 13) continue;
    last = y;
    P.write(paint, P.short(Number(tick.toPrecision(10))), left - 5, P.clamp(y, top + 4, floor), quiet.css, "right");
  }
  P.stroke(paint, line.css, 1, [left, Math.round(floor) + 0.5, width - right, Math.round(floor) + 0.5]);
  const middle = (top + floor) / 2;
  const two = floor - top > 30;
  paint.font = P.BOLD;
  P.write(paint, lane.title, 7, middle - (two ? 7 : 0), text.css, "left");
  paint.font = P.FONT;
  if (two) P.write(paint, P.unit(lane.unit), 7, middle + 7, quiet.css, "left");
};

// Columns with a block above its own limit stand out, as far as they are above that of most.
P.lane.over = (paint, lane, { low, high, rows }, y_of) => {
  const { limit } = lane;
  const values = lane.get();
  const limits = lane.limits === "axis" ? P.m.axis_limits : lane.limits && lane.get(lane.limits);
  paint.fillStyle = P.colour.bad.css;
  for (let x = 0; x < high.length; x++) {
    let above = !limits && high[x] > limit;
    for (let row = rows[x]; limits && !above && row <= Math.max(rows[x + 1] - 1, rows[x]); row++) above = values[row] > limits[row];
    if (above) paint.fillRect(P.charts.left + x - 0.5, y_of(high[x]), 2, Math.max(Math.min(y_of(low[x]), y_of(limit)) - y_of(high[x]), 3));
  }
};

// What limits the feed, as a strip: of the blocks of a column, the one that most share.
P.lane.bands = (paint, values, rows, y, height) => {
  const counts = new Int32Array(P.m.meta.limits.length);
  for (let x = 0; x + 1 < rows.length; x++) {
    counts.fill(0);
    let best = -1;
    for (let row = rows[x]; row <= Math.max(rows[x + 1] - 1, rows[x]); row++) {
      const at = values[row];
      if (at < 0) continue;
      counts[at] += 1;
      if (best < 0 || counts[at] > counts[best]) best = at;
    }
    if (best < 0) continue;
    const [r, g, b] = P.colour.kind(best, P.colour.dark).map((value) => Math.round(value * 255));
    paint.fillStyle = `rgb(${r} ${g} ${b})`;
    paint.fillRect(P.charts.left + x, y, 1.5, height);
  }
};
