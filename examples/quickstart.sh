#!/usr/bin/env bash
# From a bare Debian 12 machine to an archive of centerlines: installs what is missing, builds
# Lumenline, and runs the example cohort.
# Usage: bash examples/quickstart.sh
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
echo "== 1 of 3: packages"
bash examples/setup.sh build
echo "== 2 of 3: build (a few minutes the first time)"
cmake --preset release -DLUMENLINE_TESTS=OFF -DLUMENLINE_BENCH=OFF >/dev/null
cmake --build --preset release --target lumenline
echo "== 3 of 3: the example cohort (examples/cohort.yaml)"
status=0
build/release/lumenline run examples/cohort.yaml || status=$?
cat <<'NEXT'

Next, try:
  build/release/lumenline browse examples/results show portal_vein
  build/release/lumenline browse examples/results get portal_vein /centerlines/radius | head
  build/release/lumenline browse examples/results tree arch_to_willis
  build/release/lumenline browse examples/results serve
  build/release/lumenline report examples/results -o report.html
  build/release/lumenline model examples/liver/gastric_vein.vtk --inlet=27.54,-177.74,-276.02 --outlet=-27.10,-187.21,-275.55 -o gastric.hdf
  paraview examples/results/models/portal_vein.hdf
  bash tests/run.sh
NEXT
exit "$status"
