// The scene on a plain canvas, where WebGL2 is not to be had: the reduced detail of a moving frame, the machine as edges.

P.plain = {};

P.plain.start = (canvas) => {
  const paint = canvas.getContext("2d");
  if (!paint) return null;
  const lines = {};
  const stats = { draws: 0, vertices: 0 };
  // Strokes are gathered by colour: as few as there are colours in sight.
  const stroke = (line, matrix, width, plain, pairs) => {
    const { colour, scene, state } = P;
    const { pixel } = P.camera;
    const groups = new Map();
    const [first, last] = state.brush || [-1, Infinity];
    for (let at = pairs ? 0 : 1; at < line.count; at++) {
      const look = at * 4;
      const flag = line.look[look + 1];
      if (flag === scene.NONE) continue;
      const place = line.look[look];
      const outside = line.look[look + 2] < first || line.look[look + 2] > last;
      const css = flag === scene.RAPID ? colour.rapid.css : place < 0 ? plain : colour.css(Math.floor(place / 6) * 6);
      const key = `${flag} ${outside ? 0.2 : 1} ${place > colour.top ? 1.7 : 1} ${css}`;
      if (!groups.has(key)) groups.set(key, { path: new Path2D(), flag, outside, css, wide: place > colour.top });
      const { path } = groups.get(key);
      const from = pairs ? at * 6 : at * 3 - 3;
      path.moveTo(...pixel(matrix, line.pos[from], line.pos[from + 1], line.pos[from + 2]));
      path.lineTo(...pixel(matrix, line.pos[from + 3], line.pos[from + 4], line.pos[from + 5]));
    }
    for (const { path, flag, outside, css, wide } of groups.values()) {
      paint.strokeStyle = css;
      paint.globalAlpha = outside ? 0.16 : 1;
      paint.lineWidth = wide ? width * 1.7 : width;
      paint.setLineDash(flag === scene.RAPID ? [6, 5] : []);
      paint.stroke(path);
      stats.draws += 1;
    }
    stats.vertices += line.count * 2;
    paint.globalAlpha = 1;
    paint.setLineDash([]);
  };
  const edges = (values, bodies, clip, css, alpha) => {
    const path = new Path2D();
    for (let at = 0; at < values.length; at += 4) path[at % 8 ? "lineTo" : "moveTo"](...P.camera.pixel(clip, ...P.chain.apply(bodies[values[at + 3]], values.subarray(at, at + 3))));
    paint.globalAlpha = alpha;
    paint.strokeStyle = css;
    paint.lineWidth = 1;
    paint.stroke(path);
    paint.globalAlpha = 1;
    stats.draws += 1;
    stats.vertices += values.length / 4;
  };
  const draw = ({ clip, matrix, bodies }) => {
    const { scene, colour, camera } = P;
    stats.draws = stats.vertices = 0;
    paint.setTransform(camera.dense, 0, 0, camera.dense, 0, 0);
    paint.fillStyle = colour.scene.css;
    paint.fillRect(0, 0, camera.width, camera.height);
    if (bodies) {
      edges(P.parts.made.boxes, bodies, clip, colour.strong.css, 0.6);
      edges(P.parts.made.edges, bodies, clip, colour.edge.css, 0.4);
    }
    if (scene.cl) stroke(scene.cl_moving, matrix, 1, colour.cl.css);
    stroke(scene.path_moving, matrix, 1.8, colour.quiet.css);
    if (lines.vectors_moving) stroke(lines.vectors_moving, matrix, 1, colour.mark.css, true);
    if (lines.chosen) stroke(lines.chosen, matrix, 4, colour.select.css);
    return stats;
  };
  return { kind: "Canvas2D", upload: (name, line) => (lines[name] = line), ramp: () => {}, mesh: () => {}, draw, stats, lost: () => false };
};
