// What the tasks say: each instruction with its words coloured by what they mean, the axes that a variant moves, how many starts.
import { type Child, h, replace } from "../../../report/page/src/dom";

export interface Task {
  is_own: boolean; name: string; prompt: string; baseline: string | null; axes: string[]; starts: number; horizon: number; hz: number;
  words: { words: string; object: string; role: string }[];
  metrics: { name: string; truth: boolean }[];
}
export interface Summary { tasks: Task[]; episodes: number; suites: { name: string; tasks: number; episodes: number }[] }

export const roleClass = (role: string): string => (role === "source" || role === "target" ? `role-${role}` : role === "distractor" || role === "" ? "role-other" : "role-named");

// The longest words first, so that "the red can" is not cut by "can"; each place once.
export function coloured(task: Task): Child[] {
  const marks: { begin: number; end: number; object: string; role: string }[] = [];
  for (const { words, object, role } of [...task.words].sort((a, b) => b.words.length - a.words.length)) {
    if (!words) continue;
    for (let at = task.prompt.indexOf(words); at >= 0; at = task.prompt.indexOf(words, at + 1)) {
      const end = at + words.length;
      if (marks.some((m) => at < m.end && m.begin < end)) continue;
      marks.push({ begin: at, end, object, role });
      break;
    }
  }
  marks.sort((a, b) => a.begin - b.begin);
  const out: Child[] = [];
  let at = 0;
  for (const mark of marks) {
    out.push(task.prompt.slice(at, mark.begin), h("mark", { class: roleClass(mark.role), title: `${mark.role || "an object"}: ${mark.object}`, "data-object": mark.object }, task.prompt.slice(mark.begin, mark.end)));
    at = mark.end;
  }
  out.push(task.prompt.slice(at));
  return out;
}

const kMost = 200;

export class Tasks {
  private summary: Summary = { tasks: [], episodes: 0, suites: [] };
  private filter = "";
  readonly list = h("div", { class: "tasks", role: "listbox", "aria-label": "Tasks and their variants", tabindex: 0 });
  readonly find = h("input", { type: "search", placeholder: "find a task", "aria-label": "Find a task", input: () => { this.filter = this.find.value; this.draw(); } });
  readonly counts = h("span", { class: "counts" });
  chosen = "";
  constructor(private readonly choose: (task: string) => void) {
    this.list.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      this.step(step);
    });
  }
  get task(): Task | undefined { return this.summary.tasks.find((task) => task.name === this.chosen); }
  has(name: string): boolean { return this.summary.tasks.some((task) => task.name === name); }
  step(by: number): void {
    const shown = this.shown();
    const next = shown[shown.findIndex((task) => task.name === this.chosen) + by];
    if (next) this.choose(next.name);
  }
  set(summary: Summary, chosen: string): void {
    this.summary = summary;
    this.chosen = chosen;
    const n = (count: number, what: string): string => `${count.toLocaleString("en")} ${what}${count === 1 ? "" : "s"}`;
    this.counts.textContent = `${n(summary.tasks.length, "task")}, ${n(summary.tasks.reduce((sum, t) => sum + t.starts, 0), "start")}${summary.suites.map((s) => `; suite ${s.name}: ${n(s.tasks, "task")}, ${n(s.episodes, "episode")}`).join("")}`;
    this.draw();
  }
  mark(chosen: string): void {
    this.chosen = chosen;
    this.draw();
  }
  // A baseline and behind it its variants.
  private shown(): Task[] {
    const wanted = this.filter.toLowerCase();
    // The text's own first; those that it uses behind them.
    const tasks = [...this.summary.tasks.filter((task) => task.is_own), ...this.summary.tasks.filter((task) => !task.is_own)];
    const all = tasks.filter((task) => !wanted || task.name.toLowerCase().includes(wanted) || task.prompt.toLowerCase().includes(wanted));
    const behind = new Map<string, Task[]>();
    for (const task of all) if (task.baseline) behind.set(task.baseline, [...(behind.get(task.baseline) ?? []), task]);
    const names = new Set(all.map((task) => task.name));
    const out: Task[] = [];
    const add = (task: Task): void => { out.push(task); for (const variant of behind.get(task.name) ?? []) add(variant); };
    for (const task of all) if (!task.baseline || !names.has(task.baseline)) add(task);
    return out;
  }
  private draw(): void {
    const shown = this.shown();
    const names = new Set(shown.map((task) => task.name));
    replace(this.list, shown.slice(0, kMost).map((task) => h("div", { class: `task${task.baseline && names.has(task.baseline) ? " variant" : ""}`, role: "option", id: `task-${task.name}`, "aria-selected": String(task.name === this.chosen), click: () => this.choose(task.name) },
      h("div", { class: "instruction" }, coloured(task)),
      h("div", { class: "about" }, h("code", {}, task.name), ` ${task.starts} start${task.starts === 1 ? "" : "s"}`, task.baseline ? [" ", task.axes.length ? task.axes.map((axis) => [h("span", { class: "axis" }, axis), " "]) : h("span", { class: "axis none" }, "moves nothing")] : ""))),
      shown.length > kMost && h("p", { class: "note" }, `and ${shown.length - kMost} more; find them by name`));
    const now = this.list.querySelector("[aria-selected=true]");
    this.list.setAttribute("aria-activedescendant", now?.id ?? "");
    now?.scrollIntoView({ block: "nearest" });
  }
}
