// Builds ../viewer.js and ../viewer.css. `npm ci && npm run build`; the same sources and lock file give the same bytes.
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const out = process.argv[2] ?? "..";
const options = { bundle: true, minify: true, charset: "ascii", legalComments: "inline", logLevel: "warning", write: false };
const script = await build({ ...options, entryPoints: ["src/main.js"], format: "iife", target: ["es2022"] });
const style = await build({ ...options, entryPoints: ["src/style.css"] });
// The bundle stands inside a script element, which nothing in it may end.
const code = script.outputFiles[0].text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
await writeFile(`${out}/viewer.js`, code);
await writeFile(`${out}/viewer.css`, style.outputFiles[0].text);
const { version } = JSON.parse(await readFile("node_modules/three/package.json", "utf8"));
console.log(`viewer.js: ${code.length} bytes with three ${version}`);
