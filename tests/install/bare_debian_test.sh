#!/usr/bin/env bash
# Installs the .deb on a bare Debian 12 as `apt install ./swarf.deb` does, and runs a scene there with report and pictures: what
# the package forgets to depend on is missing there. Arguments: build folder, folder to work in.
# Exit 77, with the reason: this machine cannot make a bare Debian (it takes root, mmdebstrap and a Debian archive).
set -euo pipefail
build=$1 work=$2
not_here() { echo "NOT RUN: $*"; exit 77; }
[ "$(id -u)" = 0 ] || not_here "only root may make another system's root"
command -v mmdebstrap >/dev/null || not_here "mmdebstrap is not installed"

rm -rf "$work" && mkdir -p "$work"
trap 'rm -rf "$work"' EXIT
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work" >"$work/package.log" 2>&1 || { cat "$work/package.log"; exit 1; }
package=$(echo "$work"/*.deb)

# The archive that this machine itself is installed from, where it is a Debian 12: a mirror near by.
archive=()
for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
  if grep -qs bookworm "$list"; then archive=("$list"); break; fi
done

bare() { mmdebstrap --mode=root --variant=minbase --format=null "$@" bookworm /dev/null "${archive[@]}" 2>"$work/bare.log"; }
bare --simulate || { tail -n 5 "$work/bare.log"; not_here "no archive of Debian 12 answers"; }
bare --customize-hook="copy-in $package /opt" \
  --customize-hook='chroot "$1" sh -c "DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /opt/swarf_*.deb >/dev/null"' \
  --customize-hook='chroot "$1" swarf --version >&2' \
  --customize-hook='chroot "$1" swarf run /usr/share/swarf/scenes/exact_slot_flat/scene.toml -o /opt/out --no-progress --set stills.samples=1 >&2' \
  --customize-hook='chroot "$1" sh -c "test -s /opt/out/report.html && test -s /opt/out/still_part.png && test -s /opt/out/part.glb"' ||
  { tail -n 40 "$work/bare.log"; exit 1; }
grep -E "^[0-9.]+$|PASS" "$work/bare.log"
