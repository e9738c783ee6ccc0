// The editor of the machine file: completion and findings by the language server, which is the module again.

const server = new Helper(() => {});
const field = $("machine");
const list = $("completion");
/** Answers that are waited for, by their numbers. */
const asked = new Map();
let version = 0;
let begun = false;
let rest = null;

const uri = () => `file:///${opened.machine.name}`;
let openUri = null;

function hear({ messages }) {
  for (const message of messages) {
    if (message.method === "textDocument/publishDiagnostics" && message.params.uri === uri()) {
      showTold(message.params.diagnostics);
    } else if (message.id !== undefined && asked.has(message.id)) {
      asked.get(message.id)(message.result);
      asked.delete(message.id);
    }
  }
}

async function tell(method, params, id) {
  const message = { jsonrpc: "2.0", method, params };
  hear(await server.ask({ kind: "edit", message: id === undefined ? message : { ...message, id } }));
}

async function question(method, params) {
  const id = ++version;
  const answer = new Promise((resolve) => asked.set(id, resolve));
  await tell(method, params, id);
  return answer;
}

function showTold(diagnostics) {
  const lines = diagnostics.map(({ severity, message, range }) => {
    const line = element("li", `line ${range.start.line + 1}: ${message}`, severity === 1 ? "error" : "warning");
    line.onclick = () => {
      const at = field.value.split("\n").slice(0, range.start.line).join("\n").length;
      field.focus();
      field.setSelectionRange(at + (range.start.line > 0), at + (range.start.line > 0));
    };
    return line;
  });
  $("told").replaceChildren(...lines);
}

/** The text is another one: findings come at once, slow ones once it has rested. */
async function edited() {
  try {
    if (!begun) {
      begun = true;
      await question("initialize", { capabilities: {}, processId: null, rootUri: null });
      await tell("initialized", {});
    }
    const text = field.value;
    version += 1;
    if (openUri !== uri()) {
      if (openUri !== null) {
        await tell("textDocument/didClose", { textDocument: { uri: openUri } });
      }
      openUri = uri();
      await tell("textDocument/didOpen", { textDocument: { uri: openUri, languageId: "toml", version, text } });
    } else {
      await tell("textDocument/didChange", { textDocument: { uri: openUri, version }, contentChanges: [{ text }] });
    }
    clearTimeout(rest);
    rest = setTimeout(async () => hear(await server.ask({ kind: "edit", message: null })), 250);
  } catch (fault) {
    // The next text is told to a new server.
    [begun, openUri] = [false, null];
    $("told").replaceChildren(element("li", fault.message, "error"));
  }
}

function position() {
  const before = field.value.slice(0, field.selectionStart).split("\n");
  return { line: before.length - 1, character: before.at(-1).length };
}

let offered = [];
let chosen = 0;

function close() {
  list.hidden = true;
  offered = [];
}

/** Where the word begins that is being written. */
function wordStart() {
  const before = field.value.slice(0, field.selectionStart);
  return before.length - /[\w.-]*$/.exec(before)[0].length;
}

async function complete() {
  const at = field.selectionStart;
  const answer = await question("textDocument/completion", { textDocument: { uri: openUri }, position: position() });
  if (field.selectionStart !== at) {
    return;
  }
  const items = Array.isArray(answer) ? answer : (answer?.items ?? []);
  const begun = field.value.slice(wordStart(), at).toLowerCase();
  offered = items.filter((item) => item.label.toLowerCase().startsWith(begun)).slice(0, 200);
  chosen = 0;
  showOffered();
}

function showOffered() {
  list.hidden = offered.length === 0;
  const rows = offered.map((item, index) => {
    const row = element("li", `${item.label} `);
    row.setAttribute("role", "option");
    row.setAttribute("aria-selected", String(index === chosen));
    const about = item.detail ?? item.documentation?.value ?? item.documentation ?? "";
    row.append(element("small", String(about).split("\n")[0]));
    row.onmousedown = (event) => {
      event.preventDefault();
      takeOffered(item);
    };
    return row;
  });
  list.replaceChildren(...rows);
  const { line, character } = position();
  const style = getComputedStyle(field);
  const height = parseFloat(style.lineHeight);
  list.style.top = `${Math.min((line + 1) * height + 8 - field.scrollTop, field.clientHeight)}px`;
  list.style.left = `${Math.max(0, Math.min(character * 7.8 + 8 - field.scrollLeft, field.clientWidth / 2))}px`;
  rows[chosen]?.scrollIntoView({ block: "nearest" });
}

function takeOffered(item) {
  const edit = item.textEdit;
  const text = (edit?.newText ?? item.insertText ?? item.label).replace(/\$\{\d+:?([^}]*)\}|\$\d+/g, "$1");
  const lines = field.value.split("\n");
  const offset = ({ line, character }) => lines.slice(0, line).reduce((sum, one) => sum + one.length + 1, 0) + character;
  const [from, to] = edit?.range ? [offset(edit.range.start), offset(edit.range.end)] : [wordStart(), field.selectionStart];
  field.setRangeText(text, from, to, "end");
  close();
  edited();
}

field.oninput = async ({ inputType, data }) => {
  await edited();
  const types = inputType === "insertText" && /[\w."=[]/.test(data ?? "");
  types ? await complete() : close();
};
field.onblur = close;
field.onkeydown = (event) => {
  if (event.ctrlKey && event.key === " ") {
    event.preventDefault();
    complete();
    return;
  }
  if (list.hidden) {
    return;
  }
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (step) {
    chosen = (chosen + step + offered.length) % offered.length;
    showOffered();
  } else if (event.key === "Enter" || event.key === "Tab") {
    takeOffered(offered[chosen]);
  } else if (event.key === "Escape") {
    close();
  } else {
    return;
  }
  event.preventDefault();
};

// The module is there once all is read.
compiled = unpacked("module").then((bytes) => WebAssembly.compile(bytes));
compiled.then(
  () => {
    showSample(given.samples[0]);
    $("verdict").textContent = "Ready.";
    document.documentElement.dataset.ready = "yes";
  },
  (fault) => verdict(false, `This browser cannot run it: ${fault.message}`),
);
tab("program");
