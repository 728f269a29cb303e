#!/usr/bin/env bash
# Last in gate_workflow.yml: `gate_verdict.sh SCENE CODE` after `binpick gate SCENE --out gate-run --markdown verdict.md
# --json verdict.json ..` has ended with CODE. Fills the summary page, writes replay.txt (a command for every pile that
# lost a verdict and every trial that failed to run), and says what the code means: 0 and 3 let the job pass.
set -euo pipefail
scene=$1 code=$2

# GitHub drops a summary of more than 1 MiB as a whole; the files are uploaded anyway.
if [ -f verdict.md ]; then head -c 1000000 verdict.md >> "$GITHUB_STEP_SUMMARY"; fi
python3 - "$scene" > replay.txt <<'PYTHON'
import glob, json, os, sys
if os.path.exists("verdict.json"):
    for flip in json.load(open("verdict.json"))["flips"]:
        if flip["lost"]:
            print(flip["replay"], " #", flip["what"])
for path in sorted(glob.glob("gate-run/records/*.jsonl")):
    for line in open(path, errors="replace"):
        try:
            record = json.loads(line)
        except ValueError:  # what a killed gate left of a line
            continue
        if "failure" in record:
            print("binpick trial", sys.argv[1], "--seed", record["seed"], " #", record["failure"])
PYTHON

case "$code" in
  0) ;;
  1) echo "::error::binpick gate $scene: worse than its baseline" ;;
  3) echo "::warning::binpick gate $scene: inconclusive, too few seeds to tell" && exit 0 ;;
  5) echo "::error::binpick gate $scene: more trials failed to run than crash_budget allows" ;;
  7) echo "::error::binpick gate $scene: bits differ that must be equal" ;;
  *) echo "::error::binpick gate $scene: exit code $code, see the log" ;;
esac
exit "$code"
