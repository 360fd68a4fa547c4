#!/usr/bin/env bash
# Sets up and tests. The last line says how much passed; the exit code is 0 when nothing failed.
#   ./test.sh              all stages
#   ./test.sh --quick      all but the sanitizers and their builds
#   ./test.sh STAGE...     these stages alone, in this order
#   ./test.sh --list       the stages
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

stages='setup build tests lint sanitizers threads'
passed=0 failed=0 skipped=0 failures=()

count() {  # count OUTCOME NAME
  case "$1" in
    passed) passed=$((passed + 1)) ;;
    failed) failed=$((failed + 1)); failures+=("$2") ;;
  esac
}

# must NAME COMMAND...: counts only a failure, since it is no test.
must() {
  local name=$1
  shift
  "$@" || { count failed "$name"; return 1; }
}

check() {  # check NAME COMMAND...
  local name=$1
  shift
  if "$@"; then count passed "$name"; else count failed "$name"; fi
}

# run_ctest TREE [ctest option...]: one count a test, from ctest's own report.
run_ctest() {
  local tree=$1 report
  shift
  report=$PWD/$tree/tests.xml
  rm -f "$report"
  ctest --test-dir "$tree" -j 2 --output-on-failure --no-tests=error --output-junit "$report" \
    "$@" </dev/null | grep -vE '^ *Start |Passed +[0-9.]+ sec$'
  [ -e "$report" ] || { count failed "ctest in $tree"; return; }
  # What did not run is a failure, unless the test itself said that it skips.
  local total good off bad
  total=$(grep -cE '^\s*<testcase ' "$report")
  good=$(grep -cE '^\s*<testcase .* status="run"' "$report")
  off=$(grep -cE '^\s*<skipped message="SKIP_|^\s*<testcase .* status="disabled"' "$report")
  bad=$((total - good - off))
  passed=$((passed + good)) failed=$((failed + bad)) skipped=$((skipped + off))
  if [ "$bad" -gt 0 ]; then failures+=("$bad of $total tests in $tree"); fi
}

stage_setup() { must setup ./setup.sh --lint; }
stage_build() { must 'release build' scripts/build release; }
stage_tests() { run_ctest build/release; }

stage_lint() {
  local script
  for script in scripts/check_*; do check "$script" "$script"; done
}

# Unit tests only: the others would need the time of all the rest together.
stage_sanitizers() {
  must 'asan build' scripts/build asan unit_tests || return
  run_ctest build/asan -L '^unit'
}

# Data races in what shares memory between threads.
stage_threads() {
  must 'tsan build' scripts/build tsan core_tests || return
  if build/tsan/bin/core_tests --gtest_list_tests 2>&1 | grep -q 'unexpected memory mapping'; then
    echo 'skipped: the thread sanitizer cannot map its memory on this kernel'
    skipped=$((skipped + 1))
    return
  fi
  run_ctest build/tsan -L '^unit-core$'
}

case "${1-}" in
  --list) tr ' ' '\n' <<<"$stages"; exit 0 ;;
  --quick) set -- ${stages/ sanitizers threads/} ;;
  '') set -- $stages ;;
esac
for stage in "$@"; do
  if ! grep -qw -- "$stage" <<<"$stages"; then
    echo "test.sh: expected stages of: $stages; found '$stage'" >&2
    exit 2
  fi
done
for stage in "$@"; do
  echo "== $stage"
  began=$SECONDS
  stage_"$stage"
  echo "== $stage took $((SECONDS - began)) s"
done
for failure in "${failures[@]-}"; do [ -z "$failure" ] || echo "failed: $failure"; done
echo "$passed passed, $failed failed$([ "$skipped" -eq 0 ] || echo ", $skipped skipped")"
[ "$failed" -eq 0 ]
