// Case studies: chosen tasks side by side, each with success, intention and wrong object by policy.
import { axisStyle, chart, percentAxis, tooltip, whiskers } from "../chart";
import { breakable, h, replace, simpleTable } from "../dom";
import { percent, rate, spoken } from "../format";
import { instruction } from "../model";
import { details, legend, metricsNamed, nothing, type Panel, panel, policyLabel, shortCell, wasRun } from "../parts";
import type { State } from "../state";
import { decal, policyColor, token } from "../theme";

const kMost = 9;

function one(state: State, task: number, metrics: number[]): HTMLElement {
  const { data } = state;
  const at = (p: number, m: number) => data.tables.by_task?.[data.metrics[m]!.name]?.[p]?.[task] ?? null;
  const slots = state.chosen.length, width = slots > 5 ? 8 : 11, gap = 0.25;
  const record = data.tasks[task]!;
  const label = `${record.name}. ` + state.chosen.map((p) => `${data.policies[p]!.label}: ` + metrics.map((m) => `${data.metrics[m]!.label} ${percent(rate(at(p, m)))} %`).join(", ")).join("; ");
  return h("figure", { class: "case" }, h("figcaption", {}, h("a", { href: `#task-${task}` }, breakable(record.name)), h("q", { class: "prompt" }, instruction(record))),
    chart(label, 210, () => ({
      grid: { left: 4, right: 6, top: 10, bottom: 4, containLabel: true },
      xAxis: { ...axisStyle(), type: "category", data: metrics.map((m) => data.metrics[m]!.label), axisLabel: { color: token("--ink"), fontSize: 12, interval: 0 } },
      yAxis: percentAxis(),
      tooltip: tooltip((q: { seriesIndex: number; dataIndex: number }) => {
        const p = state.chosen[q.seriesIndex]!, m = metrics[q.dataIndex]!;
        return [`${data.policies[p]!.label}: ${data.metrics[m]!.label}`, spoken(at(p, m))];
      }),
      series: [
        ...state.chosen.map((p) => ({ type: "bar" as const, barWidth: width, barGap: "25%", name: String(p), itemStyle: { color: policyColor(p), decal: decal(p) },
          data: metrics.map((m) => { const r = rate(at(p, m)); return r === null ? "-" : 100 * r; }) })),
        ...state.chosen.map((p, slot) => whiskers(metrics.flatMap((m, i) => { const e = at(p, m); return e ? [[i, 100 * e[2], 100 * e[3]]] : []; }), slot, slots, width, gap, false)),
      ],
    })),
    details("As a table", simpleTable(record.name, ["Policy", ...metrics.map((m) => data.metrics[m]!.label)], state.chosen.map((p) => [policyLabel(state, p), ...metrics.map((m) => shortCell(at(p, m)))]))));
}

export function cases(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const metrics = metricsNamed(data, ["success", "intention", "wrong"]);
  // To begin with: where wrong objects are on offer, the last categories first, one task each.
  const everybody = data.policies.map((_, p) => p);
  const run = data.tasks.flatMap((_, t) => (wasRun(data, everybody, t) ? [t] : []));
  let chosen: number[] = [];
  for (const category of [...data.categories].reverse()) {
    const task = category.tasks.find((t) => data.tasks[t]!.distractors.length > 0 && run.includes(t) && !chosen.includes(t)) ?? category.tasks.find((t) => run.includes(t) && !chosen.includes(t));
    if (task !== undefined && chosen.length < 6) chosen.push(task);
  }
  const draw = (): void => {
    if (!data.tables.by_task || !run.length || !metrics.length || !state.chosen.length) return replace(holder, nothing(data, "cases", "No task was run."));
    const options = run.map((t) => {
      const box = h("input", { type: "checkbox", checked: chosen.includes(t), disabled: !chosen.includes(t) && chosen.length >= kMost, change: () => {
        chosen = box.checked ? [...chosen, t] : chosen.filter((c) => c !== t);
        drawCharts();
        for (const other of list.querySelectorAll<HTMLInputElement>("input")) other.disabled = !other.checked && chosen.length >= kMost;
      } });
      return h("label", { class: "check" }, box, data.tasks[t]!.name);
    });
    const list = h("div", { class: "choices" }, options);
    const charts = h("div", { class: "cases" });
    const drawCharts = () => replace(charts, chosen.map((t) => one(state, t, metrics)), chosen.length ? null : h("p", { class: "nothing" }, "No task is chosen."));
    const open = holder.querySelector("details.choose")?.hasAttribute("open") ?? false;
    replace(holder, h("details", { class: "choose", open }, h("summary", {}, `Choose tasks (up to ${kMost})`), list), legend(state), charts);
    drawCharts();
  };
  state.watch(draw);
  return panel("cases", "Case studies", "Chosen tasks, each with what was done, what was meant, and how often another object was taken instead.", holder);
}
