#!/usr/bin/env bash
# Installs a build, tries the program and its shipped files there, and builds the example projects against it: with the
# compiler's defaults, for this machine's processor and by clang++. Then the same as a part of the example's own build, and a
# Debian package.
#   install_test.sh PROGRAM SOURCE_DIR
set -u
program=$1
source=$2
build=$(dirname "$program")
source "$(dirname "$0")/expect.sh"

cmake --install "$build" --prefix "$work/first" >"$work/installed" || { cat "$work/installed"; exit 1; }
mv "$work/first" "$work/prefix"   # an installed tree may be moved
prefix=$work/prefix
share=$prefix/share
mkdir "$work/empty"
cd "$work/empty" || exit 1

# The program, in a folder without sources.
program=$prefix/bin/ttfusion
expect 0 '^ttfusion [0-9.]+, commit ' --version
hash=$(sed -n 's/.*"paper_scenario1 tt": "\(.*\)".*/\1/p' "$source/tests/golden/content_hashes.json")
expect 0 "content hash of the log +$hash" run paper_scenario1 --strategy tt --no-pictures
expect 0 'consistent' schedule check paper_synchronised
expect 0 'Which strategy sees' experiment paper_drives --replications 1 --out out/experiment
expect 0 'fusion' launch two_lasers --virtual-time --dry-run
expect 2 '^error: paper_scenaro1: is neither a file nor the name of a shipped scenario; did you mean paper_scenario1\?$' \
  run paper_scenaro1
for file in man/man1/ttfusion.1 man/man1/ttfusion-schedule.1 bash-completion/completions/ttfusion \
  zsh/site-functions/_ttfusion fish/vendor_completions.d/ttfusion.fish doc/ttfusion/copyright \
  doc/ttfusion/docs/use/installing.md ttfusion/experiments/faults/camera_crash.yaml ttfusion/schemas/cluster.schema.json; do
  [[ -s $share/$file ]] || fail "$file is not installed"
done
# The example of a step of one's own, with the installed header.
if cmake -G Ninja -S "$share/doc/ttfusion/examples/step" -B "$work/steps" "-DCMAKE_PREFIX_PATH=$prefix" >"$work/steps.txt" 2>&1 &&
  cmake --build "$work/steps" >>"$work/steps.txt" 2>&1; then
  grep -q "TTFUSION_STEP_INCLUDE:PATH=$prefix/include/ttfusion" "$work/steps/CMakeCache.txt" || fail "the example takes another header"
  expect 0 's: lamp on, nearest object at' run "$share/doc/ttfusion/examples/step/scenario.yaml" --strategy tt --no-pictures \
    --steps "$work/steps"
else
  fail "the example of a step does not build: $(tail -n 30 "$work/steps.txt")"
fi
[[ -z $(compgen -G "$build/own_symbols.*") && ! -e $build/manual ]] || fail "files stay in the build folder"
[[ -z $(find "$prefix" -name '*.cc' -not -path '*/examples/*') ]] || fail "sources are installed"
[[ -z $(find "$prefix" -type d -empty) ]] || fail "empty folders are installed"
weak=$(find "$prefix" -name libttf_fusion.a -exec nm --defined-only {} + | grep -c ' [uVvWw] ')
[[ $weak -eq 0 ]] || fail "the library shares $weak functions with its user"
grep -rIl --exclude-dir=doc "$source" "$prefix" && fail "installed files name the sources' folder"

# The example, three times with the installed library.
example=$source/examples/embedding
make() {  # NAME ARGS...: configures and builds the example with ARGS, and keeps what it prints
  local name=$1
  shift
  if cmake -G Ninja -S "$example" -B "$work/$name" "$@" >"$work/$name.txt" 2>&1 &&
    cmake --build "$work/$name" >>"$work/$name.txt" 2>&1; then
    "$work/$name/embedding" >"$work/$name.tracks" || fail "the example, $name, ends with $?"
  else
    fail "the example, $name, does not build: $(tail -n 30 "$work/$name.txt")"
  fi
}
compilers=(defaults native)
make defaults "-DCMAKE_PREFIX_PATH=$prefix"
make native "-DCMAKE_PREFIX_PATH=$prefix" -DCMAKE_CXX_FLAGS='-O2 -march=native'
if command -v clang++ >/dev/null; then
  make clang "-DCMAKE_PREFIX_PATH=$prefix" -DCMAKE_CXX_COMPILER=clang++
  compilers+=(clang)
fi
[[ $(wc -l <"$work/defaults.tracks") -gt 10 ]] || fail "the example prints no tracks"
for name in "${compilers[@]:1}"; do
  cmp "$work/defaults.tracks" "$work/$name.tracks" || fail "the example's tracks differ: $name"
done

grep -qi 'fmt\|yaml' "$work/defaults/CMakeCache.txt" && fail "ttfusion::fusion needs more than Eigen"

# Other modules.
if cmake -G Ninja -S "$source/examples/modules" -B "$work/modules" "-DCMAKE_PREFIX_PATH=$prefix" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  >"$work/modules.txt" 2>&1 && cmake --build "$work/modules" >>"$work/modules.txt" 2>&1; then
  for flag in ' -W' ' -march' ' -mno-fma' ' -ffp-contract' ' --param' ' -O'; do
    grep -q -- "\"command\".*$flag" "$work/modules/compile_commands.json" && fail "a module's user is compiled with $flag"
  done
  program=$work/modules/check_schedule
  expect 0 '^laser: used [0-9.]+ to [0-9.]+ ms after the measurement$' "$share/ttfusion/schedules/paper_synchronised.yaml"
  sed 's/gdNIT: .*/gdNIT: 900 us/' "$share/ttfusion/schedules/paper_synchronised.yaml" >"$work/wrong.yaml"
  expect 2 'wrong.yaml:[0-9]+: flexray.gdNIT = ' "$work/wrong.yaml"
  program=$work/modules/read_log
  expect 0 '^paper_scenario1 by tt: [1-9][0-9]* uses of an image$' out/paper_scenario1/tt.mcap
  expect 2 'is not a log' "$source/README.md"
  program=$prefix/bin/ttfusion
else
  fail "the example of modules does not build: $(tail -n 30 "$work/modules.txt")"
fi
mkdir "$work/unknown"
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(unknown LANGUAGES CXX)' \
  'find_package(ttfusion REQUIRED COMPONENTS fusion nodes)' >"$work/unknown/CMakeLists.txt"
said=$(cmake -S "$work/unknown" -B "$work/unknown/build" "-DCMAKE_PREFIX_PATH=$prefix" 2>&1) && fail "an unknown component is found"
grep -q 'There is no component nodes' <<<"$said" || fail "an unknown component is not named: $said"

# As a part of the example's build: no tests, and none of our flags in its own sources.
cmake -G Ninja -S "$example" -B "$work/part" "-DTTFUSION_SOURCE=$source" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  >"$work/part.txt" 2>&1 || fail "the example does not configure with the sources: $(tail -n 30 "$work/part.txt")"
own=$(grep '"command".*embedding/main.cc' "$work/part/compile_commands.json")
[[ -n $own ]] || fail "the example's own source is not compiled"
[[ $own == *EIGEN_MAX_ALIGN_BYTES* ]] || fail "Eigen's alignment is not handed on: $own"
for flag in ' -W' ' -march' ' -mno-fma' ' -ffp-contract' ' --param'; do
  [[ $own != *"$flag"* ]] || fail "the example is compiled with $flag: $own"
done
grep -q 'gtest\|fmt' "$work/part/build.ninja" && fail "the example's build needs more than Eigen"
cmake --build "$work/part" --target ttf_base CMakeFiles/embedding.dir/main.cc.o >"$work/part.txt" 2>&1 ||
  fail "the example does not build with the sources: $(tail -n 30 "$work/part.txt")"

# The package has the same program, below usr/ alone.
if command -v dpkg-shlibdeps >/dev/null; then
  if cpack -G DEB -B "$work/package" --config "$build/CPackConfig.cmake" >"$work/package.txt" 2>&1 &&
    dpkg-deb -x "$work"/package/*.deb "$work/root"; then
    [[ $(ls "$work/root") == usr ]] || fail "the package has $(ls "$work/root")"
    [[ -s $work/root/usr/share/man/man1/ttfusion.1.gz ]] || fail "the package's man pages are not compressed"
    [[ -s $work/root/usr/share/zsh/vendor-completions/_ttfusion ]] || fail "the package has nothing for zsh"
    dpkg-deb -f "$work"/package/*.deb Depends | grep -q 'libstdc++6' || fail "the package depends on no library"
    program=$work/root/usr/bin/ttfusion
    expect 0 "content hash of the log +$hash" run paper_scenario1 --strategy tt --no-pictures
  else
    fail "no package: $(tail -n 30 "$work/package.txt")"
  fi
fi

[[ $failures -eq 0 ]] && echo "install: all as documented"
exit $((failures > 0))
