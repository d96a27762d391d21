// Lists for whoever checks the numbers: confounded comparisons, invalid episodes, proof of delivery, runs and fingerprints.
import { h, replace, simpleTable } from "../dom";
import { count, plural } from "../format";
import { taskName } from "../model";
import { details, kConfounded, noteList, nothing, type Panel, panel, policyLabel } from "../parts";
import type { State } from "../state";

export function confounded(state: State): Panel {
  const { data } = state;
  const rows = data.tables.confounded ?? [];
  return panel("confounded", "Confounded comparisons", "Variants that differ from their baseline in more than one thing. Their difference is real, but not the effect of one change; everywhere on this page they carry a " + kConfounded + ".",
    rows.length ? simpleTable("Comparisons that move more than one thing", ["Variant", "Baseline", "What moved", "Why the suite allows it"],
      rows.map((r) => [h("a", { href: `#task-${r.task}` }, taskName(data, r.task)), taskName(data, r.baseline), r.axes.join(", "), r.reason])) : nothing(data, "confounded", "Every comparison here moves one thing."));
}

export function invalid(state: State): Panel {
  const { data } = state;
  const { episodes } = data;
  const rows: number[] = [];
  for (let i = 0; i < episodes.count; ++i) if (episodes.reason[i]! >= 0) rows.push(i);
  const kShown = 200;
  const holder = h("div", {});
  let all = false;
  const draw = (): void => {
    if (!rows.length) return replace(holder, nothing(data, "invalid", episodes.count ? `All ${count(episodes.count)} episodes are valid.` : "No episode was run."));
    const shown = all ? rows : rows.slice(0, kShown);
    const byPolicy = data.policies.map((_, p) => [p, rows.filter((i) => episodes.policy[i] === p).length] as const).filter(([, n]) => n > 0);
    replace(holder, h("p", { class: "summary" }, `${plural(rows.length, "episode")} of ${count(episodes.count)}: `, byPolicy.map(([p, n], i) => [i ? ", " : "", policyLabel(state, p), ` ${count(n)}`])),
      simpleTable("Invalid episodes", ["Task", "Policy", "Start", "Seed", "Steps", "Reason"],
        shown.map((i) => [h("a", { href: `#episode-${i}` }, taskName(data, episodes.task[i])), policyLabel(state, episodes.policy[i]!), String(episodes.start[i]), String(episodes.seed[i]), String(episodes.steps[i]), data.reasons[episodes.reason[i]!] ?? ""])),
      shown.length < rows.length ? h("button", { type: "button", click: () => { all = true; draw(); } }, `Show all ${count(rows.length)}`) : null);
  };
  state.watch(draw);
  return panel("invalid", "Invalid episodes", "Episodes that ended by a failure of the policy server, the network or the world, and those that a scripted policy did not attempt because it has no skill for them. They count neither as success nor as failure.", holder);
}

export function delivery(state: State): Panel {
  const { data } = state;
  const notes = data.tables.delivery ?? [];
  return panel("delivery", "What reached the policy", "Whether the instruction and the pictures that each policy got are those the plan describes, by their hashes.",
    notes.length ? noteList(notes, (note) => {
      const { policy, task } = note as { policy?: number | null; task?: number | null };
      return [typeof policy === "number" && policy >= 0 && !note.text.includes(data.policies[policy]?.label ?? "") ? h("span", { class: "sub" }, " ", policyLabel(state, policy)) : null, typeof task === "number" && task >= 0 ? h("span", { class: "sub" }, ` ${taskName(data, task)}`) : null];
    }) : nothing(data, "delivery", "Nothing was checked."));
}

export function runs(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  state.watch(() => replace(holder,
    data.notes.some((note) => note.level === "note") ? noteList(data.notes.filter((note) => note.level === "note")) : null,
    data.fingerprint_differences?.length ? details("What differs between the fingerprints", h("ul", { class: "differences" }, data.fingerprint_differences.map((text) => h("li", {}, text)))) : null,
    data.policies.length ? simpleTable("Runs", ["Policy", "Folder", "Plan", "Suite", "Seeds", "Episodes", "Invalid", "Videos", "Fingerprint"],
      data.policies.flatMap((policy, p) => policy.runs.map((run) => [policyLabel(state, p), h("code", {}, run.dir), h("code", { title: data.plans[run.plan]?.root ?? "" }, (data.plans[run.plan]?.root ?? "").slice(0, 12)),
        data.plans[run.plan]?.suite ?? "", run.seeds.join(", "), run.done === run.expected ? count(run.done) : `${count(run.done)} of ${count(run.expected)}`, run.not_attempted ? `${count(run.invalid)}; ${count(run.not_attempted)} not attempted` : count(run.invalid), run.videos ? count(run.videos) : "none", `no. ${run.fingerprint + 1}`]))) : nothing(data, "runs", "No run was given."),
    data.plans.map((plan) => h("dl", { class: "facts" }, h("dt", {}, "Plan"), h("dd", {}, h("code", { class: "long" }, plan.root)), h("dt", {}, "Suite"), h("dd", {}, `${plan.suite}: ${plural(plan.tasks, "task")}, ${plural(plan.starts, "start")}${plan.trained_on ? `, trained on ${plan.trained_on}` : ""}`))),
    data.fingerprints.map((entries, i) => details(`Fingerprint no. ${i + 1}: ${entries.length} entries`, simpleTable(`Fingerprint no. ${i + 1}`, ["What", "Which"], entries.map(([name, value]) => [name, h("code", { class: "long" }, value)])))),
    data.command ? h("dl", { class: "facts" }, h("dt", {}, "This page"), h("dd", {}, h("code", { class: "long" }, data.command), data.program ? ` with ${data.program}` : "")) : null));
  return panel("runs", "Runs and fingerprints", "Equal plans, assets and fingerprints give equal bits; what differs stands here.", holder);
}
