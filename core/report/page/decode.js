// Bytes become tables and texts: what core/report packs, and nothing else.
//
// A part is base64 of raw deflate. A chunk of a table is its number of rows (32 bits, least byte first), then its columns; a
// column is the order of its differences (0, 1, 2), its number of byte planes, and the planes, the least bytes first; where the
// order has 16 more, a first value (64 bits, float) and a step (32 bits) ahead of the planes, which are multiples of it.
// Folded signs: 0, 1, 2, 3, … are 0, -1, 1, -2, … A value is the integer over ten to the power of its decimals.
const P = {};

// The format that this page reads.
P.FORMAT = 1;

P.bytesOfBase64 = (text) => {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i += 1) bytes[i] = letters.charCodeAt(i);
  return bytes;
};

P.inflate = async (bytes) => {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
};

// The chunks of all parts, by name, inflated. The elements go once they are read: their letters would lie in memory twice.
P.chunks = async (root) => {
  const chunks = new Map();
  const work = [];
  for (const element of root.querySelectorAll("script.part")) {
    const name = element.dataset.name;
    if (!chunks.has(name)) chunks.set(name, []);
    const list = chunks.get(name);
    const index = list.push(null) - 1;
    work.push(P.inflate(P.bytesOfBase64(element.textContent)).then((bytes) => { list[index] = bytes; }));
    element.remove();
  }
  await Promise.all(work);
  return chunks;
};

P.uint32 = (bytes, at) => (bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16)) + bytes[at + 3] * 16777216;

// Integers of a column of a chunk that begins at `at`, into `out` from `start`; where the next column begins.
P.integers = (bytes, at, rows, out, start) => {
  const order = bytes[at] & 15;
  const planes = bytes[at + 1];
  const steps = (bytes[at] & 16) !== 0;
  const first = at + (steps ? 14 : 2);
  const base = steps ? new DataView(bytes.buffer, bytes.byteOffset).getFloat64(at + 2, true) : 0;
  const step = steps ? P.uint32(bytes, at + 10) : 1;
  let last = 0;
  let slope = 0;
  for (let row = 0; row < rows; row += 1) {
    let folded = 0;
    let weight = 1;
    for (let plane = 0; plane < planes; plane += 1) {
      folded += bytes[first + plane * rows + row] * weight;
      weight *= 256;
    }
    const odd = folded % 2;
    const difference = odd ? -(folded + 1) / 2 : folded / 2;
    if (order === 0) last = difference;
    else if (order === 1) last += difference;
    else {
      slope += difference;
      last += slope;
    }
    out[start + row] = base + step * last;
  }
  return P.behind(bytes, at, rows);
};

// Where a column ends.
P.behind = (bytes, at, rows) => at + (bytes[at] & 16 ? 14 : 2) + bytes[at + 1] * rows;

// The tip (mm, part frame) and the tool axis by the chain, from axis values as the control shows them: one product from the
// workpiece to the tool, as core/machine has it. Into `pose`: x, y, z, i, j, k. With `slides` the linear axes stand at zero,
// and their ways follow behind, the last axis first.
P.poser = ({ axes, mount, gauge, tool_axis }) => {
  const all = new Float64Array(6 + axes.length * 3);
  return (value, length, pose, slides) => {
    let end = 6;
    for (let at = 0; at < 3; at++) {
      all[at] = gauge[at] - tool_axis[at] * length;
      all[at + 3] = tool_axis[at];
    }
    for (let place = axes.length - 1; place >= 0; place--) {
      const { kind, direction, point, zero } = axes[place];
      const [a, b, c] = direction;
      if (kind !== "rotary") {
        const q = slides ? 0 : value(place) - zero;
        for (let at = 0; at < 3; at++) {
          all[at] += direction[at] * q;
          if (slides) all[end++] = direction[at];
        }
        continue;
      }
      const q = ((value(place) - zero) * Math.PI) / 180;
      const sine = Math.sin(q);
      const cosine = Math.cos(q);
      for (let at = 0; at < 3; at++) all[at] -= point[at];
      for (let at = 0; at < end; at += 3) {
        const u = all[at];
        const v = all[at + 1];
        const w = all[at + 2];
        const along = (a * u + b * v + c * w) * (1 - cosine);
        all[at] = u * cosine + (b * w - c * v) * sine + a * along;
        all[at + 1] = v * cosine + (c * u - a * w) * sine + b * along;
        all[at + 2] = w * cosine + (a * v - b * u) * sine + c * along;
      }
      for (let at = 0; at < 3; at++) all[at] += point[at];
    }
    for (let at = 0; at < end; at++) pose[at] = all[at] - (at < 3 ? mount[at][3] : 0);
  };
};

// Columns that are told against what follows from others, so that only what is left of them is packed: the sum is what Rust
// has told, to its last decimal.
P.derive = {
  // Tip and tool axis, told against the chain; or the tool axis alone, which the rotary axes turn.
  chain: ({ meta }, columns) => {
    const { machine } = meta;
    const bare = columns.get("tip.x").from !== "chain";
    const names = ["tip.x", "tip.y", "tip.z", "axis.i", "axis.j", "axis.k"];
    const axes = machine.axes.map(({ name, kind }) => (bare && kind !== "rotary" ? null : columns.get(`q.${name}`).values));
    const lengths = columns.get("tool_length").values;
    const values = names.map((name, at) => (bare && at < 3 ? null : columns.get(name).packed()));
    const pose = new Float64Array(6 + machine.axes.length * 3);
    const into = P.poser(machine);
    let row = 0;
    const value = (place) => axes[place][row];
    for (; row < lengths.length; row++) {
      into(value, lengths[row], pose, bare);
      for (let name = bare ? 3 : 0; name < 6; name++) values[name][row] += pose[name];
    }
    values.forEach((told, at) => told && (columns.get(names[at]).unpacked = told));
  },
  // The linear axes, told against those that bring the tip where it is, the rotary axes being as they are.
  tips: ({ meta }, columns) => {
    const { machine } = meta;
    const axes = machine.axes.map(({ name, kind }) => (kind === "rotary" ? columns.get(`q.${name}`).values : null));
    const slides = machine.axes.filter(({ kind }) => kind !== "rotary").reverse();
    const told = slides.map(({ name }) => columns.get(`q.${name}`).packed());
    const lengths = columns.get("tool_length").values;
    const [x, y, z] = ["tip.x", "tip.y", "tip.z"].map((name) => columns.get(name).values);
    const m = new Float64Array(15);
    const far = new Float64Array(3);
    const into = P.poser(machine);
    let row = 0;
    const value = (place) => axes[place][row];
    // The volume of three of the vectors in m; one of them may be the way that is left.
    const volume = (a, p, b, q, c, r) => a[p] * (b[q + 1] * c[r + 2] - b[q + 2] * c[r + 1]) + a[p + 1] * (b[q + 2] * c[r] - b[q] * c[r + 2]) + a[p + 2] * (b[q] * c[r + 1] - b[q + 1] * c[r]);
    for (; row < lengths.length; row++) {
      into(value, lengths[row], m, true);
      far[0] = x[row] - m[0];
      far[1] = y[row] - m[1];
      far[2] = z[row] - m[2];
      const whole = volume(m, 6, m, 9, m, 12);
      if (Math.abs(whole) < 1e-3) continue;
      told[0][row] += volume(far, 0, m, 9, m, 12) / whole + slides[0].zero;
      told[1][row] += volume(m, 6, far, 0, m, 12) / whole + slides[1].zero;
      told[2][row] += volume(m, 6, m, 9, far, 0) / whole + slides[2].zero;
    }
    slides.forEach(({ name }, at) => { columns.get(`q.${name}`).unpacked = told[at]; });
  },
  // Points of the CL path, told against the tip of the last of the next blocks that come from the same line.
  blocks: (report, columns) => {
    const { rows, columns: of } = report.tables.blocks;
    const lines = columns.get("line").values;
    const from = of.get("cl").values;
    const names = ["x", "y", "z"];
    const tips = names.map((name) => of.get(`tip.${name}`).values);
    const values = names.map((name) => columns.get(name).packed());
    let block = 0;
    for (let point = 0; rows && point < lines.length; point++) {
      const line = lines[point];
      if (point === 0 || line !== lines[point - 1]) {
        let found = block;
        while (found < rows && found < block + 64 && from[found] !== line) found++;
        if (from[found] === line && found < block + 64) {
          while (found + 1 < rows && from[found + 1] === line) found++;
          block = found;
        }
      }
      for (let at = 0; at < 3; at++) values[at][point] += tips[at][block];
    }
    names.forEach((name, at) => { columns.get(name).unpacked = values[at]; });
  },
  // The beginning of a block, told against the end of the one before.
  t1: (report, columns) => {
    const ends = columns.get("t1").values;
    const values = columns.get("t0").packed();
    for (let row = 1; row < values.length; row += 1) values[row] += ends[row - 1];
    columns.get("t0").unpacked = values;
  },
  // The end of a block, told against that of the one before and what a straight way takes at the feed.
  way: (report, columns) => {
    const [x, y, z, feed] = ["tip.x", "tip.y", "tip.z", "feed"].map((name) => columns.get(name).values);
    const values = columns.get("t1").packed();
    for (let row = 0; row < values.length; row++) {
      const from = row ? row - 1 : 0;
      const way = row ? Math.sqrt((x[row] - x[from]) ** 2 + (y[row] - y[from]) ** 2 + (z[row] - z[from]) ** 2) : Math.hypot(x[0], y[0], z[0]);
      values[row] += (row ? values[row - 1] : 0) + (feed[row] > 0 ? (60 * way) / feed[row] : 0);
    }
    columns.get("t1").unpacked = values;
  },
  // Places of a block, told against even steps from tip to tip.
  tip: (report, columns) => {
    const blocks = report.tables.blocks.columns;
    const rows = columns.get("row").values;
    for (const name of ["x", "y", "z"]) {
      const tips = blocks.get(`tip.${name}`).values;
      const values = columns.get(name).packed();
      let first = 0;
      while (first < rows.length) {
        const row = rows[first];
        let end = first + 1;
        while (end < rows.length && rows[end] === row) end += 1;
        const to = tips[row];
        const from = row > 0 ? tips[row - 1] : to;
        for (let place = first; place < end; place += 1) values[place] += from + (to - from) * ((place - first + 1) / (end - first));
        first = end;
      }
      columns.get(name).unpacked = values;
    }
  },
};

// A column whose values are unpacked when somebody asks for them first.
P.Column = class {
  constructor(meta, rows, pieces, owner) {
    this.owner = owner;
    this.from = meta.from;
    this.name = meta.name;
    this.unit = meta.unit;
    this.decimals = meta.decimals;
    this.rows = rows;
    this.pieces = pieces;
    this.unpacked = null;
  }

  get values() {
    if (!this.unpacked) {
      if (this.from) P.derive[this.from](this.owner.report, this.owner.columns);
      else this.unpacked = this.packed();
    }
    return this.unpacked;
  }

  // What is packed, unpacked.
  packed() {
    const values = new Float64Array(this.rows);
    let start = 0;
    for (const piece of this.pieces) {
      P.integers(piece.bytes, piece.at, piece.rows, values, start);
      start += piece.rows;
    }
    this.pieces = null;
    if (this.decimals === 0) return Int32Array.from(values);
    const scale = 10 ** this.decimals;
    for (let row = 0; row < values.length; row += 1) values[row] /= scale;
    return values;
  }
};

P.table = (meta, chunks, report) => {
  const pieces = meta.columns.map(() => []);
  let sum = 0;
  for (const bytes of chunks) {
    const rows = P.uint32(bytes, 0);
    let at = 4;
    for (const column of pieces) {
      column.push({ bytes, at, rows });
      at = P.behind(bytes, at, rows);
    }
    if (at !== bytes.length) throw new Error(`The table ${meta.name} is damaged.`);
    sum += rows;
  }
  if (sum !== meta.rows) throw new Error(`The table ${meta.name} has ${sum} rows, and should have ${meta.rows}.`);
  const columns = new Map();
  const owner = { report, columns };
  meta.columns.forEach((column, index) => columns.set(column.name, new P.Column(column, sum, pieces[index], owner)));
  return { name: meta.name, rows: sum, columns };
};

// Columns of integers one behind the other: the next moves `at` behind it.
P.Reader = class {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at;
  }

  word() {
    this.at += 4;
    return P.uint32(this.bytes, this.at - 4);
  }

  integers(rows) {
    const values = new Float64Array(rows);
    this.at = P.integers(this.bytes, this.at, rows, values, 0);
    return values;
  }
};

// Writes a number as its column does into `out` from `at`: `digits` over ten to the power of `most`, with `wanted`
// decimals; below 0: without zeros at its end. Answers where it ends.
P.number = (out, at, digits, most, wanted) => {
  let rest = Math.abs(digits);
  let end = at;
  if (digits < 0) out[end++] = 45;
  let count = 1;
  for (let power = 10; power <= rest; power *= 10) count++;
  const whole = Math.max(count - most, 1);
  const last = end + whole + (most ? most : -1);
  for (let place = last; place >= end; place--) {
    if (most && place === end + whole) {
      out[place] = 46;
      continue;
    }
    const tenth = Math.floor(rest / 10);
    out[place] = 48 + rest - tenth * 10;
    rest = tenth;
  }
  if (!most) return last + 1;
  let kept = wanted;
  if (wanted < 0) for (kept = most; kept && out[end + whole + kept] === 48;) kept--;
  return end + whole + (kept ? kept + 1 : 0);
};

// The bytes of a chunk of lines that was packed as templates, which core/report/src/template.rs explains.
P.ofTemplates = (bytes, start, lines) => {
  const reader = new P.Reader(bytes, start);
  const count = reader.word();
  const templates = [];
  for (let i = 0; i < count; i += 1) {
    const length = reader.word();
    const pieces = [];
    let from = reader.at;
    for (let at = reader.at; at < reader.at + length; at += 1) {
      if (bytes[at] === 0) {
        pieces.push(bytes.subarray(from, at));
        from = at + 1;
      }
    }
    pieces.push(bytes.subarray(from, reader.at + length));
    reader.at += length;
    templates.push({ pieces, places: [] });
  }
  const columns = Array.from({ length: reader.word() });
  for (const { pieces, places } of templates) for (let i = 1; i < pieces.length; i += 1) places.push(reader.word());
  const order = reader.integers(lines);
  for (let i = 0; i < columns.length; i += 1) {
    const rows = reader.word();
    const form = bytes[reader.at];
    reader.at += 1;
    const digits = reader.integers(rows);
    columns[i] = { form, digits, each: form >= 64 ? reader.integers(rows) : null, row: 0 };
  }
  if (reader.at !== bytes.length) throw new Error("A text of the report is damaged.");
  let out = new Uint8Array(lines * 48 + 1024);
  let at = 0;
  const room = (more) => {
    if (at + more <= out.length) return;
    const larger = new Uint8Array(2 * (at + more));
    larger.set(out);
    out = larger;
  };
  for (const place of order) {
    const { pieces, places } = templates[place];
    for (let i = 0; i < pieces.length; i += 1) {
      const piece = pieces[i];
      room(piece.length + 40);
      for (let letter = 0; letter < piece.length; letter++) out[at++] = piece[letter];
      if (i === places.length) continue;
      const column = columns[places[i]];
      const { form, digits, each, row } = column;
      column.row += 1;
      const most = form % 32;
      at = P.number(out, at, digits[row], most, each ? each[row] : form >= 32 ? -1 : most);
    }
  }
  return out.subarray(0, at);
};

// A text, chunk by chunk: the number of its lines (32 bits), how it is packed (0: as it is, 1: templates), and what is packed.
P.Text = class {
  constructor(meta, chunks) {
    this.name = meta.name;
    this.chunks = chunks;
    this.starts = [];
    this.lines = 0;
    for (const bytes of chunks) {
      this.starts.push(this.lines);
      this.lines += P.uint32(bytes, 0);
    }
    if (this.lines !== meta.lines) throw new Error(`The text ${meta.name} is damaged.`);
    this.recent = new Map();
  }

  // The bytes of a chunk, as they stand in the file.
  bytesOf(chunk) {
    const bytes = this.chunks[chunk];
    return bytes[4] === 1 ? P.ofTemplates(bytes, 5, P.uint32(bytes, 0)) : bytes.subarray(5);
  }

  // The lines of a chunk; those of the last few are kept.
  linesOf(chunk) {
    let lines = this.recent.get(chunk);
    if (!lines) {
      const bytes = this.bytesOf(chunk);
      let text;
      try {
        text = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
      } catch {
        text = new TextDecoder("windows-1252").decode(bytes);
      }
      lines = text.split("\n");
      if (lines[lines.length - 1] === "") lines.pop();
      if (this.recent.size >= 8) this.recent.delete(this.recent.keys().next().value);
      this.recent.set(chunk, lines);
    }
    return lines;
  }

  // Line `index`, counted from 0, without its end.
  line(index) {
    if (index < 0 || index >= this.lines) return "";
    let low = 0;
    let high = this.starts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.starts[middle] <= index) low = middle;
      else high = middle - 1;
    }
    const line = this.linesOf(low)[index - this.starts[low]];
    return line.endsWith("\r") ? line.slice(0, -1) : line;
  }

  // The whole text, as it stands in the file.
  async whole() {
    return new Uint8Array(await new Blob(this.chunks.map((_, chunk) => this.bytesOf(chunk))).arrayBuffer());
  }
};

// What the document holds: { meta, tables, texts }.
P.load = async () => {
  if (typeof DecompressionStream === "undefined") throw new Error("This browser is too old for the report: it cannot unpack it.");
  const chunks = await P.chunks(document);
  const bytes = chunks.get("meta");
  if (!bytes) throw new Error("The report is cut off: its file is not whole.");
  const meta = JSON.parse(new TextDecoder().decode(bytes[0]));
  if (meta.format !== P.FORMAT) throw new Error(`The report has format ${meta.format}, and this page reads ${P.FORMAT}.`);
  const report = { meta, tables: {}, texts: {} };
  for (const table of meta.tables) report.tables[table.name] = P.table(table, chunks.get(table.name) || [], report);
  for (const text of meta.texts) report.texts[text.name] = new P.Text(text, chunks.get(`text.${text.name}`) || []);
  // What is predicted of the blocks stands beside them, and for their times.
  const { blocks, predicted } = report.tables;
  if (predicted) for (const [name, column] of predicted.columns) blocks.columns.set(name, column);
  P.check(report);
  return report;
};

// The chain of this page must be that of Rust: what follows from it is shown as if Rust had told it.
P.check = ({ meta }) => {
  const pose = new Float64Array(6);
  for (const check of meta.checks) {
    P.poser(meta.machine)((place) => check.joints[place], check.tool_length, pose);
    const far = [...check.tip, ...check.axis].some((value, place) => !(Math.abs(value - pose[place]) < 1e-6));
    if (far) throw new Error(`The chain of the page is not that of the machine: row ${check.row}.`);
  }
};
