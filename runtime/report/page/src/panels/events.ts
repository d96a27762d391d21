// What happened in the episodes, beside their verdicts: dropped, bumped, how far they came, how the tool moved.
import { breakable, type Child, h, replace, scroller, select } from "../dom";
import { points, probability } from "../format";
import type { Delta, EventTables } from "../model";
import { details, estimateCell, isReal, kQuestionColumns, nothing, type Panel, panel, policyLabel, questionCells, questionHead, shortCell, differenceBar, stars } from "../parts";
import type { State } from "../state";

const capital = (label: string): string => label.charAt(0).toUpperCase() + label.slice(1);
const heads = (first: string, names: string[]): HTMLElement => h("thead", {}, h("tr", {}, [first, ...names.map(capital)].map((t) => h("th", { scope: "col" }, t))));

// Those that began in some episode of the policies drawn.
function happened(table: EventTables, chosen: number[], subgoals: boolean): number[] {
  return table.names.flatMap(({ subgoal }, m) => (subgoal === subgoals && table.main.some((r) => r.metric === m && chosen.includes(r.policy) && (subgoals ? r.all : (r.all?.[0] ?? 0) > 0)) ? [m] : []));
}

function sums(state: State, table: EventTables, columns: number[], caption: string): Child {
  if (!columns.length) return null;
  return scroller(caption, h("table", { class: "plain sums" }, h("caption", {}, caption), heads("Policy", columns.map((m) => table.names[m]!.label)),
    h("tbody", {}, state.chosen.map((p) => h("tr", {}, h("th", { scope: "row" }, policyLabel(state, p)),
      columns.map((m) => h("td", {}, estimateCell(table.main.find((r) => r.policy === p && r.metric === m)?.all ?? null))))))));
}

const number = (value: number): string => String(Number(value.toPrecision(3)));

function taskTable(state: State, table: EventTables, policy: number, columns: number[]): Child {
  const { data } = state;
  const cell = (m: number, t: number) => table.by_task[table.names[m]!.name]?.[policy]?.[t] ?? null;
  const own = data.tasks.map((_, t) => t).filter((t) => table.names.some((_, m) => cell(m, t)));
  const busy = own.filter((t) => columns.some((m) => (cell(m, t)?.[0] ?? 0) > 0)), idle = own.length - busy.length;
  return [
    busy.length ? scroller("Events by task", h("table", { class: "plain" }, h("caption", {}, "Episodes in which it happened, by task"), heads("Task", columns.map((m) => table.names[m]!.label)),
      h("tbody", {}, busy.map((t) => h("tr", {}, h("th", { scope: "row" }, h("a", { href: `#task-${t}` }, breakable(data.tasks[t]!.name))), columns.map((m) => h("td", {}, shortCell(cell(m, t)))))))), busy.length > 14) : null,
    idle ? h("p", { class: "sub" }, busy.length ? `In ${idle} other ${idle === 1 ? "task" : "tasks"} none of it happened.` : "None of it happened in its episodes.") : null,
  ];
}

function numberTable(state: State, table: EventTables, policy: number): Child {
  const { data } = state;
  const columns = table.numbers.filter((n) => n.rows.some(([p]) => p === policy));
  const tasks = data.tasks.map((_, t) => t).filter((t) => columns.some((n) => n.rows.some(([p, of]) => p === policy && of === t)));
  if (!tasks.length) return null;
  return details("How the tool moved, and when", h("p", { class: "sub" }, "Means of the episodes that have the number; below, the least and the most. Smoothness compares at equal control rates alone."),
    scroller("Numbers by task", h("table", { class: "plain" }, h("caption", {}, "Means by task"), heads("Task", columns.map((n) => n.label + (n.unit ? `, ${n.unit}` : ""))),
      h("tbody", {}, tasks.map((t) => h("tr", {}, h("th", { scope: "row" }, h("a", { href: `#task-${t}` }, breakable(data.tasks[t]!.name))), columns.map((n) => {
        const found = n.rows.find(([p, of]) => p === policy && of === t);
        return h("td", { class: "number" }, found ? [number(found[2]), h("small", {}, `${number(found[3])} to ${number(found[4])}, n ${found[5]}`)] : h("span", { class: "none" }, "\u2013"));
      }))))), tasks.length > 14));
}

function deltaRow(state: State, table: EventTables, d: Delta): HTMLElement {
  const { data } = state;
  return h("tr", { class: isReal(d) ? "real" : null },
    h("th", { scope: "row" }, h("a", { href: `#task-${d.task}` }, breakable(data.tasks[d.task]!.name)), h("span", { class: "sub" }, "against ", breakable(data.tasks[d.baseline]?.name ?? ""))),
    h("td", { class: "words" }, table.names[d.metric]!.label), h("td", { class: "number strong" }, points(d.diff), stars(d)), h("td", { class: "bar" }, differenceBar(d)),
    h("td", { class: "number" }, d.pairs ? `${d.pairs[1]} : ${d.pairs[2]}` : "not paired"), questionCells(d.on_these_starts), questionCells(d.for_starts_never_tried));
}

// Differences that are real, and behind a button all that are not 0.
function deltaTable(state: State, table: EventTables, policy: number): Child {
  const own = table.deltas.filter((d) => d.policy === policy && d.diff !== 0);
  if (!own.length) return null;
  const real = own.filter(isReal), rest = own.filter((d) => !isReal(d));
  const listed = (rows: Delta[], caption: string): Child => scroller(caption, h("table", { class: "plain deltas questions" }, h("caption", {}, caption),
    questionHead(["Variant", "What", "Difference", "\u2212100 to +100", "Variant only : baseline only"], kQuestionColumns, []),
    h("tbody", {}, rows.map((d) => deltaRow(state, table, d)))), rows.length > 14);
  return [real.length ? listed(real, "Variants in which it happens more or less often than in their baselines") : h("p", { class: "sub" }, `No variant differs from its baseline for certain, of ${own.length} that differ; least q ${probability(Math.min(...own.map((d) => d.on_these_starts.p_adjusted ?? 1)))}.`),
    rest.length ? details(`${rest.length} that may be chance`, listed(rest, "Differences that are not certain")) : null];
}

export function events(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  let policy = -1;
  const draw = (): void => {
    const table = data.tables.events;
    if (!table) return replace(holder, nothing(data, "events", "No events were read from traces, or nothing happened in any episode."));
    if (!state.chosen.includes(policy)) policy = state.chosen[0] ?? 0;
    const columns = happened(table, state.chosen, false), subgoals = happened(table, state.chosen, true);
    const quiet = table.names.filter(({ subgoal }, m) => !subgoal && !columns.includes(m)).map(({ label }) => label);
    replace(holder,
      sums(state, table, columns, "Episodes in which it happened"),
      quiet.length ? h("p", { class: "sub" }, `Never: ${quiet.join(", ")}.`) : null,
      sums(state, table, subgoals, "Episodes that came so far, one after the other"),
      h("div", { class: "controls" }, select("Policy", state.chosen.map((p) => data.policies[p]!.label), Math.max(0, state.chosen.indexOf(policy)), (i) => { policy = state.chosen[i]!; draw(); })),
      taskTable(state, table, policy, columns), deltaTable(state, table, policy), numberTable(state, table, policy));
  };
  state.watch(draw);
  return panel("events", "What happened", "Events read from the traces by std/events.probe, whatever the verdict was. A touch counts when it lasts to the end of a control step.", holder);
}
