#!/usr/bin/env python3
"""The schemas take every shipped file and refuse wrong ones with the key named, as the program does.

    schemas_test.py PROGRAM SOURCE_FOLDER
"""

import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import yaml

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()


class Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):   # libyaml, where PyYAML has it
    """YAML 1.2, as editors read it: PyYAML takes `yes` for a flag and 1e-3 for a text. Keys are texts."""

    yaml_implicit_resolvers = {}

    def construct_mapping(self, node, deep=False):
        return {key.value: self.construct_object(value, deep=True) for key, value in node.value}


Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), None)
Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile("^[-+]?[0-9]+$"), None)
Loader.add_implicit_resolver("tag:yaml.org,2002:null", re.compile("^(null|~|)$"), None)
Loader.add_implicit_resolver("tag:yaml.org,2002:float",
                             re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"), None)
Loader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))
Loader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))

SCHEMAS = {path.name.split(".")[0]: json.loads(path.read_text()) for path in (SOURCE / "keys/schemas").glob("*.json")}


@functools.cache   # many mistakes are made in one right file
def refusals(kind: str, text: str) -> list[str]:
    """One line for each mistake, with its path."""
    validator = jsonschema.Draft7Validator(SCHEMAS[kind])
    return [".".join(str(step) for step in error.absolute_path) + ": " + error.message
            for error in validator.iter_errors(yaml.load(text, Loader))]


SHIPPED = ([("scenario", path) for path in sorted((SOURCE / "scenarios").glob("*.yaml"))] +
           [("scenario", path) for path in sorted((SOURCE / "tests/test_bed").glob("*.yaml"))] +
           [("cluster", path) for path in sorted((SOURCE / "schedules").glob("*.yaml"))] +
           [("plan", path) for path in sorted((SOURCE / "schedules/plans").glob("*.yaml"))] +
           [("experiment", path) for path in sorted((SOURCE / "experiments").glob("*.yaml"))] +
           [("faults", path) for path in sorted((SOURCE / "experiments/faults").glob("*.yaml"))])

# Configurations of `ttfusion track` in other tests.
TRACKS = [
    "sensors: {laser: {}}\n",
    "strategy: tt\ntracker: {process_noise: 4.0, confirm_hits: 1}\n"
    "sensors:\n  laser: {position: 0.15, period: 100 ms, worst_delay: 10 ms}\n"
    "  radar: {range: 0.3, bearing: 0.03, range_rate: 0.3, period: 100 ms, first: 50 ms, worst_delay: 70 ms}\n",
    "sensors:\n  side: {mounting: {x: 1.0, y: -0.9, heading: -1.57}, bias: {bearing: 0.01},"
    " bias_sigma: {range: 0.1, time: 5 ms}}\ntracker: {systematic: consider}\n",
    "sensors: {lidar: {field: {half_angle: 1.05, min_range: 1, max_range: 120, shadow: 0.5}}, radar: {field: {}}}\n",
    "sensors: {camera: {bias_sigma: {x: 0.5, y: 0.5}}, radar: {bias_sigma: {bearing: 0.02}}}\n",
    "tracker: {late: clone, buff_waits: fixed_lag, fixed_lag: 50 ms, clutter_density: 1e-3}\n",
]

# Name of the mistake, kind of file, a right file (none: a track configuration), a text in it, its replacement, the wrong key.
CAR = "scenarios/dynamics.yaml"
LASERS = "scenarios/two_lasers.yaml"
PAPER = "schedules/paper_synchronised.yaml"
HEIR = "schedules/paper_unsynchronised.yaml"
PLAN = "schedules/plans/paper.yaml"
HEIR_OF_PLAN = "schedules/plans/paper_two_lasers_radar.yaml"
NOISE = "experiments/process_noise.yaml"
CAMPAIGN = "experiments/fault_campaign.yaml"
CAN_CAMPAIGN = "experiments/can_fault_campaign.yaml"
CRASH = "experiments/faults/camera_crash.yaml"
WRONG = [
    ("an unknown key", "scenario", CAR, "process_noise: 0.04", "proces_noise: 0.04", "proces_noise"),
    ("a missing key", "scenario", CAR, "seed: 1\n", "", "seed"),
    ("out of range", "scenario", CAR, "speed: 25.0", "speed: 120.0", "speed"),
    ("a wrong unit", "scenario", CAR, "duration: 3 s", "duration: 3 min", "duration"),
    ("an unknown word", "scenario", CAR, "process_noise: 0.04", "motion: ctrw", "motion"),
    ("a sensor without its kind", "scenario", LASERS, "left_laser: {kind: laser, ", "left_laser: {", "kind"),
    ("another kind's key", "scenario", LASERS, "half_field: 0.9, period", "focal: 900.0, period", "focal"),
    ("another kind's key of preprocessing", "scenario", LASERS, "preprocessing: {half_field: 0.9}}",
     "preprocessing: {focal: 900.0}}", "focal"),
    ("a number outside its kind's range", "scenario", LASERS, "preprocessing: {half_field: 0.9}}",
     "preprocessing: {half_field: 50}}", "half_field"),
    ("an unknown colour", "scenario", LASERS, "colour: green", "colour: pink", "colour"),
    ("a word that needs the mapping", "scenario", CAR, "seed: 1\n", "seed: 1\nstartup: cold\n", "startup"),
    ("a flag that is a number", "cluster", PAPER, "synchronisation: true", "synchronisation: 1", "synchronisation"),
    ("a plan without its section", "plan", PLAN, "plan:\n", "plans:\n", "plan"),
    ("a plan's unknown key", "plan", PLAN, "  objective: [", "  objectives: [", "objectives"),
    ("an unknown objective", "plan", PLAN, "data_age, worst_age", "age, worst_age", "objective"),
    ("an age without a unit", "plan", PLAN, "to: feature.use, largest_age: 60 ms", "to: feature.use, largest_age: 60", "largest_age"),
    ("a key of tasks", "plan", PLAN, "draw: worst", "draw: often", "draw"),
    ("another kind of sensor", "plan", HEIR_OF_PLAN, "kind: radar", "kind: sonar", "kind"),
    ("a parameter below its range", "cluster", PAPER, "gdStaticSlot: 84", "gdStaticSlot: 3", "gdStaticSlot"),
    ("a key of another measurement", "cluster", PAPER, "measurement: scheduled", "measurement: scheduled, period: 80 ms",
     "period"),
    ("an unknown key of a sensor that is like another", "cluster", PAPER, "sensors:\n", "sensors:\n  rear: {like: laser, mount: 1}\n",
     "mount"),
    ("a difference without a copy", "cluster", PAPER, "camera: {kind: camera", "camera: {raw: 9, kind: camera", "raw"),
    ("an unknown key in a file that extends another", "cluster", HEIR, "sensors:\n", "sensorz: ~\nsensors:\n", "sensorz"),
    ("a parameter beyond its range in such a file", "cluster", HEIR, "sensors:\n", "flexray: {gdNIT: 900}\nsensors:\n", "gdNIT"),
    ("a fraction of a whole number", "cluster", PAPER, "gSyncNodeMax: 5", "gSyncNodeMax: 5.5", "gSyncNodeMax"),
    ("a campaign's key in a sweep", "experiment", NOISE, "seed: 1\n", "seed: 1\nvariants: {}\n", "variants"),
    ("an unknown measure", "experiment", NOISE, "measures: [", "measures: [speed, ", "measures"),
    ("a text instead of a list", "experiment", NOISE, "measures: [", "measures: nees #", "measures"),
    ("a weight of an unknown kind", "experiment", CAMPAIGN, "seed: 1\n", "seed: 1\nclasses: {crush: 1}\n", "crush"),
    ("a start-up on a CAN", "experiment", CAN_CAMPAIGN, "seed: 1\n", "seed: 1\nstart_up: 0.25\n", "start_up"),
    ("a wiring of a CAN", "experiment", CAN_CAMPAIGN, "{recovery: never}", "{recovery: never, topology: bus}", "topology"),
    ("an unknown recovery", "experiment", CAN_CAMPAIGN, "{recovery: never}", "{recovery: seldom}", "recovery"),
    ("a kind of FlexRay", "experiment", CAN_CAMPAIGN, "harmless: [", "harmless: [crash, ", "harmless"),
    ("another kind's parameter", "faults", CRASH, "from: 1600 ms", "from: 1600 ms, probability: 0.5", "probability"),
    ("a time without a unit", "faults", CRASH, "from: 1600 ms", "from: 1600", "from"),
    ("too large a sigma", "track", None, "bearing: 0.03", "bearing: 0.9", "bearing"),
]


def program_says(kind: str, folder: pathlib.Path, text: str) -> tuple[int, str]:
    file = folder / "wrong.yaml"
    base = "schedules/plans" if kind == "plan" else "schedules"
    file.write_text(text.replace("extends: ", f"extends: {SOURCE}/{base}/"))
    observations = folder / "observations.csv"
    observations.write_text("time,sensor,x,y\n0,laser,1,2\n1,laser,1,2\n")
    sweep = folder / "sweep.yaml"
    sweep.write_text(f"kind: sweep\nname: crash\nquestion: none\nscenario: {SOURCE / CAR}\nseed: 1\nreplications: 1\n"
                     "paradigms: {tt: {strategy: tt}}\naxes: {bus: {settings: {crash: {faults: wrong.yaml}}}}\n")
    command = {"scenario": ["run", file, "--out", folder / "out"],
               "cluster": ["schedule", "check", file],
               "plan": ["schedule", "synthesize", file],
               "experiment": ["experiment", file, "--out", folder / "out"],
               "faults": ["experiment", sweep, "--out", folder / "out"],
               "track": ["track", observations, "--config", file, "-o", folder / "tracks.csv"]}[kind]
    done = subprocess.run([PROGRAM, *command], capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stderr


class Schemas(unittest.TestCase):
    def test_they_are_schemas_with_right_examples(self):
        def walk(schema, whole):
            if isinstance(schema, dict):
                for value in schema.get("examples", []) + ([schema["default"]] if "default" in schema else []):
                    resolver = jsonschema.RefResolver.from_schema(whole)   # "#/$defs/..." is the whole schema's
                    jsonschema.Draft7Validator(schema, resolver=resolver).validate(value)
                if "$ref" in schema:
                    self.assertEqual(list(schema), ["$ref"], "draft 07 ignores what stands beside a reference")
                    self.assertIn(schema["$ref"].removeprefix("#/$defs/"), whole["$defs"])
                    used.add(schema["$ref"].removeprefix("#/$defs/"))
                for inner in schema.values():
                    walk(inner, whole)
            elif isinstance(schema, list):
                for inner in schema:
                    walk(inner, whole)

        self.assertEqual(set(SCHEMAS), {"scenario", "cluster", "plan", "experiment", "track", "faults", "summary"})
        for kind, schema in SCHEMAS.items():
            with self.subTest(kind):
                jsonschema.Draft7Validator.check_schema(schema)
                used = set()
                walk({part: schema[part] for part in ("properties", "allOf", "then", "else", "$defs") if part in schema}, schema)
                self.assertEqual(used, set(schema.get("$defs", {})), "every definition is needed")

    def test_shipped_files_are_right(self):
        self.assertGreater(len(SHIPPED), 40)
        for kind, path in SHIPPED:
            with self.subTest(path.name):
                self.assertEqual(refusals(kind, path.read_text()), [])

    def test_track_configurations_are_right(self):
        blocks = re.findall(r"```yaml\n(.*?)```", (SOURCE / "docs/use/track.md").read_text(), re.DOTALL)
        self.assertTrue(blocks)
        for text in TRACKS + blocks:
            with self.subTest(text):
                self.assertEqual(refusals("track", text), [])

    def test_an_entry_may_be_like_another(self):
        for old, new in [("kind: camera, device: camera, host: camera_pre, measurement: scheduled, base",
                          "like: laser, kind: camera, device: camera, host: camera_pre, base"),
                         ("sensors:\n", "sensors:\n  rear: {like: laser, raw: 9}\n"),
                         ("pdus:\n", "pdus:\n  rear_scan: {like: laser_scan, sensor: camera}\n")]:
            for kind, path in [("cluster", PAPER), ("plan", PLAN)]:
                text = (SOURCE / path).read_text()
                self.assertEqual(refusals(kind, text.replace(old, new)), [], new)

    def test_wrong_files_are_refused_with_the_key(self):
        for name, kind, file, old, new, key in WRONG:
            with self.subTest(name):
                good = TRACKS[1] if file is None else (SOURCE / file).read_text()
                self.assertIn(old, good)
                wrong = good.replace(old, new, 1)
                self.assertEqual(refusals(kind, good), [])
                said = refusals(kind, wrong)
                self.assertTrue(any(re.search(rf"\b{key}\b", line) for line in said), said)
                with tempfile.TemporaryDirectory() as folder:
                    code, errors = program_says(kind, pathlib.Path(folder), wrong)
                self.assertEqual(code, 2, errors)
                self.assertRegex(errors, rf"wrong\.yaml:[0-9]+: [^ ]*\b{key}\b")
                print(f"{name}: {said[0]}")


# Drives whose summaries have all parts but those of real time: a scenario, options, and members of each strategy.
DRIVES = [
    ("paper_scenario1", ["--duration", "1.6"], {"age_by_stage", "can_load", "clear_mot"}),
    ("acc_braking_lead", ["--strategy", "tt"], {"driving", "odometry"}),
    ("lane_keeping", ["--strategy", "tt", "--duration", "4"], {"driving"}),
    ("faulty_bus", ["--strategy", "tt"], {"faults", "unattributed", "fault_free_nodes"}),
    ("faulty_can", ["--strategy", "tt"], {"faults", "cans"}),
    ("cold_start", ["--strategy", "tt"], {"startup"}),
]


class Summaries(unittest.TestCase):
    """summary.json of real drives fits its schema, which refuses any other member."""

    @staticmethod
    def refusals(summary) -> list[str]:
        return [".".join(map(str, error.absolute_path)) + ": " + error.message
                for error in jsonschema.Draft7Validator(SCHEMAS["summary"]).iter_errors(summary)]

    def drive(self, scenario: str, *options: str):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([PROGRAM, "run", scenario, "--no-log", "--json", "--out", f"{folder}/out", *options],
                                  capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_drives_fit(self):
        for scenario, options, members in DRIVES:
            with self.subTest(scenario):
                summary = self.drive(scenario, *options)
                self.assertEqual(self.refusals(summary), [])
                for strategy in summary["strategies"]:
                    self.assertLessEqual(members, set(strategy))

    def test_another_member_and_an_absent_one_are_refused(self):
        right = self.drive("paper_scenario1", "--strategy", "tt", "--duration", "1.6")
        for change in (lambda rmse: rmse.update(z=0.0), lambda rmse: rmse.pop("x"), lambda rmse: rmse.update(x="small")):
            wrong = json.loads(json.dumps(right))
            change(wrong["strategies"][0]["rmse_truth"])
            self.assertTrue(any("rmse_truth" in line for line in self.refusals(wrong)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
