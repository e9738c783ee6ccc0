// Panes that are as wide and as high as the reader wants: a grip on each edge, by mouse, finger or arrows.

P.panes = {};

// What a grip changes: a property of the grid, the view on whose edge it lies, whether it is the height of a view, and
// whether the view grows as the pointer goes on.
P.panes.grips = [
  { name: "--first", view: "verdict", grows: 1, text: "Width of the verdict" },
  { name: "--text", view: "nc", grows: -1, text: "Width of the texts" },
  { name: "--low", view: "charts", high: true, grows: -1, text: "Height of the charts" },
];
P.panes.LEAST = 150;

P.panes.build = () => {
  const views = P.by("views");
  for (const { name, view, high, grows, text } of P.panes.grips) {
    // A CL file alone stands where the program would.
    const place = [P.by(view), view === "nc" && P.by("cl")].find((one) => one && !one.hidden);
    if (!place) continue;
    // Of three views that share a place, whichever is shown.
    const size = () => {
      const shown = high ? [...views.querySelectorAll("#charts, #spread, #table")].find((one) => !one.classList.contains("away")) || place : place;
      return shown.getBoundingClientRect()[high ? "height" : "width"];
    };
    const grip = P.el("div", { class: `grip ${view}`, role: "separator", tabindex: "0", "aria-label": text, "aria-orientation": high ? "horizontal" : "vertical", title: `${text}; a double click puts it back` });
    const set = (pixels) => {
      const whole = views.getBoundingClientRect()[high ? "height" : "width"];
      const most = Math.max(whole * (high ? 0.75 : 0.45), P.panes.LEAST);
      views.style.setProperty(name, `${Math.round(P.clamp(pixels, P.panes.LEAST, most))}px`);
      tell();
    };
    const tell = () => grip.setAttribute("aria-valuenow", Math.round(size()));
    let held = null;
    grip.addEventListener("pointerdown", (event) => {
      grip.setPointerCapture(event.pointerId);
      held = { from: high ? event.clientY : event.clientX, size: size() };
    });
    grip.addEventListener("pointermove", (event) => held && set(held.size + grows * ((high ? event.clientY : event.clientX) - held.from)));
    for (const over of ["pointerup", "pointercancel"]) grip.addEventListener(over, () => (held = null));
    grip.addEventListener("dblclick", () => {
      views.style.removeProperty(name);
      tell();
    });
    grip.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      set(size() + step * grows * 24);
    });
    views.append(grip);
    tell();
  }
};
