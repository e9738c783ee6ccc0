// Up and down in a list: by one, by a page.
P.steps = (box, run) => {
  box.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 }[event.key];
    if (!step) return;
    event.preventDefault();
    run(step);
  });
};

// A long list of which only what is in sight is there. Browsers end at some ten million pixels: beyond, the bar is scaled.

P.virtual = (box, { count, height, make, top = 0 }) => {
  const LIMIT = 8e6;
  const full = count * height;
  const page = P.el("div", { class: "page", role: "presentation" });
  page.style.height = `${Math.min(full, LIMIT) + top}px`;
  box.append(page);
  const list = {};
  // Its height is told when it changes: asking for it would lay the page out anew.
  let tall = box.clientHeight;
  const room = () => Math.max(tall - top, height);
  const scaled = full > LIMIT;
  // From where the bar stands to the place of the first line, and back. Where it stands is known: asking would lay the page
  // out anew.
  const ratio = () => (scaled ? (full - room()) / (LIMIT - room()) : 1);
  let bar = 0;
  list.draw = () => {
    if (box.closest(".away")) return;
    const from = bar * ratio();
    const first = Math.max(0, Math.floor(from / height) - 4);
    const last = Math.min(count, Math.ceil((from + room()) / height) + 4);
    const rows = [];
    for (let at = first; at < last; at++) {
      const row = make(at);
      row.style.top = `${bar + at * height - from + top}px`;
      rows.push(row);
    }
    page.replaceChildren(...rows);
  };
  let waiting = null;
  const later = () => {
    if (!waiting) {
      waiting = requestAnimationFrame(() => {
        waiting = null;
        list.draw();
      });
    }
  };
  // Brings a line into sight, a third from the top if it was not.
  list.show = (at) => {
    if (box.closest(".away")) return;
    const from = bar * ratio();
    const place = at * height;
    if (place < from || place + height > from + room() - 2) {
      bar = P.clamp(Math.floor((place - room() / 3) / ratio()), 0, Math.max(Math.min(full, LIMIT) - room(), 0));
      requestAnimationFrame(() => (box.scrollTop = bar));
    }
    list.draw();
  };
  box.addEventListener("scroll", () => {
    bar = box.scrollTop;
    later();
  });
  new ResizeObserver(() => {
    tall = box.clientHeight;
    bar = box.scrollTop;
    later();
  }).observe(box);
  return list;
};
