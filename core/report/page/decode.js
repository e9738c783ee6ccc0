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
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
};

// The chunks of all parts, by name. The elements go once they are read: their letters would lie in memory twice.
P.chunks = (root) => {
  const chunks = new Map();
  for (const element of root.querySelectorAll("script.part")) {
    const { name } = element.dataset;
    if (!chunks.has(name)) chunks.set(name, []);
    chunks.get(name).push(P.bytesOfBase64(element.textContent));
    element.remove();
  }
  return chunks;
};

// The first place of so many for which it holds, where it holds for all behind; their number where it never does.
P.first = (count, holds) => {
  let low = 0;
  for (let high = count; low < high; ) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
};

P.uint32 = (bytes, at) => (bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16)) + bytes[at + 3] * 16777216;

// Values of a column of a chunk that begins at `at`, into `out` from `start`; where the next column begins.
P.integers = (bytes, at, rows, out, start, scale = 1) => {
  const order = bytes[at] & 15;
  const planes = bytes[at + 1];
  const steps = (bytes[at] & 16) !== 0;
  const first = at + (steps ? 14 : 2);
  const base = steps ? new DataView(bytes.buffer, bytes.byteOffset).getFloat64(at + 2, true) : 0;
  const step = steps ? P.uint32(bytes, at + 10) : 1;
  let last = 0;
  let slope = 0;
  if (!planes) out.fill(base / scale, start, start + rows);
  for (let row = 0; planes && row < rows; row++) {
    let folded = 0;
    for (let plane = planes - 1; plane >= 0; plane--) folded = folded * 256 + bytes[first + plane * rows + row];
    const half = planes < 4 ? folded >> 1 : Math.floor(folded / 2);
    const difference = folded > 2 * half ? -half - 1 : half;
    if (order === 0) last = difference;
    else if (order === 1) last += difference;
    else {
      slope += difference;
      last += slope;
    }
    out[start + row] = (base + step * last) / scale;
  }
  return P.behind(bytes, at, rows);
};

// Where a column ends.
P.behind = (bytes, at, rows) => at + (bytes[at] & 16 ? 14 : 2) + bytes[at + 1] * rows;

// The columns that are unpacked whole: the last so many; what is asked for again is unpacked again.
P.held = [];
P.release = (kept, pick = () => true) => {
  for (let at = P.held.length; at-- > kept; ) if (pick(P.held[at].name)) P.held.splice(at, 1)[0].whole = null;
};

// A column whose values are unpacked when somebody asks for them: all, or those about a row.
P.Column = class {
  constructor({ from, name, unit, decimals }, rows, pieces, owner) {
    Object.assign(this, { owner, from, name, unit, decimals, rows, pieces, whole: null });
  }

  get values() {
    return this.part();
  }

  // The value of one row; what follows from the rows before is there whole.
  at(row) {
    return ["t1", "way", "lines"].includes(this.from) ? this.values[row] : this.part(row >> 6)[row & 63];
  }

  // All values, or those of sixty-four rows.
  part(place) {
    const { owner, from, whole } = this;
    if (whole) return place === undefined ? whole : whole.subarray(place * 64, place * 64 + 64);
    if (from) P.derive[from](owner.report, owner.columns, place);
    else this.keep(this.packed(place), place);
    return place === undefined ? this.whole : this.few;
  }

  keep(values, place) {
    if (place !== undefined) return (this.few = values);
    this.whole = values;
    P.held.unshift(this);
    return P.release(16);
  }

  // What is packed, unpacked: all, or sixty-four rows. Of the last chunk all is kept, as its neighbours will be wanted.
  packed(place) {
    const { pieces, decimals } = this;
    const unpack = (values, piece, start) => P.integers(piece.bytes, piece.at, piece.rows, values, start, 10 ** decimals);
    const room = (rows) => new (decimals ? Float64Array : Int32Array)(rows);
    if (place === undefined) {
      const values = room(this.rows);
      let start = 0;
      for (const piece of pieces) {
        unpack(values, piece, start);
        start += piece.rows;
      }
      return values;
    }
    const size = pieces[0].rows;
    const piece = pieces[Math.floor((place * 64) / size)];
    if (this.piece !== piece) {
      this.near ??= room(size);
      unpack(this.near, piece, 0);
      this.piece = piece;
    }
    const start = (place * 64) % size;
    return this.near.slice(start, Math.min(start + 64, piece.rows));
  }
};

P.table = (meta, chunks, report) => {
  const pieces = meta.columns.map(() => []);
  let sum = 0;
  for (const packed of chunks) {
    const bytes = P.inflate(packed);
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
  for (let i = 0; i < count; i++) {
    const length = reader.word();
    const pieces = [];
    let from = reader.at;
    for (let at = reader.at; at < reader.at + length; at++) {
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
  for (const { pieces, places } of templates) for (let i = 1; i < pieces.length; i++) places.push(reader.word());
  const order = reader.integers(lines);
  for (let i = 0; i < columns.length; i++) {
    const rows = reader.word();
    const form = bytes[reader.at];
    reader.at++;
    const digits = reader.integers(rows);
    columns[i] = { form, digits, each: form >= 64 ? reader.integers(rows) : null, row: 0 };
  }
  if (reader.at !== bytes.length) throw new Error("A text of the report is damaged.");
  let out = new Uint8Array(lines * 48 + 1024);
  let at = 0;
  for (const place of order) {
    const { pieces, places } = templates[place];
    for (let i = 0; i < pieces.length; i++) {
      const piece = pieces[i];
      out = P.roomy(out, at + piece.length + 40);
      for (let letter = 0; letter < piece.length; letter++) out[at++] = piece[letter];
      if (i === places.length) continue;
      const column = columns[places[i]];
      const { form, digits, each, row } = column;
      column.row++;
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
      this.lines += P.uint32(P.inflate(bytes, 4), 0);
    }
    if (this.lines !== meta.lines) throw new Error(`The text ${meta.name} is damaged.`);
    this.recent = new Map();
  }

  // The bytes of a chunk, as they stand in the file.
  bytesOf(chunk) {
    const bytes = P.inflate(this.chunks[chunk]);
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
    const chunk = P.first(this.starts.length, (at) => this.starts[at] > index) - 1;
    const line = this.linesOf(chunk)[index - this.starts[chunk]];
    return line.endsWith("\r") ? line.slice(0, -1) : line;
  }

  // The whole text, as it stands in the file.
  async whole() {
    return new Uint8Array(await new Blob(this.chunks.map((_, chunk) => this.bytesOf(chunk))).arrayBuffer());
  }
};

// What the document holds: { meta, tables, texts }.
P.load = async () => {
  const chunks = P.chunks(document);
  const bytes = chunks.get("meta");
  if (!bytes) throw new Error("The report is cut off: its file is not whole.");
  const meta = JSON.parse(new TextDecoder().decode(P.inflate(bytes[0])));
  if (meta.format !== P.FORMAT) throw new Error(`The report has format ${meta.format}, and this page reads ${P.FORMAT}.`);
  const report = { meta, tables: {}, texts: {} };
  for (const table of meta.tables) report.tables[table.name] = P.table(table, chunks.get(table.name) || [], report);
  for (const text of meta.texts) report.texts[text.name] = new P.Text(text, chunks.get(`text.${text.name}`) || []);
  // What is predicted of the blocks stands beside them, and for their times.
  const { blocks, predicted } = report.tables;
  if (predicted) for (const [name, column] of predicted.columns) blocks.columns.set(name, column);
  // How near bodies come on a line of the program, and what it cuts, stands beside its blocks.
  const { clearance } = report.tables;
  if (clearance) {
    const owner = { report, columns: blocks.columns };
    for (const [name, { unit, decimals }] of clearance.columns) if (name !== "nc") blocks.columns.set(name, new P.Column({ from: "lines", name, unit, decimals }, blocks.rows, [], owner));
  }
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
