#!/usr/bin/env bash
# Runs the scenes and refreshes the pictures that the README shows.
set -euo pipefail
cd "$(dirname "$0")/../.."
for scene in scenes/*/scene.toml; do
  name=$(basename "$(dirname "$scene")")
  build/release/cli/swarf run "$scene" -o "reports/out/$name"
  for still in machine part deviation fan; do
    cp "reports/out/$name/still_$still.png" "reports/gallery/${name}_$still.png"
  done
done
