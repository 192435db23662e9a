// Compares the schemas `foxglove.*` in an MCAP file with those of npm @foxglove/schemas: messages, names, numbers, types.
//
//   npm ci && node compare_schemas.mjs SCENE.mcap      prints the messages that agree; exit 1 and a line for each difference
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import { McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers, protobufFromBinaryDescriptor } from "@mcap/support";

const { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } = createRequire(import.meta.url)(
  "@foxglove/schemas/internal",
);

const path = process.argv[2];
if (path === undefined) {
  console.error("usage: node compare_schemas.mjs SCENE.mcap");
  process.exit(2);
}

// Lines such as "1: repeated Point3 points" of a message of the package.
function published(name) {
  const enums = Object.values(foxgloveEnumSchemas).filter((one) => one.parentSchemaName === name);
  const text = generateProto(foxgloveMessageSchemas[name], enums);
  const fields = text.matchAll(/^ {2}(?:(repeated) )?([\w.]+) (\w+) = (\d+);/gm);
  return [
    ...[...fields].map(([, repeated, type, field, number]) => line(number, repeated, type, field)),
    ...enums.flatMap((one) => one.values.map((value) => `${one.protobufEnumName}: ${value.value} ${value.name}`)),
  ].sort();
}

function found(type) {
  return [
    ...type.fieldsArray.map((field) => line(field.id, field.repeated ? "repeated" : undefined, field.type, field.name)),
    ...type.nestedArray.flatMap((one) =>
      Object.entries(one.values).map(([name, value]) => `${one.name}: ${value} ${name}`),
    ),
  ].sort();
}

function line(number, repeated, type, field) {
  return `${number}: ${repeated === undefined ? "" : "repeated "}${type.split(".").at(-1)} ${field}`;
}

const reader = new McapStreamReader({ decompressHandlers: await loadDecompressHandlers(), validateCrcs: true });
reader.append(readFileSync(path));
const agree = new Set();
const differences = new Set();
for (let record; (record = reader.nextRecord()) !== undefined; ) {
  if (record.type !== "Schema" || !record.name.startsWith("foxglove.")) {
    continue;
  }
  const root = protobufFromBinaryDescriptor(record.data);
  root.resolveAll();
  for (const type of root.lookup("foxglove").nestedArray) {
    const [ours, theirs] = [found(type), foxgloveMessageSchemas[type.name] === undefined ? [] : published(type.name)];
    const apart = [...ours.filter((one) => !theirs.includes(one)), ...theirs.filter((one) => !ours.includes(one))];
    apart.forEach((one) => differences.add(`${type.name}: ${one}`));
    if (apart.length === 0) {
      agree.add(type.name);
    }
  }
}
differences.forEach((one) => console.error(`${path}: differs from the package: ${one}`));
console.log([...agree].sort().join(" "));
process.exitCode = differences.size > 0 || agree.size === 0 ? 1 : 0;
