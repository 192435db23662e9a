# For the scripts here: failing, and waiting for what others do; sourced.
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# wait_for TEXT FILE: until it is there, 60 s at most.
wait_for() {
  for _ in $(seq 6000); do
    ! grep -q "$1" "$2" 2>/dev/null || return 0
    sleep 0.01
  done
  fail "no '$1' in $2: $(cat "$2")"
}
# wait_for_receivers INTERFACE COUNT: until so many sockets on that interface have said that they want its frames.
wait_for_receivers() {
  for _ in $(seq 6000); do
    [[ $(grep -c "^ *$1 " /proc/net/can/rcvlist_all) -lt $2 ]] || return 0
    sleep 0.01
  done
  fail "fewer than $2 receivers on $1"
}
