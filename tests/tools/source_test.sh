#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# source_test.sh [FOLDER]: the source archive of HEAD, unpacked in FOLDER (default: a temporary one) where there is no git,
# builds the plugin, the programs and some tests, which pass. Opt-in: as long as a build.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-$(mktemp -d)}
[ $# -gt 0 ] || trap 'rm -rf "$folder"' EXIT
version=$(sed -n 's/^project(vielto VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
name=vielto-$version
mkdir -p "$folder/bin"
git -c tar.umask=0022 archive --prefix="$name/" -o "$folder/$name.tar.gz" HEAD
tar xzf "$folder/$name.tar.gz" -C "$folder"

cd "$folder/$name"
printf '#!/bin/sh\necho "git is called: $*" >&2\nexit 1\n' >"$folder/bin/git"
chmod +x "$folder/bin/git"
export PATH=$folder/bin:$PATH
laws=$(basename -s .cpp tests/law/*_test.cpp)
# shellcheck disable=SC2086
scripts/build ci vielto_run vielto_laws vielto vielto_manual $laws liggghts_normal_impact_test observation_table_test
[ "$(build/bin/vielto --version)" = "vielto $version" ]
cd build
ctest -L '^law$' -j"$(nproc)" --output-on-failure
tests/liggghts_normal_impact_test
tests/observation_table_test
echo "$name.tar.gz: $(du -h "$folder/$name.tar.gz" | cut -f1), built and tested without git"
