#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs each fuzz target for some seconds from its corpus, and counts the executions of all.
#   tests/fuzz/run.sh BUILD SECONDS [TARGET...]      BUILD: the folder of a build with LUMEN_FUZZ (tests/fuzz/CMakeLists.txt)
# Exit status: 1 if a target ends by a fault; inputs that show it stay in BUILD/tests/fuzz/found.
set -uo pipefail
build=$(realpath "$1") seconds=$2
shift 2
corpora=$(realpath "$(dirname "${BASH_SOURCE[0]}")/corpus")
found=$build/tests/fuzz/found
mkdir -p "$found"
if [ $# -eq 0 ]; then
  mapfile -t names < <(find "$build/tests/fuzz" -maxdepth 1 -name 'fuzz_*' -type f -perm -u+x -printf '%f\n' | sed 's/^fuzz_//' | sort)
  set -- "${names[@]}"
fi
all=0 status=0
for target; do
  seeds=("$corpora/$target")
  case $target in
    binary | json) seeds=("$build/spec/conformance/valid" "$build/spec/conformance/hostile") ;;
    round_trip) seeds=("$build/spec/conformance/valid") ;;
    vtp | vtp_lines) seeds+=("$corpora/../../data/vtk") ;;
    graph_csv | graphml | spatial_graph | swc | tre) seeds+=("$corpora/../../data/neighbours") ;;
  esac
  for seed in "${!seeds[@]}"; do [ -d "${seeds[$seed]}" ] || unset "seeds[$seed]"; done
  made=$(mktemp -d)
  log=$made.log
  nice -n 10 "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -malloc_limit_mb=256 -rss_limit_mb=4096 -timeout=60 \
    -print_final_stats=1 -artifact_prefix="$found/$target-" "$made" "${seeds[@]}" >"$log" 2>&1 || { status=1; tail -n 30 "$log"; }
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-16s %12d executions\n' "$target" "${runs:-0}"
  all=$((all + ${runs:-0}))
  rm -rf "$made" "$log"
done
printf '%-16s %12d executions\n' all "$all"
exit $status
