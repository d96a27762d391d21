// The language server's answers as Monaco wants them: one provider each. What a text means is known by the program alone.
import { kLanguage, monaco } from "./monaco";
import { type Message, Socket } from "./socket";

type Model = monaco.editor.ITextModel;
interface Place { line: number; character: number }
interface Range { start: Place; end: Place }
interface TextEdit { range: Range; newText: string }

// What the page does that the editor cannot.
export interface Host {
  // A text of the folder as a model; null, and said to the user, where it may not be opened.
  model(uri: string): Promise<Model | null>;
  say(text: string): void;
  command(name: string, task: string): void;
  closed(why: string): void;
}

const position = (p: Place): monaco.IPosition => ({ lineNumber: p.line + 1, column: p.character + 1 });
const range = (r: Range): monaco.IRange => ({ startLineNumber: r.start.line + 1, startColumn: r.start.character + 1, endLineNumber: r.end.line + 1, endColumn: r.end.character + 1 });
const place = (p: monaco.IPosition): Place => ({ line: p.lineNumber - 1, character: p.column - 1 });
const toRange = (r: monaco.IRange): Range => ({ start: { line: r.startLineNumber - 1, character: r.startColumn - 1 }, end: { line: r.endLineNumber - 1, character: r.endColumn - 1 } });
const edit = (e: TextEdit): monaco.languages.TextEdit => ({ range: range(e.range), text: e.newText });

// By the protocol's numbers, from 1.
const kItems = ["Text", "Method", "Function", "Constructor", "Field", "Variable", "Class", "Interface", "Module", "Property", "Unit", "Value", "Enum", "Keyword", "Snippet", "Color", "File", "Reference", "Folder", "EnumMember", "Constant", "Struct", "Event", "Operator", "TypeParameter"] as const;

// For whoever measures; what is old is forgotten.
let measured = 0;
export function measure(name: string, begun: number): void {
  performance.measure(name, { start: begun, end: performance.now() });
  if (++measured % 5000 === 0) performance.clearMeasures();
}

export class Language {
  private socket: Socket;
  private next = 0;
  private readonly waiting = new Map<number, { done(result: any): void; failed(error: Error): void }>();
  private legend: { tokenTypes: string[]; tokenModifiers: string[] } = { tokenTypes: [], tokenModifiers: [] };
  readonly ready: Promise<void>;

  constructor(private readonly host: Host) {
    this.ready = new Promise((ready) => {
      this.socket = new Socket("text", { text: (message) => this.hear(message), closed: (why) => host.closed(why) }, () => void this.begin().then(ready));
    });
    this.socket ??= null as never;
  }

  ask(method: string, params: object): Promise<any> {
    const id = ++this.next;
    const begun = performance.now();
    this.socket.say({ jsonrpc: "2.0", id, method, params });
    return new Promise((done, failed) => this.waiting.set(id, { done: (result) => { measure(`answer ${method}`, begun); done(result); }, failed }));
  }
  private tell(method: string, params: object): void { this.socket.say({ jsonrpc: "2.0", method, params }); }

  private async begin(): Promise<void> {
    const result = await this.ask("initialize", { processId: null, rootUri: null, capabilities: { textDocument: { publishDiagnostics: { relatedInformation: true }, documentSymbol: { hierarchicalDocumentSymbolSupport: true } } } });
    this.legend = result.capabilities.semanticTokensProvider.legend;
    this.tell("initialized", {});
    this.register(result.capabilities);
  }

  private hear(message: Message): void {
    if (message.method === "textDocument/publishDiagnostics") return this.mark(message.params);
    if (message.method === "window/showMessage") return this.host.say(message.params.message);
    const waits = this.waiting.get(message.id);
    if (!waits || message.method) return;
    this.waiting.delete(message.id);
    if (message.error) waits.failed(new Error(message.error.message));
    else waits.done(message.result);
  }

  // From now on the program knows every keystroke in it.
  open(model: Model): void {
    const uri = model.uri.toString(true);
    this.tell("textDocument/didOpen", { textDocument: { uri, languageId: kLanguage, version: model.getVersionId(), text: model.getValue() } });
    model.onDidChangeContent((event) => {
      // Each is of the text before all of them: the last comes first.
      const changes = [...event.changes].sort((a, b) => b.rangeOffset - a.rangeOffset);
      this.tell("textDocument/didChange", { textDocument: { uri, version: event.versionId }, contentChanges: changes.map((c) => ({ range: toRange(c.range), text: c.text })) });
    });
  }

  private mark(params: Message): void {
    const model = monaco.editor.getModel(monaco.Uri.parse(params.uri));
    if (!model) return;
    monaco.editor.setModelMarkers(model, "vlaprobe", params.diagnostics.map((d: any) => ({
      ...range(d.range), message: d.message, code: d.code, source: "vlaprobe",
      severity: d.severity === 1 ? monaco.MarkerSeverity.Error : monaco.MarkerSeverity.Warning,
      tags: d.tags,
      relatedInformation: d.relatedInformation?.map((r: any) => ({ ...range(r.location.range), resource: monaco.Uri.parse(r.location.uri), message: r.message })),
    })));
  }

  private async at<T>(method: string, model: Model, more: object, read: (result: any) => T): Promise<T | undefined> {
    try {
      const result = await this.ask(method, { textDocument: { uri: model.uri.toString(true) }, ...more });
      return result === null ? undefined : read(result);
    } catch (error) {
      if (method === "textDocument/rename" || method === "textDocument/prepareRename") throw error;
      return undefined;
    }
  }

  // Those that can be shown; of others the user hears where they are.
  private async locations(found: { uri: string; range: Range }[]): Promise<monaco.languages.Location[]> {
    const out: monaco.languages.Location[] = [];
    for (const one of found) if (await this.host.model(one.uri)) out.push({ uri: monaco.Uri.parse(one.uri), range: range(one.range) });
    return out;
  }
  async workspaceEdit(result: any): Promise<monaco.languages.WorkspaceEdit> {
    const edits: monaco.languages.IWorkspaceTextEdit[] = [];
    for (const [uri, list] of Object.entries<TextEdit[]>(result.changes)) {
      const model = await this.host.model(uri);
      if (!model) throw new Error(`${uri} cannot be changed here`);
      for (const one of list) edits.push({ resource: model.uri, versionId: undefined, textEdit: edit(one) });
    }
    return { edits };
  }

  private register(capabilities: any): void {
    const languages = monaco.languages;
    languages.registerCompletionItemProvider(kLanguage, {
      // Who opens a brace goes on with Enter, which must not take what is offered.
      triggerCharacters: capabilities.completionProvider.triggerCharacters.filter((c: string) => c !== "{"),
      provideCompletionItems: (model, p) => this.at("textDocument/completion", model, { position: place(p) }, (result) => ({
        incomplete: result.isIncomplete,
        suggestions: result.items.map((item: any) => ({
          label: item.label, kind: languages.CompletionItemKind[kItems[item.kind - 1] ?? "Text"], sortText: item.sortText, detail: item.detail,
          documentation: item.documentation ? { value: item.documentation.value } : undefined, insertText: item.textEdit.newText, range: range(item.textEdit.range),
        })),
      })),
    });
    languages.registerHoverProvider(kLanguage, { provideHover: (model, p) => this.at("textDocument/hover", model, { position: place(p) }, (r) => ({ contents: [{ value: r.contents.value }], range: range(r.range) })) });
    languages.registerSignatureHelpProvider(kLanguage, {
      signatureHelpTriggerCharacters: capabilities.signatureHelpProvider.triggerCharacters,
      provideSignatureHelp: (model, p) => this.at("textDocument/signatureHelp", model, { position: place(p) }, (r) => ({
        value: { activeSignature: r.activeSignature, activeParameter: r.activeParameter, signatures: r.signatures.map((one: any) => ({ label: one.label, parameters: one.parameters, documentation: one.documentation ? { value: one.documentation.value } : undefined })) },
        dispose: () => {},
      })),
    });
    languages.registerDefinitionProvider(kLanguage, { provideDefinition: async (model, p) => this.locations((await this.at("textDocument/definition", model, { position: place(p) }, (r) => r)) ?? []) });
    languages.registerReferenceProvider(kLanguage, { provideReferences: async (model, p, context) => this.locations((await this.at("textDocument/references", model, { position: place(p), context }, (r) => r)) ?? []) });
    languages.registerDocumentHighlightProvider(kLanguage, { provideDocumentHighlights: (model, p) => this.at("textDocument/documentHighlight", model, { position: place(p) }, (r) => r.map((one: any) => ({ range: range(one.range), kind: one.kind - 1 }))) });
    const symbol = (one: any): monaco.languages.DocumentSymbol => ({ name: one.name, detail: one.detail ?? "", kind: one.kind - 1, tags: [], range: range(one.range), selectionRange: range(one.selectionRange), children: (one.children ?? []).map(symbol) });
    languages.registerDocumentSymbolProvider(kLanguage, { displayName: "vlaprobe", provideDocumentSymbols: (model) => this.at("textDocument/documentSymbol", model, {}, (r) => r.map(symbol)) });
    languages.registerFoldingRangeProvider(kLanguage, { provideFoldingRanges: (model) => this.at("textDocument/foldingRange", model, {}, (r) => r.map((f: any) => ({ start: f.startLine + 1, end: f.endLine + 1, kind: f.kind ? new languages.FoldingRangeKind(f.kind) : undefined }))) });
    languages.registerDocumentFormattingEditProvider(kLanguage, { provideDocumentFormattingEdits: (model) => this.at("textDocument/formatting", model, { options: {} }, (r) => r.map(edit)) });
    languages.registerRenameProvider(kLanguage, {
      provideRenameEdits: async (model, p, newName) => {
        try {
          return (await this.at("textDocument/rename", model, { position: place(p), newName }, (r) => this.workspaceEdit(r))) ?? { edits: [] };
        } catch (error) {
          return { edits: [], rejectReason: (error as Error).message };
        }
      },
      resolveRenameLocation: async (model, p) => {
        try {
          return await this.at("textDocument/prepareRename", model, { position: place(p) }, (r) => ({ range: range(r.range), text: r.placeholder }));
        } catch (error) {
          return { range: new monaco.Range(p.lineNumber, p.column, p.lineNumber, p.column), text: "", rejectReason: (error as Error).message };
        }
      },
    });
    languages.registerCodeActionProvider(kLanguage, {
      provideCodeActions: async (model, r, context) => {
        const found = (await this.at("textDocument/codeAction", model, { range: toRange(r), context: { diagnostics: [], only: context.only ? [context.only] : undefined } }, (x) => x)) ?? [];
        const actions = [];
        for (const one of found) actions.push({ title: one.title, kind: one.kind, isPreferred: one.isPreferred, edit: await this.workspaceEdit(one.edit), diagnostics: context.markers.filter((m) => one.diagnostics?.some((d: any) => d.code === m.code)) });
        return { actions, dispose: () => {} };
      },
    }, { providedCodeActionKinds: capabilities.codeActionProvider.codeActionKinds });
    languages.registerDocumentSemanticTokensProvider(kLanguage, {
      getLegend: () => this.legend,
      provideDocumentSemanticTokens: (model) => this.at("textDocument/semanticTokens/full", model, {}, (r) => ({ data: new Uint32Array(r.data) })),
      releaseDocumentSemanticTokens: () => {},
    });
    languages.registerInlayHintsProvider(kLanguage, { provideInlayHints: (model, r) => this.at("textDocument/inlayHint", model, { range: toRange(r) }, (hints) => ({ hints: hints.map((one: any) => ({ position: position(one.position), label: one.label, paddingLeft: one.paddingLeft })), dispose: () => {} })) });
    languages.registerCodeLensProvider(kLanguage, { provideCodeLenses: (model) => this.at("textDocument/codeLens", model, {}, (r) => ({ lenses: r.map((one: any) => ({ range: range(one.range), command: { id: one.command.command, title: one.command.title, arguments: one.command.arguments } })), dispose: () => {} })) });
    languages.registerLinkProvider(kLanguage, { provideLinks: (model) => this.at("textDocument/documentLink", model, {}, (r) => ({ links: r.map((one: any) => ({ range: range(one.range), url: one.target })) })) });
    for (const name of ["show", "preview", "runExpert", "list"]) monaco.editor.registerCommand(`vlaprobe.${name}`, (_, __: string, task: string) => this.host.command(name, task));
  }
}
