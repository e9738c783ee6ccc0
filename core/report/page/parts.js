// The machine drawn from its chain: tables and heads as discs on their axis lines, slides on rails, the tool, and the
// boxes of travel. The tool is as long as it is, and as thick where its cutter is known; solids are what they are. Of the
// rest only lines, directions and travels are known: sizes are chosen to fit the path.

// What is drawn in a colour of its own: the tool, what holds it, what carries the part. Added to the tone of a face.
P.TOOL = 10;
P.HOLDER = 20;
P.TABLE = 30;
P.GOUGE = 40;
P.REST = 50;

P.vec = {
  add: (a, b, by = 1) => [a[0] + b[0] * by, a[1] + b[1] * by, a[2] + b[2] * by],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  times: (a, by) => a.map((value) => value * by),
};

// Shapes in faces (place, normal, body, tone) and edges (place, body).
// Bodies that are `hidden` show nothing but the tool.
P.shapes = (made, hidden) => {
  const { add, cross, times } = P.vec;
  const { unit } = P.chain;
  const edge = (body, a, b) => made.edges.push(...a, body, ...b, body);
  const face = (body, tone, a, b, c) => {
    const normal = unit(cross(add(b, a, -1), add(c, a, -1)));
    for (const point of [a, b, c]) made.faces.push(...point, ...normal, body, tone);
  };
  const across = (k) => {
    const side = unit(cross(k, Math.abs(k[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    return [side, cross(k, side)];
  };
  // A cylinder or cone from a to b, with a spoke, so that a turn is seen.
  const round = (body, tone, a, b, from, to = from, steps = 32) => {
    if (hidden.includes(body) && Math.floor(tone / 10) * 10 !== P.TOOL) return;
    const [u, v] = across(unit(add(b, a, -1)));
    const ring = (at, radius, step) => {
      const turn = (step * 2 * Math.PI) / steps;
      return add(add(at, u, radius * Math.cos(turn)), v, radius * Math.sin(turn));
    };
    for (let step = 0; step < steps; step++) {
      const [p, q, r, s] = [ring(a, from, step), ring(a, from, step + 1), ring(b, to, step), ring(b, to, step + 1)];
      face(body, tone, p, q, r);
      face(body, tone, q, s, r);
      face(body, tone, a, q, p);
      face(body, tone, b, r, s);
      edge(body, p, q);
      edge(body, r, s);
    }
    edge(body, b, ring(b, to, 0));
    edge(body, ring(a, from, 0), ring(b, to, 0));
  };
  // A box about a middle with half lengths along three directions.
  const box = (body, tone, middle, u, v, w) => {
    if (hidden.includes(body)) return;
    for (const [a, b, c] of [[u, v, w], [v, w, u], [w, u, v]]) {
      for (const side of [-1, 1]) {
        const corner = (i, j) => add(add(add(middle, c, side), a, i), b, j);
        const [p, q, r, s] = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
        face(body, tone, p, q, r);
        face(body, tone, p, r, s);
        edge(body, p, q);
        edge(body, r, s);
      }
    }
  };
  const bar = (body, a, b, width, tone = 0.75) => {
    const way = add(b, a, -1);
    if (Math.hypot(...way) < width * 0.5) return;
    const [u, v] = across(unit(way));
    box(body, tone, add(a, way, 0.5), times(way, 0.5), times(u, width), times(v, width));
  };
  return { across, round, box, bar, face, edge };
};

P.parts = {};

P.parts.build = (machine) => {
  const { meta } = P.m;
  const made = { faces: [], edges: [], boxes: [], labels: [] };
  const { solids } = P.m.report.tables;
  const { across, round, box, bar, face, edge } = P.shapes(made, solids ? machine.solid : []);
  const { add, dot, times } = P.vec;
  const { unit } = P.chain;
  const mount = P.chain.mount(machine);
  const axis = unit(machine.tool_axis);
  const down = times(axis, -1);
  const length = Math.max(P.chain.length(P.state.row) || 0, 0);
  const cutter = P.chain.cutter(P.state.row);
  const outline = P.chain.outline(P.state.row);
  const tip = P.chain.tip(machine, length);
  const { low, high, centre } = P.scene;
  const reach = (Math.hypot(high[0] - low[0], high[1] - low[1]) / 2) * 1.15;
  const apart = Math.hypot(...add(machine.gauge, mount, -1));
  const size = P.clamp(reach, apart * 0.18, Math.max(apart * 0.5, reach)) || 50;
  const bed = P.chain.bed(machine);
  const of = (body) => (body < bed ? P.TABLE : body === machine.axes.length ? P.HOLDER : 0);
  const label = (body, at, text) => made.labels.push({ body, at, text });
  const along = (k) => Math.abs(dot(k, axis)) > 0.7;
  const plate = (body, at) => box(body, 1 + of(body), add(at, down, size * 0.05), [size, 0, 0], [0, size * 0.85, 0], [0, 0, size * 0.05]);
  // The point of an axis line that is nearest.
  const foot = ({ point, direction }, near) => add(point, unit(direction), dot(add(near, point, -1), unit(direction)));
  // A slide: its carriage goes with one body, its rails stay on the other.
  const slide = ({ direction, travel, name }, anchor, carriage, rail, sign) => {
    const k = unit(direction);
    const [u, v] = across(k);
    const [from, to] = times(travel || [-size, size], sign).sort((a, b) => a - b);
    const half = Math.min((to - from) / 2, size * 12) + size * 0.3;
    box(carriage, 1 + of(carriage), anchor, times(k, size * 0.3), times(u, size * 0.3), times(v, size * 0.07));
    for (const side of [-0.2, 0.2]) {
      const middle = add(add(add(anchor, k, (from + to) / 2), u, side * size), v, -size * 0.11);
      box(rail, 0.8, middle, times(k, half), times(u, size * 0.03), times(v, size * 0.03));
    }
    label(carriage, add(anchor, u, size * 0.34), name);
    return add(anchor, v, -size * 0.16);
  };

  // The side of the work, from the part to the bed.
  const floor = Math.min(0, low[2]) - size * 0.02;
  let anchor = add(add(mount, [centre[0], centre[1], 0]), axis, along([0, 0, 1]) ? floor : 0);
  for (let at = 0; at < bed; at++) {
    const joint = machine.axes[at];
    const k = unit(joint.direction);
    const first = at === 0;
    if (joint.kind !== "rotary") {
      if (first) plate(0, anchor);
      anchor = slide(joint, add(anchor, down, size * (first ? 0.2 : 0.12)), at, at + 1, -1);
    } else if (first && along(k)) {
      const near = foot(joint, anchor);
      round(0, 1 + of(0), add(near, down, size * 0.12), near, size, size, 48);
      round(1, 0.85, add(near, down, size * 0.3), add(near, down, size * 0.13), size * 0.6);
      label(0, add(near, across(k)[0], size * 1.08), joint.name);
      anchor = add(near, down, size * 0.24);
    } else {
      if (first) plate(0, anchor);
      const near = foot(joint, anchor);
      const below = add(near, down, size * 1.15);
      for (const side of [-1, 1]) {
        const cheek = add(near, k, side * size * 1.25);
        const outer = add(cheek, k, side * size * 0.24);
        round(at, 1 + of(at), add(cheek, k, side * size * 0.14), cheek, size * 0.3);
        bar(at, cheek, add(cheek, down, Math.max(0.35 * size, dot(add(anchor, cheek, -1), down) + 0.06 * size)), size * 0.09, 0.75 + of(at));
        bar(at, add(anchor, k, side * size * 1.25), anchor, size * 0.09, 0.75 + of(at));
        bar(at + 1, outer, add(outer, down, size * 1.15), size * 0.1);
        bar(at + 1, add(below, k, side * size * 1.49), below, size * 0.1);
        if (side > 0) label(at, outer, joint.name);
      }
      anchor = below;
    }
  }
  if (!bed) plate(0, anchor);
  const base = anchor;

  // The side of the tool, from the tool back to the bed.
  const last = machine.axes.length;
  const thick = cutter ? cutter.diameter / 2 : P.clamp(length * 0.09, size * 0.02, size * 0.16) * 0.8;
  const holder = length ? machine.gauge : add(machine.gauge, axis, cutter ? cutter.stick_out || cutter.diameter * 4 : size * 0.3);
  const free = cutter && cutter.stick_out && length ? Math.min(cutter.stick_out, length) : null;
  const shank = free ? add(tip, axis, free) : holder;
  const tool = 1.25 + P.TOOL;
  // An outline in cones, z from `from` along `way`: it is true to size, whatever solids stand for.
  const bare = P.shapes(made, []).round;
  const turned = (tone, points, from, way) => points.slice(1).forEach(([z, r], at) => bare(last, tone, add(from, way, points[at][0]), add(from, way, z), points[at][1], r));
  if (outline) {
    turned(tool, outline.cutter, tip, axis);
    turned(1.1 + P.HOLDER, outline.holder, machine.gauge, down);
  }
  if (outline && outline.cutter.length) {
    // It is drawn.
  } else if (cutter) {
    // The corner in chords; a flat end is a disc.
    const corner = cutter.corner_radius;
    const ring = (step) => [thick - corner * (1 - Math.sin((step * Math.PI) / 12)), add(tip, axis, corner * (1 - Math.cos((step * Math.PI) / 12)))];
    for (let step = 0; corner > 0 && step < 6; step++) round(last, tool, ring(step + 1)[1], ring(step)[1], ring(step + 1)[0], ring(step)[0]);
    round(last, tool, add(tip, axis, corner), shank, thick);
    if (free) round(last, 1.1 + P.HOLDER, shank, holder, Math.max(thick * 1.6, size * 0.06));
  } else if (length) {
    const neck = add(tip, axis, thick);
    round(last, tool, neck, holder, thick);
    round(last, tool, neck, tip, thick, thick * 0.25);
  } else round(last, tool, holder, machine.gauge, size * 0.13, size * 0.015);
  anchor = add(holder, axis, size * 0.75);
  round(last, 1 + P.HOLDER, holder, add(holder, axis, size * 0.3), size * 0.13, size * 0.2);
  round(last, 0.9 + P.HOLDER, add(holder, axis, size * 0.3), anchor, size * 0.24);
  for (let at = last - 1; at >= bed; at--) {
    const joint = machine.axes[at];
    const k = unit(joint.direction);
    if (joint.kind !== "rotary") {
      const behind = add(anchor, [0, size * 0.12, 0]);
      bar(at + 1, anchor, behind, size * 0.08);
      anchor = slide(joint, behind, at + 1, at, 1);
      continue;
    }
    const near = foot(joint, anchor);
    const middle = along(k) ? add(near, axis, size * 0.1) : near;
    const half = size * (along(k) ? 0.1 : 0.3);
    round(at + 1, 1, add(middle, k, -half), add(middle, k, half), size * 0.28);
    bar(at + 1, anchor, middle, size * 0.1);
    label(at + 1, add(middle, k, half + size * 0.12), joint.name);
    anchor = along(k) ? add(middle, axis, size * 0.22) : add(add(middle, k, -size * 0.4), axis, size * 0.5);
    if (!along(k)) bar(at, add(middle, k, -size * 0.34), anchor, size * 0.1);
  }
  // The bed: a foot under the work and a column behind it up to the slides of the tool.
  const behind = base[1] + Math.max(anchor[1] - base[1], size * 2.2);
  const corners = [base, [base[0], behind, base[2]], [anchor[0], behind, anchor[2]], anchor];
  corners.slice(1).forEach((corner, at) => bar(bed, corners[at], corner, size * (at === 1 ? 0.16 : 0.12)));

  // Solids that the machine file names.
  let far = 0;
  if (solids) {
    const [shapes, corners, body, ...place] = [...solids.columns.values()].map(({ values }) => values);
    const corner = (row) => place.map((values) => values[row]);
    for (let row = 0; row < solids.rows; row += corners[row]) {
      const [a, b, c] = [0, 1, 2].map((more) => corner(row + more));
      if (shapes[row] !== machine.shapes) continue;
      far = Math.max(far, ...a.map(Math.abs));
      if (corners[row] > 2) face(body[row], 1 + of(body[row]), a, b, c);
      else edge(body[row], a, b);
    }
  }

  // What is left of the stock beside the part: where that is cut into, and where something is left on it.
  const { left } = P.m.report.tables;
  if (left && !machine.shapes) {
    const [body, over, ...place] = [...left.columns.values()].map(({ values }) => values);
    const corner = (row) => place.map((values) => values[row]);
    const tone = (far, body) => (far < 0 ? P.GOUGE : far > 0 ? P.REST : of(body));
    for (let row = 0; row < left.rows; row += 3) face(body[row], 1 + tone(over[row], body[row]), corner(row), corner(row + 1), corner(row + 2));
  }

  // Boxes of travel: where the slides of the tool may bring the tip, and those of the work the part's origin.
  const travel = (joints, from, sign) => {
    const spans = joints.filter((joint) => joint.kind !== "rotary" && joint.travel).map((joint) => joint.travel.map((value) => times(unit(joint.direction), (value - joint.zero) * sign)));
    const corner = (bits) => spans.reduce((at, span, place) => add(at, span[(bits >> place) & 1]), from);
    for (let bits = 0; bits < 1 << spans.length; bits++)
      for (let place = 0; place < spans.length; place++)
        if (!(bits & (1 << place))) made.boxes.push(...corner(bits), bed, ...corner(bits | (1 << place)), bed);
  };
  travel(machine.axes.slice(bed), tip, 1);
  travel(machine.axes.slice(0, bed), mount, -1);
  for (const name of ["faces", "edges", "boxes"]) made[name] = new Float32Array(made[name]);
  P.parts.made = { ...made, deep: Math.max(size * 40, far * 4), machine, length, cutter, outline };
};

// Points that the machine takes up, for fitting the view: scene coordinates under the bodies given.
P.parts.points = (bodies) => {
  const { edges, boxes } = P.parts.made;
  return [edges, boxes].flatMap((ends) => Array.from({ length: ends.length / 4 }, (_, at) => P.chain.apply(bodies[ends[at * 4 + 3]], ends.subarray(at * 4, at * 4 + 3))));
};
