// Are wrong documents refused? Of each file given, copies are made that are wrong in one place: a key is missing, a key
// is there that nobody knows, or a value has another type. Each has to be refused. (Of a list, the first and the last
// entry are spoiled.)
//   node tests/schema_test.mjs FILE...
import { checker, read } from '../tools/schema.mjs';

const check = checker();

// What may be missing or free, by its place: objects with keys of their own, and keys that are only sometimes there.
const free_keys = [/^experiment\/experiments\/\d+\/rows\/\d+$/];
const may_lack = [
  /^sensitivity\/without_answer\/\w+$/,
  /^precision\/reference\/\d+\/(period|amplitude|independent)$/,
  /^experiment\/experiments\/\d+\/rows\/\d+\/(?!law$|setting$)/,
];
// Values that are a number or a text.
const either = [/^dissipativity\/passive_up_to_speed$/, /^laws\/laws\/\d+\/parameters\/\d+\/default$/];
const matches = (patterns, place) => patterns.some((pattern) => pattern.test(place));

/// Runs `visit(holder, key, place)` for every value below `node`.
function visit_all(node, place, visit) {
  if (node === null || typeof node !== 'object') return;
  const keys = Array.isArray(node) ? [...new Set([0, node.length - 1])].filter((i) => i in node) : Object.keys(node);
  for (const key of keys) {
    visit(node, key, `${place}/${key}`);
    visit_all(node[key], `${place}/${key}`, visit);
  }
}

const accepted = [];
let tried = 0;
function must_fail(document, what) {
  ++tried;
  if (check(document).length === 0) accepted.push(what);
}

function spoil(document) {
  visit_all(document, document.command, (holder, key, place) => {
    const value = holder[key];
    if (!Array.isArray(holder) && !matches(may_lack, place)) {
      delete holder[key];
      must_fail(document, `${place} is missing`);
    }
    for (const wrong of [typeof value === 'string' ? 12345 : 'no such word', { no: 'such object' }]) {
      holder[key] = wrong;
      // Where there is nothing, or either may be, a word need not be wrong.
      const may_be = typeof wrong !== 'object' && (matches(either, place) || (value === null && wrong !== 12345));
      if (!may_be) must_fail(document, `${place} is ${JSON.stringify(wrong)}`);
    }
    holder[key] = value;
    if (value !== null && typeof value === 'object' && !Array.isArray(value) && !matches(free_keys, place)) {
      value.unknown_key = 1;
      must_fail(document, `${place} has a key that nobody knows`);
      delete value.unknown_key;
    }
  });
  document.unknown_key = 1;
  must_fail(document, `${document.command} has a key that nobody knows`);
  delete document.unknown_key;
}

for (const file of process.argv.slice(2)) spoil(read(file));
for (const what of accepted.slice(0, 20)) console.error(`accepted, though ${what}`);
console.log(`tests/schema_test: of ${tried} spoiled documents ${tried - accepted.length} are refused`);
process.exit(accepted.length === 0 && tried > 0 ? 0 : 1);
