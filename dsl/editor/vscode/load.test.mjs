// Loads the bundled extension without an editor: node load.test.mjs EXTENSION_FOLDER PROGRAM. What `vscode`
// has is a stand-in that takes every call, so this shows that the bundle is whole, that it registers
// the commands that the server's lenses name, and that it says so where PROGRAM cannot be started.
import Module, { createRequire } from 'node:module';
import { resolve } from 'node:path';
import assert from 'node:assert';

const registered = [];
const settings = { program: process.argv[3], assets: '' };
const errors = [];
function anything() {
  const target = class {};
  return new Proxy(target, {
    get: (of, key) => (key === 'prototype' ? of.prototype : key === Symbol.toPrimitive ? () => 0 : key === 'then' ? undefined : (of[key] ??= anything())),
    apply: () => anything(),
    construct: () => anything(),
  });
}
const vscode = new Proxy(
  {
    commands: {
      registerCommand: (name) => (registered.push(name), { dispose() {} }),
      executeCommand: async () => undefined,
    },
    window: new Proxy({ showErrorMessage: async (text) => void errors.push(text), terminals: [] }, { get: (of, key) => of[key] ?? anything() }),
    workspace: new Proxy(
      {
        getConfiguration: () => ({ get: (name, other) => settings[name] ?? other }),
        onDidChangeConfiguration: () => ({ dispose() {} }),
        textDocuments: [], workspaceFolders: undefined, notebookDocuments: [],
      },
      { get: (of, key) => (key in of ? of[key] : anything()) },
    ),
    version: '1.91.0',
  },
  { get: (of, key) => of[key] ?? anything() },
);
const load = Module._load;
Module._load = (name, ...rest) => (name === 'vscode' ? vscode : load(name, ...rest));
const require = createRequire(import.meta.url);
const extension = require(resolve(process.argv[2], 'dist/extension.js'));
const context = { subscriptions: [] };
await Promise.race([extension.activate(context), new Promise((done) => setTimeout(done, 5000))]);
assert.deepEqual(registered.sort(), ['vlaprobe.list', 'vlaprobe.preview', 'vlaprobe.restart', 'vlaprobe.runExpert', 'vlaprobe.show']);
console.log(`registered ${registered.length}; said: ${errors.join(' | ') || 'nothing'}`);
process.exit(0);
