#!/usr/bin/env bash
# Builds Lumenline and runs its tests: all but those labelled `long`; with --all, those too. Then fuzzes each reader for
# some seconds where there is clang.
# Usage: bash tests/run.sh [--all]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
exclude=(--label-exclude '^long$')
case "${1:-}" in
    --all) exclude=() ;;
    "") ;;
    *) echo "usage: bash tests/run.sh [--all]" >&2; exit 2 ;;
esac
bash "$root/examples/setup.sh" build test browser
cd "$root"
cmake --preset release -DLUMENLINE_TESTS=ON -DLUMENLINE_BENCH=ON
cmake --build --preset release
ctest --test-dir build/release --output-on-failure --no-tests=error --parallel "$(nproc)" "${exclude[@]}"
if echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
    clang++ -x c++ -fsanitize=fuzzer,address - -o /dev/null 2>/dev/null; then
    bash "$root/tests/fuzz/run.sh" 5
else
    echo "run.sh: there is no clang++ with libFuzzer here (Debian: clang libclang-rt-14-dev): readers not fuzzed" >&2
fi
