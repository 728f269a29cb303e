#!/usr/bin/env bash
# Kills a campaign, again and again, and shows that nothing is lost, doubled or changed.
#   kill_campaign.sh PROGRAM SCENE SEEDS KILLS FOLDER [RANDOM_SEED]
# A first campaign runs undisturbed. A second one is killed KILLS times with signal 9, its coordinator and one of its
# workers by turns, and started again until it is complete. Both folders must then hold the same canonical.jsonl, byte
# for byte.
set -u
program=$1 scene=$2 seeds=$3 kills=$4 folder=$5
RANDOM=${6:-1}
campaign=("$program" campaign "$scene" --seeds "$seeds" --workers 2 --pictured -1 --out)

"${campaign[@]}" "$folder/whole" >/dev/null 2>"$folder/whole.log" || { echo "undisturbed: exit code $?"; exit 1; }
killed=0 starts=0
while :; do
  ((++starts > 20 * kills + 20)) && { echo "does not come to an end"; exit 1; }
  "${campaign[@]}" "$folder/killed" >/dev/null 2>>"$folder/killed.log" &
  coordinator=$!
  while ((killed < kills)); do
    sleep "$((RANDOM % 2)).$((RANDOM % 90 + 10))"
    kill -0 $coordinator 2>/dev/null || break
    if ((killed % 2 == 0)); then
      kill -9 $coordinator 2>/dev/null && ((++killed))
      break
    fi
    worker=$(pgrep -P $coordinator | shuf -n 1 --random-source=<(yes $RANDOM))
    [ -n "$worker" ] && kill -9 "$worker" 2>/dev/null && ((++killed))
  done
  wait $coordinator
  code=$?
  if [ $code -eq 0 ]; then
    ((killed >= kills)) && break
    # Complete before it was killed often enough: the last records go, as if the disk had never seen them.
    lines=$(wc -l <"$folder/killed/records/records.jsonl")
    head -n $((lines / 2)) "$folder/killed/records/records.jsonl" >"$folder/kept" &&
      mv "$folder/kept" "$folder/killed/records/records.jsonl"
  elif [ $code -ne 137 ]; then
    echo "exit code $code after $killed kills"
    exit 1
  fi
done
cmp "$folder/whole/canonical.jsonl" "$folder/killed/canonical.jsonl" || exit 1
echo "$killed kills, $starts starts, $(wc -l <"$folder/whole/canonical.jsonl") trials: byte-equal"
