#!/usr/bin/env bash
# Installs the build, runs the program from a place that it was moved to, and builds and runs a program of somebody
# else with find_package(swarf). Arguments: build folder, source folder, folder to work in.
set -euo pipefail
build=$1 source=$2 work=$3
rm -rf "$work" && mkdir -p "$work"
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
cd "$work"
scene=moved/share/swarf/scenes/exact_slot_flat/scene.toml
moved/bin/swarf --version
moved/bin/swarf run "$scene" --no-render -o "$work/run"
if grep -rlI "$source" moved --include=*.cmake --include=*.toml --include=*.h; then
  echo "files of the installation name the source folder"; exit 1
fi

if [ -d moved/lib/python3/dist-packages/swarf ]; then
  PYTHONPATH=moved/lib/python3/dist-packages /usr/bin/python3 -B -c "
import swarf
result = swarf.run('$scene')
print('python:', result.verdict_text)
assert result.verdict == 'pass' and swarf.__file__.startswith('$work/moved/'), swarf.__file__"
fi

# The package: unpacked, since installing it needs rights that a test has not.
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/packages" >package.log 2>&1 || { cat package.log; exit 1; }
dpkg-deb -f packages/*.deb Depends | tee depends
grep -q libosmesa6 depends && grep -q libopenvdb depends
dpkg-deb -x packages/*.deb unpacked
for made in $(cd moved/share/swarf/scenes && ls -d */); do
  # Cases of one kind stand in one folder, under names or in folders of their own.
  [ -n "$(find "unpacked/usr/share/swarf/scenes/$made" -name '*.toml' -print -quit)" ] || { echo "the package lacks $made"; exit 1; }
done
unpacked/usr/bin/swarf check unpacked/usr/share/swarf/scenes/spinner_axis_cross/scene.toml

cmake -S "$source/tests/install/example" -B example -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld >configure.log 2>&1 ||
  { cat configure.log; exit 1; }
cmake --build example >build.log 2>&1 || { tail -n 40 build.log; exit 1; }
example/example "$scene" | tee said
grep -q "removed 1135" said
