// Holds what an editor and the server said to one another to the protocol's types.
//
//   node check.mjs PACKAGES FROM_EDITOR FROM_SERVER ours|theirs
//
// PACKAGES has node_modules of package.json; the next two are what went through each pipe, as it
// was; mistakes of an editor that is not ours are told and do not count. A line for each message that is not as it should be, then one of what was seen.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { copyFileSync } from 'node:fs';

const [packages, fromEditor, fromServer, whose] = process.argv.slice(2);
const require = createRequire(join(packages, 'package.json'));
const here = dirname(fileURLToPath(import.meta.url));
// Types are looked for from the file that names them.
for (const name of ['messages.ts', 'tsconfig.json']) copyFileSync(join(here, name), join(packages, name));
const { createGenerator } = await import(require.resolve('ts-json-schema-generator'));
const generator = createGenerator({
  path: join(packages, 'messages.ts'),
  tsconfig: join(packages, 'tsconfig.json'),
  skipTypeCheck: true,
  additionalProperties: false,
});
const Ajv = require('ajv');
const ajv = new (Ajv.default ?? Ajv)({ strict: false, allErrors: false });
ajv.addSchema(generator.createSchema('Requests'), 'requests');
ajv.addSchema(generator.createSchema('Notices'), 'notices');

// A place within a schema, by the words of its path.
const known = new Map();
function shapeOf(schema, ...path) {
  const words = path.map((word) => word.replaceAll('~', '~0').replaceAll('/', '~1'));
  const root = schema === 'requests' ? 'Requests' : 'Notices';
  const whole = ajv.getSchema(schema).schema.definitions;
  let at = whole[root];
  const address = [`${schema}#/definitions/${root}`];
  for (const word of path) {
    while (at?.$ref) {
      const name = decodeURIComponent(at.$ref.slice('#/definitions/'.length));
      address.splice(0, address.length, `${schema}#/definitions/${encodeURIComponent(name)}`);
      at = whole[name];
    }
    at = at?.properties?.[word];
    if (at === undefined) return undefined;
    address.push('properties', encodeURIComponent(word.replaceAll('~', '~0').replaceAll('/', '~1')));
  }
  const key = address.join('/');
  if (!known.has(key)) known.set(key, ajv.compile({ $ref: key }));
  return known.get(key);
}

function messages(file) {
  const bytes = readFileSync(file);
  const found = [];
  for (let at = 0; at < bytes.length; ) {
    const end = bytes.indexOf('\r\n\r\n', at);
    const length = Number(/Content-Length: (\d+)/i.exec(bytes.subarray(at, end).toString('latin1'))?.[1]);
    if (end < 0 || !Number.isInteger(length)) throw new Error(`${file}: no message at byte ${at}`);
    found.push(JSON.parse(bytes.subarray(end + 4, end + 4 + length).toString('utf8')));
    at = end + 4 + length;
  }
  return found;
}

let wrong = 0;
const seen = new Set();
function hold(check, value, what) {
  if (check?.(value)) return;
  // Of alternatives the one that went deepest says most.
  const deep = [...(check?.errors ?? [])].sort((a, b) => b.instancePath.length - a.instancePath.length)[0];
  const why = deep ? `${deep.instancePath} ${deep.message} ${JSON.stringify(deep.params)}` : 'no message of the protocol or of the table';
  console.log(`${what}: ${why}`);
  if (whose === 'ours' || !what.startsWith('editor')) wrong += 1;
}

const both = { editor: messages(fromEditor), server: messages(fromServer) };
for (const [who, said] of Object.entries(both)) {
  const other = both[who === 'editor' ? 'server' : 'editor'];
  const asked = new Map(other.filter((m) => m.method && m.id !== undefined).map((m) => [m.id, m.method]));
  for (const message of said) {
    if (message.jsonrpc !== '2.0') hold(() => false, message, `${who}: not JSON-RPC 2.0`);
    if (message.method !== undefined) {
      seen.add(message.method);
      const isAsked = message.id !== undefined;
      const shape = isAsked ? shapeOf('requests', message.method, 'params') : shapeOf('notices', message.method);
      hold(shape, message.params ?? null, `${who}: ${message.method}`);
    } else if (message.error !== undefined) {
      const { code, message: text } = message.error;
      hold(() => Number.isInteger(code) && typeof text === 'string', message, `${who}: an error`);
    } else {
      const method = asked.get(message.id);
      hold(method && shapeOf('requests', method, 'result'), message.result, `${who}: answer to ${method}`);
    }
  }
}
console.log(`${both.editor.length} and ${both.server.length} messages, ${wrong} wrong; methods: ${[...seen].sort().join(' ')}`);
process.exit(wrong === 0 ? 0 : 1);
