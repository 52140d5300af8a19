// Makes the JSON Schema of case files: kinds and their keys as the program tells them, sections by case-sections.mjs.
//   limcycle laws --json - | node tools/case-schema.mjs >docs/schema/case.json
import { readFileSync } from 'node:fs';
import { block_keys, by_kind, choice, definitions, diagram_of, ref, sections, table } from './case-sections.mjs';

const laws = JSON.parse(readFileSync(0, 'utf8')).laws;
const of_group = (group) => laws.filter((law) => law.group === group);
const name_of = (law) => `${law.group.replace(' ', '-')}-${law.kind}`;

/// As many entries as a list, or rows and columns as a matrix, may have: longest_list of cases/loader/sections/parameters.hpp.
const longest = { maxItems: 201 };
const longest_data = { maxItems: 100000 };

function bounds({ low, high, low_open, high_open }) {
  return {
    ...(low !== null && { [low_open ? 'exclusiveMinimum' : 'minimum']: low }),
    ...(high !== null && { [high_open ? 'exclusiveMaximum' : 'maximum']: high }),
  };
}

const with_unit = ({ meaning, unit }) => meaning + (unit === '1' ? '' : `, ${unit}`);

function parameter(p) {
  const description = with_unit(p) + (p.default_from === null ? '' : `; default as ${p.default_from}`);
  const more = p.default === null ? {} : { default: p.default };
  const one = { type: 'number', ...bounds(p.range) };
  const number_or_pair = { type: ['number', 'array'], items: { type: 'number' }, minItems: 2, maxItems: 2 };
  const row = { type: 'array', items: one, ...longest };
  switch (p.type) {
    case 'number': return { ...one, ...more, description };
    case 'choice': return choice(p.choices, description, more);
    case 'list': return { ...row, description };
    case 'text': return { type: 'string', minLength: 1, description };
    case 'matrix': return { type: 'array', items: row, ...(p.key === 'points' ? longest_data : longest), description };
    case 'complex list': return { type: 'array', items: number_or_pair, ...longest, description };
  }
  throw new Error(`${p.key} is a ${p.type}, which tools/case-schema.mjs does not know`);
}

/// A law over measured points is named so, or as the one over a formula with `curve = "table"`.
const table_suffix = /-table$/;
const kind_of = (law) => !table_suffix.test(law.kind) ? { kind: { const: law.kind } } :
  { kind: { enum: [law.kind.replace(table_suffix, ''), law.kind] }, curve: { const: 'table' } };

/// Its points stand in lists or in a file: read_curve.cpp.
const lists = ['velocities', 'forces'];
const column = { type: ['string', 'integer'], minLength: 1, minimum: 1, maximum: 10000 };
const file_keys = {
  file: { type: 'string', minLength: 1, description: 'CSV file with the points, in the place of the lists' },
  velocity: { ...column, description: 'its column of velocities: name, or number from 1' },
  force: { ...column, description: 'its column of forces: name, or number from 1' },
  scale: table('factors of the columns', {
    velocity: { type: 'number', not: { const: 0 } }, force: { type: 'number', not: { const: 0 } },
  }),
};
const has_points = (law) => table_suffix.test(law.kind);

/// Its matrices and lists stand in the case or in a MAT-file: read_matrices.cpp. Measured data stand in a file of columns too.
const is_measured = (law) => law.kind === 'frf';
const of_matrices = ({ type }) => ['list', 'matrix', 'complex list'].includes(type);
const has_matrices = (law) => ['plant', 'controller', 'block'].includes(law.group) && !is_measured(law) && law.parameters.some(of_matrices);
const mat_file = { file: { type: 'string', minLength: 1, description: 'MAT-file with the matrices and lists that the case does not give' } };

const keys_of = (law) => ({
  ...Object.fromEntries(law.parameters.map((p) => [p.key, parameter(p)])), ...(has_points(law) && file_keys),
  ...(has_matrices(law) && mat_file),
});
const required_of = (law) => law.parameters.filter((p) => p.required && !(has_points(law) && lists.includes(p.key)) &&
  !(has_matrices(law) && of_matrices(p))).map((p) => p.key);
const in_lists = ['velocities_minus', 'forces_minus', ...lists];
const rules_of = (law) => is_measured(law) ? { oneOf: [{ required: ['file'] }, { required: ['points'] }] } :
  has_matrices(law) ? {
    anyOf: [{ required: ['file'] }, { required: law.parameters.filter((p) => p.required && of_matrices(p)).map((p) => p.key) }],
  } : !has_points(law) ? {} : {
  if: { required: ['file'] },
  then: { properties: Object.fromEntries(in_lists.map((key) => [key, false])) },
  else: { required: lists, properties: { velocity: false, force: false, scale: false } },
};

const kind_definition = (law) =>
  table(law.equation, { ...kind_of(law), ...keys_of(law) }, ['kind', ...required_of(law)], rules_of(law));

const group = (description, some) =>
  by_kind(description, Object.fromEntries(some.map((law) => [law.kind, name_of(law)])),
    some.flatMap((law) => law.parameters.map((p) => [p.key, with_unit(p)])));

const friction = of_group('friction');
const elements = of_group('element');
// Two of the elements may act on the error too: ErrorElements of models/laws.hpp.
const both = elements.filter(({ kind }) => ['dead-zone', 'saturation'].includes(kind));

// Blocks of a diagram: every kind but the controllers other than pid, each once; of two of one name that with more keys.
const compensation = {
  kind: 'friction-compensation', group: 'compensation', equation: 'level sgn(v), to be added to a command',
  parameters: [{ key: 'level', unit: 'N', meaning: 'size of the force', type: 'number', required: true,
    range: { low: 0, low_open: false, high: null, high_open: false }, default: null, default_from: null }],
};
const in_diagram = new Map();
for (const law of [...laws.filter(({ group, kind }) => group !== 'controller' || kind === 'pid'), compensation])
  if (law.parameters.length >= (in_diagram.get(law.kind)?.parameters.length ?? 0)) in_diagram.set(law.kind, law);
// Linear blocks of one input and one output may run on a computer, with keys that pid has too. A transfer function
// among them is the plant of that name, which a sample_time makes a part of the controller.
const clock = ['sample_time', 'computation_delay', 'input_step', 'output_step'];
const of_clock = laws.find(({ group, kind }) => group === 'controller' && kind === 'pid').parameters
  .filter(({ key }) => clock.includes(key));
const may_be_sampled = ['gain', 'integrator', 'low-pass', 'lead-lag', 'notch', 'transfer-function'];
const block_definition = (law) => {
  const touches = law.group === 'friction' || law === compensation;
  const { input, on, between, name } = block_keys;
  const signals = law.kind === 'constant' ? {} : { ...(law !== compensation && { input }), ...(touches && { on, between }) };
  return table(law.equation, {
    name,
    ...kind_of(law),
    ...signals,
    ...keys_of(law),
    ...(may_be_sampled.includes(law.kind) && Object.fromEntries(of_clock.map((p) => [p.key, parameter(p)]))),
  }, ['name', 'kind', ...(touches || law.kind === 'constant' ? [] : ['input']), ...required_of(law)],
  { ...rules_of(law), ...(touches && { oneOf: ['input', 'on', 'between'].filter((key) => key in signals).map((key) => ({ required: [key] })) }) });
};

/// JSON in one line, and with what fits into a line of 120 in one.
function in_line(value) {
  if (value === null || typeof value !== 'object') return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(in_line).join(', ')}]`;
  return `{${Object.entries(value).map(([key, one]) => `"${key}": ${in_line(one)}`).join(', ')}}`;
}
function written(value, indent = '', taken = 0) {
  const line = in_line(value);
  if (value === null || typeof value !== 'object' || indent.length + taken + line.length < 120) return line;
  const inner = `${indent}  `;
  const [open, close] = Array.isArray(value) ? '[]' : '{}';
  const entries = Object.entries(value).map(([key, one]) =>
    Array.isArray(value) ? inner + written(one, inner) : `${inner}"${key}": ${written(one, inner, key.length + 4)}`);
  return `${open}\n${entries.join(',\n')}\n${indent}${close}`;
}

const remark =
  'Made by tools/case-schema --fix. What this refuses, the program refuses. Rules between values (Fs >= Fc, numbers ' +
  'that rise, names of states and of numbers, what fits together in a loop) are left to `limcycle check`';
const simulate_needs_plant = { simulate: { properties: { loop: { required: ['plant'] } } } };

const schema = {
  $schema: 'https://json-schema.org/draft/2020-12/schema',
  title: 'A case file of limcycle: TOML, read as JSON',
  ...table(remark, { ...sections, diagram: diagram_of(ref('block')) }, [], {
    oneOf: [
      { required: ['loop'] },
      { required: ['diagram'] },
      { required: ['identify'], properties: { loop: false, diagram: false } },
    ],
    dependentSchemas: simulate_needs_plant,
  }),
  $defs: {
    ...definitions,
    plant: group('From u - F to the position y', of_group('plant')),
    controller: group('From e = r - y to u', of_group('controller')),
    friction: group('Opposes the rubbing velocity of the plant', friction),
    'series-element': group('In series after the controller: plant input = element(u)', [...elements, ...friction]),
    error: group('On e, before the controller', [...of_group('error element'), ...both]),
    block: by_kind('A block of a diagram', Object.fromEntries([...in_diagram.keys()].sort().map((kind) =>
      [kind, `block-${kind}`])), [...in_diagram.values()].flatMap((law) => law.parameters.map((p) => [p.key, with_unit(p)]))),
    ...Object.fromEntries(laws.filter(({ group }) => group !== 'block').map((law) => [name_of(law), kind_definition(law)])),
    ...Object.fromEntries([...in_diagram].map(([kind, law]) => [`block-${kind}`, block_definition(law)])),
  },
};
console.log(written(schema));
