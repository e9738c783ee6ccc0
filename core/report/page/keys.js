// The keys, in one list that the help is made from.

P.keys = {};

// The next place worth looking at, in the order of the program.
P.keys.event = (step) => {
  const { row } = P.state;
  const { marks } = P.scene;
  const found = step > 0 ? marks.find((mark) => mark.row > row) : marks.findLast((mark) => mark.row < row);
  if (found) P.select(found.row);
};

P.keys.brush = (end) => {
  const { row, brush } = P.state;
  const [first, last] = brush || [0, P.m.rows - 1];
  P.set({ brush: end ? [Math.min(first, row), row] : [row, Math.max(last, row)] });
};

P.keys.turn_on = (name, values) => P.set({ [name]: values[(values.indexOf(P.state[name]) + 1) % values.length] });
P.keys.by = () => P.m.timed && P.keys.turn_on("by", ["time", "block"]);
P.keys.scales = [0, 1, 10, 100, 1000, 10000];
P.keys.scale = (step) => {
  const { scales } = P.keys;
  P.set({ scale: scales[P.clamp(scales.indexOf(P.state.scale) + step, 0, scales.length - 1)] });
};
P.keys.camera = (run) => {
  run();
  P.path.redraw(true);
};
P.keys.pane = () => {
  const { panes } = P.texts;
  const inside = Object.values(panes).find(({ box }) => box.closest(".view").contains(document.activeElement));
  return inside || panes.nc || panes.cl || Object.values(panes)[0];
};
P.keys.into = (name) => {
  const pane = P.keys.pane();
  if (!pane) return;
  const solo = P.by("views").dataset.solo;
  const own = pane.box.closest(".view").id;
  if (solo && solo !== own) P.views.show(own);
  pane[name].focus();
  pane[name].select();
};

P.keys.list = [
  { keys: ["ArrowLeft", "ArrowRight"], text: "block before, block after", run: (key) => P.select(P.state.row + (key === "ArrowLeft" ? -1 : 1)) },
  { keys: ["Shift+ArrowLeft", "Shift+ArrowRight"], text: "a hundred blocks", run: (key) => P.select(P.state.row + (key.endsWith("Left") ? -100 : 100)) },
  { keys: ["Home", "End"], text: "first block, last block", run: (key) => P.select(key === "Home" ? 0 : P.m.rows - 1) },
  { keys: ["w", "W"], text: "next worse block, next better", run: (key) => P.next_by_worth(key === "w") },
  { keys: ["x"], text: "worst block", run: () => P.worst() >= 0 && P.select(P.worst()) },
  { keys: ["e", "E"], text: "next event, event before", run: (key) => P.keys.event(key === "e" ? 1 : -1) },
  { keys: ["c", "C"], text: "colour by the next quantity, the one before", run: (key) => P.set({ colour: (P.state.colour + (key === "c" ? 1 : -1) + P.colour.modes.length) % P.colour.modes.length }) },
  { keys: ["h", "H"], text: "hide or draw this operation, draw all", run: (key) => (key === "H" ? P.set({ hidden: [] }) : P.steps_hidden(P.operation_here(), !P.state.hidden.includes(P.operation_here()))) },
  { keys: ["r", "R"], text: "measure, from or to the end of this block", run: (key) => (key === "R" ? P.measure.here() : P.keys.turn_on("measuring", [false, true])) },
  { keys: ["m"], text: "machine", run: () => P.m.meta.machine && P.keys.turn_on("machine", [true, false]) },
  { keys: ["f"], text: "part frame, machine frame", run: () => P.m.meta.machine && P.keys.turn_on("frame", ["part", "machine"]) },
  { keys: [" "], text: "play, pause", run: () => P.keys.turn_on("playing", [false, true]) },
  { keys: ["<", ">"], text: "slower, faster", run: (key) => P.play.faster(key === "<" ? -1 : 1) },
  { keys: ["b"], text: "by time, by block", run: () => P.keys.by() },
  { keys: ["/"], text: "find in the text", run: () => P.keys.into("find") },
  { keys: ["g"], text: "go to a line", run: () => P.keys.into("go") },
  { keys: ["1", "2", "3", "4", "5", "6", "7"], text: "verdict, path, NC, CL, charts, spread, table; again: the view alone", run: (key) => P.views.key(Number(key) - 1) },
  { keys: ["q"], text: "next chart", run: () => P.charts.groups.length && P.set({ chart: (P.state.chart + 1) % P.charts.groups.length }) },
  { keys: ["[", "]"], text: "look at the part from here, to here", run: (key) => P.keys.brush(key === "]") },
  { keys: ["d", "D"], text: "deviation vectors ten times longer, shorter", run: (key) => P.keys.scale(key === "d" ? 1 : -1) },
  { keys: ["v"], text: "next look at the path", run: () => P.path.renderer && P.path.look(((P.camera.looked || 0) + 1) % P.camera.looks.length) },
  { keys: ["+", "-"], text: "nearer, farther", run: (key) => P.keys.camera(() => P.camera.zoom(key === "+" ? 0.8 : 1.25)) },
  { keys: ["i", "j", "k", "l"], text: "turn up, left, down, right", run: (key) => P.keys.camera(() => P.camera.orbit(...{ i: [0, 0.1], k: [0, -0.1], j: [-0.1, 0], l: [0.1, 0] }[key])) },
  { keys: ["0"], text: "fit the view", run: () => P.path.fit() },
  { keys: ["t"], text: "light, dark, as the system", run: () => P.views.theme() },
  { keys: ["Escape"], text: "whole program, all views", run: () => P.views.escape() },
  { keys: ["?"], text: "this help", run: () => P.keys.help() },
];

P.keys.names = { " ": "space", ArrowLeft: "←", ArrowRight: "→", "Shift+ArrowLeft": "shift ←", "Shift+ArrowRight": "shift →", Escape: "Esc" };

P.keys.build = () => {
  const { el } = P;
  const shown = (key) => el("kbd", {}, P.keys.names[key] || key);
  const dialog = P.by("help");
  const close = el("button", { onclick: () => dialog.close() }, "Close");
  dialog.append(
    el("h2", { id: "help-title" }, "Keys"),
    el("dl", { class: "keys" }, P.keys.list.map(({ keys, text }) => el("div", {}, el("dt", {}, keys.length > 4 ? [shown(keys[0]), " … ", shown(keys[keys.length - 1])] : keys.map((key, at) => [at ? " " : "", shown(key)]).flat()), el("dd", {}, text)))),
    el("p", {}, "Mouse: drag turns the path, with shift or the right button it shifts, the wheel comes nearer; a click selects. In the charts a drag chooses a part of the program, the wheel draws it out, a double click shows all."),
    el("p", {}, P.m.meta.by),
    close,
  );
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || dialog.open) return;
    const { tagName, type } = event.target;
    // Where something is typed or chosen, keys are letters.
    if (tagName === "INPUT" && type === "text") return;
    const named = (event.shiftKey && event.key.startsWith("Arrow") ? "Shift+" : "") + event.key;
    if ((tagName === "SELECT" || tagName === "INPUT") && (/Arrow|Home|End| /.test(named) || (tagName === "SELECT" && named.length === 1))) return;
    if (tagName === "BUTTON" && (named === " " || named === "Enter")) return;
    const found = P.keys.list.find(({ keys }) => keys.includes(named));
    if (!found) return;
    event.preventDefault();
    found.run(named);
  });
};

P.keys.help = () => P.by("help").showModal();
