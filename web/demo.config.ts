// SPDX-License-Identifier: Apache-2.0
// demo.html as one file: script, style sheet and recording stand in it, and it may load nothing. `npm run demo` writes dist-demo/demo.html.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { defineConfig, type Plugin, type Rollup } from "vite";

const kRecording = "demo/recording.mcap.gz";
const kFacts = "demo/recording.json"; // what the page says of it

interface Facts {
  readonly name: string;
  readonly commands: readonly string[];
  readonly made: string;
  readonly story: string;
}

/// Nothing but what is in the file: the browser refuses all else.
const kPolicy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

const escaped = (text: string) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");

/// @throws Error if the page needs another file
function inline(bundle: Rollup.OutputBundle): void {
  const files = Object.values(bundle);
  const page = files.find((file) => file.fileName.endsWith(".html"));
  const script = files.find((file) => file.type === "chunk" && file.isEntry);
  const styles = files.filter((file) => file.fileName.endsWith(".css"));
  if (page?.type !== "asset" || script?.type !== "chunk") throw new Error("a page and a script are expected");
  // Threads of their own are written, though what would start them is left out.
  const rest = files.filter((file) => file !== page && file !== script && !styles.includes(file));
  const used = rest.filter((file) => script.code.includes(file.fileName));
  if (used.length > 0) throw new Error(`not in one file: ${used.map((file) => file.fileName).join(", ")}`);
  const facts = JSON.parse(readFileSync(resolve(__dirname, kFacts), "utf8")) as Facts;
  const recording = readFileSync(resolve(__dirname, kRecording)).toString("base64");
  const style = styles.map((file) => (file.type === "asset" ? String(file.source) : "")).join("");
  const code = script.code.replace(/<\/script/gi, "<\\/script");
  const commands = facts.commands.map((command) => `<code>${escaped(command)}</code>`).join("<br>");
  page.source = String(page.source)
    .replace(/\s*<script type="module"[^>]*><\/script>/, "")
    .replace(/\s*<link rel="stylesheet"[^>]*>/g, "")
    .replace("<title>", () => `<meta http-equiv="Content-Security-Policy" content="${kPolicy}" />\n    <title>`)
    .replace("</head>", () => `<style>${style}</style></head>`)
    .replace('<p id="story"></p>', () => `<p id="story">${escaped(facts.story)}</p>`)
    .replace('id="made"></footer>', () => `id="made">${escaped(facts.made)}<br>${commands}</footer>`)
    .replace('id="recording"></script>', () => `id="recording" data-name="${facts.name}">${recording}</script>`)
    .replace("</body>", () => `<script type="module">${code}</script></body>`);
  for (const file of [script, ...styles, ...rest]) delete bundle[file.fileName];
}

/// Last of all: the other parts of vite have put their code in by then.
const oneFile = (): Plugin => ({ name: "one-file", enforce: "post", generateBundle: { order: "post", handler: (_options, bundle) => inline(bundle) } });

export default defineConfig({
  base: "./",
  plugins: [oneFile()],
  build: {
    target: "es2022", outDir: "dist-demo", emptyOutDir: true, cssCodeSplit: false, assetsInlineLimit: 1 << 20, modulePreload: false,
    chunkSizeWarningLimit: 2000, reportCompressedSize: false,
    rollupOptions: { input: "demo.html", output: { inlineDynamicImports: true } },
  },
});
