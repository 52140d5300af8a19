// The sections of a case file as JSON Schema, for tools/case-schema.mjs: written out after cases/loader/sections/read_*.cpp, as no
// table of the program lists them. tests/case_schema_test.mjs holds them against the program.

const number = (description, more = {}) => ({ type: 'number', ...more, description });
const integer = (minimum, maximum, description, more = {}) =>
  ({ type: 'integer', minimum, maximum, ...more, description });
const text = (description, more = {}) => ({ type: 'string', ...more, description });
export const choice = (names, description, more = {}) => ({ enum: names, ...more, description });
const positive = { exclusiveMinimum: 0 };
const accuracy = { minimum: 1e-13, maximum: 0.1 };
export const ref = (name) => ({ $ref: `#/$defs/${name}` });

/// A table that knows these keys, and no other. `more`: keywords beside.
export const table = (description, properties, required = [], more = {}) => ({
  type: 'object',
  description,
  properties,
  ...(required.length > 0 && { required }),
  additionalProperties: false,
  ...more,
});

/// Keys with what they mean, from [key, meaning]: a key may mean something else in another kind.
function described(meanings) {
  const all = {};
  for (const [key, meaning] of meanings) (all[key] ??= new Set()).add(meaning);
  return Object.fromEntries(Object.entries(all).map(([key, set]) => [key, { description: [...set].join('; or ') }]));
}

/// With `curve = "table"` a kind stands for the one over measured points: "lugre" for "lugre-table".
const by_curve = (kind, kinds) => {
  const measured = kinds[`${kind}-table`];
  if (!measured) return ref(kinds[kind]);
  return { if: { properties: { curve: { const: 'table' } }, required: ['curve'] }, then: ref(measured), else: ref(kinds[kind]) };
};
/// A table whose `kind` says which of `kinds` (kind -> name of its definition) it follows. By "if" and not by "oneOf":
/// then a mistake is told as one of that kind. Not every editor looks behind "if": of a key it shows `meanings`.
export const by_kind = (description, kinds, meanings, type = 'object') => ({
  type,
  description,
  properties: { kind: choice(Object.keys(kinds), 'which'), ...described(meanings) },
  required: ['kind'],
  allOf: Object.keys(kinds).map((kind) => ({
    if: { type: 'object', properties: { kind: { const: kind } }, required: ['kind'] },
    then: by_curve(kind, kinds),
  })),
});

// ---- signals of time: cases/loader/sections/read_signal.cpp

const start = number('before which it is 0, s', { minimum: 0, default: 0 });
const rate = number('slope, 1/s');
const list = (description) =>
  ({ type: 'array', items: { type: 'number' }, minItems: 1, maxItems: 1_000_000, description });
const signal_kinds = {
  constant: { value: number('the constant') },
  step: { value: number('height of the step'), start },
  ramp: { rate, start },
  sine: { amplitude: number('height of the sine'), frequency: number('rad/s', positive), start },
  zigzag: {
    amplitude: number('height of the peaks', positive),
    rate: number('slope of the flanks, 1/s', positive),
    start,
  },
  table: {
    times: list('rising, s'),
    values: list('one for each of times; straight lines between them, constant beyond'),
  },
};
const signal_definition = (kind) => [
  `signal-${kind}`,
  table(`A ${kind} of time`, { kind: { const: kind }, ...signal_kinds[kind] },
    ['kind', ...Object.keys(signal_kinds[kind]).filter((key) => key !== 'start')]),
];
const signal_names = Object.fromEntries(Object.keys(signal_kinds).map((kind) => [kind, `signal-${kind}`]));
const signal_meanings = Object.values(signal_kinds).flatMap((keys) =>
  Object.entries(keys).map(([key, { description }]) => [key, description]));
const signal = by_kind('A signal of time: a number, or a table', signal_names, signal_meanings, ['number', 'object']);

// ---- sections: cases/loader/case.cpp, read_loop.cpp, read_methods.cpp, read_sensitivity.cpp, read_claims.cpp

const reference_of_loop = table('set-point r, in the unit of y: a number, or {kind = "ramp", rate}',
  { kind: { const: 'ramp' }, rate }, ['kind', 'rate'], { type: ['number', 'object'], default: 0 });

const loop = table('The loop, or one lone friction or element', {
  plant: ref('plant'),
  controller: ref('controller'),
  friction: ref('friction'),
  element: ref('series-element'),
  error: ref('error'),
  reference: reference_of_loop,
  load: number('a constant force on the plant, such as weight, N; it is added to u: A for a servo-drive', { default: 0 }),
}, [], {
  anyOf: ['friction', 'element', 'error', 'controller'].map((key) => ({ required: [key] })),
  if: { maxProperties: 1, anyOf: ['friction', 'element'].map((key) => ({ required: [key] })) },
  else: { required: ['plant'] },
});

/// Keys that are not those of a kind.
export const block_keys = {
  name: text('a letter, then letters, digits and _', { pattern: '^[A-Za-z_][A-Za-z0-9_]*$' }),
  input: {
    type: ['string', 'array'],
    items: { type: 'string' },
    minItems: 1,
    description: 'sum of signals, such as "r - axis.y"; a list for several inputs',
  },
  on: text('the plant that friction acts on'),
  between: {
    type: 'array',
    items: { type: 'string' },
    minItems: 2,
    maxItems: 2,
    description: 'the two plants between which friction acts',
  },
};
export const diagram_of = (block) => table('A loop of any structure, in place of [loop]', {
  output: text('the signal that is y, such as "axis.y"'),
  reference: reference_of_loop,
  block: { type: 'array', items: block, minItems: 1 },
}, ['output', 'block']);

const interval = (description) =>
  ({ type: 'array', items: { type: 'number', ...positive }, minItems: 2, maxItems: 2, description });

const axis = (description, range, spacing) =>
  table(`${description}: a number, a list, or {from, to, points, spacing}`, {
    from: number('first value', range),
    to: number('last value', range),
    points: integer(1, 1_000_000, 'how many'),
    spacing: choice(['log', 'linear'], 'how they are spaced', { default: spacing }),
  }, ['from', 'to', 'points'], {
    type: ['number', 'array', 'object'],
    ...range,
    items: { type: 'number', ...range },
    minItems: 1,
    maxItems: 1_000_000,
  });

const spread = table('How one number is spread', {
  path: text('which number of the case, such as "loop.friction.Fs"'),
  distribution: choice(['uniform', 'log-uniform', 'normal'], 'how', { default: 'uniform' }),
  from: number('least value, in the unit of the number'),
  to: number('largest value, in the unit of the number'),
  factor: number('in place of from and to: from value/factor to value times factor', { exclusiveMinimum: 1 }),
  mean: number('of "normal", in the unit of the number; default: the value in the case'),
  deviation: number('standard deviation of "normal", in the unit of the number', positive),
}, ['path'], {
  dependentSchemas: { factor: { properties: { from: false, to: false } } },
  if: { properties: { distribution: { const: 'normal' } }, required: ['distribution'] },
  then: { properties: { factor: false }, required: ['deviation'] },
  else: {
    properties: { mean: false, deviation: false },
    anyOf: [{ required: ['from', 'to'] }, { required: ['factor'] }],
  },
});
const spread_list = (description) => ({ type: 'array', items: ref('spread'), minItems: 1, maxItems: 200, description });

const of_df = ['gain.real', 'gain.imag', 'dissipation', 'mean'];
const quantities = [
  'period', 'amplitude', 'frequency', 'offset', 'first_harmonic', 'sticking_fraction', 'largest_multiplier', 'cycles',
  'hunts', ...of_df, 'passive', 'threshold.sigma2', 'state_bound', 'force_bound',
];
const claim = table('A claim of your own: quantity comparison formula', {
  id: text('a word', { pattern: '^[^ \t\n]+$' }),
  statement: text('for the reader'),
  source: text('for the reader'),
  quantity: choice(quantities, 'what it is about'),
  comparison: choice(['=', '<', '<=', '>', '>='], 'how they compare', { default: '=' }),
  formula: { type: ['string', 'number'], description: 'over the numbers of the case, such as "4*Fs/(pi*A)"' },
  tolerance: number('relative, of "="', { minimum: 1e-12, maximum: 10, default: 1e-6 }),
  expected: choice(['holds', 'fails'], 'the verdict that is expected', { default: 'holds' }),
  at: table('where a describing function is asked', {
    amplitude: number("of the element's input", positive),
    frequency: number('rad/s', positive),
    bias: number('of the input; of friction a mean velocity, m/s', { default: 0 }),
  }, ['amplitude', 'frequency']),
  over: spread_list('numbers that are drawn at random'),
  random: integer(0, 100_000, 'how often', { default: 10 }),
}, ['id', 'quantity', 'formula'], {
  dependentRequired: { random: ['over'] },
  allOf: [
    {
      if: { properties: { quantity: { enum: of_df } }, required: ['quantity'] },
      then: { required: ['at'] },
      else: { properties: { at: false } },
    },
    {
      if: { properties: { comparison: { enum: ['<', '<=', '>', '>='] } }, required: ['comparison'] },
      then: { properties: { tolerance: false } },
    },
  ],
});

const identified = ['coulomb', 'stribeck', 'dahl', 'lugre', 'elasto-plastic', 'gms'];
const column = (description) => ({ type: ['string', 'integer'], minimum: 1, maximum: 10_000, description });
/// Single numbers of the laws that can be identified.
const fitted_keys = [
  'Fc', 'Fs', 'Fc_minus', 'Fs_minus', 'vs', 'delta', 'sigma0', 'sigma1', 'sigma2', 'vd', 'zba_ratio', 'C', 'exponent',
];

const record = table('A file of measured friction', {
  kind: choice(
    ['steady-velocity', 'lag', 'pre-sliding', 'break-away', 'free', 'free-decay'], 'which experiment',
  ),
  file: text('relative to the folder of the case'),
  time: column('name or number of the column of times; default "time"'),
  position: column('of positions; default "position"'),
  velocity: column('of velocities; default "velocity"'),
  force: column('of friction forces, of kind free of applied ones; default "force"'),
  scale: table('factors of the columns', {
    time: number('of the times', positive),
    position: number('of the positions', { not: { const: 0 } }),
    velocity: number('of the velocities', { not: { const: 0 } }),
    force: number('of the forces', { not: { const: 0 } }),
  }),
  skip: number('from the first row, without comparison, s', { minimum: 0, default: 0 }),
  force_limit: number('of the force sensor: rows at it or beyond are not compared, N', positive),
  hold: choice(['linear', 'zero-order'], 'how the applied force of kind free goes on from row to row', { default: 'linear' }),
  weight: column('of weights, each 1 over the variance of its row; default: all alike'),
  loss: choice(['squares', 'huber'], 'how rows count that are far off', { default: 'squares' }),
}, ['kind', 'file']);

export const sections = {
  title: text("a line for the reader; default: the file's name"),
  loop: ref('loop'),
  units: table('How texts, pages and pictures show y', {
    y: {
      type: ['string', 'object'],
      description: 'a symbol such as "mm", or {symbol, per_si}',
      properties: {
        symbol: text('as it is shown', { minLength: 1, maxLength: 12 }),
        per_si: number('y in this unit over y in SI units', positive),
      },
      required: ['symbol', 'per_si'],
      additionalProperties: false,
    },
  }, ['y']),
  search: table('Where predictions are looked for', {
    amplitude: interval("[from, to] of the element's input; with friction of the rubbing displacement, m"),
    frequency: interval('[from, to], rad/s'),
  }, ['amplitude', 'frequency']),
  predict: table('How cycles are predicted and found', {
    methods: {
      type: 'array',
      items: { enum: ['describing-function', 'composite-describing-function', 'harmonic-balance'] },
      minItems: 1,
      description: 'which predict; default all',
    },
    starts: integer(1, 1000, 'simulations from how many displaced starts', { default: 4 }),
    accuracy: number('wanted relative error of period and amplitude', { ...accuracy, default: 1e-8 }),
  }),
  df: table('Where describing functions are wanted', {
    amplitude: axis("of the element's input", positive, 'log'),
    frequency: axis('rad/s', positive, 'log'),
    bias: axis('of the input; of friction a mean velocity, m/s', {}, 'linear'),
    harmonics: integer(1, 1000, 'how many are told', { default: 7 }),
    accuracy: number('wanted relative error of N', { ...accuracy, default: 1e-6 }),
    method: choice(['auto', 'fft', 'quadrature'], 'how they are computed', { default: 'auto' }),
  }, ['amplitude', 'frequency']),
  simulate: table('A run in time', {
    duration: number('how long, s', positive),
    initial: {
      type: 'object',
      additionalProperties: { type: 'number' },
      description: 'states to begin from, by the names that `limcycle check` lists; default all 0',
    },
    force: ref('signal'),
    reference: ref('signal'),
    stepper: choice(['auto', 'exact', 'rodas5p', 'dopri5', 'fehlberg78', 'cash-karp54'], 'how it is computed',
      { default: 'auto' }),
    rtol: number('relative tolerance of a step', { ...accuracy, default: 1e-7 }),
    sample: number('from one row to the next, s; default a thousandth of the duration', positive),
  }, ['duration']),
  dissipativity: table('Speeds that a question of energy is about', {
    speed: number('up to which the force is bounded, m/s', { ...positive, default: 1 }),
    top_speed: number('of the motions that may take energy out, m/s; default any', positive),
  }),
  sensitivity: table('How numbers are spread', {
    parameters: spread_list('which numbers, and how'),
    correlation: {
      type: 'array',
      items: table('Two numbers that go together', {
        between: { type: 'array', items: text('a number of the list of parameters'), minItems: 2, maxItems: 2 },
        value: number('correlation of their normal scores', { exclusiveMinimum: -1, exclusiveMaximum: 1 }),
      }, ['between', 'value']),
      description: 'of numbers that do not vary independently',
    },
    samples: integer(1, 100_000_000, 'base samples of the Sobol study', { default: 256 }),
    seed: integer(0, 2147483647, 'of everything random', { default: 0 }),
  }, ['parameters']),
  identify: table('Friction laws to be fitted to records', {
    law: {
      description: 'which law, or a list of them, which is ranked; default all',
      oneOf: [
        { enum: identified },
        { type: 'array', items: { enum: identified }, minItems: 1, uniqueItems: true },
      ],
    },
    free: { type: 'array', items: { enum: fitted_keys }, description: 'keys fitted although they have a default' },
    fixed: { type: 'object', propertyNames: { enum: fitted_keys }, additionalProperties: { type: 'number', minimum: 0 }, description: 'keys held at a value' },
    elements: integer(1, 12, 'parallel elements of gms', { default: 4 }),
    record: { type: 'array', items: ref('record'), minItems: 1, maxItems: 100, description: 'files of measured friction' },
  }, ['record']),
  claim: { type: 'array', items: ref('claim'), maxItems: 1000, description: 'Claims of your own' },
};

/// What `sections` refer to, but for the kinds.
export const definitions = {
  loop,
  signal,
  spread,
  record,
  claim,
  ...Object.fromEntries(Object.keys(signal_kinds).map(signal_definition)),
};
