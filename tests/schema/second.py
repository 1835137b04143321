"""Compares the verdicts of two validators of JSON Schema on files with typos.

The test `typos` of `tests/cli` writes files and verdicts; jsonschema of PyPI says what it thinks of each:

    cargo build && GIRDERWAY_TYPOS=/tmp/typos.jsonl cargo test -p girderway --test cli typos
    python3 -m venv target/schemas && target/schemas/bin/pip install jsonschema==4.26.0
    target/schemas/bin/python tests/schema/second.py target/debug/girderway /tmp/typos.jsonl
"""

import json
import subprocess
import sys
from collections import Counter

import jsonschema


def main(program, path):
    validators = {}
    counts, apart = Counter(), []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            case = json.loads(line)
            name = case["schema"]
            if name not in validators:
                schema = json.loads(subprocess.run([program, "schema", name], check=True, capture_output=True).stdout)
                jsonschema.Draft202012Validator.check_schema(schema)
                validators[name] = jsonschema.Draft202012Validator(schema)
            fits = validators[name].is_valid(case["file"])
            counts[name, fits] += 1
            if fits != case["fits"]:
                apart.append(f"{name}: {case['what']}: jsonschema {fits}, the test {case['fits']}")
    for (name, fits), count in sorted(counts.items()):
        print(f"{name}: {count} files {'fit' if fits else 'are refused'}")
    print(f"{sum(counts.values())} files, {len(apart)} verdicts differ")
    print(*apart[:20], sep="\n")
    return 1 if apart or not counts else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
