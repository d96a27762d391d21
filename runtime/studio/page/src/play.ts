// Below: an episode of the task that is shown, as it happens, step by step afterwards, and why its verdicts are what they are.
import { type Child, h, replace } from "../../../report/page/src/dom";
import { Pictures } from "./picture";
import type { Message, Seen } from "./socket";
import { type Metric, Timeline } from "./timeline";

export interface PlayHost {
  say(message: Message): void;
  // The task and the start that are shown.
  now(): { task: string; start: number };
  // A line of a text, in the editor.
  go(file: string, line: number): void;
}

const number = (value: number): string => (Number.isInteger(value) ? String(value) : value.toPrecision(3));

export class Play {
  private readonly pictures = new Pictures("The episode");
  private readonly policy = h("input", { list: "policies", value: "expert", "aria-label": "Policy", spellcheck: false, size: 26, keydown: (event) => { const { key, ctrlKey, metaKey } = event as KeyboardEvent; if (key === "Enter" && !ctrlKey && !metaKey) this.begin(); } });
  private readonly policies = h("datalist", { id: "policies" });
  private readonly seed = h("input", { type: "number", value: 0, min: 0, max: 1000000, "aria-label": "Seed", class: "short" });
  private readonly run = h("button", { type: "button", class: "primary", click: () => this.begin(), title: "Ctrl+Enter" }, "Run");
  private readonly halt = h("button", { type: "button", disabled: true, click: () => this.host.say({ do: "stop" }) }, "Stop");
  private readonly scrub = h("input", { type: "range", min: 0, max: 0, value: 0, disabled: true, "aria-label": "Step of the episode", input: () => this.look(Number(this.scrub.value)) });
  private readonly keep = h("button", { type: "button", disabled: true, title: "A start that begins as this step is", click: () => this.host.say({ do: "keep", step: Number(this.scrub.value) }) }, "Keep as a start");
  private readonly where = h("span", { class: "where", "aria-live": "off" });
  private readonly verdict = h("span", { class: "verdict", role: "status" });
  private readonly lights = h("div", { class: "lights", role: "group", "aria-label": "Verdicts; each says why" });
  private readonly reasons = h("div", { class: "reasons", tabindex: 0, role: "region", "aria-label": "Why" });
  private readonly timeline = new Timeline((step) => this.look(step));
  private metrics: Metric[] = [];
  private values: number[][] = [];
  private isPlaying = false;
  private asked = -1;
  readonly element: HTMLElement;

  constructor(private readonly host: PlayHost) {
    this.element = h("section", { class: "play", "aria-label": "Episode" },
      h("div", { class: "bar" }, h("label", {}, "policy ", this.policy), this.policies, h("label", {}, "seed ", this.seed), this.run, this.halt, this.scrub, this.where, this.keep, this.verdict),
      h("div", { class: "watched" }, this.pictures.element, h("div", { class: "judged" }, this.lights, this.timeline.element), this.reasons));
    replace(this.reasons, h("p", { class: "note" }, "Run an episode; click on a verdict for its reasons."));
  }

  setPolicies(help: string): void {
    replace(this.policies, help.split("\n").filter(Boolean).map((line) => {
      const [name, ...meaning] = line.trim().split(/\s{2,}/);
      return h("option", { value: name!.replace(/:[A-Z].*$/, ":") }, `${name} ${meaning.join(" ")}`);
    }));
  }

  begin(policy?: string): void {
    if (policy) this.policy.value = policy;
    const { task, start } = this.host.now();
    if (!task) return this.tell("the text has no task to run", "bad");
    this.host.say({ do: "play", task, start, policy: this.policy.value.trim(), seed: Number(this.seed.value) || 0 });
  }

  private tell(words: string, kind = ""): void {
    this.verdict.textContent = words;
    this.verdict.title = words;
    this.verdict.className = `verdict ${kind}`;
  }

  // What a line may cut is read below it.
  private tellWhole(words: string): void {
    this.tell(words, "bad");
    replace(this.reasons, h("p", { class: "note bad" }, words));
  }

  private look(step: number): void {
    if (!this.values.length) return;
    this.scrub.value = String(step);
    this.at(step);
    // One at a time: the newest is asked for when the last has come.
    if (this.isPlaying) return;
    const idle = this.asked < 0;
    this.asked = step;
    if (idle) this.host.say({ do: "look", step });
  }

  private at(step: number): void {
    this.where.textContent = `step ${step} of ${this.values.length - 1}`;
    this.timeline.mark(step);
    this.light(this.values[step] ?? []);
  }

  private light(values: number[]): void {
    [...this.lights.children].forEach((light, i) => {
      const metric = this.metrics[i]!, value = values[i] ?? 0;
      light.classList.toggle("on", metric.truth && value !== 0);
      light.querySelector(".value")!.textContent = metric.truth ? (value ? "yes" : "no") : number(value);
    });
  }

  hear(message: Message): boolean {
    switch (message.kind) {
      case "playing":
        this.isPlaying = true;
        this.asked = -1;
        this.metrics = message.metrics;
        this.values = [];
        this.scrub.max = String(message.horizon);
        this.scrub.disabled = this.keep.disabled = true;
        this.halt.disabled = false;
        this.element.dataset.state = "playing";
        this.pictures.draw([]);
        replace(this.lights, this.metrics.map((metric) => h("button", { type: "button", class: metric.truth ? "light truth" : "light", click: () => this.host.say({ do: "why", metric: metric.name }) }, h("span", { class: "lamp", "aria-hidden": "true" }), h("span", {}, metric.name), " ", h("span", { class: "value" }, ""))));
        this.timeline.begin(this.metrics, message.horizon);
        this.tell(`${message.policy} on start ${message.start} of ${message.task}`);
        replace(this.reasons, h("p", { class: "note" }, `"${message.prompt}"`));
        return true;
      case "step":
        this.step(message);
        return true;
      case "played": {
        this.isPlaying = false;
        this.values[message.steps] = message.values;
        this.scrub.max = String(message.steps);
        this.scrub.value = String(message.steps);
        this.scrub.disabled = this.keep.disabled = false;
        this.halt.disabled = true;
        this.at(message.steps);
        const success = this.metrics.findIndex((metric) => metric.name === "success");
        if (message.invalid) this.tellWhole(message.invalid);
        else if (success < 0) this.tell(`judged after ${message.steps} steps`);
        else this.tell(message.values[success] ? `success after ${message.steps} steps` : `no success after ${message.steps} steps${message.remark ? `: ${message.remark}` : ""}`, message.values[success] ? "good" : "bad");
        this.element.dataset.state = "played";
        return true;
      }
      case "stopped":
        this.isPlaying = false;
        this.halt.disabled = true;
        this.tellWhole(message.message);
        this.element.dataset.state = "stopped";
        return true;
      case "why":
        this.explain(message);
        return true;
    }
    return false;
  }

  private step(message: Message): void {
    this.values[message.step] = message.values;
    this.timeline.add(message.step, message.values);
    this.scrub.value = String(message.step);
    this.where.textContent = `step ${message.step}`;
    this.light(message.values);
  }

  picture(head: Message, cameras: Seen[]): boolean {
    if (head.kind === "step") {
      this.step(head);
      this.pictures.draw(cameras);
      return true;
    }
    if (head.kind !== "moment") return false;
    this.pictures.draw(cameras);
    this.element.dataset.step = String(head.step);
    const next = this.asked;
    this.asked = -1;
    if (next !== head.step) this.look(next);
    return true;
  }

  private explain(why: Message): void {
    if (why.message) return replace(this.reasons, h("p", { class: "note bad" }, why.message));
    const line = (file: string, at: number, text: string): Child => (file ? h("button", { type: "button", class: "place", click: () => this.host.go(file, at), title: `${file}:${at}` }, text) : text);
    replace(this.reasons, why.metrics.map((metric: any) => [
      h("h3", {}, `${metric.metric}: ${metric.shown}`, h("span", { class: "soft" }, ` ${metric.when}`)),
      h("ul", {}, metric.conditions.map((c: any) => h("li", { class: `${c.decides ? "decides" : ""} ${c.truth === false ? "no" : "yes"}` }, line(c.file, c.line, c.text || "its value"), h("span", { class: "soft" }, ` ${c.measured}${c.bodies ? ` (${c.bodies})` : ""}${c.alike ? `, and ${c.alike} alike` : ""}`)))),
      metric.step > 0 && h("button", { type: "button", class: "link", click: () => this.look(metric.step) }, `show step ${metric.step}`),
    ]));
    this.element.dataset.why = why.metrics.map((metric: any) => metric.metric).join(" ");
  }

  redraw(): void { if (this.metrics.length) this.timeline.draw(); }
}
