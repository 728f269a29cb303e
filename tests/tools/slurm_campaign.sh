#!/usr/bin/env bash
# A campaign on a real Slurm with four emulated nodes, one of which is lost in the middle: the merged run must be
# byte-equal to that of one machine.
#   slurm_campaign.sh PROGRAM SOURCE
# Exit code 77: skipped, since Slurm cannot run here. Everything it starts is its own, in a folder of its own, and ends
# with it.
set -u
program=$1 source=$2
. "$source/tests/tools/slurm_emulated.sh"
missing=$(slurm_missing)
[ -z "$missing" ] || { echo "skipped: $missing"; exit 77; }
folder=$(mktemp -d)
trap 'slurm_stop "$folder/slurm"; rm -rf "$folder"' EXIT
trap 'exit 1' INT TERM
seeds=1:25 shards=5
scene=$folder/scene.yaml run=$folder/run
cat >"$scene" <<YAML
name: slurm
part: $source/assets/parts/bearing_6914/part.yaml
count: 3
cell: $source/assets/cells/mz07_three_cups.yaml
sensor: {type: ideal}
estimator: {type: oracle}
trial: {max_picks: 2}
YAML
fail() {
  echo "failed: $1"
  cat "$folder"/*.log 2>/dev/null | tail -n 40
  tail -n 20 "$folder/slurm/slurmctld.log" 2>/dev/null
  exit 1
}

"$program" campaign "$scene" --seeds $seeds --workers 2 --pictured -1 --out "$folder/whole" >/dev/null 2>"$folder/whole.log" ||
  fail "on one machine: exit code $?"

mkdir "$folder/slurm"
slurm_start "$folder/slurm" || fail "Slurm did not start"
cd "$folder" || exit 1
jobs=$(BINPICK=$program "$source/tools/slurm/submit" $shards "$run" campaign "$scene" --seeds $seeds --pictured -1) ||
  fail "submit"
echo "array and merge: $jobs"

# The node that holds shard 2 is lost when the shard has its first record, and before its last.
records=$run.shards/2/records/records.jsonl
for _ in $(seq 600); do [ -s "$records" ] && break; sleep 0.1; done
node=$(squeue -h -r -o '%K %N' | awk '$1 == 2 { print $2 }')
[ -n "$node" ] || fail "shard 2 is not running when its first record is there"
slurm_kill_node "$folder/slurm" "$node"
sleep 1
before=$(wc -l <"$records")
echo "node $node killed; shard 2 had $before records"
[ "$before" -ge 1 ] || fail "there was nothing yet to complete"

for _ in $(seq 300); do
  [ -z "$(squeue -h 2>/dev/null)" ] && break
  sleep 1
done
[ -z "$(squeue -h)" ] || { squeue; fail "the jobs did not come to an end"; }
after=$(wc -l <"$records")
[ "$after" -gt "$before" ] || fail "the node was lost after the shard's last record: nothing was tested"
grep -q "requeue job.*due to failure of node $node" "$folder/slurm/slurmctld.log" || fail "nothing was requeued"
grep -hq 'shard 2 of.*start 1' "$folder"/binpick-*_2.log || fail "shard 2 was not started again"
cmp "$folder/whole/canonical.jsonl" "$run/canonical.jsonl" || fail "the merged run differs"
echo "$(wc -l <"$run/canonical.jsonl") trials in $shards shards on 4 nodes, one killed: shard 2 had $before records and was completed to" \
  "$after; byte-equal"
