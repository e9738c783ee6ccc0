// Bundles the extension and packs it: a .vsix is a zip with a manifest. The same sources make the same bytes.
// `node build.mjs SCHEMA`: SCHEMA is what `post schema` prints. For VS Code for the Web the module that `editors/web/build`
// makes is packed too, if it is there.

import { existsSync } from "node:fs";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { crc32, deflateRawSync } from "node:zlib";
import { build } from "esbuild";

const about = JSON.parse(await readFile("package.json", "utf8"));
const schema = process.argv[2];
if (!schema) {
  throw new Error("name the file that `post schema` printed");
}

const bundle = await build({
  entryPoints: ["src/extension.js"],
  bundle: true,
  platform: "node",
  target: "node18",
  external: ["vscode"],
  minify: true,
  write: false,
  legalComments: "none",
});

/** The module; without it the extension is none of VS Code for the Web. */
const module = "../web/out/package/post.wasm";
const web = [];
if (existsSync(module)) {
  const options = { bundle: true, platform: "browser", target: "es2022", minify: true, write: false, legalComments: "none" };
  const extension = await build({ ...options, entryPoints: ["src/web.js"], format: "cjs", external: ["vscode"] });
  const server = await build({ ...options, entryPoints: ["src/server.js"], format: "iife" });
  web.push(["extension/web.js", Buffer.from(extension.outputFiles[0].contents)]);
  web.push(["extension/server.js", Buffer.from(server.outputFiles[0].contents)]);
  web.push(["extension/post.wasm", await readFile(module)]);
} else {
  delete about.browser;
  console.log(`without ${module}: not for VS Code for the Web`);
}

const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");

const manifest = `<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011">
  <Metadata>
    <Identity Language="en-US" Id="${about.name}" Version="${about.version}" Publisher="${about.publisher}"/>
    <DisplayName>${escaped(about.displayName)}</DisplayName>
    <Description xml:space="preserve">${escaped(about.description)}</Description>
    <Categories>${about.categories.join(",")}</Categories>
    <Properties>
      <Property Id="Microsoft.VisualStudio.Code.Engine" Value="${about.engines.vscode}"/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionDependencies" Value=""/>
    </Properties>
  </Metadata>
  <Installation><InstallationTarget Id="Microsoft.VisualStudio.Code"/></Installation>
  <Dependencies/>
  <Assets>
    <Asset Type="Microsoft.VisualStudio.Code.Manifest" Path="extension/package.json" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.Details" Path="extension/readme.md" Addressable="true"/>
  </Assets>
</PackageManifest>
`;

const types = `<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
  <Default Extension="json" ContentType="application/json"/>
  <Default Extension="js" ContentType="application/javascript"/>
  <Default Extension="md" ContentType="text/markdown"/>
  <Default Extension="wasm" ContentType="application/wasm"/>
  <Default Extension="vsixmanifest" ContentType="text/xml"/>
</Types>
`;

const { languages, grammars: coloured } = about.contributes;
const own = [...languages.map((language) => language.configuration.slice(2))];
const grammars = coloured.map((grammar) => grammar.path.slice(2));
const files = [
  ["extension/package.json", Buffer.from(`${JSON.stringify(about, null, 2)}\n`)],
  ["extension.vsixmanifest", Buffer.from(manifest)],
  ["[Content_Types].xml", Buffer.from(types)],
  ["extension/extension.js", Buffer.from(bundle.outputFiles[0].contents)],
  ["extension/machine.schema.json", await readFile(schema)],
  ["extension/readme.md", await readFile("../README.md")],
  ...web,
];
for (const name of [...own, ...grammars]) {
  const bytes = await readFile(name);
  // A grammar that is no JSON would only be found by whoever installs it.
  JSON.parse(bytes.toString("utf8"));
  files.push([`extension/${name}`, bytes]);
}

/** A zip of the files, every one from 1980-01-01. */
function zip(entries) {
  const day = (1 << 5) | 1;
  const parts = [];
  const directory = [];
  let offset = 0;
  for (const [name, bytes] of entries) {
    const packed = deflateRawSync(bytes, { level: 9 });
    const label = Buffer.from(name);
    const common = Buffer.alloc(26);
    common.writeUInt16LE(20, 0);
    common.writeUInt16LE(0x0800, 2);
    common.writeUInt16LE(8, 4);
    common.writeUInt16LE(0, 6);
    common.writeUInt16LE(day, 8);
    common.writeUInt32LE(crc32(bytes), 10);
    common.writeUInt32LE(packed.length, 14);
    common.writeUInt32LE(bytes.length, 18);
    common.writeUInt16LE(label.length, 22);
    common.writeUInt16LE(0, 24);
    parts.push(Buffer.from("PK\x03\x04"), common, label, packed);
    const tail = Buffer.alloc(14);
    tail.writeUInt32LE(offset, 10);
    directory.push(Buffer.from("PK\x01\x02"), Buffer.from([20, 0]), common, tail, label);
    offset += 4 + common.length + label.length + packed.length;
  }
  const listed = Buffer.concat(directory);
  const end = Buffer.alloc(22);
  end.write("PK\x05\x06", 0, "latin1");
  end.writeUInt16LE(entries.length, 8);
  end.writeUInt16LE(entries.length, 10);
  end.writeUInt32LE(listed.length, 12);
  end.writeUInt32LE(offset, 16);
  return Buffer.concat([...parts, listed, end]);
}

await mkdir("out", { recursive: true });
const name = `out/${about.name}-${about.version}.vsix`;
const bytes = zip(files);
await writeFile(name, bytes);
console.log(`${name}: ${files.length} files, ${Math.ceil(bytes.length / 1024)} kB`);
