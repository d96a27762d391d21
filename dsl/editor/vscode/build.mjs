// Bundles the extension and packs it: node build.mjs PACKAGES OUT.vsix
// PACKAGES has node_modules of package.json. The licences of all that is bundled go inside.
import { createRequire } from 'node:module';
import { cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync, existsSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [packages, out] = process.argv.slice(2).map((path) => resolve(path));
const require = createRequire(join(packages, 'package.json'));
const stage = join(dirname(out), 'stage');
rmSync(stage, { recursive: true, force: true });
mkdirSync(stage, { recursive: true });
for (const name of ['README.md', 'language-configuration.json', 'syntaxes']) cpSync(join(here, name), join(stage, name), { recursive: true });
cpSync(join(here, '../../../LICENSE'), join(stage, 'LICENSE'));

// What is only for building is none of the extension's.
const manifest = JSON.parse(readFileSync(join(here, 'package.json'), 'utf8'));
delete manifest.devDependencies;
writeFileSync(join(stage, 'package.json'), JSON.stringify(manifest, null, 2) + '\n');

const made = await require('esbuild').build({
  entryPoints: [join(here, 'src/extension.ts')],
  outfile: join(stage, 'dist/extension.js'),
  bundle: true,
  platform: 'node',
  format: 'cjs',
  target: 'node18',
  external: ['vscode'],
  minify: true,
  legalComments: 'none',
  metafile: true,
  nodePaths: [join(packages, 'node_modules')],
});

const folders = new Set();
for (const input of Object.keys(made.metafile.inputs)) {
  const found = /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(resolve(input));
  if (found) folders.add(found[1]);
}
const notices = [...folders].sort().map((folder) => {
  const { name, version, license } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const file = readdirSync(folder).find((entry) => /^(licen[cs]e|copying)/i.test(entry));
  if (!file) throw new Error(`no licence of ${name} is in ${folder}`);
  return `${name} ${version} (${license})\n\n${readFileSync(join(folder, file), 'utf8').trim()}\n`;
});
if (notices.length === 0) throw new Error('nothing was bundled');
writeFileSync(join(stage, 'THIRD_PARTY_LICENSES.txt'), notices.join(`\n${'-'.repeat(80)}\n\n`));

mkdirSync(dirname(out), { recursive: true });
const { createVSIX } = await import(require.resolve('@vscode/vsce'));
await createVSIX({ cwd: stage, packagePath: out, dependencies: false, allowMissingRepository: true, skipLicense: false });
if (!existsSync(out)) throw new Error(`${out} was not made`);
