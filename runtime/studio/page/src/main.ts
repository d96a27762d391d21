// The studio: the text on the left, what it means on the right, an episode of it below.
import { h, replace } from "../../../report/page/src/dom";
import { isDark } from "../../../report/page/src/theme";
import { Language, measure } from "./language";
import { monaco, setTheme } from "./monaco";
import { Pictures } from "./picture";
import { Play } from "./play";
import { type Message, type Seen, Socket } from "./socket";
import { Tasks } from "./tasks";
import { type Text, Texts } from "./texts";
import { Top } from "./top";
import "./page.css";

const kPause = 30;  // ms without a keystroke until the text is shown anew
const kDiskEvery = 1500;  // ms

const page = document.getElementById("page")!;
const root = document.documentElement;

function whole(title: string, words: string, button?: [string, () => void]): void {
  replace(page, h("main", { class: "alone", role: "alert" }, h("h1", {}, title), h("p", {}, words), button && h("button", { type: "button", class: "primary", click: button[1] }, button[0])));
  (page.querySelector("button") as HTMLElement | null)?.focus();
}

class Studio {
  private readonly texts = new Texts();
  private readonly tasks = new Tasks((task) => this.choose(task, 0));
  private readonly pictures = new Pictures("What the policy sees first");
  private readonly top = new Top({ show: (start) => this.choose(this.tasks.chosen, start), move: (object, from, to) => void this.move(object, from, to) });
  private readonly play = new Play({ say: (message) => this.live.say(message), now: () => ({ task: this.tasks.chosen, start: this.start }), go: (file, line) => void this.go(file, line) });
  private readonly tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Texts" });
  private readonly state = h("span", { class: "state", role: "status" });
  private readonly notices = h("div", { class: "notices", role: "alert" });
  private readonly saves = h("button", { type: "button", click: () => this.save(), title: "Ctrl+S" }, "Save");
  private readonly caption = h("p", { class: "caption" });
  private readonly startBox = h("input", { type: "number", min: 0, value: 0, class: "short", "aria-label": "Start", change: () => this.choose(this.tasks.chosen, Number(this.startBox.value)) });
  private readonly holder = h("div", { class: "editor" });
  private editor: monaco.editor.IStandaloneCodeEditor | undefined;
  private language: Language | undefined;
  private readonly live: Socket;
  private folder = "";
  private start = 0;
  private wish = 0;
  private readonly typed = new Map<number, number>();  // by wish: when the key was pressed
  private pressed = 0;
  private pause = 0;
  private isBroken = false;
  // Somebody chose the task; else the program shows the text's first.
  private isChosen = false;
  private under = "";  // the task that the cursor is in
  private readonly opening = new Map<string, ((text: Text | null) => void)[]>();
  private isOver = false;

  constructor() {
    this.live = new Socket("live", { text: (m) => this.hear(m), picture: (head, cameras) => this.see(head, cameras), closed: (why) => this.ended(why) }, () => this.live.say({ do: "hello" }));
    this.live ??= null as never;
  }

  private ended(why: string): void {
    if (this.isOver) return;
    this.isOver = true;
    if (!this.editor) return whole("The studio has ended", why || "The program does not answer. Start `vlaprobe studio` again and open the address that it prints.");
    this.notice("ended", `The program has ended${why ? `: ${why}` : ""}. What is not saved is still here: copy it, or start the program again and open its new address.`);
  }

  private hear(message: Message): void {
    if (this.play.hear(message)) return;
    switch (message.kind) {
      case "taken":
        return whole("This studio is open in another page", "A text has one editor at a time. Go to that page, or show it here: the other page then lets go, and what is not saved there stays there.", ["Show it here", () => { replace(page); this.live.say({ do: "take" }); }]);
      case "lost":
        this.isOver = true;
        return whole("Another page shows this studio now", this.texts.anyChanged() ? "It took over before everything was saved here. Go back with your browser's history, or take it back: the texts are then read from the disk." : "It took over. You may close this one.", ["Show it here again", () => location.reload()]);
      case "welcome":
        return void this.build(message);
      case "text": {
        const text = this.texts.add(message.path, message.uri, message.text, message.is_new);
        this.settle(message.path, text);
        return this.drawTabs();
      }
      case "kept":
        return this.kept(message);
      case "saved":
        return this.saved(message.path);
      case "news":
        return this.news(message.path, message.what);
      case "refused":
        if (message.path && this.opening.has(message.path)) this.settle(message.path, null);
        if (/changed on the disk/.test(message.message)) return this.news(message.path, "changed");
        return this.notice("refused", message.message);
      case "broken":
        if (message.id < this.wish) return;
        this.isBroken = true;
        root.dataset.shown = "broken";
        this.say(`${message.errors} ${message.errors === 1 ? "error" : "errors"}: ${message.message}${message.line ? ` (line ${message.line})` : ""}`, "bad");
        return;
      case "failed":
        this.say(message.message, "bad");
        root.dataset.shown = "failed";
        return;
      case "tasks":
        this.tasks.set(message.summary, message.task);
        this.startBox.max = String((this.tasks.task?.starts ?? 1) - 1);
        if (this.editor?.hasTextFocus()) this.follow(this.editor.getPosition()!.lineNumber);
        return this.counted();
      case "top":
        if (message.svg) this.top.draw(message.svg);
        else this.top.fail(message.message);
        root.dataset.top = message.task;
        return;
    }
  }

  private see(head: Message, cameras: Seen[]): void {
    if (this.play.picture(head, cameras)) return;
    this.pictures.draw(cameras);
    const begun = this.typed.get(head.id);
    if (begun !== undefined) {
      measure(`keystroke to ${head.size} picture`, begun);
      if (head.size === "full") this.typed.delete(head.id);
    }
    if (this.isBroken) {
      this.isBroken = false;
      this.counted();
    }
    this.start = head.start;
    this.startBox.value = String(head.start);
    this.caption.textContent = `${head.task}, start ${head.start}`;
    if (this.tasks.chosen !== head.task) this.tasks.mark(head.task);
    this.top.mark(head.start);
    root.dataset.shown = `${head.id} ${head.size} ${head.task} ${head.start}`;
  }

  private say(words: string, kind = ""): void {
    this.state.textContent = words;
    this.state.className = `state ${kind}`;
  }
  private counted(): void { this.say(`it checks`, "good"); }

  private notice(id: string, words: string, buttons: [string, () => void][] = []): void {
    this.unnotice(id);
    this.notices.append(h("div", { class: "notice", "data-id": id }, h("span", {}, words), buttons.map(([label, act]) => h("button", { type: "button", click: () => { this.unnotice(id); act(); } }, label)), h("button", { type: "button", "aria-label": "Dismiss", click: () => this.unnotice(id) }, "\u00d7")));
  }
  private unnotice(id: string): void { this.notices.querySelector(`[data-id="${CSS.escape(id)}"]`)?.remove(); }

  // ---- texts
  private settle(path: string, text: Text | null): void {
    for (const done of this.opening.get(path) ?? []) done(text);
    this.opening.delete(path);
  }
  private open(path: string): Promise<Text | null> {
    const known = this.texts.all.get(path);
    if (known) return Promise.resolve(known);
    return new Promise((done) => {
      const waiting = this.opening.get(path);
      if (waiting) return void waiting.push(done);
      this.opening.set(path, [done]);
      this.live.say({ do: "open", path });
    });
  }
  private async model(uri: string): Promise<monaco.editor.ITextModel | null> {
    const path = monaco.Uri.parse(uri).path;
    if (!path.startsWith(this.folder + "/")) {
      this.notice("outside", `${path} lies outside of the folder that this studio shows`);
      return null;
    }
    const known = this.texts.all.has(path);
    const text = await this.open(path);
    if (text && !known) this.edit(text);
    return text?.model ?? null;
  }
  private async go(file: string, line: number): Promise<void> {
    const path = file.startsWith("/") ? file : `${this.folder}/${file}`;
    const known = [...this.texts.all.keys()].find((one) => one === path || one.endsWith(`/${file}`));
    const model = await this.model(monaco.Uri.file(known ?? path).toString());
    if (!model) return;
    this.turn(model);
    this.editor!.revealLineInCenter(line);
    this.editor!.setPosition({ lineNumber: line, column: 1 });
    this.editor!.focus();
  }
  private turn(model: monaco.editor.ITextModel): void {
    this.editor!.setModel(model);
    this.drawTabs();
  }
  // Known to the language server, and shown when it changes.
  private edit(text: Text): void {
    this.language!.open(text.model);
    text.model.onDidChangeContent(() => {
      this.pressed ||= performance.now();
      this.want(kPause);
      this.drawTabs();
    });
  }
  private drawTabs(): void {
    const now = this.texts.ofModel(this.editor?.getModel() ?? null);
    replace(this.tabs, [...this.texts.all.values()].map((text) => h("button", { type: "button", role: "tab", "aria-selected": String(text === now), title: text.path, click: () => { this.turn(text.model); this.editor!.focus(); } }, text.path.slice(this.folder.length + 1), this.texts.isChanged(text) ? h("span", { class: "unsaved", title: "not saved" }, " \u2022", h("span", { class: "unseen" }, " not saved")) : null)));
    this.saves.disabled = !this.texts.anyChanged();
    root.dataset.unsaved = String(this.texts.anyChanged());
  }
  private save(over = ""): void {
    for (const text of this.texts.all.values()) {
      if (this.texts.isChanged(text) || text.path === over) this.live.say({ do: "save", path: text.path, text: text.model.getValue(), over: text.path === over });
      if (this.texts.isChanged(text)) text.model.pushStackElement();
    }
  }
  private saved(path: string): void {
    const text = this.texts.all.get(path);
    if (!text) return;
    text.saved = text.model.getAlternativeVersionId();
    text.isNew = false;
    this.unnotice(path);
    this.drawTabs();
  }
  private news(path: string, what: string): void {
    const text = this.texts.all.get(path);
    if (!text || this.notices.querySelector(`[data-id="${CSS.escape(path)}"]`)) return;
    const name = path.slice(this.folder.length + 1);
    if (what === "gone") return this.notice(path, `${name} was deleted on the disk; its text is still here.`, [["Save it again", () => this.save(path)]]);
    this.notice(path, `${name} was changed on the disk by another program${this.texts.isChanged(text) ? ", and here as well" : ""}.`, [["Take the disk's", () => this.live.say({ do: "open", path })], ["Keep this one", () => this.save(path)]]);
  }

  // ---- what is shown
  private want(pause: number): void {
    clearTimeout(this.pause);
    this.pause = window.setTimeout(() => {
      if (this.pressed) this.typed.set(this.wish + 1, this.pressed);
      this.pressed = 0;
      this.live.say({ do: "show", id: ++this.wish, texts: this.texts.unsaved(), task: this.isChosen ? this.tasks.chosen : "", start: this.start });
    }, pause);
  }
  // The task that one writes is the one that one sees.
  private follow(line: number): void {
    const model = this.editor?.getModel();
    if (!model) return;
    for (let at = line; at > 0; --at) {
      const words = model.getLineContent(at);
      const task = /^\s*(?:abstract\s+)?(?:task|variant)\s+(\w+)/.exec(words)?.[1];
      if (!task && (at === line || !/^\S/.test(words)) && !/^[a-z]/.test(words)) continue;
      if (task && !this.tasks.has(task)) return;  // not yet: once it checks
      if (task && task !== this.under && task !== this.tasks.chosen) this.choose(task, 0);
      this.under = task ?? "";
      return;
    }
  }
  private choose(task: string, start: number): void {
    this.isChosen = true;
    if (task !== this.tasks.chosen) this.tasks.mark(task);
    const last = (this.tasks.task?.starts ?? 1) - 1;
    this.start = Math.max(0, Math.min(last, Math.round(start) || 0));
    this.startBox.max = String(last);
    this.top.mark(this.start);
    this.want(0);
  }

  private async move(object: string, from: [number, number], to: [number, number]): Promise<void> {
    const now = this.texts.ofModel(this.editor!.getModel()) ?? [...this.texts.all.values()][0]!;
    try {
      const result = await this.language!.ask("vlaprobe/move", { textDocument: { uri: now.model.uri.toString(true) }, task: this.tasks.chosen, object, from, to });
      const { edits } = await this.language!.workspaceEdit(result);
      // By the editor of that text, so that it is undone like what was typed; all of them at once, as each is of the text before.
      const parts = edits as monaco.languages.IWorkspaceTextEdit[];
      if (!parts.length) return;
      const model = monaco.editor.getModel(parts[0]!.resource)!;
      if (this.editor!.getModel() !== model) this.turn(model);
      this.editor!.pushUndoStop();
      this.editor!.executeEdits("move", parts.map((one) => ({ range: one.textEdit.range, text: one.textEdit.text, forceMoveMarkers: true })));
      this.editor!.pushUndoStop();
      this.editor!.revealRangeInCenterIfOutsideViewport(parts[0]!.textEdit.range);
      this.unnotice("move");
    } catch (error) {
      this.notice("move", (error as Error).message);
    }
  }

  // A step of an episode has become a table; the lines that use it stand behind the text.
  private kept(message: Message): void {
    const text = [...this.texts.all.values()][0]!;
    this.turn(text.model);
    const model = text.model, last = model.getLineCount();
    const end = new monaco.Range(last, model.getLineMaxColumn(last), last, model.getLineMaxColumn(last));
    this.editor!.pushUndoStop();
    this.editor!.executeEdits("keep", [{ range: end, text: (model.getLineMaxColumn(last) > 1 ? "\n" : "") + message.lines }]);
    this.editor!.pushUndoStop();
    this.editor!.setPosition({ lineNumber: model.getLineCount() - 1, column: 1 });
    this.editor!.revealLine(model.getLineCount());
    this.editor!.focus();
    this.notice("kept", `Kept as ${message.table}; the task ${message.task} begins there.`);
  }

  private command(name: string, task: string): void {
    if (name === "list") return;
    this.choose(task, this.tasks.chosen === task ? this.start : 0);
    if (name === "runExpert") this.play.begin("expert");
  }

  // ---- the page
  private async build(welcome: Message): Promise<void> {
    this.folder = welcome.folder;
    document.title = `${welcome.file.slice(welcome.folder.length + 1)} - vlaprobe studio`;
    const more = h("select", { "aria-label": "Open a text of the folder", change: () => { const path = more.value; more.value = ""; if (path) void this.model(monaco.Uri.file(path).toString()).then((model) => model && (this.turn(model), this.editor!.focus())); } },
      h("option", { value: "" }, "open ..."), (welcome.texts as string[]).map((path) => h("option", { value: path }, path.slice(welcome.folder.length + 1))));
    const theme = h("button", { type: "button", title: "Light or dark", "aria-label": "Light or dark", click: () => { root.dataset.theme = isDark() ? "light" : "dark"; this.recolour(); } }, "\u25d0");
    const pane = (name: string, label: string, ...children: (HTMLElement | null)[]): HTMLElement => h("section", { class: name, "aria-label": label, tabindex: -1 }, children);
    replace(page, h("div", { class: "studio" },
      h("header", {}, h("h1", {}, "vlaprobe studio"), this.tabs, more, this.saves, this.state, theme),
      this.notices,
      pane("text", "Text", this.holder),
      pane("seen", "First picture", h("div", { class: "bar" }, h("label", {}, "start ", this.startBox), this.caption), this.pictures.element),
      pane("above", "Starts from above", this.top.element),
      pane("said", "Instructions", h("div", { class: "bar" }, this.tasks.find, this.tasks.counts), this.tasks.list),
      this.play.element));
    this.play.element.tabIndex = -1;
    this.play.setPolicies(welcome.policies);
    setTheme();
    this.language = new Language({ model: (uri) => this.model(uri), say: (words) => this.notice("server", words), command: (name, task) => this.command(name, task), closed: (why) => this.ended(why) });
    this.editor = monaco.editor.create(this.holder, {
      model: null, theme: "vlaprobe", automaticLayout: true, "semanticHighlighting.enabled": true, minimap: { enabled: false }, fontSize: 13.5, lineNumbersMinChars: 3, scrollBeyondLastLine: false,
      wordBasedSuggestions: "off", codeLens: true, inlayHints: { enabled: "on" }, fixedOverflowWidgets: true, tabSize: 2, ariaLabel: "Text; F6 leaves it", stickyScroll: { enabled: false }, rulers: [100], quickSuggestions: { strings: true, other: true, comments: false }, bracketPairColorization: { enabled: false },
    });
    this.editor.onDidChangeCursorPosition((event) => this.follow(event.position.lineNumber));
    monaco.editor.registerEditorOpener({
      openCodeEditor: async (_, resource, place) => {
        const model = await this.model(resource.toString());
        if (!model) return true;
        this.turn(model);
        if (place && "startLineNumber" in place) this.editor!.setSelection(place as monaco.IRange), this.editor!.revealRangeInCenter(place as monaco.IRange);
        else if (place) this.editor!.setPosition(place as monaco.IPosition);
        return true;
      },
    });
    monaco.editor.registerLinkOpener({ open: async (resource) => { const model = await this.model(resource.toString()); if (model) this.turn(model); return true; } });
    this.keys();
    const [text] = await Promise.all([this.open(welcome.file), this.language.ready]);
    if (!text) return;
    this.edit(text);
    this.turn(text.model);
    this.editor.focus();
    this.want(0);
    root.dataset.ready = "yes";
    performance.mark("ready");
    setInterval(() => this.live.say({ do: "news", paths: [...this.texts.all.keys()] }), kDiskEvery);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
    addEventListener("beforeunload", (event) => { if (!this.isOver && this.texts.anyChanged()) event.preventDefault(); });
  }

  private recolour(): void {
    setTheme();
    this.play.redraw();
  }

  private keys(): void {
    const panes = (): HTMLElement[] => [this.holder, ...["section.seen", "section.above", "section.said", "section.play", "header"].map((name) => page.querySelector<HTMLElement>(name)!)];
    const focus = (pane: HTMLElement): void => {
      if (pane === this.holder) return this.editor!.focus();
      (pane.querySelector<HTMLElement>("input, select, button:not(:disabled), [tabindex='0']") ?? pane).focus();
    };
    // Before the editor, which has other uses for some of them.
    const act: Record<string, (event: KeyboardEvent) => void> = {
      F6: (event) => {
        const all = panes();
        const at = all.findIndex((pane) => pane.contains(document.activeElement));
        focus(all[(at + (event.shiftKey ? all.length - 1 : 1)) % all.length]!);
      },
      "Ctrl+Enter": () => this.play.begin(),
      "Ctrl+s": () => this.save(),
      "Alt+PageDown": () => this.choose(this.tasks.chosen, this.start + 1),
      "Alt+PageUp": () => this.choose(this.tasks.chosen, this.start - 1),
      "Alt+ArrowDown": () => this.tasks.step(1),
      "Alt+ArrowUp": () => this.tasks.step(-1),
    };
    addEventListener("keydown", (event) => {
      const key = `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${event.altKey ? "Alt+" : ""}${event.key}`;
      if (!act[key]) return;
      event.preventDefault();
      event.stopPropagation();
      act[key](event);
    }, true);
  }
}

new Studio();
