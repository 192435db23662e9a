#!/usr/bin/env bash
# The tests that need real SocketCAN, on the test bed (tools/test_bed.sh), whatever this machine's kernel has.
#   tools/vcan_bed.sh                    exit code 1 if one fails
#   tools/vcan_bed.sh --update-golden    only the drives whose hashes are kept in tests/golden/vcan_hashes: shows what
#                                        has changed, and keeps what was computed
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh release --target test_socketcan vcan_peer ttfusion
tools/test_bed.sh --build
peer=build/release/tests/test_bed/vcan_peer
ttfusion=build/release/ttfusion
out=build/test-bed/exchange
rm -rf "$out"
mkdir -p "$out"

# What comes before a drive takes time there, 256 ns for each look at the clock, and moves what comes after: the locale a shell
# loads, the folders a program is looked for in, how deep the project lies. So all of them are the same everywhere.
#   bed SECONDS COMMAND [ARGUMENT...]
bed() {
  env -i LC_ALL=C HOME=/ PATH=/usr/sbin:/usr/bin:/sbin:/bin tools/test_bed.sh --seconds "$1" bash -c \
    'mkdir /run/project && busybox mount --bind "$PWD" /run/project && cd /run/project && exec "$@"' bed "${@:2}"
}

# Both beds' words in the order of the commands, each a script with its arguments in one word.
two_at_once() {
  local k=0 script beds=()
  for script; do
    k=$((k + 1))
    # shellcheck disable=SC2086
    bed 240 $script >"$out/bed_$k" 2>&1 &
    beds+=($!)
  done
  for ((k = 0; k < $#; ++k)); do
    wait "${beds[k]}" || { cat "$out/bed_$((k + 1))" >&2; exit 1; }
    cat "$out/bed_$((k + 1))"
  done
}

# The drives of processes on vcans that are the same, bit for bit, whenever and wherever they are run.
golden=tests/golden/vcan_hashes
made_with='bash g++-12 libc6 libddsc0debian libfmt9 libopenmpi3 libprotobuf32 librsvg2-2 libsqlite3-0 libstdc++6 libyaml-cpp0.7 libzstd1 linux-source-6.1'
golden_drives() {
  : >"$out/golden"
  for script in node_set node_set_restart; do
    echo "vcan bed: $script, twice, the same log"
    two_at_once "env LOGS=$out/$script.1.mcap tests/test_bed/$script.sh $ttfusion" \
      "env LOGS=$out/$script.2.mcap tests/test_bed/$script.sh $ttfusion"
    cmp "$out/$script.1.mcap" "$out/$script.2.mcap" || exit 1
    echo "$script $(sed -n 's/.*"content_hash": "\(.*\)"/\1/p' "$out/bed_1")" >>"$out/golden"
  done
  # What a process does between two looks at the clock is its libraries' and the kernel's business, too.
  echo "made_with $(dpkg-query -W -f '${Package} ${Version}\n' $made_with | sha256sum | cut -c 1-16)" >>"$out/golden"
  if [[ ${1:-} != --update-golden && $(grep ^made_with "$golden") != $(grep ^made_with "$out/golden") ]]; then
    echo "vcan bed: $golden was made with other versions of $made_with: its hashes are not compared"
    return
  fi
  if ! diff "$golden" "$out/golden"; then
    [[ ${1:-} == --update-golden ]] && cp "$out/golden" "$golden" && return
    echo "vcan bed: other hashes (>) than in $golden (<); if that is right: tools/vcan_bed.sh --update-golden" >&2
    exit 1
  fi
}
if [[ ${1:-} == --update-golden ]]; then
  golden_drives --update-golden
  exit
fi

echo "vcan bed: the bed itself"
ends_with() {
  local code=0
  bed "$2" "${@:3}" >"$out/bed" 2>&1 || code=$?
  [[ $code -eq $1 ]] || { echo "vcan bed: exit code $code, not $1: ${*:3}" >&2; cat "$out/bed" >&2; exit 1; }
}
ends_with 7 60 bash -c 'sleep 3600; exit 7'        # an hour of virtual time
ends_with 124 3 bash -c 'while :; do :; done'
ends_with 125 60 busybox poweroff -f

echo "vcan bed: the socket's tests, none skipped"
bed 300 build/release/tests/bus/socketcan/test_socketcan >"$out/tests" || { cat "$out/tests"; exit 1; }
tail -2 "$out/tests"
if grep '^\[  SKIPPED' "$out/tests"; then exit 1; fi

echo "vcan bed: strangers on the bus"
bed 120 tests/test_bed/strangers.sh "$peer"

golden_drives
echo "vcan bed: strangers beside the node set, interfaces that go down"
two_at_once "tests/test_bed/node_set_strangers.sh $ttfusion $peer" "tests/test_bed/node_set_down.sh $ttfusion"

repeats=12
echo "vcan bed: ten processes, $repeats times, two beds at once"
for i in $(seq 1 2 "$repeats"); do
  beds=()
  for k in "$i" $((i + 1)); do
    bed 120 tests/test_bed/exchange.sh "$peer" "$out/$k" &
    beds+=($!)
  done
  for bed in "${beds[@]}"; do wait "$bed"; done
done
for k in $(seq "$repeats"); do (cd "$out/$k" && sha256sum node_* | sha256sum); done | sort | uniq -c >"$out/hashes"
cat "$out/hashes"
if [[ $(wc -l <"$out/hashes") -ne 1 ]]; then
  echo "vcan bed: the same exchange gave other stamps" >&2
  exit 1
fi
