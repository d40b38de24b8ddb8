#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The main job, start to end, with a robot on two wheels and without a compass. It explores a mesh
# that it does not know, by its own map, whose errors fall from tour to tour. Then something is wrong
# with it that its model does not know: the model fails, the missing effect is named and added, the
# map is built again, and good. Usage: maps/demo.sh [--verbose], which prints every command's tables.
set -euo pipefail
cd "$(dirname "$0")/.."
verbose=${1:-}
trussmap=build/trussmap
out=build/demo
rec=$out/recording
mkdir -p "$out"

# Runs a command; its output goes to a file, and with --verbose to the terminal.
run() {
  local to=$1
  shift
  printf '$'
  printf ' %q' "$@"
  printf '\n'
  if [ "$verbose" = --verbose ]; then
    "$@" | tee "$to"
    echo
  else
    "$@" >"$to"
  fi
}
verdict() { sed -n '2s/:.*//p' "$1"; }                       # the verdict's word
number() { sed -n "s/^ *$2  *\([0-9.]*\) m.*/\1/p" "$1"; }   # the number behind a label

run "$out/explore.txt" "$trussmap" explore --mesh 6x6 --uneven --no-compass --seed 1 \
  --html "$out/explore.html" --svg "$out/explore.svg"
printf '\n'
head -1 "$out/explore.txt"
awk '$1 ~ /^[0-9]+$/ {printf "  after %5s m  %s landmarks, %s m off (mean)\n", $2, $3, $4}' "$out/explore.txt"
printf '\n'

run "$out/simulate.txt" "$trussmap" simulate --hide --mesh 5x5 --uneven --tours 3 --seed 5 \
  --no-compass --out "$rec"
run "$out/before.txt" "$trussmap" build "$rec" --model "$rec/model.toml"
run "$out/compare.txt" "$trussmap" compare "$rec" --model "$rec/model.toml"
run "$out/diagnose.txt" "$trussmap" diagnose "$rec" --model "$rec/model.toml" \
  --html "$out/diagnose.html"
effect=$(sed -n '1s/^missing: \(.*\); .*/\1/p' "$out/diagnose.txt")
run "$out/add.txt" "$trussmap" add "$rec/model.toml" "$effect" --out "$out/added.toml"
run "$out/fit.txt" "$trussmap" fit "$rec" --model "$out/added.toml" --out "$out/fitted.toml"
run "$out/after.txt" "$trussmap" build "$rec" --model "$out/fitted.toml" \
  --out "$out/map.graphml" --svg "$out/map.svg" --html "$out/map.html"
run "$out/reveal.txt" "$trussmap" reveal "$rec"

printf '\n'
printf 'before   %s: landmarks are %s m off (rms), by dead reckoning %s m\n' \
  "$(verdict "$out/before.txt")" "$(number "$out/before.txt" 'rms error of the map')" \
  "$(number "$out/before.txt" 'rms of dead reckoning')"
printf 'compare  %s\n' "$(head -1 "$out/compare.txt")"
printf 'diagnose %s\n' "$(head -1 "$out/diagnose.txt")"
printf 'hidden   %s\n' "$(awk -F '  +' 'NR == 5 {print $2 ", coefficient " $4}' "$out/reveal.txt")"
printf 'after    %s: landmarks are %s m off (rms), by dead reckoning %s m\n' \
  "$(verdict "$out/after.txt")" "$(number "$out/after.txt" 'rms error of the map')" \
  "$(number "$out/after.txt" 'rms of dead reckoning')"
printf 'pages    %s, %s, %s\n' "$out/explore.html" "$out/diagnose.html" "$out/map.html"
