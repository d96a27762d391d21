// Base tasks beside their rewordings, policies down: the layout of the published language table.
import { type Child, h, replace, scroller, select } from "../dom";
import { percent, plural, points, probability } from "../format";
import { type Contrast, instruction, metricIndex, taskName } from "../model";
import { details, isReal, kConfounded, mainMetrics, nothing, type Panel, panel, policyLabel, shortCell, stars, wasRun } from "../parts";
import type { State } from "../state";

const isLanguage = (axis: string): boolean => axis.startsWith("language");
// Another name for another object is no rewording.
const isReworded = (axes: string[]): boolean => axes.some((a) => isLanguage(a) && a !== "language.paraphrase") || (axes.length > 0 && axes.every(isLanguage));
const shortAxis = (axis: string): string => axis.replace(/^language\./, "");

const share = ([k, n]: [number, number]): Child => h("span", { class: "short" }, h("b", {}, percent(k / n)), h("small", {}, `${k}/${n}`));

function change(d: Contrast | undefined): HTMLElement | null {
  if (!d) return null;
  return h("span", { class: "change" + (isReal(d) ? " real" : ""),
    title: `q ${probability(d.on_these_starts.p_adjusted)} on these starts, ${probability(d.for_starts_never_tried.p_adjusted)} for starts never tried` }, points(d.diff) || "0", stars(d));
}

export function language(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const metrics = mainMetrics(data);
  let metric = Math.max(0, metricIndex(data, "success"));
  // Variants that only say it differently, in groups by their baseline.
  const groups = new Map<number, number[]>();
  data.tasks.forEach((task, t) => {
    if (task.baseline === null || task.baseline < 0 || !isReworded(task.axes)) return;
    groups.set(task.baseline, [...(groups.get(task.baseline) ?? []), t]);
  });
  const reworded = groups.size;
  const everybody = data.policies.map((_, p) => p);
  for (const [base, variants] of groups) {
    const run = variants.filter((t) => wasRun(data, everybody, t));
    if (run.length) groups.set(base, run); else groups.delete(base);
  }
  const isLarge = (variants: number[]): boolean => variants.length >= 3 || groups.size <= 4;
  const large = [...groups].filter(([, variants]) => isLarge(variants)), small = [...groups].filter(([, variants]) => !isLarge(variants));
  const byCategory = (): HTMLElement | null => {
    const rows = (data.tables.language ?? []).filter((r) => r.metric === metric && state.chosen.includes(r.policy) && data.categories[r.category]?.tasks.every((t) => isReworded(data.tasks[t]?.axes ?? [])));
    const categories = [...new Set(rows.map((r) => r.category))];
    if (!rows.length) return null;
    return scroller("Language categories", h("table", { class: "plain compact" }, h("caption", {}, "By kind of rewording: variants, and the same starts of their own baselines"),
      h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Policy"), categories.map((c) => [h("th", { scope: "col", class: "before" }, "baseline"), h("th", { scope: "col" }, data.categories[c]?.label ?? "all")]))),
      h("tbody", {}, state.chosen.map((p) => h("tr", {}, h("th", { scope: "row" }, policyLabel(state, p)), categories.map((c) => {
        const r = rows.find((x) => x.policy === p && x.category === c);
        return [h("td", { class: "before" }, r ? share(r.second) : "\u2013"), h("td", {}, r ? share(r.first) : "\u2013", change(r))];
      }))))));
  };
  const group = (base: number, variants: number[]): HTMLElement => scroller(`Rewordings of ${taskName(data, base)}`, h("table", { class: "plain compact" },
    h("caption", {}, h("b", {}, taskName(data, base))),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Policy"), [base, ...variants].map((t, i) => h("th", { scope: "col" },
      i === 0 ? "original" : data.tasks[t]!.axes.filter(isLanguage).map(shortAxis).join(" + "),
      i > 0 && data.tasks[t]!.axes.some((a) => !isLanguage(a)) ? h("abbr", { class: "dagger", title: `also moved: ${data.tasks[t]!.axes.filter((a) => !isLanguage(a)).join(", ")}` }, kConfounded) : null,
      h("q", { class: "prompt" }, instruction(data.tasks[t]!)))))),
    h("tbody", {}, state.chosen.map((p) => h("tr", {}, h("th", { scope: "row" }, policyLabel(state, p)),
      [base, ...variants].map((t, i) => h("td", {}, shortCell(data.tables.by_task?.[data.metrics[metric]!.name]?.[p]?.[t] ?? null),
        i > 0 ? change(data.tables.deltas?.find((d) => d.policy === p && d.task === t && d.metric === metric)) : null)))))));
  const draw = (): void => {
    if (groups.size === 0 || !data.tables.by_task || !state.chosen.length) return replace(holder, nothing(data, "language", reworded ? "No rewording was run." : "No task here is a rewording of another."));
    replace(holder, h("div", { class: "controls" }, select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); })),
      byCategory(), large.map(([base, variants]) => group(base, variants)),
      small.length ? details(`${plural(small.length, "further task")}, with fewer wordings`, small.map(([base, variants]) => group(base, variants))) : null);
  };
  state.watch(draw);
  return panel("language", "The same task in other words", `Percent, count, and the change against the original wording in points; \u2217 where it is real on these starts (q \u2264 0.05), \u2217\u2217 for starts never tried too, ${kConfounded} where something besides the words changed.`, holder);
}
