// What follows from other columns, so that Rust has packed no more than what is left of it.

// The tip (mm, part frame) and the tool axis by the chain, from axis values as the control shows them: one product from the
// workpiece to the tool, as core/machine has it. Into `pose`: x, y, z, i, j, k. With `slides` the linear axes stand at zero,
// and their ways follow behind, the last axis first.
P.poser = ({ axes, mount, gauge, tool_axis }) => {
  const all = new Float64Array(6 + axes.length * 3);
  return (value, length, pose, slides) => {
    let end = 6;
    for (let at = 0; at < 3; at++) {
      all[at] = gauge[at] - tool_axis[at] * length;
      all[at + 3] = tool_axis[at];
    }
    for (let place = axes.length - 1; place >= 0; place--) {
      const { kind, direction, point, zero } = axes[place];
      const [a, b, c] = direction;
      if (kind !== "rotary") {
        const q = slides ? 0 : value(place) - zero;
        for (let at = 0; at < 3; at++) {
          all[at] += direction[at] * q;
          if (slides) all[end++] = direction[at];
        }
        continue;
      }
      const q = ((value(place) - zero) * Math.PI) / 180;
      const sine = Math.sin(q);
      const cosine = Math.cos(q);
      for (let at = 0; at < 3; at++) all[at] -= point[at];
      for (let at = 0; at < end; at += 3) {
        const u = all[at];
        const v = all[at + 1];
        const w = all[at + 2];
        const along = (a * u + b * v + c * w) * (1 - cosine);
        all[at] = u * cosine + (b * w - c * v) * sine + a * along;
        all[at + 1] = v * cosine + (c * u - a * w) * sine + b * along;
        all[at + 2] = w * cosine + (a * v - b * u) * sine + c * along;
      }
      for (let at = 0; at < 3; at++) all[at] += point[at];
    }
    for (let at = 0; at < end; at++) pose[at] = all[at] - (at < 3 ? mount[at][3] : 0);
  };
};

// Columns that are told against what follows from others, so that only what is left of them is packed: the sum is what Rust
// has told, to its last decimal.
P.derive = {
  // Tip and tool axis, told against the chain; or the tool axis alone, which the rotary axes turn.
  chain: ({ meta }, columns, part) => {
    const { machine } = meta;
    const bare = columns.get("tip.x").from !== "chain";
    const names = ["tip.x", "tip.y", "tip.z", "axis.i", "axis.j", "axis.k"];
    const axes = machine.axes.map(({ name, kind }) => (bare && kind !== "rotary" ? null : columns.get(`q.${name}`).part(part)));
    const lengths = columns.get("tool_length").part(part);
    const values = names.map((name, at) => (bare && at < 3 ? null : columns.get(name).packed(part)));
    const pose = new Float64Array(6 + machine.axes.length * 3);
    const into = P.poser(machine);
    let row = 0;
    const value = (place) => axes[place][row];
    for (; row < lengths.length; row++) {
      into(value, lengths[row], pose, bare);
      for (let name = bare ? 3 : 0; name < 6; name++) values[name][row] += pose[name];
    }
    values.forEach((told, at) => told && columns.get(names[at]).keep(told, part));
  },
  // The linear axes, told against those that bring the tip where it is, the rotary axes being as they are.
  tips: ({ meta }, columns, part) => {
    const { machine } = meta;
    const axes = machine.axes.map(({ name, kind }) => (kind === "rotary" ? columns.get(`q.${name}`).part(part) : null));
    const slides = machine.axes.filter(({ kind }) => kind !== "rotary").reverse();
    const told = slides.map(({ name }) => columns.get(`q.${name}`).packed(part));
    const lengths = columns.get("tool_length").part(part);
    const [x, y, z] = ["tip.x", "tip.y", "tip.z"].map((name) => columns.get(name).part(part));
    const m = new Float64Array(15);
    const far = new Float64Array(3);
    const into = P.poser(machine);
    let row = 0;
    const value = (place) => axes[place][row];
    // The volume of three of the vectors in m; one of them may be the way that is left.
    const volume = (a, p, b, q, c, r) => a[p] * (b[q + 1] * c[r + 2] - b[q + 2] * c[r + 1]) + a[p + 1] * (b[q + 2] * c[r] - b[q] * c[r + 2]) + a[p + 2] * (b[q] * c[r + 1] - b[q + 1] * c[r]);
    for (; row < lengths.length; row++) {
      into(value, lengths[row], m, true);
      far[0] = x[row] - m[0];
      far[1] = y[row] - m[1];
      far[2] = z[row] - m[2];
      const whole = volume(m, 6, m, 9, m, 12);
      if (Math.abs(whole) < 1e-3) continue;
      told[0][row] += volume(far, 0, m, 9, m, 12) / whole + slides[0].zero;
      told[1][row] += volume(m, 6, far, 0, m, 12) / whole + slides[1].zero;
      told[2][row] += volume(m, 6, m, 9, far, 0) / whole + slides[2].zero;
    }
    slides.forEach(({ name }, at) => columns.get(`q.${name}`).keep(told[at], part));
  },
  // Points of the CL path, told against the tip of the last of the next blocks that come from the same line.
  blocks: (report, columns) => {
    const { rows, columns: of } = report.tables.blocks;
    const lines = columns.get("line").values;
    const from = of.get("cl").values;
    const names = ["x", "y", "z"];
    const tips = names.map((name) => of.get(`tip.${name}`).values);
    const values = names.map((name) => columns.get(name).packed());
    let block = 0;
    for (let point = 0; rows && point < lines.length; point++) {
      const line = lines[point];
      if (point === 0 || line !== lines[point - 1]) {
        let found = block;
        while (found < rows && found < block + 64 && from[found] !== line) found++;
        if (from[found] === line && found < block + 64) {
          while (found + 1 < rows && from[found + 1] === line) found++;
          block = found;
        }
      }
      for (let at = 0; at < 3; at++) values[at][point] += tips[at][block];
    }
    names.forEach((name, at) => columns.get(name).keep(values[at]));
  },
  // How near bodies come in a block and what it cuts, told of its line; of several ways over a line the nearest and the most. A
  // block that does not move has none, and no body comes nearer than zero.
  lines: ({ tables }, columns) => {
    const { nc, ...told } = Object.fromEntries([...tables.clearance.columns].map(([name, { values }]) => [name, values]));
    for (const [name, values] of Object.entries(told)) {
      const worse = name === "clearance" ? Math.min : Math.max;
      const of = new Map();
      nc.forEach((line, at) => values[at] >= 0 && of.set(line, worse(values[at], of.get(line) ?? values[at])));
      columns.get(name).keep(Float64Array.from(columns.get("nc").values, (line) => of.get(line) ?? NaN));
    }
  },
  // The beginning of a block, told against the end of the one before.
  t1: (report, columns) => {
    const ends = columns.get("t1").values;
    const values = columns.get("t0").packed();
    for (let row = 1; row < values.length; row++) values[row] += ends[row - 1];
    columns.get("t0").keep(values);
  },
  // The end of a block, told against that of the one before and what a straight way takes at the feed.
  way: (report, columns) => {
    const [x, y, z, feed] = ["tip.x", "tip.y", "tip.z", "feed"].map((name) => columns.get(name).values);
    const values = columns.get("t1").packed();
    for (let row = 0; row < values.length; row++) {
      const from = row ? row - 1 : 0;
      const way = row ? Math.sqrt((x[row] - x[from]) ** 2 + (y[row] - y[from]) ** 2 + (z[row] - z[from]) ** 2) : Math.hypot(x[0], y[0], z[0]);
      values[row] += (row ? values[row - 1] : 0) + (feed[row] > 0 ? (60 * way) / feed[row] : 0);
    }
    columns.get("t1").keep(values);
  },
  // Places of a block, told against even steps from tip to tip; a single one on the way against the chain, where all follows
  // from it. How far that one is off the CL path, told against how far it is off the straight way.
  tip: ({ meta, tables }, columns) => {
    const blocks = tables.blocks.columns;
    const rows = columns.get("row").values;
    const held = columns.get("held").values;
    const names = ["x", "y", "z", "d.x", "d.y", "d.z"];
    const tips = names.slice(0, 3).map((name) => blocks.get(`tip.${name}`).values);
    const values = names.map((name) => columns.get(name).packed());
    const chained = blocks.get("tip.x").from === "chain";
    const into = chained && P.poser(meta.machine);
    const axes = chained && meta.machine.axes.map(({ name }) => blocks.get(`q.${name}`).values);
    const lengths = chained && blocks.get("tool_length").values;
    const pose = new Float64Array(6);
    const half = (place) => (axes[place][row - 1] + axes[place][row]) / 2;
    let row = 0;
    for (let first = 0, end = 0; first < rows.length; first = end) {
      row = rows[first];
      while (end < rows.length && rows[end] === row) end++;
      const from = tips.map((tip) => tip[Math.max(row - 1, 0)]);
      const step = tips.map((tip, at) => tip[row] - from[at]);
      const single = row > 0 && end - first === 2;
      if (single && chained) into(half, lengths[row], pose);
      for (let at = 0; at < 3; at++)
        for (let place = first; place < end; place++) values[at][place] += single && chained && place === first ? pose[at] : from[at] + step[at] * ((place - first + 1) / (end - first));
      if (!single || !held[first]) continue;
      const bow = from.map((value, at) => values[at][first] - value - step[at] / 2);
      const share = P.vec.dot(bow, step) / (P.vec.dot(step, step) || 1);
      for (let at = 0; at < 3; at++) values[at + 3][first] += bow[at] - step[at] * share;
    }
    names.forEach((name, at) => columns.get(name).keep(values[at]));
  },
};
