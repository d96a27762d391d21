// Made-up results in the shape of PAGE_DATA.md, for tests of the page: any number of policies, seeds and starts; with
// names that would be markup or script if anything interpreted them. The same arguments give the same results.

// Mulberry32: a small generator, so that every run of the test sees the same page.
function generator(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Stand-ins with the right shape; the program's own statistics are in runtime/stats.
const round = (x) => Math.round(x * 1e4) / 1e4;
function estimate(k, n) {
  if (n === 0) return null;
  const z = 1.96, p = k / n, d = 1 + (z * z) / n;
  const mid = (p + (z * z) / (2 * n)) / d;
  const half = (z * Math.sqrt((p * (1 - p)) / n + (z * z) / (4 * n * n))) / d;
  return [k, n, round(Math.max(0, mid - half)), round(Math.min(1, mid + half))];
}

// Both questions of a difference: `wide` is by how much more is open for starts never tried.
function answers(low, high, p, units, wide = 0.02) {
  const answer = (a, b, chance, n) => ({ units: n, low: round(Math.max(-1, a)), high: round(Math.min(1, b)), p: chance, p_adjusted: Math.min(1, 2 * chance),
    real: 2 * chance <= 0.05, ...(2 * chance <= 0.05 ? {} : { detectable: 0.021, more: 3 }) });
  return { on_these_starts: answer(low, high, p, units), for_starts_never_tried: answer(low - wide, high + wide, Math.min(1, wide ? 40 * p : p), wide ? Math.max(1, Math.floor(units / 4)) : units) };
}

export const kHostile = [
  `<img src=x onerror="window.pwned=1">`,
  `</script><script>window.pwned=2</script>`,
  `"><svg onload=window.pwned=3>`,
  "line\u2028separator & <b>bold</b>",
  `{{constructor.constructor('window.pwned=4')()}}`,
  `javascript:window.pwned=5`,
];

const kCategories = [
  ["original", "Original"], ["ood_source", "OOD source"], ["ood_target", "OOD target"],
  ["ood_source_target", "OOD source + target"], ["ood_relation", "OOD relation"], ["lang_action", "Language: action"],
  ["lang_negation", "Language: negation"], ["lang_appearance", "Language: appearance"],
  ["object_distraction", "Object distraction"], ["commonsense", "Commonsense"],
  ["commonsense_distraction", "Commonsense + distraction"],
];
const kObjects = ["carrot", "plate", "spoon", "towel", "green_cube", "yellow_cube", "eggplant", "basket", "coke_can", "pepsi_can",
  "orange_juice", "nut", "keyboard", "sponge", "ramekin", "wheel", "orange", "rabbit", "small_plate"];

function makeTasks() {
  const tasks = [];
  const object = (name) => kObjects.indexOf(name);
  const add = (name, category, source, target, more = {}) => {
    tasks.push({
      plan: 0, name, baseline: -1, axes: [], categories: [category], prompt: more.prompt ?? `put ${source} on ${target}`,
      source: object(source), target: object(target), distractors: (more.distractors ?? []).map(object), ood: more.ood ?? [],
      horizon: 60, hz: 5, scene: "table", metrics: [0, 1, 2, 3, 4],
      starts: Array.from({ length: 24 }, (_, s) => {
        const x = -0.235 + 0.15 * (s % 2), y = -0.075 + 0.15 * ((s >> 1) % 2);
        return [[x, y, (s * 90) % 360], [-0.32 - x, -y, 0],
          ...(more.distractors ?? []).map((_, i) => [-0.1 - 0.05 * i, 0.1 * (i ? 1 : -1), 0])];
      }),
      rule: { file: "manipulation.probe", line: 31, text: "success = source rests on target, gripper open" },
      ...("confounded" in more ? { confounded: more.confounded } : {}),
    });
    const task = tasks[tasks.length - 1];
    if (more.of) { task.baseline = tasks.findIndex((t) => t.name === more.of); task.axes = more.axes; }
  };
  add("carrot_on_plate", 0, "carrot", "plate");
  add("spoon_on_towel", 0, "spoon", "towel");
  add("stack_cube", 0, "green_cube", "yellow_cube");
  add("put_eggplant_in_basket", 0, "eggplant", "basket");
  for (const s of ["coke_can", "pepsi_can", "orange_juice", "nut"])
    add(`${s}_on_plate`, 1, s, "plate", { of: "carrot_on_plate", axes: ["object.source"], ood: ["source"] });
  for (const t of ["keyboard", "ramekin", "wheel"])
    add(`carrot_on_${t}`, 2, "carrot", t, { of: "carrot_on_plate", axes: t === "keyboard" ? ["object.target"] : ["object.target", "goal"],
      ood: ["target"], ...(t === "keyboard" ? {} : { confounded: "a hollow target has its own rule of success" }) });
  for (const t of ["keyboard", "ramekin", "wheel"])
    add(`coke_can_on_${t}`, 3, "coke_can", t, { of: "coke_can_on_plate", axes: ["object.target"], ood: ["source", "target"] });
  add("carrot_on_sponge", 4, "carrot", "sponge", { of: "carrot_on_plate", axes: ["object.target"], ood: ["relation"] });
  add("cube_on_plate", 4, "green_cube", "plate", { of: "carrot_on_plate", axes: ["object.source"], ood: ["relation"] });
  for (const [t, s, g] of [["carrot_on_plate", "carrot", "plate"], ["spoon_on_towel", "spoon", "towel"]]) {
    add(`${t}_lang_action`, 5, s, g, { of: t, axes: ["language.action"], prompt: `pick up the ${s} and drop it off on the ${g}` });
    add(`${t}_lang_neg`, 6, s, g, { of: t, axes: ["language.negation", "object.distractors"], prompt: `put the ${s} on the ${g}, not on the sponge`,
      distractors: ["sponge"], confounded: "published on the distractor scene, compared with the clean one" });
    add(`${t}_lang_color`, 7, s, g, { of: t, axes: ["language.appearance"], prompt: "put the orange object on the white object" });
    add(`${t}_distract`, 8, s, g, { of: t, axes: ["object.distractors"], distractors: ["keyboard", "coke_can"] });
    add(`${t}_lang_common`, 9, s, g, { of: t, axes: ["language.commonsense"], prompt: "put the rabbit's favorite vegetable on the plate" });
    add(`${t}_lang_common_distract`, 10, s, g, { of: `${t}_lang_common`, axes: ["object.distractors"],
      prompt: "put the rabbit's favorite vegetable on the plate", distractors: ["eggplant", "rabbit"] });
  }
  return tasks;
}

const kSkill = [["expert", "ceiling", 1, 1], ["null", "floor", 0, 0], ["noisy:0.01", "probe", 0.97, 0.6], ["reach", "probe", 0.99, 0],
  ["wrong", "probe", 0.05, 0], ["random", "random", 0.06, 0.01]];

// A column as it stands in a page of many episodes.
function packed(column) {
  const runs = [];
  for (const value of column) if (runs.length && runs.at(-2) === value) ++runs[runs.length - 1]; else runs.push(value, 1);
  if (8 * runs.length <= column.length) return { runs };
  const from = column.reduce((a, b) => Math.min(a, b)), span = column.reduce((a, b) => Math.max(a, b)) - from, width = span < 256 ? 1 : span < 65536 ? 2 : 4;
  const bytes = Buffer.alloc(column.length * width);
  column.forEach((value, i) => bytes.writeUIntLE(value - from, i * width, width));
  return { from, width, bytes: bytes.toString("base64") };
}

// {data, timelines, whys} as objects. Options: policies, starts, seeds, hostile, packs, only ("none" | "invalid" | "partial").
export function sample({ policies = 6, starts = 24, seeds = [42], hostile = false, packs = false, only = "" } = {}) {
  const random = generator(policies * 1000 + starts);
  const tasks = makeTasks();
  const metrics = [["success", "Success", 1], ["intention", "Intention", 1], ["grasp", "Grasp", 1], ["moved", "Moved", 0], ["wrong", "Wrong object", -1]]
    .map(([name, label, good]) => ({ name, label, truth: true, good }));
  const list = Array.from({ length: policies }, (_, p) => {
    const [name, role, reach, skill] = p < kSkill.length ? kSkill[p] : [`model-${p}`, "model", random(), random()];
    return { name, label: name, role, reach, skill };
  });
  const objects = kObjects.map((name, o) => ({ name, seen: { source: o < 7, target: o < 8 } }));
  const reasons = ["policy: the connection was closed", "world: a velocity is not finite"];
  if (hostile) {
    list.forEach((policy, p) => { policy.name = policy.label = `${kHostile[p % kHostile.length]} ${p}`; });
    tasks.forEach((task, t) => { task.name = `${kHostile[t % kHostile.length]} ${t}`; task.prompt = kHostile[(t + 1) % kHostile.length]; });
    objects.forEach((object, o) => { object.name = `${kHostile[o % kHostile.length]} ${o}`; });
    reasons[0] = kHostile[1];
    metrics[3].label = kHostile[0];
  }
  const categories = kCategories.map(([name, label], c) => ({ name, label: hostile && c === 0 ? kHostile[0] : label,
    tasks: tasks.flatMap((task, t) => (task.categories.includes(c) ? [t] : [])) }));
  const prompts = [...new Set(tasks.map((t) => t.prompt))];
  const episodes = { count: 0, policy: [], task: [], start: [], seed: [], bits: [], steps: [], reason: [], prompt: [], video: [] };
  const strings = hostile ? ["javascript:window.pwned=6", "runs/x/<b>.mp4"] : ["runs/noisy/videos/carrot_on_plate/0-42.mp4"];
  const count = only === "none" ? 0 : starts;
  const difficulty = tasks.map((t) => 1 - 0.12 * t.ood.length - 0.1 * t.distractors.length - (t.axes.some((a) => a.startsWith("language")) ? 0.15 : 0));
  const lines = [];
  list.forEach((policy, p) => tasks.forEach((task, t) => {
    if (only === "partial" && (p * 7 + t) % 3 === 0) return;
    for (let start = 0; start < count; ++start) for (const seed of seeds) {
      const bad = only === "invalid" || random() < (policy.role === "model" ? 0.01 : 0.001);
      const intention = random() < policy.reach * (policy.role === "ceiling" ? 1 : difficulty[t]);
      const grasp = intention && random() < Math.sqrt(policy.skill);
      const success = grasp && random() < Math.sqrt(policy.skill);
      const wrong = !intention && task.distractors.length > 0 && random() < 0.5;
      const steps = success ? 14 + Math.floor(random() * 20) : 60;
      const row = [p, t, start, seed, (success ? 1 : 0) | (intention ? 2 : 0) | (grasp ? 4 : 0) | (intention ? 8 : 0) | (wrong ? 16 : 0),
        steps, bad ? (random() < 0.5 ? 0 : 1) : -1, prompts.indexOf(task.prompt), random() < 0.1 ? Math.floor(random() * strings.length) : -1];
      ["policy", "task", "start", "seed", "bits", "steps", "reason", "prompt", "video"].forEach((key, i) => episodes[key].push(row[i]));
      ++episodes.count;
      const touch = 8 + Math.floor(random() * 6);
      lines.push(bad ? 0 : [intention ? `m1:${touch - 3}-${steps};m3:${touch}-${steps}` : "", grasp ? `m2:${touch}-${steps};c0.4:${touch}-${steps - 1};g:${touch}-${steps - 2}` : "",
        success ? `m0:${steps}-${steps};c0.1:${steps - 2}-${steps}` : "", wrong ? `m4:20-60;c2.4:18-30` : "",
        "d:" + Array.from({ length: Math.ceil(steps / 2) }, (_, i) => Math.round(intention ? 15 * (1 - (0.9 * 2 * i) / steps) : 15)).join(",")].filter(Boolean).join(";"));
    }
  }));

  // Counts of chosen rows by metric.
  const tally = (chosen) => metrics.map((_, m) => {
    let k = 0, n = 0;
    for (const i of chosen) { if (episodes.reason[i] >= 0) continue; ++n; k += (episodes.bits[i] >> m) & 1; }
    return estimate(k, n);
  });
  const rows = Array.from({ length: list.length }, () => Array.from({ length: tasks.length }, () => []));
  for (let i = 0; i < episodes.count; ++i) rows[episodes.policy[i]][episodes.task[i]].push(i);
  const shown = [1, 2, 0];
  const main = { all_label: "All", rows: [] };
  const by_task = Object.fromEntries(metrics.map((m) => [m.name, []]));
  const deltas = [], pairs = [], things = [], gap = [], floors = [], compare = [], sequential = [], category_deltas = [];
  list.forEach((_, p) => {
    const cells = categories.map((c) => tally(c.tasks.flatMap((t) => rows[p][t])));
    const all = tally(rows[p].flat());
    for (const m of shown) main.rows.push({ policy: p, metric: m, all: all[m], cells: cells.map((c) => c[m]) });
    const tasksOf = tasks.map((_, t) => tally(rows[p][t]));
    metrics.forEach((m, i) => by_task[m.name].push(tasksOf.map((t) => t[i])));
    tasks.forEach((task, t) => {
      if (task.baseline < 0) return;
      for (const m of [0, 1, 2]) {
        const a = rows[p][t], b = rows[p][task.baseline], four = [0, 0, 0, 0];
        for (let i = 0; i < Math.min(a.length, b.length); ++i) {
          if (episodes.reason[a[i]] >= 0 || episodes.reason[b[i]] >= 0) continue;
          const x = (episodes.bits[a[i]] >> m) & 1, y = (episodes.bits[b[i]] >> m) & 1;
          ++four[x && y ? 0 : x ? 1 : y ? 2 : 3];
        }
        const n = four[0] + four[1] + four[2] + four[3];
        if (!n) continue;
        const diff = (four[1] - four[2]) / n, se = Math.sqrt(Math.max(four[1] + four[2], 1)) / n;
        const prob = Math.min(1, Math.exp(-0.7 * (diff / se) ** 2));
        deltas.push({ policy: p, task: t, baseline: task.baseline, metric: m, pairs: task.name === "carrot_on_wheel" ? null : four, first: [four[0] + four[1], n], second: [four[0] + four[2], n], floor: four[0] + four[2] === 0, starts: n, diff: round(diff),
          low: round(Math.max(-1, diff - 1.96 * se)), high: round(Math.min(1, diff + 1.96 * se)), p: prob, q: Math.min(1, prob * 2),
          ...answers(diff - 1.96 * se, diff + 1.96 * se, prob, n, 0) });
      }
    });
    const plain = tasks.flatMap((task, t) => (task.distractors.length || task.axes.some((a) => a.startsWith("language")) ? [] : [t]));
    for (const m of [0, 1, 2]) {
      for (const t of plain) { const e = tally(rows[p][t])[m]; if (e) pairs.push({ policy: p, source: tasks[t].source, target: tasks[t].target, metric: m, e, ood: tasks[t].ood }); }
      for (const role of ["source", "target"]) for (const o of new Set(plain.map((t) => tasks[t][role]))) {
        const e = tally(plain.filter((t) => tasks[t][role] === o).flatMap((t) => rows[p][t]))[m];
        if (e) things.push({ policy: p, object: o, role, metric: m, e, ood: !objects[o].seen[role] });
      }
    }
    for (const c of [-1, ...categories.keys()]) {
      const [s, i] = (c < 0 ? all : cells[c]);
      if (s) gap.push({ policy: p, category: c, intention: i, success: s, diff: round((i[0] - s[0]) / s[1]), low: round(i[2] - s[3] > -1 ? Math.max(-1, (i[0] - s[0]) / s[1] - 0.05) : -1), high: round(Math.min(1, (i[0] - s[0]) / s[1] + 0.05)), p: 0.001,
        ...answers((i[0] - s[0]) / s[1] - 0.05, (i[0] - s[0]) / s[1] + 0.05, 0.001, i[1]) });
    }
  });
  const ceiling = list.findIndex((p) => p.role === "ceiling"), floor = list.findIndex((p) => p.role === "floor");
  if (ceiling >= 0 && floor >= 0) tasks.forEach((_, t) => { for (const m of shown) {
    const f = tally(rows[floor][t])[m], c = tally(rows[ceiling][t])[m];
    if (f && c) floors.push({ task: t, metric: m, floor: f, ceiling: c });
  } });
  for (let a = 0; a < Math.min(6, list.length); ++a) for (let b = a + 1; b < Math.min(6, list.length); ++b) {
    const x = main.rows[a * 3 + 2].all, y = main.rows[b * 3 + 2].all;
    if (!x || !y) continue;
    const diff = x[0] / x[1] - y[0] / y[1];
    compare.push({ a, b, metric: 0, scope: "all", pairs: x[1], starts: x[1], diff: round(diff), low: round(Math.max(-1, diff - 0.03)), high: round(Math.min(1, diff + 0.03)),
      p: Math.abs(diff) > 0.03 ? 0.0001 : 0.4, q: Math.abs(diff) > 0.03 ? 0.0003 : 0.5, real: Math.abs(diff) > 0.03, detectable: 0.021,
      ...answers(diff - 0.03, diff + 0.03, Math.abs(diff) > 0.5 ? 1e-6 : Math.abs(diff) > 0.03 ? 0.002 : 0.4, x[1], 0.2) });
    const looked = (units, used) => ({ units, used, a_wins: used, b_wins: 0, p: used < units ? 0.037 : 0.4, stopped: used < units });
    sequential.push({ a, b, metric: 0, on_these_starts: looked(x[1], Math.min(x[1], 7)), for_starts_never_tried: looked(Math.ceil(x[1] / 4), Math.ceil(x[1] / 4)) });
  }
  for (let p = 0; p < list.length; ++p) for (const c of categories.keys()) for (const m of [0, 1, 2]) {
    const own = deltas.filter((d) => d.policy === p && d.metric === m && d.pairs && tasks[d.task].categories.includes(c));
    if (!own.length) continue;
    const four = [0, 1, 2, 3].map((i) => own.reduce((sum, d) => sum + d.pairs[i], 0)), n = four[0] + four[1] + four[2] + four[3];
    const diff = (four[1] - four[2]) / n, se = Math.sqrt(Math.max(four[1] + four[2], 1)) / n;
    category_deltas.push({ policy: p, category: c, metric: m, pairs: four, first: [four[0] + four[1], n], second: [four[0] + four[2], n], starts: n, diff: round(diff),
      ...answers(diff - 1.96 * se, diff + 1.96 * se, Math.min(1, Math.exp(-0.7 * (diff / se) ** 2)), n, 0.05) });
  }
  // Two models that were asked, beside the first policies.
  const arm = (k, n, more = {}) => ({ circular: [k, n, round(Math.max(0, k / n - 0.05)), round(Math.min(1, k / n + 0.05))], plain: [Math.min(n, k + 40), n, 0.8, 0.9], rows: 3 * n, unclear: 7, refused: 0, empty: 1, invalid: 2, incomplete: 3, ...more });
  const models = count === 0 || only === "nobody" ? [] : ["paligemma", hostile ? kHostile[0] : "qwen2.5-vl"].map((label) => ({ name: label, label, plan: 0, answers: 5184, invalid: 4, left_out: 12,
    families: [["understanding.source", "choice", "A robot is told: \"{instruction}\". Which object must it pick up?"], ["understanding.restate", "free", "Say in one short sentence what the robot has to do."]]
      .map(([name, form, text]) => ({ name, form, moment: "at start", text })) }));
  const accuracy = models.flatMap((_, model) => [-1, ...categories.keys()].flatMap((category) => [
    { model, family: 0, category, picture: arm(980 - 300 * model, 1200, model ? {} : { likely_circular: [1004, 1200, 0.81, 0.86], likely_plain: [1090, 1200, 0.89, 0.92] }), blind: arm(400, 1200), prior: arm(410, 1200), random: 0.0741, first: 0 },
    { model, family: 1, category, picture: arm(310, 1200, { copied: 0.84, copies: 702 }) }]));
  const knows = models.flatMap((_, model) => [-1, ...categories.keys()].flatMap((category) => list.slice(0, 2).map((_, policy) => ({ model, policy, family: 0, category, counts: [20, 5, 30, 65, 71, 2, 200, 807], starts: 1200, diff: 0.148, low: 0.09, high: 0.2,
    says: `of the 98 episodes in which ${list[policy].label} did not go for the right object, ${models[model].label} named it in 73`, ...answers(0.09, 0.2, 0.001, 1200, 0.01) }))));
  const named = (t) => tasks[t].name;
  // Events that began as often as some verdict was true, one that never did, and two subgoals.
  const told = [["dropped", 0, false], ["bumped", 1, false], ["left_table", -1, false], ["reached_it", 1, true], ["grasped_it", 2, true]]
    .map(([name, m, subgoal]) => ({ name, m, subgoal, label: hostile ? kHostile[0] : name.replaceAll("_", " ") }));
  const never = (e) => (e ? [0, e[1], 0, e[3]] : null);
  const events = count === 0 || list.length === 0 ? undefined : { names: told.map(({ name, label, subgoal }) => ({ name, label, subgoal })),
    main: list.flatMap((_, p) => told.map(({ m }, metric) => { const all = main.rows.find((r) => r.policy === p && r.metric === Math.max(0, m))?.all ?? null; return { policy: p, metric, all: m < 0 ? never(all) : all, cells: [] }; })),
    by_task: Object.fromEntries(told.map(({ name, m }) => [name, m < 0 ? by_task[metrics[0].name].map((row) => row.map(never)) : by_task[metrics[m].name]])),
    deltas: deltas.filter((d) => d.metric < 2 && d.policy < 3),
    numbers: [["path", "m"], ["hand_over", "s"], ["sparc", ""]].map(([name, unit], i) => ({ name, label: name.replaceAll("_", " "), unit, rows: list.slice(0, 3).flatMap((_, p) => tasks.slice(0, 9 - 4 * i).map((_, t) => [p, t, 0.71 + i, 0.4, 1.93 + i, 24])) })) };
  const data = {
    format: "vlaprobe-report", version: 1, title: hostile ? kHostile[1] : "vlaprobe report", program: "vlaprobe 0.1.0",
    command: `vlaprobe report ${list.map((p) => "runs/" + p.name).slice(0, 6).join(" ")} -o report.html`,
    confidence: 0.95, interval: "Wilson's score interval, 95 %.",
    run: count === 0 ? ["No episode was run."] : [`${list.length} policies over ${tasks.length} tasks, ${starts} starts each: ${episodes.count} episodes.`, "Every policy met the same starts."],
    findings: count === 0 ? [] : [{ level: "good", text: "The expert solves every start, so no task here is impossible.", see: "floors" },
      { level: "warn", text: "noisy:0.01 reaches for the right object far more often than it finishes.", see: "gap" },
      { level: "bad", text: "6 comparisons move more than one thing; their differences cannot be read as effects of one.", see: "confounded" }],
    notes: only === "partial" ? [{ level: "warn", text: "runs/reach: 812 of 1,200 episodes are there; rates are over what is there." }] : [],
    metrics, categories, objects, prompts, reasons, strings,
    plans: [{ root: "4385c74b2ba4d76a4a500c8d5a4a84dd22b5c5072f42dcf5da5e2b1a8ac0182c", suite: "intact", tasks: tasks.length, starts: tasks.length * starts, trained_on: "bridge_v2" }],
    fingerprints: [[["compiler", "GCC 12.2.0"], ["cpu", "x86-64-v3"], ["program", "1f2e3d4c"], ["simbody", "3.7"]]],
    policies: list.map(({ name, label, role }, p) => ({ name, label, role, runs: [{ dir: hostile ? kHostile[5] : `runs/${name}`, plan: 0, fingerprint: 0, seeds, done: rows[p].flat().length,
      expected: tasks.length * starts * seeds.length, invalid: rows[p].flat().filter((i) => episodes.reason[i] >= 0).length, videos: 3 }] })),
    tasks, episodes, models,
    tables: { events, accuracy, knows, main, by_task, deltas, category_deltas, pairs, objects: things, gap, floors, compare, sequential,
      external: count === 0 ? [] : [{ source: "published.csv", rows: [{ policy: hostile ? kHostile[0] : "pi0 fintune", metric: "success", all: 30.4,
        cells: [47.6, 49.3, 24.4, 21.5, 39.6, 38.5, 22.2, 43.1, 25.2, 26.4, 10.6], flags: Array.from({ length: 12 }, (_, i) => (i === 3 ? "49.3 % is no count of 120 episodes" : null)) }] }],
      delivery: count === 0 ? [] : [{ level: "good", text: "Every prompt that was sent has the hash of its plan's instruction." }],
      confounded: tasks.flatMap((task, t) => (task.confounded ? [{ task: t, baseline: task.baseline, axes: task.axes, reason: task.confounded }] : [])) },
  };
  const whys = { strings: ["manipulation.probe", "source rests on target", "carrot, plate", "3.1cm <= 2cm", named(0)], e: {} };
  for (let i = 0; i < Math.min(episodes.count, 400); ++i)
    whys.e[i] = [["success", "false", "at step 60", 0, 31, [[32, 1, 2, 3, 0, 1, 0], [33, 1, 2, 3, 1, 0, 2]]]];
  const timelines = { every: 2, bodies: tasks.map((t) => [objects[t.source].name, objects[t.target].name, ...t.distractors.map((d) => objects[d].name),
    ...Array(2 - t.distractors.length).fill(""), "gripper"]), events: told.map(({ label, subgoal }) => [label, subgoal ? 1 : 0]),
    e: lines.map((line) => (line ? `${line};e0:31.0,44.0;e1:33.0.1;e3:9.0;e4:14.0` : line)) };
  if (packs) for (const name of Object.keys(episodes)) if (Array.isArray(episodes[name])) episodes[name] = packed(episodes[name]);
  return { data, timelines, whys };
}

// The page as runtime/report/page_writer.cpp writes it.
export function embed(before, after, documents) {
  const text = (json) => JSON.stringify(json).replace(/[<>&\u2028\u2029]/g, (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
  const scripts = ["data", "timelines", "whys"].map((id) => `<script type="application/json" id="${id}">${text(documents[id])}</script>\n`);
  return before + scripts.join("") + after;
}
