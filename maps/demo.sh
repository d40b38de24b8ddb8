#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The main job, start to end: a robot without a compass tours a mesh, and something is wrong with it
# that its model does not know. Its map is built, and doubtful; what is missing is found; the map is
# built again, and good. Usage: maps/demo.sh [--verbose], which prints every command's tables.
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
  printf '$ %s\n' "$*"
  if [ "$verbose" = --verbose ]; then
    "$@" | tee "$to"
    echo
  else
    "$@" >"$to"
  fi
}
# value FILE: the verdict's word; value FILE LABEL: the number behind a label.
verdict() { sed -n '2s/:.*//p' "$1"; }
number() { sed -n "s/^ *$2  *\([0-9.]*\) m.*/\1/p" "$1"; }

run "$out/simulate.txt" "$trussmap" simulate --hide --mesh 6x6 --uneven --tours 3 --seed 1 \
  --no-compass --out "$rec"
run "$out/before.txt" "$trussmap" build "$rec" --model "$rec/model.toml"
run "$out/discover.txt" "$trussmap" discover "$rec" --model "$rec/model.toml" \
  --out "$out/found.toml" --html "$out/discover.html"
run "$out/after.txt" "$trussmap" build "$rec" --model "$out/found.toml" \
  --out "$out/map.graphml" --svg "$out/map.svg" --html "$out/map.html"
run "$out/reveal.txt" "$trussmap" reveal "$rec"

printf '\n'
printf 'before   %s: landmarks are %s m off (rms), by dead reckoning %s m\n' \
  "$(verdict "$out/before.txt")" "$(number "$out/before.txt" 'rms error of the map')" \
  "$(number "$out/before.txt" 'rms of dead reckoning')"
printf 'missing  %s\n' "$(sed -n 2p "$out/discover.txt" | sed 's/^ *//')"
printf 'hidden   %s\n' "$(awk -F '  +' 'NR == 5 {print $2 ", coefficient " $4}' "$out/reveal.txt")"
printf 'after    %s: landmarks are %s m off (rms)\n' \
  "$(verdict "$out/after.txt")" "$(number "$out/after.txt" 'rms error of the map')"
printf 'pages    %s, %s\n' "$out/map.html" "$out/discover.html"
