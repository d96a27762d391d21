// Builds the page: words first, then tables and charts, each panel on its own so that a broken one leaves the others.
import { type Child, freshId, h, replace } from "./dom";
import { plural } from "./format";
import { type Data, type Note, readData } from "./model";
import { details, noteList, type Panel, panel, policyLabel, prose } from "./parts";
import { cases } from "./panels/cases";
import { compare } from "./panels/compare";
import { deltas } from "./panels/deltas";
import { events } from "./panels/events";
import { floors } from "./panels/floors";
import { gap } from "./panels/gap";
import { heatmap } from "./panels/heatmap";
import { knows } from "./panels/knows";
import { language } from "./panels/language";
import { mainTable } from "./panels/main_table";
import { objects } from "./panels/objects";
import { radar } from "./panels/radar";
import { confounded, delivery, invalid, runs } from "./panels/records";
import { tasks } from "./panels/tasks";
import { State } from "./state";
import { isDark } from "./theme";

// In the order of reading. Ids are those that findings point to.
const kPanels: [string, string, (state: State) => Panel][] = [
  ["main", "Main table", mainTable], ["radar", "Intention and success by category", radar], ["gap", "Intention\u2013action gap", gap],
  ["knows", "What the model knows", knows], ["compare", "Policies in pairs", compare], ["deltas", "Variants against baselines", deltas], ["language", "The same task in other words", language],
  ["heatmap", "Source by target", heatmap], ["objects", "By object", objects], ["cases", "Case studies", cases], ["events", "What happened", events],
  ["tasks", "Tasks, starts, episodes", tasks], ["floors", "Floors and ceilings", floors], ["confounded", "Confounded comparisons", confounded],
  ["invalid", "Invalid episodes", invalid], ["delivery", "What reached the policy", delivery], ["runs", "Runs and fingerprints", runs],
];

// What is wrong with the runs, the first few at once.
function shortList(notes: Note[]): Child {
  const kAtOnce = 5;
  if (!notes.length) return null;
  return [noteList(notes.slice(0, kAtOnce)), notes.length > kAtOnce ? details(plural(notes.length - kAtOnce, "further warning"), noteList(notes.slice(kAtOnce))) : null];
}

function opening(state: State): HTMLElement {
  const { data } = state;
  return h("header", { class: "opening", id: "top" },
    h("p", { class: "brand" }, "vlaprobe"), h("h1", {}, data.title),
    data.run.length ? h("div", { class: "run" }, h("p", {}, prose(data.run[0]!)), data.run.length > 1 ? h("ul", {}, data.run.slice(1).map((sentence) => h("li", {}, prose(sentence)))) : null) : null,
    shortList(data.notes.filter((note) => note.level !== "note")),
    data.findings.length ? [h("h2", {}, "What stands out"), noteList(data.findings, (note) => (note.see && kPanels.some(([id]) => id === note.see) ? h("a", { class: "see", href: `#${note.see}` }, kPanels.find(([id]) => id === note.see)![1]) : null))] : null);
}

// Which policies the charts draw.
function choice(state: State): HTMLElement {
  const { data } = state;
  const holder = h("div", { class: "choice" });
  state.watch(() => {
    const focused = document.activeElement?.getAttribute("data-policy");
    const boxes = data.policies.map((_, p) => {
      const id = freshId();
      return h("li", {}, h("input", { type: "checkbox", id, "data-policy": p, checked: state.chosen.includes(p), change: (event) => {
        const on = (event.target as HTMLInputElement).checked;
        const next = on ? [...state.chosen, p] : state.chosen.filter((q) => q !== p);
        if (next.length) state.choose(next);
        else (event.target as HTMLInputElement).checked = true;
      } }), h("label", { for: id }, policyLabel(state, p)));
    });
    replace(holder, h("fieldset", {}, h("legend", {}, data.policies.length > state.chosen.length ? `Policies drawn: ${state.chosen.length} of ${data.policies.length}` : "Policies drawn"), h("ul", {}, boxes)));
    if (focused !== null && focused !== undefined) holder.querySelector<HTMLElement>(`[data-policy="${Number(focused)}"]`)?.focus();
  });
  return holder;
}

function themeButton(state: State): HTMLElement {
  const button = h("button", { type: "button", class: "theme", click: () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    label();
    state.refresh();
  } });
  const label = () => { button.textContent = isDark() ? "Light page" : "Dark page"; };
  label();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { label(); state.refresh(); });
  return button;
}

function build(data: Data): void {
  const state = new State(data);
  document.title = data.title;
  const panels = kPanels.map(([id, title, make]): Panel => {
    try {
      return make(state);
    } catch (error) {
      console.error(error);
      return panel(id, title, null, h("p", { class: "bad" }, `This panel could not be drawn: ${error instanceof Error ? error.message : String(error)}`));
    }
  });
  const holder = document.getElementById("page")!;
  replace(holder, h("a", { class: "skip", href: "#main" }, "Skip to the main table"),
    h("aside", {}, h("nav", { "aria-label": "Panels" }, h("a", { href: "#top", class: "brand" }, "vlaprobe report"), h("ol", {}, panels.map((p) => h("li", {}, h("a", { href: `#${p.id}` }, p.title))))),
      data.policies.length ? choice(state) : null, themeButton(state)),
    h("main", {}, opening(state), panels.map((p) => p.element),
      h("footer", {}, `${plural(data.episodes.count, "episode")}. `, data.program ?? "vlaprobe", ". Charts: Apache ECharts. Type: Inter.")));
  // A link into the page was followed before there was anything to go to.
  if (/^#[a-z]+$/.test(location.hash)) document.getElementById(location.hash.slice(1))?.scrollIntoView();
  const current = new IntersectionObserver((entries) => {
    for (const entry of entries) holder.querySelector(`nav a[href="#${entry.target.id}"]`)?.classList.toggle("here", entry.isIntersecting);
  }, { rootMargin: "-30% 0px -60% 0px" });
  panels.forEach((p) => current.observe(p.element));
  document.documentElement.dataset.ready = "yes";
}

try {
  build(readData());
} catch (error) {
  console.error(error);
  replace(document.getElementById("page")!, h("p", { class: "opening bad" }, `This report cannot be shown: ${error instanceof Error ? error.message : String(error)}.`));
}
