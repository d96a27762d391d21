// Whether src/grammar.json is what grammar.js says: evaluates the one as the generator does and compares it with the other.
// The generator itself, a program of its own, is not needed for that.
import assert from 'node:assert'
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'

const folder = process.argv[2]

function rule(value) {
  if (typeof value === 'string') return { type: 'STRING', value }
  if (value instanceof RegExp) return { type: 'PATTERN', value: value.source }
  if (typeof value?.type === 'string') return value
  throw new TypeError(`no rule: ${value}`)
}
const with_content = (type) => (content) => ({ type, content: rule(content) })
const with_members = (type) => (...members) => ({ type, members: members.map(rule) })

const blank = () => ({ type: 'BLANK' })
const choice = with_members('CHOICE')
const token = with_content('TOKEN')
token.immediate = with_content('IMMEDIATE_TOKEN')
Object.assign(globalThis, {
  blank, choice, token,
  seq: with_members('SEQ'),
  repeat: with_content('REPEAT'),
  repeat1: with_content('REPEAT1'),
  optional: (value) => choice(value, blank()),
  field: (name, content) => ({ type: 'FIELD', name, content: rule(content) }),
  prec: (value, content) => ({ type: 'PREC', value, content: rule(content) }),
  alias: (content, as) => {
    const shown = rule(as)
    const named = shown.type === 'SYMBOL'
    return { type: 'ALIAS', content: rule(content), named, value: named ? shown.name : shown.value }
  },
  grammar: (given) => {
    const $ = new Proxy({}, { get: (_, name) => ({ type: 'SYMBOL', name }) })
    return {
      name: given.name,
      word: given.word($).name,
      rules: Object.fromEntries(Object.entries(given.rules).map(([name, made]) => [name, rule(made($))])),
      extras: given.extras($).map(rule),
      conflicts: given.conflicts($).map((set) => set.map((symbol) => symbol.name)),
      precedences: [],
      externals: given.externals($).map(rule),
      inline: [],
      supertypes: [],
    }
  },
})

const said = createRequire(import.meta.url)(`${folder}/grammar.js`)
assert.deepStrictEqual(JSON.parse(readFileSync(`${folder}/src/grammar.json`, 'utf8')), JSON.parse(JSON.stringify(said)))
