// Types edits into the studio and measures: node latency.mjs BUILD SOURCE OUT [KEYS]. Prints, in ms, how long it takes to open; from a
// keystroke to its small and its full picture; each kind of answer about the text; and the processor time of the program. Another
// program's load is in the figures: it prints the machine's as well.
import { readFileSync } from "node:fs";
import { loadavg } from "node:os";
import { join } from "node:path";
import { chord, launch, open, pause, startStudio, until, wrong } from "./studio.mjs";

const [build, source, out, keys = "60"] = process.argv.slice(2);
const kText = readFileSync(join(source, "suite/intact.probe"), "utf8").replace(/use "(?!std)/g, `use "${source}/suite/`);
const median = (list, share = 0.5) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(list.length * share))];
const told = (name, list) => list.length && console.log(`${name.padEnd(44)} ${median(list).toFixed(1).padStart(8)} ${median(list, 0.95).toFixed(1).padStart(8)} ${String(list.length).padStart(5)}`);
// User and system time of the program so far, in ms.
const cpu = (pid) => { const part = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" "); return (Number(part[11]) + Number(part[12])) * 10; };

const browser = await launch(build);
const studio = await startStudio(build, join(out, "latency"), kText);
await (await open(browser, studio.address)).close();  // the browser's own beginnings are not ours
await pause(500);
const opened = [], pictured = [];
for (let i = 0; i < 5; ++i) {
  const page = await open(browser, studio.address);
  opened.push(await page.evaluate(() => performance.getEntriesByName("ready")[0].startTime));
  await until(page, () => / full /.test(document.documentElement.dataset.shown ?? ""), "a picture");
  pictured.push(await page.evaluate(() => performance.now()));
  await page.close();
  await pause(300);
}
const page = await open(browser, studio.address);
await until(page, () => document.documentElement.dataset.top, "the starts");
await page.evaluate(() => performance.clearMeasures());
const before = cpu(studio.pid);
const begun = Date.now();
// A number that is typed again and again, and a word with what is offered for it.
await chord(page, "Control", "End");
await page.keyboard.type("\n# a note", { delay: 120 });
for (let i = 0; i < Number(keys); ++i) {
  await page.keyboard.press(i % 20 < 10 ? "x" : "Backspace");
  await pause(250);
}
await page.keyboard.press("Enter");
await page.keyboard.press("Backspace");
await page.keyboard.press("Enter");
for (let i = 0; i < 3; ++i) {
  await chord(page, "Control", "End");
  await page.keyboard.type("task ta", { delay: 150 });
  await page.keyboard.press("Escape");
  for (let k = 0; k < 7; ++k) await page.keyboard.press("Backspace");
}
await pause(1000);
const spent = cpu(studio.pid) - before;
const all = await page.evaluate(() => performance.getEntriesByType("measure").map(({ name, duration }) => ({ name, duration })));
const by = Map.groupBy ? Map.groupBy(all, (one) => one.name) : all.reduce((map, one) => map.set(one.name, [...(map.get(one.name) ?? []), one]), new Map());
console.log(`load of the machine ${loadavg()[0].toFixed(1)}; the program took ${spent} ms of processor time in ${Date.now() - begun} ms`);
console.log(`${"ms".padEnd(44)} ${"median".padStart(8)} ${"95 %".padStart(8)} ${"n".padStart(5)}`);
told("opening until it can be typed in", opened);
told("opening until the first picture", pictured);
for (const [name, list] of [...by].sort()) told(name, list.map((one) => one.duration));
await browser.close();
await studio.end();
if (wrong.length) console.log(wrong.join("\n"));
process.exit(wrong.length ? 1 : 0);
