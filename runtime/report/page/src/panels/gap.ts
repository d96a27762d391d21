// The intention-action gap: how much of what was meant is not done, by policy and by category.
import { axisStyle, chart, percentAxis, tooltip } from "../chart";
import { h, replace, scroller, select } from "../dom";
import { points, probability, signedRange, spoken } from "../format";
import type { Gap } from "../model";
import { differenceBar, nothing, type Panel, panel, policyLabel, shortCell } from "../parts";
import type { State } from "../state";
import { markPath, policyColor, token } from "../theme";

interface Row { name: string; policy: number; gap: Gap }

function dumbbells(rows: Row[], label: string): HTMLElement {
  const ends = (g: Gap): [number, number] => [(100 * g.success![0]) / g.success![1], (100 * g.intention![0]) / g.intention![1]];
  return chart(label, 44 + 30 * rows.length, () => ({
    grid: { left: 8, right: 24, top: 6, bottom: 4, containLabel: true },
    xAxis: percentAxis(),
    yAxis: { ...axisStyle(), type: "category", inverse: true, data: rows.map((r) => r.name), axisLabel: { color: token("--ink"), fontSize: 12.5, fontWeight: 500, width: 210, overflow: "truncate" }, splitLine: { show: false } },
    tooltip: tooltip((q: { dataIndex: number }) => {
      const r = rows[q.dataIndex]!;
      return [r.name, `intention ${spoken(r.gap.intention)}`, `success ${spoken(r.gap.success)}`, `gap ${points(r.gap.diff)} points, ${signedRange(r.gap.low, r.gap.high)}`];
    }),
    series: [
      { type: "custom" as const, silent: true, data: rows.map((r, i) => [i, ...ends(r.gap)]), encode: { y: 0, x: [1, 2] },
        renderItem: (_: unknown, api: { value(d: number): number; coord(p: number[]): number[] }) => {
          const a = api.coord([api.value(1), api.value(0)]), b = api.coord([api.value(2), api.value(0)]);
          return { type: "line" as const, shape: { x1: a[0], y1: a[1], x2: b[0], y2: b[1] }, style: { stroke: policyColor(rows[api.value(0)]!.policy), lineWidth: 3, opacity: 0.45 } };
        } },
      { type: "scatter" as const, symbolSize: 12, z: 3, data: rows.map((r, i) => ({ value: [ends(r.gap)[1], i], symbol: `path://${markPath(r.policy)}`, itemStyle: { color: token("--paper"), borderColor: policyColor(r.policy), borderWidth: 2 } })) },
      { type: "scatter" as const, symbolSize: 12, z: 4, data: rows.map((r, i) => ({ value: [ends(r.gap)[0], i], symbol: `path://${markPath(r.policy)}`, itemStyle: { color: policyColor(r.policy) } })) },
    ],
  }));
}

export function gap(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  let by = 0;  // 0: all policies over everything, else one policy by category
  const draw = (): void => {
    const all = (data.tables.gap ?? []).filter((g) => g.intention && g.success && state.chosen.includes(g.policy));
    if (!all.length) return replace(holder, nothing(data, "gap", "The gap needs valid episodes of plans with the metrics intention and success."));
    if (by > state.chosen.length) by = 0;
    const chosen = by === 0 ? all.filter((g) => g.category < 0) : all.filter((g) => g.policy === state.chosen[by - 1]);
    const rows = chosen.map((g): Row => ({ gap: g, policy: g.policy, name: by === 0 ? data.policies[g.policy]!.label : g.category < 0 ? "All" : data.categories[g.category]?.label ?? "" }));
    const label = "Intention-action gap. " + rows.slice(0, 8).map((r) => `${r.name}: intention ${spoken(r.gap.intention)}, success ${spoken(r.gap.success)}`).join("; ");
    replace(holder, h("div", { class: "controls" },
      select("Show", ["all policies", ...state.chosen.map((p) => `${data.policies[p]!.label}, by category`)], by, (i) => { by = i; draw(); })),
      h("p", { class: "key" }, "Filled mark: success. Hollow mark: intention."), dumbbells(rows, label),
      scroller("Gap as a table", h("table", { class: "plain" }, h("caption", {}, "The gap in numbers"), h("thead", {}, h("tr", {}, [by === 0 ? "Policy" : "Category", "Intention", "Success", "Gap", "", "Interval on these starts", "for starts never tried"].map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, rows.map((r) => h("tr", {}, h("th", { scope: "row" }, by === 0 ? policyLabel(state, r.policy) : r.name), h("td", {}, shortCell(r.gap.intention)), h("td", {}, shortCell(r.gap.success)),
          h("td", { class: "number strong" }, points(r.gap.diff) || "0"), h("td", { class: "bar" }, differenceBar(r.gap)), 
          [r.gap.on_these_starts, r.gap.for_starts_never_tried].map((a) => h("td", { class: "number" }, signedRange(a.low, a.high), h("small", {}, ` p ${probability(a.p)}`)))))))));
  };
  state.watch(draw);
  return panel("gap", "Intention\u2013action gap", "Episodes where the policy went for the right object and still did not finish, in points of all episodes.", holder);
}
