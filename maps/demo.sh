#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The main job, start to end: a simulated robot without a compass tours a mesh, its recording
# becomes a corrected map with a picture, every method is compared with the truth per tour, and the
# effect that is hidden in a recording is found.
set -euo pipefail
cd "$(dirname "$0")/.."
run() {
  printf '\n$ %s\n' "$*"
  "$@"
}
trussmap=build/trussmap
out=build/demo
mkdir -p "$out"

run "$trussmap" simulate --mesh 6x6 --uneven --tours 3 --seed 1 --no-compass --out "$out/recording"
run "$trussmap" build "$out/recording" --model "$out/recording/model.toml" \
  --out "$out/map.graphml" --svg "$out/map.svg"
run "$trussmap" tour --mesh 6x6 --spacing 5 --tours 20 --seeds 24 --json "$out/tours.json"
run "$trussmap" umbmark maps/square_runs.csv maps/square_runs_2.csv --wheelbase 0.34 --plots "$out"
run "$trussmap" discover maps/riddle --model maps/riddle/model.toml --out "$out/riddle.toml"

printf '\nThe map before and after correction: %s\n' "$out/map.svg"
