// Raw deflate (RFC 1951), at once: what is asked for is there when it is shown. Of a chunk no more than `most` bytes.
P.inflate = (bytes, most = Infinity) => {
  let out = new Uint8Array(most < 9 ? 1024 : bytes.length * 8 + 1024);
  let end = 0;
  let at = 0;
  let held = 0;
  let count = 0;
  const damaged = () => {
    throw new Error("The report is damaged.");
  };
  const fill = (wanted) => {
    if (at > bytes.length + 8) damaged();
    for (; count < wanted; count += 8) held |= bytes[at++] << count;
  };
  const bits = (wanted) => {
    fill(wanted);
    const value = held & ((1 << wanted) - 1);
    held >>>= wanted;
    count -= wanted;
    return value;
  };
  // Codes by the bits that follow: sixteen times the symbol, and how long its code is.
  const codes = (lengths) => {
    const table = new Uint16Array(1 << Math.max(...lengths));
    let code = 0;
    for (let length = 1; 1 << length <= table.length; length++, code *= 2) {
      for (let symbol = 0; symbol < lengths.length; symbol++) {
        if (lengths[symbol] !== length) continue;
        let turned = 0;
        for (let bit = 0; bit < length; bit++) turned = (turned << 1) | ((code >> bit) & 1);
        for (; turned < table.length; turned += 1 << length) table[turned] = (symbol << 4) | length;
        code++;
      }
    }
    return table;
  };
  const symbol = (table) => {
    fill(15);
    const found = table[held & (table.length - 1)] || damaged();
    held >>>= found & 15;
    count -= found & 15;
    return found >> 4;
  };
  for (let last = 0; !last && end < most; ) {
    last = bits(1);
    const kind = bits(2);
    if (kind === 0) {
      at -= count >> 3;
      const length = bytes[at] | (bytes[at + 1] << 8);
      out = P.roomy(out, end + length);
      out.set(bytes.subarray(at + 4, at + 4 + length), end);
      end += length;
      at += 4 + length;
      held = count = 0;
      continue;
    }
    let lengths = Array.from({ length: 288 }, (_, at) => (at < 144 || at > 279 ? 8 : at < 256 ? 9 : 7));
    let ways = Array(30).fill(5);
    if (kind === 2) {
      const sizes = [bits(5) + 257, bits(5) + 1];
      const few = Array(19).fill(0);
      for (let place = 0, more = bits(4) + 4; place < more; place++) few[[16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15][place]] = bits(3);
      const table = codes(few);
      const all = [];
      while (all.length < sizes[0] + sizes[1]) {
        const next = symbol(table);
        if (next < 16) all.push(next);
        else for (let more = next === 16 ? bits(2) + 3 : next === 17 ? bits(3) + 3 : bits(7) + 11, same = next === 16 ? all.at(-1) : 0; more--; ) all.push(same);
      }
      lengths = all.slice(0, sizes[0]);
      ways = all.slice(sizes[0]);
    }
    const [letters, back] = [lengths, ways].map(codes);
    while (end < most) {
      const next = symbol(letters);
      if (next === 256) break;
      out = P.roomy(out, end + 258);
      if (next < 256) {
        out[end++] = next;
        continue;
      }
      // Lengths and ways grow by powers of two, four lengths and two ways each.
      const more = next < 265 || next > 284 ? 0 : (next - 261) >> 2;
      let length = bits(more) + (next > 284 ? 258 : more ? ((4 + ((next - 261) & 3)) << more) + 3 : next - 254);
      const far = symbol(back);
      const extra = far < 4 ? 0 : (far >> 1) - 1;
      const way = 1 + (extra ? (2 + (far & 1)) << extra : far) + bits(extra);
      for (; length--; end++) out[end] = out[end - way];
    }
  }
  return out.slice(0, end);
};

// Bytes with room for `size`: larger ones where they are too few.
P.roomy = (bytes, size) => {
  if (size <= bytes.length) return bytes;
  const larger = new Uint8Array(2 * size);
  larger.set(bytes);
  return larger;
};
