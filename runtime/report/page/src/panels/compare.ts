// Policies in pairs: which differences are real, and how small a one the data could have shown.
import { h, replace, scroller, select, simpleTable } from "../dom";
import { percent, points, probability, signedRange } from "../format";
import { details, differenceBar, mainMetrics, nothing, type Panel, panel, policyLabel, prose } from "../parts";
import type { State } from "../state";

export function compare(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const all = data.tables.compare ?? [];
  const preferred = mainMetrics(data);
  const place = (m: number): number => (preferred.includes(m) ? preferred.indexOf(m) : 99);
  const metrics = [...new Set(all.map((c) => c.metric))].sort((a, b) => place(a) - place(b)), scopes = [...new Set(all.map((c) => c.scope))];
  let metric = metrics[0] ?? -1, scope = scopes[0] ?? "";
  const draw = (): void => {
    if (!all.length) return replace(holder, nothing(data, "compare", "Two policies with the same starts are needed to compare any."));
    const rows = all.filter((c) => c.metric === metric && c.scope === scope && state.chosen.includes(c.a) && state.chosen.includes(c.b));
    const ranking = (data.tables.ranking ?? []).filter((r) => r.metric === metric && state.chosen.includes(r.policy)).sort((a, b) => b.score - a.score);
    const sequential = (data.tables.sequential ?? []).filter((q) => q.metric === metric && state.chosen.includes(q.a) && state.chosen.includes(q.b));
    const mixed = (data.tables.mixed ?? []).filter((m) => m.metric === metric);
    replace(holder,
      h("div", { class: "controls" }, select("Metric", metrics.map((m) => data.metrics[m]?.label ?? ""), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); }),
        scopes.length > 1 ? select("Where", scopes, scopes.indexOf(scope), (i) => { scope = scopes[i]!; draw(); }) : null),
      scroller("Policies in pairs", h("table", { class: "plain" }, h("caption", { class: "unseen" }, "Policies in pairs"),
        h("thead", {}, h("tr", {}, ["Policy", "Against", "Difference", "\u2212100 to +100", "Interval", "Starts", "p", "q", "Verdict"].map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, rows.map((c) => h("tr", { class: c.real ? "real" : null }, h("th", { scope: "row" }, policyLabel(state, c.a)), h("td", {}, policyLabel(state, c.b)),
          h("td", { class: "number strong" }, points(c.diff) || "0"), h("td", { class: "bar" }, differenceBar(c)), h("td", { class: "number" }, signedRange(c.low, c.high)), h("td", { class: "number" }, String(c.starts)),
          h("td", { class: "number" }, probability(c.p)), h("td", { class: "number" }, probability(c.q)),
          h("td", {}, c.real ? "real" : c.diff === 0 && (c.p ?? 0) > 0.995 ? "no difference seen" : c.detectable ? `cannot tell; ${percent(c.detectable, 1)} points would have shown` : "cannot tell")))))),
      ranking.length ? simpleTable("Ranking (Bradley and Terry): the higher, the more often ahead where two differ", ["Policy", "Score", "Interval"],
        ranking.map((r) => [policyLabel(state, r.policy), r.score.toFixed(2), r.low === null || r.low === undefined || r.high === null || r.high === undefined ? "\u2013" : `${r.low.toFixed(2)} to ${r.high.toFixed(2)}`])) : null,
      sequential.length ? simpleTable("Could it have stopped earlier? A sequential test on the places of start in their order", ["Policy", "Against", "Places used", "Ahead", "Behind", "p at any time", ""],
        sequential.map((q) => [policyLabel(state, q.a), policyLabel(state, q.b), `${q.used} of ${q.places}`, String(q.a_wins), String(q.b_wins), probability(q.p), q.stopped ? "could have stopped there" : "needed all"])) : null,
      mixed.map((m) => details(`Mixed model: ${m.model ?? data.metrics[m.metric]?.label ?? ""}`, m.rows.length ? simpleTable(`Mixed model of ${data.metrics[m.metric]?.label ?? ""}${m.n ? `, ${m.n} episodes` : ""}`, ["Term", "Kind", "Odds ratio", "Interval", "p", ""],
        m.rows.map((r) => [r.term, r.kind, r.odds === null ? "\u2013" : r.odds.toPrecision(3), r.low === null || r.high === null ? "\u2013" : `${r.low.toPrecision(2)} to ${r.high.toPrecision(2)}`, probability(r.p), r.note ?? ""])) : null,
        h("p", { class: "key" }, m.random?.length ? ` Random: ${m.random.map((r) => `${r.factor} (sd ${r.sd.toFixed(2)})`).join(", ")}.` : "", m.note ? prose(` ${m.note}`) : null))));
  };
  state.watch(draw);
  return panel("compare", "Policies in pairs", "On the same starts: who is better, by how much, and whether the data can tell.", holder);
}
