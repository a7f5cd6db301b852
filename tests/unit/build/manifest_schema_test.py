"""A manifest of every target against docs/manifest.schema.json.

manifest_schema_test.py SOURCE TOOL: exit code 1 where one does not fit, or where a damaged one does.
"""
import copy
import json
import os
import subprocess
import sys
import tempfile

import jsonschema

SCENE = """
name = "harbour"
targets = ["ps_2_0", "ps_3_0", "glsl_450", "glsl_330", "essl_100", "hlsl_5_0", "hlsl_3_0", "spirv", "msl"]
[tolerance]
p95 = 100
[[light]]
name = "sun"
elevation = 45
azimuth = 20
[[surface]]
name = "quay"
maker = "bricks"
width = 16
height = 16
search = "parallax"
shadow = "none"
normal = "map"
shading = "lambert"
output = "colour"
vertex = "tangent_space"
"""


def main():
    source, tool = sys.argv[1:]
    with open(os.path.join(source, "docs/manifest.schema.json"), encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "harbour.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE)
        subprocess.run([tool, "build", scene, "-o", folder + "/out", "--no-cache", "-q"], check=True)
        with open(folder + "/out/manifest.json", encoding="utf-8") as file:
            manifest = json.load(file)
    jsonschema.validate(manifest, schema)
    variants = manifest["surfaces"][0]["variants"]
    if len(variants) != 9 or any(not variant["witnesses"] for variant in variants):
        sys.exit("a variant is missing, or nobody accepted it")

    def fits(damage):
        other = copy.deepcopy(manifest)
        damage(other)
        return jsonschema.Draft7Validator(schema).is_valid(other)

    for damage in (lambda m: m.pop("schema"),
                   lambda m: m.update(schema=2),
                   lambda m: m["surfaces"][0].update(name="no name"),
                   lambda m: m["surfaces"][0]["header"].update(hash="0"),
                   lambda m: m["surfaces"][0]["variants"][0]["files"][0].pop("entry"),
                   lambda m: m["surfaces"][0]["maps"][0].pop("file")):
        if fits(damage):
            sys.exit("the schema takes a damaged manifest")


main()
