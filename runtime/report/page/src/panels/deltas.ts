// Every variant against its baseline on the same starts, one policy and metric at a time.
import { breakable, type Child, checkbox, h, replace, scroller, select } from "../dom";
import { percent, points, probability, signedRange } from "../format";
import { type Delta, taskName } from "../model";
import { details, differenceBar, isReal, kConfounded, kQuestionColumns, mainMetrics, nothing, type Panel, panel, policyLabel, questionCells, questionHead, stars } from "../parts";
import type { State } from "../state";

const q = (d: Delta): number => d.for_starts_never_tried.p_adjusted ?? 2;
const split = (pairs: number[] | null): string => (pairs ? `${pairs[1]} : ${pairs[2]}` : "not paired");
const share = ([k, n]: [number, number]): Child => [percent(k / n), h("small", {}, `${k}/${n}`)];

function row(state: State, d: Delta): HTMLElement {
  const { data } = state;
  const task = data.tasks[d.task]!;
  const answer = d.for_starts_never_tried;
  return h("tr", { class: isReal(d) ? "real" : null },
    h("th", { scope: "row" }, h("a", { href: `#task-${d.task}` }, breakable(task.name)), task.confounded ? h("abbr", { title: `confounded: ${task.confounded}`, class: "dagger" }, kConfounded) : null,
      h("span", { class: "sub" }, "against ", breakable(taskName(data, d.baseline)))),
    h("td", { class: "words" }, task.axes.join(", ") || "\u2013"),
    h("td", { class: "number" }, share(d.first)), h("td", { class: "number" }, share(d.second)),
    h("td", { class: "number strong" }, points(d.diff), d.floor ? h("abbr", { class: "floor", title: "the baseline never succeeds: there is nothing to lose" }, "floor") : null),
    h("td", { class: "bar" }, differenceBar(d)),
    h("td", { class: "number" }, signedRange(answer.low, answer.high)),
    h("td", { class: "number" }, split(d.pairs)),
    h("td", { class: "number" }, String(d.starts)),
    h("td", { class: "number" }, probability(answer.p)),
    h("td", { class: "number" }, probability(answer.p_adjusted), stars(d)));
}

export function deltas(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const metrics = mainMetrics(data);
  let policy = state.typical(), metric = metrics[0] ?? -1, order = 0, onlyReal = false;
  const draw = (): void => {
    const all = data.tables.deltas ?? [];
    if (!all.length) return replace(holder, nothing(data, "deltas", "No variant was run together with its baseline."));
    if (!state.chosen.includes(policy)) policy = state.typical();
    const own = all.filter((d) => d.policy === policy && d.metric === metric);
    const sorted = order === 0 ? own : [...own].sort((a, b) => (order === 1 ? a.diff - b.diff : q(a) - q(b)));
    const shown = onlyReal ? sorted.filter(isReal) : sorted;
    const real = own.filter(isReal).length;
    const categories = (data.tables.category_deltas ?? []).filter((d) => d.policy === policy && d.metric === metric);
    replace(holder,
      h("div", { class: "controls" },
        select("Policy", state.chosen.map((p) => data.policies[p]!.label), state.chosen.indexOf(policy), (i) => { policy = state.chosen[i]!; draw(); }),
        select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); }),
        select("Order", ["of the suite", "largest loss first", "surest first"], order, (i) => { order = i; draw(); }),
        checkbox("only real differences", onlyReal, (on) => { onlyReal = on; draw(); })),
      h("p", { class: "summary", "aria-live": "polite" }, policyLabel(state, policy), ` differs from the baseline in ${real} of ${own.length} comparisons.`),
      categories.length ? scroller("Differences by category", h("table", { class: "plain deltas questions" }, h("caption", {}, "By category; q after Holm"),
        questionHead(["Category", "Difference", "\u2212100 to +100", "Variant only : baseline only"], kQuestionColumns, []),
        h("tbody", {}, categories.map((d) => h("tr", { class: isReal(d) ? "real" : null }, h("th", { scope: "row" }, data.categories[d.category]?.label ?? "", stars(d)),
          h("td", { class: "number strong" }, points(d.diff)), h("td", { class: "bar" }, differenceBar(d)), h("td", { class: "number" }, split(d.pairs)),
          questionCells(d.on_these_starts), questionCells(d.for_starts_never_tried)))))) : null,
      scroller("Variants against their baselines", h("table", { class: "plain deltas" }, h("caption", {}, "By task"),
        h("thead", {}, h("tr", {}, ["Variant", "What moved", "Variant %", "Baseline %", "Difference", "\u2212100 to +100", "Interval", "Variant only : baseline only", "Starts", "p", "q"]
          .map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, shown.length ? shown.map((d) => row(state, d)) : h("tr", {}, h("td", { colspan: 11, class: "nothing" }, "No comparison fits the choice.")))), shown.length > 14),
      details("How to read this table",
        h("p", {}, "Each start is met once by the variant and once by its baseline; only starts where they came out differently say anything (column \u201cvariant only : baseline only\u201d). p is exact: how many of all ways to exchange variant and baseline differ as much. ",
          h("b", {}, "On these starts"), " every start is exchanged by itself (variants of one baseline together with it); ", h("b", {}, "for starts never tried"), " all starts in one place are exchanged together. One task\u2019s starts are places of their own, so a task has one answer to both. ",
          `q keeps the share of false findings over all tasks at the stated level (Benjamini and Hochberg), and by category the chance of any (Holm). \u2217 marks q \u2264 0.05 on these starts, \u2217\u2217 for starts never tried too. ${kConfounded} marks comparisons that move more than one thing.`)));
  };
  state.watch(draw);
  return panel("deltas", "Variants against baselines", "What one change does to a policy, start by start, in percentage points.", holder);
}
