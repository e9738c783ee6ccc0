// What is selected and how it is shown, in one place; every view listens and none knows another.

P.state = {
  row: 0, // the selected block
  share: 1, // how far the machine is through it, 0 to 1
  line: null, // { text, line } of a chosen line that is no block, from 0
  brush: null, // [first, last] block of the part that is looked at
  colour: 0, // place in P.colour.modes
  frame: "part", // or "machine"
  machine: false,
  by: "time", // or "block"
  playing: false,
  speed: 1,
  scale: 1000, // of the deviation vectors
  chart: 0,
  hidden: [], // places of the steps whose blocks are not drawn
  measuring: false, // a click on the path takes a point to measure from, or to
};

P.listeners = [];
P.listen = (names, run) => P.listeners.push({ names: names.split(" "), run });

// Puts new values and tells those who listen to one that changed.
P.set = (values) => {
  const changed = Object.keys(values).filter((name) => P.state[name] !== values[name]);
  Object.assign(P.state, values);
  for (const { names, run } of P.listeners) {
    if (names.some((name) => changed.includes(name))) run(changed);
  }
};

// An element with properties, attributes and children; text enters as text alone.
P.el = (tag, properties, ...children) => {
  const element = document.createElement(tag);
  if (tag === "button") element.type = "button";
  for (const [name, value] of Object.entries(properties || {})) {
    if (value == null) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (typeof value !== "boolean" || name.startsWith("aria")) element.setAttribute(name, value);
    else element.toggleAttribute(name, value);
  }
  element.append(...children.flat(Infinity).filter((child) => child != null));
  return element;
};
P.by = (id) => document.getElementById(id);

// A drawing of the page's own, from path data; never from the report.
P.icon = (path) => {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  const shape = document.createElementNS(space, "path");
  for (const [name, value] of [["d", path], ["fill", "none"], ["stroke", "currentColor"], ["stroke-width", "2"], ["stroke-linecap", "round"], ["stroke-linejoin", "round"]]) shape.setAttribute(name, value);
  svg.append(shape);
  return svg;
};

// The end of the program, s or blocks.
P.whole = () => (P.state.by === "time" ? P.m.total : P.m.rows);
P.clamp = (value, low, high) => Math.min(Math.max(value, low), high);
P.digits = { mm: 4, deg: 4, s: 3, "mm/min": 1, "deg/min": 1 };
// Positions, travel and ways are told as a control shows them.
P.POSITION = 3;
P.position = (value, unit) => P.quantity(value, unit, false, P.POSITION);
// Digits of a column wherever its numbers are told: no more than are known.
P.digits_of = ({ name, unit, decimals }) => (/^(q|tip)\./.test(name) ? P.POSITION : Math.min(P.digits[unit] ?? 3, decimals));

// A time as one says it: 4.2 s, 2 min 04.2 s, 1 h 02 min 04.2 s. The only form that times have on the page.
P.clock = (seconds, digits = 1) => {
  const ticks = Math.round(Math.max(0, seconds) * 10 ** digits);
  const minute = 60 * 10 ** digits;
  const [hours, minutes, rest] = [Math.floor(ticks / minute / 60), Math.floor(ticks / minute) % 60, ((ticks % minute) / 10 ** digits).toFixed(digits)];
  const two = (text, wide = 2) => String(text).padStart(wide, "0");
  const last = `${ticks < minute ? rest : two(rest, digits ? digits + 3 : 2)} s`;
  return [hours ? `${hours} h` : null, hours ? `${two(minutes)} min` : minutes ? `${minutes} min` : null, last].filter(Boolean).join(" ");
};

// A number with as many digits as its unit deserves; a bound below them is told as one of the last.
P.shown = (value, unit, digits, bound) => {
  if (!Number.isFinite(value)) return "–";
  const places = digits ?? P.digits[unit] ?? 3;
  // What holds at most is told no smaller.
  const up = Math.ceil(value * 10 ** places - 1e-3) / 10 ** places;
  return (bound && value > 0 ? Math.max(up, 10 ** -places) : value).toFixed(places).replace(/^-(?=[0.]*$)/, "");
};
// `most`: digits that are known.
P.quantity = (value, unit, bound, most = 9) => P.shown(value, unit, Math.min(P.digits[unit] ?? 3, most), bound) + (unit ? " " + P.unit(unit) : "");
P.unit = (unit) => unit.replace("deg", "°");
// Of a tick of a chart: no more digits than tell.
P.short = (value) => {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-5 || size >= 1e7)) return value.toExponential(1);
  return String(Number(value.toPrecision(4)));
};

// The report with what the views ask of it.
P.model = (report) => {
  const blocks = report.tables.blocks;
  const column = (name) => {
    const found = blocks.columns.get(name);
    return found ? found.values : null;
  };
  // Whether there is one; asking for it would unpack it.
  const has = (name) => blocks.columns.has(name);
  // The value in one row: no more than its piece is unpacked.
  const at = (name, row) => blocks.columns.get(name)?.at(row);
  const unit = (name) => (blocks.columns.get(name) || {}).unit || "";
  const rows = blocks.rows;
  const places = {};
  // The first block of every line, so that a line is found in no time.
  const firsts = (name) => {
    if (places[name]) return places[name];
    const values = column(name);
    if (!values) return (places[name] = new Int32Array(0));
    let last = 0;
    for (let row = 0; row < rows; row++) last = Math.max(last, values[row]);
    const first = new Int32Array(last + 1).fill(-1);
    for (let row = rows - 1; row >= 0; row--) if (values[row] > 0) first[values[row]] = row;
    return (places[name] = first);
  };
  // The block of a line from 1, else that of the nearest line before it that has one, else the next after.
  const rowOf = (name, line) => {
    const first = firsts(name);
    for (let at = Math.min(line, first.length - 1); at > 0; at--) if (first[at] >= 0) return first[at];
    for (let at = Math.max(line, 0); at < first.length; at++) if (first[at] >= 0) return first[at];
    return -1;
  };
  const lineOf = (name, row) => {
    const values = column(name);
    return values && row < rows ? values[row] : 0;
  };
  const t1 = column("t1");
  const t0 = column("t0");
  const start = (row) => (t0 ? t0[row] : t1 ? (row > 0 ? t1[row - 1] : 0) : row);
  const end = (row) => (t1 ? t1[row] : row + 1);
  const total = rows > 0 ? end(rows - 1) : 0;
  // The block that is under way at a time, s.
  const rowAt = (time) => {
    if (!t1) return P.clamp(Math.floor(time), 0, rows - 1);
    return P.first(rows - 1, (row) => t1[row] >= time);
  };
  const timed = t1 !== null && total > 0;
  // The tolerance of the cuts, which most share; rapids have another.
  const tolerance = report.meta.tolerances.tip;
  // That of the tool axis holds for cuts alone: a rapid may turn the tool as it likes.
  const kind = column("kind");
  const turn = report.meta.tolerances.axis;
  const axis_limits = kind && turn ? new Float32Array(rows).fill(turn) : null;
  for (let row = 0; axis_limits && row < rows; row++) if (kind[row] <= 2) axis_limits[row] = Infinity;
  const names = [...blocks.columns.keys()];
  // Operations, tools and heads, in the order of the program: each goes on to the next of its kind, [first, last] block.
  const steps = report.meta.events.filter(({ kind }) => ["operation", "tool", "head"].includes(kind));
  const span = (at) => [steps[at].row, (steps.find(({ kind }, next) => next > at && kind === steps[at].kind)?.row ?? rows) - 1];
  const axes = names.filter((name) => name.startsWith("q.")).map((name) => name.slice(2));
  return { report, meta: report.meta, rows, blocks, column, at, has, unit, rowOf, lineOf, firsts, start, end, total, rowAt, timed, axes, tolerance, turn, axis_limits, steps, span };
};

// Selects a block, and the machine stands at its end.
P.select = (row, line) => {
  const found = P.clamp(row, 0, Math.max(P.m.rows - 1, 0));
  P.set({ row: found, share: 1, line: line || null });
  P.remember();
};

// The address names what is selected, so that it can be handed on.
P.remember = () => {
  const { row, line } = P.state;
  const nc = line && line.text === "nc" ? line.line + 1 : P.m.lineOf("nc", row);
  const cl = P.m.lineOf("cl", row);
  const hash = nc > 0 ? `#nc=${nc}` : cl > 0 ? `#cl=${cl}` : `#block=${row + 1}`;
  try {
    history.replaceState(null, "", hash);
  } catch (_) {
    // A page without an address of its own is not linked to.
  }
};

// Goes where the address says; answers whether it says anything.
P.follow = () => {
  const found = /^#(nc|cl|block)=(\d+)$/.exec(location.hash);
  if (!found) return false;
  const [, name, number] = found;
  if (name === "block") P.select(Number(number) - 1);
  else P.select_line(name, Number(number) - 1);
  return true;
};

// Selects a line of a text, from 0, and the block that belongs to it.
P.select_line = (name, line) => {
  const row = P.m.rowOf(name, line + 1);
  const own = row >= 0 && P.m.lineOf(name, row) === line + 1;
  if (row >= 0) P.select(row, own ? null : { text: name, line });
  else {
    P.set({ line: { text: name, line } });
    P.remember();
  }
};

// What "worse" means: the part of its tolerance that a block takes, else what there is to compare.
P.worth = () => {
  const { column, rows } = P.m;
  const mode = P.colour.mode();
  if (mode.bad) return mode.value;
  const deviation = column("deviation");
  const tolerance = column("tolerance");
  if (deviation) return (row) => (tolerance && tolerance[row] > 0 ? deviation[row] / tolerance[row] : deviation[row]);
  const other = column("contour") || column("axis_deviation");
  return other ? (row) => other[row] : null;
};

// The next block that is worse than the selected one, or better: by value, then by place.
P.next_by_worth = (worse) => {
  const worth = P.worth();
  if (!worth) return;
  const { row, brush } = P.state;
  const [first, last] = brush || [0, P.m.rows - 1];
  const own = worth(row);
  const inside = row >= first && row <= last;
  let best = -1;
  let value = worse ? Infinity : -Infinity;
  for (let at = first; at <= last; at++) {
    const here = worth(at);
    if (worse ? here > own || (here === own && at < row && inside) : here < own || (here === own && at > row && inside)) {
      if (worse ? here < value || (here === value && at > best) : here > value) {
        best = at;
        value = here;
      }
    }
  }
  if (best >= 0) P.select(best);
};

// The worst block of all: the one that the verdict names for what is looked at; -1 where nothing can be compared.
P.worst = () => {
  const worth = P.worth();
  const { bad, title } = P.colour.mode();
  const { row, nc } = P.m.meta.maxima.find(({ name }) => !bad || name.includes(title)) || {};
  if (row != null) return row;
  if (nc) return P.m.rowOf("nc", nc);
  if (!worth) return -1;
  let best = -1;
  for (let at = 0; at < P.m.rows; at++) {
    const here = worth(at);
    if (here > 0 && (best < 0 || here > worth(best))) best = at;
  }
  return best;
};
