#!/usr/bin/env bash
# Builds the fuzzers of the readers with clang in build/fuzz and lets each run for some seconds, from the corpus and what
# earlier runs added to it in build/fuzz/work. A finding stops it; its bytes are left in build/fuzz/findings.
# Usage: bash tests/fuzz/run.sh [SECONDS]   (of each reader; 10 if not given)
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-10}
readers=(stl ply obj off vtk_legacy vtk_xml)
build=$root/build/fuzz
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DLUMENLINE_TESTS=ON -DLUMENLINE_BENCH=OFF -DLUMENLINE_FUZZ=ON \
    -DLUMENLINE_SANITIZE=fuzzer-no-link,address,undefined >/dev/null
cmake --build "$build" --target "${readers[@]/#/fuzz_}"
mkdir -p "$build/findings"
for reader in "${readers[@]}"; do
    mkdir -p "$build/work/$reader"
    log=$build/$reader.log
    if ! "$build/tests/fuzz/fuzz_$reader" -seed=1 -max_total_time="$seconds" -max_len=8192 -timeout=20 -rss_limit_mb=2048 \
        -print_final_stats=1 -artifact_prefix="$build/findings/$reader-" \
        "$build/work/$reader" "$root/tests/fuzz/corpus/$reader" >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        echo "fuzz_$reader: a finding; its bytes are in $build/findings" >&2
        exit 1
    fi
    echo "fuzz_$reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") files in $seconds s, no finding"
done
