# For the scripts that launch node sets; sourced behind expect.sh. $launch_options are those of all launches.

# launch FOLDER SCENARIO ARGS...: runs a whole one, with its output in FOLDER.out and FOLDER.err.
launch() {
  local folder=$1
  shift
  "$program" launch "$@" "${launch_options[@]}" --no-pictures --out "$folder" >"$folder.out" 2>"$folder.err"
}

# begin FOLDER SCENARIO ARGS...: in the background. $! is the launch itself, so that signals reach it.
begin() {
  local folder=$1
  shift
  "$program" launch "$@" "${launch_options[@]}" --no-pictures --out "$folder" >"$folder.out" 2>"$folder.err" &
}

# Until the nodes of the launch in FOLDER have begun.
wait_begun() {
  for _ in $(seq 600); do
    grep -q 'all nodes are ready' "$1/launch.log" 2>/dev/null && return
    sleep 0.1
  done
  fail "the nodes of $1 do not begin: $(cat "$1.err")"
}

# pids_of FOLDER: of the nodes' first processes, into pid[NODE].
pids_of() {
  declare -gA pid=()
  local name number
  while read -r name number; do pid[$name]=$number; done < <(python3 -c '
import json, sys
for node in json.load(open(sys.argv[1] + "/manifest.json"))["nodes"]: print(node["name"], node["processes"][0]["pid"])' "$1")
}
