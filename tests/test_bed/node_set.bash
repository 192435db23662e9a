# For the scripts here that run the node set of the paper's TT cluster as processes on separate vcans. To be sourced
# with the program's path as $1.
ttfusion=$(realpath "$1")
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
drive=$project/tests/test_bed/short_drive.yaml
export PATH=$PATH:/usr/sbin:/sbin

# On the test bed time is virtual: frames are never late there, under any load of the machine. Elsewhere wake-ups may be
# late, so the schedule is stretched, and lateness is not judged.
virtual_time=false
time_scale=4
if grep -q time-travel=inf-cpu /proc/cmdline; then
  virtual_time=true
  time_scale=1
fi

source "$(dirname "${BASH_SOURCE[0]}")/waiting.bash"
skip() {
  echo "skipped: $*"
  exit 77
}
need() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null || skip "no $program (Debian: can-utils, iproute2, python3)"
  done
}

# Interfaces for these scripts only: ttfcan0 and 1 are channels A and B.
a=ttfcan0 b=ttfcan1 laser_can=ttfcan2 camera_can=ttfcan3 observation_can=ttfcan4
interfaces=("$a" "$b" "$laser_can" "$camera_can" "$observation_can")
on_vcans=(--bus "socketcan:$a,$b" --can "laser_can=$laser_can" --can "camera_can=$camera_can"
          --can "observation_can=$observation_can" --no-topics --time-scale "$time_scale")

end_all() {
  local interface
  kill $(jobs -p) 2>/dev/null || true
  for interface in "${interfaces[@]}"; do ip link del dev "$interface" 2>/dev/null || true; done
  rm -rf "$run"
}
make_interfaces() {
  local interface reason
  need ip
  [[ $(id -u) -eq 0 ]] || skip "only root can make interfaces"
  run=$(mktemp -d)
  trap end_all EXIT
  for interface in "${interfaces[@]}"; do
    ip link del dev "$interface" 2>/dev/null || true
    reason=$(ip link add dev "$interface" type vcan 2>&1) || skip "no vcan here: $reason"
    ip link set "$interface" mtu 72 up
  done
}

# Sleeps until so many ns after the next tenth of a second, where drives begin. The following events then come at the same
# instant of each drive.
sleep_to() {
  local now
  now=$((10#$(date +%N)))
  now=$(($1 + 100000000 - now % 100000000))
  sleep "$((now / 1000000000)).$(printf %09d $((now % 1000000000)))"
}

# launch FOLDER [OPTION...]: runs the node set, supervised; its output is in FOLDER.txt.
launch() {
  local folder=$1
  shift
  ! $virtual_time || sleep_to 0
  "$ttfusion" launch "$drive" "${on_vcans[@]}" --no-pictures --json --out "$folder" "$@" >"$folder.json" 2>"$folder.txt"
}

# process_of NODE MANIFEST: prints the number of the node's first process.
process_of() { awk -v name="\"$1\"," '$1 == "\"name\":" { on = $2 == name } on && $1 == "\"pid\":" { print +$2; exit }' "$2"; }

# judge FOLDER [EXPRESSION SENTENCE]...: prints the sentence of each false expression (judge.py has their variables).
judge() { python3 "$project/tests/test_bed/judge.py" "$@" || fail "see above"; }

# Judges a drive of the whole node set by the common expressions, and by those given.
judge_drive() {
  local in_time=()
  ! $virtual_time ||
    in_time=('lost("late_frames") + lost("early_frames") + lost("missed_slots") == 0' "something was late")
  judge "$1" \
    'all(node.get("state", "normal active") == "normal active" for node in nodes.values())' "who is not normal active?" \
    'summary["uses"] >= 8 and summary["objects"]["missed"] == 0' "the feature service used too little" \
    'lost("drops") + lost("frames_lost") == 0' "frames were lost" \
    "${in_time[@]}" "${@:2}"
}
