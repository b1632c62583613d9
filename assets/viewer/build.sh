#!/bin/sh
# Builds viewer.min.js from src/. Needs node and npm; nothing else of the project does.
set -eu
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r src "$work/"
cd "$work"
npm init -y > /dev/null
npm install --no-audit --no-fund --ignore-scripts three@0.187.0 esbuild@0.28.2
npx esbuild src/main.js --bundle --minify --format=iife --target=es2022 --charset=utf8 \
  --legal-comments=eof --outfile=viewer.min.js
cd "$OLDPWD"
cp "$work/viewer.min.js" viewer.min.js
cp "$work/node_modules/three/LICENSE" LICENSE.three.txt
