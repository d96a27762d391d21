// Policies x metrics x categories, with counts and intervals; other people's numbers below ours, marked.
import { h, replace, scroller } from "../dom";
import { fixed, percent } from "../format";
import type { Data, ExternalRow } from "../model";
import { estimateCell, nothing, type Panel, panel, policyLabel } from "../parts";
import type { State } from "../state";

// Where the long words of category names may break; browsers without a dictionary would break them anywhere.
const hyphenated = (label: string): string =>
  label.replace(/commonsense/gi, (w) => `${w.slice(0, 6)}\u00ad${w.slice(6)}`).replace(/appearance/gi, (w) => `${w.slice(0, 6)}\u00ad${w.slice(6)}`).replace(/distraction/gi, (w) => `${w.slice(0, 7)}\u00ad${w.slice(7)}`);

function head(data: Data): HTMLElement {
  return h("thead", {}, h("tr", {},
    h("th", { scope: "col", class: "who" }, "Policy"), h("th", { scope: "col", class: "what" }, "Metric"),
    h("th", { scope: "col", class: "all" }, data.tables.main?.all_label ?? "All"),
    data.categories.map((c) => h("th", { scope: "col" }, hyphenated(c.label)))));
}

function ours(state: State): HTMLElement[] {
  const rows = state.data.tables.main!.rows;
  const bodies: HTMLElement[] = [];
  for (const policy of new Set(rows.map((row) => row.policy))) {
    const own = rows.filter((row) => row.policy === policy);
    bodies.push(h("tbody", {}, own.map((row, i) => h("tr", {},
      i === 0 ? h("th", { scope: "rowgroup", class: "who", rowspan: own.length }, policyLabel(state, policy)) : null,
      h("th", { scope: "row", class: "what" }, state.data.metrics[row.metric]?.label ?? ""),
      h("td", { class: "all" }, estimateCell(row.all, 1)),
      state.data.categories.map((_, c) => h("td", {}, estimateCell(row.cells[c] ?? null, 1)))))));
  }
  return bodies;
}

function theirs(data: Data, flags: string[]): HTMLElement[] {
  const bodies: HTMLElement[] = [];
  for (const table of data.tables.external ?? []) {
    bodies.push(h("tbody", { class: "external source" }, h("tr", {},
      h("th", { scope: "rowgroup", colspan: data.categories.length + 3 }, h("span", { class: "tag" }, "not ours"), "as published in ", h("cite", { title: table.source }, table.source.replace(/^.*\//, ""))))));
    const by = new Map<string, ExternalRow[]>();
    for (const row of table.rows) by.set(row.policy, [...(by.get(row.policy) ?? []), row]);
    for (const [policy, rows] of by) {
      bodies.push(h("tbody", { class: "external" }, rows.map((row, i) => h("tr", {},
        i === 0 ? h("th", { scope: "rowgroup", class: "who", rowspan: rows.length }, h("span", { class: "policy" }, h("span", { class: "mark other", "aria-hidden": "true" }, "\u2217"), h("span", { class: "name" }, policy))) : null,
        h("th", { scope: "row", class: "what" }, data.metrics.find((m) => m.name === row.metric)?.label ?? row.metric),
        [row.all, ...data.categories.map((_, c) => row.cells[c] ?? null)].map((value, c) => {
          const flag = row.flags?.[c];
          if (flag) flags.push(`${policy}, ${row.metric}, ${c === 0 ? "all" : data.categories[c - 1]!.label}: ${flag}`);
          return h("td", { class: c === 0 ? "all" : null }, value === null ? h("span", { class: "none" }, "\u2013") : h("span", { class: "rate" }, fixed(value, 1)),
            row.n?.[c] ? h("span", { class: "count" }, `of ${row.n[c]}`) : null,
            flag ? h("span", { class: "flag", title: flag }, "\u2691 ", h("span", { class: "unseen" }, flag)) : null);
        })))));
    }
  }
  return bodies;
}

export function mainTable(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  state.watch(() => {
    const main = data.tables.main;
    if (!main?.rows.length && !data.tables.external?.length) return replace(holder, nothing(data, "main", "No episode has been judged, so there is no rate to show."));
    const flags: string[] = [];
    const table = h("table", { class: "main" }, h("caption", { class: "unseen" }, "Percent of episodes by policy, metric and category"),
      head(data), main?.rows.length ? ours(state) : null, theirs(data, flags));
    replace(holder, scroller("Main table, scrolls sideways", table),
      flags.length ? h("div", { class: "flags" }, h("h3", {}, "\u2691 Published numbers that no count of episodes gives"), h("ul", {}, flags.map((flag) => h("li", {}, flag)))) : null);
  });
  return panel("main", "Main table",
    ["Percent of valid episodes, beneath it their count and the interval. ", data.interval ?? `Intervals: ${percent(data.confidence ?? 0.95)} %.`], holder);
}
