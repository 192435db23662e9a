# For the scripts here, to be sourced: failing, and waiting for other processes.
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# wait_for TEXT FILE: waits until the file has the text, at most 60 s.
wait_for() {
  for _ in $(seq 6000); do
    ! grep -q "$1" "$2" 2>/dev/null || return 0
    sleep 0.01
  done
  fail "no '$1' in $2: $(cat "$2")"
}
# wait_for_receivers INTERFACE COUNT: waits until so many sockets receive that interface's frames.
wait_for_receivers() {
  for _ in $(seq 6000); do
    [[ $(grep -c "^ *$1 " /proc/net/can/rcvlist_all) -lt $2 ]] || return 0
    sleep 0.01
  done
  fail "fewer than $2 receivers on $1"
}
