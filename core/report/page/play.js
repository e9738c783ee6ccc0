// Playing: the machine goes through the program, by its time or block by block.

P.play = { speeds: [0.1, 0.25, 0.5, 1, 2, 5, 10, 25, 50, 100, 250, 500, 1000] };

P.play.build = () => {
  const { el, m } = P;
  if (!m.timed) P.set({ by: "block" });
  const button = el("button", { title: "Play (space)", "aria-label": "Play", onclick: () => P.set({ playing: !P.state.playing }) }, "▶");
  const scrub = el("input", { type: "range", min: "0", max: "100000", step: "1", value: "0", "aria-label": "Place in the program" });
  scrub.addEventListener("input", () => {
    P.set({ playing: false });
    P.play.to((Number(scrub.value) / 100000) * P.whole());
    P.remember();
  });
  const speed = el("input", { type: "range", min: "0", max: String(P.play.speeds.length - 1), value: P.play.speeds.indexOf(P.state.speed), "aria-label": "Speed (< and >)", class: "speed" });
  speed.addEventListener("input", () => P.set({ speed: P.play.speeds[Number(speed.value)] }));
  const told = el("output", { class: "mono" });
  const by = el("select", { "aria-label": "Play by", onchange: () => P.set({ by: by.value }) }, m.timed ? el("option", { value: "time" }, "by time") : null, el("option", { value: "block" }, "by block"));
  by.value = P.state.by;
  P.listen("playing", () => {
    button.textContent = P.state.playing ? "❚❚" : "▶";
    button.setAttribute("aria-label", P.state.playing ? "Pause" : "Play");
    if (P.state.playing) P.play.start();
    else P.remember();
  });
  const tell = () => {
    const at = P.play.at();
    scrub.value = String(Math.round((at / (P.whole() || 1)) * 100000));
    scrub.setAttribute("aria-valuetext", P.state.by === "time" ? P.clock(at) : `block ${P.state.row + 1}`);
    speed.value = String(P.play.speeds.indexOf(P.state.speed));
    speed.setAttribute("aria-valuetext", `${P.state.speed} times`);
    by.value = P.state.by;
    told.textContent = `${P.state.by === "time" ? `${P.clock(at)} / ${P.clock(m.total)}` : `${P.state.row + 1} / ${m.rows}`}  ×${P.state.speed}`;
  };
  P.listen("row share speed by", tell);
  tell();
  return el("div", { class: "bar low" }, button, scrub, told, speed, by);
};

// The place in the program, s or blocks, and its end.
P.play.at = () => {
  const { row, share, by } = P.state;
  const { start, end } = P.m;
  return by === "time" ? start(row) + (end(row) - start(row)) * share : row + share;
};

P.play.to = (place) => {
  const { m, state } = P;
  const at = P.clamp(place, 0, P.whole());
  const row = state.by === "time" ? m.rowAt(at) : Math.min(Math.floor(at), m.rows - 1);
  const length = m.end(row) - m.start(row);
  const share = state.by === "time" ? (length > 0 ? P.clamp((at - m.start(row)) / length, 0, 1) : 1) : at - row;
  P.set({ row, share, line: null });
};

P.play.start = () => {
  if (P.play.at() >= P.whole() * (1 - 1e-9)) P.play.to(0);
  let place = P.play.at();
  let set = place;
  let before = performance.now();
  const step = (now) => {
    if (!P.state.playing) return;
    // Whoever selects another place while it plays goes on from there.
    if (Math.abs(P.play.at() - set) > 1e-6) place = P.play.at();
    place += ((now - before) / 1000) * P.state.speed;
    before = now;
    P.play.to(place);
    set = P.play.at();
    if (place >= P.whole()) P.set({ playing: false });
    else requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
};

P.play.faster = (by) => {
  const at = P.play.speeds.indexOf(P.state.speed);
  P.set({ speed: P.play.speeds[P.clamp(at + by, 0, P.play.speeds.length - 1)] });
};
