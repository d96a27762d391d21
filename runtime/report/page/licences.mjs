// Whose code a bundle holds: the packages of its inputs and their licences, for who passes a program on. Notices are written
// beside the bundle: OUT/licences/PACKAGE, and OUT/licences/packages.txt with a line "NAME VERSION LICENCE" each.
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

// What a package is made of and does not name as a package; zrender's and ECharts' own texts name theirs.
const kNotices = /^(licen[cs]e|notice|third-?party-?notices|copying)/i;

function noticesIn(folder) {
  return readdirSync(folder, { withFileTypes: true }).filter((entry) => kNotices.test(entry.name)).sort((a, b) => (a.name < b.name ? -1 : 1)).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? readdirSync(path).sort().map((file) => join(path, file)) : [path];
  });
}

// `inputs`: paths of what esbuild bundled (its metafile); `packages`: node_modules; `out`: where to write.
export function writeLicences(inputs, packages, out) {
  const names = new Set();
  for (const path of inputs) {
    const parts = path.replaceAll("\\", "/").split("/node_modules/").slice(1);
    if (!parts.length) continue;
    const words = parts.at(-1).split("/");
    names.add(words[0].startsWith("@") ? `${words[0]}/${words[1]}` : words[0]);
  }
  const folder = join(out, "licences");
  mkdirSync(folder, { recursive: true });
  const lines = [];
  for (const name of [...names].sort()) {
    const from = join(packages, name);
    const about = JSON.parse(readFileSync(join(from, "package.json"), "utf8"));
    const texts = noticesIn(from);
    if (!texts.length) throw new Error(`no licence of the package ${name} is there`);
    const file = name.replaceAll("@", "").replaceAll("/", "-");
    writeFileSync(join(folder, `npm-${file}`), texts.map((text) => readFileSync(text, "utf8")).join("\n\n"));
    lines.push(`npm-${file} ${about.version} ${typeof about.license === "string" ? about.license : about.license?.type ?? "see its text"}`);
  }
  if (!lines.length) throw new Error("a bundle without packages: are its inputs absolute paths?");
  writeFileSync(join(folder, "packages.txt"), lines.join("\n") + "\n");
  return lines;
}
// Absolute paths of all that a bundle was made from.
export const inputsOf = (metafile, at) => Object.keys(metafile.inputs).map((path) => join(at, path));
