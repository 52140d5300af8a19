// Do JSON documents of limcycle follow docs/schema?
//   node tools/schema.mjs FILE...
// Tells what does not, with the place in the document; exit code 1 then.
import { readFileSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';

const folder = new URL('../docs/schema/', import.meta.url);

/// A function that says what is wrong with a document (a list of sentences, empty: nothing), by its own "command".
export function checker() {
  // Draft 2020-12; strict: a schema with a keyword that means nothing is refused too.
  const Ajv = createRequire(import.meta.url)('ajv/dist/2020').default;
  const ajv = new Ajv({ allErrors: false, strict: true, strictTypes: false, strictRequired: false, allowUnionTypes: true });
  const commands = new Map();
  for (const file of readdirSync(folder)) {
    ajv.addSchema(JSON.parse(readFileSync(new URL(file, folder), 'utf8')), file);
    if (!['definitions.json', 'case.json'].includes(file)) commands.set(file.replace('.json', ''), file);
  }
  return (document) => {
    const file = commands.get(document?.command);
    if (!file) return [`no schema for the command ${JSON.stringify(document?.command)}`];
    const follows = ajv.getSchema(file);
    if (follows(document)) return [];
    return follows.errors.map((e) => `${e.instancePath || '/'} ${e.message} ${JSON.stringify(e.params)}`);
  };
}

/// The document in a file. JSON knows neither NaN nor infinity: JSON.parse refuses them.
export const read = (file) => JSON.parse(readFileSync(file, 'utf8'));

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const check = checker();
  let wrong = 0;
  for (const file of process.argv.slice(2)) {
    let errors;
    try {
      errors = check(read(file));
    } catch (error) {
      errors = [error.message];
    }
    for (const error of errors) console.error(`${file}: ${error}`);
    wrong += errors.length > 0;
  }
  console.log(`tools/schema: ${process.argv.length - 2 - wrong} documents follow docs/schema, ${wrong} do not`);
  process.exit(wrong ? 1 : 0);
}
