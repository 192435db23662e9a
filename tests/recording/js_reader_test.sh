#!/usr/bin/env bash
# Opens a log with the official JavaScript reader and compares the result with the written records.
#   js_reader_test.sh SAMPLE_LOG_PROGRAM TOOLS_JS WORK_DIR      exit 77: skipped, with the reason
set -euo pipefail
sample=$1 tools=$2 work=$3

source "$(dirname "$0")/js_packages.sh"
js_packages "$tools" "$work" @mcap/core

"$sample" "$work/sample.mcap" >"$work/expected.json"
node "$packages/read_mcap.mjs" "$work/sample.mcap" >"$work/found.json"
cat >"$work/compare.mjs" <<'JS'
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
const [expected, found] = process.argv.slice(2).map((path) => JSON.parse(readFileSync(path, "utf8")));
assert.deepEqual(found.counts, expected.counts);
assert.equal(Object.keys(found.counts).length, 35);
assert.deepEqual(found.attachments, { "cluster.yaml": 12 });
const manifest = found.metadata["ttfusion.manifest"];
assert.equal(manifest.seed, "18446744073709551615");
assert.equal(manifest["node.0.task.1"], "send");
assert.equal(manifest["hash.scenario"], "dead.beef");
assert.equal(found.metadata["ttfusion.result"].content_hash, expected.hash);
const clock = found.first["/clock_corrected"];
assert.equal(clock.cycle, "41");
assert.equal(clock.offset_microticks, -7);
assert.equal(clock.rate_limited, true);
const track = found.first["/track"];
assert.deepEqual(track.state, [1.5, -2.25, 1e-300, 0, 3, -0.125]);
assert.equal(track.covariance.length, 36);
assert.equal(track.covariance[0], 1);
assert.equal(track.track, 65535);
assert.equal(track.valid_at, "-5");
console.log("the official reader finds what was written:", JSON.stringify(found.counts));
JS
node "$work/compare.mjs" "$work/expected.json" "$work/found.json"

# The reader must be able to fail: one byte of the first chunk changed.
node -e '
  const fs = require("node:fs");
  const bytes = fs.readFileSync(process.argv[1]);
  bytes[bytes.indexOf("zstd") + 40] ^= 1;
  fs.writeFileSync(process.argv[2], bytes);' "$work/sample.mcap" "$work/damaged.mcap"
if node "$packages/read_mcap.mjs" "$work/damaged.mcap" >/dev/null 2>"$work/damaged.txt"; then
  echo "error: the reader did not notice a damaged chunk" >&2
  exit 1
fi
