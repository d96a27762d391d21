// Drives the packed extension against a real server, without an editor:
//   node drive.test.mjs EXTENSION_FOLDER PROGRAM FOLDER
// What `vscode` has is a stand-in: its values (places, texts, lists of diagnostics) are real, its windows take every call. A text with
// a mistake is opened, hovered over, mended by typing and formatted; what the extension shows of each is said on standard output. Where
// PROGRAM cannot be started, what is said of that.
import assert from 'node:assert';
import Module, { createRequire } from 'node:module';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { pathToFileURL, fileURLToPath } from 'node:url';

const [folder, program, work] = process.argv.slice(2).map((path) => resolve(path));

class Disposable {
  constructor(call = () => {}) { this.call = call; }
  dispose() { this.call(); }
  static from(...all) { return new Disposable(() => all.forEach((one) => one.dispose())); }
}
class EventEmitter {
  listeners = new Set();
  event = (listen, self) => {
    const bound = self ? listen.bind(self) : listen;
    this.listeners.add(bound);
    return new Disposable(() => this.listeners.delete(bound));
  };
  fire(value) { for (const listen of [...this.listeners]) listen(value); }
  dispose() { this.listeners.clear(); }
}
class Position {
  constructor(line, character) { Object.assign(this, { line, character }); }
  isBefore(other) { return this.line < other.line || (this.line === other.line && this.character < other.character); }
  isEqual(other) { return this.line === other.line && this.character === other.character; }
}
class Range {
  constructor(a, b, c, d) {
    this.start = a instanceof Position ? a : new Position(a, b);
    this.end = a instanceof Position ? b : new Position(c, d);
  }
}
class Uri {
  constructor(url) { this.url = new URL(url); }
  static parse(text) { return new Uri(text); }
  static file(path) { return new Uri(pathToFileURL(path).href); }
  get scheme() { return this.url.protocol.slice(0, -1); }
  get path() { return this.url.pathname; }
  get fsPath() { return fileURLToPath(this.url); }
  get authority() { return this.url.host; }
  toString() { return this.url.href; }
  with() { return this; }
}
class TextDocument {
  isClosed = false; isDirty = false; isUntitled = false; eol = 1;
  constructor(path, text) { Object.assign(this, { uri: Uri.file(path), fileName: path, languageId: 'probe', version: 1, text }); }
  getText() { return this.text; }
  get lineCount() { return this.text.split('\n').length; }
  offsetAt(at) { return this.text.split('\n').slice(0, at.line).reduce((sum, line) => sum + line.length + 1, 0) + at.character; }
  // Of ASCII texts.
  place(words) { const before = this.text.slice(0, this.text.indexOf(words)).split('\n'); return new Position(before.length - 1, before.at(-1).length); }
}
class Token { isCancellationRequested = false; onCancellationRequested = () => new Disposable(); }
// As the editor's: fields that are given in order.
const made = (...names) => class { constructor(...values) { names.forEach((name, i) => { this[name] = values[i]; }); } };
class MarkdownString { constructor(value = '') { this.value = value; } appendMarkdown(more) { this.value += more; return this; } appendCodeblock(more) { this.value += more; return this; } appendText(more) { this.value += more; return this; } }
class CodeActionKind {
  constructor(value) { this.value = value; }
  append(more) { return new CodeActionKind(this.value ? `${this.value}.${more}` : more); }
  contains(other) { return this.value === '' || other.value === this.value || other.value.startsWith(`${this.value}.`); }
  static Empty = new CodeActionKind('');
}
for (const [name, value] of Object.entries({ QuickFix: 'quickfix', Refactor: 'refactor', RefactorExtract: 'refactor.extract', RefactorInline: 'refactor.inline', RefactorMove: 'refactor.move', RefactorRewrite: 'refactor.rewrite', Source: 'source', SourceOrganizeImports: 'source.organizeImports', SourceFixAll: 'source.fixAll', Notebook: 'notebook' }))
  CodeActionKind[name] = new CodeActionKind(value);
class TabInputText { constructor(uri) { this.uri = uri; } }
class Hover { constructor(contents, range) { this.contents = Array.isArray(contents) ? contents : [contents]; this.range = range; } }

// All else takes every call.
function anything() {
  return new Proxy(class {}, {
    get: (of, key) => (key === 'prototype' ? of.prototype : key === Symbol.toPrimitive ? () => 0 : key === Symbol.iterator ? () => [][Symbol.iterator]() : key === 'then' ? undefined : (of[key] ??= anything())),
    apply: () => anything(),
    construct: () => anything(),
  });
}
const or = (known) => new Proxy(known, { get: (of, key) => (key in of ? of[key] : anything()) });

const events = Object.fromEntries(['Open', 'Change', 'Close', 'Save', 'WillSave', 'Configuration', 'Folders', 'Create', 'Delete', 'Rename', 'WillCreate', 'WillDelete', 'WillRename'].map((name) => [name, new EventEmitter()]));
const providers = {}, shown = new Map(), errors = [], sent = [], waiting = [], saved = [];
const texts = [], asked = new Set();
const settings = { program, assets: process.env.VLAPROBE_DRIVE_ASSETS ? JSON.parse(process.env.VLAPROBE_DRIVE_ASSETS) : '' };
function tell(uri, list) {
  shown.set(uri.toString(), list ?? []);
  for (const look of [...waiting]) look();
}
const collection = {
  name: 'vlaprobe',
  set: (uri, list) => (Array.isArray(uri) ? uri.forEach(([one, all]) => tell(one, all)) : tell(uri, list)),
  delete: (uri) => tell(uri, []), clear: () => shown.clear(), has: (uri) => shown.has(uri.toString()), get: (uri) => shown.get(uri.toString()), forEach() {}, dispose() {},
};
const languages = new Proxy(
  { createDiagnosticCollection: () => collection, match: (selector, document) => ([selector].flat().some((one) => one === document.languageId || one.language === document.languageId) ? 10 : 0), getLanguages: async () => ['probe'] },
  { get: (of, key) => of[key] ?? ((selector, provider) => { providers[key] = provider; return new Disposable(); }) },
);
const commands = {};
const vscode = or({
  Disposable, EventEmitter, Position, Range, Uri, MarkdownString, Hover,
  Location: made('uri', 'range'), Diagnostic: made('range', 'message', 'severity'), DiagnosticRelatedInformation: made('location', 'message'),
  DiagnosticSeverity: { Error: 0, Warning: 1, Information: 2, Hint: 3 }, DiagnosticTag: { Unnecessary: 1, Deprecated: 2 },
  CompletionItem: made('label', 'kind'), CompletionList: made('items', 'isIncomplete'), TextEdit: class { constructor(range, newText) { Object.assign(this, { range, newText }); } static replace(range, text) { return new this(range, text); } },
  CodeActionKind, CodeAction: made('title', 'kind'), CodeLens: made('range', 'command'), SymbolKind: {}, SymbolInformation: class {}, DocumentSymbol: class {}, InlayHint: made('position', 'label', 'kind'), DocumentLink: made('range', 'target'), SemanticTokens: made('data', 'resultId'), CallHierarchyItem: class {}, TypeHierarchyItem: class {}, SemanticTokensLegend: made('types', 'modifiers'), SnippetString: made('value'),
  CancellationTokenSource: class { token = new Token(); cancel() {} dispose() {} }, CancellationError: class extends Error {},
  TabInputText, TabInputTextDiff: class {}, TabInputNotebook: class {}, TabInputCustom: class {}, TextDocumentChangeReason: { Undo: 1, Redo: 2 }, TextDocumentSaveReason: { Manual: 1 }, LogLevel: or({ Info: 3 }),
  languages,
  commands: { registerCommand: (name, call) => { commands[name] = call; return new Disposable(); }, executeCommand: async () => undefined },
  window: or({
    get activeTextEditor() { const document = texts.at(-1); return document && { document }; },
    showErrorMessage: async (text) => void errors.push(text), terminals: [], visibleTextEditors: [],
    tabGroups: {
      get all() { return [{ tabs: texts.map((text) => ({ input: new TabInputText(text.uri) })) }]; },
      activeTabGroup: { activeTab: undefined, tabs: [] },
      onDidChangeTabs: new EventEmitter().event, onDidChangeTabGroups: new EventEmitter().event,
    },
    createTerminal: (options) => ({ name: options.name, show() {}, sendText: (line) => sent.push(`${options.cwd ?? options.name}: ${line}`) }),
    onDidChangeActiveTextEditor: new EventEmitter().event, onDidChangeVisibleTextEditors: new EventEmitter().event,
    createOutputChannel: () => or({ append() {}, appendLine() {}, info() {}, warn() {}, error: (text) => errors.push(text), debug() {}, trace() {}, show() {}, dispose() {}, logLevel: 3, onDidChangeLogLevel: new EventEmitter().event }),
  }),
  workspace: or({
    textDocuments: texts, notebookDocuments: [], workspaceFolders: [{ uri: Uri.file(work), name: basename(work), index: 0 }], getWorkspaceFolder: () => ({ uri: Uri.file(work), name: 'work', index: 0 }),
    getConfiguration: () => ({ get: (name, other) => (asked.add(name), settings[name] ?? other) }), saveAll: async () => { saved.push('all'); return true; },
    onDidOpenTextDocument: events.Open.event, onDidChangeTextDocument: events.Change.event, onDidCloseTextDocument: events.Close.event,
    onDidSaveTextDocument: events.Save.event, onWillSaveTextDocument: events.WillSave.event, onDidChangeConfiguration: events.Configuration.event,
    onDidChangeWorkspaceFolders: events.Folders.event, onDidCreateFiles: events.Create.event, onDidDeleteFiles: events.Delete.event, onDidRenameFiles: events.Rename.event,
    onWillCreateFiles: events.WillCreate.event, onWillDeleteFiles: events.WillDelete.event, onWillRenameFiles: events.WillRename.event,
    createFileSystemWatcher: () => ({ onDidCreate: new EventEmitter().event, onDidChange: new EventEmitter().event, onDidDelete: new EventEmitter().event, dispose() {} }),
    onDidOpenNotebookDocument: new EventEmitter().event, onDidCloseNotebookDocument: new EventEmitter().event, onDidChangeNotebookDocument: new EventEmitter().event, onDidSaveNotebookDocument: new EventEmitter().event,
  }),
  env: or({ language: 'en', appName: 'stand-in', machineId: '0' }), version: '1.91.0', extensions: or({ all: [], getExtension: () => undefined }), l10n: { t: (text) => text },
});
const load = Module._load;
Module._load = (name, ...rest) => (name === 'vscode' ? vscode : load(name, ...rest));

// What is shown of a text, once it is as it should be.
function until(document, wanted) {
  return new Promise((done, fail) => {
    const look = () => {
      const list = shown.get(document.uri.toString());
      if (list === undefined || !wanted(list)) return false;
      clearTimeout(limit);
      waiting.splice(waiting.indexOf(look), 1);
      done(list);
      return true;
    };
    const limit = setTimeout(() => fail(new Error(`${basename(document.fileName)} shows ${JSON.stringify(shown.get(document.uri.toString()))}; ${errors.join(' | ')}`)), 20000);
    waiting.push(look);
    look();
  });
}
function open(name, text) {
  const path = join(work, name);
  writeFileSync(path, text);
  const document = new TextDocument(path, text);
  texts.push(document);
  return document;
}
function type(document, from, to, text) {
  const change = { range: new Range(from, to), rangeOffset: document.offsetAt(from), rangeLength: document.offsetAt(to) - document.offsetAt(from), text };
  document.text = document.text.slice(0, change.rangeOffset) + text + document.text.slice(change.rangeOffset + change.rangeLength);
  document.version += 1;
  document.isDirty = true;
  events.Change.fire({ document, contentChanges: [change], reason: undefined });
}

mkdirSync(work, { recursive: true });
try {
  const things = open('things.probe', '# Things.\nattribute color { red, blue }\nobject ball { color red; friction 1 }\n');
  const user = open('user.probe', 'use "things.probe"\nobject other like bal { color blue }\n');
  const manifest = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const { contributes } = manifest;
  const parts = [manifest.main, ...contributes.languages.map((one) => one.configuration), ...contributes.grammars.map((one) => one.path)];
  for (const part of parts) assert(existsSync(join(folder, part)), `${part} is not packed`);
  const extension = createRequire(import.meta.url)(join(folder, manifest.main));
  await extension.activate({ subscriptions: [], extensionPath: folder });
  for (const { command } of contributes.commands) assert(commands[command], `${command} is in a menu and does nothing`);
  for (const name of asked) assert(contributes.configuration.properties[`vlaprobe.${name}`], `vlaprobe.${name} is no setting`);
  console.log(`registered: ${Object.keys(commands).sort().join(' ')}; said: ${errors.join(' | ') || 'nothing'}`);
  if (errors.length > 0) process.exit(0);
  const before = await until(user, (list) => list.some((one) => String(one.code?.value ?? one.code) === 'P0201'));
  console.log(`diagnostics: ${before.map((one) => `${one.code?.value ?? one.code} ${one.range.start.line}:${one.range.start.character} ${one.message.split('\n')[0]}`).join(', ')}`);
  const hover = await providers.registerHoverProvider.provideHover(things, things.place('ball'), new Token());
  console.log(`hover: ${hover.contents.map((one) => one.value).join(' ').replaceAll('\n', ' ')}`);
  const at = user.place('bal ');
  const completed = await providers.registerCompletionItemProvider?.provideCompletionItems(user, at, new Token(), { triggerKind: 0 });
  console.log(`completion: ${(completed?.items ?? completed ?? []).map((one) => one.label.label ?? one.label).join(' ')}`);
  type(user, new Position(at.line, at.character + 3), new Position(at.line, at.character + 3), 'l');
  await until(user, (list) => !list.some((one) => String(one.code?.value ?? one.code) === 'P0201'));
  console.log('mended: yes');
  const edits = await providers.registerDocumentFormattingEditProvider.provideDocumentFormattingEdits(user, { tabSize: 2, insertSpaces: true }, new Token());
  console.log(`formatting: ${edits?.length ?? 0} edits`);
  await commands['vlaprobe.list'](user.uri.toString(), 'mine');
  console.log(`lens: ${saved.length} saved, ${sent.map((line) => line.replaceAll(work, '.').replace(program, 'vlaprobe')).join(' | ')}`);
  await extension.deactivate();
  console.log(`end: ${errors.length === 0 ? 'done' : errors.join(' | ')}`);
  process.exit(0);
} catch (mistake) {
  console.log(`FAILED: ${mistake.stack ?? mistake}`.slice(0, 4000));
  process.exit(1);
}
