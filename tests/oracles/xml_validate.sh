#!/bin/sh
# Validates Picot XML with tools that share nothing with Picot: xmllint (XML Schema, RELAX NG, Schematron) and, as a second
# opinion on the schema, the Python package xmlschema. Usage: xml_validate.sh FILE.xml...
# PYTHON names an interpreter that has xmlschema; a tool that is missing is named on stderr and skipped.
set -eu
grammar=$(cd "$(dirname "$0")/../../grammar" && pwd)
[ $# -gt 0 ] || { echo "usage: $0 FILE.xml..." >&2; exit 2; }
status=0
if command -v xmllint >/dev/null 2>&1; then
    for way in schema:xsd relaxng:rng schematron:sch; do
        xmllint --nonet --huge --noout "--${way%%:*}" "$grammar/picot.${way##*:}" "$@" 2>/tmp/xmllint.$$ || { status=1; grep -v ' validates$' /tmp/xmllint.$$ >&2 || true; }
        rm -f /tmp/xmllint.$$
    done
else
    echo "SKIPPED: xmllint is missing (Debian: libxml2-utils)" >&2
fi
python=${PYTHON:-python3}
if "$python" -c 'import xmlschema' 2>/dev/null; then
    "$python" - "$grammar/picot.xsd" "$@" <<'END' || status=1
import sys, xmlschema
schema = xmlschema.XMLSchema(sys.argv[1])
bad = 0
for path in sys.argv[2:]:
    for error in schema.iter_errors(xmlschema.XMLResource(path, defuse="always")):
        bad += 1
        print(f"{path}: {error.reason} at {error.path}", file=sys.stderr)
sys.exit(bad > 0)
END
else
    echo "SKIPPED: the Python package xmlschema is missing (PYTHON=$python)" >&2
fi
[ $status -ne 0 ] || echo "$# files are valid"
exit $status
