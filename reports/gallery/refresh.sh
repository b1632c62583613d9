#!/usr/bin/env bash
# Runs the scenes whose pictures the READMEs show, and refreshes those pictures.
set -euo pipefail
cd "$(dirname "$0")/../.."
refresh() {
  local name=$1; shift
  # A scene that shows findings exits with 1.
  build/release/cli/swarf run "scenes/$name/scene.toml" -o "reports/out/$name" || [ $? = 1 ]
  for still in "$@"; do cp "reports/out/$name/still_$still.png" "reports/gallery/${name}_$still.png"; done
}
refresh lin_koren_dome machine part deviation fan
refresh exact_gouges deviation
refresh nc_pocket part
refresh spinner_axis_cross part machine
refresh so_singularity
reports/gallery/figure.sh reports/out/so_singularity/report.html "Fig. 9" reports/gallery/so_singularity_fig9.png
