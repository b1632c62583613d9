#!/bin/sh
# page.sh [--pictures FOLDER] [--leading] REPORT.html...: opens the pages in headless Chromium (page.mjs). Playwright and axe come by npm into
# build/ on first use; Chromium is Debian's. Exits 77 and says so where there is no Chromium.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
modules="$here/../../build/page_check"
if ! command -v chromium >/dev/null; then
  echo "page.sh: NOT CHECKED: there is no chromium here (apt package chromium)" >&2
  exit 77
fi
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "page.sh: node and npm are needed (apt packages nodejs, npm)" >&2
  exit 1
fi
if ! cmp -s "$here/package-lock.json" "$modules/package-lock.json"; then
  mkdir -p "$modules"
  cp "$here/package.json" "$here/package-lock.json" "$modules/"
  (cd "$modules" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2)
fi
SWARF_PAGE_MODULES="$modules" exec node "$here/page.mjs" "$@"
