#!/usr/bin/env bash
# Each public header compiles alone, and needs no third party but Eigen. Private headers (they say so in their first lines)
# may. Where a .cpp includes its own header before anything else the build has compiled it alone already, so that only its
# includes are read here; the others are compiled, syntax only.
status=0
for header in "$@"; do
  head -n 4 "$SOURCE/$header" | grep -q 'rivate to' && continue
  foreign=$(grep -E '^ *# *include *<' "$SOURCE/$header" | grep -vE '<(Eigen/[A-Za-z]+|[a-z_]+)>')
  [ -z "$foreign" ] || { echo "$header needs a third party: $foreign"; status=1; }
  own="$SOURCE/${header%.hpp}.cpp"
  [ -f "$own" ] && [ "$(grep -m 1 -E '^ *# *include' "$own")" = "#include \"$header\"" ] && continue
  "$CXX" -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -I"$SOURCE" -isystem "$EIGEN" -x c++ - <<<"#include \"$header\"" ||
    { echo "$header does not compile alone"; status=1; }
done
exit $status
