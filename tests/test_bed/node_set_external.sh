#!/usr/bin/env bash
# A real node in camera_pre's place: examples/real_node.c, which knows SocketCAN alone.
#   node_set_external.sh TTFUSION      exit code 77, with the reason, outside the test bed and without a compiler for C
set -euo pipefail
source "$(dirname "$0")/node_set.bash"
need python3 cc
$virtual_time || skip "the real node keeps the schedule as it is, which this kernel may not"
make_interfaces
cc -O2 -Wall -o "$run/real_node" "$project/examples/real_node.c"

# with_real_node FOLDER [SHIFT_US [spoil]]: a drive with it.
with_real_node() {
  "$run/real_node" "$a" "$b" "$camera_can" "$observation_can" "${@:2}" &
  local real=$!
  wait_for_receivers "$observation_can" 1
  launch "$run/$1" --external camera_pre || fail "exit code $?: $(cat "$run/$1.txt")"
  kill "$real"
  wait "$real" || true
}
# judge_real FOLDER [EXPRESSION SENTENCE]...: `real` is its account.
judge_real() {
  judge "$run/$1" 'external[0]["node"] == "camera_pre" and external[0]["state"] == "sending"' "is it sending?" \
    'external == summary_of_all["external_nodes"]' "the summary differs from the manifest" \
    'all(node.get("state", "normal active") == "normal active" for node in nodes.values())' "who is not normal active?" \
    "${@:2}"
}
none_but() { echo "sum(real[kind] for kind in ('early', 'late', 'missing')) + real['malformed']['all'] == $1"; }

echo "in time, it is as good as the node in its place"
with_real_node in_time
judge_real in_time "$(none_but 0)" "it did something wrong" \
  'real["in_window"] >= 2 * 195 + 20 + 20' "its slot, triggers and lists" \
  'lost("late_frames") + lost("early_frames") + lost("frames_lost") + lost("drops") == 0' "the others miss something" \
  'medium("malformed") == 0 and summary["refused_can_frames"] == 0' "the others refuse something" \
  'summary["uses"] >= 8 and summary["objects"]["missed"] == 0' "the feature service used too little"
grep -q "camera_pre: sending" "$run/in_time.txt" || fail "not a word of it: $(cat "$run/in_time.txt")"
[[ ! -e $run/in_time/camera_pre.mcap && ! -e $run/in_time/camera_pre.txt ]] || fail "it has a log"

echo "its mistakes are counted"
with_real_node early -300
judge_real early 'real["early"] >= 2 * 195' "its frames are early" "$(none_but 'real["early"]')" "and nothing else" \
  'lost("early_frames") >= 4 * 195' "the others tell it, too"
with_real_node late 700
judge_real late 'real["late"] >= 2 * 195' "its frames are late" "$(none_but 'real["late"]')" "and nothing else" \
  'lost("late_frames") >= 4 * 195' "the others tell it, too" '"late of camera_pre" in verdict' "the verdict"
with_real_node spoiled 0 spoil
judge_real spoiled 'real["malformed"]["wrong frame CRC"] >= 2 * 195' "its frame CRCs are wrong" \
  "$(none_but 'real["malformed"]["wrong frame CRC"]')" "and nothing else"

echo "a real node that is not there"
code=0
launch "$run/absent" --external camera_pre || code=$?
[[ $code -eq 1 ]] || fail "exit code $code: $(cat "$run/absent.txt")"
grep -q "ended: nothing was heard of camera_pre" "$run/absent.txt" || fail "$(cat "$run/absent.txt")"
launch "$run/optional" --external camera_pre --policy camera_pre=optional || fail "exit code $?"
grep -q "warning: camera_pre was not in operation at the end: waiting" "$run/optional.txt" || fail "$(cat "$run/optional.txt")"
echo "a real node: all as the page says"
