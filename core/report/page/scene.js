// What is drawn, as plain numbers: both renderers draw from here, and a click is found here.

P.scene = { ready: false, marks: [] };

// Segments that a moving frame draws of the path, of the CL path and of the deviation vectors.
P.scene.budget = { path: 6500, cl: 3000, vectors: 1200, marks: 1500 };
// Vectors that are kept at all: of every group of points, the largest.
P.scene.most_vectors = 100000;

// How a segment is drawn.
P.scene.CUT = 0;
P.scene.RAPID = 1;
P.scene.NONE = 2;

P.scene.build = () => {
  const { report, column, rows } = P.m;
  const table = report.tables.path;
  const given = (from, names) => names.map((name) => from && from.columns.has(name) && from.columns.get(name).values);
  let [row, x, y, z] = given(table, ["row", "x", "y", "z"]);
  let count = table ? table.rows : 0;
  if (!x || !y || !z) {
    [x, y, z] = ["tip.x", "tip.y", "tip.z"].map(column);
    row = null;
    count = x ? rows : 0;
  }
  if (!count) return;
  const scene = P.scene;
  const low = [x, y, z].map((values) => values.reduce((a, b) => (b < a ? b : a)));
  const high = [x, y, z].map((values) => values.reduce((a, b) => (b > a ? b : a)));
  scene.low = low;
  scene.high = high;
  scene.centre = low.map((value, at) => (value + high[at]) / 2);
  scene.radius = Math.max(Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2, 1e-3);
  const kind = column("kind");
  scene.path = P.scene.line(count, x, y, z, (point) => (row ? row[point] : point), (at) => (kind && kind[at] <= 2 ? scene.RAPID : scene.CUT));
  scene.cuts = P.scene.cut_box();
  const points = report.tables.cl;
  const [line, cx, cy, cz, rapid] = given(points, ["line", "x", "y", "z", "rapid"]);
  if (cx && cy && cz) {
    const from = P.m.has("nc2") ? "nc2" : "cl";
    const start = (point) => (line ? P.m.rowOf(from, line[point]) : point);
    scene.cl = P.scene.line(points.rows, cx, cy, cz, start, (_, point) => (rapid && rapid[point] ? scene.RAPID : scene.CUT));
  }
  const [dx, dy, dz] = given(table, ["d.x", "d.y", "d.z"]);
  if (dx && dy && dz) scene.vectors = P.scene.comb(count, [dx, dy, dz]);
  scene.marks = P.scene.find_marks();
  // What is drawn is held in single precision now; the tables of it would lie in memory twice.
  delete report.tables.path;
  delete report.tables.cl;
  P.release(0, (name) => !/^(t\d|kind)$/.test(name));
  scene.ready = true;
  P.scene.recolour();
};

// The corners of what is cut, from the middle of the path; of all where nothing is. Rapids may go far away.
P.scene.cut_box = () => {
  const { low, high, centre, path, CUT } = P.scene;
  const box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let point = 0; point < path.count; point++) {
    if (path.look[point * 4 + 1] !== CUT) continue;
    for (let at = 0; at < 3; at++) {
      const value = path.pos[point * 3 + at];
      if (value < box[0][at]) box[0][at] = value;
      if (value > box[1][at]) box[1][at] = value;
    }
  }
  return box[0][0] <= box[1][0] ? box : [low, high].map((corner) => corner.map((value, at) => value - centre[at]));
};

// A polyline: positions from the centre, and for each point place on the scale, kind, block and length so far of the
// segment that ends there.
P.scene.line = (count, x, y, z, rowOf, flagOf) => {
  const { centre } = P.scene;
  const pos = new Float32Array(count * 3);
  const look = new Float32Array(count * 4);
  const flags = new Uint8Array(count);
  let along = 0;
  for (let point = 0; point < count; point++) {
    pos[point * 3] = x[point] - centre[0];
    pos[point * 3 + 1] = y[point] - centre[1];
    pos[point * 3 + 2] = z[point] - centre[2];
    const row = rowOf(point);
    const flag = point === 0 ? P.scene.NONE : flagOf(row, point);
    if (flag === P.scene.RAPID) along += Math.hypot(x[point] - x[point - 1], y[point] - y[point - 1], z[point] - z[point - 1]);
    look[point * 4] = -1;
    look[point * 4 + 1] = flags[point] = flag;
    look[point * 4 + 2] = row;
    look[point * 4 + 3] = along;
  }
  return { count, pos, look, flags };
};

// Takes the blocks of hidden steps out of what is drawn, clicked at and fitted to; they stay in the texts and the charts.
P.scene.hide = () => {
  const { scene, m, state } = P;
  scene.gone = null;
  for (const at of state.hidden) {
    const [first, last] = m.span(at);
    (scene.gone ||= new Uint8Array(m.rows)).fill(1, first, last + 1);
  }
  for (const line of [scene.path, scene.cl]) {
    for (let point = 0; line && point < line.count; point++) line.look[point * 4 + 1] = P.scene.hides(line.look[point * 4 + 2]) ? scene.NONE : line.flags[point];
  }
  scene.cuts = P.scene.cut_box();
};
P.scene.hides = (row) => Boolean(P.scene.gone && P.scene.gone[row]);

// Every so many segments as one, coloured as the worst of them; a rapid is kept apart from a cut.
P.scene.thin = (line, budget) => {
  if (line.count <= budget) return line;
  const step = Math.ceil(line.count / budget);
  const kept = [0];
  const worst = [-1];
  let most = -1;
  for (let point = 1; point < line.count; point++) {
    most = Math.max(most, line.look[point * 4]);
    const turns = point + 1 < line.count && line.look[point * 4 + 1] !== line.look[point * 4 + 5];
    const room = kept.length < budget * 0.4;
    if (point % step === 0 || point === line.count - 1 || (turns && room)) {
      kept.push(point);
      worst.push(most);
      most = -1;
    }
  }
  const pos = new Float32Array(kept.length * 3);
  const look = new Float32Array(kept.length * 4);
  kept.forEach((point, at) => {
    pos.set(line.pos.subarray(point * 3, point * 3 + 3), at * 3);
    look.set(line.look.subarray(point * 4, point * 4 + 4), at * 4);
    look[at * 4] = worst[at];
  });
  return { count: kept.length, pos, look };
};

// The deviation vectors as pairs: foot on the CL path, and the vector; of every group of points in cuts the largest. One
// below half of its tolerance is not drawn: where all is well the path stays free.
P.scene.comb = (count, d) => {
  const { path } = P.scene;
  const step = Math.ceil(count / P.scene.most_vectors);
  const kept = [];
  const own = P.m.column("tolerance");
  const least = (row) => ((own ? own[row] : P.m.tolerance) || 0) / 2;
  let small = 0;
  for (let first = 0; first < count; first += step) {
    let best = -1;
    let most = 0;
    for (let point = first; point < Math.min(first + step, count); point++) {
      if (path.look[point * 4 + 1] !== P.scene.CUT) continue;
      const size = d[0][point] ** 2 + d[1][point] ** 2 + d[2][point] ** 2;
      if (size > most) {
        most = size;
        best = point;
      }
    }
    if (best >= 0 && Math.sqrt(most) < least(path.look[best * 4 + 2])) small += 1;
    else if (best >= 0) kept.push(best);
  }
  const foot = new Float32Array(kept.length * 3);
  const vector = new Float32Array(kept.length * 3);
  const row = new Float32Array(kept.length);
  kept.forEach((point, at) => {
    for (let axis = 0; axis < 3; axis++) {
      foot[at * 3 + axis] = path.pos[point * 3 + axis] - d[axis][point];
      vector[at * 3 + axis] = d[axis][point];
    }
    row[at] = path.look[point * 4 + 2];
  });
  return { count: kept.length, foot, vector, row, step, small };
};

// The vectors as drawn: from the foot to its vector times the scale.
P.scene.drawn_vectors = (budget) => {
  const { vectors } = P.scene;
  const { scale } = P.state;
  const step = Math.max(1, Math.ceil(vectors.count / budget));
  const count = Math.ceil(vectors.count / step);
  const pos = new Float32Array(count * 6);
  const look = new Float32Array(count * 4);
  for (let at = 0; at < count; at++) {
    for (let axis = 0; axis < 3; axis++) {
      pos[at * 6 + axis] = vectors.foot[at * step * 3 + axis];
      pos[at * 6 + 3 + axis] = pos[at * 6 + axis] + vectors.vector[at * step * 3 + axis] * scale;
    }
    look[at * 4] = -1;
    look[at * 4 + 1] = P.scene.hides(vectors.row[at * step]) ? P.scene.NONE : P.scene.CUT;
    look[at * 4 + 2] = vectors.row[at * step];
  }
  return { count, pos, look };
};

// Colours of the mode in use, for every point of the path.
P.scene.recolour = () => {
  const { path } = P.scene;
  const mode = P.colour.mode();
  for (let point = 0; point < path.count; point++) {
    path.look[point * 4] = P.colour.place(mode, mode.value(path.look[point * 4 + 2]));
  }
  P.scene.path_moving = P.scene.thin(path, P.scene.budget.path);
  if (P.scene.cl) P.scene.cl_moving = P.scene.thin(P.scene.cl, P.scene.budget.cl);
};

// The points of a block on the path: [first, last], with the one that it starts from.
P.scene.points_of = (row) => {
  const { count, look } = P.scene.path;
  const low = P.first(count, (point) => look[point * 4 + 2] >= row);
  let last = low;
  while (last + 1 < count && look[(last + 1) * 4 + 2] === row) last++;
  return [Math.max(low - 1, 0), Math.min(last, count - 1)];
};

// Rewinds, branch changes, tools and cycles, from the writer; arcs from the kind of block.
P.scene.find_marks = () => {
  const { meta, column, rows } = P.m;
  const marks = meta.events.filter((event) => event.row >= 0 && event.row < rows).map((event) => ({ ...event }));
  const kind = column("kind");
  for (let row = 0; kind && row < rows && marks.length < 20000; row++) {
    if (kind[row] === 4) marks.push({ row, kind: "arc", text: "arc", quiet: true });
  }
  for (const mark of marks) mark.point = P.scene.points_of(mark.row)[1];
  return marks.sort((one, other) => one.row - other.row);
};

// The block whose drawn segment is nearest to a pixel, no farther than `reach` pixels; -1 where none is.
P.scene.pick = (matrix, x, y, reach) => {
  const { count, pos, look } = P.scene.path;
  const { width, height } = P.camera;
  const [first, last] = P.state.brush || [0, Infinity];
  const m = matrix;
  let best = -1;
  let nearest = reach * reach;
  let front = Infinity;
  let px = 0;
  let py = 0;
  for (let point = 0; point < count; point++) {
    const at = point * 3;
    const a = pos[at];
    const b = pos[at + 1];
    const c = pos[at + 2];
    const qx = ((m[0] * a + m[4] * b + m[8] * c + m[12]) * 0.5 + 0.5) * width - x;
    const qy = (0.5 - (m[1] * a + m[5] * b + m[9] * c + m[13]) * 0.5) * height - y;
    const row = look[point * 4 + 2];
    if (look[point * 4 + 1] < P.scene.NONE && row >= first && row <= last) {
      const dx = qx - px;
      const dy = qy - py;
      const length = dx * dx + dy * dy;
      const t = length > 0 ? Math.min(Math.max(-(px * dx + py * dy) / length, 0), 1) : 1;
      const distance = (px + t * dx) ** 2 + (py + t * dy) ** 2;
      // Of those that are as near, the one in front.
      if (distance < nearest + 0.5) {
        const depth = m[2] * a + m[6] * b + m[10] * c + m[14];
        if (distance < nearest - 0.5 || depth < front) {
          front = depth;
          nearest = Math.min(distance, nearest);
          best = row;
        }
      }
    }
    px = qx;
    py = qy;
  }
  return best;
};
