# Other people's JavaScript packages, for the scripts that open our files with them; to be sourced.

skip() { echo "skipped: $*"; exit 77; }

# js_packages TOOLS_JS WORK_DIR PACKAGE: sets $packages to a folder that has the package, those of its lock file and our
# scripts beside it. Fetches them into WORK_DIR if they are not there. Skips the test, with the reason, if it cannot.
js_packages() {
  local tools=$1 work=$2 package=$3
  command -v node >/dev/null || skip "node is not installed"
  node -e 'process.exit(Number(process.versions.node.split(".")[0]) < 18 ? 1 : 0)' ||
    skip "node $(node --version) is older than 18"
  mkdir -p "$work"
  packages=$tools
  [[ -d $tools/node_modules/$package ]] && return
  command -v npm >/dev/null || skip "npm is not installed and tools/js/node_modules has no $package"
  packages=$work
  cp "$tools/package.json" "$tools/package-lock.json" "$tools/.npmrc" "$tools"/*.mjs "$work/"
  [[ -d $work/node_modules/$package ]] && return
  (cd "$work" && timeout 60 npm ci --no-progress >npm.log 2>&1) || {
    rm -rf "$work/node_modules"
    skip "npm ci could not fetch $package within 60 s (no network?)"
  }
}
