// From all tasks to one task's starts: who did what at which start. One episode more is panels/episode.ts.
import { breakable, type Child, h, replace, scroller, select } from "../dom";
import { percent, points, probability, rate, spoken } from "../format";
import { type Data, instruction, isTrue, metricIndex, objectName, taskName } from "../model";
import { kConfounded, nothing, novel, type Panel, panel, policyLabel } from "../parts";
import type { State } from "../state";
import { episodeView } from "./episode";

interface Outcome { sign: string; word: string; kind: string }

// The furthest an episode came, by the names of the common metrics.
function outcomes(data: Data): (row: number) => Outcome {
  const bit = (name: string) => metricIndex(data, name);
  const [success, grasp, intention, wrong] = ["success", "grasp", "intention", "wrong"].map(bit) as [number, number, number, number];
  const has = (row: number, m: number) => m >= 0 && isTrue(data.episodes, row, m);
  return (row) => {
    if (data.reasons[data.episodes.reason[row]!]?.startsWith("not attempted")) return { sign: "\u2013", word: "not attempted", kind: "invalid" };
    if (data.episodes.reason[row]! >= 0) return { sign: "!", word: "invalid", kind: "invalid" };
    if (has(row, success)) return { sign: "\u25cf", word: "success", kind: "success" };
    if (has(row, wrong)) return { sign: "\u00d7", word: "wrong object", kind: "wrong" };
    if (has(row, grasp)) return { sign: "\u25d1", word: "grasped, not finished", kind: "grasp" };
    if (has(row, intention)) return { sign: "\u25cb", word: "intention only", kind: "intention" };
    return { sign: "\u00b7", word: "neither", kind: "none" };
  };
}
const kKey: [string, string, string][] = [["\u25cf", "success", "success"], ["\u25d1", "grasp", "grasped, not finished"], ["\u25cb", "intention", "intention only"], ["\u00b7", "none", "neither"], ["\u00d7", "wrong", "wrong object"], ["!", "invalid", "invalid"]];

// Policies down, starts across; several seeds share a cell. Arrow keys move, Enter opens.
function startGrid(state: State, task: number, open: (row: number) => void): HTMLElement {
  const { data } = state;
  const outcome = outcomes(data);
  const lists = state.chosen.map((p) => state.index.of(p, task));
  const starts = Math.max(data.tasks[task]!.starts?.length ?? 0, ...lists.flat().map((row) => data.episodes.start[row]! + 1), 0);
  const buttons: HTMLButtonElement[][] = [];
  const rows = state.chosen.map((p, i) => {
    const own: HTMLButtonElement[] = [];
    buttons.push(own);
    const by = new Map<number, number[]>();
    for (const row of lists[i]!) by.set(data.episodes.start[row]!, [...(by.get(data.episodes.start[row]!) ?? []), row]);
    return h("tr", {}, h("th", { scope: "row" }, policyLabel(state, p)), Array.from({ length: starts }, (_, start) => h("td", {}, (by.get(start) ?? []).map((row) => {
      const o = outcome(row);
      const button = h("button", { type: "button", class: `start ${o.kind}`, tabindex: -1, "data-row": row, title: `${data.policies[p]!.label}, start ${start}, seed ${data.episodes.seed[row]}: ${o.word}`,
        "aria-label": `${data.policies[p]!.label}, start ${start}, seed ${data.episodes.seed[row]}: ${o.word}`, click: () => {
          for (const line of buttons) for (const b of line) b.removeAttribute("aria-pressed");
          button.setAttribute("aria-pressed", "true");
          open(row);
        } }, o.sign);
      own.push(button);
      return button;
    }))));
  });
  const first = buttons.find((line) => line.length)?.[0];
  if (first) first.tabIndex = 0;
  const table = h("table", { class: "starts", keydown: (event) => {
    const key = (event as KeyboardEvent).key;
    const step = ({ ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0], Home: [0, -1e9], End: [0, 1e9] } as Record<string, [number, number]>)[key];
    if (!step) return;
    const y = buttons.findIndex((line) => line.includes(event.target as HTMLButtonElement));
    if (y < 0) return;
    event.preventDefault();
    const x = buttons[y]!.indexOf(event.target as HTMLButtonElement);
    let line = y + step[0];
    while (buttons[line] && !buttons[line]!.length) line += step[0];
    const list = buttons[line] ?? buttons[y]!;
    const next = list[Math.min(list.length - 1, Math.max(0, x + step[1]))];
    if (!next) return;
    (event.target as HTMLButtonElement).tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
  } }, h("caption", {}, "Starts: one mark an episode. Arrow keys move, Enter opens the episode."),
    h("thead", {}, h("tr", {}, h("td", {}), Array.from({ length: starts }, (_, i) => h("th", { scope: "col" }, String(i))))), h("tbody", {}, rows));
  return h("div", {}, scroller("Starts", table), h("ul", { class: "outcomes" }, kKey.map(([sign, kind, word]) => h("li", {}, h("span", { class: `start ${kind}`, "aria-hidden": "true" }, sign), word))));
}

function taskView(state: State, task: number, open: (row: number) => void): Child {
  const { data } = state;
  const t = data.tasks[task]!;
  const thing = (o: number, role?: "source" | "target"): Child => o < 0 ? "none" : [objectName(data, o), role && data.objects[o]?.seen?.[role] === false ? novel() : null];
  const facts: [string, Child][] = [
    ["Instruction", h("q", { class: "prompt" }, instruction(t))],
    ["Source", thing(t.source, "source")], ["Target", thing(t.target, "target")],
    ...(t.roles ?? []).map((r): [string, Child] => [r.name ? r.name[0]!.toUpperCase() + r.name.slice(1) : "Placed", r.objects.map((o) => objectName(data, o)).join(", ")]),
    ["Distractors", t.distractors.length ? t.distractors.map((o) => objectName(data, o)).join(", ") : "none"],
    ["New to training", t.ood.length ? t.ood.join(", ") : "nothing"],
    ["Categories", t.categories.map((c) => data.categories[c]?.label).filter(Boolean).join(", ") || "none"],
    ["Compared with", t.baseline !== null && t.baseline >= 0 ? [h("a", { href: `#task-${t.baseline}` }, taskName(data, t.baseline)), ` (moved: ${t.axes.join(", ") || "nothing"})`] : "nothing"],
    ["Time", `${t.horizon} control steps${t.hz ? ` at ${t.hz} Hz, ${(t.horizon / t.hz).toFixed(0)} s` : ""}`],
  ];
  if (t.confounded) facts.push([`Confounded ${kConfounded}`, t.confounded]);
  if (t.unpaired) facts.push(["Not paired", t.unpaired]);
  for (const a of t.allowed ?? []) facts.push([`Allowed: ${a.word}`, a.reason]);
  if (t.rule) facts.push(["Rule of success", [h("code", {}, t.rule.text), h("span", { class: "sub" }, `${t.rule.file}:${t.rule.line}`)]]);
  const deltas = (data.tables.deltas ?? []).filter((d) => d.task === task && state.chosen.includes(d.policy) && data.metrics[d.metric]?.name === "success");
  return [h("h3", { id: "task-title", tabindex: -1 }, t.name), h("dl", { class: "facts" }, facts.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
    deltas.length ? h("p", { class: "key" }, "Success against the baseline, in points: ", deltas.map((d, i) => [i ? "; " : "", policyLabel(state, d.policy), ` ${points(d.diff) || "0"} (p ${probability(d.for_starts_never_tried.p)})`])) : null,
    startGrid(state, task, open)];
}

export function tasks(state: State): Panel {
  const { data } = state;
  const table = h("div", {}), one = h("div", { class: "task", "aria-live": "off" }), episode = h("div", { class: "episode" });
  const metrics = data.metrics.flatMap((m, i) => (m.truth ? [i] : []));
  let metric = Math.max(0, metrics.findIndex((m) => data.metrics[m]!.name === "success")), category = 0, words = "", opened = -1;

  const openEpisode = (row: number, focus = true): void => {
    history.replaceState(null, "", `#episode-${row}`);
    replace(episode, episodeView(state, row));
    if (focus) episode.querySelector<HTMLElement>("h3")?.focus({ preventScroll: true });
    episode.scrollIntoView({ block: "start", behavior: "auto" });
  };
  const openTask = (task: number): void => {
    opened = task;
    replace(episode);
    replace(one, taskView(state, task, (row) => openEpisode(row, false)));
    one.querySelector<HTMLElement>("h3")?.focus({ preventScroll: true });
    one.scrollIntoView({ block: "start", behavior: "auto" });
  };
  const follow = (): void => {
    const [, kind, number] = location.hash.match(/^#(task|episode)-(\d+)$/) ?? [];
    const i = Number(number);
    if (kind === "task" && i < data.tasks.length) openTask(i);
    if (kind === "episode" && i < data.episodes.count) { openTask(data.episodes.task[i]!); openEpisode(i); }
  };
  addEventListener("hashchange", follow);
  queueMicrotask(follow);

  const body = h("tbody", {});
  const fill = (): void => {
    const needle = words.trim().toLowerCase();
    const of = data.metrics[metrics[metric]!];
    const shown = [...data.tasks.keys()].filter((t) => (category === 0 || data.tasks[t]!.categories.includes(category - 1)) && (!needle || data.tasks[t]!.name.toLowerCase().includes(needle) || instruction(data.tasks[t]!).toLowerCase().includes(needle)));
    replace(body, shown.map((t) => h("tr", {}, h("th", { scope: "row" }, h("a", { href: `#task-${t}`, click: () => { if (location.hash === `#task-${t}`) openTask(t); } }, breakable(data.tasks[t]!.name)),
      data.tasks[t]!.confounded ? h("abbr", { class: "dagger", title: data.tasks[t]!.confounded }, kConfounded) : null, h("q", { class: "prompt" }, instruction(data.tasks[t]!))),
      state.chosen.map((p) => { const e = data.tables.by_task?.[of?.name ?? ""]?.[p]?.[t] ?? null; return h("td", { class: "number", title: spoken(e) }, e ? [h("b", {}, percent(rate(e))), h("small", {}, ` ${e[0]}/${e[1]}`)] : "\u2013"); }))),
      shown.length ? null : h("tr", {}, h("td", { colspan: state.chosen.length + 1, class: "nothing" }, "No task fits.")));
  };
  state.watch(() => {
    if (!data.tasks.length) return replace(table, nothing(data, "tasks", "There is no task to show."));
    const filter = h("input", { type: "search", id: "task-filter", value: words, autocomplete: "off", input: () => { words = filter.value; fill(); } });
    replace(table, h("div", { class: "controls" }, h("span", { class: "control" }, h("label", { for: "task-filter" }, "Name or instruction"), filter),
      select("Category", ["all", ...data.categories.map((c) => c.label)], category, (i) => { category = i; fill(); }),
      metrics.length ? select("Metric", metrics.map((m) => data.metrics[m]!.label), metric, (i) => { metric = i; fill(); }) : null),
      h("div", { class: "scroller tall", tabindex: 0, role: "region", "aria-label": "All tasks" }, h("table", { class: "plain tasks" }, h("caption", { class: "unseen" }, "Tasks"),
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Task"), state.chosen.map((p) => h("th", { scope: "col" }, policyLabel(state, p))))), body)));
    fill();
    if (opened >= 0) { replace(one, taskView(state, opened, (row) => openEpisode(row, false))); replace(episode); }
  });
  return panel("tasks", "Tasks, starts, episodes", "Open a task for its starts, a start for its episode: video, timeline, the words as sent, and why it was judged so.", table, one, episode);
}
