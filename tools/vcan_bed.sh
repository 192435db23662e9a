#!/usr/bin/env bash
# The tests that need real SocketCAN, on the test bed (tools/test_bed.sh), whatever this machine's kernel has.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh release --target test_socketcan vcan_peer
tools/test_bed.sh --build
peer=$PWD/build/release/tests/test_bed/vcan_peer
out=$PWD/build/test-bed/exchange
rm -rf "$out"
mkdir -p "$out"

echo "vcan bed: the bed itself"
ends_with() {
  local code=0
  tools/test_bed.sh --seconds "$2" "${@:3}" >"$out/bed" 2>&1 || code=$?
  [[ $code -eq $1 ]] || { echo "vcan bed: exit code $code, not $1: ${*:3}" >&2; cat "$out/bed" >&2; exit 1; }
}
ends_with 7 60 bash -c 'sleep 3600; exit 7'        # an hour of virtual time
ends_with 124 3 bash -c 'while :; do :; done'
ends_with 125 60 busybox poweroff -f

echo "vcan bed: the socket's tests, none skipped"
tools/test_bed.sh --seconds 120 build/release/tests/socketcan/test_socketcan >"$out/tests" || { cat "$out/tests"; exit 1; }
tail -2 "$out/tests"
if grep '^\[  SKIPPED' "$out/tests"; then exit 1; fi

echo "vcan bed: strangers on the bus"
tools/test_bed.sh --seconds 120 tests/test_bed/strangers.sh "$peer"

repeats=12
echo "vcan bed: ten processes, $repeats times, two beds at once"
for i in $(seq 1 2 "$repeats"); do
  beds=()
  for k in "$i" $((i + 1)); do
    tools/test_bed.sh --seconds 120 tests/test_bed/exchange.sh "$peer" "$out/$k" &
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
