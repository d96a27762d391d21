// A studio and a browser for tests: `vlaprobe studio` is started for a text in a folder of its own, Chromium opens its address.
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

export const wrong = [];
export const expect = (holds, what) => { if (!holds) wrong.push(what); };
export const pause = (ms) => new Promise((done) => setTimeout(done, ms));

export async function launch(build) {
  const require = createRequire(pathToFileURL(join(build, "report_page", "package.json")));
  const puppeteer = await import(pathToFileURL(require.resolve("puppeteer-core")).href);
  const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
  return (puppeteer.default ?? puppeteer).launch({ executablePath: chromium, headless: true, args: ["--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--font-render-hinting=none"] });
}

// {address, file, folder, read(), write(text), end()}
export async function startStudio(build, folder, text) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const file = join(folder, "my.probe");
  if (text !== null) writeFileSync(file, text);
  const program = spawn(join(build, "vlaprobe"), ["studio", file], { stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((found, failed) => {
    createInterface(program.stdout).once("line", found);
    program.once("exit", (code) => failed(new Error(`vlaprobe studio ended with ${code}`)));
  });
  return { address, file, folder, pid: program.pid, read: () => readFileSync(file, "utf8"), write: (words) => writeFileSync(file, words), end: () => new Promise((done) => {
    program.removeAllListeners("exit");
    program.once("exit", done);
    program.kill("SIGTERM");
    setTimeout(() => { wrong.push("vlaprobe studio does not end"); program.kill("SIGKILL"); }, 10000).unref();
  }) };
}

// A policy server of ours: {address, end()}
export async function serve(build, words) {
  const program = spawn(join(build, "vlaprobe"), ["serve", ...words], { stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((found, failed) => {
    createInterface(program.stdout).once("line", found);
    program.once("exit", (code) => failed(new Error(`vlaprobe serve ended with ${code}`)));
  });
  return { address, end: () => new Promise((done) => { program.removeAllListeners("exit"); program.once("exit", done); program.kill("SIGTERM"); }) };
}

// Errors of any kind are wrong, and so is what is asked of another place than the studio.
export async function open(browser, address, { width = 1280, height = 800, dark = false, ready = true } = {}) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  page.on("pageerror", (error) => wrong.push(`script error: ${error.message}`));
  page.on("console", (message) => { if (["error", "warn"].includes(message.type())) wrong.push(`console: ${message.text()}`); });
  page.on("request", (request) => expect(/^(data|blob):/.test(request.url()) || request.url().startsWith(new URL(address).origin), `fetched ${request.url()}`));
  page.on("dialog", (dialog) => dialog.accept());
  await page.goto(address);
  if (ready) await until(page, () => document.documentElement.dataset.ready === "yes", "ready");
  return page;
}

export async function until(page, condition, what, ...given) {
  if (process.env.STUDIO_TEST_STEPS) console.error(what);
  await page.waitForFunction(condition, { timeout: 20000 }, ...given).catch(async () => {
    const now = await page.evaluate(() => `${document.querySelector(".state")?.textContent} / ${JSON.stringify({ ...document.documentElement.dataset })} / ${document.querySelector(".verdict")?.textContent} / ${document.querySelector(".notices")?.textContent}`).catch(() => "the page is gone");
    throw new Error(`never: ${what}; the page says: ${now}; ${wrong.join("; ")}`);
  });
}

export async function chord(page, ...keys) {
  for (const key of keys.slice(0, -1)) await page.keyboard.down(key);
  await page.keyboard.press(keys.at(-1));
  for (const key of keys.slice(0, -1).reverse()) await page.keyboard.up(key);
}
