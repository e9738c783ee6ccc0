// The machine drawn from its chain: tables and heads as discs on their axis lines, slides on rails, the tool, and the
// boxes of travel. Only lines, directions and travels are known; sizes are chosen to fit the path.

P.parts = {};

P.parts.build = () => {
  const { meta } = P.m;
  const { machine } = meta;
  const made = { faces: [], edges: [], labels: [] };
  const vec = {
    add: (a, b, by = 1) => [a[0] + b[0] * by, a[1] + b[1] * by, a[2] + b[2] * by],
    dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
    cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  };
  const { add, dot, cross } = vec;
  const unit = P.chain.unit;
  const mount = P.chain.mount(machine);
  const axis = unit(machine.tool_axis);
  const tip = P.chain.tip(machine, meta.tool_length);
  const { low, high, centre } = P.scene;
  const reach = Math.hypot(high[0] - low[0], high[1] - low[1]) / 2;
  const apart = Math.hypot(...add(machine.gauge, mount, -1));
  const size = P.clamp(reach * 1.15, apart * 0.18, Math.max(apart * 0.5, reach * 1.15)) || 50;
  const bed = P.chain.bed(machine);

  const face = (body, tone, a, b, c) => {
    const normal = unit(cross(add(b, a, -1), add(c, a, -1)));
    for (const point of [a, b, c]) made.faces.push(...point, ...normal, body, tone);
  };
  const edge = (body, a, b) => made.edges.push(...a, body, ...b, body);
  const frame_of = (k) => {
    const side = unit(cross(k, Math.abs(k[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    return [side, cross(k, side)];
  };
  // A cylinder or cone from a to b.
  const round = (body, tone, a, b, from, to, steps = 28) => {
    const k = unit(add(b, a, -1));
    const [u, v] = frame_of(k);
    const ring = (at, radius, step) => {
      const turn = (step * 2 * Math.PI) / steps;
      return add(add(at, u, radius * Math.cos(turn)), v, radius * Math.sin(turn));
    };
    for (let step = 0; step < steps; step++) {
      const [p, q, r, s] = [ring(a, from, step), ring(a, from, step + 1), ring(b, to, step), ring(b, to, step + 1)];
      if (from > 0) face(body, tone, p, q, r);
      if (to > 0) face(body, tone, q, s, r);
      if (from > 0) face(body, tone, a, q, p);
      if (to > 0) face(body, tone, b, r, s);
      if (from > 0) edge(body, p, q);
      if (to > 0) edge(body, r, s);
    }
    // Spokes, so that a turn is seen.
    edge(body, b, ring(b, to, 0));
    edge(body, ring(a, from, 0), ring(b, to, 0));
  };
  // A box about a middle with half lengths along three directions.
  const box = (body, tone, middle, u, v, w) => {
    const corner = (i, j, k) => add(add(add(middle, u, i), v, j), w, k);
    const sides = [[[-1, -1, -1], [-1, 1, -1], [1, 1, -1], [1, -1, -1]], [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]],
      [[-1, 1, -1], [-1, 1, 1], [1, 1, 1], [1, 1, -1]], [[-1, -1, -1], [-1, -1, 1], [-1, 1, 1], [-1, 1, -1]], [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]]];
    for (const side of sides) {
      const [a, b, c, d] = side.map((at) => corner(...at));
      if (tone >= 0) {
        face(body, tone, a, b, c);
        face(body, tone, a, c, d);
      }
      edge(body, a, b);
      edge(body, c, d);
      if (tone < 0) edge(body, b, c);
    }
  };
  const bar = (body, a, b, width) => {
    const way = add(b, a, -1);
    if (Math.hypot(...way) < width * 0.5) return;
    const [u, v] = frame_of(unit(way));
    box(body, 0.75, add(a, way, 0.5), way.map((value) => value / 2), u.map((value) => value * width), v.map((value) => value * width));
  };
  const foot = ({ point, direction }, near) => {
    const k = unit(direction);
    return add(point, k, dot(add(near, point, -1), k));
  };
  const label = (body, at, text) => made.labels.push({ body, at, text });
  // A slide: its carriage goes with one body, its rail stays on the other.
  const slide = (joint, anchor, carriage, rail, sign) => {
    const k = unit(joint.direction);
    const [u, v] = frame_of(k);
    const [from, to] = joint.travel || [-size, size];
    const [a, b] = sign > 0 ? [from, to] : [-to, -from];
    const middle = add(anchor, k, (a + b) / 2);
    const half = Math.min((b - a) / 2, size * 12) + size * 0.3;
    box(carriage, 1, anchor, k.map((x) => x * size * 0.3), u.map((x) => x * size * 0.3), v.map((x) => x * size * 0.07));
    for (const side of [-1, 1]) box(rail, 0.8, add(add(middle, u, side * size * 0.2), v, -size * 0.11), k.map((x) => x * half), u.map((x) => x * size * 0.03), v.map((x) => x * size * 0.03));
    label(carriage, add(anchor, u, size * 0.34), joint.name);
    return add(anchor, v, -size * 0.16);
  };

  // The side of the work, from the part to the bed.
  const down = axis.map((value) => -value);
  const floor = Math.min(0, low[2]) - size * 0.02;
  let anchor = add(add(mount, [centre[0], centre[1], 0]), axis, Math.abs(axis[2]) > 0.7 ? floor : 0);
  let first = true;
  for (let at = 0; at < bed; at++) {
    const joint = machine.axes[at];
    if (joint.kind !== "rotary") {
      if (first) box(at, 1, add(anchor, down, size * 0.05), [size, 0, 0], [0, size * 0.8, 0], [0, 0, size * 0.05]);
      anchor = slide(joint, add(anchor, down, size * (first ? 0.2 : 0.12)), at, at + 1, -1);
      first = false;
      continue;
    }
    const k = unit(joint.direction);
    const near = foot(joint, anchor);
    if (first && Math.abs(dot(k, axis)) > 0.7) {
      round(at, 1, add(near, down, size * 0.12), near, size, size, 48);
      round(at + 1, 0.85, add(near, down, size * 0.3), add(near, down, size * 0.13), size * 0.6, size * 0.6);
      label(at, add(near, frame_of(k)[0], size * 1.08), joint.name);
      anchor = add(near, down, size * 0.24);
    } else {
      if (first) box(at, 1, add(anchor, down, size * 0.05), [size * 0.9, 0, 0], [0, size * 0.9, 0], [0, 0, size * 0.05]);
      for (const side of [-1, 1]) {
        const cheek = add(near, k, side * size * 1.25);
        round(at, 1, add(cheek, k, side * size * 0.14), cheek, size * 0.3, size * 0.3);
        const under = add(anchor, k, side * size * 1.25 - 0 * size);
        bar(at, cheek, add(cheek, down, Math.max(0.35 * size, dot(add(anchor, cheek, -1), down) + 0.06 * size)), size * 0.09);
        bar(at, under, anchor, size * 0.09);
        if (side > 0) label(at, add(cheek, k, size * 0.24), joint.name);
        bar(at + 1, add(cheek, k, side * size * 0.24), add(add(cheek, k, side * size * 0.24), down, size * 1.15), size * 0.1);
      }
      anchor = add(near, down, size * 1.15);
      bar(at + 1, add(anchor, k, size * 1.49), add(anchor, k, -size * 1.49), size * 0.1);
    }
    first = false;
  }
  if (first) box(0, 1, add(anchor, down, size * 0.06), [size * 1.2, 0, 0], [0, size, 0], [0, 0, size * 0.06]);
  const base = anchor;

  // The side of the tool, from the tool back to the bed.
  const last = machine.axes.length;
  const length = meta.tool_length > 0 ? meta.tool_length : 0;
  const thick = P.clamp(length * 0.09 || size * 0.07, size * 0.02, size * 0.16);
  if (length > 0) {
    round(last, 1.25, add(tip, axis, thick * 0.8), machine.gauge, thick * 0.8, thick * 0.8, 20);
    round(last, 1.25, add(tip, axis, thick * 0.8), tip, thick * 0.8, thick * 0.2, 20);
  }
  const nose = length > 0 ? 0 : size * 0.3;
  if (nose) round(last, 1.25, add(machine.gauge, axis, nose), machine.gauge, size * 0.13, size * 0.015, 20);
  const holder = add(machine.gauge, axis, nose);
  round(last, 1, holder, add(holder, axis, size * 0.3), size * 0.13, size * 0.2);
  round(last, 0.9, add(holder, axis, size * 0.3), add(holder, axis, size * 0.75), size * 0.24, size * 0.24);
  anchor = add(holder, axis, size * 0.75);
  for (let at = last - 1; at >= bed; at--) {
    const joint = machine.axes[at];
    const k = unit(joint.direction);
    if (joint.kind === "rotary") {
      const near = foot(joint, anchor);
      const along = Math.abs(dot(k, axis)) > 0.7;
      const middle = along ? add(near, axis, size * 0.1) : near;
      const thick_half = along ? 0.1 : 0.3;
      round(at + 1, 1, add(middle, k, -size * thick_half), add(middle, k, size * thick_half), size * 0.28, size * 0.28);
      bar(at + 1, anchor, middle, size * 0.1);
      label(at + 1, add(middle, k, size * (thick_half + 0.12)), joint.name);
      const away = along ? add(middle, axis, size * 0.22) : add(add(middle, k, -size * 0.4), axis, size * 0.5);
      if (!along) bar(at, add(middle, k, -size * 0.34), away, size * 0.1);
      anchor = away;
    } else {
      const behind = [0, size * 0.12, 0];
      bar(at + 1, anchor, add(anchor, behind), size * 0.08);
      anchor = slide(joint, add(anchor, behind), at + 1, at, 1);
    }
  }
  // The bed: a foot under the work and a column behind it up to the slides of the tool.
  const back = [0, 1, 0];
  const column = add(base, back, Math.max(anchor[1] - base[1], size * 2.2));
  const upper = [anchor[0], column[1], anchor[2]];
  bar(bed, base, [base[0], column[1], base[2]], size * 0.12);
  bar(bed, [base[0], column[1], base[2]], upper, size * 0.16);
  bar(bed, upper, anchor, size * 0.12);

  // Boxes of travel: where the slides of the tool may bring the tip, and those of the work the part's origin.
  const boxes = { edges: [] };
  const travel = (joints, from, sign) => {
    const slides = joints.filter((joint) => joint.kind !== "rotary" && joint.travel);
    if (!slides.length) return;
    const spans = slides.map((joint) => joint.travel.map((value) => unit(joint.direction).map((x) => x * value * sign)));
    const corner = (bits) => spans.reduce((at, span, place) => add(at, span[(bits >> place) & 1]), from);
    for (let bits = 0; bits < 1 << spans.length; bits++)
      for (let place = 0; place < spans.length; place++)
        if (!(bits & (1 << place))) boxes.edges.push(...corner(bits), bed, ...corner(bits | (1 << place)), bed);
  };
  travel(machine.axes.slice(bed), tip, 1);
  travel(machine.axes.slice(0, bed), mount, -1);
  P.parts.made = { faces: new Float32Array(made.faces), edges: new Float32Array(made.edges), boxes: new Float32Array(boxes.edges), labels: made.labels, size };
};

// Points that the machine takes up, for fitting the view: scene coordinates under the bodies given.
P.parts.points = (bodies) => {
  const { edges } = P.parts.made;
  const points = [];
  for (let at = 0; at < edges.length; at += 16) points.push(P.chain.apply(bodies[edges[at + 3]], [edges[at], edges[at + 1], edges[at + 2]]));
  return points;
};
