// Called by tests/vscode.sh: node vscode.mjs EXTENSION.vsix VLAPROBE FOLDER [--fetch]. FOLDER keeps what was fetched and has `pictures`
// afterwards. Prints what it saw, and ends with 1 where something is not as it should be. puppeteer-core is that of the report's page.
import { execFileSync, spawn } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const [vsix, program, folder] = process.argv.slice(2, 5).map((path) => resolve(path));
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
const puppeteer = createRequire(join(root, 'build/report_page/package.json'))('puppeteer-core');
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// code-server without what the editor does not need: its own build of Kerberos and of Windows' parts, a package that only GitHub has
// (npm has another version of it), and passwords, which a later argon2 has ready-made.
const code = join(folder, 'node_modules/code-server');
const inside = join(code, 'lib/vscode');
function npm(...words) {
  execFileSync('npm', words.slice(1), { cwd: words[0], stdio: ['ignore', 'ignore', 'inherit'] });
}
function install() {
  mkdirSync(folder, { recursive: true });
  npm(folder, 'install', '--prefix', folder, '--ignore-scripts', 'code-server@4.96.4');
  npm(folder, 'install', '--prefix', folder, '--ignore-scripts', 'argon2@0.44.0');
  rmSync(join(code, 'node_modules/argon2'), { recursive: true, force: true });
  const known = JSON.parse(readFileSync(join(inside, 'npm-shrinkwrap.json'), 'utf8')).packages;
  const manifest = JSON.parse(readFileSync(join(inside, 'package.json'), 'utf8'));
  for (const name of Object.keys(manifest.dependencies)) {
    if (/windows|kerberos/.test(name)) delete manifest.dependencies[name];
    else manifest.dependencies[name] = known[`node_modules/${name}`]?.version ?? manifest.dependencies[name];
  }
  manifest.dependencies['@vscode/proxy-agent'] = '^0.27.0';
  manifest.dependencies['@parcel/watcher'] = '2.4.1';
  manifest.devDependencies = {};
  writeFileSync(join(inside, 'package.json'), JSON.stringify(manifest, null, 1));
  renameSync(join(inside, 'npm-shrinkwrap.json'), join(folder, 'shrinkwrap.json'));
  npm(inside, 'install', '--ignore-scripts', '--omit=dev');
  // The terminal, which the lenses run in.
  const gyp = join(execFileSync('npm', ['root', '-g']).toString().trim(), 'npm/node_modules/node-gyp/bin/node-gyp.js');
  execFileSync('node', [gyp, 'rebuild', '--nodedir=/usr'], { cwd: join(inside, 'node_modules/node-pty'), stdio: 'ignore' });
}
if (!existsSync(join(inside, 'node_modules/node-pty/build/Release/pty.node'))) {
  if (!process.argv.includes('--fetch')) {
    console.log(`skipped: no code-server in ${folder}; --fetch brings it from npm, some 250 MB`);
    process.exit(0);
  }
  install();
}

const work = join(folder, 'work'), data = join(folder, 'data'), pictures = join(folder, 'pictures');
for (const one of [work, data, pictures, join(folder, 'extensions')]) rmSync(one, { recursive: true, force: true });
for (const one of [work, pictures, join(data, 'User')]) mkdirSync(one, { recursive: true });
for (const name of readdirSync(join(root, 'suite'))) if (name.endsWith('.probe')) cpSync(join(root, 'suite', name), join(work, name));
writeFileSync(join(data, 'User/settings.json'), JSON.stringify({
  'vlaprobe.program': program, 'vlaprobe.assets': join(root, 'assets'), 'workbench.startupEditor': 'none',
  'security.workspace.trust.enabled': false, 'telemetry.telemetryLevel': 'off', 'editor.minimap.enabled': false,
  // Nothing lies over the text that is clicked at.
  'editor.stickyScroll.enabled': false, 'breadcrumbs.enabled': false, 'editor.occurrencesHighlight': 'off',
}));
const entry = join(code, 'out/node/entry.js');
const folders = ['--user-data-dir', data, '--extensions-dir', join(folder, 'extensions')];
execFileSync('node', [entry, ...folders, '--install-extension', vsix], { stdio: 'ignore' });
const server = spawn('node', [entry, '--auth', 'none', '--bind-addr', '127.0.0.1:0', ...folders, '--disable-update-check', work]);
const address = await new Promise((found, failed) => {
  let said = '';
  server.stdout.on('data', (more) => {
    said += more;
    const at = /listening on (http:\S+)/.exec(said);
    if (at) found(at[1]);
  });
  server.on('exit', () => failed(new Error(`code-server ended: ${said}`)));
});

let failures = 0;
function holds(what, is_so, seen) {
  console.log(`${is_so ? 'yes' : 'NO '} ${what}${is_so ? '' : `: ${JSON.stringify(seen)}`}`);
  if (!is_so) ++failures;
}
const browser = await puppeteer.launch({ executablePath: chromium, args: ['--no-sandbox'], defaultViewport: { width: 1500, height: 950 }, protocolTimeout: 300000 });
try {
  const page = await browser.newPage();
  const words = (selector) => page.$$eval(selector, (all) => all.map((one) => one.innerText.replace(/[\s\u00a0]+/g, ' ').trim()));
  // What is seen once it is as it should be, or after a minute.
  const seen = async (selector, is_so) => {
    let all = [];
    for (let i = 0; i < 120 && !is_so((all = await words(selector))); ++i) await pause(500);
    return all;
  };
  const has = (text) => (all) => all.some((one) => one.includes(text));
  const keys = async (...chord) => {
    for (const key of chord.slice(0, -1)) await page.keyboard.down(key);
    await page.keyboard.press(chord.at(-1));
    for (const key of chord.slice(0, -1)) await page.keyboard.up(key);
    await pause(700);
  };
  const command = async (name) => {
    await keys('F1');
    await page.keyboard.type(name, { delay: 20 });
    await seen('.quick-input-list .monaco-list-row', has(name));
    await pause(500);
    await keys('Enter');
  };
  const picture = (name) => page.screenshot({ path: join(pictures, `${name}.png`) });

  await page.goto(`${address}?folder=${work}`, { timeout: 180000 });
  await seen('.monaco-list-row', has('intact.probe'));
  const rows = await page.$$('.monaco-list-row');
  for (const row of rows) if ((await row.evaluate((one) => one.innerText.trim())) === 'intact.probe') await row.click({ count: 2 });

  const lenses = await seen('.codelens-decoration', has('24 starts'));
  holds('lenses stand over tasks', has('24 starts')(lenses), lenses.slice(0, 3));
  // A text that is opened while the extension is being loaded for the first time may be drawn without the settings that it brings.
  const are_whole = (all) => has('24 starts, object.source')(all) && !has('…')(all);
  let lines = await seen('.view-line', has('24 starts, object.'));
  if (!are_whole(lines)) {
    await page.reload({ timeout: 180000 });
    lines = await seen('.view-line', are_whole);
  }
  holds('hints say the axis and are not cut', are_whole(lines), lines.slice(20, 34));
  const colors = await page.$$eval('.view-line span span', (all) => new Set(all.map((one) => getComputedStyle(one).color)).size);
  holds('words have colours', colors >= 6, colors);
  await picture('text');

  await page.click('.view-lines');
  await keys('Control', 'End');
  await page.keyboard.type('\ntask mine like carrot_on_plate { source carrt }', { delay: 40 });
  await keys('Escape');
  await keys('Control', 'Shift', 'm');
  let problems = await seen('.markers-panel .monaco-list-row', has('unknown object'));
  holds('a mistake is told among the problems', has('unknown object `carrt`')(problems) && has('P0201')(problems), problems);
  await picture('problem');
  await page.click('.view-lines');
  await keys('Control', 'End');
  for (let i = 0; i < 4; ++i) await keys('ArrowLeft');
  await keys('Control', '.');
  const fixes = await seen('.action-widget .monaco-list-row', has('write'));
  holds('its fix is offered', has('write `carrot`')(fixes), fixes);
  await keys('Enter');
  problems = await seen('.markers-panel .monaco-list-row', (all) => !has('unknown object')(all));
  holds('and mends it', !has('unknown object')(problems), problems);

  await keys('Control', 'End');
  await keys('ArrowLeft');
  await page.keyboard.type('; target ', { delay: 40 });
  await keys('Escape');
  await keys('Control', ' ');
  const offered = await seen('.suggest-widget .monaco-list-row', has('plate'));
  holds('objects are offered where one is wanted', has('plate')(offered) && !has('grid_24')(offered), offered);
  await picture('completion');
  await keys('Escape');
  await page.keyboard.type('plate', { delay: 40 });
  await keys('Escape');

  await command('Format Document');
  const laid = await seen('.view-line', has('{ source carrot; target plate }'));
  holds('the text is laid out', has('{ source carrot; target plate }')(laid), laid.slice(-3));

  await keys('Control', 'Home');
  await keys('Control', 'f');
  await page.keyboard.type('carrot_on_plate {', { delay: 20 });
  await pause(1500);
  await keys('Enter');
  await keys('Escape');
  await keys('ArrowLeft');
  await keys('ArrowRight');
  await command('Show or Focus Hover');
  const hover = await seen('.monaco-hover', has('60 steps'));
  holds('a task is told of when it is hovered over', has('"put carrot on plate"')(hover), hover);
  await picture('hover');
  await keys('Escape');
  await keys('F2');
  await page.keyboard.type('carrot_laid', { delay: 20 });
  await keys('Enter');
  const renamed = await seen('.view-line', has('variants of carrot_laid'));
  holds('a name is changed wherever it is used', has('variants of carrot_laid')(renamed), renamed.slice(0, 12));
  await picture('renamed');

  // What is seen of a lens may be made anew while it is clicked at: until a terminal stands there.
  const terminal = '.terminal-tabs-entry, .single-terminal-tab';
  let terminals = [];
  for (let i = 0; i < 10 && !has('vlaprobe')(terminals); ++i) {
    for (const lens of await page.$$('.codelens-decoration a')) {
      const at = await lens.evaluate((one) => {
        const box = one.getBoundingClientRect(), x = box.x + box.width / 2, y = box.y + box.height / 2;
        return one.innerText.includes('starts') && document.elementFromPoint(x, y)?.closest('a') === one ? [x, y] : null;
      }).catch(() => null);
      if (!at) continue;
      await page.mouse.click(...at);
      break;
    }
    for (let k = 0; k < 10 && !has('vlaprobe')((terminals = await words(terminal))); ++k) await pause(1000);
  }
  holds('a lens runs in a terminal', has('vlaprobe')(terminals), terminals);
  await pause(5000);
  await picture('lens');
} finally {
  await browser.close();
  server.kill();
}
console.log(failures === 0 ? 'all is as it should be' : `${failures} are not as they should be`);
process.exit(failures === 0 ? 0 : 1);
