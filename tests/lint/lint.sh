#!/usr/bin/env bash
# Everything that is checked without running the program. Fails on the first group that has findings.
set -uo pipefail
cd "$(dirname "$0")/../.."
failed=0
say() { echo "lint: $*"; }

sources() { git ls-files -co --exclude-standard '*.h' '*.cpp' ':!tests/data' | while read -r f; do [ -e "$f" ] && echo "$f"; done; }

say "clang-format"
sources | xargs clang-format --dry-run --Werror || { say "run clang-format -i on the files above"; failed=1; }

say "include directions and folders of heavy libraries"
python3 tests/lint/includes.py || failed=1

say "rooms inside modules, methods per class"
python3 tests/lint/rooms.py || failed=1

say "names that files compiled as one must not share"
python3 tests/lint/unity.py || failed=1

say "reference page of the machines"
python3 assets/machines/reference_page.py --check || failed=1

say "file sizes (600 lines)"
long=$(sources | xargs wc -l | awk '$2 != "total" && $1 > 600 {print "  " $2 ": " $1 " lines"}')
[ -z "$long" ] || { echo "$long"; failed=1; }

say "what must not be in the project"
if git grep -nIE '(^|[^A-Za-z0-9_.])/(work|home|root)/' -- . ':!tests/lint/lint.sh'; then say "a path of one machine"; failed=1; fi

# clang-tidy reads every header of every file: the slow part. Only what changed since the last clean run is read again.
say "clang-tidy"
stamp=build/lint-stamps; mkdir -p "$stamp"
config=$(cksum < .clang-tidy | cut -d' ' -f1)
list=$(sources | grep '\.cpp$' | grep -v '^tests/')
headers=$(sources | grep '\.h$' | xargs cat | cksum | cut -d' ' -f1)
export stamp config headers
echo "$list" | xargs -P "$(nproc)" -I{} bash -c '
  key="$stamp/$(echo "{}" | tr / _)-$(cksum < "{}" | cut -d" " -f1)-$headers-$config"
  [ -e "$key" ] && exit 0
  if clang-tidy --quiet -p build/release "{}" 2>/dev/null > "$key.log"; then mv "$key.log" "$key"; else cat "$key.log"; rm -f "$key.log"; exit 1; fi
' || { say "clang-tidy has findings"; failed=1; }

[ $failed = 0 ] && say "clean"
exit $failed
