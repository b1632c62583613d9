#!/usr/bin/env bash
# A figure of a report as a picture: figure.sh REPORT.html "words of its heading" OUT.png (needs chromium and python3).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
python3 - "$1" "$2" "$work/figure.html" <<'PY'
import re, sys
page = open(sys.argv[1], encoding="utf-8").read()
style = re.search(r"<style.*?</style>", page, re.S).group(0)
figure = next(f for f in re.findall(r"<figure.*?</figure>", page, re.S) if sys.argv[2] in f.split("</h3>")[0])
body = '<body style="margin:0;background:#fff"><div style="width:1180px">'
open(sys.argv[3], "w", encoding="utf-8").write(f'<!doctype html><meta charset="utf-8">{style}{body}{figure}</div></body>')
PY
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$work/profile" --window-size=1180,592 \
  --screenshot="$3" "file://$work/figure.html" > /dev/null 2>&1
