// Does docs/schema/case.json accept what the program accepts, and refuse with it what can be told of one value?
//   node tests/case_schema_test.mjs PROGRAM [--all]
// Cases of the repository, cases of `limcycle new` and every form of a section have to pass. Then they are spoiled in
// one place each, and the program says of some hundred (--all: of each) whether it refuses too.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { parse as parse_toml, stringify } from 'smol-toml';
import { forms, spoiled } from './case_schema_forms.mjs';

const [program, all] = process.argv.slice(2);
const root = new URL('..', import.meta.url).pathname;
const sample = 60;

const schema = JSON.parse(readFileSync(join(root, 'docs/schema/case.json'), 'utf8'));
const Ajv = createRequire(import.meta.url)('ajv/dist/2020').default;
const options = { allErrors: true, strict: true, strictTypes: false, strictRequired: false, allowUnionTypes: true };
const follows = new Ajv(options).compile(schema);

// Integers of TOML are BigInt, so that a case is written again with the types that it was read with.
const parse = (text) => parse_toml(text, { integersAsBigInt: true });
const written = (document) => stringify(document, { numbersAsFloat: true });

/// A case as JSON has it.
function plain(value) {
  if (typeof value === 'bigint') return Number(value);
  if (Array.isArray(value)) return value.map(plain);
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, plain(one)]));
}

const errors = (document) => (follows(plain(document)) ? [] : follows.errors);
const sentence = (error) => `${error.instancePath || '/'} ${error.message} ${JSON.stringify(error.params)}`;

const folder = mkdtempSync(join(tmpdir(), 'case_schema_'));
process.on('exit', () => rmSync(folder, { recursive: true }));
let calls = 0;

function run(...argv) {
  ++calls;
  const { status, stdout, stderr, error } = spawnSync(program, argv, { encoding: 'utf8' });
  if (error) throw error;
  if (status !== 0 && status !== 2) throw new Error(`exit code ${status} of ${argv.join(' ')}\n${stderr}`);
  return { refused: status === 2, stdout, stderr };
}

/// What the program says against a case; empty: nothing.
function complaint(text) {
  const file = join(folder, 'case.toml');
  writeFileSync(file, text);
  const { refused, stderr } = run('check', file, '--quiet');
  return refused ? stderr : '';
}

const wrong = [];
const expect = (holds, what) => holds || wrong.push(what);

// ---- what is valid passes

const cases = readdirSync(join(root, 'cases'), { recursive: true }).filter((file) => file.endsWith('.toml')).sort();
const valid = cases.map((file) => ({ name: `cases/${file}`, text: readFileSync(join(root, 'cases', file), 'utf8') }));

const laws = JSON.parse(run('laws', '--json', '-').stdout).laws;
const kinds = (group) => laws.filter((law) => law.group === group).map((law) => law.kind);
const wanted = [
  ...kinds('plant').map((kind) => ['--plant', kind]),
  ...kinds('plant').map((kind) => ['--plant', kind, '--controller', 'none', '--element', 'relay']),
  ...kinds('controller').map((kind) => ['--controller', kind]),
  ...kinds('friction').map((kind) => ['--friction', kind]),
  ...kinds('friction').map((kind) => ['--friction', 'none', '--element', kind]),
  ...kinds('element').map((kind) => ['--element', kind]),
  ...[...kinds('error element'), 'dead-zone', 'saturation'].map((kind) => ['--error', kind]),
  ['--all'],
  ['--diagram'],
];
/// With the optional keys too, which stand there as comments.
const in_full = (text) => text.replace(/^# (\w+ = [-\d.["{t][^;]*)$/gm, '$1');
let made = 0;
for (const argv of wanted) {
  const { refused, stdout } = run('new', ...argv);
  if (refused) continue; // these parts make no loop
  ++made;
  valid.push({ name: `limcycle new ${argv.join(' ')}`, text: stdout });
  const full = in_full(stdout);
  if (full !== stdout && !complaint(full)) valid.push({ name: `limcycle new ${argv.join(' ')}, in full`, text: full });
}
const base = run('new').stdout;
for (const [name, change] of Object.entries(forms)) {
  const text = change(base);
  expect(!complaint(text), `the program refuses the form "${name}": ${complaint(text)}`);
  valid.push({ name, text });
}

for (const one of valid) {
  one.document = parse(one.text);
  expect(errors(one.document).length === 0, `${one.name} is refused: ${errors(one.document).map(sentence)[0]}`);
}
for (const { group, kind } of laws) {
  const parts = (document) => [...Object.values(document.loop ?? {}), ...(document.diagram?.block ?? [])];
  const kind_of = (part) => (part.curve === 'table' ? `${part.kind}-table` : part.kind);
  const seen = valid.some(({ document }) => parts(document).some((part) => kind_of(part) === kind));
  expect(seen, `no case has the ${group} ${kind}`);
}

// ---- what is spoiled is refused by both

const unique = new Map();
for (const { name, document } of valid)
  for (const copy of spoiled(document)) {
    // What a loop may lack depends on what else it has.
    const key = /^loop\.\w+ is missing/.test(copy.what) ? `${copy.what} of ${Object.keys(document.loop ?? {})}` : copy.what;
    if (!unique.has(key)) unique.set(key, { ...copy, name });
  }

/// A fixed order that has nothing to do with what is there.
function shuffled(text) {
  let hash = 2166136261;
  for (const letter of text) hash = Math.imul(hash ^ letter.charCodeAt(0), 16777619);
  hash = Math.imul(hash ^ (hash >>> 15), 0x2c1b3c6d);
  return (hash ^ (hash >>> 12)) >>> 0;
}
const order = [...unique.values()].sort((a, b) => shuffled(a.what) - shuffled(b.what));
// The keys of kinds come from the tables of the program, sections were written by hand: of these more are asked.
const of_kind = ({ what }) => /^loop\.\w+\(/.test(what);
const plain_mistake = ({ what }) => /(= no-such-word|= -1 \(bigint\)|is missing|an unknown key)$/.test(what);
const sections = order.filter((one) => !of_kind(one));
const some = [
  ...order.filter(of_kind).slice(0, sample),
  ...sections.filter(plain_mistake),
  ...sections.filter((one) => !plain_mistake(one)).slice(0, sample),
];

/// The words that a refusal tells to be known, in order.
function words_of(said) {
  const words = said.match(/must be one of (".*")|known: ([a-z, -]+)/);
  return words && (words[1] ?? words[2]).replaceAll('"', '').split(', ').sort();
}

/// The bounds that it tells to be in the range.
function bounds_of(said) {
  const integers = said.match(/must be in (-?\d+) \.\. (-?\d+)/);
  if (integers) return integers.slice(1).map(BigInt);
  return [...said.matchAll(/(?:must be|and) [<>]= (-?[\d.e-]*\d)/g)].map(([, bound]) => Number(bound));
}

let asked = 0;
let both = 0;
for (const { what, make, must, name, place } of all === '--all' ? order : some) {
  ++asked;
  const document = make();
  const found = errors(document);
  const said = complaint(written(document));
  const where = `${what} in ${name}`;
  both += found.length > 0 && said !== '';
  if (found.length > 0) expect(said, `the program accepts: ${where}; the schema says: ${sentence(found[0])}`);
  else if (said) expect(!must(said), `the schema accepts: ${where}; the program says: ${said}`);

  // What the program names in its place is what the schema knows there.
  const here = found.find(({ instancePath, keyword }) => instancePath === place && /^(enum|const)$/.test(keyword));
  const words = words_of(said);
  if (words && here) {
    const known = [here.params.allowedValues ?? here.params.allowedValue].flat();
    expect(known.sort().join() === words.join(), `the schema knows ${known}: ${where}; the program says: ${said}`);
  }
  for (const bound of bounds_of(said)) {
    const of_bound = ({ instancePath, keyword }) => instancePath === place && /imum$/i.test(keyword);
    expect(!errors(make(bound)).some(of_bound), `the schema refuses ${bound}: ${where}; the program says: ${said}`);
  }
}

// ---- no key is forgotten

const is_leaf = (node) => node === null || typeof node !== 'object';
const below = (node) => (is_leaf(node) ? [] : [node, ...Object.values(node).flatMap(below)]);
const known = new Set(below(schema).flatMap((node) => Object.keys(node.properties ?? {})));
const tried = new Set(below(valid.map(({ document }) => document)).flatMap(Object.keys));
const readers = readdirSync(join(root, 'cases/loader/sections')).filter((name) => /^read_.*\.cpp$/.test(name));
for (const file of ['loader/case.cpp', ...readers.map((name) => `loader/sections/${name}`)])
  for (const [, keys] of readFileSync(join(root, 'cases', file), 'utf8').matchAll(/allow\(\{([^}]*)\}/g))
    for (const [, key] of keys.matchAll(/"([^"]+)"/g)) {
      expect(known.has(key), `the schema does not know the key ${key} of cases/${file}`);
      expect(tried.has(key), `tests/case_schema_forms.mjs has no form with the key ${key} of cases/${file}`);
    }

for (const what of wrong.slice(0, 20)) console.error(what.trim());
console.log(`tests/case_schema_test: ${valid.length} cases pass, ${made} of them made anew; of ${unique.size} ` +
  `spoiled ones ${asked} are asked of the program, and both refuse ${both}; ${wrong.length} mistakes, ${calls} calls`);
process.exit(wrong.length === 0 && made > 0 && both > asked / 2 ? 0 : 1);
