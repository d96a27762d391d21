// One episode: where things stood, what was said, what happened when, and why it was judged so.
import { type Child, h, s } from "../dom";
import { safeLink, shellWord } from "../format";
import { bodiesOf, type Data, isTrue, objectName, readTimelines, readWhys, taskName, type TimelineJoint, type WhyMetric } from "../model";
import { policyLabel } from "../parts";
import type { State } from "../state";

type Spans = [first: number, last: number][];
interface Timeline { metrics: [number, Spans][]; contacts: [number, number, Spans][]; gripper: Spans; distance: number[]; joints: [number, number[]][]; events: [number, [step: number, bodies: number[]][]][] }

const spansOf = (text: string): Spans => text.split(",").filter(Boolean).map((part) => { const [a, b] = part.split("-").map(Number); return [a!, b ?? a!]; });

function decode(text: string): Timeline {
  const timeline: Timeline = { metrics: [], contacts: [], gripper: [], distance: [], joints: [], events: [] };
  for (const record of text.split(";")) {
    const colon = record.indexOf(":"), key = record.slice(0, colon), rest = record.slice(colon + 1);
    if (key[0] === "m") timeline.metrics.push([Number(key.slice(1)), spansOf(rest)]);
    else if (key[0] === "c") { const [a, b] = key.slice(1).split(".").map(Number); timeline.contacts.push([a!, b!, spansOf(rest)]); }
    else if (key === "g") timeline.gripper = spansOf(rest);
    else if (key === "d") timeline.distance = rest.split(",").map(Number);
    else if (key[0] === "e") timeline.events.push([Number(key.slice(1)), rest.split(",").map((mark) => { const [step, ...of] = mark.split(".").map(Number); return [step!, of]; })]);
    else if (key[0] === "j") timeline.joints.push([Number(key.slice(1)), rest.split(",").map(Number)]);
  }
  return timeline;
}

const kLeft = 190, kWide = 620, kLine = 20, kCurve = 64;

interface Curve { name: string; low: number; high: number; values: number[] }

// The distance, and joints of fixtures: each over its own range, a joint without end over what it went.
function curvesOf(timeline: Timeline, joints: TimelineJoint[]): Curve[] {
  const curves: Curve[] = [];
  if (timeline.distance.length > 1) curves.push({ name: "source to target, cm", low: 0, high: Math.max(5, ...timeline.distance), values: timeline.distance });
  for (const [number, values] of timeline.joints) {
    const joint = joints[number];
    if (!joint || values.length < 2) continue;
    const [name, unit, lower, upper] = joint, endless = lower === upper;
    curves.push({ name: `${name}, ${unit}`, low: endless ? Math.min(...values) : lower, high: endless ? Math.max(...values) : upper, values });
  }
  return curves;
}

interface Marks { name: string; subgoal: boolean; at: { step: number; of: string }[] }

// Events in the order of the library, each with its steps and whose it is.
function marksOf(timeline: Timeline, events: [string, number][], bodies: string[]): Marks[] {
  return timeline.events.flatMap(([number, marks]) => {
    const event = events[number];
    return event ? [{ name: event[0], subgoal: !!event[1], at: marks.map(([step, of]) => ({ step, of: of.map((b) => bodies[b] ?? "?").join(", ") })) }] : [];
  });
}

// Lines of marks and spans over control steps, curves below, and a cursor that set() moves.
function drawing(data: Data, timeline: Timeline, events: [string, number][], bodies: string[], joints: TimelineJoint[], steps: number, every: number): { element: SVGElement; set: (step: number) => void } {
  const x = (step: number) => kLeft + (kWide * step) / Math.max(steps, 1);
  const lines: [string, string, Spans][] = [
    ...timeline.metrics.map(([m, spans]): [string, string, Spans] => [data.metrics[m]?.label ?? "", data.metrics[m]?.name === "wrong" ? "bad" : "metric", spans]),
    ...(timeline.gripper.length ? [["gripper closing", "gripper", timeline.gripper] as [string, string, Spans]] : []),
    ...timeline.contacts.map(([a, b, spans]): [string, string, Spans] => [`${bodies[a] || "?"} \u2013 ${bodies[b] || "?"}`, "contact", spans]),
  ];
  const curves = curvesOf(timeline, joints), marks = marksOf(timeline, events, bodies);
  const head = 4, top = head + marks.length * kLine + (marks.length ? 6 : 0), bottom = top + lines.length * kLine, height = bottom + curves.length * kCurve + 24;
  const cursor = s("line", { class: "cursor", y1: head, y2: height - 20, x1: kLeft, x2: kLeft });
  const ticks: number[] = [];
  const stride = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((d) => steps / d <= 8) ?? 1000;
  for (let step = 0; step <= steps; step += stride) ticks.push(step);
  const said = marks.map(({ name, at }) => `${name}: ${at.map(({ step, of }) => `step ${step}${of ? ` (${of})` : ""}`).join(", ")}; `).join("");
  const words = said + lines.map(([name, , spans]) => `${name}: steps ${spans.map(([a, b]) => `${a} to ${b}`).join(", ")}`).join("; ");
  const element = s("svg", { class: "timeline", viewBox: `0 0 ${kLeft + kWide + 20} ${height}`, role: "img", "aria-label": `Timeline of ${steps} control steps. ${words}` },
    ticks.map((step) => [s("line", { class: "tick", x1: x(step), x2: x(step), y1: head, y2: height - 20 }), s("text", { class: "axis", x: x(step), y: height - 6, "text-anchor": "middle" }, String(step))]),
    marks.map(({ name, subgoal, at }, i) => {
      const y = head + i * kLine + kLine / 2;
      const middle = (mark: { step: number }) => x(mark.step - 0.5);
      return [s("text", { class: "line", x: kLeft - 10, y: y + 4, "text-anchor": "end" }, name),
        at.map((mark, k) => {
          // Words stand behind their mark, before it at the right edge, and nowhere if they met another mark.
          const { step, of } = mark, cx = middle(mark), wide = 16 + 6.5 * of.length, toLeft = cx + wide > kLeft + kWide;
          const before = at[k - 1], after = at[k + 1];
          const fits = toLeft ? !before || middle(before) + 8 < cx - wide : !after || middle(after) - 8 > cx + wide;
          return s("g", { class: subgoal ? "subgoal" : "event" }, s("title", {}, `${name}, step ${step}${of ? `: ${of}` : ""}`),
            subgoal ? s("path", { d: `M${cx} ${y - 6}L${cx + 6} ${y}L${cx} ${y + 6}L${cx - 6} ${y}Z` }) : s("circle", { cx, cy: y, r: 5 }),
            fits ? s("text", { class: "axis", x: toLeft ? cx - 9 : cx + 9, y: y + 4, "text-anchor": toLeft ? "end" : "start" }, of) : null);
        })];
    }),
    lines.map(([name, kind, spans], i) => [
      s("text", { class: "line", x: kLeft - 10, y: top + i * kLine + 14, "text-anchor": "end" }, name.length > 26 ? name.slice(0, 25) + "\u2026" : name),
      spans.map(([a, b]) => s("rect", { class: kind, x: x(a - 1), width: Math.max(2, x(b) - x(a - 1)), y: top + i * kLine + 4, height: kLine - 8, rx: 2 }))]),
    curves.map(({ name, low, high, values }, k) => {
      const from = bottom + k * kCurve;
      return [s("text", { class: "line", x: kLeft - 10, y: from + 34, "text-anchor": "end" }, name), s("text", { class: "axis", x: kLeft - 10, y: from + 50, "text-anchor": "end" }, `${low.toFixed(0)} to ${high.toFixed(0)}`),
        s("polyline", { class: "curve", points: values.map((v, i) => `${x(Math.min(steps, i * every)).toFixed(1)},${(from + 58 - (50 * (v - low)) / Math.max(high - low, 1e-9)).toFixed(1)}`).join(" ") })];
    }), cursor);
  return { element, set: (step) => { cursor.setAttribute("x1", String(x(step))); cursor.setAttribute("x2", String(x(step))); } };
}

// The start from above as `vlaprobe draw` shows it: x of the world to the right, y upwards. Dots are the places of all starts.
function topView(data: Data, task: number, start: number): Child {
  const t = data.tasks[task]!;
  const places = t.starts?.[start];
  if (!places?.length) return null;
  const bodies = bodiesOf(t), objects = bodies.map((body) => body.object);
  const all = t.starts!.flat();
  const low = [0, 1].map((i) => Math.min(...all.map((p) => p[i]!))), high = [0, 1].map((i) => Math.max(...all.map((p) => p[i]!)));
  const half = Math.max(0.1, ...[0, 1].map((i) => (high[i]! - low[i]!) / 2)) * 1.45;
  const at = (p: number[]): [number, number] => [110 + (105 * (p[0]! - (low[0]! + high[0]!) / 2)) / half, 110 - (105 * (p[1]! - (low[1]! + high[1]!) / 2)) / half];
  return h("figure", { class: "top" }, h("figcaption", {}, `Start ${start} from above`),
    s("svg", { viewBox: "0 0 220 220", role: "img", "aria-label": `Start ${start}: ` + places.map((p, i) => `${objectName(data, objects[i] ?? -1)} at x ${(100 * p[0]!).toFixed(0)} cm, y ${(100 * p[1]!).toFixed(0)} cm`).join("; ") },
      s("rect", { class: "table", x: 1, y: 1, width: 218, height: 218, rx: 6 }),
      s("text", { class: "axes", x: 8, y: 211 }, "x \u2192  y \u2191"),
      [...new Set(all.map((p) => at(p).map((v) => v.toFixed(1)).join(" ")))].map((key) => { const [cx, cy] = key.split(" "); return s("circle", { class: "place", cx, cy, r: 1.6 }); }),
      places.map((p, i) => {
        const [x, y] = at(p), turn = ((p[2] ?? 0) * Math.PI) / 180, name = objectName(data, objects[i] ?? -1);
        return s("g", { class: bodies[i]?.role ?? "distractor" }, s("circle", { cx: x, cy: y, r: bodies[i]?.role === "target" ? 15 : 10 }),
          s("line", { x1: x, y1: y, x2: x + 19 * Math.cos(turn), y2: y - 19 * Math.sin(turn) }),
          s("text", { x: Math.min(190, Math.max(30, x)), y: y + 28, "text-anchor": "middle" }, name.length > 18 ? name.slice(0, 17) + "\u2026" : name));
      })));
}

function whyView(list: WhyMetric[], strings: string[]): Child {
  const text = (i: number) => strings[i] ?? "";
  return list.map(([name, shown, when, file, line, conditions]) => h("div", { class: "why" },
    h("p", {}, h("b", {}, name), " = ", shown, ", ", when, file >= 0 ? h("span", { class: "sub" }, ` ${text(file)}${line > 0 ? `:${line}` : ""}`) : null),
    conditions.length ? h("table", { class: "plain compact" }, h("caption", { class: "unseen" }, `Conditions of ${name}`),
      h("thead", {}, h("tr", {}, ["Line", "Condition", "Of", "Measured", "", "Decides"].map((c) => h("th", { scope: "col" }, c)))),
      h("tbody", {}, conditions.map(([at, what, bodies, measured, truth, decides, alike]) => h("tr", { class: decides ? "decides" : "idle" }, h("td", { class: "number" }, at > 0 ? String(at) : ""), h("th", { scope: "row" }, h("code", {}, text(what)), alike > 0 ? h("span", { class: "sub" }, `and ${alike} alike`) : null),
        h("td", {}, text(bodies)), h("td", {}, text(measured)), h("td", {}, truth < 0 ? "" : truth ? "true" : "false"), h("td", {}, decides ? "yes" : ""))))) : null));
}

// A command to copy; dragging over it takes all of it.
// In which step a sentence behind the first was said, of an episode that is known so well.
const saidWhen = (told: number[] | undefined, k: number): string => (told === undefined ? "later, once its condition held: " : k < told.length ? `from step ${told[k]} on: ` : "never said, as its condition never held: ");

function command(text: string): HTMLElement {
  const code = h("code", { class: "long command", tabindex: 0 }, text);
  const button = h("button", { type: "button", click: () => {
    const done = () => { button.textContent = "Copied"; setTimeout(() => { button.textContent = "Copy"; }, 1500); };
    const choose = () => { getSelection()?.selectAllChildren(code); };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, choose);
    else choose();
  } }, "Copy");
  return h("div", { class: "copy" }, code, button);
}

export function episodeView(state: State, row: number): Child {
  const { data } = state;
  const e = data.episodes;
  const [p, t, start, seed, steps] = [e.policy[row]!, e.task[row]!, e.start[row]!, e.seed[row]!, e.steps[row]!];
  const task = data.tasks[t]!;
  const run = data.policies[p]!.runs.find((r) => r.seeds.includes(seed) && r.plan === task.plan) ?? data.policies[p]!.runs[0];
  const bad = e.reason[row]! >= 0;
  const truths = task.metrics.filter((m) => data.metrics[m]?.truth);
  const holds = (m: number) => isTrue(e, row, m);

  const timelines = readTimelines(), encoded = timelines.e?.[row];
  const timeline = encoded ? drawing(data, decode(encoded), timelines.events ?? [], timelines.bodies?.[t] ?? [], timelines.joints?.[t] ?? [], steps, timelines.every ?? 1) : null;
  const link = safeLink(data.strings[e.video?.[row] ?? -1] ?? "");
  const video = link ? h("video", { src: link, controls: true, preload: "metadata", playsinline: true, muted: true, "aria-label": `Video of ${task.name}, start ${start}` }) : null;
  // A video has a frame before the first step and one after each.
  const shown = h("output", {}, `step 0 of ${steps}`);
  const slider = h("input", { type: "range", min: 0, max: steps, value: 0, step: 1, id: "scrub", "aria-label": "Control step", input: () => { move(Number(slider.value)); if (video?.duration) video.currentTime = ((Number(slider.value) + 0.5) / (steps + 1)) * video.duration; } });
  const move = (step: number): void => {
    slider.value = String(step);
    slider.setAttribute("aria-valuetext", `step ${step} of ${steps}`);
    shown.textContent = `step ${step} of ${steps}${task.hz ? `, ${(step / task.hz).toFixed(1)} s` : ""}`;
    timeline?.set(step);
  };
  video?.addEventListener("timeupdate", () => { if (!video.paused && video.duration) move(Math.min(steps, Math.floor((video.currentTime / video.duration) * (steps + 1)))); });
  video?.addEventListener("error", () => { video.replaceWith(h("p", { class: "nothing" }, "The video is not where this page expects it: ", h("code", {}, data.strings[e.video![row]!] ?? ""), ". Keep the page and the results folder together.")); });

  const args = [shellWord(run?.dir ?? "DIR"), shellWord(task.name), start, seed].join(" ");
  const numbers = Object.entries(e.numbers ?? {}).flatMap(([name, values]) => (typeof values[row] === "number" ? [`${data.metrics.find((m) => m.name === name)?.label ?? name} ${Number(values[row]!.toPrecision(5))}`] : []));
  const remark = data.strings[e.remark?.[row] ?? e.remarks?.[String(row)] ?? -1];
  const why = readWhys().e?.[String(row)];
  const told = e.told?.[String(row)];
  const prompt = data.prompts[e.prompt[row] ?? -1];
  return [
    h("h3", { tabindex: -1 }, policyLabel(state, p), ` at start ${start} of ${taskName(data, t)}, seed ${seed}`),
    bad ? h("p", { class: "bad" }, ...(data.reasons[e.reason[row]!]?.startsWith("not attempted") ? [] : [h("b", {}, "Invalid: ")]), data.reasons[e.reason[row]!] ?? "") : h("ul", { class: "verdicts", "aria-label": "Verdicts" }, truths.map((m) => h("li", { class: holds(m) ? "yes" : "no" }, h("span", { "aria-hidden": "true" }, holds(m) ? "\u2713" : "\u2013"), data.metrics[m]!.label, h("span", { class: "unseen" }, holds(m) ? ": yes" : ": no")))),
    remark ? h("p", { class: "key" }, h("b", {}, "The policy says: "), remark) : null,
    numbers.length ? h("p", { class: "key" }, numbers.join("; ")) : null,
    h("div", { class: "said" }, h("span", { class: "sub" }, "Instruction as sent"), prompt === undefined ? h("p", { class: "nothing" }, "What was sent is not the plan's instruction, and its text was not kept.") : h("q", { class: "prompt" }, prompt), ...(task.then ?? []).map((words, k) => h("p", { class: "later" }, saidWhen(told, k), h("q", { class: "prompt" }, words)))),
    h("div", { class: "scene" }, topView(data, t, start), h("div", { class: "video" }, video ?? h("p", { class: "nothing" }, "No video was recorded. The episode can be had again, bit for bit:", command(`vlaprobe replay ${args} --video ${shellWord(`${task.name.replace(/[^\w.-]+/g, "_")}-${start}-${seed}.mp4`)}`)))),
    h("div", { class: "scrub" }, h("label", { for: "scrub" }, "Control step"), slider, shown),
    timeline?.element ?? h("p", { class: "nothing" }, bad ? "It ended before anything was kept." : "No timeline was kept for this episode."),
    h("h4", {}, "Why"), why ? whyView(why, readWhys().strings ?? []) : null, command(`vlaprobe why ${args}`),
  ];
}
