#!/bin/sh
# validate.sh FILE...: installs the Khronos validator under build/ on first use, then checks the files with it.
# Fails, never skips, when node or npm is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
modules="$here/../../build/gltf_validator"
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "validate.sh: node and npm are needed (apt packages nodejs, npm)" >&2
  exit 1
fi
if [ ! -d "$modules/node_modules/gltf-validator" ]; then
  mkdir -p "$modules"
  cp "$here/package.json" "$here/package-lock.json" "$modules/"
  (cd "$modules" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2)
fi
SWARF_GLTF_MODULES="$modules" exec node "$here/validate.mjs" "$@"
