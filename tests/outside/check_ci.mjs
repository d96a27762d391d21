// check_ci.mjs PACKAGES: examples/ci against what GitHub and GitLab take, and a manifest against Kubernetes' API.
//   node check_ci.mjs NODE_MODULES ci
//   node check_ci.mjs NODE_MODULES k8s JOB.yaml MERGE.yaml
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const [packages, what, ...files] = process.argv.slice(2);
const require = createRequire(join(packages, "x.js"));
const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const mistakes = [];
const { parse, parseAllDocuments } = require("yaml");

if (what === "ci") {
  const { validateWorkflow } = require("@action-validator/core");
  const text = readFileSync(join(root, "examples/ci/github-actions.yml"), "utf8");
  const { errors } = validateWorkflow(text);
  for (const error of errors) mistakes.push(`github-actions.yml: ${JSON.stringify(error)}`);
  // That the checker finds anything at all.
  if (!validateWorkflow(text.replace("runs-on:", "runs_on:")).errors.length) mistakes.push("a workflow that runs nowhere passed");

  // GitLab's own schema, which gitlab-ci-local has with it.
  const { schema } = await import(pathToFileURL(join(packages, "gitlab-ci-local/src/schema/schema.js")));
  const Ajv = require("ajv");
  const ajv = new Ajv({ strict: false });
  require("ajv-formats")(ajv);
  const fits = ajv.compile(schema);
  const jobs = parse(readFileSync(join(root, "examples/ci/gitlab-ci.yml"), "utf8"));
  if (!fits(jobs)) mistakes.push(`gitlab-ci.yml: ${ajv.errorsText(fits.errors)}`);
  for (const name of ["check", "probe", "gate", "keep"]) if (!jobs.stages.includes(jobs[name]?.stage)) mistakes.push(`gitlab-ci.yml: \`${name}\` is in no stage`);
  if (fits({ ...jobs, probe: { ...jobs.probe, parallel: "many" } })) mistakes.push("a number that is none passed GitLab's schema");

  // Where nothing is there to hold a change against, the job fails: its own words, run in an empty folder.
  const empty = mkdtempSync(join(tmpdir(), "ci-"));
  const gateOf = (lines) => lines.filter((line) => !/^vlaprobe /.test(line)).join("\n");
  for (const [name, script] of [["gitlab-ci.yml", gateOf(jobs.gate.script)],
    ["github-actions.yml", Object.values(parse(text).jobs).flatMap((job) => job.steps).find((step) => /== ''$/.test(step.if ?? ""))?.run ?? ""]]) {
    const said = spawnSync("bash", ["-e", "-c", script], { cwd: empty, encoding: "utf8", env: { ...process.env, CI_DEFAULT_BRANCH: "main" } });
    if (said.status !== 1 || !/nothing was gated/.test(said.stdout + said.stderr)) mistakes.push(`${name}: a gate without anything to compare passes: ${said.status} ${said.stdout}${said.stderr}`);
  }
  // Caches of protected and of other branches are two, unless they are told not to be.
  for (const name of ["gate", "keep"]) if (jobs[name]?.cache?.unprotect !== true) mistakes.push(`gitlab-ci.yml: the cache of \`${name}\` is another one on protected branches`);
  if (jobs.gate.cache.policy !== "pull") mistakes.push("gitlab-ci.yml: a change overwrites what it is held against");

  // Every call of vlaprobe, for whoever runs them.
  const steps = Object.values(parse(text).jobs).flatMap((job) => job.steps.map((step) => step.run ?? ""));
  const lines = [...steps, readFileSync(join(root, "examples/ci/gitlab-ci.yml"), "utf8")].join("\n").split("\n");
  for (const line of lines) if (/^\s*(- )?vlaprobe /.test(line)) console.log(line.trim().replace(/^- /, ""));
} else {
  const models = (group) => import(pathToFileURL(join(packages, `kubernetes-models/${group}/index.js`)));
  const kinds = { ConfigMap: (await models("v1")).ConfigMap, Job: (await models("batch/v1")).Job };
  for (const file of files) {
    const documents = parseAllDocuments(readFileSync(file, "utf8"));
    for (const document of documents) {
      for (const error of document.errors) mistakes.push(`${file}: ${error.message}`);
      const object = document.toJS();
      try {
        new kinds[object.kind](object).validate();
      } catch (error) {
        mistakes.push(`${file}: ${object.kind}: ${error.message}`);
      }
      if (object.kind !== "Job") continue;
      try {
        new kinds.Job({ ...object, spec: { ...object.spec, completions: "many" } }).validate();
        mistakes.push("a number that is none passed the API's schema");
      } catch { /* as it should be */ }
    }
    console.log(JSON.stringify(documents.map((document) => document.toJS())));
  }
}
for (const mistake of mistakes) console.error(mistake);
process.exit(mistakes.length ? 1 : 0);
