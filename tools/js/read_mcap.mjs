// Opens a log with the official MCAP readers and prints what they found as JSON, keys sorted.
//
//   npm ci && node read_mcap.mjs LOG.mcap
//   {"counts":{"/can_frame":12,...},"attachments":{"cluster.yaml":812},"metadata":{...},"first":{"/track":{...},...}}
//
// The stream reader goes over every record and every checksum; the indexed reader seeks through the summary and
// reads in order of log time. Both must find the same messages as the statistics state. `first` is each topic's
// first message as its schema in the file decodes it. Exit 1 with a sentence where anything does not hold.
import { open } from "node:fs/promises";

import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers, protobufFromBinaryDescriptor } from "@mcap/support";

const path = process.argv[2];
if (path === undefined) {
  console.error("usage: node read_mcap.mjs LOG.mcap");
  process.exit(2);
}

function expect(condition, sentence) {
  if (!condition) {
    throw new Error(sentence);
  }
}

function add(counts, topic) {
  counts[topic] = (counts[topic] ?? 0) + 1;
}

function sorted(object) {
  return Object.fromEntries(Object.entries(object).sort(([a], [b]) => (a < b ? -1 : 1)));
}

async function streamed(file, size, decompressHandlers) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const topics = new Map();
  const counts = {};
  const block = new Uint8Array(1 << 16);
  for (let at = 0; at < size; ) {
    const { bytesRead } = await file.read(block, 0, block.length, at);
    expect(bytesRead > 0, `no bytes at ${at} of ${size}`);
    reader.append(block.slice(0, bytesRead));
    at += bytesRead;
    for (let record; (record = reader.nextRecord()) !== undefined; ) {
      if (record.type === "Channel") {
        topics.set(record.id, record.topic);
      } else if (record.type === "Message") {
        add(counts, topics.get(record.channelId));
      }
    }
  }
  expect(reader.done(), "the stream reader did not reach the end");
  return counts;
}

async function indexed(file, size, decompressHandlers) {
  const readable = {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
      expect(bytesRead === bytes.length, `${bytesRead} of ${length} bytes at ${offset}`);
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const counts = {};
  const first = {};
  const types = new Map();
  let last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    expect(message.logTime >= last, `${channel.topic} at ${message.logTime} comes after ${last}`);
    last = message.logTime;
    add(counts, channel.topic);
    if (!types.has(schema.id)) {
      expect(schema.encoding === "protobuf" && channel.messageEncoding === "protobuf", `encoding of ${channel.topic}`);
      types.set(schema.id, protobufFromBinaryDescriptor(schema.data).lookupType(schema.name));
    }
    const type = types.get(schema.id);
    const decoded = type.decode(message.data);   // throws where schema and payload do not agree
    first[channel.topic] ??= type.toObject(decoded, { longs: String, bytes: String, defaults: true });
  }
  const stated = {};
  for (const [id, count] of reader.statistics.channelMessageCounts) {
    stated[reader.channelsById.get(id).topic] = Number(count);
  }
  expect(
    reader.statistics.messageCount === BigInt(Object.values(counts).reduce((a, b) => a + b, 0)),
    `the statistics state ${reader.statistics.messageCount} messages`,
  );
  const attachments = {};
  for await (const attachment of reader.readAttachments()) {
    attachments[attachment.name] = attachment.data.byteLength;
  }
  const metadata = {};
  for await (const record of reader.readMetadata()) {
    metadata[record.name] = sorted(Object.fromEntries(record.metadata));
  }
  return { counts, stated, attachments, metadata, first };
}

const file = await open(path);
try {
  const { size } = await file.stat();
  const handlers = await loadDecompressHandlers();
  const { counts, stated, attachments, metadata, first } = await indexed(file, size, handlers);
  const text = JSON.stringify(sorted(counts));
  const other = JSON.stringify(sorted(await streamed(file, size, handlers)));
  expect(text === other, `the stream reader found ${other}, the indexed reader ${text}`);
  expect(text === JSON.stringify(sorted(stated)), `the statistics state ${JSON.stringify(stated)}, found ${text}`);
  console.log(
    JSON.stringify({ counts: sorted(counts), attachments: sorted(attachments), metadata, first: sorted(first) }),
  );
} catch (error) {
  console.error(`${path}: ${error.message}`);
  process.exitCode = 1;
} finally {
  await file.close();
}
