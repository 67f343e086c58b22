"""The JSON Schema and the program agree about configs: every shipped one is good by both, every kind of error bad by
both, and the limits of every key are the same. `qtrace config check` as its user runs it. What docs/ holds is current."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any, Iterator

import jsonschema

ROOT = Path(__file__).resolve().parents[2]
QTRACE = os.environ.get("QTRACE_BINARY", str(ROOT / "build/release/qtrace"))
SCENE = str(ROOT / "configs/scenes/simple.glb")
GOOD = {"name": "a", "scene": SCENE, "frames": 8}
SKY = str(ROOT / "configs/scenes/sunlit_sky.hdr")


def qtrace(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess:
    return subprocess.run([QTRACE, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)


def without_comments(text: str) -> str:
    """Configs may have comments; texts in quotes stay."""
    return re.sub(r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/', lambda match: match[1] or "", text, flags=re.DOTALL)


SCHEMA = json.loads(qtrace("config", "schema").stdout)
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def leaves(schema: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    for name, part in schema["properties"].items():
        if "properties" in part:
            yield from leaves(part, f"{path}{name}.")
        else:
            yield path + name, part


class SchemaTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def check(self, configs: dict[str, Any], *options: str) -> dict[str, str]:
        """By name: the program's error, or "" where the config is good."""
        for name, config in configs.items():
            (self.folder / f"{name}.json").write_text(json.dumps(config))
        result = qtrace("config", "check", *(options or ["--no-device"]), *(f"{name}.json" for name in configs),
                        cwd=self.folder)
        said = {line.split(".json")[0].removeprefix("error: "): line if line.startswith("error: ") else ""
                for line in (result.stdout + result.stderr).splitlines() if not line.startswith("warning: ")}
        self.assertEqual(set(said), set(configs), result.stderr)  # one sentence for each, and nothing else
        self.assertEqual(result.returncode, int(any(said.values())))
        self.assertEqual(len(list(self.folder.iterdir())), len(configs))  # nothing was written
        return said

    def test_schema_is_one(self) -> None:
        jsonschema.Draft202012Validator.check_schema(SCHEMA)
        for key, part in leaves(SCHEMA):
            self.assertIn("description", part, key)
            if "default" in part and key != "published.ratio":
                self.assertTrue(VALIDATOR.evolve(schema={**part, "$defs": SCHEMA["$defs"]}).is_valid(part["default"]),
                                key)

    def test_it_has_every_key_with_its_default(self) -> None:
        listed = {}
        for line in qtrace("keys", "--markdown").stdout.splitlines():
            if line.startswith("| `"):
                fields = [field.strip() for field in line.strip("|").split(" | ")]
                listed[fields[0].strip("`")] = json.loads(fields[2].strip("`"))
        self.assertEqual({key for key, _ in leaves(SCHEMA)} - {"$schema"}, set(listed))
        self.assertGreater(len(listed), 60)
        for key, part in leaves(SCHEMA):
            self.assertEqual(part.get("default", listed.get(key)), listed.get(key), key)

    def test_shipped_configs_are_good(self) -> None:
        configs = sorted((ROOT / "configs").glob("*.json"))
        self.assertGreater(len(configs), 10)
        for file in configs:
            errors = list(VALIDATOR.iter_errors(json.loads(without_comments(file.read_text()))))
            self.assertEqual([error.message for error in errors], [], file.name)
        # One needs a scene that is generated when it is asked for.
        result = qtrace("config", "check", "--no-device", *(f for f in configs if f.stem != "stability_large"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("paper_table.json: good: 'paper_table', runs: 24, configurations: 24\n", result.stdout)

    def test_every_spelling_is_good(self) -> None:
        configs = {"nested": GOOD | {"rl": {"update": "sarsa"}}, "dotted": GOOD | {"rl.update": "sarsa"},
                   "schema": GOOD | {"$schema": "../docs/config.schema.json"}, "whole": GOOD | {"width": 64.0},
                   "snapshots": GOOD | {"snapshots": [1, 3]},
                   "values": GOOD | {"sweep": [{"rl.bins_phi": [2, 4]}, {"seed": [1, 2]}]},
                   "groups": GOOD | {"sweep": [{"how": {"A": {"rl.update": "sarsa", "nee": "one_ray"}, "B": {}}}]},
                   "label": GOOD | {"sweep": [{"sampler": {"A": {"sampler": "rl", "rl": {"bins_phi": 2}}}}]},
                   "group_axis": GOOD | {"sweep": [{"rl": [{"bins_phi": 2}]}]},
                   "constant": GOOD | {"environment": [1, 0.5, 0]}, "sky": GOOD | {"environment": {"file": SKY}},
                   "turned_sky": GOOD | {"environment": {"file": SKY, "scale": 2, "rotation": -90}},
                   "skies": GOOD | {"sweep": [{"environment": [[0, 0, 0], {"file": SKY, "scale": [1, 2, 0.5]}]}]},
                   "swept_scene": {"name": "a", "frames": 8, "sweep": [{"scene": [SCENE]}]}}
        for name, config in configs.items():
            self.assertEqual([error.message for error in VALIDATOR.iter_errors(config)], [], name)
        self.assertEqual(set(self.check(configs).values()), {""})

    def test_every_kind_of_error_is_bad(self) -> None:
        configs = {"no_name": {"scene": SCENE}, "empty_name": GOOD | {"name": ""}, "unknown": GOOD | {"widht": 3},
                   "unknown_member": GOOD | {"rl": {"bins_fi": 3}}, "unknown_dotted": GOOD | {"rl.bins_fi": 3},
                   "member_at_top": GOOD | {"bins_phi": 3}, "text_for_number": GOOD | {"width": "512"},
                   "fraction": GOOD | {"width": 3.5}, "null": GOOD | {"width": None}, "word": GOOD | {"nee": "both"},
                   "truth": GOOD | {"rl": {"bsdf_fraction": True}}, "number_for_group": GOOD | {"rl": 3},
                   "two_channels": GOOD | {"environment": [1, 2]},
                   "negative_channel": GOOD | {"environment": [0, 0, -1]},
                   "environment_word": GOOD | {"environment": SKY}, "no_image": GOOD | {"environment": {"scale": 1}},
                   "image_member": GOOD | {"environment": {"file": SKY, "turn": 3}},
                   "image_name": GOOD | {"environment": {"file": ""}},
                   "image_scale": GOOD | {"environment": {"file": SKY, "scale": -1}},
                   "image_scales": GOOD | {"environment": {"file": SKY, "scale": [1, 1]}},
                   "image_turn": GOOD | {"environment": {"file": SKY, "rotation": 361}},
                   "swept_image": GOOD | {"sweep": [{"environment": [{}]}]},
                   "snapshot_zero": GOOD | {"snapshots": [0]}, "snapshot_word": GOOD | {"snapshots": "all"},
                   "dotted_range": GOOD | {"rl.bins_phi": 0}, "schema": GOOD | {"$schema": 3},
                   "sweep_object": GOOD | {"sweep": {}},
                   "two_in_one_axis": GOOD | {"sweep": [{"seed": [1], "nee": []}]},
                   "empty_axis": GOOD | {"sweep": [{}]}, "no_values": GOOD | {"sweep": [{"seed": []}]},
                   "twice": GOOD | {"sweep": [{"seed": [1, 1]}]}, "axis_value": GOOD | {"sweep": [{"nee": ["both"]}]},
                   "axis_range": GOOD | {"sweep": [{"rl.bins_phi": [0]}]}, "axis_key": GOOD | {"sweep": [{"sed": [1]}]},
                   "axis_number": GOOD | {"sweep": [{"how": 3}]}, "override": GOOD | {"sweep": [{"how": {"A": 3}}]},
                   "override_key": GOOD | {"sweep": [{"how": {"A": {"widht": 3}}}]},
                   "override_name": GOOD | {"sweep": [{"how": {"A": {"name": "b"}}}]},
                   "override_value": GOOD | {"sweep": [{"how": {"A": {"rl": {"update": "best"}}}}]},
                   "swept_sweep": GOOD | {"sweep": [{"baseline": ["a"]}]}, "no_groups": GOOD | {"sweep": [{"how": {}}]},
                   "published": GOOD | {"published": {"ms_per_frame": {"a": 0}}},
                   "published_key": GOOD | {"published": {"sauce": "a"}}, "list": [GOOD]}
        for name, config in configs.items():
            self.assertFalse(VALIDATOR.is_valid(config), name)
        for name, error in self.check(configs).items():
            self.assertNotEqual(error, "", name)

    def test_limits_of_every_key_are_the_programs(self) -> None:
        """One beyond each end, and a value of another type."""
        configs = {}
        for key, part in leaves(SCHEMA):
            step = 1 if part.get("type") == "integer" else 1e-3
            for end, sign in (("minimum", -1), ("maximum", 1)):
                if end in part:
                    beyond = part[end] + sign * max(step, abs(part[end]) * step)
                    configs[f"{key}-{end}"] = (key, round(beyond) if step == 1 else beyond)
            configs[f"{key}-type"] = (key, {"no": "such"} if key != "published.ms_per_frame" else 3)
        self.assertGreater(len(configs), 120)
        bad = {name: {**GOOD, key: value} for name, (key, value) in configs.items()}
        for name, config in bad.items():
            self.assertFalse(VALIDATOR.is_valid(config), name)
        for name, error in self.check(bad).items():
            self.assertIn(configs[name][0].split(".")[-1], error)

    def test_what_only_the_program_knows(self) -> None:
        broken = self.folder.parent / f"{self.folder.name}.glb"  # beside the folder, which holds configs alone
        broken.write_bytes(b"no scene")
        self.addCleanup(broken.unlink)
        configs = {"disorder": (GOOD | {"snapshots": [4, 2]}, "must be increasing"),
                   "seeds": (GOOD | {"seed": 9001}, "'seed' and 'reference.seed' are both"),
                   "baseline": (GOOD | {"baseline": "none"}, "must be a label or a configuration"),
                   "no_scene": ({"name": "a"}, "key 'scene' is missing"),
                   "gone": (GOOD | {"scene": "gone.glb"}, "gone.glb: no such scene"),
                   "no_image": (GOOD | {"environment": {"file": "gone.exr"}}, "gone.exr: no such image; the file of key"),
                   "other_image": (GOOD | {"environment": {"file": SCENE}}, "simple.glb: is neither an OpenEXR image"),
                   "broken": (GOOD | {"scene": str(broken)}, broken.name), "good": (GOOD, "")}
        said = self.check({name: config for name, (config, _) in configs.items()})
        for name, (config, words) in configs.items():
            self.assertTrue(VALIDATOR.is_valid(config), name)
            self.assertIn(words, said[name])
            self.assertEqual(said[name] == "", words == "", name)

    def test_every_error_of_a_file_is_named(self) -> None:
        config = GOOD | {"widht": 3, "frames": 0, "rl": {"bins_fi": 3, "update": "best", "bins_phi": 4}, "nee": "none",
                         "rl.bins_theta": 65, "camera": {"position": [0, 0, 3], "target": [0, 0, 0], "fov": 400},
                         "environment": {"file": "a.exr", "scale": -2},
                         "sweep": [{"sed": [1]}, {"seed": [1]}, {"nee": []},
                                   {"how": {"A": {"rl": {"bins_phi": 0}}}}]}
        (self.folder / "c.json").write_text(json.dumps(config))
        result = qtrace("config", "check", "--no-device", "c.json", cwd=self.folder)
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        words = ["key 'frames' is 0", "unknown key 'widht'; did you mean 'width'?", "unknown key 'rl.bins_fi'",
                 "key 'rl.update' is \"best\"", "key 'rl.bins_theta' is 65",
                 "key 'camera.fov' is 400", "key 'environment.scale' is -2", "unknown key 'sed'",
                 "sweep axis 'nee' has no values", "'A' of sweep axis 'how': key 'rl.bins_phi' is 0"]
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), len(words), result.stderr)
        for line, word in zip(lines, words):
            self.assertTrue(line.startswith("error: c.json: "), line)
            self.assertIn(word, line)
        for text in ("{", "[]", '{"name": "a", "name": "b"}'):  # no members to look at one by one: one sentence
            (self.folder / "c.json").write_text(text)
            said = qtrace("config", "check", "--no-device", "c.json", cwd=self.folder).stderr
            self.assertEqual(len(said.splitlines()), 1, said)

    def test_the_device_counts_unless_told_otherwise(self) -> None:
        large = {"large": GOOD | {"width": 16384, "height": 16384}}
        self.assertEqual(self.check(large, "--no-device")["large"], "")
        self.assertIn("run 'run': ", self.check(large, "--set", "frames=9")["large"])

    def test_wrong_command_lines(self) -> None:
        for arguments in (["check"], [], ["check", "--no-such", "a.json"], ["lint"]):
            self.assertEqual(qtrace("config", *arguments).returncode, 2, arguments)

    def test_docs_are_current(self) -> None:
        for command, file in ((("keys", "--markdown"), "keys.md"), (("config", "schema"), "config.schema.json"),
                              (("gltf", "--markdown"), "gltf.md")):
            self.assertEqual((ROOT / "docs" / file).read_text(), qtrace(*command).stdout,
                             f"build/release/qtrace {' '.join(command)} > docs/{file}")


if __name__ == "__main__":
    unittest.main()
