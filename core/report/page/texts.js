// The NC program and the CL file, side by side: found in, gone to, and following the selection.

P.texts = { panes: {} };

P.texts.build = () => {
  const { texts, meta } = P.m.report;
  const { names } = meta;
  const second = texts.cl ? "cl" : texts.nc2 ? "nc2" : null;
  P.by("views").dataset.texts = String((texts.nc ? 1 : 0) + (second ? 1 : 0));
  if (texts.nc) P.texts.pane(P.by("nc"), "nc", "NC program", names.nc);
  else P.by("nc").hidden = true;
  if (second) P.texts.pane(P.by("cl"), second, second === "cl" ? "CL file" : "Old NC program", names[second]);
  else P.by("cl").hidden = true;
  if (!texts.nc && second) P.by("cl").style.gridArea = "nc";
};

P.texts.pane = (view, name, title, file) => {
  const { el } = P;
  const text = P.m.report.texts[name];
  const box = el("div", { class: "lines", role: "listbox", tabindex: "0", "aria-label": title });
  const gutter = String(text.lines).length + 2;
  box.style.setProperty("--gutter", `${gutter}ch`);
  const pane = { name, text, box, current: -1, needle: "" };
  pane.list = P.virtual(box, {
    count: text.lines,
    height: 18,
    make: (at) => {
      const line = el("div", { class: "line", role: "option", id: `${name}-${at + 1}`, "aria-selected": at === pane.current, "aria-posinset": at + 1, "aria-setsize": text.lines }, el("span", { class: "at" }, String(at + 1)), P.texts.coloured(text.line(at), name, pane.needle));
      line.addEventListener("click", () => P.select_line(name, at));
      return line;
    },
  });
  const find = el("input", { type: "text", placeholder: "Find", "aria-label": `Find in the ${title} (/)`, spellcheck: "false", autocomplete: "off" });
  const told = el("output", { "aria-live": "polite" });
  const turn = (back) => P.texts.find(pane, find.value, back, told);
  find.addEventListener("keydown", (event) => {
    if (event.key === "Enter") turn(event.shiftKey);
    else if (event.key === "Escape") box.focus();
  });
  const go = el("input", { type: "text", class: "goto", placeholder: "Line", inputmode: "numeric", "aria-label": `Go to a line of the ${title} (g)` });
  go.addEventListener("keydown", (event) => {
    const line = Number.parseInt(go.value, 10);
    if (event.key === "Escape") box.focus();
    if (event.key !== "Enter" || !Number.isFinite(line)) return;
    P.select_line(name, P.clamp(line, 1, text.lines) - 1);
    box.focus();
  });
  Object.assign(pane, { find, go });
  P.steps(box, (step) => P.select_line(name, P.clamp(pane.current + step, 0, text.lines - 1)));
  const head = el("div", { class: "bar" }, el("h2", { id: `${view.id}-title` }, title, " ", el("span", { class: "name" }, file || "")));
  const tools = el("div", { class: "bar find" }, find, el("button", { "aria-label": "Find back", title: "Back", onclick: () => turn(true) }, "↑"), el("button", { "aria-label": "Find on", title: "On", onclick: () => turn(false) }, "↓"), go, told);
  view.append(head, tools, box);
  P.texts.panes[name] = pane;
  const follow = () => P.texts.follow(pane);
  P.listen("row line", follow);
  follow();
};

// Shows the line that belongs to the selection.
P.texts.follow = (pane) => {
  const { row, line } = P.state;
  const chosen = line && line.text === pane.name ? line.line : P.m.lineOf(pane.name, row) - 1;
  // A block without a line of its own here leaves the line that stood.
  if (chosen >= 0) pane.current = Math.min(chosen, pane.text.lines - 1);
  pane.box.setAttribute("aria-activedescendant", `${pane.name}-${pane.current + 1}`);
  if (pane.current >= 0) pane.list.show(pane.current);
};

// The next line that holds the words, round the end; a slice at a time, so that the page stays alive.
P.texts.find = async (pane, needle, back, told) => {
  const { text } = pane;
  pane.needle = needle;
  const turn = (pane.turn = (pane.turn || 0) + 1);
  if (!needle) {
    told.textContent = "";
    pane.list.draw();
    return;
  }
  const wanted = needle.toLowerCase();
  const step = back ? -1 : 1;
  let at = pane.current;
  for (let seen = 0; seen < text.lines; seen++) {
    at = (at + step + text.lines) % text.lines;
    if (text.line(at).toLowerCase().includes(wanted)) {
      told.textContent = "";
      P.select_line(pane.name, at);
      pane.list.draw();
      return;
    }
    if (seen % 50000 === 49999) {
      told.textContent = "…";
      await new Promise((done) => setTimeout(done));
      if (turn !== pane.turn) return;
    }
  }
  told.textContent = "not found";
  pane.list.draw();
};

// Words of a line with a class each; what is found is marked. Text alone, never markup.
P.texts.rules = {
  nc: [[/^(\([^)]*\)?|;.*)/, "remark"], [/^(N\d+|%)/i, "dim"], [/^([GMT]\d+(?:\.\d+)?)/i, "word"], [/^([^NGMTngmt(;%]+|.)/, ""]],
  cl: [[/^(\$\$.*|PPRINT.*)/i, "remark"], [/^([A-Z][A-Z0-9]*)(?=\s*(?:\/|$|=))/i, "word"], [/^([A-Z][A-Z0-9]*)/i, ""], [/^([^A-Z$]+|.)/i, ""]],
};
P.texts.coloured = (line, name, needle) => {
  const { el } = P;
  // A line longer than a screen is shown to its first thousand letters; it says so.
  const shown = line.length > 1000 ? line.slice(0, 1000) + ` … ${line.length - 1000} more` : line;
  const found = needle ? shown.toLowerCase().indexOf(needle.toLowerCase()) : -1;
  if (found >= 0) {
    return el("span", {}, shown.slice(0, found), el("mark", {}, shown.slice(found, found + needle.length)), shown.slice(found + needle.length));
  }
  const out = el("span", {});
  let rest = shown;
  let first = true;
  while (rest) {
    for (const [pattern, kind] of P.texts.rules[name === "cl" ? "cl" : "nc"]) {
      const match = pattern.exec(rest);
      if (!match) continue;
      // Of a CL line only the first word is a word of the language.
      const taken = kind === "word" && name === "cl" && !first ? "" : kind;
      out.append(taken ? el("span", { class: taken }, match[0]) : match[0]);
      rest = rest.slice(match[0].length);
      first = false;
      break;
    }
  }
  return out;
};
