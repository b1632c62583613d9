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

say "lengths of functions, comments of headers"
python3 tests/lint/functions.py || failed=1

say "theory and errata that comments name"
python3 tests/lint/theory.py || failed=1

say "options without a test"
python3 tests/lint/options.py || failed=1

say "tests that the README names"
python3 tests/lint/readme.py || failed=1

say "reference page of the machines"
python3 assets/machines/reference_page.py --check || failed=1

say "file sizes (600 lines)"
long=$(sources | xargs wc -l | awk '$2 != "total" && $1 > 600 {print "  " $2 ": " $1 " lines"}')
[ -z "$long" ] || { echo "$long"; failed=1; }

say "what must not be in the project"
if git grep -nIE '(^|[^A-Za-z0-9_.])/(work|home|root)/' -- . ':!tests/lint/lint.sh'; then say "a path of one machine"; failed=1; fi

say "clang-tidy"
python3 tests/lint/tidy.py || { say "clang-tidy has findings"; failed=1; }

[ $failed = 0 ] && say "clean"
exit $failed
