// Policies in pairs: which differences are real, and how small a one the data could have shown.
import { h, replace, scroller, select, simpleTable } from "../dom";
import { count, percent, plural, points, probability } from "../format";
import type { Comparison, Looked } from "../model";
import { details, differenceBar, isReal, kQuestionColumns, mainMetrics, nothing, type Panel, panel, policyLabel, prose, questionCells, questionHead } from "../parts";
import type { State } from "../state";

// In a few words what the numbers beside it say.
function verdict(c: Comparison): string {
  const { on_these_starts: here, for_starts_never_tried: anew } = c;
  if (here.real && anew.real) return "real, here and elsewhere";
  if (anew.real) return "real for starts never tried";
  const more = anew.more ? `, about ${plural(anew.more, "more place")} would` : "";
  if (here.real) return `real on these starts; elsewhere cannot tell${more}`;
  if (c.diff === 0 && here.p > 0.995 && anew.p > 0.995) return "no difference seen";
  const shown = anew.detectable ? `; ${percent(anew.detectable, 1)} points would have shown` : more;
  return `cannot tell${shown}`;
}

const stopped = (l: Looked, units: string): string =>
  `${l.stopped ? `${count(l.used)} of ${count(l.units)} ${units} would have done` : `needed all ${count(l.units)} ${units}`} (${l.a_wins} : ${l.b_wins})`;

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
      scroller("Policies in pairs", h("table", { class: "plain questions" }, h("caption", { class: "unseen" }, "Policies in pairs"),
        questionHead(["Policy", "Against", "Difference", "\u2212100 to +100"], kQuestionColumns, ["Verdict"]),
        h("tbody", {}, rows.map((c) => h("tr", { class: isReal(c) ? "real" : null }, h("th", { scope: "row" }, policyLabel(state, c.a)), h("td", {}, policyLabel(state, c.b)),
          h("td", { class: "number strong" }, points(c.diff) || "0"), h("td", { class: "bar" }, differenceBar(c)),
          questionCells(c.on_these_starts), questionCells(c.for_starts_never_tried), h("td", { class: "verdict" }, verdict(c))))))),
      details("How to read this table",
        h("p", {}, h("b", {}, "On these starts"), " asks whether it matters, on the very starts that were run, which of the two acted: every start is a finding of its own. ",
          h("b", {}, "For starts never tried"), " asks whether it would matter elsewhere: all tasks that start in one place are one finding, so it takes places, not starts, to answer."),
        h("p", {}, "In the drawing the thick line is the interval on these starts, the thin one for starts never tried. p is exact; q keeps the chance of any false finding among the pairs of a metric at 5 % (Holm), for each question by itself.")),
      ranking.length ? simpleTable("Ranking on these starts (Bradley and Terry): the higher, the more often ahead where two differ", ["Policy", "Score", "Interval"],
        ranking.map((r) => [policyLabel(state, r.policy), r.score.toFixed(2), r.low === null || r.low === undefined || r.high === null || r.high === undefined ? "\u2013" : `${r.low.toFixed(2)} to ${r.high.toFixed(2)}`])) : null,
      sequential.length ? simpleTable("Could it have stopped earlier? Looked at after every start, and after every place with all its tasks", ["Policy", "Against", "On these starts", "p at any time", "For starts never tried", "p at any time"],
        sequential.map((q) => [policyLabel(state, q.a), policyLabel(state, q.b), stopped(q.on_these_starts, "starts"), probability(q.on_these_starts.p), stopped(q.for_starts_never_tried, "places"), probability(q.for_starts_never_tried.p)])) : null,
      mixed.map((m) => details(`Mixed model: ${m.model ?? data.metrics[m.metric]?.label ?? ""}`, m.rows.length ? simpleTable(`Mixed model of ${data.metrics[m.metric]?.label ?? ""}${m.n ? `, ${m.n} episodes` : ""}`, ["Term", "Kind", "Odds ratio", "Interval", "p", ""],
        m.rows.map((r) => [r.term, r.kind, r.odds === null ? "\u2013" : r.odds.toPrecision(3), r.low === null || r.high === null ? "\u2013" : `${r.low.toPrecision(2)} to ${r.high.toPrecision(2)}`, probability(r.p), r.note ?? ""])) : null,
        h("p", { class: "key" }, m.random?.length ? ` Random: ${m.random.map((r) => `${r.factor} (sd ${r.sd.toFixed(2)})`).join(", ")}.` : "", m.note ? prose(` ${m.note}`) : null))));
  };
  state.watch(draw);
  return panel("compare", "Policies in pairs", "On the same starts: who is better, by how much, whether that is certain on these starts, and whether it is for starts never tried.", holder);
}
