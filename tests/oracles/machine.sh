#!/usr/bin/env bash
# Machine programs of small shapes, limbs, flat pieces and random tubes against two checkers that share no code with Picot: a simulator of a V-bed machine
# (knitout_oracle.py) and a replay of k-code beside its Knitout (kcode_check.py). Then the table of all shapes.
# Usage: machine.sh PICOT DIRECTORY; the directory keeps the Python environment. Status 77: no network or no Python.
set -euo pipefail
picot=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
mkdir -p "$work/out"
if [ ! -x "$work/env/bin/python" ]; then
    python3 -m venv "$work/env" || exit 77
fi
"$work/env/bin/pip" install -q knitout-interpreter==0.1.8 virtual-knitting-machine==0.0.31 knit-graphs==0.1.4 || exit 77
cd "$work/out"
programs=()
mkdir -p tubes
python3 "$here/random_tubes.py" tubes 10
for shape in "$root"/shapes/{ball,cord,capsule,egg,elbow}.toml "$root"/tests/it/cases/machine/*.txt tubes/*.txt; do
    name=$(basename "${shape%.*}")
    "$picot" -q build "$shape" --machine swg091n2 -o "$name.k"
    "$picot" -q check "$name.k" --against "$shape"
    "$picot" -q build "$shape" --machine kniterate --set no-waste=true -o "$name-kniterate.k"
    "$picot" -q build "$name-kniterate.k" -o "$name.kc"
    "$picot" -q check "$name.kc" --against "$shape"
    python3 "$here/kcode_check.py" "$name.kc" "$name-kniterate.k"
    programs+=("$name.k")
done
# The same machines with tubes on all needles: sliders let loops move; without them a plain tube ends on waste yarn.
for name in swg091n2 kniterate; do
    sed 's/half_gauge = true/half_gauge = false/' "$root/src/ir/machine/$name.toml" > "$name-full.toml"
done
for shape in "$root"/shapes/{ball,cord,elbow}.toml tubes/*.txt; do
    name=$(basename "${shape%.*}")-full
    "$picot" -q build "$shape" --machine swg091n2-full.toml -o "$name.k"
    "$picot" -q check "$name.k" --against "$shape" --machine swg091n2-full.toml
    programs+=("$name.k")
done
"$picot" -q build "$root/shapes/cord.toml" --machine kniterate-full.toml -o cord-waste.k
"$picot" -q build cord-waste.k --machine kniterate-full.toml -o cord-waste.kc
"$picot" -q check cord-waste.kc --against "$root/shapes/cord.toml" --machine kniterate-full.toml
python3 "$here/kcode_check.py" cord-waste.kc cord-waste.k
"$work/env/bin/python" "$here/knitout_oracle.py" --strict --quiet "${programs[@]}"
python3 "$here/machine_table.py" "$picot" "$root"/shapes/*.toml
