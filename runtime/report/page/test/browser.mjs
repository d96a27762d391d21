// Opens pages of made-up results in headless Chromium and looks at them: node browser.mjs BUILD OUT CASE [PAGE]. BUILD is the
// folder of build.mjs with its packages, OUT gets pages and screenshots. Ends with "ok" and status 0, or names what is wrong.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { lowContrast } from "./contrast.mjs";
import { embed, kHostile, sample } from "./sample.mjs";

const [build, out, name, given] = process.argv.slice(2);
const require = createRequire(pathToFileURL(join(build, "package.json")));
const puppeteer = await import(pathToFileURL(require.resolve("puppeteer-core")).href);
const launch = (puppeteer.default ?? puppeteer).launch;
mkdirSync(out, { recursive: true });

const kPanels = ["main", "radar", "gap", "knows", "compare", "deltas", "language", "heatmap", "objects", "cases", "events", "tasks", "floors", "confounded", "invalid", "delivery", "runs"];
const wrong = [];
const expect = (holds, what) => { if (!holds) wrong.push(what); };
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
const browser = await launch({ executablePath: chromium, headless: true, args: ["--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--font-render-hinting=none"] });

function written(file, options, edit = () => {}) {
  const path = join(out, file);
  const made = sample(options);
  edit(made.data);
  writeFileSync(path, embed(readFileSync(join(build, "before.html"), "utf8"), readFileSync(join(build, "after.html"), "utf8"), made));
  return path;
}

// Opens, waits until the page says it is complete, and draws everything by scrolling through. Errors of any kind are wrong.
async function open(path, { width = 1440, dark = false, hash = "" } = {}) {
  const page = await browser.newPage();
  await page.setViewport({ width, height: 900 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  page.on("pageerror", (error) => wrong.push(`script error: ${error.message}`));
  page.on("console", (message) => {
    // A video that is not there is said in the page.
    if (["error", "warn"].includes(message.type()) && !/ERR_FILE_NOT_FOUND/.test(message.text())) wrong.push(`console: ${message.text()}`);
  });
  page.on("request", (request) => expect(/^(file|data|blob):/.test(request.url()), `fetched ${request.url()}`));
  page.on("dialog", (dialog) => { wrong.push("a dialog opened"); dialog.dismiss(); });
  await page.goto(pathToFileURL(path).href + hash);
  await page.waitForSelector("html[data-ready=yes]", { timeout: 30000 }).catch(() => wrong.push(`${path} never became ready`));
  const ready = await page.evaluate(() => performance.now());
  await page.evaluate(async () => {
    for (let y = 0; y < document.body.scrollHeight; y += 600) { scrollTo(0, y); await new Promise((done) => setTimeout(done, 40)); }
    scrollTo(0, 0);
  });
  await pause(200);
  return { page, ready };
}

async function checkPanels(page) {
  const found = await page.evaluate(() => [...document.querySelectorAll("main section")].map((s) => ({
    id: s.id, title: s.querySelector("h2")?.textContent, text: s.innerText.length, broken: /could not be drawn/.test(s.textContent),
    silent: !!s.querySelector(".nothing") && !s.querySelector("select, input, table, svg, details"), height: s.offsetHeight,
    empty: [...s.querySelectorAll(".chart")].filter((c) => !c.querySelector("svg")).length,
    unnamed: [...s.querySelectorAll(".chart, svg[role=img], select, input, .scroller")].filter((e) => !e.getAttribute("aria-label") && !document.querySelector(`label[for="${e.id}"]`) && !e.closest("label")).length })));
  expect(JSON.stringify(found.map((f) => f.id)) === JSON.stringify(kPanels), `panels are ${found.map((f) => f.id)}`);
  for (const f of found) {
    expect(f.title && f.text > 25, `panel ${f.id} is empty`);
    expect(!f.broken, `panel ${f.id} could not be drawn`);
    expect(f.empty === 0, `panel ${f.id} has ${f.empty} charts that were not drawn`);
    expect(!f.silent || f.height < 90, `panel ${f.id} has nothing to say and takes ${f.height} px to say it`);
    expect(f.unnamed === 0, `panel ${f.id} has ${f.unnamed} parts without a name for screen readers`);
  }
}

async function checkContrast(page, theme) {
  for (const text of (await lowContrast(page)).slice(0, 8)) wrong.push(`contrast, ${theme}: ${text}`);
}

const focused = (page) => page.evaluate(() => { const e = document.activeElement; return { tag: e.tagName, text: e.textContent?.slice(0, 60), type: e.type ?? "", id: e.id, panel: e.closest("section, aside")?.id ?? "", label: e.getAttribute("aria-label") ?? "", visible: !!e.getClientRects().length, className: e.getAttribute("class") ?? "" }; });

async function checkKeyboard(page) {
  await page.evaluate(() => { document.activeElement?.blur(); scrollTo(0, 0); });
  await page.keyboard.press("Tab");
  const first = await focused(page);
  expect(/Skip/.test(first.text), `the first stop is ${first.tag} ${first.text}, not the skip link`);
  const seen = new Set(), panels = new Set();
  for (let i = 0; i < 700; ++i) {
    const at = await focused(page);
    seen.add(at.tag + (at.type ? `:${at.type}` : ""));
    if (at.panel) panels.add(at.panel);
    expect(at.tag === "BODY" || at.visible, `focus on something that is not to be seen: ${at.tag} ${at.text}`);
    if (at.tag === "BODY" && i > 3) break;
    await page.keyboard.press("Tab");
  }
  for (const kind of ["A", "SELECT:select-one", "INPUT:checkbox", "INPUT:search", "BUTTON:button", "DIV"]) expect(seen.has(kind), `Tab never reaches a ${kind}; it reached ${[...seen]}`);
  // A panel that has nothing to show has nothing to reach.
  const filled = await page.$$eval("main section", (list) => list.filter((e) => e.querySelector(".scroller, select")).map((e) => e.id));
  for (const id of filled) expect(panels.has(id), `Tab reaches nothing in panel ${id}`);
  // A task by its link, a start by arrows and Enter, a step by the slider.
  const task = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).episodes.task[0]);
  await page.focus(`#tasks tbody a[href="#task-${task}"]`);
  await page.keyboard.press("Enter");
  await pause(100);
  expect((await focused(page)).id === "task-title", "Enter on a task does not lead to it");
  await page.focus(".starts button[tabindex='0']");
  const before = (await focused(page)).label;
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowDown");
  const after = (await focused(page)).label;
  expect(after && after !== before, "arrow keys do not move over the starts");
  await page.keyboard.press("Enter");
  await pause(100);
  expect(await page.$(".episode h3"), "Enter on a start does not open its episode");
  if (await page.$(".timeline .cursor")) {
    await page.focus("#scrub");
    const x = () => page.$eval(".timeline .cursor", (c) => c.getAttribute("x1"));
    const from = await x();
    await page.keyboard.press("ArrowRight");
    expect((await x()) !== from, "the slider does not move the timeline's cursor");
    const told = await page.$eval(".timeline", (t) => t.getAttribute("aria-label"));
    // What happened in a made page is known; in a given one an episode reaches its object, at least.
    const event = given ? /reached it: step \d+ \(/ : /dropped: step 31 \(/;
    expect(event.test(told), `the timeline does not tell of events: ${told.slice(0, 80)}`);
    const marks = (await page.$$(".timeline .event, .timeline .subgoal")).length;
    expect(given ? marks > 0 : marks === 5, `the timeline marks ${marks} events`);
  } else {
    wrong.push("the opened episode has no timeline");
  }
  expect(/vlaprobe why /.test(await page.$eval(".episode", (e) => e.textContent)), "an episode does not say how to ask why");
}

async function shots(page, prefix, ids) {
  for (const id of ids) await (await page.$(`#${id}`)).screenshot({ path: join(out, `${prefix}-${id}.png`) });
}

// What a page of hostile names may not do.
async function checkInert(page) {
  const state = await page.evaluate(() => ({
    pwned: window.pwned, handlers: [...document.querySelectorAll("*")].filter((e) => [...e.attributes].some((a) => /^on/i.test(a.name))).length,
    images: document.querySelectorAll("img, iframe, object, embed, base, form").length,
    links: [...document.querySelectorAll("[href], [src]")].filter((e) => /^\s*javascript:/i.test(e.getAttribute("href") ?? e.getAttribute("src"))).length,
    scripts: document.querySelectorAll("script:not([type])").length, text: document.body.innerText, title: document.title }));
  expect(state.pwned === undefined, `a name was run: ${state.pwned}`);
  expect(state.handlers === 0 && state.images === 0 && state.links === 0 && state.scripts === 1, `names became elements: ${JSON.stringify({ ...state, text: "" })}`);
  for (const text of kHostile) expect(state.text.includes(text.replace(/\u2028/g, "").slice(0, 4)), `a name is not shown as text: ${text}`);
  expect(state.text.includes(kHostile[0]) && state.text.includes(kHostile[1]) && state.title === kHostile[1], "names are not shown as they are");
}

const kCases = {
  // Six policies with 3,640 episodes each.
  async large() {
    const { page, ready } = await open(written("large.html", { policies: 6, starts: 26, seeds: [1, 2, 3, 4, 5], packs: true }));
    console.log(`6 policies, 21,840 episodes: complete after ${(ready / 1000).toFixed(2)} s`);
    expect(ready < 15000, `the page needed ${ready} ms`);
    await checkPanels(page);
    await page.pdf({ path: join(out, "large.pdf"), preferCSSPageSize: true, printBackground: true, timeout: 120000 });
    expect(readFileSync(join(out, "large.pdf")).length > 50000, "the printed page is empty");
  },
  async light() {
    const { page } = await open(written("six.html", { policies: 6 }));
    await checkPanels(page);
    await page.screenshot({ path: join(out, "light-page.png") });
    await shots(page, "light", kPanels);
    await checkKeyboard(page);
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = true; }));
    await checkContrast(page, "light");
    await shots(page, "light-open", ["tasks"]);
  },
  async dark() {
    const { page } = await open(written("six-dark.html", { policies: 6 }), { dark: true, hash: "#episode-1500" });
    await checkPanels(page);
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = true; }));
    await checkContrast(page, "dark");
    await page.screenshot({ path: join(out, "dark-page.png") });
    await shots(page, "dark", ["radar", "tasks", "heatmap"]);
  },
  async hostile() {
    const { page } = await open(written("hostile.html", { policies: 8, hostile: true }));
    await checkPanels(page);
    await checkInert(page);
    for (const hash of ["#episode-3", "#episode-40", "#task-2"]) {
      await page.evaluate((h) => { location.hash = h; }, hash);
      await pause(150);
    }
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = true; }));
    await checkInert(page);
    await page.screenshot({ path: join(out, "hostile-page.png") });
  },
  async few() {
    for (const [file, options] of [["none", { only: "none" }], ["invalid", { only: "invalid", policies: 2 }], ["partial", { only: "partial" }], ["one", { policies: 1 }], ["nobody", { policies: 0 }]]) {
      const { page } = await open(written(`${file}.html`, options));
      const before = wrong.length;
      await checkPanels(page);
      await page.screenshot({ path: join(out, `${file}-page.png`), fullPage: true });
      for (let i = before; i < wrong.length; ++i) wrong[i] = `${file}: ${wrong[i]}`;
    }
    const broken = join(out, "broken.html");
    writeFileSync(broken, readFileSync(join(build, "before.html"), "utf8") + readFileSync(join(build, "after.html"), "utf8"));
    const page = await browser.newPage();
    await page.goto(pathToFileURL(broken).href);
    expect(/cannot be shown/.test(await page.evaluate(() => document.body.innerText)), "a page without results says nothing");
  },
  async many() {
    const { page, ready } = await open(written("many.html", { policies: 50 }));
    console.log(`50 policies, 33,600 episodes: complete after ${(ready / 1000).toFixed(2)} s`);
    await checkPanels(page);
    await page.screenshot({ path: join(out, "many-page.png") });
    await shots(page, "many", ["radar", "cases"]);
  },
  async narrow() {
    const { page } = await open(written("narrow.html", { policies: 4 }), { width: 420, hash: "#episode-40" });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    expect(wide <= 0, `the page is ${wide} px wider than a narrow window`);
    await page.screenshot({ path: join(out, "narrow-page.png") });
  },
  // As tests/runtime/base/percent_test.cpp has it for the other formats.
  async numbers() {
    const edit = (data) => { data.tables.main.rows[0].all = [63, 1200, 0.041, 0.067]; data.tables.main.rows[1].all = [1200, 1200, 0.9968, 1]; };
    const { page } = await open(written("numbers.html", { policies: 1 }, edit));
    const text = await page.$eval("section#main", (e) => e.innerText);
    expect(/5\.3\s+63\/1,200/.test(text), `63 of 1200 is not 5.3 in: ${text.slice(0, 400)}`);
    expect(text.includes("99.7\u2013100.0"), `an interval with width looks as if it had none in: ${text.slice(0, 400)}`);
  },
  // A sentence that holds for every model and question is said once, a question once with all its models.
  async knowing() {
    const edit = (data) => {
      const rows = data.tables.knows, whole = { counts: [0, 0, 0, 0, 0, 0, 200, 1000], diff: 0, low: 0, high: 0 };
      data.tables.knows = rows.flatMap((r) => (r.policy ? [r, { ...r, family: 1 }] : [0, 1].map((family) => ({ ...r, ...whole, family, says: "in every episode a policy went for the right object" }))));
    };
    const { page } = await open(written("knowing.html", { policies: 2 }, edit));
    const chosen = await page.$$eval("section#knows li", (all) => all.map((e) => e.innerText));
    expect(chosen.filter((text) => text.includes("episode")).length === 3 && !chosen.some((text) => text.includes("restate")), `of the first question is said: ${chosen}`);
    await page.select(await page.$$eval("section#knows label", (all) => `#${CSS.escape(all.find((e) => e.innerText === "Beside policies").htmlFor)}`), "2");
    const said = await page.$$eval("section#knows li", (all) => all.map((e) => e.innerText));
    expect(said.filter((text) => text === "In every episode a policy went for the right object.").length === 1, `what holds for every question is said so: ${said}`);
    expect(said.filter((text) => /named it in 73 \(understanding\.source, understanding\.restate\)\.$/.test(text)).length === 2, `what one model named is said so: ${said}`);
    const asked = await page.$$eval("section#knows table:first-of-type td[rowspan='2'] b", (all) => all.map((e) => e.innerText));
    expect(JSON.stringify(asked) === JSON.stringify(["understanding.source", "understanding.restate"]), `questions of two models: ${asked}`);
  },
  // More truths than one number holds.
  async truths() {
    const edit = (data) => {
      const first = data.metrics.length;
      for (let i = first; i < 75; ++i) data.metrics.push({ name: `own_${i}`, label: `Own ${i}`, truth: true, good: 0 });
      for (const task of data.tasks) task.metrics = data.metrics.map((_, i) => i);
      const e = data.episodes;
      e.reason[0] = -1;
      e.bits[0] = 2 ** 52 - 1 - 2 ** 51;
      e.more_bits = [e.bits.map((_, i) => (i === 0 ? 2 ** 23 - 1 : 0))];
    };
    const { page } = await open(written("truths.html", { policies: 1 }, edit), { hash: "#episode-0" });
    const no = await page.$$eval("ul.verdicts li", (all) => [all.length, ...all.filter((e) => e.className !== "yes").map((e) => e.innerText)]);
    expect(no[0] === 75 && no.length === 2 && no[1].includes("Own 51"), `of 75 truths without the 51st there is said: ${no}`);
  },
  // What is certain on these starts and not elsewhere is said so, in words and in numbers.
  async questions() {
    const edit = (data) => {
      const row = data.tables.compare[0];
      row.on_these_starts = { units: 144, low: 0.97, high: 1, p: 1.8e-43, p_adjusted: 5e-42, real: true };
      row.for_starts_never_tried = { units: 6, low: 0.45, high: 1, p: 0.03125, p_adjusted: 0.1875, real: false, more: 2 };
      row.diff = 1;
    };
    const { page } = await open(written("questions.html", { policies: 3 }, edit));
    const text = await page.$eval("section#compare tbody tr", (e) => e.innerText.replace(/\s+/g, " "));
    expect(text.includes("144 +97 to +100 < 0.001 p < 0.001 6 +45 to +100 0.19 p 0.031 real on these starts; elsewhere cannot tell, about 2 more places would"), `the pair reads: ${text}`);
    for (const id of ["compare", "deltas"]) {
      const head = await page.$eval(`section#${id} table.questions thead`, (e) => e.innerText);
      expect(/On these starts/i.test(head) && /For starts never tried/i.test(head), `${id} does not name both questions: ${head}`);
      const wide = await page.$eval(`section#${id} table.questions`, (e) => e.offsetWidth - e.closest(".scroller").clientWidth);
      expect(wide <= 0, `the table of ${id} is ${wide} px wider than a laptop's window`);
    }
    await shots(page, "questions", ["compare", "deltas", "gap"]);
  },
  // A page that the program wrote.
  async given() {
    const { page, ready } = await open(given);
    console.log(`${given}: complete after ${(ready / 1000).toFixed(2)} s`);
    await checkPanels(page);
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = true; }));
    await checkContrast(page, "light");
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => { d.open = false; }));
    await page.screenshot({ path: join(out, "report-page.png") });
    await shots(page, "report", kPanels);
    if (await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).episodes.count > 0)) {
      await checkKeyboard(page);
      await shots(page, "report-open", ["tasks"]);
    }
  },
};

if (!kCases[name]) throw new Error(`no such case: ${name}`);
try {
  await kCases[name]();
} catch (error) {
  wrong.push(`${error.stack ?? error}`);
}
await browser.close();
for (const text of wrong.slice(0, 25)) console.log(`wrong: ${text}`);
console.log(wrong.length ? `${wrong.length} wrong` : "ok");
process.exitCode = wrong.length ? 1 : 0;
