#!/usr/bin/env bash
# A real node in camera_pre's place: examples/real_node.c, which has SocketCAN alone. The gateway's steps are a library's.
#   node_set_external.sh TTFUSION      exit code 77, with the reason, outside the test bed and without a compiler for C
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3 cc
$virtual_time || skip "the real node keeps the schedule as it is, which this kernel may not"
make_interfaces
cc -O2 -Wall -o "$run/real_node" "$project/examples/real_node.c"
# copy.c passes lists on as the program's own step does.
mkdir "$run/steps"
cc -O2 -ffp-contract=off -shared -fPIC -I "$project/nodes/foreign" -o "$run/steps/copy.so" "$project/tests/nodes/foreign/copy.c" -lm
sed 's/step: gateway/step: copy.so/' "$project/schedules/paper_synchronised.yaml" >"$run/cluster.yaml"
sed "s#\.\./\.\./schedules/paper_synchronised.yaml#cluster.yaml#; s#\.\./\.\./schedules#$project/schedules#" "$drive" >"$run/drive.yaml"
drive=$run/drive.yaml

echo "the stand-in says what is wrong with its arguments"
code=0
said=$("$run/real_node" 2>&1) || code=$?
[[ $code -eq 2 && $said == usage:* ]] || fail "exit code $code without arguments: $said"
code=0
said=$("$run/real_node" nowhere "$b" "$camera_can" "$observation_can" 2>&1) || code=$?
[[ $code -eq 1 && $said == nowhere:* ]] || fail "exit code $code without an interface: $said"

# with_real_node FOLDER [FAULT...] -- OPTION...: a drive with it; there is no camera.
with_real_node() {
  local folder=$1 faults=() code=0
  for (( ; $# > 1; )); do
    shift
    [[ $1 != -- ]] || break
    faults+=("$1")
  done
  shift
  "$run/real_node" "$a" "$b" "$camera_can" "$observation_can" "${faults[@]}" &
  local real=$!
  wait_for_receivers "$observation_can" 1
  launch "$run/$folder" --external camera_pre,camera --steps "$run/steps" "$@" || code=$?
  kill "$real"
  wait "$real" || true
  return "$code"
}
# judge_real FOLDER [EXPRESSION SENTENCE]...: `real` is its account.
judge_real() {
  judge "$run/$1" 'external[0]["node"] == "camera_pre" and external[0]["state"] == "sending"' "is it sending?" \
    'external == summary_of_all["external_nodes"]' "the summary differs from the manifest" \
    'all(node.get("state", "normal active") == "normal active" for node in nodes.values())' "who is not normal active?" \
    "${@:2}"
}
none_but() { echo "sum(real[kind] for kind in ('early', 'late', 'missing')) + real['malformed']['all'] == $1"; }

echo "in time, it is as good as the node in its place; an optional one may be absent"
with_real_node in_time -- --policy camera=optional || fail "exit code $?: $(cat "$run/in_time.txt")"
judge_real in_time "$(none_but 0)" "it did something wrong" \
  'real["in_window"] >= 2 * 195 + 20 + 20' "its slot, triggers and lists" \
  'lost("late_frames") + lost("early_frames") + lost("frames_lost") + lost("drops") == 0' "the others miss something" \
  'medium("malformed") == 0 and summary["refused_can_frames"] == 0' "the others refuse something" \
  'summary["uses"] >= 8 and summary["objects"]["missed"] == 0' "the feature service used too little" \
  'external[1]["node"] == "camera" and external[1]["state"] == "waiting"' "what of the camera?"
grep -q "camera_pre: sending" "$run/in_time.txt" || fail "not a word of it: $(cat "$run/in_time.txt")"
grep -q "warning: camera was not in operation at the end: waiting" "$run/in_time.txt" || fail "$(cat "$run/in_time.txt")"
grep -aq 'copy\.so' "$run/in_time/gateway.mcap" || fail "the gateway's log names no library"
[[ ! -e $run/in_time/camera_pre.mcap && ! -e $run/in_time/camera_pre.txt ]] || fail "it has a log"

echo "its mistakes are counted, of each kind in turn; a drive without a required one fails"
code=0
with_real_node faulty -300 0 700 spoil -- || code=$?
[[ $code -eq 1 ]] || fail "exit code $code: $(cat "$run/faulty.txt")"
grep -q "ended: nothing was heard of camera" "$run/faulty.txt" || fail "$(cat "$run/faulty.txt")"
judge_real faulty 'real["early"] >= 2 * 48 and real["late"] >= 2 * 48' "its frames are early and late" \
  'real["malformed"]["wrong frame CRC"] >= 2 * 48' "its frame CRCs are wrong" \
  "$(none_but 'real["early"] + real["late"] + real["malformed"]["wrong frame CRC"]')" "and nothing else" \
  'real["in_window"] >= 2 * 48 + 20 + 20' "those in between" \
  'lost("early_frames") >= 4 * 48 and lost("late_frames") >= 4 * 48' "the others tell it, too" \
  '"late" in verdict and "camera_pre: " in verdict and "malformed" in verdict' "the verdict"
echo "a real node: all as the page says"
