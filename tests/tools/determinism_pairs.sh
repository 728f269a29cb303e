#!/usr/bin/env bash
# Pairs of (seed, way to run it): the same bits every time?
#   determinism_pairs.sh PROGRAM SOURCE SMALL WHOLE [FOLDER]
# SMALL seeds of two bearings under a stereo camera, found by ppf, one pick, in fifteen ways; WHOLE seeds of the shipped
# bearing scene, to the last pick, in five. Ways: numbers of workers, orders of the seeds, a fresh worker for every trial, no disk
# cache, processor features hidden from libm, the renderer and OpenCV. canonical.jsonl must be that of one worker, seeds
# in order, byte for byte.
set -u
program=$1 source=$2 small=$3 whole=$4 folder=${5:-$(mktemp -d)}
mkdir -p "$folder"
cat >"$folder/small.yaml" <<END
name: small
part: $source/assets/parts/bearing_6914/part.yaml
count: 2
cell: $source/assets/cells/mz07_three_cups.yaml
sensor: {type: disparity, preset: d435_848}
estimator: {type: ppf}
trial: {max_picks: 1}
END
ways=(
  "--workers 2" "--workers 4" "--workers 8 --shuffle 1" "--workers 1 --shuffle 2" "--workers 2 --worker-trials 1"
  "--workers 3 --shuffle 3 --worker-trials 2" "--workers 1|BINPICK_CACHE=off" "--workers 2 --shuffle 4|OPENCV_CPU_DISABLE=AVX2,AVX,FP16"
  "--workers 2|OPENCV_CPU_DISABLE=AVX512-SKX,AVX2,AVX,FP16,POPCNT,SSE4.2,SSE4.1,SSSE3"
  "--workers 2|GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-SSE4_1,-FMA,-AVX2" "--workers 2 --shuffle 5|GALLIUM_OVERRIDE_CPU_CAPS=sse2"
  "--workers 1|LP_NUM_THREADS=4" "--workers 2|OMP_NUM_THREADS=4 LC_ALL=C.UTF-8 TZ=Asia/Tokyo" "--workers 4 --worker-trials 3 --shuffle 6"
  "--workers 2|MALLOC_PERTURB_=165 MALLOC_ARENA_MAX=1"
)
pairs=0 differ=0
# compare NAME SCENE SEEDS NUMBER_OF_WAYS
compare() {
  local name=$1 scene=$2 seeds=$3 number=$4 way options settings k
  "$program" campaign "$scene" --seeds 5000:$((5000 + seeds)) --workers 1 --pictured -1 --out "$folder/$name" >/dev/null 2>&1 ||
    { echo "$name: exit code $?"; exit 1; }
  for ((k = 0; k < number; ++k)); do
    way=${ways[k]} options=${ways[k]%%|*} settings=
    [ "$options" = "$way" ] || settings=${way#*|}
    rm -rf "$folder/again"
    # shellcheck disable=SC2086
    env $settings "$program" campaign "$scene" --seeds 5000:$((5000 + seeds)) $options --pictured -1 --out "$folder/again" >/dev/null 2>&1 ||
      { echo "$name, $way: exit code $?"; exit 1; }
    pairs=$((pairs + seeds))
    local other
    other=$(diff "$folder/$name/canonical.jsonl" "$folder/again/canonical.jsonl" | grep -c '^>')
    [ "$other" -eq 0 ] || echo "$name, $way: $other of $seeds records differ"
    differ=$((differ + other))
  done
}
[ "$small" -eq 0 ] || compare small "$folder/small.yaml" "$small" ${#ways[@]}
[ "$whole" -eq 0 ] || compare whole "$source/scenes/bearing_bin.yaml" "$whole" 5
echo "$differ of $pairs (seed, way) pairs differ"
[ "$differ" -eq 0 ]
