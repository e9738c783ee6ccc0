// Measuring between two points of the path, in the part frame.

P.measure = { points: [] };

P.measure.build = () => {
  P.measure.told = P.el("p", { class: "measured mono", role: "status", hidden: true });
  P.listen("measuring", () => {
    P.measure.points = [];
    P.measure.tell();
  });
  return P.measure.told;
};

// Takes the end of a block that is drawn nearest to a pixel: the first point, the second, and again the first.
P.measure.take = (x, y) => {
  const { path, NONE } = P.scene;
  const { matrix } = P.path.matrices();
  let best = -1;
  let nearest = 12;
  for (let point = 0; point < path.count; point++) {
    if (path.look[point * 4 + 1] >= NONE && !(point + 1 < path.count && path.look[point * 4 + 5] < NONE)) continue;
    const [px, py] = P.camera.pixel(matrix, ...path.pos.subarray(point * 3, point * 3 + 3));
    const apart = Math.hypot(px - x, py - y);
    if (apart < nearest) {
      nearest = apart;
      best = point;
    }
  }
  if (best >= 0) P.measure.add(best);
};

P.measure.add = (point) => {
  const { path, centre } = P.scene;
  const at = [0, 1, 2].map((axis) => path.pos[point * 3 + axis] + centre[axis]);
  const kept = P.measure.points.length > 1 ? [] : P.measure.points;
  P.measure.points = [...kept, { at, row: path.look[point * 4 + 2] }];
  P.measure.tell();
};

// The end of the selected block, without a mouse.
P.measure.here = () => {
  if (!P.scene.ready || !P.path.renderer) return;
  if (!P.state.measuring) P.set({ measuring: true });
  P.measure.add(P.scene.points_of(P.state.row)[1]);
};

P.measure.way = () => P.measure.points[1].at.map((value, at) => value - P.measure.points[0].at[at]);

P.measure.tell = () => {
  const { points, told } = P.measure;
  const place = ({ at, row }) => `${["X", "Y", "Z"].map((name, axis) => `${name} ${P.shown(at[axis], "mm", P.POSITION)}`).join(" ")}, block ${row + 1}`;
  const lines = ["Click at a point of the path, or R: the end of the selected block.", points[0] && `from ${place(points[0])}`, points[1] && `to ${place(points[1])}`];
  if (points[1]) {
    const way = P.measure.way();
    const far = Math.hypot(...way);
    lines.push(`${P.position(far, "mm")}: ${["ΔX", "ΔY", "ΔZ"].map((name, axis) => `${name} ${P.shown(way[axis], "mm", P.POSITION)}`).join(" ")}`);
  }
  told.hidden = !P.state.measuring;
  told.replaceChildren(...lines.slice(points.length ? 1 : 0).filter(Boolean).map((line) => P.el("span", {}, line)));
  P.path.redraw();
};

P.measure.draw = (paint, matrix) => {
  const { points } = P.measure;
  const { scene, colour, camera } = P;
  const ends = points.map(({ at }) => camera.pixel(matrix, ...at.map((value, axis) => value - scene.centre[axis])));
  if (ends.length > 1) {
    P.stroke(paint, colour.scene.css, 5, ends.flat());
    P.stroke(paint, colour.accent.css, 2, ends.flat(), [7, 4]);
    P.over.text(paint, P.position(Math.hypot(...P.measure.way()), "mm"), (ends[0][0] + ends[1][0]) / 2, (ends[0][1] + ends[1][1]) / 2 - 12, colour.accent.css);
  }
  paint.fillStyle = colour.scene.css;
  for (const end of ends) P.over.ring(paint, ...end, 4, colour.accent.css, 2);
};
