// Every variant against its baseline on the same starts, one policy and metric at a time.
import { breakable, type Child, checkbox, h, replace, scroller, select } from "../dom";
import { percent, points, probability, signedRange } from "../format";
import { type Delta, taskName } from "../model";
import { details, differenceBar, kConfounded, mainMetrics, nothing, type Panel, panel, policyLabel } from "../parts";
import type { State } from "../state";

const split = (pairs: number[] | null): string => (pairs ? `${pairs[1]} : ${pairs[2]}` : "not paired");
const share = ([k, n]: [number, number]): Child => [percent(k / n), h("small", {}, `${k}/${n}`)];

function row(state: State, d: Delta): HTMLElement {
  const { data } = state;
  const task = data.tasks[d.task]!;
  const real = d.q !== null && d.q !== undefined && d.q <= 0.05;
  return h("tr", { class: real ? "real" : null },
    h("th", { scope: "row" }, h("a", { href: `#task-${d.task}` }, breakable(task.name)), task.confounded ? h("abbr", { title: `confounded: ${task.confounded}`, class: "dagger" }, kConfounded) : null,
      h("span", { class: "sub" }, "against ", breakable(taskName(data, d.baseline)))),
    h("td", { class: "words" }, task.axes.join(", ") || "\u2013"),
    h("td", { class: "number" }, share(d.first)), h("td", { class: "number" }, share(d.second)),
    h("td", { class: "number strong" }, points(d.diff), d.floor ? h("abbr", { class: "floor", title: "the baseline never succeeds: there is nothing to lose" }, "floor") : null),
    h("td", { class: "bar" }, differenceBar(d)),
    h("td", { class: "number" }, signedRange(d.low, d.high)),
    h("td", { class: "number" }, split(d.pairs)),
    h("td", { class: "number" }, String(d.starts)),
    h("td", { class: "number" }, probability(d.p)),
    h("td", { class: "number" }, probability(d.q), real ? h("span", { class: "star", title: "real at a false discovery rate of 5 %" }, "\u2217") : null));
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
    const sorted = order === 0 ? own : [...own].sort((a, b) => (order === 1 ? a.diff - b.diff : (a.q ?? 2) - (b.q ?? 2)));
    const shown = onlyReal ? sorted.filter((d) => (d.q ?? 1) <= 0.05) : sorted;
    const real = own.filter((d) => (d.q ?? 1) <= 0.05).length;
    const categories = (data.tables.category_deltas ?? []).filter((d) => d.policy === policy && d.metric === metric);
    replace(holder,
      h("div", { class: "controls" },
        select("Policy", state.chosen.map((p) => data.policies[p]!.label), state.chosen.indexOf(policy), (i) => { policy = state.chosen[i]!; draw(); }),
        select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); }),
        select("Order", ["of the suite", "largest loss first", "surest first"], order, (i) => { order = i; draw(); }),
        checkbox("only real differences", onlyReal, (on) => { onlyReal = on; draw(); })),
      h("p", { class: "summary", "aria-live": "polite" }, policyLabel(state, policy), ` differs from the baseline in ${real} of ${own.length} comparisons.`),
      categories.length ? scroller("Differences by category", h("table", { class: "plain deltas" }, h("caption", {}, "By category; q after Holm"),
        h("thead", {}, h("tr", {}, ["Category", "Difference", "", "Interval", "Variant only : baseline only", "Starts", "p", "q"].map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, categories.map((d) => h("tr", { class: (d.q ?? 1) <= 0.05 ? "real" : null }, h("th", { scope: "row" }, data.categories[d.category]?.label ?? ""),
          h("td", { class: "number strong" }, points(d.diff)), h("td", { class: "bar" }, differenceBar(d)), h("td", { class: "number" }, signedRange(d.low, d.high)),
          h("td", { class: "number" }, split(d.pairs)), h("td", { class: "number" }, String(d.starts)),
          h("td", { class: "number" }, probability(d.p)), h("td", { class: "number" }, probability(d.q))))))) : null,
      scroller("Variants against their baselines", h("table", { class: "plain deltas" }, h("caption", {}, "By task"),
        h("thead", {}, h("tr", {}, ["Variant", "What moved", "Variant %", "Baseline %", "Difference", "\u2212100 to +100", "Interval", "Variant only : baseline only", "Starts", "p", "q"]
          .map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, shown.length ? shown.map((d) => row(state, d)) : h("tr", {}, h("td", { colspan: 11, class: "nothing" }, "No comparison fits the choice.")))), shown.length > 14),
      details("How to read this table",
        h("p", {}, "Each start is met once by the variant and once by its baseline; only starts where they came out differently say anything (column \u201cvariant only : baseline only\u201d). p is McNemar\u2019s exact test, clustered by start where seeds repeat it; q keeps the share of false findings over all tasks at the stated level (Benjamini and Hochberg). \u2217 marks q \u2264 0.05. ",
          `${kConfounded} marks comparisons that move more than one thing.`)));
  };
  state.watch(draw);
  return panel("deltas", "Variants against baselines", "What one change does to a policy, start by start, in percentage points.", holder);
}
