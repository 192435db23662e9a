#!/usr/bin/env bash
# Opens an export for Foxglove with the official JavaScript readers, and compares its schemas with npm @foxglove/schemas.
#   foxglove_schemas_test.sh PROGRAM SOURCE_DIR WORK_DIR      exit 77: skipped, with the reason
set -euo pipefail
program=$1 source=$2 work=$3

source "$source/tests/recording/js_packages.sh"
js_packages "$source/tools/js" "$work" @foxglove/schemas

"$program" run "$source/scenarios/paper_scenario1.yaml" --strategy tt --no-pictures --out "$work/drive" >/dev/null 2>&1
"$program" export "$work/drive/tt.mcap" --format foxglove --json -o "$work/scene.mcap" >"$work/stated.json" 2>/dev/null
node "$packages/read_mcap.mjs" "$work/scene.mcap" >"$work/found.json"
cat >"$work/compare.mjs" <<'JS'
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
const [stated, found] = process.argv.slice(2).map((path) => JSON.parse(readFileSync(path, "utf8")));
const { counts, first } = found;
assert.equal(counts["/truth"], stated.truths);
assert.equal(counts["/tracks"], stated.images);
assert.equal(counts["/image_use"], stated.uses);
assert.equal(counts["/errors"], stated.errors);
assert.equal(counts["/reference"], stated.references);
assert.equal(counts["/observations/laser"] + counts["/observations/camera"], stated.observations);
assert.equal(counts["/ages/laser"] + counts["/ages/camera"], stated.ages);
assert.deepEqual(stated.left_out, []);
assert.deepEqual(first["/fields"].entities.map((entity) => entity.frame_id), ["vehicle/laser", "vehicle/camera"]);
assert.equal(first["/truth"].entities[0].cubes[0].size.x, 4.39);
console.log("the official readers find what the export says:", JSON.stringify(counts));
JS
node "$work/compare.mjs" "$work/stated.json" "$work/found.json"

agree=$(node "$packages/compare_schemas.mjs" "$work/scene.mcap")
for message in SceneUpdate SceneEntity SceneEntityDeletion CubePrimitive LinePrimitive FrameTransforms Pose; do
  [[ " $agree " == *" $message "* ]] || { echo "error: $message is not among those that agree: $agree" >&2; exit 1; }
done
echo "as in the package: $agree"
