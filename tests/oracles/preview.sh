#!/usr/bin/env bash
# Models of all shapes in both views against checkers that share no code with Picot: Khronos' glTF validator (no error,
# warning, hint or information), trimesh (closed, consistent, a volume) and admesh (no facet to repair).
# Usage: preview.sh PICOT DIRECTORY; the directory keeps what is installed. Status 77: none of them can be had.
set -euo pipefail
picot=$(realpath "$1")
mkdir -p "$2"
work=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
[ -x "$work/env/bin/python" ] || python3 -m venv "$work/env" || exit 77
"$work/env/bin/pip" install -q trimesh numpy || exit 77
command -v npm >/dev/null || { apt-get update && apt-get install -y nodejs npm; } >/dev/null 2>&1 || exit 77
if [ ! -d "$work/node_modules/gltf-validator" ]; then
    npm install --silent --no-audit --no-fund --prefix "$work" gltf-validator@2.0.0-dev.3.10 || exit 77
fi
command -v admesh >/dev/null || { apt-get update && apt-get install -y admesh; } >/dev/null 2>&1 || exit 77
rm -rf "$work/models"
mkdir "$work/models"
for view in realistic wireframe; do
    while read -r shape; do
        name=${shape#"$root/shapes/"}
        name=${name%.toml}
        "$picot" -q build "$shape" --set view=$view --set detail=1 -o "$work/models/${name//\//-}-$view.stl" \
            -o "$work/models/${name//\//-}-$view.glb" -o "$work/models/${name//\//-}-$view.obj" 2>"$work/log" || { cat "$work/log"; exit 1; }
    done < <(find "$root/shapes" -name '*.toml' | sort)
done
NODE_PATH=$work/node_modules node "$here/gltf_check.js" "$work"/models/*.glb
"$work/env/bin/python" "$here/model_check.py" "$work"/models/*.stl
for file in "$work"/models/*.stl; do
    report=$(admesh "$file")
    for fault in 'Edges fixed' 'Facets removed' 'Facets added' 'Facets reversed' 'Backwards edges' 'Degenerate facets' \
        'Total disconnected facets'; do
        numbers=$(grep -o "$fault *:.*" <<<"$report" | grep -o '[0-9]*' || true)
        [ -n "$numbers" ] && [ -z "$(tr -d '0\n' <<<"$numbers")" ] || { echo "$file: $fault" $numbers; exit 1; }
    done
done
echo "$(find "$work/models" -name '*.glb' | wc -l) models are sound"
