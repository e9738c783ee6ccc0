// The view of the path and the machine: canvas, what is written over it, and its tools.

P.path = { drawn: { draws: 0, vertices: 0 } };

P.path.build = (view) => {
  const { scene, m } = P;
  const { machine } = m.meta;
  const { el } = P;
  const toggle = (text, title, name, on, off) => {
    const button = P.button(text, title, () => P.set({ [name]: P.state[name] === on ? off : on }));
    const tell = () => button.setAttribute("aria-pressed", P.state[name] === on);
    P.listen(name, tell);
    tell();
    return button;
  };
  const colours = P.choose("Colour (c)", P.colour.modes.map((mode) => mode.title), P.state.colour, (at) => P.set({ colour: at }));
  const { scales } = P.keys;
  if (scene.vectors) P.set({ scale: P.path.fitting_scale() });
  const vectors = P.choose("Deviation vectors (d, D)", scales.map((by) => (by ? `Vectors × ${by.toLocaleString("en")}` : "No vectors")), scales.indexOf(P.state.scale), (at) => P.set({ scale: scales[at] }));
  const looks = P.choose("Look (v)", P.camera.looks.map(([name]) => name), 0, (at) => P.path.look(at));
  const bar = el("div", { class: "bar" }, el("h2", { id: "path-title" }, "Path"), colours, scene.vectors ? vectors : null, looks, P.button("Fit", "Fit the view (0)", P.path.fit));
  P.path.canvas = el("canvas", { tabindex: "0", role: "img", "aria-label": "Tool path in three dimensions; the selected block is told at the foot of the page" });
  P.path.over = el("canvas", { class: "over", "aria-hidden": "true" });
  P.path.legend = el("div", { class: "legend" });
  P.path.notice = el("p", { class: "notice", role: "status", hidden: true });
  P.path.stage = el("div", { class: "stage" }, P.path.canvas, P.path.over, P.path.legend, P.path.notice, P.measure.build());
  view.append(bar, P.path.stage);
  if (!scene.ready) {
    P.path.say("This report holds no path.");
    return;
  }
  bar.append(toggle("Measure", "Measure between two points of the path (r)", "measuring", true, false));
  if (machine) bar.append(toggle("Machine", "Show the machine (m)", "machine", true, false), toggle("Bed", "Machine frame: the bed stands still, the part moves (f)", "frame", "machine", "part"));
  if (machine) P.parts.build(P.chain.at(P.state.row));
  P.path.start();
  view.append(P.play.build());
  P.path.handle();
  P.listen("row", P.path.choose);
  P.listen("row share brush", () => P.path.redraw(P.state.playing));
  P.listen("frame machine", P.path.fit);
  P.listen("machine", P.path.tell);
  P.listen("hidden", () => {
    scene.hide();
    P.path.repaint();
    for (const name of ["cl", "cl_moving"]) if (scene[name] && P.path.renderer) P.path.renderer.upload(name, scene[name]);
    P.path.comb();
  });
  P.listen("scale", () => {
    vectors.value = scales.indexOf(P.state.scale);
    P.path.comb();
    P.path.tell();
    P.path.redraw();
  });
  P.listen("colour", () => {
    colours.value = P.state.colour;
    P.path.repaint();
  });
  P.path.looks = looks;
  P.surface(P.path.stage, [P.path.canvas, P.path.over], P.path.resize);
};

P.path.say = (text) => {
  P.path.notice.textContent = text;
  P.path.notice.hidden = !text;
};

// A power of ten by which the largest vector is well seen; none where so many would hide the path.
P.path.fitting_scale = () => {
  const { vectors, radius } = P.scene;
  if (vectors.count > 20000) return 0;
  let most = 0;
  for (let at = 0; at < vectors.count; at++) most = Math.max(most, Math.hypot(...vectors.vector.subarray(at * 3, at * 3 + 3)));
  return most > 0 ? P.clamp(10 ** Math.floor(Math.log10((radius * 0.12) / most)), 1, 10000) : 1000;
};

// The best renderer that is to be had.
P.path.start = () => {
  let renderer = P.webgl.start(P.path.canvas, P.path.load);
  if (!renderer) {
    renderer = P.plain.start(P.path.canvas);
    if (renderer) P.path.say("WebGL2 is not to be had here: the path is drawn in reduced detail.");
  }
  P.path.renderer = renderer;
  if (!renderer) {
    P.path.say("Nothing can be drawn here: the numbers are in the table (7).");
    P.by("views").dataset.lower = "table";
  } else P.path.load();
};

// Everything into the renderer, at the start and when a lost context has come back.
P.path.load = () => {
  const { renderer } = P.path;
  const { scene } = P;
  if (!renderer) return;
  renderer.ramp();
  for (const name of ["path", "path_moving", "cl", "cl_moving"]) if (scene[name]) renderer.upload(name, scene[name]);
  if (P.parts.made) renderer.mesh();
  P.path.comb();
  P.path.choose();
  P.path.tell();
  P.path.redraw();
};

P.path.comb = () => {
  const { renderer } = P.path;
  if (!P.scene.vectors || !renderer) return;
  renderer.upload("vectors", P.scene.drawn_vectors(Infinity), true);
  renderer.upload("vectors_moving", P.scene.drawn_vectors(P.scene.budget.vectors), true);
};

// Colours anew, after the mode or the theme has changed.
P.path.repaint = () => {
  P.colour.refresh();
  if (!P.scene.ready || !P.path.renderer) return;
  P.scene.recolour();
  P.path.renderer.ramp();
  for (const name of ["path", "path_moving"]) P.path.renderer.upload(name, P.scene[name]);
  P.path.tell();
  P.path.redraw();
};

// The selected block as a line of its own.
P.path.choose = () => {
  const { scene, state } = P;
  if (!P.path.renderer) return;
  const [first, last] = scene.points_of(state.row);
  const look = new Float32Array((last - first + 1) * 4);
  for (let at = 0; at <= last - first; at++) look.set([-1, at === 0 ? scene.NONE : scene.CUT, state.row, 0], at * 4);
  P.path.renderer.upload("chosen", { count: last - first + 1, pos: scene.path.pos.slice(first * 3, last * 3 + 3), look });
};

P.path.resize = (size) => {
  if (!P.path.renderer) return;
  Object.assign(P.camera, size);
  if (!P.path.sized) {
    P.path.sized = true;
    P.path.look(0);
  }
  P.path.draw(false);
};

P.path.look = (at) => {
  P.camera.look(at);
  P.path.looks.value = at;
  P.path.fit();
};

P.path.fit = () => {
  if (!P.path.renderer) return;
  const { cuts } = P.scene;
  const bodies = P.path.bodies();
  const carry = P.path.carry(bodies);
  const points = [];
  for (let bits = 0; bits < 8; bits++) points.push(P.chain.apply(carry, [0, 1, 2].map((at) => cuts[(bits >> at) & 1][at])));
  if (bodies && P.state.machine) points.push(...P.parts.points(bodies));
  // What is told lies over the lowest part: it stays free.
  P.camera.fit(points, Math.min(P.path.legend.offsetHeight + 14, P.camera.height / 3));
  P.path.redraw();
};

// The bodies of the machine at the place that is selected; null where no machine is known.
P.path.bodies = () => {
  const machine = P.chain.at(P.state.row);
  if (!machine) return null;
  return P.chain.bodies(machine, P.chain.values(P.state.row, P.state.share), P.state.frame);
};

// From the middle of the path to the scene.
P.path.carry = (bodies) => {
  const machine = P.chain.at(P.state.row);
  const shift = P.chain.still();
  const mount = machine ? P.chain.mount(machine) : [0, 0, 0];
  for (let at = 0; at < 3; at++) shift[12 + at] = mount[at] + P.scene.centre[at];
  return bodies ? P.chain.times(bodies[0], shift) : shift;
};

P.path.matrices = () => {
  const bodies = P.path.bodies();
  const size = P.parts.made ? P.parts.made.deep : 0;
  const clip = P.camera.clip(Math.max(P.scene.radius * 40, size, P.camera.span * 20));
  return { bodies, clip, matrix: P.chain.times(clip, P.path.carry(bodies)) };
};

// Draws at the next frame: reduced while something moves, whole when it has rested.
P.path.redraw = (moving) => {
  if (!P.path.renderer || !P.path.sized) return;
  clearTimeout(P.path.rest);
  P.path.moving = Boolean(moving);
  if (moving) P.path.rest = setTimeout(() => P.path.redraw(), 160);
  if (P.path.waiting) return;
  P.path.waiting = requestAnimationFrame(() => P.path.draw(P.path.moving));
};

P.path.draw = (moving) => {
  cancelAnimationFrame(P.path.waiting);
  P.path.waiting = null;
  const machine = P.chain.at(P.state.row);
  const { made } = P.parts;
  // Another head or tool than is drawn.
  if (machine && (made.machine !== machine || made.cutter !== P.chain.cutter(P.state.row) || made.outline !== P.chain.outline(P.state.row) || made.length !== Math.max(P.chain.length(P.state.row) || 0, 0))) {
    P.parts.build(machine);
    P.path.renderer.mesh();
    P.path.tell();
  }
  const given = P.path.matrices();
  const shown = P.state.machine ? given.bodies : null;
  P.path.drawn = { ...P.path.renderer.draw({ ...given, bodies: shown, moving }), moving: Boolean(moving) };
  P.over.draw(given);
};

// Mouse and touch: turn, shift, nearer, and a click selects.
P.path.handle = () => {
  const { canvas } = P.path;
  const held = new Map();
  let start = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.offsetX, event.offsetY]);
    start = { x: event.offsetX, y: event.offsetY, moved: false, shift: event.button !== 0 || event.shiftKey };
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before || !start) return;
    const [dx, dy] = [event.offsetX - before[0], event.offsetY - before[1]];
    if (Math.hypot(event.offsetX - start.x, event.offsetY - start.y) > 4) start.moved = true;
    if (!start.moved) return;
    if (held.size === 2) {
      const [other] = [...held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const apart = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1;
      P.camera.zoom(apart(before) / apart([event.offsetX, event.offsetY]), (other[0] + event.offsetX) / 2, (other[1] + event.offsetY) / 2);
      P.camera.pan(dx / 2, dy / 2);
    } else if (start.shift) P.camera.pan(dx, dy);
    else P.camera.orbit(dx * 0.008, dy * 0.008);
    held.set(event.pointerId, [event.offsetX, event.offsetY]);
    P.path.redraw(true);
  });
  const release = (event) => {
    held.delete(event.pointerId);
    if (start && !start.moved && event.type === "pointerup" && event.button === 0) P.path.click(event.offsetX, event.offsetY);
    if (!held.size) start = null;
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    P.camera.zoom(Math.exp(P.clamp(event.deltaY, -240, 240) * 0.0015), event.offsetX, event.offsetY);
    P.path.redraw(true);
  }, { passive: false });
};

P.path.click = (x, y) => {
  if (P.state.measuring) return P.measure.take(x, y);
  const row = P.scene.pick(P.path.matrices().matrix, x, y, 8);
  return row >= 0 && P.select(row);
};

// Says what the colours mean.
P.path.tell = () => {
  const { el, colour, scene, state, m } = P;
  const mode = colour.mode();
  const strip = (width, place) => {
    const canvas = el("canvas", { width, height: 10 });
    const paint = canvas.getContext("2d");
    for (let at = 0; at < width; at++) {
      paint.fillStyle = colour.css(place(at / width));
      paint.fillRect(at, 0, 1, 10);
    }
    return canvas;
  };
  const has = (test, count) => {
    for (let at = 0; at < count; at++) if (test(at)) return true;
    return false;
  };
  const told = [el("b", {}, mode.title)];
  if (mode.kinds) {
    const seen = mode.kinds.map((name, kind) => (has((row) => mode.value(row) === kind, m.rows) ? el("span", {}, strip(12, () => colour.place(mode, kind)), name) : null));
    told.push(el("div", { class: "kinds" }, seen));
  } else if (mode.unit) {
    const limit = mode.fixed || (mode.id === "axis_deviation" ? m.turn : m.tolerance);
    const far = mode.near && [P.quantity(mode.near, mode.unit), "nearer"];
    const ends = far || (mode.top === null ? [`tolerance ${limit ? P.short(limit) + " " + P.unit(mode.unit) : ""}`, "above"] : [P.quantity(mode.top, mode.unit)]);
    // The tolerance stands in the middle, where the colours change.
    const by = mode.top ? 1 : 2;
    told.push(strip(170, (share) => ((share *= by) > 1 ? colour.over : share * colour.top)), el("div", { class: "ends" }, [far ? "far" : "0", ...ends].map((text) => el("span", {}, text))));
  }
  const { vectors, path } = scene;
  const notes = [];
  if (scene.cl) notes.push(m.meta.names.nc2 ? "thin: old program" : "thin: CL path");
  if (has((point) => path.look[point * 4 + 1] === scene.RAPID, path.count)) notes.push("dashed: rapid");
  if (vectors && state.scale) notes.push(`vectors × ${state.scale.toLocaleString("en")}${vectors.step > 1 ? `, the largest of every ${vectors.step} points` : ""}${vectors.small ? (vectors.count ? ", none below half of the tolerance" : ": all are below half of the tolerance") : ""}`);
  if (state.machine && m.report.tables.left) notes.push("what is left: red where it is cut into the part, blue where it is thicker");
  if (state.machine && P.parts.made) {
    const { cutter, outline, length } = P.parts.made;
    const corner = cutter && cutter.corner_radius ? `, corner ${P.shown(cutter.corner_radius, "mm", P.POSITION)}` : "";
    notes.push(outline ? `tool: as the machine file has it, ${P.position(length, "mm")} long` : cutter ? `tool: ⌀ ${P.shown(cutter.diameter, "mm", P.POSITION)}${corner}, ${P.position(length, "mm")} long` : "tool: diameter not known");
  }
  P.path.legend.replaceChildren(...told, el("div", { class: "quiet" }, notes.join(" · ")));
};
