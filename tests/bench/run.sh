#!/usr/bin/env bash
# Runs the benchmarks (or the one that is named) and the whole scene, and writes their results to reports/perf/.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=${1:-}
for bench in build/release/tests/bench_*; do
  [ -x "$bench" ] || continue
  short=$(basename "$bench"); short=${short#bench_}
  [ -z "$name" ] || [ "$name" = "$short" ] || continue
  echo "bench: $short"
  "$bench" --benchmark_repetitions=3 --benchmark_report_aggregates_only=true \
    --benchmark_out="reports/perf/$short.json" --benchmark_out_format=json
  # The host's name and the path of the program say nothing about the result.
  sed -i -e '/"host_name"/d' -e '/"executable"/d' -e '/"date"/d' "reports/perf/$short.json"
done
if [ -z "$name" ] || [ "$name" = scene ]; then
  echo "bench: whole scene"
  out=$(mktemp -d)
  start=$(date +%s.%N)
  build/release/cli/swarf run scenes/lin_koren_dome/scene.toml -o "$out/run" 2> "$out/stages.txt"
  seconds=$(echo "$(date +%s.%N) - $start" | bc)
  { echo "scenes/lin_koren_dome, $(nproc) processors: $seconds s"; cat "$out/stages.txt"; } > reports/perf/scene.txt
  cat reports/perf/scene.txt
  rm -rf "$out"
fi
