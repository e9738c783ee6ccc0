// A million points fit into half a gigabyte, and fewer into so much less: a fifth of them, and all with POST_ROUNDS=1.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Post } from "../js/module.mjs";
import { module } from "./common.mjs";
import { long } from "./long.mjs";

const POINTS = process.env.POST_ROUNDS ? 1_000_000 : 200_000;

/** Memory of the module at most, bytes: 500 MB for a million points, 30 MB of it whatever the file (stack, tables, machine). */
const MOST = 30e6 + 470 * POINTS;

test("many points, read back and with a report", async () => {
  const post = await Post.of(await WebAssembly.compile(readFileSync(module)));
  post.put("part.cls", long(POINTS));
  const line = "--machine ac-trunnion part.cls -o part.nc --report part.html --verify --tool-length 100";
  const ran = post.run(line.split(" "));
  assert.equal(ran.code, 0, JSON.stringify(ran.findings).slice(0, 2000));
  const [, length] = post.files().find(([name]) => name === "part.nc");
  console.log(`${POINTS} points: a program of ${(length / 1e6).toFixed(0)} MB, memory ${(post.memory / 1e6).toFixed(0)} MB`);
  assert.ok(length > 40 * POINTS && post.memory <= MOST, `${post.memory} bytes`);
});
