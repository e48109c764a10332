#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_format.sh [--fix] [FILE...]: reports the C and C++ files that clang-format-14 would lay out otherwise, all
# tracked ones without a FILE; with --fix lays them out. Other versions of clang-format differ.
set -euo pipefail
fix=0
if [ "${1:-}" = --fix ]; then
  fix=1
  shift
fi
format=$(command -v clang-format-14) || {
  echo "check_format.sh: clang-format-14 is missing; Debian: apt install clang-format-14" >&2
  exit 1
}
if [ $# -gt 0 ]; then
  files=("$@")
else
  cd "$(dirname "${BASH_SOURCE[0]}")/.."
  mapfile -t files < <(git ls-files '*.c' '*.h' '*.cpp')
fi

if [ $fix -eq 1 ]; then
  "$format" -i "${files[@]}"
elif ! "$format" --dry-run -Werror "${files[@]}"; then
  echo "check_format.sh: tests/check_format.sh --fix lays these files out" >&2
  exit 1
else
  echo "${#files[@]} files are laid out as .clang-format states"
fi
