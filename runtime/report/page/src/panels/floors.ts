// What a task gives a policy that understands nothing, and what it allows one that sees everything.
import { checkbox, h, replace, scroller, select, s } from "../dom";
import { rate } from "../format";
import { type Floor, taskName } from "../model";
import { nothing, type Panel, panel, shortCell } from "../parts";
import type { State } from "../state";

function room(f: Floor): SVGElement {
  const low = 100 * (rate(f.floor) ?? 0), high = 100 * (rate(f.ceiling) ?? 1);
  return s("svg", { class: "room", viewBox: "0 0 100 8", preserveAspectRatio: "none", "aria-hidden": "true" },
    s("rect", { class: "ground", x: 0, y: 3.5, width: 100, height: 1 }), s("rect", { class: "span", x: low, y: 2, width: Math.max(0.5, high - low), height: 4 }));
}

export function floors(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const all = data.tables.floors ?? [];
  const metrics = [...new Set(all.map((f) => f.metric))].sort((a, b) => a - b);
  let metric = metrics[0] ?? -1, everything = true;
  const odd = (f: Floor): boolean => (rate(f.floor) ?? 0) > 0 || (rate(f.ceiling) ?? 1) < 1 || !!f.note;
  const draw = (): void => {
    const roles = new Set(data.policies.map((p) => p.role));
    if (!all.length) return replace(holder, nothing(data, "floors", `No task has a floor and a ceiling here. They are measured with the policies null${roles.has("floor") ? " (which is here)" : ""} and expert${roles.has("ceiling") ? " (which is here)" : ""}: add both runs to the report, or --floors with a table of them.`));
    const own = all.filter((f) => f.metric === metric);
    const shown = everything ? own : own.filter(odd);
    replace(holder, h("div", { class: "controls" }, select("Metric", metrics.map((m) => data.metrics[m]!.label), metrics.indexOf(metric), (i) => { metric = metrics[i]!; draw(); }),
      checkbox("all tasks, also those with the whole range", everything, (on) => { everything = on; draw(); })),
      h("p", { class: "summary", "aria-live": "polite" }, own.filter(odd).length === 0
        ? `All ${own.length} tasks have the whole range from 0 to 100 %: nothing is given away, nothing is impossible.`
        : `${own.filter(odd).length} of ${own.length} tasks give something away or cannot all be done.`),
      shown.length ? scroller("Floors and ceilings", h("table", { class: "plain" }, h("caption", { class: "unseen" }, "Floors and ceilings by task"),
        h("thead", {}, h("tr", {}, ["Task", "Floor", "Ceiling", "Room between", ""].map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, shown.map((f) => h("tr", {}, h("th", { scope: "row" }, taskName(data, f.task)), h("td", {}, shortCell(f.floor)), h("td", {}, shortCell(f.ceiling)), h("td", { class: "bar" }, room(f)), h("td", {}, f.note ?? ""))))), shown.length > 12) : null);
  };
  state.watch(draw);
  return panel("floors", "Floors and ceilings", "The floor is what a policy that does nothing gets; the ceiling is what the scripted expert reaches. A rate means something only between the two.", holder);
}
