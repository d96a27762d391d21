// client.mjs PACKAGES VLAPROBE SUITE FOLDER: `vlaprobe mcp` asked by the protocol's own client, which holds every answer of a
// tool to the schema that the tool lists.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [packages, program, suite, folder] = process.argv.slice(2);
const require = createRequire(join(packages, "x.js"));
const load = (name) => import(pathToFileURL(require.resolve(`@modelcontextprotocol/sdk/${name}`)));
const { Client } = await load("client/index.js");
const { StdioClientTransport } = await load("client/stdio.js");
const Ajv = require("ajv/dist/2020.js").default ?? require("ajv/dist/2020.js");

const mistakes = [];
const expect = (sentence, truth, shown = "") => { if (!truth) mistakes.push(`${sentence} ${typeof shown === "string" ? shown : JSON.stringify(shown)}`); };
mkdirSync(folder, { recursive: true });
const client = new Client({ name: "test", version: "1" });
await client.connect(new StdioClientTransport({ command: program, args: ["mcp"], stderr: "inherit" }));
expect("the server says who it is", client.getServerVersion()?.name === "vlaprobe");
await client.ping();

const { tools } = await client.listTools();
const kTools = ["check", "explain", "list", "show", "draw", "preview", "run", "results", "why", "compare", "gate"];
expect("every tool is listed", kTools.join() === tools.map((tool) => tool.name).join(), tools.map((tool) => tool.name));
const ajv = new Ajv({ strict: true });
const inputs = new Map();
for (const tool of tools) {
  for (const kind of ["inputSchema", "outputSchema"]) expect(`${kind} of ${tool.name} is a schema`, ajv.validateSchema(tool[kind]), ajv.errorsText());
  inputs.set(tool.name, ajv.compile(tool.inputSchema));
  expect(`${tool.name} says what it does`, tool.description.length > 20);
}

// Arguments that fit the schema are taken, others are refused by both.
async function call(name, args, fails = false) {
  const fits = inputs.get(name)(args);
  const result = await client.callTool({ name, arguments: args });
  if (fails !== (result.isError === true)) mistakes.push(`${name} ${JSON.stringify(args)}: ${JSON.stringify(result).slice(0, 600)}`);
  if (!fits) expect(`${name} refuses what its schema refuses`, result.isError === true, args);
  return result;
}
const text = (result) => result.content[0]?.text ?? "";

const bad = join(folder, "bad.probe");
writeFileSync(bad, "task x { source nothing }\n");
expect("a suite has no findings", (await call("check", { files: [suite] })).structuredContent.diagnostics.length === 0);
const found = await call("check", { files: [bad] });
expect("a mistake is data", found.structuredContent.diagnostics.length > 0 && /^P/.test(found.structuredContent.diagnostics[0].code), found);
expect("and has an essay", text(await call("explain", { code: found.structuredContent.diagnostics[0].code })).length > 200);
const tasks = (await call("list", { file: suite })).structuredContent.tasks;
expect("tasks are listed", tasks.some((task) => task.task === "carrot_on_plate"));
expect("a task is shown whole", (await call("show", { file: suite, task: "carrot_on_plate" })).structuredContent.task.task === "carrot_on_plate");
expect("starts are drawn", text(await call("draw", { file: suite, task: "carrot_on_plate" })).startsWith("<svg"));
const picture = await call("preview", { file: suite, task: "carrot_on_plate", start: 0 });
expect("the first picture is a picture", picture.content[0].type === "image" && Buffer.from(picture.content[0].data, "base64").subarray(1, 4).toString() === "PNG");

const run = async (policy, out) => {
  for (let i = 0; i < 30; ++i) {
    const { structuredContent: { run } } = await call("run", { file: suite, policy, out, tasks: "carrot_on_plate", episodes: "0-1", wait_s: 10 });
    if (!run.is_running) return run;
  }
  return {};
};
const [a, b] = ["null", "expert"].map((policy) => join(folder, policy));
expect("a run ends with its counts", (await run("null", a)).episodes === 2);
expect("another one, too", (await run("expert", b)).rates?.find((rate) => rate.name === "success").k === 2);
const results = (await call("results", { dir: a })).structuredContent.results;
expect("failures are told", results.newest_failures.length === 2, results);
expect("a verdict is explained", Object.keys((await call("why", { dir: a, task: "carrot_on_plate", episode: 1 })).structuredContent.why).length > 0);
expect("runs are compared", (await call("compare", { a: b, b: a })).structuredContent.comparison.words.length > 0);
expect("a gate has a verdict", text(await call("gate", { new: b, against: a, allow: "2%" })).includes("verdict"));

for (const [name, args] of [["check", {}], ["check", { files: [] }], ["check", { files: ["--watch"] }], ["show", { file: suite }], ["run", { file: suite, policy: "null", out: "-o" }],
  ["why", { dir: a, task: "carrot_on_plate", episode: -1 }], ["why", { dir: a, task: "carrot_on_plate", episode: "1" }], ["list", { file: suite, more: 1 }]]) await call(name, args, true);
for (const [name, args] of [["list", { file: join(folder, "absent.probe") }], ["results", { dir: folder }], ["why", { dir: a, task: "carrot_on_plate", episode: 7 }],
  ["run", { file: suite, policy: "nobody", out: join(folder, "no") }], ["explain", { code: "P9999" }]]) await call(name, args, true);
await client.callTool({ name: "rm", arguments: {} }).then(() => mistakes.push("a tool that is none was called"), () => {});

// Of answers that are too long an agent is told that they are, and is given no part of an object.
const many = join(folder, "many.probe");
writeFileSync(many, `use "${suite}"\n` + Array.from({ length: 700 }, (_, i) => `variant again_${i} of carrot_on_plate { say drop_on }\n`).join(""));
const cut = await call("list", { file: many });
expect("tasks are cut to what is read", JSON.stringify(cut.structuredContent).length < 70_000 && cut.structuredContent.tasks.length > 50, JSON.stringify(cut).length);
expect("and the rest is counted", /\d+ more are left out/.test(text(cut)), text(cut).slice(0, 200));

// A run does not outlive whoever asked for it, however that ends.
for (const signal of ["SIGTERM", "SIGKILL"]) {
  const second = new Client({ name: "test", version: "1" });
  const transport = new StdioClientTransport({ command: program, args: ["mcp"], stderr: "inherit" });
  await second.connect(transport);
  const out = join(folder, `left-${signal}`);
  await second.callTool({ name: "run", arguments: { file: suite, policy: "expert", out, wait_s: 3 } });
  const alive = () => readdirSync("/proc").some((name) => {
    try { return /^\d+$/.test(name) && readFileSync(`/proc/${name}/cmdline`, "utf8").includes(`\0${out}\0`); } catch { return false; }
  });
  expect(`the run goes on (${signal})`, alive());
  process.kill(transport.pid, signal);
  for (let i = 0; i < 100 && alive(); ++i) await new Promise((done) => setTimeout(done, 100));
  expect(`the run ended with its server (${signal})`, !alive());
  await second.close().catch(() => {});
}

await client.close();
for (const mistake of mistakes) console.error(mistake);
process.exit(mistakes.length ? 1 : 0);
