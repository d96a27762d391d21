// The documents that stand in the page, as PAGE_DATA.md describes them. What is missing is empty; nothing here computes a
// statistic.

// rate: where it is not k / n, because unlike shares of tasks were run.
export type Estimate = [k: number, n: number, low: number, high: number, rate?: number] | null;
export type Level = "good" | "note" | "warn" | "bad";
export interface Note { level: Level; text: string; see?: string }
export interface Metric { name: string; label: string; truth: boolean; good: number }
export interface Category { name: string; label: string; tasks: number[] }
export interface Thing { name: string; label?: string; seen?: { source?: boolean | null; target?: boolean | null } | null }
export interface Run {
  dir: string; plan: number; fingerprint: number; seeds: number[];
  done: number; expected: number; invalid: number; videos: number; not_attempted?: number;
}
export interface Policy { name: string; label: string; role: string; runs: Run[] }
export interface Task {
  plan: number; name: string; baseline: number | null; axes: string[]; categories: number[]; prompt: string; then?: string[];
  source: number; target: number; roles?: { name: string; objects: number[] }[]; distractors: number[]; ood: string[]; horizon: number; hz: number; scene?: string;
  metrics: number[]; confounded?: string | null; unpaired?: string; allowed?: { word: string; reason: string }[];
  starts?: number[][][]; rule?: { file: string; line: number; text: string };
}
export type Column = ArrayLike<number>;
export interface Episodes {
  count: number; policy: Column; task: Column; start: Column; seed: Column; bits: Column; more_bits?: Column[]; steps: Column;
  reason: Column; prompt: Column; video?: Column; remark?: Column; remarks?: Record<string, number>; told?: Record<string, number[]>; numbers?: Record<string, (number | null)[]>;
}
// All that a task says, in one line.
export function instruction(task: Task): string {
  return [task.prompt, ...(task.then ?? [])].join("; then: ");
}
// A number holds 52 of an episode's truths exactly.
export function isTrue(e: Episodes, row: number, m: number): boolean {
  const column = m < 52 ? e.bits : e.more_bits?.[Math.floor(m / 52) - 1];
  return Math.floor((column?.[row] ?? 0) / 2 ** (m % 52)) % 2 === 1;
}
export interface MainRow { policy: number; metric: number; all: Estimate; cells: Estimate[] }
export interface ExternalRow {
  policy: string; metric: string; all: number | null; cells: (number | null)[]; n?: (number | null)[]; flags?: (string | null)[];
}
// The answer to one of the two questions of a difference: whether it is one on these starts, and for starts never tried.
// `units` are starts or places, `more` places that are missing for an answer.
export interface Answer { units: number; low: number; high: number; p: number; p_adjusted?: number; real?: boolean; detectable?: number; more?: number }
export interface Difference { diff: number; low: number; high: number; on_these_starts: Answer; for_starts_never_tried: Answer }
// `first` minus `second`, counts of both; `pairs` is null where starts do not correspond.
export interface Contrast extends Difference { first: [k: number, n: number]; second: [k: number, n: number]; pairs: number[] | null; starts: number }
export interface Delta extends Contrast { policy: number; task: number; baseline: number; metric: number; floor?: boolean }
export interface CategoryDelta extends Contrast { policy: number; category: number; metric: number; left_out?: number }
export interface PairCell { policy: number; source: number; target: number; metric: number; e: Estimate; ood: string[] }
export interface ObjectCell { policy: number; object: number; role: "source" | "target"; metric: number; e: Estimate; ood: boolean }
export interface Gap extends Difference { policy: number; category: number; intention: Estimate; success: Estimate }
export interface Floor { task: number; metric: number; floor: Estimate; ceiling: Estimate; note?: string }
export interface Comparison extends Difference {
  a: number; b: number; metric: number; scope: string; starts: number;
}
export interface ArmScore {
  circular: Estimate; plain: Estimate; likely_circular?: Estimate; likely_plain?: Estimate; rows: number; unclear: number; refused: number; empty: number;
  invalid: number; incomplete: number; copied?: number; copies?: number;
}
export interface Model { name: string; label: string; plan: number; answers: number; invalid: number; left_out: number; families: { name: string; form: string; moment: string; text: string }[] }
export interface Accuracy { model: number; family: number; category: number; picture?: ArmScore; blind?: ArmScore; prior?: ArmScore; random?: number; first?: number }
export interface Knows extends Difference { model: number; policy: number; family: number; category: number; counts: number[]; says: string; starts: number }
export interface Looked { units: number; used: number; a_wins: number; b_wins: number; p: number; stopped: boolean }
export interface Sequential { a: number; b: number; metric: number; on_these_starts: Looked; for_starts_never_tried: Looked }
export interface Ranking { policy: number; metric: number; score: number; low?: number | null; high?: number | null }
export interface MixedTerm { term: string; kind: string; odds: number | null; low: number | null; high: number | null; p: number | null; note?: string }
export interface Mixed { metric: number; model?: string; rows: MixedTerm[]; random?: { factor: string; sd: number }[]; n?: number; note?: string }
// Events and subgoals as truths of episodes; `metric` of its rows is an index into `names`.
export interface EventTables {
  names: { name: string; label: string; subgoal: boolean }[];
  main: MainRow[]; by_task: Record<string, Estimate[][]>; deltas: Delta[];
  numbers: { name: string; label: string; unit: string; rows: [policy: number, task: number, mean: number, low: number, high: number, n: number][] }[];
}
export interface Tables {
  events?: EventTables;
  main?: { rows: MainRow[]; all_label?: string };
  external?: { source: string; rows: ExternalRow[] }[];
  by_task?: Record<string, Estimate[][]>;
  deltas?: Delta[]; category_deltas?: CategoryDelta[];
  language?: CategoryDelta[];
  pairs?: PairCell[]; objects?: ObjectCell[]; gap?: Gap[]; floors?: Floor[];
  compare?: Comparison[]; sequential?: Sequential[]; ranking?: Ranking[]; mixed?: Mixed[];
  delivery?: (Note & { policy?: number | null; task?: number | null })[];
  accuracy?: Accuracy[]; knows?: Knows[];
  confounded?: { task: number; baseline: number; axes: string[]; reason: string }[];
}
export interface Data {
  format: string; version: number; title: string; command?: string; program?: string; confidence?: number; interval?: string;
  run: string[]; findings: Note[]; notes: Note[]; metrics: Metric[]; categories: Category[]; objects: Thing[];
  plans: { root: string; suite: string; tasks: number; starts: number; trained_on?: string }[];
  fingerprints: [string, string][][]; fingerprint_differences?: string[];
  prompts: string[]; reasons: string[]; strings: string[];
  models?: Model[]; policies: Policy[]; tasks: Task[]; episodes: Episodes; tables: Tables; empty?: Record<string, string>;
}
export type TimelineJoint = [name: string, unit: string, lower: number, upper: number];
export interface Timelines { every?: number; bodies?: string[][]; joints?: TimelineJoint[][]; events?: [label: string, subgoal: number][]; e?: (string | 0)[] }
export type WhyCondition = [line: number, text: number, bodies: number, measured: number, truth: number, decides: number, alike: number];
export type WhyMetric = [name: string, shown: string, when: string, file: number, line: number, conditions: WhyCondition[]];
export interface Whys { strings?: string[]; e?: Record<string, WhyMetric[]> }

function parsed(id: string): unknown {
  const text = document.getElementById(id)?.textContent;
  return text ? JSON.parse(text) : {};
}

type Packed = { runs: number[] } | { from: number; width: number; bytes: string };

// A column as it stands in a page of many episodes: PAGE_DATA.md.
function unpacked(column: Column | Packed, count: number): Column {
  if ("runs" in column) {
    const values = new Float64Array(count);
    for (let i = 0, at = 0; i < column.runs.length; i += 2) values.fill(column.runs[i]!, at, at += column.runs[i + 1]!);
    return values;
  }
  if (!("bytes" in column)) return column;
  const text = atob(column.bytes), values = new Float64Array(count);
  for (let i = 0; i < count; ++i) {
    let value = column.from;
    for (let k = 0; k < column.width; ++k) value += text.charCodeAt(i * column.width + k) * 256 ** k;
    values[i] = value;
  }
  return values;
}

function unpackEpisodes(e: Episodes): void {
  for (const name of ["policy", "task", "start", "seed", "bits", "steps", "reason", "prompt", "video", "remark"] as const) if (e[name]) e[name] = unpacked(e[name]!, e.count);
  if (e.more_bits) e.more_bits = e.more_bits.map((column) => unpacked(column, e.count));
}

const kNoEpisodes: Episodes = { count: 0, policy: [], task: [], start: [], seed: [], bits: [], steps: [], reason: [], prompt: [] };

// "pi0 and expert on intact", "6 policies on intact".
function ownTitle(data: Data): string {
  const names = data.policies.map((p) => p.label);
  const suites = [...new Set(data.plans.map((p) => p.suite))].join(" and ");
  if (!names.length) return "vlaprobe report";
  return (names.length <= 3 ? names.join(names.length === 2 ? " and " : ", ") : `${names.length} policies`) + (suites ? ` on ${suites}` : "");
}

// Fails with a sentence for the reader when the page holds no results, or results of another version.
export function readData(): Data {
  const data = parsed("data") as Partial<Data>;
  if (data.format !== "vlaprobe-report") throw new Error("this page holds no results");
  if (data.version !== 1) throw new Error(`these results have version ${data.version}; this page reads version 1`);
  const full: Data = {
    format: data.format, version: 1, title: "", run: [], findings: [], notes: [], metrics: [], categories: [],
    objects: [], plans: [], fingerprints: [], prompts: [], reasons: [], strings: [], policies: [], tasks: [], episodes: kNoEpisodes, tables: {},
  };
  for (const [key, value] of Object.entries(data)) if (value !== null) (full as unknown as Record<string, unknown>)[key] = value;
  full.title ||= ownTitle(full);
  unpackEpisodes(full.episodes);
  // Labels stand at the head of columns.
  const capital = (label: string): string => label.charAt(0).toUpperCase() + label.slice(1);
  for (const entry of [...full.metrics, ...full.categories]) entry.label = capital(entry.label);
  if (full.tables.main?.all_label) full.tables.main.all_label = capital(full.tables.main.all_label);
  return full;
}

let timelines: Timelines | undefined, whys: Whys | undefined;
export const readTimelines = (): Timelines => (timelines ??= parsed("timelines") as Timelines);
export const readWhys = (): Whys => (whys ??= parsed("whys") as Whys);

// Rows of every policy and task, in their order.
export class EpisodeIndex {
  private readonly rows = new Map<number, number[]>();
  constructor(private readonly data: Data) {
    const { count, policy, task } = data.episodes;
    for (let i = 0; i < count; ++i) {
      const key = policy[i]! * data.tasks.length + task[i]!;
      const list = this.rows.get(key);
      if (list) list.push(i);
      else this.rows.set(key, [i]);
    }
  }
  of(policy: number, task: number): number[] {
    return this.rows.get(policy * this.data.tasks.length + task) ?? [];
  }
}

export const metricIndex = (data: Data, name: string): number => data.metrics.findIndex((m) => m.name === name);
// The objects of a task's bodies in their order, each with the class of its role.
export function bodiesOf(t: Task): { object: number; role: string }[] {
  const of = (objects: number[], role: string) => objects.filter((object) => object >= 0).map((object) => ({ object, role }));
  const others = t.roles ?? [];
  return [...of([t.source], "source"), ...of([t.target], "target"), ...others.filter((r) => r.name).flatMap((r) => of(r.objects, "other")),
    ...of(t.distractors, "distractor"), ...others.filter((r) => !r.name).flatMap((r) => of(r.objects, "distractor"))];
}
export const objectName = (data: Data, object: number): string => data.objects[object]?.label ?? data.objects[object]?.name ?? "";
export const taskName = (data: Data, task: number | null | undefined): string => data.tasks[task ?? -1]?.name ?? "";
