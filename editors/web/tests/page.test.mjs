// The page in a real browser: what its buttons do, and that nothing is asked of the network.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { browser, page, root } from "./common.mjs";
import { long } from "./long.mjs";

const value = (id) => `document.getElementById(${JSON.stringify(id)}).value`;
const text = (id) => `document.getElementById(${JSON.stringify(id)}).textContent`;
const click = (id) => `document.getElementById(${JSON.stringify(id)}).click()`;

/** Drops a file on the page. */
const drop = (name, content) => `(() => {
  const data = new DataTransfer();
  data.items.add(new File([${JSON.stringify(content)}], ${JSON.stringify(name)}));
  document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
})()`;

test("a sample is posted, its report shown, the program held against it; nothing is asked for", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  await chromium.ask(click("post"));
  await chromium.until(`document.getElementById("verdict").className !== ""`);
  assert.match(await chromium.ask(text("verdict")), /^The program is good/);
  const program = await chromium.ask(text("program"));
  assert.match(program, /G1/);
  assert.match(await chromium.ask(text("summary")), /of memory/);
  const saved = await chromium.ask(`[...document.querySelectorAll("#downloads a")].map((link) => link.download)`);
  assert.deepEqual(saved, ["blade.nc", "blade.html", "blade.json"]);
  // The report runs in its frame.
  await chromium.ask(`document.querySelector("[data-tab=report]").click()`);
  assert.equal(await chromium.inFrame(), "yes");
  // Held against its CL file.
  await chromium.ask(drop("blade.nc", program));
  await chromium.ask(click("verify"));
  await chromium.until(`/asks for\\.$|cannot be read\\.$/.test(${text("verdict")})`);
  assert.equal(await chromium.ask(text("verdict")), "The program does what the CL file asks for.");
  await chromium.ask(drop("wrong.nc", program.replace(/X(-?[\d.]+)/g, (_, x) => `X${(Number(x) + 0.5).toFixed(3)}`)));
  await chromium.ask(click("verify"));
  await chromium.until(`/does not do/.test(${text("verdict")})`);
  assert.ok((await chromium.ask(`document.querySelectorAll("#messages .finding.error").length`)) > 0);
  assert.deepEqual(chromium.complaints(), []);
  const asked = chromium.requests().filter((url) => !/^(data|blob):/.test(url));
  console.log(`requests: ${asked.length} (${chromium.requests().length} with what the page hands to itself)`);
  assert.deepEqual(asked, [`file://${page}`]);
});

test("a list of points that is dropped is posted", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  const points = [[0, 0, 50, true], [0, 0, 5, true], [0, 0, -2, false], [60, 0, -2, false], [60, 0, 50, true]];
  const csv = ["x,y,z,rapid", ...points.map(([x, y, z, rapid]) => `${x},${y},${z},${Number(rapid)}`), ""].join("\n");
  const json = JSON.stringify({ points: points.map(([x, y, z, rapid]) => ({ x, y, z, rapid })) });
  const words = "--tool-length 100 --tool 1 --spindle 6000 --feed 800";
  const programs = [];
  await chromium.ask(`document.getElementById("machines").value = "vmc", document.getElementById("machines").onchange()`);
  await chromium.ask(`document.getElementById("options").value = ${JSON.stringify(words)}`);
  for (const [name, content] of [["path.csv", csv], ["path.json", json]]) {
    await chromium.ask(drop(name, content));
    await chromium.until(`${text("cl-name")}.startsWith(${JSON.stringify(name)})`);
    assert.equal(await chromium.ask(text("nc-name")), "none");
    await chromium.ask(click("post"));
    await chromium.until(`document.getElementById("verdict").className !== ""`);
    assert.match(await chromium.ask(text("verdict")), /^The program is good/);
    const program = await chromium.ask(text("program"));
    assert.match(program, /X60/);
    programs.push(program.replaceAll(name, ""));
    const saved = await chromium.ask(`[...document.querySelectorAll("#downloads a")].map((link) => link.download)`);
    assert.ok(!saved.includes(name), `the summary would take the name of ${name}`);
  }
  assert.equal(programs[0], programs[1]);
  assert.deepEqual(chromium.complaints(), []);
});

test("the policy forbids what would leave", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  const left = await chromium.ask(`(async () => {
    const failed = async (what) => { try { await what(); return false; } catch { return true; } };
    return [
      await failed(() => fetch("https://example.org/")),
      await failed(() => fetch(URL.createObjectURL(new Blob(["a"])))),
      await failed(() => new Promise((resolve, reject) => {
        const image = new Image();
        image.onload = resolve;
        image.onerror = reject;
        image.src = "https://example.org/a.png";
      })),
      !navigator.sendBeacon("https://example.org/", "a") || "queued",
    ];
  })()`);
  assert.deepEqual(left.slice(0, 3), [true, true, true]);
  assert.ok(chromium.complaints().length > 0, "the browser says what it has kept back");
});

test("the machine is edited with completion, and its faults are told", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  const machine = readFileSync(path.join(root, "machines/ac-trunnion.toml"), "utf8");
  await chromium.until(`${value("machine")}.length > 0`);
  assert.equal(await chromium.ask(value("machine")), machine);
  await chromium.ask(`(() => {
    const field = document.getElementById("machine");
    field.focus();
    field.value = field.value.replace("[accuracy]\\n", "[accuracy]\\nred\\n");
    const at = field.value.indexOf("red", field.value.indexOf("[accuracy]")) + 3;
    field.setSelectionRange(at, at);
  })()`);
  await chromium.send("Input.insertText", { text: "u" });
  await chromium.until(`!document.getElementById("completion").hidden`);
  assert.match(await chromium.ask(text("completion")), /reduce/);
  await chromium.until(`document.querySelectorAll("#told .error").length > 0`);
  assert.deepEqual(chromium.complaints(), []);
});

test("work is cancelled, and the next goes on", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  const blade = readFileSync(path.join(root, "tests/samples/blade.cls"), "utf8");
  await chromium.ask(drop("long.cls", long(100_000)));
  await chromium.until(`/long/.test(${text("cl-name")})`);
  await chromium.ask(click("post"));
  await chromium.until(`!document.getElementById("progress").hidden`);
  await chromium.ask(click("cancel"));
  await chromium.until(`${text("verdict")} === "Cancelled."`);
  await chromium.ask(drop("blade.cls", blade));
  await chromium.until(`/^blade/.test(${text("cl-name")})`);
  await chromium.ask(click("post"));
  await chromium.until(`/^The program is good/.test(${text("verdict")})`);
});
