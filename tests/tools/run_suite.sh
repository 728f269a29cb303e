#!/usr/bin/env bash
# One scene of scenes/ci against its committed baseline. Passes when nothing is found to be worse: with equal bits (exit
# code 0), or, where the bits of this machine are others, when two dozen piles show no loss (0) or cannot tell (3).
set -u
"$PROGRAM" gate "$SOURCE/scenes/ci/$1.yaml" --baseline "$SOURCE/scenes/ci/$1.baseline.jsonl" --block 24 \
  --margins "$SOURCE/scenes/ci/margins.yaml" --workers 2
code=$?
echo "binpick gate: exit code $code"
[ $code -eq 0 ] || [ $code -eq 3 ]
