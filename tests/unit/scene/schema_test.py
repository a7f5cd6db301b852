#!/usr/bin/python3
"""docs/scene.schema.json judged by Debian's python3-jsonschema: it is a schema, the examples are scenes to it, and
of schema_cases.txt it accepts what is right and refuses what is wrong, as the reader does (document_test.cpp)."""
import json
import pathlib
import re
import sys
import tomllib

try:
    import jsonschema
except ImportError:
    sys.exit("no jsonschema: install Debian's python3-jsonschema (scripts/packages)")

root = pathlib.Path(sys.argv[1])
schema = json.loads((root / "docs/scene.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
failures = []


def expect(right, name, text):
    errors = [f"{error.json_path}: {error.message}" for error in validator.iter_errors(tomllib.loads(text))]
    if right and errors:
        failures.append(f"{name}: is right, and the schema says {errors[0][:300]}")
    if not right and not errors:
        failures.append(f"{name}: is wrong, and the schema accepts it")


scenes = 0
for path in sorted((root / "examples").rglob("*.toml")):
    if path.parent.name == "02_own_technique":
        continue  # it asks for a technique of its own, which the schema cannot know
    text = path.read_text()
    if "[[surface]]" in text:
        expect(True, str(path.relative_to(root)), text)
        scenes += 1
if scenes == 0:
    failures.append("no example is a scene")

block = re.search(r"^```toml\n(.*?)^```", (root / "docs/scene.md").read_text(), re.M | re.S)
expect(True, "docs/scene.md", block.group(1))

head, *cases = re.split(r"^=== (right|wrong): (.*)\n", (root / "tests/unit/scene/schema_cases.txt").read_text(), flags=re.M)
common = head.split("\n\n", 1)[1]
for right, name, text in zip(cases[0::3], cases[1::3], cases[2::3]):
    expect(right == "right", name, common + text)

print(f"{len(cases) // 3 + scenes + 1} scenes, {len(failures)} judged wrongly")
sys.exit("\n".join(failures) if failures else 0)
