// A long CL file: the last cut of the blade, gone to and fro.

import { readFileSync } from "node:fs";
import path from "node:path";

import { root } from "./common.mjs";

/** The blade with so many points more. */
export function long(points) {
  const lines = readFileSync(path.join(root, "tests/samples/blade.cls"), "utf8").split("\n");
  const cut = lines.findLastIndex((line, index) => line.startsWith("GOTO") && lines[index - 1].startsWith("GOTO"));
  const [from, to] = [lines[cut - 1], lines[cut]];
  const more = Array.from({ length: points }, (_, index) => (index % 2 === 0 ? from : to));
  return [...lines.slice(0, cut + 1), ...more, ...lines.slice(cut + 1)].join("\n");
}
