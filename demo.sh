#!/usr/bin/env bash
# Sets everything up, simulates a drive in the article's corridor, makes a map of its survey,
# localizes the drive in that map, prints the result and writes the report.
#   ./demo.sh [SCENARIO [SEED]]      corridor (default), office, hall, ...: holdfast simulate --list
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
scenario=${1:-corridor}
seed=${2:-1}

./setup.sh
holdfast=build/release/bin/holdfast
out=demo_out/$scenario-$seed
mkdir -p demo_out

step() { printf '\n%s\n' "== $*"; }

step "simulate a drive: $scenario, seed $seed"
"$holdfast" simulate "$scenario" --seed "$seed" --out "$out/log" --threads "$(nproc)"
step "import the surveyed map"
"$holdfast" map import "$out/log/map.pcd" --out "$out/map"
step "localize"
pose=$(sed -n 's/^# initial_pose: //p' "$out/log/config.yaml")
"$holdfast" localize "$out/log/run.bag" --map "$out/map" --out "$out/run" --initial-pose "$pose"
step "evaluate against the truth"
"$holdfast" evaluate "$out/run/trajectory.tum" --truth "$out/log/truth.tum" \
  --events "$out/log/events.jsonl" --report
printf '\nThe report: %s\n' "$PWD/$out/run/report.html"
