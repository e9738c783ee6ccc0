// The npm package as its users call it.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import * as post from "../out/package/index.mjs";
import { root } from "./common.mjs";
import { long } from "./long.mjs";

const blade = readFileSync(path.join(root, "tests/samples/blade.cls"), "utf8");
const trunnion = readFileSync(path.join(root, "machines/ac-trunnion.toml"), "utf8");
const text = (bytes) => new TextDecoder().decode(bytes);

test("a CL file becomes a program, which is held against it", async () => {
  const made = await post.post(blade, "ac-trunnion", { toolLength: 100, report: true });
  assert.equal(made.code, 0, JSON.stringify(made.findings));
  assert.match(text(made.program), /^%?/);
  assert.ok(made.summary.tip_deviation_mm.value <= 0.01);
  assert.match(made.report, /^<!doctype html>/);
  const held = await post.verify(made.program, blade, "ac-trunnion", { toolLength: 100 });
  assert.ok(held.ok, JSON.stringify(held.findings));
  const moved = text(made.program).replace(/X(-?[\d.]+)/g, (_, x) => `X${(Number(x) + 0.5).toFixed(3)}`);
  const wrong = await post.verify(moved, blade, "ac-trunnion", { toolLength: 100 });
  assert.equal(wrong.code, 1);
  assert.ok(wrong.findings.some(({ severity, line }) => severity === "error" && line > 0), JSON.stringify(wrong.findings));
  const looked = await post.lint(made.program, "ac-trunnion", { toolLength: 100 });
  assert.equal(looked.summary.machine, "AC trunnion");
  const read = await post.read(made.program, "ac-trunnion", { toolLength: 100 });
  assert.ok(read.printed.includes("blocks"), read.printed);
});

test("a machine is a text too, and its faults have their line", async () => {
  const own = await post.post(blade, trunnion, { tool_length: 100 });
  const named = await post.post(blade, "ac-trunnion", { tool_length: 100 });
  assert.equal(text(own.program), text(named.program));
  const slip = await post.check(trunnion.replace("[workpiece]", "[workpeice]"));
  assert.equal(slip.code, 1);
  const [finding] = slip.findings.filter(({ severity }) => severity === "error");
  assert.equal(finding.file, "machine.toml");
  assert.match(trunnion.replace("[workpiece]", "[workpeice]").split("\n")[finding.line - 1], /workpeice/);
  const good = await post.check("ac-trunnion");
  assert.ok(good.ok && good.summary !== null);
});

test("what is refused leaves no program, and says why", async () => {
  const far = await post.post(blade.replace(/GOTO\/ *(-?[\d.]+)/g, "GOTO/90000"), "ac-trunnion", { toolLength: 100 });
  assert.deepEqual([far.ok, far.program, far.summary], [false, null, null]);
  assert.ok(far.findings.some(({ code }) => code === "over-travel"), JSON.stringify(far.findings.slice(0, 2)));
  const wrong = await post.run(["--machine", "ac-trunnion", "--no-such-flag", "part.cls"], { "part.cls": blade });
  assert.equal(wrong.code, 2);
  assert.match(wrong.said, /--no-such-flag/);
  const none = await post.run(["--machine", "ac-trunnion", "part.cls"]);
  assert.equal(none.code, 1);
  assert.match(none.findings[0].message, /part\.cls/);
});

test("options are words of the command line", () => {
  const told = { toolLength: 100, mount: [0, 0, -5], set: ["Lm=3", "a.b=4"], plan: true, tcp: undefined, quiet: false };
  assert.deepEqual(post.words(told), ["--tool-length=100", "--mount=0,0,-5", "--set=Lm=3", "--set=a.b=4", "--plan"]);
});

test("any verb runs on files in memory", async () => {
  const files = { "part.cls": blade };
  const { code, printed, files: there } = await post.run(["-m", "ac-trunnion", "part.cls", "-o", "-", "--tool-length", "100"], files);
  assert.equal(code, 0);
  const named = await post.run(["-m", "ac-trunnion", "part.cls", "--tool-length", "100"], files);
  const [program] = Object.keys(named.files).filter((name) => name !== "part.cls");
  assert.equal(text(named.files[program]), printed);
  assert.deepEqual(Object.keys(there), ["part.cls"]);
  const help = await post.run(["--help"]);
  assert.ok(help.code === 0 && help.printed.includes("Usage"));
  const version = await post.run(["--version"]);
  assert.match(version.printed, /^post \d/);
  assert.ok((await post.schema()).properties.chain);
  const listed = await post.run(["machines"]);
  assert.ok(listed.printed.includes("ac-trunnion"));
  const predicted = await post.run(["predict", program, "-m", "ac-trunnion", "--tool-length", "100"], named.files);
  assert.equal(predicted.code, 0, JSON.stringify(predicted.findings));
});

test("a verb that needs a system is refused", async () => {
  for (const line of ["batch part.cls", "lsp", "view part.cls", "plugin test fanuc"]) {
    const { code, findings } = await post.run(line.split(" "), { "part.cls": blade });
    assert.equal(code, 1);
    assert.match(findings[0].message, /needs threads/);
  }
});

test("reading is told as it goes", async () => {
  const seen = [];
  const made = await post.post(long(20_000), "ac-trunnion", { toolLength: 100, progress: (done, of) => seen.push([done, of]) });
  assert.ok(made.ok, JSON.stringify(made.findings));
  assert.ok(seen.length > 0 && seen.every(([done, of]) => done <= of), JSON.stringify(seen));
});
