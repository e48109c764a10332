# SPDX-License-Identifier: Apache-2.0
# Runs the stages of a script that includes it: usage(), all=(NAME...), and stage_NAME() of each.

# built_and_tested PRESET
built_and_tested() {
  cmake --preset "$1" && cmake --build --preset "$1" && ctest --preset "$1" -j "$(nproc)"
}

times=()

# run_stage NAME: its output, its time, and at a failure how to see it again.
run_stage() {
  local begin=$SECONDS status=0
  printf '\n==== %s\n' "$1"
  "stage_$1" </dev/null || status=$?
  local took=$((SECONDS - begin))
  times+=("$(printf '%-9s %2d min %02d s' "$1" $((took / 60)) $((took % 60)))")
  [ $status -eq 0 ] && return
  times[-1]+="  FAILED"
  printf '\n==== %s failed. The same again, here: %s %s\n' "$1" "$0" "$1" >&2
  return 1
}

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
wanted=("$@")
case "${1:-}" in -h | --help) usage; exit 0 ;; esac
[ $# -gt 0 ] || wanted=("${all[@]}")
for stage in "${wanted[@]}"; do
  [[ " ${all[*]} " == *" $stage "* ]] && continue
  usage >&2
  exit 2
done
status=0
for stage in "${wanted[@]}"; do
  run_stage "$stage" || { status=1; [ -n "${go_on:-}" ] || break; }
done
printf '\n==== Stages\n'
printf '%s\n' "${times[@]}"
exit $status
