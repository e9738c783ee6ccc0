// Colours: a scale whose lightness only rises or only falls (OKLab), distinct above the tolerance.

P.colour = { modes: [], ramp: new Uint8ClampedArray(256 * 4), dark: false, kinds: [] };

// Places of the scale: up to the tolerance, above it; kinds take twelve places each.
P.colour.top = 191;
P.colour.over = 200;

// OKLCh to sRGB, 0 to 1; the chroma is drawn in until the colour can be shown.
P.colour.rgb = (light, chroma, hue) => {
  for (let part = chroma; ; part -= 0.004) {
    const a = part * Math.cos((hue * Math.PI) / 180);
    const b = part * Math.sin((hue * Math.PI) / 180);
    const [l, m, s] = [
      (light + 0.3963377774 * a + 0.2158037573 * b) ** 3,
      (light - 0.1055613458 * a - 0.0638541728 * b) ** 3,
      (light - 0.0894841775 * a - 1.291485548 * b) ** 3,
    ];
    const linear = [
      4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
      -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
      -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
    if (part <= 0 || linear.every((value) => value > -1e-4 && value < 1.0001)) {
      return linear.map((value) => {
        const kept = P.clamp(value, 0, 1);
        return kept <= 0.0031308 ? 12.92 * kept : 1.055 * kept ** (1 / 2.4) - 0.055;
      });
    }
  }
};

// Light on dark ground, dark on light: the worst stands out from the ground the most.
P.colour.scale = (place, dark) => {
  const top = P.colour.top;
  if (place <= top) {
    const share = place / top;
    return dark
      ? P.colour.rgb(0.5 + 0.24 * share, 0.13 - 0.02 * share, 268 - 78 * share)
      : P.colour.rgb(0.76 - 0.3 * share, 0.1 + 0.08 * share, 205 + 65 * share);
  }
  const share = (place - top) / (255 - top);
  return dark ? P.colour.rgb(0.84 + 0.09 * share, 0.16, 72 + 26 * share) : P.colour.rgb(0.435 - 0.09 * share, 0.16 - 0.04 * share, 29);
};

// Kinds differ in lightness as well as in hue.
P.colour.kind = (index, dark) => {
  const hues = [250, 55, 150, 325, 95, 200, 20, 290, 120, 350];
  const lift = [0, 0.08, -0.04, 0.03, 0.12, 0.05, -0.06, -0.02, 0.1, 0][index % 10];
  return P.colour.rgb((dark ? 0.72 : 0.54) + lift, 0.15, hues[index % hues.length]);
};

// Colours of the style sheet as the canvas and the shader need them.
P.colour.probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
P.colour.of = (name) => {
  const probe = P.by("head");
  const before = probe.style.color;
  probe.style.color = `var(--${name})`;
  const css = getComputedStyle(probe).color;
  probe.style.color = before;
  const paint = P.colour.probe;
  paint.clearRect(0, 0, 1, 1);
  paint.fillStyle = css;
  paint.fillRect(0, 0, 1, 1);
  const [r, g, b] = paint.getImageData(0, 0, 1, 1).data;
  return { css, rgb: [r / 255, g / 255, b / 255] };
};

// Reads the theme anew and fills the scale of the mode in use.
P.colour.refresh = () => {
  const names = ["ground", "panel", "line", "text", "quiet", "accent", "cl", "rapid", "scene", "grid", "machine", "tool", "holder", "table", "rest", "edge", "mark", "select", "bad", "strong"];
  for (const name of names) P.colour[name] = P.colour.of(name);
  const [r, g, b] = P.colour.scene.rgb;
  P.colour.dark = 0.2126 * r + 0.7152 * g + 0.0722 * b < 0.4;
  const mode = P.colour.mode();
  for (let place = 0; place < 256; place++) {
    const colour = mode.kinds ? P.colour.kind(Math.floor(place / 12), P.colour.dark) : P.colour.scale(place, P.colour.dark);
    colour.forEach((value, at) => (P.colour.ramp[place * 4 + at] = Math.round(value * 255)));
    P.colour.ramp[place * 4 + 3] = 255;
  }
};

P.colour.css = (place) => {
  const at = Math.round(place) * 4;
  const [r, g, b] = P.colour.ramp.subarray(at, at + 3);
  return `rgb(${r} ${g} ${b})`;
};

// Where a value stands on the scale: a share of its limit, or the number of a kind; -1 where there is none.
P.colour.place = (mode, value) => {
  if (!Number.isFinite(value) || value < 0) return -1;
  if (mode.kinds) return (value % 20) * 12 + 6;
  if (value <= 1) return value * P.colour.top;
  return Math.min(P.colour.over + Math.log2(value) * 12, 255);
};

P.KINDS = ["position", "reference", "rapid", "line", "arc", "spline", "cycle"];
P.REASONS = ["point", "eased", "put in", "leave", "stage", "rewind", "feed", "above", "at once"];

// The ways of colouring that the columns of this report allow; a column is unpacked when its way is chosen.
P.colour.find = () => {
  const { column, has, meta, unit } = P.m;
  const modes = [];
  // As a share of a limit, one for all or one a block; else of the largest.
  const share = (name, title, limits) => {
    if (!has(name)) return;
    const make = () => {
      const values = column(name);
      const limit = limits && limits();
      const fixed = typeof limit === "number" ? limit : 0;
      const top = limit ? null : P.largest(values);
      const value = limit && !fixed ? (row) => values[row] / (limit[row] || Infinity) : (row) => values[row] / (fixed || top || 1);
      return { value, fixed, top };
    };
    modes.push({ id: name, title, unit: unit(name), bad: name !== "feed", make });
  };
  const kinds = (name, title, words) => {
    if (has(name) && words.length) modes.push({ id: name, title, kinds: words, make: () => ({ value: ((values) => (row) => values[row])(column(name)) }) });
  };
  share("deviation", "tip deviation", () => column("tolerance") || P.m.tolerance);
  share("axis_deviation", "axis deviation", () => P.m.axis_limits || P.m.turn);
  share("contour", "contour error", () => P.m.tolerance);
  // The nearer, the worse: as a share of what is to be kept, or of the nearest approach where that is farther.
  if (has("clearance")) {
    const make = () => {
      const values = column("clearance");
      const near = Math.max(values.reduce((least, value) => (value < least ? value : least), Infinity), meta.clearance.keep, 1e-3);
      return { value: (row) => near / Math.max(values[row], 1e-3), near, top: null };
    };
    modes.push({ id: "clearance", title: "clearance", unit: "mm", bad: true, make });
  }
  share("chip", "volume cut");
  share("cut_depth", "depth of cut");
  share("cut_width", "width of cut");
  share("feed", "feed");
  kinds("limit", "what limits the feed", meta.limits);
  kinds("kind", "kind of block", P.KINDS);
  kinds("reason", "why the block is there", P.REASONS);
  if (!modes.length) modes.push({ id: "plain", title: "path", make: () => ({ value: () => 0 }) });
  P.colour.modes = modes;
};

// The way in use.
P.colour.mode = () => {
  const mode = P.colour.modes[P.state.colour];
  return mode.value ? mode : Object.assign(mode, mode.make());
};
