#!/usr/bin/env bash
# Runs the tests that need real SocketCAN on the test bed (tools/test_bed.sh), independent of this machine's kernel.
#   tools/vcan_bed.sh                    exit code 1 if one fails
#   tools/vcan_bed.sh --update-golden    only the drives whose hashes are kept in tests/golden/vcan_hashes: shows the
#                                        differences, and keeps the new hashes
# shellcheck disable=SC2016   # lines for at_once, which are another bash's
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_deps.sh --gates
tools/build.sh release --target test_socketcan vcan_peer ttfusion
tools/test_bed.sh --build
export out=build/test-bed/vcan peer=build/release/tests/test_bed/vcan_peer ttfusion=build/release/ttfusion
rm -rf "$out"
mkdir -p "$out"

# at_once LINE...: runs lines of bash, one a processor at a time, with this script's functions. Shows a line's output when it
# ends; after a failure no further line begins. Each line keeps to one processor: a bed's processes take turns, and turns
# across processors take half as long again.
at_once() {
  local processors
  processors=$(python3 -c 'import os; print(*os.sched_getaffinity(0))')
  export processors
  printf '%s\0' "$@" |
    xargs -0 -n 1 -P "$(wc -w <<<"$processors")" --process-slot-var=slot bash -euo pipefail -c 'at_its_place "$1"' at_once ||
    return 1
}
at_its_place() {
  local of=($processors) words code=0
  words=$(taskset -c "${of[slot]}" bash -euo pipefail -c "$1" 2>&1) || code=$?
  echo "vcan bed: $1: $SECONDS s${words:+$'\n'$words}"
  [[ $code -eq 0 ]] || exit 255   # xargs begins nothing more
}

# bed [NAME=VALUE...] COMMAND [ARGUMENT...]: runs the command on the bed with these variables only.
bed() { env -i LC_ALL=C HOME=/ PATH=/usr/sbin:/usr/bin:/sbin:/bin tools/test_bed.sh env "$@"; }
script() { bed "tests/test_bed/$1.sh" "${@:2}"; }

the_bed_itself() {
  ends_with 7 60 bash -c 'sleep 3600; exit 7'        # an hour of virtual time
  ends_with 124 3 bash -c 'while :; do :; done'
  ends_with 125 60 busybox poweroff -f
}
ends_with() {
  local code=0 words
  words=$(tools/test_bed.sh --seconds "$2" "${@:3}" 2>&1) || code=$?
  [[ $code -eq $1 ]] || { echo "exit code $code, not $1: ${*:3}"$'\n'"$words"; return 1; }
}

sockets_tests() {
  bed build/release/tests/bus/socketcan/test_socketcan >"$out/sockets_tests" || { cat "$out/sockets_tests"; return 1; }
  tail -2 "$out/sockets_tests"
  ! grep '^\[  SKIPPED' "$out/sockets_tests"   # a skipped test is an error here
}

# drive SCRIPT REPEAT [NAME=VALUE...]: a drive of processes on vcans; repeats must be bit-identical.
drive() { bed "${@:3}" LOGS="$out/$1.$2.mcap" "tests/test_bed/$1.sh" "$ttfusion" >"$out/$1.$2"; }
# The dynamic loader searches sub-folders by the processor's features. One repeat masks the features, another adds a folder to
# search and a large environment, which moves the stack. Neither may change a bit.
export fewer_looks=GLIBC_TUNABLES=glibc.cpu.hwcap_mask=0:glibc.cpu.hwcaps=-POPCNT
more_looks="LD_LIBRARY_PATH=/run/nowhere LARGE=$(printf %05000d 0)"
export more_looks
drives=('drive node_set_restart 1' 'drive node_set_restart 2 $more_looks' 'drive node_set 1' 'drive node_set 2 $fewer_looks'
  'drive node_set_closed_loop 1' 'drive node_set_closed_loop 2 $more_looks')

export -f at_its_place bed script the_bed_itself ends_with sockets_tests drive

golden=tests/golden/vcan_hashes
made_with='bash g++-12 libc6 libddsc0debian libfmt9 libopenmpi3 libprotobuf32 librsvg2-2 libsqlite3-0 libstdc++6 libyaml-cpp0.7 libzstd1 linux-source-6.1'
compare_drives() {
  local drive
  for drive in node_set node_set_restart node_set_closed_loop; do
    cmp "$out/$drive.1.mcap" "$out/$drive.2.mcap" >&2 || exit 1
    echo "$drive $(sed -n 's/.*"content_hash": "\(.*\)"/\1/p' "$out/$drive.1")"
  done >"$out/golden"
  # The kernel and the libraries also decide which process wakes first at an instant, and how long one sleeps.
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
  at_once "${drives[@]}"
  compare_drives --update-golden
  exit
fi

exchanges=()
for k in {1..12}; do exchanges+=("script exchange \$peer \$out/$k"); done
compare_exchanges() {
  for k in {1..12}; do (cd "$out/$k" && sha256sum node_* | sha256sum); done | sort | uniq -c >"$out/hashes"
  [[ $(wc -l <"$out/hashes") -eq 1 ]] && return
  cat "$out/hashes" >&2
  echo "vcan bed: the same exchange gave other stamps" >&2
  exit 1
}

# The longest line begins first.
at_once 'script node_set_strangers $ttfusion $peer' sockets_tests "${drives[@]:0:2}" 'script node_set_external $ttfusion' 'script node_set_down $ttfusion' \
  "${drives[@]:2}" "${exchanges[@]}" 'script strangers $peer' the_bed_itself
compare_drives
compare_exchanges
