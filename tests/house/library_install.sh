#!/usr/bin/env bash
# The library as others take it: a configuration without the simulator looks for nothing of it, and the example of
# docs/library.md builds against an installed copy, finds what `binpick estimate` finds, and links nothing of the simulator.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
say() { echo "library_install: $*" >&2; exit 1; }

"$CMAKE" -S "$SOURCE" -B "$work/lean" -DBINPICK_WITH_SIM=OFF >"$work/log" 2>&1 || { tail -n 20 "$work/log"; say "does not configure"; }
grep -Eiq '^(BULLET|OSMESA|embree|URDFDOM|CLI11|GTest)[A-Za-z_0-9]*:' "$work/lean/CMakeCache.txt" &&
  say "without the simulator its packages are looked for all the same"

"$CMAKE" --install "$BUILD" --prefix "$work/prefix" --component library >"$work/log"
"$CMAKE" -S "$SOURCE/docs/examples/estimate_poses" -B "$work/build" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror $CXX_FLAGS" >"$work/log" 2>&1 &&
  "$CMAKE" --build "$work/build" >>"$work/log" 2>&1 || { tail -n 30 "$work/log"; say "the example does not build"; }
ldd "$work/build/estimate_poses" | grep -Ei 'bullet|osmesa|embree|urdf' && say "the example links the simulator"

cat >"$work/scene.yaml" <<YAML
part: $SOURCE/assets/parts/bearing_6914/part.yaml
count: 3
cell: $SOURCE/assets/cells/mz07_three_cups.yaml
trial: {max_picks: 1, execute: only_if_right}
YAML
"$PROGRAM" trial "$work/scene.yaml" --seed 3 --out "$work/run" >/dev/null 2>&1
frame="$work/run/artifacts/seed-3/00_frame"
"$work/build/estimate_poses" "$frame" | tee "$work/found"
[ "$(wc -l <"$work/found")" -eq "$(($(wc -l <"$frame/estimates.csv") - 1))" ] || say "finds another number of poses"
[ -s "$work/found" ] || say "finds nothing"
status=0
"$work/build/estimate_poses" "$work/nowhere" 2>"$work/said" || status=$?
[ "$status" -eq 2 ] && [ "$(wc -l <"$work/said")" -eq 1 ] || say "a missing folder is not one line and exit 2"
