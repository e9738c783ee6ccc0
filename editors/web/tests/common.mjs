// What the tests share: jobs, the command, a browser.

import { execFile, spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../../", import.meta.url));
export const page = fileURLToPath(new URL("../out/post.html", import.meta.url));
export const module = fileURLToPath(new URL("../out/package/post.wasm", import.meta.url));

const named = (folder, ending) => readdirSync(path.join(root, folder)).filter((name) => ending.test(name)).sort();

/**
 * Every sample on every machine of the library, and what each machine makes or refuses of its own: a third of it, another
 * one with another POST_SEED, and all with POST_ROUNDS=1.
 */
export function jobs() {
  const machines = named("machines", /\.toml$/).map((name) => path.parse(name).name);
  const text = (folder, name) => readFileSync(path.join(root, folder, name), "utf8");
  const all = [];
  for (const name of named("tests/samples", /\.[a-z]+$/)) {
    const cl = text("tests/samples", name);
    all.push(...machines.map((machine) => ({ machine, name, cl })));
  }
  for (const name of named("tests/machines", /\.(cls|apt|ncl)$/)) {
    all.push({ machine: name.split(".")[0], name, cl: text("tests/machines", name) });
  }
  // A sixth in a usual run, drawn by its seed: arms take seconds each.
  const sixth = Number(process.env.POST_SEED ?? 0) % 6;
  return { machines, all: process.env.POST_ROUNDS ? all : all.filter((_, index) => index % 6 === sixth) };
}

/** The words of a job's command line. */
export function words({ machine, name }) {
  return ["--machine", machine, name, "-o", "out.nc", "--summary", "out.json", "--tool-length", "100", "--verify"];
}

export const hash = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** What must be equal: exit code, bytes of program and summary, what is printed, codes and lines of findings. */
export function told(code, nc, json, printed) {
  return { code, nc: nc && hash(nc), json: json && hash(json), printed: hash(printed) };
}

/** What the command makes of a job. */
export async function byCommand(job) {
  const folder = mkdtempSync(path.join(os.tmpdir(), "post-web-"));
  try {
    const { writeFile, readFile } = await import("node:fs/promises");
    await writeFile(path.join(folder, job.name), job.cl);
    const { code, out } = await new Promise((resolve) => {
      execFile(process.env.POST_COMMAND, words(job), { cwd: folder, maxBuffer: 1 << 28 }, (fault, out, error) => {
        resolve({ code: fault ? fault.code : 0, out, error });
      });
    });
    const made = (name) => readFile(path.join(folder, name)).catch(() => null);
    return told(code, await made("out.nc"), await made("out.json"), out);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** Does this for all, a few at a time. */
export async function each(list, most, what) {
  const done = new Array(list.length);
  let next = 0;
  const work = async () => {
    while (next < list.length) {
      const index = next++;
      done[index] = await what(list[index]);
    }
  };
  await Promise.all(Array.from({ length: most }, work));
  return done;
}

const PROGRAM = "chromium-headless-shell";

/** A browser without a window and one page in it, driven over a pipe. */
export class Browser {
  events = [];
  #waiting = new Map();
  #next = 0;
  #session;

  static async start() {
    const browser = new Browser();
    browser.folder = mkdtempSync(path.join(os.tmpdir(), "post-browser-"));
    const flags = ["--headless", "--no-sandbox", "--remote-debugging-pipe", "--window-size=1440,900", `--user-data-dir=${browser.folder}`];
    browser.child = spawn(PROGRAM, flags, {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
      detached: true,
    });
    const [, , , to, from] = browser.child.stdio;
    browser.to = to;
    const there = await new Promise((resolve) => {
      browser.child.once("error", () => resolve(false));
      browser.child.once("spawn", () => resolve(true));
    });
    if (!there) {
      return null;
    }
    let rest = Buffer.alloc(0);
    from.on("data", (bytes) => {
      rest = Buffer.concat([rest, bytes]);
      for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
        browser.#hear(JSON.parse(rest.subarray(0, end).toString()));
      }
    });
    const { targetId } = await browser.send("Target.createTarget", { url: "about:blank" });
    browser.#session = (await browser.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Log", "Network"]) {
      await browser.send(`${domain}.enable`);
    }
    // Workers and frames ask for themselves.
    await browser.send("Target.setAutoAttach", { autoAttach: true, waitForDebuggerOnStart: false, flatten: true });
    return browser;
  }

  #hear(message) {
    const waits = this.#waiting.get(message.id);
    if (waits === undefined) {
      this.events.push(message);
      if (message.method === "Target.attachedToTarget" && this.#session) {
        const session = message.params.sessionId;
        for (const domain of ["Runtime", "Network"]) {
          this.send(`${domain}.enable`, {}, session).catch(() => {});
        }
      }
      return;
    }
    this.#waiting.delete(message.id);
    message.error ? waits.reject(new Error(JSON.stringify(message.error))) : waits.resolve(message.result);
  }

  send(method, params = {}, sessionId = this.#session) {
    const id = ++this.#next;
    this.to.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }

  /** What an expression of the page comes to. */
  async ask(expression) {
    const parameters = { expression, awaitPromise: true, returnByValue: true };
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", parameters);
    if (exceptionDetails) {
      throw new Error(JSON.stringify(exceptionDetails));
    }
    return result.value;
  }

  /** Whether the report that the page frames is ready: its own script has run. */
  async inFrame(seconds = 30) {
    for (let turn = 0; turn < seconds * 20; turn++) {
      const frames = this.events.filter(({ params }) => params.targetInfo?.type === "iframe" && params.sessionId);
      for (const { params } of frames) {
        const parameters = { expression: "document.documentElement?.dataset.ready ?? null", returnByValue: true };
        const seen = await this.send("Runtime.evaluate", parameters, params.sessionId).catch(() => null);
        if (typeof seen?.result?.value === "string") {
          return "yes";
        }
      }
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    return "no";
  }

  /** Waits until an expression of the page holds. */
  async until(expression, seconds = 60) {
    for (let turn = 0; turn < seconds * 20; turn++) {
      if (await this.ask(`Boolean(${expression})`)) {
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`${expression} does not hold after ${seconds} s: ${await this.ask("document.body.innerText.slice(0, 2000)")}`);
  }

  async open(file) {
    await this.send("Page.navigate", { url: `file://${file}` });
    await this.until("document.documentElement?.dataset.ready");
  }

  /** Addresses that page, workers and frames have asked for. */
  requests() {
    return this.events.filter(({ method }) => method === "Network.requestWillBeSent").map(({ params }) => params.request.url);
  }

  /** What it has complained of. */
  complaints() {
    const loud = ({ method, params }) =>
      method === "Runtime.exceptionThrown" ||
      (method === "Log.entryAdded" && params.entry.level === "error") ||
      (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type));
    return this.events.filter(loud);
  }

  end() {
    // Its processes hold the pipes, which would keep this one waiting.
    process.kill(-this.child.pid, "SIGKILL");
    this.child.stdio.forEach((stream) => stream?.destroy());
    this.child.unref();
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** A browser; none where there is none and CI does not ask for one. */
export async function browser(test) {
  const started = await Browser.start();
  if (started === null) {
    if (process.env.CI) {
      throw new Error(`${PROGRAM} is not there`);
    }
    test.skip(`${PROGRAM} is not there`);
    return null;
  }
  test.after(() => started.end());
  return started;
}
