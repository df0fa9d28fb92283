#!/usr/bin/env bash
# gap_toy_blind.sh FOLDER TRUTHS PLAN [DRAWS]: the whole blind check on toy libraries, from sealing to score.json.
# Needs build/bin and build/tests on the PATH; made new each time.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=$(realpath -m "$1") truths=$2 plan=$(realpath "$3") draws=${4:-1000}
rm -rf "$folder"
mkdir -p "$folder/libraries"
cp -r "$here"/../../libraries/effects "$here"/../../libraries/*.toml "$folder/libraries/"
gap_toy_library "$folder" "$truths"
cd "$folder"
vielto gap isolability tests.csv --library libraries/millet --draws "$draws" --out sealed >/dev/null
truth=()
for t in truth/*/; do truth+=(--truth "$t"); done
gap-withhold --library libraries/millet "${truth[@]}" --tests tests.csv --sealed sealed/isolability.json --plan "$plan" --out blind >/dev/null
# The diagnosis runs without any truth in reach.
"$here/../../scripts/blind" hide truth blind/truth blind/seals.sha256 -- \
  "$here/../../scripts/blind" diagnose blind/cases answers sealed/isolability.json libraries/millet --draws "$draws"
gap-score blind --answers answers --sealed sealed/isolability.json --out score.json
for k in 1 2 3 4 5 6 7 8; do
  gap-score blind --answers answers --sealed sealed/isolability.json --shuffle $k --out shuffled$k.json
done
