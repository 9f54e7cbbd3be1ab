#!/usr/bin/env bash
# ctest.sh FOLDER [CTEST OPTION...]: runs the tests built in FOLDER. Prints what failed, why some were
# skipped, the ten slowest, and ctest's closing line last; the whole log stays in FOLDER/ctest.log.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$1
shift
source "$root/tools/slice.sh"
log=$folder/ctest.log

ctest --test-dir "$folder" --output-on-failure -j "$(nproc)" --no-tests=error "$@" >"$log" 2>&1
status=$?
if [ $status -ne 0 ]; then
  grep -vE '(Passed|Skipped) +[0-9.]+ sec$|^ +Start +[0-9]+:' "$log" >&2
fi
skipped=$(grep -c ': Skipped$' "$folder/Testing/Temporary/LastTest.log")
reasons=$(awk '/: Skipped$/ { getline; print }' "$folder/Testing/Temporary/LastTest.log" |
  sed -E 's|/[^/"]*"|/..."|' | sort | uniq -c)
if [ -n "$reasons" ]; then
  echo "$skipped cases were skipped, because:"
  echo "$reasons"
fi
real=$(grep 'shared/data' <<<"$reasons" | awk '{ sum += $1 } END { print sum + 0 }')
echo "$real tests were skipped for want of real data."
if [ "$real" -ne 0 ]; then
  echo "Real data stays outside the repository, in ../shared/data: hid/ holds recordings of pads"
  echo "(gaitpad record PAD --out FILE.hid makes one), mocap/ captured motions (mocap.cs.cmu.edu)."
fi
echo "The ten slowest tests:"
sed -nE 's|^ *[0-9]+/[0-9]+ Test +#[0-9]+: +([^ ]+) .* ([0-9.]+) sec.*|\2 s  \1|p' "$log" | sort -rn | head -n 10
grep -E '^Total Test time' "$log"
grep -E 'tests passed, [0-9]+ tests? failed' "$log" || tail -n 1 "$log"
exit $status
