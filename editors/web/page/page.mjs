// The page: what is opened goes to the worker, what comes back is shown.

const $ = (id) => document.getElementById(id);
const given = JSON.parse($("given").textContent);

/** A text is edited here up to so many bytes; a longer file is only named. */
const EDITED = 1 << 20;

/** Bytes that stand in the page, packed. */
async function unpacked(id) {
  const packed = Uint8Array.from(atob($(id).textContent.trim()), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const workerSource = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
let compiled;

/** A worker that answers one after the other, and may be ended. */
class Helper {
  #worker = null;
  #waiting = new Map();
  #next = 0;

  constructor(progress) {
    this.progress = progress;
  }

  async ask(what) {
    const module = await compiled;
    if (this.#worker === null) {
      this.#worker = new Worker(workerSource);
      this.#worker.onmessage = ({ data }) => this.#hear(data);
      this.#worker.onerror = (event) => this.#hear({ kind: "fault", message: event.message });
      this.#worker.postMessage({ kind: "module", module });
    }
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ ...what, id });
    });
  }

  #hear(data) {
    if (data.kind === "progress") {
      this.progress(data);
      return;
    }
    const waits = data.id === undefined ? [...this.#waiting.keys()] : [data.id];
    for (const id of waits) {
      const { resolve, reject } = this.#waiting.get(id);
      this.#waiting.delete(id);
      data.kind === "done" ? resolve(data.result) : reject(new Error(data.message));
    }
  }

  /** Ends what is under way. */
  end() {
    this.#worker?.terminate();
    this.#worker = null;
    for (const { reject } of this.#waiting.values()) {
      reject(new Error("cancelled"));
    }
    this.#waiting.clear();
  }
}

const helper = new Helper(({ done, of }) => {
  const bar = $("progress");
  bar.hidden = false;
  of > 0 ? (bar.value = done / of) : bar.removeAttribute("value");
});

/** What is opened: text in the page, or a file that is too long for that. */
const opened = { cl: { name: "part.cls", file: null }, machine: { name: "machine.toml", file: null }, nc: null };

const size = (bytes) => (bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`);
const stem = (name) => name.replace(/\.[^.]*$/, "");

async function take(kind, file) {
  if (kind === "nc") {
    opened.nc = file;
    $("nc-name").textContent = `${file.name}, ${size(file.size)}`;
    return;
  }
  const short = file.size <= EDITED;
  opened[kind] = { name: file.name, file: short ? null : file };
  $(kind).value = short ? await file.text() : "";
  $(kind).disabled = !short;
  if (kind === "cl") {
    $("cl-name").textContent = `${file.name}, ${size(file.size)}`;
  } else {
    edited();
  }
}

function showSample(sample) {
  opened.cl = { name: sample.name, file: null };
  $("cl").disabled = false;
  $("cl").value = sample.text;
  $("cl-name").textContent = sample.name;
  if (sample.machine) {
    $("machines").value = sample.machine;
    showMachine(sample.machine);
  }
  $("options").value = sample.options;
}

function showMachine(name) {
  opened.machine = { name: `${name}.toml`, file: null };
  $("machine").disabled = false;
  $("machine").value = given.machines[name];
  edited();
}

/** A file of the job: as it is edited, else as it was opened. */
const fileOf = (kind) => ({ name: opened[kind].name, content: opened[kind].file ?? $(kind).value });

/** Words of a line, as a shell has them. */
function wordsOf(line) {
  const found = line.matchAll(/(?:[^\s"']|"[^"]*"|'[^']*')+/g);
  return [...found].map(([word]) => word.replace(/"([^"]*)"|'([^']*)'/g, (_, double, single) => double ?? single));
}

/** Where `post` writes what is told of a job, and its page. */
const SUMMARY = "post-summary.json";
const REPORT = "post-report.html";

let busy = false;

async function run(words, files, wants) {
  if (busy) {
    return null;
  }
  busy = true;
  $("verdict").className = "";
  $("verdict").textContent = "Working…";
  $("cancel").disabled = false;
  const begun = performance.now();
  try {
    const done = await helper.ask({ kind: "run", words: [...words, ...wordsOf($("options").value)], files, wants });
    return { ...done, seconds: (performance.now() - begun) / 1000 };
  } catch (fault) {
    verdict(false, fault.message === "cancelled" ? "Cancelled." : fault.message);
    return null;
  } finally {
    busy = false;
    $("cancel").disabled = true;
    $("progress").hidden = true;
  }
}

function verdict(good, text) {
  $("verdict").className = good ? "good" : "bad";
  $("verdict").textContent = text;
}

function tab(name) {
  for (const button of document.querySelectorAll("[data-tab]")) {
    button.setAttribute("aria-selected", String(button.dataset.tab === name));
  }
  for (const panel of document.querySelectorAll("[data-panel]")) {
    panel.hidden = panel.dataset.panel !== name;
  }
}

function element(name, text, className = "") {
  const made = document.createElement(name);
  made.textContent = text;
  made.className = className;
  return made;
}

/** Shows what came of a run: findings, what was printed, files to take home. */
function show({ ran, made, seconds, memory }, names) {
  const errors = ran.findings.filter((finding) => finding.severity === "error").length;
  const found = ran.findings.map((finding) => {
    const box = element("div", "", `finding ${finding.severity}`);
    box.append(element("pre", finding.shown));
    return box;
  });
  const said = ran.said.trim() ? [element("pre", ran.said)] : [];
  $("messages").replaceChildren(...said, ...(found.length ? found : [element("p", "No messages.")]));
  document.querySelector("[data-tab=messages]").textContent = `Messages (${ran.findings.length})`;
  $("summary").textContent = `${ran.printed}\n${seconds.toFixed(2)} s in this browser, ${size(memory)} of memory\n`;
  for (const link of $("downloads").querySelectorAll("a")) {
    URL.revokeObjectURL(link.href);
  }
  const links = Object.entries(names).filter(([name]) => made[name]).map(([name, as]) => {
    const link = element("a", `Save ${as}`);
    link.href = URL.createObjectURL(made[name].blob);
    link.download = as;
    return link;
  });
  $("downloads").replaceChildren(...links.flatMap((link) => [link, " "]));
  if (made[REPORT]) {
    // A frame of its own: it may run its own script and nothing else, and asks for nothing.
    $("report").src = URL.createObjectURL(new Blob([made[REPORT].blob], { type: "text/html" }));
  } else {
    $("report").removeAttribute("src");
  }
  return errors;
}

function showProgram(text, blob) {
  $("program").textContent = blob.size > text.length ? `${text}\n… ${size(blob.size)} in all: save it to see the rest` : text;
}

async function post() {
  const [cl, machine] = [fileOf("cl"), fileOf("machine")];
  const nc = `${stem(cl.name)}.nc`;
  const line = ["--machine", machine.name, cl.name, "-o", nc, "--report", REPORT, "--summary", SUMMARY];
  const done = await run(line, [cl, machine], [nc, REPORT, SUMMARY]);
  if (done === null) {
    return;
  }
  const own = stem(cl.name);
  // A list of points has the summary's name itself.
  const summary = cl.name === `${own}.json` ? `${own}-summary.json` : `${own}.json`;
  const errors = show(done, { [nc]: nc, [REPORT]: `${own}.html`, [SUMMARY]: summary });
  const program = done.made[nc];
  if (done.ran.code === 0 && program) {
    showProgram(program.begin, program.blob);
    const warnings = done.ran.findings.length;
    verdict(true, `The program is good${warnings ? `, with ${warnings} warning${warnings > 1 ? "s" : ""}` : ""}.`);
    tab("program");
  } else {
    $("program").textContent = "";
    verdict(false, `Refused: ${errors} error${errors === 1 ? "" : "s"}. No program is written.`);
    tab("messages");
  }
}

/** Reads the program that was opened, by a verb. */
async function ofProgram(verb, more, good, bad) {
  if (!opened.nc) {
    verdict(false, "Open an NC program first.");
    return;
  }
  const [machine, cl] = [fileOf("machine"), fileOf("cl")];
  const nc = { name: opened.nc.name, content: opened.nc };
  const files = verb === "verify" ? [nc, machine, cl] : [nc, machine];
  const line = [verb, nc.name, "--machine", machine.name, ...more(cl.name)];
  const done = await run(line, files, [REPORT, SUMMARY]);
  if (done === null) {
    return;
  }
  const own = stem(nc.name);
  show(done, { [REPORT]: `${own}.html`, [SUMMARY]: `${own}.json` });
  showProgram(await opened.nc.slice(0, EDITED).text(), opened.nc);
  verdict(done.ran.code === 0, done.ran.code === 0 ? good : bad);
  tab(done.ran.code === 0 ? "summary" : "messages");
}

async function check() {
  const machine = fileOf("machine");
  const done = await run(["check", machine.name, "--json", SUMMARY], [machine], [SUMMARY]);
  if (done !== null) {
    show(done, { [SUMMARY]: `${stem(machine.name)}.json` });
    const good = done.ran.code === 0;
    verdict(good, good ? "The machine file is in order. Compare the signs with the machine." : "The machine file is refused.");
    tab(good ? "summary" : "messages");
  }
}

// What the page is made of.
for (const [index, sample] of given.samples.entries()) {
  $("samples").append(new Option(`${sample.name}${sample.machine ? ` on ${sample.machine}` : ""}`, index));
}
for (const name of Object.keys(given.machines)) {
  $("machines").append(new Option(name, name));
}
$("samples").onchange = () => showSample(given.samples[$("samples").value]);
$("machines").onchange = () => showMachine($("machines").value);
for (const kind of ["cl", "machine", "nc"]) {
  $(`${kind}-file`).onchange = ({ target }) => target.files[0] && take(kind, target.files[0]);
}
$("post").onclick = post;
$("check").onclick = check;
$("cancel").onclick = () => helper.end();
$("verify").onclick = () =>
  ofProgram(
    "verify",
    (cl) => ["--against", cl, "--summary", SUMMARY, "--report", REPORT],
    "The program does what the CL file asks for.",
    "The program does not do what the CL file asks for, or cannot be read.",
  );
$("lint").onclick = () =>
  ofProgram("lint", () => ["--json", SUMMARY], "Nothing is wrong with the program.", "Something is wrong with the program.");
$("read").onclick = () => ofProgram("read", () => [], "The program was read.", "Not all of the program can be read.");
for (const button of document.querySelectorAll("[data-tab]")) {
  button.onclick = () => tab(button.dataset.tab);
}

/** What a file that is dropped is, by its ending: a list of points (CSV, JSON) stands where a CL file does. */
function kindOf(name) {
  if (/\.toml$/i.test(name)) {
    return "machine";
  }
  return /\.(cls|clsf|clt|cl|cldata|apt|ncl|aptsource|csv|json)$/i.test(name) ? "cl" : "nc";
}
document.ondragover = (event) => {
  event.preventDefault();
  document.body.classList.add("dropping");
};
document.ondragleave = () => document.body.classList.remove("dropping");
document.ondrop = (event) => {
  event.preventDefault();
  document.body.classList.remove("dropping");
  for (const file of event.dataTransfer.files) {
    take(kindOf(file.name), file);
  }
};
