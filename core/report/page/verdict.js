// The verdict: the word, the largest deviations with their places, travel, what was found, operations and tools to go to,
// and what is left out.

P.verdict = {
  icons: {
    good: "M4 10.5 8.2 15 16 5.5",
    warn: "M10 3 18 16.5H2ZM10 8v4M10 14.4v.1",
    bad: "M5 5l10 10M15 5 5 15",
  },
};

P.verdict.badge = ({ kind, word }) => P.el("span", { class: `badge ${kind}` }, P.icon(P.verdict.icons[kind] || P.verdict.icons.warn), word);

P.verdict.build = (view) => {
  const { el, m } = P;
  const { meta } = m;
  const body = el("div", { class: "body", tabindex: "0", role: "group", "aria-label": "Verdict" });
  const part = (title, ...children) => body.append(el("h3", {}, title), ...children);
  view.append(el("div", { class: "bar" }, el("h2", { id: "verdict-title" }, "Verdict")), body);
  body.append(P.verdict.badge(meta.verdict));
  body.append(el("div", { class: "said" }, meta.verdict.sentences.map((sentence) => el("p", {}, sentence))));
  if (meta.maxima.length) part("Largest", P.verdict.maxima(meta.maxima));
  if (meta.clearance) part("Clearance", P.verdict.clearance(meta.clearance));
  if (meta.warnings.length) part(`Found (${meta.warnings.length})`, P.verdict.warnings(meta.warnings));
  const { steps } = m;
  if (steps.length) part(`Operations and tools (${steps.length})`, ...P.verdict.steps(steps));
  if (meta.axes_used.length) part("Travel used", ...meta.axes_used.map(P.verdict.travel));
  // What stands above is not said twice.
  const above = [...meta.maxima.map(({ name }) => name), ...meta.axes_used.map(({ name }) => `axis ${name}`)];
  const facts = meta.facts.filter(([label]) => !above.includes(label));
  if (facts.length) part("Job", el("dl", { class: "facts" }, facts.map(([label, text]) => [el("dt", {}, label), el("dd", {}, text)])));
  if (meta.excludes.length) part("What “certified” leaves out", el("ul", { class: "plain quiet" }, meta.excludes.map((sentence) => el("li", {}, sentence))));
  const left = [...meta.parts_left_out];
  if (meta.events_left_out > 0) left.push(`${meta.events_left_out} further marks are not listed.`);
  if (left.length) part("Left out of this page", el("ul", { class: "plain" }, left.map((sentence) => el("li", {}, sentence))));
};

// Operations and tools, to be gone to, shown and hidden; the one that the selected block belongs to is marked.
P.verdict.most_steps = 1000;
P.verdict.steps = (steps) => {
  const { el, m } = P;
  const shown = steps.slice(0, P.verdict.most_steps);
  const buttons = shown.map(({ row, text }) => el("button", { class: "link", onclick: () => P.select(row) }, text));
  const time = (row) => (m.timed ? el("span", { class: "quiet number" }, P.clock(m.start(row))) : null);
  // Where two follow one another the first has no block.
  const own = (at) => m.span(at)[1] >= m.span(at)[0];
  const boxes = shown.map(({ text }, at) => (own(at) ? el("input", { type: "checkbox", "aria-label": `Draw ${text}`, title: "Draw (h)", onchange: () => P.steps_hidden(at, !boxes[at].checked) }) : el("span", { class: "no" })));
  const list = el("ol", { class: "steps" }, shown.map(({ row, kind }, at) => el("li", { class: kind }, boxes[at], buttons[at], " ", time(row))));
  const tick = () => boxes.forEach((box, at) => (box.checked = !P.state.hidden.includes(at)));
  P.listen("hidden", tick);
  tick();
  let marked;
  const follow = () => {
    const now = buttons[P.step_here()];
    if (marked) marked.removeAttribute("aria-current");
    if (now) now.setAttribute("aria-current", "step");
    marked = now;
  };
  P.listen("row", follow);
  follow();
  return [el("div", { class: "tabs" }, P.button("All", "Draw all operations (H)", () => P.set({ hidden: [] })), P.button("This alone", "Draw the selected operation alone", P.step_alone)), list];
};

// The last step ahead of the selected block, and the operation that it belongs to, the tool where there are no operations;
// -1 ahead of the first.
P.step_here = () => {
  const after = P.m.steps.findIndex(({ row }) => row > P.state.row);
  return (after < 0 ? P.m.steps.length : after) - 1;
};
P.operation_here = () => {
  const { steps } = P.m;
  const main = steps.some(({ kind }) => kind === "operation") ? "operation" : "tool";
  return steps.findLastIndex(({ kind, row }) => kind === main && row <= P.state.row);
};
P.steps_hidden = (at, hide) => at >= 0 && P.set({ hidden: [...P.state.hidden.filter((other) => other !== at), ...(hide ? [at] : [])] });
P.step_alone = () => {
  const { steps } = P.m;
  const here = P.operation_here();
  if (here >= 0) P.set({ hidden: steps.map((_, at) => at).filter((at) => at !== here && steps[at].kind === steps[here].kind) });
};

// Links to the places of something: the line of the program, that of the CL file, else the block.
P.verdict.places = ({ nc, cl, row }) => {
  const { el } = P;
  const known = row != null;
  const link = (text, title, run) => el("button", { class: "link number", title, onclick: known ? () => P.select(row) : run }, text);
  const made = [];
  if (nc) made.push(link(`NC ${nc}`, `Go to line ${nc} of the program`, () => P.select_line("nc", nc - 1)));
  if (cl) made.push(link(`CL ${cl}`, `Go to line ${cl} of the CL file`, () => P.select_line("cl", cl - 1)));
  if (!made.length && known) made.push(link(`block ${row + 1}`, "Go to the block"));
  return made;
};

P.verdict.maxima = (maxima) => {
  const { el } = P;
  const rows = maxima.map((one) => {
    const over = one.limit && one.value > one.limit * (1 + 1e-6);
    const bar = el("span", { class: `share${over ? " over" : ""}` }, el("i"));
    if (one.limit) bar.firstChild.style.width = `${P.clamp((one.value / one.limit) * 100, 0.5, 100)}%`;
    return [
      el("tr", {}, el("th", { scope: "row" }, one.name), el("td", { class: "number" }, P.quantity(one.value, one.unit, true))),
      el("tr", {}, el("td", { colspan: "2" }, one.limit ? bar : null, el("span", { class: "quiet" }, one.limit ? `of ${P.short(one.limit)} ${P.unit(one.unit)}${over ? ", exceeded" : ""} ` : ""), el("span", { class: "where" }, P.verdict.places(one)))),
    ];
  });
  return el("table", { class: "maxima" }, el("tbody", {}, rows.flat()));
};

// Pairs of bodies, the nearest first, each with the place of its nearest approach.
P.verdict.clearance = ({ pairs }) => {
  const { el } = P;
  const rows = pairs.map(({ bodies, clear_by, nearest, nc, not_clear }) => [
    el("tr", {}, el("th", { scope: "row" }, bodies.join(" – ")), el("td", { class: "number" }, nearest === null ? "–" : P.position(nearest, "mm"))),
    el("tr", {}, el("td", { colspan: "2" }, el("span", { class: not_clear ? "bad" : "quiet" }, not_clear ? `not clear in ${not_clear} motions ` : clear_by === null ? "" : `proven ${P.position(Math.floor(clear_by * 1e3 + 1e-3) / 1e3, "mm")} `), el("span", { class: "where" }, P.verdict.places({ nc })))),
  ]);
  return el("table", { class: "maxima" }, el("tbody", {}, rows.flat()));
};

P.verdict.warnings = (warnings) => {
  const { el } = P;
  return el("ul", { class: "warnings" }, warnings.map((one) => el("li", { class: one.severity }, el("b", {}, one.severity === "error" ? "Error: " : one.severity === "note" ? "Note: " : "Warning: "), one.text, one.help ? el("div", { class: "quiet" }, one.help) : null, el("div", {}, one.code ? el("code", {}, one.code) : null, " ", P.verdict.places(one)))));
};

// How much of its travel an axis uses.
P.verdict.travel = ({ name, unit, min, max, travel, way }) => {
  const { el } = P;
  // Without ends: as a share of a turn.
  const [low, high] = travel || [min, min + 360];
  const room = high - low || 1;
  const over = travel && (min < low - 1e-9 || max > high + 1e-9);
  const bar = el("span", { class: `way${over ? " over" : ""}` }, el("i"));
  const share = (value) => P.clamp(((value - low) / room) * 100, 0, 100);
  const { style } = bar.firstChild;
  style.left = `${share(min)}%`;
  style.width = `${Math.max(share(max) - share(min), 1)}%`;
  const told_as = (value) => P.shown(value, unit, P.POSITION);
  const text = `${told_as(min)} … ${P.position(max, unit)}`;
  const told = travel ? `of ${told_as(low)} … ${told_as(high)}${over ? ", exceeded" : ""}` : "endless";
  const all = Number.isFinite(way) && way !== null ? `, ${P.position(way, unit)} in all` : "";
  return el("div", { class: "travel", title: `${name}: ${text}, ${told}${all}` }, el("b", {}, name), bar, el("div", { class: "ends" }, el("span", {}, text), el("span", {}, told)));
};
