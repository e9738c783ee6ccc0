// What is written over the scene: marks, the tip, names of axes, directions and a scale.

P.over = {};

// Marks differ in shape, so that no colour is needed to tell them apart.
P.over.shapes = { tool: "square", operation: "flag", rewind: "diamond", branch: "triangle", cycle: "circle", stop: "cross", arc: "ring", rapid: "ring" };

P.over.shape = (paint, kind, x, y, r) => {
  const shape = P.over.shapes[kind] || "circle";
  paint.beginPath();
  if (shape === "square") paint.rect(x - r, y - r, 2 * r, 2 * r);
  else if (shape === "diamond" || shape === "triangle") {
    paint.moveTo(x, y - r * 1.3);
    paint.lineTo(x + r * 1.2, shape === "diamond" ? y : y + r);
    if (shape === "diamond") paint.lineTo(x, y + r * 1.3);
    paint.lineTo(x - r * 1.2, shape === "diamond" ? y : y + r);
    paint.closePath();
  } else if (shape === "cross") {
    paint.moveTo(x - r, y - r);
    paint.lineTo(x + r, y + r);
    paint.moveTo(x + r, y - r);
    paint.lineTo(x - r, y + r);
  } else if (shape === "flag") {
    paint.moveTo(x, y);
    paint.lineTo(x, y - 3 * r);
    paint.lineTo(x + 2 * r, y - 2.2 * r);
    paint.lineTo(x, y - 1.5 * r);
  } else paint.arc(x, y, r, 0, 7);
};

P.over.draw = ({ clip, matrix, bodies }) => {
  const { scene, camera, colour, state } = P;
  const paint = P.path.over.getContext("2d");
  const { width, height, dense } = camera;
  paint.setTransform(dense, 0, 0, dense, 0, 0);
  paint.clearRect(0, 0, width, height);
  paint.font = "11px system-ui, sans-serif";
  paint.lineWidth = 1.5;
  const at_point = (point) => camera.pixel(matrix, scene.path.pos[point * 3], scene.path.pos[point * 3 + 1], scene.path.pos[point * 3 + 2]);
  const [first, last] = state.brush || [0, Infinity];
  // Where many would cover the path, the quiet ones step back.
  const loud = scene.marks.filter((mark) => mark.row >= first && mark.row <= last);
  const shown = loud.length > scene.budget.marks ? loud.filter((mark) => !mark.quiet).slice(0, scene.budget.marks) : loud;
  for (const mark of shown) {
    const [x, y] = at_point(mark.point);
    if (x < -9 || y < -9 || x > width + 9 || y > height + 9) continue;
    P.over.shape(paint, mark.kind, x, y, mark.quiet ? 2.5 : 4.5);
    paint.fillStyle = mark.quiet ? colour.scene.css : colour.mark.css;
    paint.strokeStyle = mark.quiet ? colour.strong.css : colour.scene.css;
    if (mark.kind === "stop") paint.strokeStyle = colour.mark.css;
    else paint.fill();
    paint.stroke();
  }
  P.over.tip(paint, matrix);
  if (bodies && state.machine) {
    const placed = [];
    for (const { body, at, text } of P.parts.made.labels) {
      const [x, y] = camera.pixel(clip, ...P.chain.apply(bodies[body], at));
      if (placed.some(([px, py]) => Math.abs(px - x) < 15 && Math.abs(py - y) < 15)) continue;
      placed.push([x, y]);
      P.over.text(paint, text, x, y, colour.text.css, "bold 12px system-ui, sans-serif");
    }
  }
  P.over.directions(paint, bodies);
};

// Text with a rim of the ground, so that it is read over lines.
P.over.text = (paint, text, x, y, css, font) => {
  if (font) paint.font = font;
  paint.textAlign = "center";
  paint.textBaseline = "middle";
  paint.lineWidth = 4;
  paint.lineJoin = "round";
  paint.strokeStyle = P.colour.scene.css;
  paint.strokeText(text, x, y);
  paint.fillStyle = css;
  paint.fillText(text, x, y);
};

// Where the tip stands, part frame, mm.
P.over.tip_at = () => {
  const { state, scene, m } = P;
  const { machine } = m.meta;
  const { tip, axis } = machine && m.axes.length ? P.chain.forward(machine, P.chain.values(state.row, state.share), P.chain.length(state.row)) : {};
  if (tip) return { tip, axis };
  const point = scene.points_of(state.row)[1] * 3;
  return { tip: [0, 1, 2].map((at) => scene.path.pos[point + at] + scene.centre[at]), axis: null };
};

P.over.tip = (paint, matrix) => {
  const { camera, colour, scene } = P;
  const { tip, axis } = P.over.tip_at();
  const from = tip.map((value, at) => value - scene.centre[at]);
  const [x, y] = camera.pixel(matrix, ...from);
  if (axis) {
    const long = 46 / camera.per_mm();
    const [ex, ey] = camera.pixel(matrix, ...from.map((value, at) => value + axis[at] * long));
    for (const [css, wide] of [[colour.scene.css, 5], [colour.select.css, 2]]) {
      paint.strokeStyle = css;
      paint.lineWidth = wide;
      paint.beginPath();
      paint.moveTo(x, y);
      paint.lineTo(ex, ey);
      paint.stroke();
    }
  }
  paint.beginPath();
  paint.arc(x, y, 5, 0, 7);
  paint.fillStyle = colour.scene.css;
  paint.fill();
  paint.strokeStyle = colour.select.css;
  paint.lineWidth = 2.5;
  paint.stroke();
};

// The directions of the frame that stands still, and a length to measure by.
P.over.directions = (paint) => {
  const { camera, colour } = P;
  const rows = camera.rows();
  const [x, y] = [38, camera.height - 44];
  paint.lineWidth = 2;
  ["X", "Y", "Z"].forEach((name, at) => {
    const [dx, dy] = [rows[0][at] * 24, -rows[1][at] * 24];
    if (Math.hypot(dx, dy) < 3) return;
    paint.lineWidth = 2;
    paint.strokeStyle = colour.quiet.css;
    paint.beginPath();
    paint.moveTo(x, y);
    paint.lineTo(x + dx, y + dy);
    paint.stroke();
    P.over.text(paint, name, x + dx * 1.36, y + dy * 1.36, colour.text.css, "bold 11px system-ui, sans-serif");
  });
  const wanted = 110 / camera.per_mm();
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((by) => by * power).find((by) => by <= wanted) || power;
  const pixels = length * camera.per_mm();
  const [left, low] = [84, camera.height - 20];
  paint.strokeStyle = colour.quiet.css;
  paint.lineWidth = 1.5;
  paint.beginPath();
  paint.moveTo(left, low - 4);
  paint.lineTo(left, low);
  paint.lineTo(left + pixels, low);
  paint.lineTo(left + pixels, low - 4);
  paint.stroke();
  P.over.text(paint, length < 0.01 ? `${P.short(length * 1000)} µm` : `${P.short(length)} mm`, left + pixels / 2, low - 10, colour.quiet.css, "11px system-ui, sans-serif");
};
