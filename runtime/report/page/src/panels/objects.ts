// Per-object bars, as source and as target, with intervals; objects that training never showed are marked.
import { axisStyle, chart, percentAxis, tooltip, whiskers } from "../chart";
import { h, replace, select, simpleTable } from "../dom";
import { percent, rate, spoken } from "../format";
import { type ObjectCell, objectName } from "../model";
import { details, kNovel, legend, mainMetrics, nothing, type Panel, panel, policyLabel, shortCell } from "../parts";
import type { State } from "../state";
import { decal, policyColor, token } from "../theme";

function bars(state: State, cells: ObjectCell[], role: "source" | "target"): HTMLElement | null {
  const { data } = state;
  const objects = [...new Set(cells.map((c) => c.object))];
  if (!objects.length) return null;
  const at = (p: number, o: number) => cells.find((c) => c.policy === p && c.object === o);
  const isNovel = (o: number) => cells.some((c) => c.object === o && c.ood);
  // Seen objects first; the list grows downwards.
  objects.sort((a, b) => Number(isNovel(a)) - Number(isNovel(b)));
  const slots = state.chosen.length, width = slots > 5 ? 6 : 8, gap = 0.25;
  const names = objects.map((o) => (isNovel(o) ? `${kNovel} ` : "") + objectName(data, o));
  const label = `Bars by ${role}: ` + objects.map((o) => `${objectName(data, o)} ` + state.chosen.map((p) => `${data.policies[p]!.label} ${percent(rate(at(p, o)?.e ?? null))}`).join(", ")).slice(0, 3).join("; ");
  return h("figure", {}, h("figcaption", {}, `As ${role}`),
    chart(label, 46 + objects.length * (slots * width * (1 + gap) + 14), () => ({
      grid: { left: 8, right: 18, top: 6, bottom: 4, containLabel: true },
      xAxis: { ...percentAxis(), position: "bottom" },
      yAxis: { ...axisStyle(), type: "category", data: names, inverse: true, splitLine: { show: true, lineStyle: { color: token("--rule") } },
        axisLabel: { color: token("--ink"), fontSize: 12.5, fontWeight: 500, width: 130, overflow: "truncate" } },
      tooltip: tooltip((p: { seriesIndex: number; dataIndex: number }) => {
        const policy = state.chosen[p.seriesIndex]!, o = objects[p.dataIndex]!;
        return [`${data.policies[policy]!.label}, ${objectName(data, o)}`, spoken(at(policy, o)?.e ?? null)];
      }),
      series: [
        ...state.chosen.map((p) => ({ type: "bar" as const, barWidth: width, barGap: "25%", name: String(p), itemStyle: { color: policyColor(p), decal: decal(p) },
          data: objects.map((o) => { const r = rate(at(p, o)?.e ?? null); return r === null ? "-" : 100 * r; }) })),
        ...state.chosen.map((p, slot) => whiskers(objects.map((o, i) => { const e = at(p, o)?.e; return e ? [i, 100 * e[2], 100 * e[3]] : [i, null, null]; }).filter((d) => d[1] !== null), slot, slots, width, gap, true)),
      ],
    })));
}

export function objects(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const metrics = mainMetrics(data);
  let metric = metrics[0] ?? -1;
  const draw = (): void => {
    const cells = (data.tables.objects ?? []).filter((c) => c.metric === metric && state.chosen.includes(c.policy));
    if (!data.tables.objects?.length) return replace(holder, nothing(data, "objects", "No task here has a clean scene and plain words."));
    const rows = (role: "source" | "target") => [...new Set(cells.filter((c) => c.role === role).map((c) => c.object))].map((o) => [
      [objectName(data, o), cells.some((c) => c.object === o && c.role === role && c.ood) ? ` ${kNovel}` : ""],
      ...state.chosen.map((p) => shortCell(cells.find((c) => c.policy === p && c.object === o && c.role === role)?.e ?? null))]);
    replace(holder, h("div", { class: "controls" }, select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); })),
      legend(state), h("div", { class: "two" }, bars(state, cells.filter((c) => c.role === "source"), "source"), bars(state, cells.filter((c) => c.role === "target"), "target")),
      h("p", { class: "key" }, `${kNovel} not seen in training in this role. Whiskers are intervals.`),
      details("The same as a table", (["source", "target"] as const).map((role) => simpleTable(`As ${role}`, ["Object", ...state.chosen.map((p) => policyLabel(state, p))], rows(role)))));
  };
  state.watch(draw);
  return panel("objects", "By object", "How each object fares as the thing to move and as the place to put it; clean scenes and plain words only.", holder);
}
