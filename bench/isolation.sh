#!/usr/bin/env bash
# What worker processes cost: runs of one cohort of phantoms with and without them, in turns, and the median ratio.
# Usage: bash bench/isolation.sh LUMENLINE [MODELS [POINTS_AROUND [PAIRS]]]
set -euo pipefail
lumenline=$(realpath "$1")
models=${2:-40} around=${3:-32} pairs=${4:-7}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
printf 'id\tsurface\n' > models.tsv
for i in $(seq "$models"); do
    [ "$i" -gt 4 ] || "$lumenline" phantom cylinder --a 5 --b 3 --points-around "$around" --jitter 0.2 --seed "$i" -o "s$i.ply"
    printf 'm%d\ts%d.ply\n' "$i" $(((i - 1) % 4 + 1)) >> models.tsv
done
printf 'cohort: isolation\nmodels: {table: models.tsv}\n' > cohort.yaml
seconds() {
    rm -rf results
    local start end
    start=$(date +%s%N)
    "$lumenline" run cohort.yaml --isolation "$1" > /dev/null 2>&1
    end=$(date +%s%N)
    echo $(((end - start) / 1000000))
}
seconds none > /dev/null
for pair in $(seq "$pairs"); do
    if [ $((pair % 2)) -eq 0 ]; then
        with=$(seconds process) without=$(seconds none)
    else
        without=$(seconds none) with=$(seconds process)
    fi
    echo "$with $without"
done | awk '{ ratio = $1 / $2; print "process " $1 " ms, none " $2 " ms, ratio " ratio; print ratio | "sort -n > ratios" }'
awk -v models="$models" '{ r[NR] = $1 } END { print models " models: median ratio " r[int((NR + 1) / 2)] " (" r[1] " to " r[NR] ")" }' ratios
