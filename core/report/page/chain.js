// The chain as it is drawn: where its bodies stand. Tip and tool axis follow from the same product as in derive.js.

P.chain = {};

// `vector` turned about the unit vector `k` (Rodrigues' formula).
P.chain.turn = (v, k, sine, cosine) => {
  const along = (k[0] * v[0] + k[1] * v[1] + k[2] * v[2]) * (1 - cosine);
  return [
    v[0] * cosine + (k[1] * v[2] - k[2] * v[1]) * sine + k[0] * along,
    v[1] * cosine + (k[2] * v[0] - k[0] * v[2]) * sine + k[1] * along,
    v[2] * cosine + (k[0] * v[1] - k[1] * v[0]) * sine + k[2] * along,
  ];
};

P.chain.unit = (v) => {
  const length = Math.hypot(v[0], v[1], v[2]) || 1;
  return [v[0] / length, v[1] / length, v[2] / length];
};

// Where the part origin sits with all axes at zero, mm, machine frame.
P.chain.mount = ({ mount }) => mount.slice(0, 3).map((row) => row[3]);

// The tip with all axes at zero for a tool of this length, mm, machine frame.
P.chain.tip = ({ gauge, tool_axis }, length) => gauge.map((value, at) => value - tool_axis[at] * (length || 0));

// Tip and tool axis in the part frame, from axis positions as the control shows them, mm and degrees, in the chain's order.
P.chain.forward = (machine, values, length) => {
  const pose = new Float64Array(6);
  P.poser(machine)((at) => values[at], length || 0, pose);
  return { tip: [...pose.subarray(0, 3)], axis: [...pose.subarray(3)] };
};

// A rigid motion: three columns of a rotation and a shift, as sixteen numbers column by column.
P.chain.still = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
P.chain.times = (a, b) => {
  const c = new Array(16).fill(0);
  for (let column = 0; column < 4; column++)
    for (let row = 0; row < 4; row++)
      for (let at = 0; at < 4; at++) c[column * 4 + row] += a[at * 4 + row] * b[column * 4 + at];
  return c;
};
P.chain.back = (m) => {
  const r = [m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, 0, 0, 0, 1];
  for (let row = 0; row < 3; row++) r[12 + row] = -(r[row] * m[12] + r[4 + row] * m[13] + r[8 + row] * m[14]);
  return r;
};
P.chain.apply = (m, v) => [0, 1, 2].map((row) => m[row] * v[0] + m[4 + row] * v[1] + m[8 + row] * v[2] + m[12 + row]);

// The motion of one joint that stands at a position.
P.chain.motion = ({ kind, direction, point, zero }, position) => {
  const value = position - zero;
  const k = P.chain.unit(direction);
  const m = P.chain.still();
  if (kind !== "rotary") {
    for (let row = 0; row < 3; row++) m[12 + row] = k[row] * value;
    return m;
  }
  const angle = (value * Math.PI) / 180;
  for (let column = 0; column < 3; column++) {
    const turned = P.chain.turn([0, 1, 2].map((at) => (at === column ? 1 : 0)), k, Math.sin(angle), Math.cos(angle));
    for (let row = 0; row < 3; row++) m[column * 4 + row] = turned[row];
  }
  const carried = P.chain.apply(m, point);
  for (let row = 0; row < 3; row++) m[12 + row] = point[row] - carried[row];
  return m;
};

// Where the bed is in the chain: the number of axes that carry the work.
P.chain.bed = (machine) => machine.axes.filter((axis) => axis.carries === "work").length;

// The motion of every body from where it stands with all axes at zero: the part, what each axis carries, the tool.
// In the part frame the part stands still; in the machine frame the bed does.
P.chain.bodies = (machine, values, frame) => {
  const bodies = [P.chain.still()];
  machine.axes.forEach((axis, at) => bodies.push(P.chain.times(bodies[at], P.chain.motion(axis, values[at]))));
  if (frame !== "machine") return bodies;
  const back = P.chain.back(bodies[P.chain.bed(machine)]);
  return bodies.map((body) => P.chain.times(back, body));
};

// The machine with the head that is in use in a block; null where no machine is known.
P.chain.at = (row) => {
  const { machine, heads, head_rows } = P.m.meta;
  const [, head] = head_rows.findLast(([from]) => from <= row) || [0, 0];
  return head ? heads[head - 1] : machine;
};

// Axis values at a share of a block: the control moves all axes linearly between blocks. Where a head was swapped they begin.
P.chain.values = (row, share) => {
  const machine = P.chain.at(row);
  const first = row === 0 || P.chain.at(row - 1) !== machine;
  return machine.axes.map(({ name }) => {
    const to = P.m.at(`q.${name}`, row) || 0;
    if (first || share === 1) return to;
    const from = P.m.at(`q.${name}`, row - 1) || 0;
    return from + (to - from) * share;
  });
};

// The size of the tool that is in use in a block, mm; null where nobody has told it.
P.chain.tool = (row) => P.m.meta.events.findLast((event) => event.kind === "tool" && event.row <= row) || {};
P.chain.cutter = (row) => P.chain.tool(row).cutter || null;

// Its outline, as the machine file has it: what cuts and what does not; null where it has none.
P.chain.outline = (row) => P.chain.tool(row).outline || null;

// The length of the tool that is in use in a block, mm.
P.chain.length = (row) => P.m.at("tool_length", row) ?? P.m.meta.tool_length;
