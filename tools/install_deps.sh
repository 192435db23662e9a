#!/usr/bin/env bash
# Installs the packages of Debian 12 that ttfusion needs and that are not installed yet. Runs as root or with sudo.
set -euo pipefail

packages=(
  # compilers and build
  g++ cmake ninja-build ccache pkg-config git ca-certificates python3
  # libraries
  libeigen3-dev libfmt-dev libyaml-cpp-dev libpugixml-dev libcli11-dev nlohmann-json3-dev
  libzstd-dev zlib1g-dev protobuf-compiler libprotobuf-dev
  librsvg2-dev libcairo2-dev libpng-dev fonts-dejavu-core
  libsqlite3-dev libboost-dev libopenmpi-dev openmpi-bin
  cyclonedds-dev cyclonedds-tools
  # tests
  libgtest-dev libgmock-dev libbenchmark-dev clang-format python3-yaml python3-jsonschema python3-protobuf
)
# Programs that the build and the tests call, from whatever source, and the package that has each.
programs=(
  node:nodejs npm:npm   # the report's plots; the log's official reader
  tshark:tshark         # captures, as Wireshark sees them
  gnuplot:gnuplot-nox   # the pictures of exported scripts
)
# The slower gates (.ci/run) also need a second compiler with the fuzzer's runtime, a counter of instructions, and a browser.
# The test bed needs a kernel's source, its build tools, and foreign programs for its CANs.
if [[ ${1:-} == --gates ]]; then
  packages+=(clang libclang-rt-14-dev valgrind)
  packages+=(linux-source-6.1 xz-utils make flex bison bc busybox-static iproute2 can-utils)
  programs+=(chromium:chromium)
fi
# Pages of the installed headers (tools/api_pages.sh) need Doxygen.
if [[ ${1:-} == --api ]]; then packages+=(doxygen); fi

missing=()
for package in "${packages[@]}"; do
  [[ $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) == 'install ok installed' ]] || missing+=("$package")
done
for program in "${programs[@]}"; do
  command -v "${program%%:*}" >/dev/null || missing+=("${program##*:}")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "dependencies: all $((${#packages[@]} + ${#programs[@]})) are installed"
  exit 0
fi

sudo=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "error: run as root, or install sudo, to install: ${missing[*]}" >&2; exit 2; }
  sudo=(sudo)
fi
echo "dependencies: installing ${missing[*]}"
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
