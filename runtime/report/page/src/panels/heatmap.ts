// Source x target on clean scenes with plain words.
import { h, replace, scroller, select } from "../dom";
import { percent, rate, spoken } from "../format";
import { objectName } from "../model";
import { mainMetrics, nothing, novel, type Panel, panel } from "../parts";
import type { State } from "../state";
import { shade } from "../theme";

export function heatmap(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const metrics = mainMetrics(data);
  const cells = data.tables.pairs ?? [];
  let policy = state.typical(), metric = metrics[0] ?? -1;
  const sources = [...new Set(cells.map((c) => c.source))], targets = [...new Set(cells.map((c) => c.target))];
  const unseen = (object: number, role: "source" | "target") => data.objects[object]?.seen?.[role] === false;
  const draw = (): void => {
    if (!cells.length) return replace(holder, nothing(data, "pairs", "No task here has a clean scene and plain words."));
    if (!state.chosen.includes(policy)) policy = state.typical();
    const own = cells.filter((c) => c.policy === policy && c.metric === metric);
    replace(holder,
      h("div", { class: "controls" },
        select("Policy", state.chosen.map((p) => data.policies[p]!.label), state.chosen.indexOf(policy), (i) => { policy = state.chosen[i]!; draw(); }),
        select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); })),
      scroller("Source by target", h("table", { class: "heat" }, h("caption", { class: "unseen" }, "Sources down, targets across"),
        h("thead", {}, h("tr", {}, h("td", { class: "corner" }, "source \u2193   target \u2192"), targets.map((t) => h("th", { scope: "col" }, objectName(data, t), unseen(t, "target") ? novel("not seen as a target in training") : null)))),
        h("tbody", {}, sources.map((source) => h("tr", {}, h("th", { scope: "row" }, objectName(data, source), unseen(source, "source") ? novel("not seen as a source in training") : null),
          targets.map((target) => {
            const cell = own.find((c) => c.source === source && c.target === target);
            const r = rate(cell?.e ?? null);
            if (!cell?.e || r === null) return h("td", { class: "blank" }, h("span", { class: "unseen" }, "no such task"));
            const { background, ink } = shade(r);
            return h("td", { style: `background:${background};color:${ink}`, title: `${objectName(data, source)} on ${objectName(data, target)}: ${spoken(cell.e)}` },
              h("b", {}, percent(r)), h("small", {}, `${cell.e[0]}/${cell.e[1]}`), cell.ood.includes("relation") ? h("span", { class: "novel", role: "img", "aria-label": "the relation was not seen in training", title: "the relation was not seen in training" }, "\u25c7") : null);
          })))))),
      h("p", { class: "key" }, novel(), " not seen in training in this role;  \u25c7 both seen, never together."));
  };
  state.watch(draw);
  return panel("heatmap", "Source by target", "Which object goes onto which, in percent; darker is more.", holder);
}
