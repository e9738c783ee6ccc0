// One lane of the charts: a quantity over the columns of pixels.

P.lane = {};

// Least and largest of every column, with the value the column begins from, and over all.
P.lane.spans = (values, rows) => {
  const count = rows.length - 1;
  const low = new Float64Array(count);
  const high = new Float64Array(count);
  let least = Infinity;
  let most = -Infinity;
  for (let x = 0; x < count; x++) {
    let down = Infinity;
    let up = -Infinity;
    for (let row = Math.max(rows[x] - (x > 0 ? 1 : 0), 0); row <= Math.max(rows[x + 1] - 1, rows[x]); row++) {
      const value = values[row];
      if (value < down) down = value;
      if (value > up) up = value;
    }
    low[x] = down;
    high[x] = up;
    if (down < least) least = down;
    if (up > most) most = up;
  }
  return { low, high, least, most };
};

P.lane.draw = (paint, place, rows, { width, left, right }) => {
  const { lane, top, bottom } = place;
  const { colour } = P;
  const { low, high, least, most } = P.lane.spans(lane.values, rows);
  const limit = P.lane.limit(lane);
  const other = lane.other ? P.lane.spans(lane.other, rows) : null;
  const band = lane.bands && P.m.meta.limits && P.m.meta.limits.length ? 7 : 0;
  const floor = bottom - band - (band ? 3 : 0);
  const deepest = lane.log ? P.lane.deepest(lane) : 0;
  let [from, to] = [lane.zero ? Math.min(0, least) : least, Math.max(most, other ? other.most : -Infinity)];
  // The limit is shown where the values come near it; a far one would press them flat.
  const near = limit > 0 && (lane.log || most > limit * 0.25);
  if (near) to = Math.max(to, limit * 1.08);
  if (!(to > from)) [from, to] = [from - 0.5, from + 0.5];
  const rise = lane.log ? Math.log(Math.max(to, deepest * 10) * 1.3 / deepest) : 0;
  const y_of = (value) => {
    const share = lane.log ? Math.log(Math.max(value, deepest) / deepest) / rise : (value - from) / (to - from);
    return floor - P.clamp(share, 0, 1) * (floor - top);
  };
  Object.assign(place, { y_of });
  P.lane.frame(paint, { lane, top, floor, from, to, deepest, y_of, width, left, right });
  paint.save();
  paint.beginPath();
  paint.rect(left, top - 3, width - left - right, bottom - top + 6);
  paint.clip();
  if (other) P.lane.line(paint, other, y_of, left, colour.strong.css, [5, 4]);
  P.lane.fill(paint, { low, high }, y_of, left, colour.accent.css);
  if (near) {
    const y = Math.round(y_of(limit)) + 0.5;
    paint.strokeStyle = colour.bad.css;
    paint.lineWidth = 1.2;
    paint.setLineDash([6, 4]);
    paint.beginPath();
    paint.moveTo(left, y);
    paint.lineTo(width - right, y);
    paint.stroke();
    paint.setLineDash([]);
    P.lane.over(paint, { lane, low, high, rows }, y_of, left);
  }
  paint.restore();
  if (band) P.lane.bands(paint, lane.bands, rows, left, bottom - band, band);
};

// The limit of a lane: a number, or the tolerance that the cuts share.
P.lane.limit = (lane) => (typeof lane.limit === "number" ? lane.limit : lane.limit ? P.path.common_limit(lane.limit) : 0);

// A logarithm begins at the least value, but no more than three decades under the largest.
P.lane.deepest = (lane) => {
  if (lane.deepest) return lane.deepest;
  let most = P.lane.limit(lane) || 1e-9;
  let least = most;
  for (const value of lane.values) {
    if (value > most) most = value;
    if (value > 0 && value < least) least = value;
  }
  lane.deepest = Math.max(10 ** Math.floor(Math.log10(least)), 10 ** Math.floor(Math.log10(most) - 3));
  return lane.deepest;
};

P.lane.frame = (paint, { lane, top, floor, from, to, deepest, y_of, width, left, right }) => {
  const { colour } = P;
  paint.font = "11px system-ui, sans-serif";
  paint.strokeStyle = colour.grid.css;
  paint.lineWidth = 1;
  const room = floor - top;
  const ticks = lane.log ? [1, 10, 100, 1000].map((by) => deepest * by).filter((value) => y_of(value) > top - 1) : P.charts.ticks(from, to, P.clamp(room / 26, 1, 5));
  let last = Infinity;
  paint.textAlign = "right";
  paint.textBaseline = "middle";
  for (const tick of ticks) {
    const y = Math.round(y_of(tick)) + 0.5;
    paint.beginPath();
    paint.moveTo(left, y);
    paint.lineTo(width - right, y);
    paint.stroke();
    if (last - y < 13) continue;
    last = y;
    paint.fillStyle = colour.quiet.css;
    paint.fillText(P.short(Number(tick.toPrecision(10))), left - 5, P.clamp(y, top + 4, floor));
  }
  paint.strokeStyle = colour.line.css;
  paint.beginPath();
  paint.moveTo(left, Math.round(floor) + 0.5);
  paint.lineTo(width - right, Math.round(floor) + 0.5);
  paint.stroke();
  paint.textAlign = "left";
  paint.fillStyle = colour.text.css;
  paint.font = "bold 11px system-ui, sans-serif";
  paint.fillText(lane.title.length > 3 ? lane.title.split(" ").pop() : lane.title, 7, (top + floor) / 2 - (room > 30 ? 7 : 0));
  if (room > 30) {
    paint.font = "11px system-ui, sans-serif";
    paint.fillStyle = colour.quiet.css;
    paint.fillText(P.unit(lane.unit), 7, (top + floor) / 2 + 7);
  }
};

P.lane.fill = (paint, { low, high }, y_of, left, css) => {
  paint.beginPath();
  for (let x = 0; x < low.length; x++) paint.lineTo(left + x + 0.5, y_of(high[x]));
  for (let x = low.length - 1; x >= 0; x--) paint.lineTo(left + x + 0.5, y_of(low[x]));
  paint.closePath();
  paint.fillStyle = css;
  paint.globalAlpha = 0.28;
  paint.fill();
  paint.globalAlpha = 1;
  paint.strokeStyle = css;
  paint.lineWidth = 1.2;
  paint.stroke();
};

P.lane.line = (paint, { high }, y_of, left, css, dash) => {
  paint.beginPath();
  for (let x = 0; x < high.length; x++) paint.lineTo(left + x + 0.5, y_of(high[x]));
  paint.strokeStyle = css;
  paint.lineWidth = 1.3;
  paint.setLineDash(dash);
  paint.stroke();
  paint.setLineDash([]);
};

// Columns with a block above its own limit stand out.
P.lane.over = (paint, { lane, low, high, rows }, y_of, left) => {
  const own = typeof lane.limit === "number" ? null : lane.limit;
  paint.fillStyle = P.colour.bad.css;
  for (let x = 0; x < high.length; x++) {
    let above = !own && high[x] > lane.limit;
    for (let row = rows[x]; own && !above && row <= Math.max(rows[x + 1] - 1, rows[x]); row++) above = lane.values[row] > own[row];
    if (above) paint.fillRect(left + x - 0.5, y_of(high[x]), 2, Math.max(y_of(low[x]) - y_of(high[x]), 3));
  }
};

// What limits the feed, as a strip: of the blocks of a column, the one that most share.
P.lane.bands = (paint, values, rows, left, y, height) => {
  const names = P.m.meta.limits;
  const counts = new Int32Array(names.length);
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
    paint.fillRect(left + x, y, 1.5, height);
  }
};
