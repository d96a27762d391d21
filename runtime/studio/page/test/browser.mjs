// The studio in headless Chromium: node browser.mjs BUILD SOURCE OUT CASE. BUILD is the build folder, OUT gets texts and
// screenshots. Ends with "ok" and status 0, or names what is wrong.
import { mkdirSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";
import { lowContrast } from "../../../report/page/test/contrast.mjs";
import { chord, expect, launch, open, pause, serve, startStudio, until, wrong } from "./studio.mjs";

const [build, source, out, name] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const browser = await launch(build);
const studios = [];
const start = async (folder, text) => { const one = await startStudio(build, join(out, folder), text); studios.push(one); return one; };

const kText = `use "${source}/suite/intact.probe"

layout mine {
  place source at (-20cm, -8cm)
  place target at (-14cm, 6cm)
  orient by rest
  drop 50cm settle 0.5s
}
task own like carrot_on_plate { layout mine }
variant own_other of own { source eggplant }
suite small trained on bridge_v2 { tasks { own, own_other }; seeds 42 }
`;

const words = (page) => page.evaluate(() => ({ state: document.querySelector(".state").textContent, verdict: document.querySelector(".verdict").textContent, shown: document.documentElement.dataset.shown, start: document.querySelector(".seen input").value }));
const shown = (page, what = "full") => until(page, (size) => document.documentElement.dataset.shown?.includes(` ${size} `), `a ${what} picture`, what);
// The next one after what is done.
async function newPicture(page, act) {
  const before = await page.evaluate(() => document.documentElement.dataset.shown);
  await act();
  await until(page, (old) => { const now = document.documentElement.dataset.shown; return now !== old && / full /.test(now ?? ""); }, "another picture", before);
}
const textOf = (page) => page.evaluate(() => document.querySelector(".tabs [aria-selected=true]")?.title).then(() => page.$$eval(".view-line", (lines) => lines.map((line) => line.textContent.replaceAll("\u00a0", " ")).join("\n")));
// The text once it says so.
const says = (page, line) => until(page, (words) => [...document.querySelectorAll(".view-line")].some((one) => new RegExp(words).test(one.textContent.replaceAll("\u00a0", " "))), `the text says ${line}`, line);
const colours = (page) => page.$eval(".seen canvas", (canvas) => { const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data; const seen = new Set(); for (let i = 0; i < pixels.length; i += 4) seen.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]); return { width: canvas.width, height: canvas.height, colours: seen.size }; });

// From an empty file to a judged episode, without a mouse but where a thing is dragged.
async function author() {
  const studio = await start("author", null);
  const page = await open(browser, studio.address);
  await until(page, () => /no task yet/.test(document.querySelector(".state").textContent), "an empty text says that it has no task");
  // The editor has the focus and offers what may stand there.
  await page.keyboard.type("la", { delay: 30 });
  await until(page, () => [...document.querySelectorAll(".suggest-widget .monaco-list-row")].some((row) => /layout/.test(row.textContent)), "`la` offers `layout`");
  await page.screenshot({ path: join(out, "author-offers.png") });
  await page.keyboard.press("Escape");
  await chord(page, "Control", "a");
  await page.keyboard.press("Delete");
  // Without layout; the editor closes what is opened.
  for (const line of kText.trimEnd().split("\n")) {
    await page.keyboard.sendCharacter(line.trim());
    await page.keyboard.press("Escape");
    if (line.endsWith("{")) await page.keyboard.press("Delete");
    await page.keyboard.press("Enter");
  }
  await chord(page, "Control", "Shift", "i");
  for (let k = 0; k < 100 && (await textOf(page)) !== kText; ++k) await pause(50);
  await until(page, () => [...document.querySelectorAll(".view-line")].some((line) => /^\u00a0\u00a0place/.test(line.textContent)), "the layout of the text");
  // What the cursor stands in is what is seen.
  const to = async (line, task) => {
    await chord(page, "Control", "Home");
    for (let i = 1; i < line; ++i) await page.keyboard.press("ArrowDown");
    await until(page, (name) => document.documentElement.dataset.shown?.includes(` full ${name} `), `the picture of ${task}`, task);
  };
  await to(10, "own_other");
  await to(9, "own");
  await until(page, () => document.documentElement.dataset.top === "own", "the starts of own");
  const seen = await colours(page);
  expect(seen.width === 640 && seen.height === 480 && seen.colours > 1000, `the picture has ${seen.width} x ${seen.height} pixels of ${seen.colours} colours`);
  const marks = await page.$$eval(".task[aria-selected=true] mark", (list) => list.map((m) => [m.textContent, m.dataset.object, m.className]));
  expect(JSON.stringify(marks) === JSON.stringify([["carrot", "carrot", "role-source"], ["plate", "plate", "role-target"]]), `the instruction's words are ${JSON.stringify(marks)}`);
  const axes = await page.$$eval(".task.variant .axis", (list) => list.map((a) => a.textContent));
  expect(axes.length > 0 && axes[0] !== "moves nothing", `the variant moves ${axes}`);

  // A mistake: said, marked, and undone by the editor.
  await chord(page, "Control", "End");
  await page.keyboard.type("task broken like nobody { }", { delay: 5 });
  await page.keyboard.press("Escape");
  await until(page, () => /error/.test(document.querySelector(".state").textContent) && document.querySelector(".squiggly-error"), "a mistake is said and marked");
  await page.screenshot({ path: join(out, "author-mistake.png") });
  await newPicture(page, async () => { for (let i = 0; i < 8 && /error/.test((await words(page)).state); ++i) {
    await chord(page, "Control", "z");
    // On a busy machine the answer comes late, and another undo would take back what is right.
    for (let k = 0; k < 10 && /error/.test((await words(page)).state); ++k) await pause(150);
  } });
  expect(!/error/.test((await words(page)).state), "the mistake is undone and still told");
  await to(9, "own");

  // A thing is dragged: its numbers change, the picture follows, undo takes it back.
  const box = await page.$eval(".top g.now[data-object=carrot] polygon", (shape) => { const b = shape.getBoundingClientRect(); return { x: b.x + b.width / 2, y: b.y + b.height / 2 }; });
  const before = await textOf(page);
  await page.mouse.move(box.x, box.y);
  await page.mouse.down();
  await page.mouse.move(box.x + 12, box.y - 6, { steps: 4 });
  await page.mouse.up();
  await says(page, "place source at \\(-1\\d(\\.\\d)?cm, -[4-7](\\.\\d)?cm\\)");
  await pause(500);
  await page.evaluate(() => document.querySelector(".editor textarea, .editor .native-edit-context")?.focus());
  await newPicture(page, () => chord(page, "Control", "z"));
  expect((await textOf(page)) === before, "undo does not take the drag back");
  // The same by keys.
  await page.$eval(".top g.now[data-object=carrot]", (print) => print.focus());
  await newPicture(page, () => page.keyboard.press("ArrowRight"));
  await says(page, "place source at \\(-19cm, -8cm\\)");
  await until(page, () => document.activeElement?.dataset?.object === "carrot", "who moves by keys goes on with the same thing");

  // An episode, watched, judged, looked at again, explained; saved.
  await chord(page, "Control", "Enter");
  await until(page, () => document.querySelector(".play").dataset.state === "played", "the expert's episode ends");
  expect(/^success after \d+ steps/.test((await words(page)).verdict), `the expert's verdict is: ${(await words(page)).verdict}`);
  await page.focus(".play input[type=range]");
  await page.keyboard.press("Home");
  await until(page, () => document.querySelector(".play").dataset.step === "0", "the first step is looked at again");
  for (let i = 0; i < 6; ++i) await page.keyboard.press("ArrowRight");
  await until(page, () => document.querySelector(".play").dataset.step === "6", "the sixth step is looked at again");
  await page.focus(".light.truth");
  await page.keyboard.press("Enter");
  await until(page, () => document.querySelector(".play").dataset.why === "success" && document.querySelector(".reasons li.decides"), "success is explained");
  await page.screenshot({ path: join(out, "author-judged.png") });
  // A step as a start of its own, which undo takes out of the text again.
  await newPicture(page, () => page.evaluate(() => [...document.querySelectorAll(".play button")].find((b) => /Keep/.test(b.textContent)).click()));
  await until(page, () => / full own_kept_1 0/.test(document.documentElement.dataset.shown ?? ""), "the kept start is shown");
  expect(/it checks/.test((await words(page)).state), `with the kept start the page says ${(await words(page)).state}`);
  await page.screenshot({ path: join(out, "author-kept.png") });
  await newPicture(page, () => chord(page, "Control", "z"));
  await chord(page, "Control", "s");
  await until(page, () => document.documentElement.dataset.unsaved === "false", "it is saved");
  expect(studio.read() === kText.replace("(-20cm, -8cm)", "(-19cm, -8cm)"), `saved is\n${studio.read()}`);
  await page.close();
}

// Another page, another program's writing, a deleted file, the program's end.
async function bad() {
  const studio = await start("bad", kText);
  const page = await open(browser, studio.address);
  await shown(page);
  const second = await open(browser, studio.address, { ready: false });
  await until(second, () => /open in another page/.test(document.body.textContent), "the second page says that there is a first");
  await second.screenshot({ path: join(out, "bad-second.png") });
  await second.click("button");
  await until(second, () => document.documentElement.dataset.ready === "yes", "the second page takes over");
  await until(page, () => /Another page shows this studio now/.test(document.body.textContent), "the first page says that it was taken over");
  await page.close();
  await shown(second);
  studio.write(kText.replace("-20cm", "-18cm"));
  await until(second, () => /changed on the disk/.test(document.querySelector(".notices").textContent), "what another program wrote is told");
  await second.screenshot({ path: join(out, "bad-changed.png") });
  await newPicture(second, () => second.evaluate(() => [...document.querySelectorAll(".notice button")].find((b) => /disk's/.test(b.textContent)).click()));
  expect(/-18cm/.test(await textOf(second)), "the disk's text was not taken");
  rmSync(studio.file);
  await until(second, () => /was deleted on the disk/.test(document.querySelector(".notices").textContent), "a deleted file is told");
  await second.evaluate(() => [...document.querySelectorAll(".notice button")].find((b) => /again/.test(b.textContent)).click());
  await until(second, () => !document.querySelector(".notice"), "it is saved again");
  expect(/-18cm/.test(studio.read()), "the text that was deleted is not back");
  // The page of another origin: it neither reads nor opens a conversation.
  const foreign = await browser.newPage();
  await foreign.goto("data:text/html,<title>other</title>");
  const got = await foreign.evaluate(async (address) => {
    const page = await fetch(address).then(() => "read", () => "refused");
    const socket = await new Promise((done) => { const s = new WebSocket(address.replace("http", "ws") + "live"); s.onopen = () => done("open"); s.onerror = () => done("refused"); });
    const frame = document.createElement("iframe");
    frame.src = address;
    document.body.append(frame);
    await new Promise((done) => { frame.onload = done; setTimeout(done, 1500); });
    return { page, socket };
  }, studio.address);
  expect(got.page === "refused" && got.socket === "refused", `a page of another origin got ${JSON.stringify(got)}`);
  await foreign.close();
  await studio.end();
  studios.splice(studios.indexOf(studio), 1);
  await until(second, () => /has ended/.test(document.querySelector(".notices").textContent), "the program's end is told");
  expect(/-18cm/.test(await textOf(second)), "after the program's end the text is gone");
  await second.close();
}

// Both themes, both widths: nothing is cut off, every text has contrast, every pane is reached by keys.
async function looks() {
  const studio = await start("looks", kText);
  for (const [width, height, dark] of [[1280, 800, false], [1280, 800, true], [1920, 1080, false], [1920, 1080, true]]) {
    const page = await open(browser, studio.address, { width, height, dark });
    await shown(page);
    await chord(page, "Control", "Enter");
    await until(page, () => document.querySelector(".play").dataset.state === "played", "an episode ends");
    await page.click(".light.truth");
    await until(page, () => document.querySelector(".reasons li"), "it is explained");
    await until(page, () => document.documentElement.dataset.top === "own", "the starts are drawn");
    await pause(300);
    const label = `${width}${dark ? " dark" : ""}`;
    await page.screenshot({ path: join(out, `looks-${width}${dark ? "-dark" : ""}.png`) });
    for (const text of (await lowContrast(page, ".unseen, .monaco-editor, .top, button:disabled")).slice(0, 8)) wrong.push(`contrast, ${label}: ${text}`);
    const lost = await page.evaluate(() => ({ wide: document.documentElement.scrollWidth > innerWidth, tall: document.documentElement.scrollHeight > innerHeight, small: [...document.querySelectorAll("section.text, section.seen, section.above, section.said, section.play, .reasons, .timeline")].filter((e) => e.clientWidth < 180 || e.clientHeight < 50).map((e) => e.className), unnamed: [...document.querySelectorAll("button, input, select, canvas, [role=button]")].filter((e) => !e.closest(".monaco-editor") && !(e.textContent.trim() || e.getAttribute("aria-label") || e.closest("label"))).map((e) => e.outerHTML.slice(0, 80)) }));
    expect(!lost.wide && !lost.tall && !lost.small.length && !lost.unnamed.length, `${label}: ${JSON.stringify(lost)}`);
    const seen = [];
    await page.evaluate(() => document.querySelector(".editor textarea, .editor .native-edit-context").focus());
    for (let i = 0; i < 6; ++i) {
      seen.push(await page.evaluate(() => document.activeElement.closest("section, header")?.className || document.activeElement.closest("section, header")?.tagName));
      await page.keyboard.press("F6");
    }
    expect(JSON.stringify(seen) === JSON.stringify(["text", "seen", "above", "said", "play", "HEADER"]), `${label}: F6 goes over ${seen}`);
    // Tasks and starts by keys.
    await newPicture(page, () => chord(page, "Alt", "ArrowDown"));
    expect(/own_other/.test((await words(page)).shown), "Alt and the arrow do not lead to the next task");
    await newPicture(page, () => chord(page, "Alt", "PageDown"));
    expect((await words(page)).start === "1", "Alt and PageDown do not lead to the next start");
    await page.close();
  }
}

const kCameras = `use "${source}/examples/wrist_camera.probe"

task own like carrot_two_eyes { horizon 12 steps }
variant own_tilted of own { camera tilted as wrist }
suite small trained on bridge_v2 { tasks { own, own_tilted }; seeds 42 }
`;

// Several cameras and a policy behind a server, without a mouse; one that never answers is let go at once.
async function served() {
  const server = await serve(build, ["--policy", "digest", "--protocol", "openpi", "--port", "0"]);
  const silent = createServer(() => {});  // takes connections and says nothing
  await new Promise((done) => silent.listen(0, "127.0.0.1", done));
  const studio = await start("served", kCameras);
  try {
    for (const [width, height, dark] of [[1280, 800, false], [1280, 800, true], [1920, 1080, false], [1920, 1080, true]]) {
      const label = `${width}${dark ? " dark" : ""}`;
      const page = await open(browser, studio.address, { width, height, dark });
      await until(page, () => / full own 0/.test(document.documentElement.dataset.shown ?? ""), "a full picture");
      const cameras = await page.$$eval(".seen figure", (all) => all.map((one) => [one.textContent, one.querySelector("canvas").width, Math.round(one.querySelector("canvas").getBoundingClientRect().width), Math.round(one.querySelector("canvas").getBoundingClientRect().height)]));
      expect(cameras.length === 2 && cameras[0][0] === "third_view" && cameras[1][0] === "wrist" && cameras[1][1] === 224, `${label}: the cameras are ${JSON.stringify(cameras)}`);
      expect(cameras.every(([, , w, h]) => w >= 100 && h >= 60), `${label}: the pictures are ${JSON.stringify(cameras)}`);
      // To the pane of the episode, its policy typed in.
      await page.evaluate(() => document.querySelector(".editor textarea, .editor .native-edit-context").focus());
      for (let i = 0; i < 4; ++i) await page.keyboard.press("F6");
      expect(await page.evaluate(() => document.activeElement.getAttribute("aria-label")) === "Policy", `${label}: F6 does not lead to the policy`);
      await chord(page, "Control", "a");
      await page.keyboard.sendCharacter(server.address);
      await page.keyboard.press("Enter");
      await until(page, () => document.querySelector(".play").dataset.state === "played", "the served policy's episode ends");
      expect(/^no success after 12 steps/.test((await words(page)).verdict), `${label}: the served policy's verdict is ${(await words(page)).verdict}`);
      const seen = await page.$$eval(".play figure figcaption", (all) => all.map((one) => one.textContent));
      expect(JSON.stringify(seen) === JSON.stringify(["third_view", "wrist"]), `${label}: the episode shows ${seen}`);
      await page.screenshot({ path: join(out, `served-${width}${dark ? "-dark" : ""}.png`) });
      for (const text of (await lowContrast(page, ".unseen, .monaco-editor, .top, button:disabled")).slice(0, 8)) wrong.push(`contrast, ${label}: ${text}`);
      const lost = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth || document.documentElement.scrollHeight > innerHeight || [...document.querySelectorAll(".bar > *")].some((e) => e.getBoundingClientRect().right > e.parentElement.getBoundingClientRect().right + 1));
      expect(!lost, `${label}: something does not fit`);
      if (width === 1280 && !dark) {
        // A server that says nothing: it is told who is waited for, and Stop stops.
        await chord(page, "Control", "a");
        await page.keyboard.sendCharacter(`openpi://127.0.0.1:${silent.address().port}`);
        await page.keyboard.press("Enter");
        await until(page, () => document.querySelector(".play").dataset.state === "playing", "it is waited for");
        await page.keyboard.press("Tab");
        await page.keyboard.press("Tab");
        await page.keyboard.press("Tab");
        expect(await page.evaluate(() => document.activeElement.textContent) === "Stop", "Stop is not reached by keys");
        const begun = Date.now();
        await page.keyboard.press("Enter");
        await until(page, () => document.querySelector(".play").dataset.state === "stopped", "it is stopped");
        expect(Date.now() - begun < 3000, `to stop took ${Date.now() - begun} ms`);
        // The page goes on.
        await newPicture(page, () => chord(page, "Alt", "PageDown"));
        await page.focus(".play input[aria-label=Policy]");
        await chord(page, "Control", "a");
        await page.keyboard.sendCharacter("openpi://127.0.0.1:1?timeout.wait_s=0.2");
        await page.keyboard.press("Enter");
        await until(page, () => /127.0.0.1:1/.test(document.querySelector(".verdict").textContent) && document.querySelector(".play").dataset.state !== "playing", "who is not there is told");
        expect(await page.evaluate(() => document.querySelector(".reasons").textContent === document.querySelector(".verdict").textContent), "what the line cuts is not read below it");
        await page.screenshot({ path: join(out, "served-absent.png") });
      }
      await page.close();
    }
  } finally {
    await server.end();
    silent.close();
    silent.closeAllConnections?.();
  }
}

const cases = { author, bad, looks, served };
try {
  if (!cases[name]) throw new Error(`there is no case ${name}`);
  await cases[name]();
} catch (error) {
  wrong.push(error.message);
  for (const [i, page] of (await browser.pages()).entries()) await page.screenshot({ path: join(out, `${name}-failed-${i}.png`) }).catch(() => {});
}
await browser.close();
for (const studio of studios) await studio.end();
console.log(wrong.length ? wrong.join("\n") : "ok");
process.exit(wrong.length ? 1 : 0);
