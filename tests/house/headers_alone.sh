#!/usr/bin/env bash
# Compiles each public header alone. Private headers (they say so in their first lines) may need third parties.
status=0
for header in "$@"; do
  head -n 4 "$SOURCE/$header" | grep -q 'rivate to' && continue
  "$CXX" -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -I"$SOURCE" -isystem "$EIGEN" -x c++ - <<<"#include \"$header\"" ||
    { echo "$header does not compile alone"; status=1; }
done
exit $status
