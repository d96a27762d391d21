// Pieces that several panels share.
import { type Child, h, s } from "./dom";
import { count, percent, points, probability, range, rate, signedRange, spoken } from "./format";
import type { Answer, Data, Difference, Estimate, Level, Note } from "./model";
import type { State } from "./state";
import { mark } from "./theme";

export interface Panel { id: string; title: string; element: HTMLElement }

export function panel(id: string, title: string, lead: Child, ...children: Child[]): Panel {
  return { id, title, element: h("section", { id, "aria-labelledby": `${id}-title` },
    h("h2", { id: `${id}-title` }, title), lead ? h("p", { class: "lead" }, lead) : null, children) };
}

// What stands where there is nothing to show, with the reason if the data gives one.
export function nothing(data: Data, table: string, otherwise: string): HTMLElement {
  return h("p", { class: "nothing" }, data.empty?.[table] ?? otherwise);
}

export function policyLabel(state: State, policy: number): HTMLElement {
  return h("span", { class: "policy" }, mark(policy), h("span", { class: "name" }, state.data.policies[policy]?.label ?? "?"));
}

// Which line is whose, above charts.
export function legend(state: State): HTMLElement {
  return h("ul", { class: "legend", "aria-label": "Policies drawn" }, state.chosen.map((p) => h("li", {}, policyLabel(state, p))));
}

// Rate, count and interval, with the interval drawn beneath.
export function estimateCell(e: Estimate, digits = 0): Child[] {
  if (!e) return [h("span", { class: "none", title: "not run" }, "\u2013")];
  return [
    h("span", { class: "rate" }, percent(rate(e), digits)),
    h("span", { class: "count" }, `${count(e[0])}/${count(e[1])}`),
    h("span", { class: "interval" }, range(e[2], e[3])),
    track(e),
  ];
}

export function track(e: NonNullable<Estimate>): SVGElement {
  const middle = 100 * (rate(e) ?? 0);
  return s("svg", { class: "track", viewBox: "0 0 100 6", preserveAspectRatio: "none", "aria-hidden": "true" },
    s("rect", { class: "ground", x: 0, y: 2.5, width: 100, height: 1 }),
    s("rect", { class: "span", x: 100 * e[2], y: 1.5, width: Math.max(1, 100 * (e[3] - e[2])), height: 3 }),
    s("rect", { class: "point", x: Math.min(98, Math.max(0, middle - 1)), y: 0, width: 2, height: 6 }));
}

// "15/24" with the rest for whoever asks.
export function shortCell(e: Estimate): Child {
  return e ? h("span", { class: "short", title: spoken(e) }, h("b", {}, percent(rate(e))), h("small", {}, `${e[0]}/${e[1]}`)) : h("span", { class: "none" }, "\u2013");
}

// A difference around zero: the thick line is its interval on these starts, the thin one for starts never tried.
export function differenceBar(d: Difference): SVGElement {
  const at = (x: number) => 100 + 100 * x;
  const { on_these_starts: here, for_starts_never_tried: anew } = d;
  const sure = (a: Answer): string => (a.low > 0 || a.high < 0 ? " sure" : "");
  return s("svg", { class: "difference" + sure(anew), viewBox: "0 0 200 14", role: "img",
    "aria-label": `${points(d.diff)} points, ${signedRange(here.low, here.high)} on these starts, ${signedRange(anew.low, anew.high)} for starts never tried` },
    s("line", { class: "ground", x1: 0, y1: 7, x2: 200, y2: 7 }),
    s("line", { class: "zero", x1: 100, y1: 0, x2: 100, y2: 14 }),
    s("line", { class: "span", x1: at(anew.low), y1: 7, x2: at(anew.high), y2: 7 }),
    s("line", { class: "span here" + sure(here), x1: at(here.low), y1: 7, x2: at(here.high), y2: 7 }),
    s("circle", { class: "point", cx: at(d.diff), cy: 7, r: 3.6 }));
}

// The heads of two questions' columns, over the heads of each; `first` columns come before, `last` after.
export function questionHead(first: string[], of: string[], last: string[]): HTMLElement {
  const single = (text: string) => h("th", { scope: "col", rowspan: 2 }, text);
  return h("thead", {},
    h("tr", {}, first.map(single), ["On these starts", "For starts never tried"].map((text) => h("th", { scope: "colgroup", colspan: of.length, class: "question" }, text)), last.map(single)),
    h("tr", {}, ["Starts", "Places"].map((units) => of.map((text, i) => h("th", { scope: "col", class: i === 0 ? "begins" : null }, text === "units" ? units : text)))));
}
// Units, interval, and q with the p that it was made from.
export const kQuestionColumns = ["units", "Interval", "q"];
export function questionCells(a: Answer): HTMLElement[] {
  return [h("td", { class: "number begins" }, count(a.units)), h("td", { class: "number" }, signedRange(a.low, a.high)),
    h("td", { class: "number" + (a.real ? " strong" : "") }, probability(a.p_adjusted), h("small", {}, `p ${probability(a.p)}`))];
}
export const isReal = (d: Difference): boolean => !!d.on_these_starts.real || !!d.for_starts_never_tried.real;
// One star for these starts, two where it holds for starts never tried too.
export function stars(d: Difference): HTMLElement | null {
  const here = !!d.on_these_starts.real, anew = !!d.for_starts_never_tried.real;
  if (!here && !anew) return null;
  const where = here && anew ? "on these starts and for starts never tried" : here ? "on these starts only" : "for starts never tried only";
  return h("span", { class: "star", title: `real ${where} (q \u2264 0.05)` }, here && anew ? "\u2217\u2217" : here ? "\u2217" : "(\u2217)", h("span", { class: "unseen" }, `real ${where}`));
}

// Words between backticks are code.
export function prose(text: string): Child[] {
  return text.split("`").map((part, i) => (i % 2 ? h("code", {}, part) : part));
}

const kSigns: Record<Level, [string, string]> = {
  good: ["\u2713", "good"], note: ["i", "note"], warn: ["!", "warning"], bad: ["\u00d7", "problem"],
};
export function noteList(notes: Note[], more?: (note: Note, i: number) => Child): HTMLElement {
  return h("ul", { class: "notes" }, notes.map((note, i) => {
    const [sign, word] = kSigns[note.level] ?? kSigns.note;
    return h("li", { class: kSigns[note.level] ? note.level : "note" }, h("span", { class: "sign", role: "img", "aria-label": word }, sign), h("span", {}, prose(note.text), " ", more?.(note, i)));
  }));
}

export const kNovel = "\u25c6";
export function novel(title = "not seen in training"): HTMLElement {
  return h("span", { class: "novel", role: "img", "aria-label": title, title }, kNovel);
}
export const kConfounded = "\u2020";

// More of the same behind one button.
export function details(summary: string, ...children: Child[]): HTMLElement {
  return h("details", {}, h("summary", {}, summary), children);
}

// Whether any of the policies has a valid episode of this task.
export function wasRun(data: Data, policies: number[], task: number): boolean {
  return Object.values(data.tables.by_task ?? {}).some((rates) => policies.some((p) => (rates[p]?.[task]?.[1] ?? 0) > 0));
}

// Names of truths that panels look for; -1 where the plans have none of that name.
export function metricsNamed(data: Data, names: string[]): number[] {
  return names.map((name) => data.metrics.findIndex((m) => m.name === name)).filter((m) => m >= 0);
}
// The truths to choose among, success first.
export function mainMetrics(data: Data): number[] {
  const first = metricsNamed(data, ["success", "intention", "grasp"]);
  return first.length ? first : data.metrics.flatMap((m, i) => (m.truth ? [i] : [])).slice(0, 3);
}
