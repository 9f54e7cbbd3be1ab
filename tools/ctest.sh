#!/usr/bin/env bash
# ctest.sh FOLDER [CTEST OPTION...]: runs the tests built in FOLDER. Prints what failed, why some were
# skipped, and ctest's closing line last; the whole log stays in FOLDER/ctest.log.
set -uo pipefail
folder=$1
shift
log=$folder/ctest.log

ctest --test-dir "$folder" --output-on-failure -j "$(nproc)" --no-tests=error "$@" >"$log" 2>&1
status=$?
if [ $status -ne 0 ]; then
  grep -vE '(Passed|Skipped) +[0-9.]+ sec$|^ +Start +[0-9]+:' "$log" >&2
fi
skipped=$(grep -c ': Skipped$' "$folder/Testing/Temporary/LastTest.log")
if [ "$skipped" -ne 0 ]; then
  echo "$skipped cases were skipped, because:"
  awk '/: Skipped$/ { getline; print }' "$folder/Testing/Temporary/LastTest.log" |
    sed -E 's|/[^/"]*"|/..."|' | sort | uniq -c
fi
grep -E '^Total Test time' "$log"
grep -E 'tests passed, [0-9]+ tests? failed' "$log" || tail -n 1 "$log"
exit $status
