// The page: puts the views together, and says so where it cannot.

P.views = { names: ["verdict", "path", "nc", "cl", "charts", "spread", "table"] };

// A button to another of the three views that share the place under the path.
P.lower = (name) => (P.by(name).hidden ? null : P.button(name[0].toUpperCase() + name.slice(1), `Show the ${name} (${P.views.names.indexOf(name) + 1})`, () => P.views.show(name)));

// Shows a view and moves the focus into it.
P.views.show = (name) => {
  const views = P.by("views");
  const view = P.by(name);
  if (!view || view.hidden) return;
  if (["charts", "spread", "table"].includes(name)) views.dataset.lower = name;
  if (views.dataset.solo) views.dataset.solo = name;
  P.views.settle();
  const inner = view.querySelector(".body, .lines, .grid, canvas");
  (inner || view).focus({ preventScroll: false });
  view.scrollIntoView({ block: "nearest" });
};

// A view by its number; asked for again, it stands alone, and once more among the others.
P.views.key = (at) => {
  const views = P.by("views");
  const name = P.views.names[at];
  const view = P.by(name);
  if (!view || view.hidden) return;
  const inside = view.contains(document.activeElement) && getComputedStyle(view).display !== "none";
  if (views.dataset.solo === name) delete views.dataset.solo;
  else if (inside || views.dataset.solo) views.dataset.solo = name;
  P.views.show(name);
};

P.views.settle = () => {
  const { solo, lower } = P.by("views").dataset;
  const low = ["charts", "spread", "table"];
  for (const name of P.views.names) P.by(name).classList.toggle("away", solo ? solo !== name : low.includes(name) && lower !== name);
  for (const button of document.querySelectorAll("#head nav button[data-view]")) {
    const { view } = button.dataset;
    button.setAttribute("aria-pressed", solo === view);
  }
  if (P.numbers.follow) P.numbers.follow();
};

P.views.escape = () => {
  P.charts.reset();
  P.set({ measuring: false });
  if (P.by("views").dataset.solo) {
    delete P.by("views").dataset.solo;
    P.views.settle();
  }
};

P.views.theme = () => {
  const root = document.documentElement;
  const next = { undefined: "light", light: "dark" }[root.dataset.theme];
  if (next) root.dataset.theme = next;
  else delete root.dataset.theme;
  P.views.repaint();
};

P.views.repaint = () => {
  P.path.repaint();
  P.charts.draw();
  P.spread.draw();
};

P.views.head = () => {
  const { el, m } = P;
  const { meta } = m;
  const { names } = meta;
  const what = [meta.job, names.cl, names.nc, names.nc2, names.machine].filter(Boolean).join(" · ");
  const titles = ["Verdict", "Path", "NC", "CL", "Charts", "Spread", "Table"];
  const nav = el("nav", { "aria-label": "Views" }, P.views.names.map((name, at) => (P.by(name).hidden ? null : el("button", { "data-view": name, onclick: () => P.views.key(at) }, titles[at], el("kbd", {}, String(at + 1))))), el("button", { title: "Light or dark (t)", "aria-label": "Light or dark", onclick: () => P.views.theme() }, "◐"), el("button", { title: "Keys (?)", "aria-label": "Keys", onclick: () => P.keys.help() }, "?"));
  P.by("head").replaceChildren(P.verdict.badge(meta.verdict), el("div", { class: "titles" }, el("h1", {}, meta.title), el("p", {}, what)), nav);
  document.title = meta.title;
};

// The selected block in a line of text, which is read out as it changes.
P.views.foot = () => {
  const { el, m } = P;
  const chosen = el("div", { class: "chosen mono", role: "status", "aria-live": "polite" });
  P.by("foot").append(chosen, el("span", { class: "quiet" }, `${m.rows.toLocaleString("en")} blocks`));
  const told = { deviation: "tip", axis_deviation: "axis", contour: "contour", clearance: "clear by", chip: "cuts", cut_depth: "deep", cut_width: "wide", feed: "F" };
  const tell = () => {
    const { row, playing } = P.state;
    const word = (name) => (m.has(name) ? `${told[name]} ${P.quantity(m.at(name, row), m.unit(name), false, P.digits_of(m.blocks.columns.get(name)))}` : null);
    const machine = P.chain.at(row);
    const own = (name) => !machine || machine.axes.some((axis) => axis.name === name);
    const limit = m.meta.limits[m.at("limit", row)];
    const line = (text, name) => (m.lineOf(name, row) ? `${text} ${m.lineOf(name, row)}` : null);
    const parts = [`Block ${row + 1}`, line("NC", "nc"), line("CL", "cl"), line("old NC", "nc2"), m.timed ? P.clock(m.end(row), 3) : null,
      ...m.axes.filter(own).map((name) => `${name} ${P.shown(m.at("q." + name, row), m.unit("q." + name), P.POSITION)}`), word("deviation"), word("axis_deviation"), word("contour"), word("clearance"), word("chip"), word("cut_depth"), word("cut_width"), word("feed") && word("feed") + (limit ? ` by ${limit}` : "")];
    const event = P.scene.marks.find((mark) => mark.row === row && !mark.quiet);
    if (event) parts.push(event.text);
    chosen.setAttribute("aria-live", playing ? "off" : "polite");
    chosen.replaceChildren(...parts.filter(Boolean).map((text, at) => el(at ? "span" : "b", {}, text)));
  };
  P.listen("row playing", tell);
  tell();
};

// On paper: light, whatever the screen is, and the charts in its size.
P.views.print = () => {
  const root = document.documentElement;
  let before;
  window.addEventListener("beforeprint", () => {
    before = root.dataset.theme;
    root.dataset.theme = "light";
    P.colour.refresh();
    for (const one of [P.charts, P.spread]) {
      Object.assign(one, { width: 1000, height: 380, dense: 2 });
      Object.assign(one.canvas, { width: 2000, height: 760 });
      one.draw();
    }
  });
  window.addEventListener("afterprint", () => {
    if (before) root.dataset.theme = before;
    else delete root.dataset.theme;
    P.views.repaint();
    P.charts.fit();
    P.spread.fit();
  });
};

P.views.start = (report) => {
  P.m = P.model(report);
  P.colour.find();
  P.scene.build();
  P.colour.refresh();
  P.by("views").dataset.lower = "charts";
  P.by("spread").hidden = !["deviation", "axis_deviation", "contour"].some(P.m.has);
  P.verdict.build(P.by("verdict"));
  P.texts.build();
  P.path.build(P.by("path"));
  P.charts.build(P.by("charts"));
  P.spread.build(P.by("spread"));
  P.numbers.build(P.by("table"));
  P.views.head();
  P.views.foot();
  P.keys.build();
  P.panes.build();
  P.views.settle();
  P.views.print();
  for (const query of ["(prefers-color-scheme: dark)", "(forced-colors: active)"]) matchMedia(query).addEventListener("change", () => P.views.repaint());
  window.addEventListener("hashchange", () => P.follow());
  if (!P.follow()) {
    const [worst] = report.meta.maxima;
    if (worst && P.m.rows) {
      if (worst.row !== null) P.select(worst.row);
      else if (worst.nc) P.select_line("nc", worst.nc - 1);
    }
  }
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
};

P.load().then(P.views.start).catch((fault) => {
  P.by("views").hidden = true;
  P.by("head").replaceChildren(P.el("p", { role: "alert", class: "bad" }, `The report cannot be shown: ${fault.message || fault}`));
  console.error(fault);
});
