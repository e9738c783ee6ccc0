// What is written over the scene: marks, the tip, names of axes, directions and a scale.

P.over = {};

// Marks differ in shape, so that no colour is needed to tell them apart: corners around a middle, in parts of their size.
P.over.shapes = {
  tool: [-1, -1, 1, -1, 1, 1, -1, 1, -1, -1],
  rewind: [0, -1.3, 1.2, 0, 0, 1.3, -1.2, 0, 0, -1.3],
  branch: [0, -1.3, 1.2, 1, -1.2, 1, 0, -1.3],
  operation: [0, 0, 0, -3, 2, -2.2, 0, -1.5],
  stop: [-1, -1, 1, 1, 0, 0, 1, -1, -1, 1],
};

P.over.mark = (paint, { kind, quiet }, x, y) => {
  const { colour } = P;
  const size = quiet ? 2.5 : 4.5;
  const corners = P.over.shapes[kind];
  paint.fillStyle = quiet ? colour.scene.css : colour.mark.css;
  const css = quiet ? colour.strong.css : kind === "stop" ? colour.mark.css : colour.scene.css;
  if (!corners) return P.over.ring(paint, x, y, size, css, 1.5);
  P.stroke(paint, css, 1.5, corners.map((value, at) => (at % 2 ? y : x) + value * size));
  return kind === "stop" || paint.fill();
};

P.over.ring = (paint, x, y, size, css, wide) => {
  paint.beginPath();
  paint.arc(x, y, size, 0, 7);
  paint.fill();
  paint.strokeStyle = css;
  paint.lineWidth = wide;
  paint.stroke();
};

P.over.draw = ({ clip, matrix, bodies }) => {
  const { scene, camera, colour, state } = P;
  const { width, height } = camera;
  const paint = P.paint(P.path.over, camera);
  const [first, last] = state.brush || [0, Infinity];
  const marks = scene.marks.filter((mark) => mark.row >= first && mark.row <= last && !scene.hides(mark.row));
  // Where many would cover the path, the quiet ones step back.
  const most = scene.budget.marks;
  const shown = marks.length > most ? marks.filter((mark) => !mark.quiet).slice(0, most) : marks;
  for (const mark of shown) {
    const [x, y] = camera.pixel(matrix, ...scene.path.pos.subarray(mark.point * 3, mark.point * 3 + 3));
    if (x > -9 && y > -9 && x < width + 9 && y < height + 9) P.over.mark(paint, mark, x, y);
  }
  P.over.tip(paint, matrix);
  P.measure.draw(paint, matrix);
  if (bodies && state.machine) {
    const placed = [];
    for (const { body, at, text } of P.parts.made.labels) {
      const [x, y] = camera.pixel(clip, ...P.chain.apply(bodies[body], at));
      if (placed.some(([px, py]) => Math.abs(px - x) < 15 && Math.abs(py - y) < 15)) continue;
      placed.push([x, y]);
      P.over.text(paint, text, x, y, colour.text.css);
    }
  }
  P.over.directions(paint);
};

// Text with a rim of the ground, so that it is read over lines.
P.over.text = (paint, text, x, y, css) => {
  paint.font = P.BOLD;
  paint.textAlign = "center";
  paint.textBaseline = "middle";
  paint.lineWidth = 4;
  paint.strokeStyle = P.colour.scene.css;
  paint.strokeText(text, x, y);
  P.write(paint, text, x, y, css);
};

// Where the tip stands, part frame, mm, and the tool axis.
P.over.tip_at = () => {
  const { state, scene, m } = P;
  const machine = P.chain.at(state.row);
  if (machine && m.axes.length) return P.chain.forward(machine, P.chain.values(state.row, state.share), P.chain.length(state.row));
  const point = scene.points_of(state.row)[1] * 3;
  return { tip: [0, 1, 2].map((at) => scene.path.pos[point + at] + scene.centre[at]), axis: null };
};

P.over.tip = (paint, matrix) => {
  const { camera, colour, scene } = P;
  const { tip, axis } = P.over.tip_at();
  const from = tip.map((value, at) => value - scene.centre[at]);
  const at = camera.pixel(matrix, ...from);
  if (axis) {
    const long = 46 / camera.per_mm();
    const end = camera.pixel(matrix, ...from.map((value, place) => value + axis[place] * long));
    P.stroke(paint, colour.scene.css, 5, [...at, ...end]);
    P.stroke(paint, colour.select.css, 2, [...at, ...end]);
  }
  paint.fillStyle = colour.scene.css;
  P.over.ring(paint, ...at, 5, colour.select.css, 2.5);
};

// The directions of the frame that stands still, and a length to measure by.
P.over.directions = (paint) => {
  const { camera, colour } = P;
  const [right, up] = camera.rows();
  const [x, y] = [38, camera.height - 44];
  ["X", "Y", "Z"].forEach((name, at) => {
    const [dx, dy] = [right[at] * 24, -up[at] * 24];
    if (Math.hypot(dx, dy) < 3) return;
    P.stroke(paint, colour.quiet.css, 2, [x, y, x + dx, y + dy]);
    P.over.text(paint, name, x + dx * 1.36, y + dy * 1.36, colour.text.css);
  });
  const wanted = 110 / camera.per_mm();
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((by) => by * power).find((by) => by <= wanted) || power;
  const pixels = length * camera.per_mm();
  const [left, low] = [84, camera.height - 20];
  P.stroke(paint, colour.quiet.css, 1.5, [left, low - 4, left, low, left + pixels, low, left + pixels, low - 4]);
  P.over.text(paint, length < 0.01 ? `${P.short(length * 1000)} µm` : `${P.short(length)} mm`, left + pixels / 2, low - 10, colour.quiet.css);
};
