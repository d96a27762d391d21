// What models know: how many questions they answer right, beside what is got without looking; and what they know of the starts
// on which policies go for the wrong object.
import { h, replace, scroller, select } from "../dom";
import { count, percent, points, spoken } from "../format";
import type { Accuracy, ArmScore, Data, Knows } from "../model";
import { details, differenceBar, isReal, kQuestionColumns, nothing, noteList, type Panel, panel, policyLabel, questionCells, questionHead, shortCell } from "../parts";
import type { State } from "../state";

const family = (data: Data, model: number, f: number) => data.models?.[model]?.families[f];
const label = (data: Data, model: number): string => data.models?.[model]?.label ?? "?";

// "3 unclear, 1 refused", of answers that say nothing that counts.
function unread(score: ArmScore | undefined): string {
  if (!score) return "\u2013";
  const parts = ([["unclear", score.unclear], ["refused", score.refused], ["empty", score.empty], ["invalid", score.invalid], ["not yet asked", score.incomplete]] as const)
    .filter(([, n]) => n > 0).map(([word, n]) => `${count(n)} ${word}`);
  return parts.join(", ") || "none";
}

// A question once, beneath it how each model answers it.
function accuracyTable(data: Data, rows: Accuracy[]): HTMLElement {
  const likely = rows.some((r) => r.picture?.likely_circular);
  const questions = new Map<string, Accuracy[]>();
  for (const r of rows) {
    const of = family(data, r.model, r.family), key = `${of?.name ?? "?"}\n${of?.text ?? ""}`;
    questions.set(key, [...(questions.get(key) ?? []), r]);
  }
  const head = ["Question", "Model", "Right in every order", "In one order", ...(likely ? ["By the likeliest letters"] : []), "Without the picture", "With another picture", "By chance", "Not read"];
  return scroller("Right answers", h("table", { class: "plain" }, h("caption", {}, "Questions and starts answered right, percent"),
    h("thead", {}, h("tr", {}, head.map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, [...questions.values()].flatMap((answered) => answered.map((r, i) => {
      const of = family(data, r.model, r.family);
      return h("tr", {},
        i ? null : h("td", { rowspan: String(answered.length) }, h("b", {}, of?.name ?? "?"), h("span", { class: "sub" }, of?.text ?? "")),
        h("th", { scope: "row" }, label(data, r.model)),
        h("td", { title: spoken(r.picture?.circular ?? null) }, shortCell(r.picture?.circular ?? null)), h("td", {}, shortCell(r.picture?.plain ?? null)),
        likely ? h("td", { title: spoken(r.picture?.likely_circular ?? null) }, shortCell(r.picture?.likely_circular ?? null)) : null,
        h("td", {}, shortCell(r.blind?.circular ?? null)), h("td", {}, shortCell(r.prior?.circular ?? null)),
        h("td", { class: "number" }, r.random === undefined ? "\u2013" : percent(r.random)),
        h("td", {}, unread(r.picture), r.picture?.copied === undefined ? null : h("small", {}, ` ${percent(r.picture.copied)} % of the instruction's words repeated, ${count(r.picture.copies ?? 0)} mere copies`)));
    })))));
}

// What rows say in words, each sentence once: with the questions it is said of, unless it is said of all of its policy's.
function sentences(data: Data, rows: Knows[]): HTMLElement {
  const said = new Map<string, Knows[]>();
  for (const r of rows) said.set(r.says, [...(said.get(r.says) ?? []), r]);
  return h("ul", {}, [...said].map(([says, of]) => {
    const all = of.length > 1 && rows.every((r) => r.policy !== of[0]!.policy || of.includes(r));
    const names = [...new Set(of.map((r) => family(data, r.model, r.family)?.name ?? "?"))];
    const counted = of.some((r) => r.counts.some((n) => n > 0));
    return h("li", {}, says.charAt(0).toUpperCase() + says.slice(1) + (all || !counted ? "." : ` (${names.join(", ")}).`));
  }));
}

// Episodes at 4 knows + 2 goes + does.
const cell = (row: Knows, ...at: number[]): HTMLElement => h("td", { class: "number" }, count(at.reduce((sum, i) => sum + row.counts[i]!, 0)));

function knowsTable(state: State, rows: Knows[]): HTMLElement {
  const { data } = state;
  const head = ["Model", "Policy", "Question", "Knows, goes, does", "Knows, goes, fails", "Knows, goes elsewhere", "Does not know, goes", "Neither"];
  return scroller("Knows, goes, does", h("table", { class: "plain" }, h("caption", {}, "Episodes, by whether the model names the right object, the policy goes for it and the task is done"),
    h("thead", {}, h("tr", {}, head.map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, rows.map((r) => h("tr", {}, h("th", { scope: "row" }, label(data, r.model)), h("td", {}, policyLabel(state, r.policy)), h("td", {}, family(data, r.model, r.family)?.name ?? "?"),
      cell(r, 7), cell(r, 6), cell(r, 4, 5), cell(r, 2, 3), cell(r, 0, 1))))));
}

function differenceTable(state: State, rows: Knows[]): HTMLElement {
  const { data } = state;
  return scroller("Knows less goes", h("table", { class: "plain questions" }, h("caption", {}, "Knowing less going, on the same starts, in points"),
    questionHead(["Model", "Policy", "Difference", "\u2212100 to +100"], kQuestionColumns, []),
    h("tbody", {}, rows.map((r) => h("tr", { class: isReal(r) ? "real" : null }, h("th", { scope: "row" }, label(data, r.model), h("span", { class: "sub" }, family(data, r.model, r.family)?.name ?? "?")), h("td", {}, policyLabel(state, r.policy)),
      h("td", { class: "number strong" }, points(r.diff) || "0"), h("td", { class: "bar" }, differenceBar(r)),
      questionCells(r.on_these_starts), questionCells(r.for_starts_never_tried))))));
}

export function knows(state: State): Panel {
  const { data } = state;
  const holder = h("div", {});
  const accuracy = data.tables.accuracy ?? [], all = data.tables.knows ?? [];
  const categories = [-1, ...new Set(accuracy.map((r) => r.category).filter((c) => c >= 0))];
  const nameOf = (r: Knows): string => family(data, r.model, r.family)?.name ?? "?";
  const questions = [...new Set(all.map(nameOf))];
  let category = -1, question = questions[0] ?? "";  // of the tables beside policies; "": all
  const draw = (): void => {
    if (!accuracy.length) return replace(holder, nothing(data, "knows", "No model was asked; `vlaprobe ask` asks one, and its folder is named beside those of runs."));
    const beside = all.filter((r) => r.category === category && state.chosen.includes(r.policy) && (!question || nameOf(r) === question));
    const wanting = (data.models ?? []).filter((m) => m.invalid > 0 || m.left_out > 0)
      .map((m) => ({ level: "note" as const, text: `${m.label}: ${count(m.answers)} answers, ${count(m.invalid)} invalid, ${count(m.left_out)} not asked because the picture does not show what they ask for` }));
    replace(holder,
      categories.length > 1 ? h("div", { class: "controls" }, select("Tasks", categories.map((c) => (c < 0 ? "all" : data.categories[c]?.label ?? "")), categories.indexOf(category), (i) => { category = categories[i]!; draw(); })) : null,
      wanting.length ? noteList(wanting) : null,
      accuracyTable(data, accuracy.filter((r) => r.category === category)),
      questions.length > 1 ? h("div", { class: "controls" }, select("Beside policies", [...questions, "all questions"], question ? questions.indexOf(question) : questions.length, (i) => { question = questions[i] ?? ""; draw(); })) : null,
      beside.length ? [sentences(data, beside), knowsTable(state, beside), differenceTable(state, beside)] : null,
      details("How to read these tables",
        h("p", {}, "A choice is asked once for every order of its options and counts as right only if all answers are; \u201cin one order\u201d is the plain rate, with right letters balanced over starts. Where a server tells how probable each letter was, the likeliest ones are scored, too, in every order. Without the picture, and with that of another start, a model gets what words alone give away."),
        h("p", {}, "An episode stands beside the answers about its own start and words. Knows \u2212 goes is the difference of the two rates on the same starts, tested as policies in pairs are.")));
  };
  state.watch(draw);
  return panel("knows", "What the model knows", "Questions about the first pictures, with right answers that the compiler proved, beside what policies do from the same starts.", holder);
}
