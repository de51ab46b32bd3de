#!/usr/bin/env bash
# check.sh PROGRAM BUILD_TYPE: counts instructions of fixed work under callgrind and compares with
# baseline.txt; more than 3 % above it fails. Another compiler makes other instructions, so the
# comparison is made with the one that the baseline names, in a release build; elsewhere the counts
# are printed. `check.sh PROGRAM Release --write` writes a new baseline, to be committed with the
# change that earned it.
set -euo pipefail
program=$1
type=$2
baseline=$(dirname "$0")/baseline.txt

command -v valgrind >/dev/null || {
  echo "valgrind is not here: nothing counted (scripts/setup test installs it)"
  exit 0
}
compiler="g++ $(g++ -dumpversion)"
found="# compiler: $compiler, $("$program" any | cut -d' ' -f2)"$'\n'
for what in build scalar vector any; do
  count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=counted_work \
    "$program" $what 2>&1 | sed -n 's/.*Collected : *\([0-9]*\).*/\1/p')
  found+="$what $count"$'\n'
done
printf '%s' "$found"
if [ "${3:-}" = --write ]; then
  printf '%s' "$found" >"$baseline"
  exit 0
fi
if [ "$type" != Release ] || [ "$(head -1 "$baseline")" != "$(head -1 <<<"$found")" ]; then
  echo "no comparison: the baseline is for a release build by $(head -1 "$baseline")"
  exit 0
fi
wrong=0
while read -r what count; do
  [ "$what" != '#' ] || continue
  now=$(awk -v what="$what" '$1 == what {print $2}' <<<"$found")
  awk -v what="$what" -v was="$count" -v now="$now" 'BEGIN {
    printf "%s: %+.2f %% against the baseline\n", what, 100 * (now / was - 1)
    exit now > 1.03 * was
  }' || { echo "$what takes more instructions than it did"; wrong=1; }
done <"$baseline"
exit $wrong
