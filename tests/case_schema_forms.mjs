// For tests/case_schema_test.mjs: every form that a section of a case may have, and ways to spoil a case.

const also = (text) => (base) => `${base}\n${text}\n`;

/// Name -> a function that gives a case that form. The case is that of `limcycle new`: a mass, pid and lugre.
export const forms = {
  'reference: a ramp': (base) =>
    base.replace(/^# reference = .*$/m, 'load = 0.1\nreference = {kind = "ramp", rate = 0.01}'),
  'integers for numbers': (base) => base.replace(/^mass = .*$/m, 'mass = 2'),
  'signals: constant and step': also(`[simulate]
    duration = 10.0
    initial = {y = 0.1, v = 1}
    force = {kind = "constant", value = 1.0}
    reference = {kind = "step", value = 1, start = 1.0}
    stepper = "rodas5p"
    rtol = 1e-6
    sample = 0.1`),
  'signals: ramp and sine': also(`[simulate]
    duration = 10
    force = {kind = "ramp", rate = 1.0, start = 1.0}
    reference = {kind = "sine", amplitude = 1.0, frequency = 2.0, start = 1.0}`),
  'signals: zigzag and table': also(`[simulate]
    duration = 10.0
    force = {kind = "zigzag", amplitude = 1.0, rate = 2.0, start = 1.0}
    reference = {kind = "table", times = [0.0, 1], values = [0.0, 1.0]}`),
  'signals: numbers': also('[simulate]\nduration = 10.0\nforce = 1.0\nreference = 2'),
  'axes: tables': also(`[df]
    amplitude = {from = 1e-5, to = 1e-3, points = 5, spacing = "log"}
    frequency = {from = 1.0, to = 10.0, points = 5}
    bias = {from = -1.0, to = 1.0, points = 3, spacing = "linear"}
    harmonics = 3
    accuracy = 1e-5
    method = "quadrature"`),
  'axes: lists and numbers': also('[df]\namplitude = [1e-5, 1e-3]\nfrequency = 1.0\nbias = [-1, 0.5]'),
  'identify: beside a loop': also(`[identify]\nlaw = ["lugre", "gms"]\nfree = ["delta"]\nfixed = {sigma2 = 0.0}\nelements = 3
    [[identify.record]]
    kind = "pre-sliding"
    file = "a.csv"
    time = 1
    position = "x"
    velocity = "v"
    force = 4
    scale = {time = 1.0, position = 1e-3, velocity = -1.0, force = 2.0}
    skip = 0.5
    weight = "w"
    loss = "huber"
    force_limit = 10.0`),
  'identify: alone': () => '[identify]\nlaw = "lugre"\n[[identify.record]]\nkind = "lag"\nfile = "a.csv"\n',
  'identify: a driven rig': also('[identify]\n[[identify.record]]\nkind = "free"\nfile = "a.csv"\nhold = "zero-order"'),
  'units: a symbol': also('[units]\ny = "mm"'),
  'units: a table': also('[units]\ny = {symbol = "in", per_si = 39.37}'),
  'a diagram with every linear block': () => `[diagram]
    output = "axis.y"
    reference = {kind = "ramp", rate = 0.0}
    ${[
      'kind = "gain"\ngain = 2.0\ninput = "r - late"',
      'kind = "sum"\ninput = "gain + 0.5*weight"',
      'kind = "integrator"\ngain = 1.0\nleak = 0.1\ninput = "sum"',
      'kind = "lead-lag"\nlead = 0.1\nlag = 0.01\ninput = "sum + integrator"',
      'kind = "notch"\nfrequency = 50.0\ndamping = 0.5\ndepth = 0.1\ninput = "lead_lag"',
      'kind = "low-pass"\ntime_constant = 0.01\ngain = 1.0\ninput = "notch + proper"',
      'kind = "transfer-function"\nnumerator = [1.0, 2.0]\ndenominator = [1.0, 3.0]\ninput = "sum"',
      'kind = "state-space"\nA = [[-1.0]]\nB = [[1.0, 0.5]]\nC = [[1.0]]\nD = [[0.0, 0.0]]\ninput = ["low_pass", "weight"]',
      'kind = "constant"\nvalue = 0.0',
      'kind = "delay"\ndelay = 0.01\ninput = "axis.y"',
    ].map((keys, i) => `[[diagram.block]]\nname = "${
      ['gain', 'sum', 'integrator', 'lead_lag', 'notch', 'low_pass', 'proper', 'space', 'weight', 'late'][i]}"\n${keys}`)
      .join('\n')}
    [[diagram.block]]
    name = "axis"
    kind = "mass"
    mass = 1.0
    input = "space"
    [[diagram.block]]
    name = "guide"
    kind = "coulomb"
    on = "axis"
    Fc = 1.0`.replace('{kind = "ramp", rate = 0.0}', '0.5'),
  'a diagram with sampled blocks': () => `[diagram]
    output = "axis.y"
    [[diagram.block]]
    name = "pd"
    kind = "pid"
    input = "r - axis.y"
    kp = 30.0
    kd = 6.0
    sample_time = 0.002
    [[diagram.block]]
    name = "filter"
    kind = "low-pass"
    input = "pd"
    time_constant = 0.01
    sample_time = 0.002
    computation_delay = 0.001
    input_step = 0.0
    output_step = 0.01
    [[diagram.block]]
    name = "shape"
    kind = "transfer-function"
    input = "filter"
    numerator = [1.0]
    denominator = [0.01, 1.0]
    sample_time = 0.004
    [[diagram.block]]
    name = "axis"
    kind = "mass"
    mass = 1.0
    input = "shape"
    [[diagram.block]]
    name = "guide"
    kind = "coulomb"
    on = "axis"
    Fc = 1.0`,
  'friction between two plants': () => `[diagram]
    output = "b.y"
    [[diagram.block]]
    name = "a"
    kind = "mass"
    mass = 1.0
    stiffness = 2.0
    input = "b.v"
    [[diagram.block]]
    name = "b"
    kind = "mass"
    mass = 1.0
    stiffness = 3.0
    input = "r - a"
    [[diagram.block]]
    name = "rub"
    kind = "coulomb"
    between = ["a", "b"]
    Fc = 1.0`,
  'search, predict, dissipativity': also(`[search]
    amplitude = [1e-6, 1.0]
    frequency = [0.01, 1000.0]
    [predict]
    methods = ["describing-function", "harmonic-balance"]
    starts = 2
    accuracy = 1e-7
    [dissipativity]
    speed = 2.0
    top_speed = 0.5`),
  spread: also(`[sensitivity]
    parameters = [
      {path = "loop.friction.Fs", from = 1.4, to = 1.6},
      {path = "loop.friction.Fc", distribution = "log-uniform", factor = 1.1},
      {path = "loop.plant.mass", distribution = "normal", mean = 1.0, deviation = 0.1, from = 0.5, to = 2.0},
      {path = "loop.controller.kp", distribution = "uniform", factor = 2.0},
    ]
    correlation = [{between = ["loop.friction.Fs", "loop.plant.mass"], value = -0.5}]
    samples = 16
    seed = 1`),
  claims: also(`[[claim]]
    id = "one"
    statement = "for the reader"
    source = "nobody"
    quantity = "period"
    comparison = "="
    formula = 1.5
    tolerance = 0.1
    expected = "fails"
    [[claim]]
    id = "two"
    quantity = "gain.imag"
    comparison = "<="
    formula = "Fs/A"
    at = {amplitude = 1e-3, frequency = 1.0, bias = 0.0}
    over = [{path = "loop.friction.Fs", factor = 1.1}, {path = "at.amplitude", from = 1e-4, to = 1e-3}]
    random = 3
    [[claim]]
    id = "three"
    quantity = "passive"
    formula = "0"`),
};

const type_of = (value) => (Array.isArray(value) ? 'list' : typeof value === 'bigint' ? 'number' : typeof value);
const is_table = (value) => type_of(value) === 'object';

// What the schema leaves to the program: states by name; texts of which it wants more than that they are texts, names of
// blocks and sums of signals among them; and a formula may be a number too.
const states = /^simulate\.initial\b/;
const free_text = /\.(path|formula|between\[\])$|^diagram\.(output$|block\[\]\(.*\)\.(input|on|between))/;
const formula = /\.formula$/;
const always = () => true;
const never = () => false;

/// Whether the program names the range of one number.
const range_rule = (said) => /must be (>=?|<=?) [-\d.e]+( [^:]*)?$|must be in -?\d+ \.\. \d+/m.test(said);

/// Copies of a case that are wrong, or may be, in one place each: `what`, `make()`, `must(said)`: whether the schema
/// has to refuse if the program says so, and `place`, where it is. make(VALUE) has that value in the place.
export function* spoiled(document) {
  for (const { path, label } of places(document)) {
    const value = at(document, path);
    const one = (what, must, change) => ({
      what: `${label} ${what}`,
      must,
      place: path.map((key) => `/${key}`).join(''),
      make: (instead) => {
        const copy = structuredClone(document);
        const [holder, key] = [at(copy, path.slice(0, -1)), path.at(-1)];
        if (instead === undefined) change(holder, key);
        else holder[key] = instead;
        return copy;
      },
    });
    const put = (wrong) => (holder, key) => { holder[key] = wrong; };
    if (is_table(value)) {
      const must = states.test(label) ? never : always;
      yield one('has an unknown key', must, (holder, key) => { holder[key].unknown_key = 1n; });
    }
    for (const wrong of ['no-such-word', 12345n, true, {}, [], ['no-such-word'], NaN, Infinity]) {
      const word = wrong === 'no-such-word';
      const same = type_of(wrong) === type_of(value) && !word && Number.isFinite(Number(wrong));
      const must = word && free_text.test(label) ? never : same || formula.test(label) ? range_rule : always;
      yield one(`= ${typeof wrong === 'object' ? JSON.stringify(wrong) : wrong}`, must, put(wrong));
    }
    if (type_of(value) === 'number')
      for (const wrong of [-1, 0, 0.5, 1e9, -1n, 0n]) yield one(`= ${wrong} (${typeof wrong})`, range_rule, put(wrong));
    if (!Array.isArray(at(document, path.slice(0, -1))))
      yield one('is missing', (said) => / is required/.test(said), (holder, key) => { delete holder[key]; });
  }
  yield {
    what: 'the file has an unknown key',
    must: always,
    place: '',
    make: () => ({ ...structuredClone(document), unknown_key: 1n }),
  };
}

const at = (document, path) => path.reduce((holder, key) => holder[key], document);

/// Every key, every table of a list and the first of other entries, as a path and in words that name kinds on the way.
function* places(node, path = [], label = '') {
  if (Array.isArray(node)) {
    for (let i = 0; i < node.length && (i === 0 || is_table(node[i])); ++i) yield* place(node, i, path, `${label}[]`);
  } else if (is_table(node)) {
    const kind = node.kind ?? node.distribution ?? node.quantity;
    const here = label + (typeof kind === 'string' ? `(${kind})` : '');
    for (const key of Object.keys(node)) {
      const holder = key === 'kind' ? label : here;
      yield* place(node, key, path, holder === '' ? key : `${holder}.${key}`);
    }
  }
}
function* place(node, key, path, label) {
  yield { path: [...path, key], label };
  yield* places(node[key], [...path, key], label);
}
