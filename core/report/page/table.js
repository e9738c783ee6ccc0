// The numbers behind charts and path, a row a block.

P.numbers = {};

P.numbers.build = (view) => {
  const { el, m } = P;
  const words = { kind: P.KINDS, reason: P.REASONS, limit: m.meta.limits };
  const columns = [...m.blocks.columns.values()];
  const cell = (role, text) => el("span", { class: "cell", role, title: role === "columnheader" ? text : null }, text);
  const title = ({ name, unit }) => name.replace("_", " ") + (unit ? `, ${P.unit(unit)}` : "");
  const text = (one, row) => {
    const value = one.at(row);
    if (words[one.name]) return words[one.name][value] || "";
    if (one.name === "t0" || one.name === "t1") return P.clock(value, 3);
    return !one.decimals ? String(value) : P.shown(value, one.unit, P.digits_of(one));
  };
  const box = el("div", { class: "grid", role: "grid", tabindex: "0", "aria-label": "Blocks", "aria-rowcount": m.rows + 1, "aria-colcount": columns.length + 1 });
  box.append(el("div", { class: "row top", role: "row" }, cell("columnheader", "block"), columns.map((one) => cell("columnheader", title(one)))));
  const list = P.virtual(box, {
    count: m.rows,
    height: 20,
    make: (row) => el("div", { class: "row", role: "row", "aria-rowindex": row + 2, "aria-selected": row === P.state.row, onclick: () => P.select(row) }, cell("rowheader", String(row + 1)), columns.map((one) => cell("gridcell", text(one, row)))),
  });
  P.steps(box, (step) => P.select(P.state.row + step));
  view.append(el("div", { class: "bar" }, el("h2", { id: "table-title" }, "Table"), P.lower("charts"), P.lower("spread")), box);
  // Out of sight nothing is shown: the columns are not even unpacked.
  P.numbers.follow = () => !view.classList.contains("away") && list.show(P.state.row);
  P.listen("row", P.numbers.follow);
};
