// What the views draw with: surfaces that follow their size, lines, and words.

P.FONT = "11px system-ui, sans-serif";
P.BOLD = "bold 11px system-ui, sans-serif";

// Keeps canvases as large as their place; `then` is told of each new size, in pixels of the page.
P.surface = (place, canvases, then) => {
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = place;
    if (!width || !height) return;
    const dense = Math.min(window.devicePixelRatio || 1, 2);
    for (const canvas of canvases) {
      canvas.width = Math.round(width * dense);
      canvas.height = Math.round(height * dense);
    }
    then({ width, height, dense });
  };
  new ResizeObserver(fit).observe(place);
  return fit;
};

// A brush on a canvas that is to be drawn anew, in pixels of the page.
P.paint = (canvas, { width, height, dense }, ground) => {
  const paint = canvas.getContext("2d");
  paint.setTransform(dense, 0, 0, dense, 0, 0);
  paint.clearRect(0, 0, width, height);
  paint.fillStyle = ground || "transparent";
  paint.fillRect(0, 0, width, height);
  paint.font = P.FONT;
  paint.lineJoin = "round";
  return paint;
};

// A line through points: x, y, x, y, …
P.stroke = (paint, css, wide, points, dash) => {
  paint.strokeStyle = css;
  paint.lineWidth = wide;
  paint.setLineDash(dash || []);
  paint.beginPath();
  for (let at = 0; at < points.length; at += 2) paint.lineTo(points[at], points[at + 1]);
  paint.stroke();
  paint.setLineDash([]);
};

P.write = (paint, text, x, y, css, align = "center", base = "middle") => {
  paint.textAlign = align;
  paint.textBaseline = base;
  paint.fillStyle = css;
  paint.fillText(text, x, y);
};

// Buttons of which one is chosen.
P.tabs = (label, titles, run) => {
  const tabs = P.el("div", { class: "tabs", role: "tablist", "aria-label": label });
  titles.forEach((title, at) => tabs.append(P.el("button", { role: "tab", onclick: () => run(at) }, title)));
  tabs.choose = (chosen) => [...tabs.children].forEach((tab, at) => tab.setAttribute("aria-selected", at === chosen));
  tabs.choose(0);
  return tabs;
};

P.button = (text, title, run) => P.el("button", { title, onclick: run }, text);

// A choice from a list, told by number.
P.choose = (label, options, chosen, run) => {
  const select = P.el("select", { "aria-label": label, title: label, onchange: () => run(Number(select.value)) });
  options.forEach((text, at) => select.append(P.el("option", { value: at, selected: at === chosen }, text)));
  return select;
};

// The largest of a column, and no less than 0.
P.largest = (values) => values.reduce((most, value) => (value > most ? value : most), 0);
