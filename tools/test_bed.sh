#!/usr/bin/env bash
# Runs a command on a Linux with real SocketCAN and virtual time. The machine's own kernel needs neither: a User-Mode Linux
# kernel is an ordinary program. Sleeping takes no real time there, and computing takes no virtual time. A command thus sees
# the same virtual instants on a fast, slow or busy machine.
#   tools/test_bed.sh [--seconds N] COMMAND [ARGUMENT...]
#   tools/test_bed.sh --build       only builds the kernel, once: some 3 minutes on two cores
# The command runs as root of that Linux, in this folder and environment, with this machine's files and the caller's rights
# on them. vcan0, vcan1 and lo are up; both vcans carry CAN FD. /proc, /sys, /dev and /run are its own. Its exit code is this
# script's. After N seconds (default 300) of the machine's time all is ended with exit code 124. Exit code 125 means that the
# kernel went down before the command ended. A loop that waits without sleeping stops virtual time, so it never ends.
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
cache=$project/build/test-bed
symbols=$project/tools/test_bed/kernel.symbols
changes=$project/tools/test_bed/kernel.patch
package=linux-source-6.1
source=/usr/src/$package.tar.xz

fail() {
  echo "test bed: $*" >&2
  exit 2
}

version=$(dpkg-query -W -f='${Version}' "$package" 2>/dev/null) && [[ -f $source ]] ||
  fail "$package is not installed: tools/install_deps.sh --gates"
[[ $(uname -m) == x86_64 ]] || fail "User-Mode Linux is built for x86_64, this is $(uname -m)"
kernel=$cache/linux-$version-$(cat "$symbols" "$changes" | sha256sum | cut -c1-12)

build() {
  local work=$cache/work
  local options=(ARCH=um LOCALVERSION= KBUILD_BUILD_TIMESTAMP=@0 KBUILD_BUILD_USER=ttfusion KBUILD_BUILD_HOST=ttfusion)
  command -v ccache >/dev/null && options+=("CC=ccache gcc")
  # A quarter of the source: all that a kernel of these symbols is made of.
  local folders=(arch/um arch/x86 block certs crypto drivers/base drivers/char drivers/net/{Space.c,loopback.c,can} drivers/tty
    fs include init io_uring ipc kernel lib mm net scripts security tools/include usr virt)
  rm -rf "$work"
  mkdir -p "$work/out"
  tar -xJf "$source" -C "$work" --wildcards "$package/*"{Kconfig,Makefile,Kbuild}'*' "${folders[@]/#/$package/}"
  (cd "$work/$package" && busybox patch -p1) <"$changes"
  sed -E '/^(#|$)/d; s/^[^=]+$/&=y/; s/^/CONFIG_/' "$symbols" >"$work/fragment"
  make -C "$work/$package" O="$work/out" "${options[@]}" KCONFIG_ALLCONFIG="$work/fragment" allnoconfig
  # A symbol that this kernel does not have, or not on these terms, is not silently left out.
  if grep -vxFf "$work/out/.config" "$work/fragment"; then
    echo "these symbols are not what they should be" >&2
    return 1
  fi
  make -C "$work/$package" O="$work/out" "${options[@]}" -j"$(nproc)" linux
  rm -f "$cache"/linux-*   # kernels of earlier versions
  mv "$work/out/linux" "$kernel"
  rm -rf "$work"
}

if [[ ! -x $kernel ]]; then
  mkdir -p "$cache"
  exec 9>"$cache/lock"
  flock 9   # one builds, the others wait for it
  if [[ ! -x $kernel ]]; then
    echo "test bed: building the kernel, $package $version (its words: $cache/build.log)" >&2
    set +e   # `build || ...` would switch off -e inside build
    (set -e; build) >"$cache/build.log" 2>&1 9>&-
    built=$?
    set -e
    [[ $built -eq 0 ]] || { tail -n 5 "$cache/build.log" >&2; fail "the kernel was not built: $cache/build.log"; }
  fi
  exec 9>&-
fi

seconds=300
case ${1:-} in
  --build) exit 0 ;;
  --seconds) seconds=$2 && shift 2 ;;
esac
[[ $# -gt 0 ]] || fail "which command? tools/test_bed.sh [--seconds N] COMMAND [ARGUMENT...]"

run=$(mktemp -d "${TMPDIR:-/tmp}/test-bed.XXXXXX")
leader=
end() {
  if [[ -n $leader ]]; then
    kill -KILL -- "-$leader" 2>/dev/null || true
    wait "$leader" 2>/dev/null || true
  fi
  rm -rf "$run"
}
trap end EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

quoted() { printf '%q ' "$@"; }
{
  echo '#!/bin/bash'
  export -p
  cat <<INIT
# Kernel file systems come first: the commands below need them.
exec >>$(quoted "$run/init") 2>&1
export PATH=\$PATH:/usr/sbin:/sbin
busybox mount -t proc proc /proc
busybox mount -t sysfs sysfs /sys
busybox mount -t tmpfs tmpfs /run
mkdir -p /dev/shm /dev/pts
busybox mount -t tmpfs tmpfs /dev/shm
busybox mount -t devpts -o ptmxmode=666 devpts /dev/pts
ln -sfn /proc/self/fd /dev/fd
ip link set lo up
for interface in vcan0 vcan1; do
  ip link add dev \$interface type vcan && ip link set \$interface mtu 72 up
done
cd $(quoted "$PWD")
$(quoted "$@") >$(quoted "$run/stdout") 2>$(quoted "$run/stderr")
echo \$? >$(quoted "$run/rc.new")
mv $(quoted "$run/rc.new") $(quoted "$run/rc")
busybox poweroff -f
INIT
} >"$run/init.sh"
chmod +x "$run/init.sh"
: >"$run/stdout"
: >"$run/stderr"

# In a session of its own: what it starts on this machine is one process group.
setsid "$kernel" root=none rootfstype=hostfs rootflags=/ rw mem=1400M "init=$run/init.sh" con=null con0=null,fd:1 \
  "uml_dir=$run" umid=bed time-travel=inf-cpu time-travel-start=1000000000000000000 \
  >"$run/console" 2>&1 </dev/null &
leader=$!
deadline=$((SECONDS + seconds))
while kill -0 "$leader" 2>/dev/null && [[ $SECONDS -lt $deadline ]]; do sleep 0.1; done

cat "$run/stdout"
cat "$run/stderr" >&2
[[ -f $run/rc ]] && exit "$(cat "$run/rc")"
if [[ $SECONDS -ge $deadline ]]; then
  echo "test bed: ended after $seconds s: $(quoted "$@")" >&2
  exit 124
fi
echo "test bed: the kernel went down; its last words:" >&2
tail -n 20 -- "$run/init" "$run/console" >&2
exit 125
