// The camera: parallel projection, turned about a target, up along Z.

P.camera = { turn: -0.9, tilt: 0.55, target: [0, 0, 0], span: 100, width: 1, height: 1 };

// Right, up and towards the viewer.
P.camera.rows = () => {
  const { turn, tilt } = P.camera;
  const [st, ct, sp, cp] = [Math.sin(turn), Math.cos(turn), Math.sin(tilt), Math.cos(tilt)];
  return [[ct, st, 0], [-st * sp, ct * sp, cp], [st * cp, -ct * cp, sp]];
};

// From the scene (machine frame, mm) to clip space, column by column.
P.camera.clip = (depth) => {
  const { target, span, width, height } = P.camera;
  const [right, up, back] = P.camera.rows();
  const scale = [(1 / span) * (height / width), 1 / span, -1 / depth];
  const m = new Array(16).fill(0);
  [right, up, back].forEach((row, at) => {
    for (let column = 0; column < 3; column++) m[column * 4 + at] = row[column] * scale[at];
    m[12 + at] = -(row[0] * target[0] + row[1] * target[1] + row[2] * target[2]) * scale[at];
  });
  m[15] = 1;
  return m;
};

// Clip space to pixels of the view.
P.camera.pixel = (m, x, y, z) => [
  ((m[0] * x + m[4] * y + m[8] * z + m[12]) * 0.5 + 0.5) * P.camera.width,
  (0.5 - (m[1] * x + m[5] * y + m[9] * z + m[13]) * 0.5) * P.camera.height,
];

P.camera.per_mm = () => P.camera.height / 2 / P.camera.span;

P.camera.orbit = (dx, dy) => {
  P.camera.turn -= dx;
  P.camera.tilt = P.clamp(P.camera.tilt + dy, -Math.PI / 2, Math.PI / 2);
};

P.camera.pan = (dx, dy) => {
  const [right, up] = P.camera.rows();
  const mm = 1 / P.camera.per_mm();
  P.camera.target = P.camera.target.map((value, at) => value - right[at] * dx * mm + up[at] * dy * mm);
};

// Nearer or farther, the point under the pointer stays.
P.camera.zoom = (factor, x, y) => {
  const { width, height } = P.camera;
  const [dx, dy] = [(x ?? width / 2) - width / 2, (y ?? height / 2) - height / 2];
  P.camera.pan(-dx, -dy);
  P.camera.span = P.clamp(P.camera.span * factor, 1e-4, 1e6);
  P.camera.pan(dx, dy);
};

P.camera.looks = [["Slanting", -0.6, 0.5], ["From above", 0, Math.PI / 2], ["From the front", 0, 0], ["From the right", Math.PI / 2, 0]];
P.camera.look = (index) => {
  const [, turn, tilt] = P.camera.looks[index];
  Object.assign(P.camera, { turn, tilt, looked: index });
};

// Fits points of the scene into the view with a margin, above so many pixels.
P.camera.fit = (points, below = 0) => {
  const rows = P.camera.rows();
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    rows.forEach((row, at) => {
      const value = row[0] * point[0] + row[1] * point[1] + row[2] * point[2];
      low[at] = Math.min(low[at], value);
      high[at] = Math.max(high[at], value);
    });
  }
  if (!Number.isFinite(low[0])) return;
  const middle = low.map((value, at) => (value + high[at]) / 2);
  P.camera.target = [0, 1, 2].map((column) => rows[0][column] * middle[0] + rows[1][column] * middle[1] + rows[2][column] * middle[2]);
  const { width, height } = P.camera;
  const half = Math.max(((high[1] - low[1]) / 2) * (height / (height - below)), ((high[0] - low[0]) / 2) * (height / width));
  P.camera.span = Math.max(half * 1.16, 1e-3);
  P.camera.pan(0, -below / 2);
};
