#!/usr/bin/env bash
# The page in a real browser, opened from the disk: run.sh PICOT WORK. Status 77: no browser or no npm to be had.
set -euo pipefail
picot=$(realpath "$1")
mkdir -p "$2"
work=$(realpath "$2")
cd "$(dirname "$0")/../.."

skip() {
    echo "skipped: $1"
    [ "${PICOT_REQUIRE_BROWSER:-0}" = 1 ] && exit 1
    exit 77
}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
[ -n "$browser" ] || skip 'no chromium'
command -v pdftotext >/dev/null || skip 'no pdftotext'
command -v npm >/dev/null || skip 'no npm'
if [ ! -d viewer/node_modules/playwright-core ]; then
    (cd viewer && npm ci --no-audit --no-fund --silent) || skip 'npm ci failed'
fi
rm -rf "$work/pages"
mkdir -p "$work/pages"
for shape in shapes/ball.toml shapes/paper/c.toml shapes/pear.toml; do
    page=$work/pages/$(basename "$shape" .toml)
    "$picot" -q build "$shape" -o "$page.html" -o "$page.txt" 2>/dev/null
    "$picot" -q build "$shape" -o "$page.obj" --set detail=2 2>/dev/null
    "$picot" -q build "$shape" -o "$page.stl" --set detail=3 2>/dev/null
done
printf 'title: </script><img src=x onerror=alert(1)>\nRnd 1: 6 sc in magic ring (6)\nRnd 2: 6 inc (12)\n' >"$work/pages/hostile.txt"
"$picot" -q build "$work/pages/hostile.txt" -o "$work/pages/hostile.html"
"$picot" -q build shapes/cylinder.toml -o "$work/pages/predicted.html" --set places=predicted 2>/dev/null
CHROMIUM=$browser node tests/browser/page.mjs "$work/pages" ball c pear
# Models that the page itself saves.
if command -v admesh >/dev/null; then
    for file in "$work"/pages/*-page.stl; do
        faults=$(admesh "$file" | grep -E 'Edges fixed|Facets removed|Facets added|Facets reversed|Degenerate' | grep -c ': *[1-9]' || true)
        [ "$faults" = 0 ] || { admesh "$file"; exit 1; }
    done
fi
