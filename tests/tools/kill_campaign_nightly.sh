#!/usr/bin/env bash
# kill_campaign.sh on a scene of its own: kill_campaign_nightly.sh PROGRAM SOURCE KILLS
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/scene.yaml" <<END
name: tiny
part: $2/assets/parts/bearing_6914/part.yaml
count: 2
cell: $2/assets/cells/mz07_three_cups.yaml
estimator: {type: oracle}
trial: {max_picks: 1}
END
bash "$2/tests/tools/kill_campaign.sh" "$1" "$folder/scene.yaml" 1:101 "$3" "$folder" 7
