"""docs/examples/gate_workflow.yml and gate_verdict.sh: well-formed, the options it uses exist, and its steps pass, warn
or fail as docs/gate.md says. The gate itself is a stand-in that ends with a given code.
Usage: workflow_test.py SOURCE PROGRAM"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

SOURCE, PROGRAM = map(os.path.abspath, sys.argv[1:3])
EXAMPLES = os.path.join(SOURCE, "docs/examples")
with open(os.path.join(EXAMPLES, "gate_workflow.yml")) as workflow:
    JOBS = yaml.safe_load(workflow)["jobs"]
STAND_IN = """#!/usr/bin/env bash
echo "$@" >> calls
case " $* " in *" --renew "*) exit 0;; esac
[ CODE -eq 2 ] && exit 2
mkdir -p gate-run/records && cp "$DATA"/verdict.* . && cp "$DATA"/records.jsonl gate-run/records/
exit CODE
"""


def steps_of(job):
    return [step["run"] for step in JOBS[job]["steps"] if "run" in step]


def run_gate_step(folder, job, code):
    """The step that calls the gate, as a runner would: bash with -e and pipefail."""
    os.makedirs(folder + "/docs")
    os.symlink(EXAMPLES, folder + "/docs/examples")
    for tree in ("build", "base/build"):
        os.makedirs(f"{folder}/{tree}/release/tools")
        path = f"{folder}/{tree}/release/tools/binpick"
        with open(path, "w") as file:
            file.write(STAND_IN.replace("CODE", str(code)))
        os.chmod(path, 0o755)
    data = folder + "/data"
    os.makedirs(data)
    flips = [{"lost": True, "what": "first pick", "replay": "binpick trial a.yaml --seed 7"},
             {"lost": False, "what": "first pick", "replay": "binpick trial a.yaml --seed 8"}]
    for name, text in (("verdict.json", json.dumps({"flips": flips})), ("verdict.xml", "<testsuite/>"),
                       ("verdict.md", "x" * 3_000_000),
                       ("records.jsonl", '{"seed":9}\n{"seed":11,"failure":"Timeout"}\n{"seed":12,"fai')):
        with open(f"{data}/{name}", "w") as file:
            file.write(text)
    env = dict(os.environ, SCENE="tee_ppf", SEEDS="300", GITHUB_RUN_NUMBER="42", DATA=data,
               GITHUB_STEP_SUMMARY=folder + "/summary")
    step = [s for s in steps_of(job) if "binpick gate" in s][-1]
    return subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step], cwd=folder, env=env,
                          capture_output=True, text=True)


class Workflow(unittest.TestCase):
    def test_every_step_is_a_script(self):
        for job in JOBS:
            self.assertGreaterEqual(len(steps_of(job)), 3)
            for step in steps_of(job):
                self.assertNotIn("${{", step, "values reach scripts by their environment")
                done = subprocess.run(["bash", "-n", "-c", step], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_scenes_and_options_exist(self):
        text = subprocess.run([PROGRAM, "gate", "--help"], capture_output=True, text=True).stdout
        for job in JOBS.values():
            for scene in job["strategy"]["matrix"]["scene"]:
                for ending in (".yaml", ".baseline.jsonl"):
                    self.assertTrue(os.path.exists(f"{SOURCE}/scenes/ci/{scene}{ending}"), scene)
        used = {o for job in JOBS for s in steps_of(job) for call in re.findall(r"binpick gate (?:.*\\\n)*.*", s)
                for o in re.findall(r"--[a-z-]+", call)}
        self.assertGreater(len(used), 8)
        for option in used:
            self.assertIn(option, text)

    def test_codes(self):
        for job in JOBS:
            for code, ends in ((0, 0), (1, 1), (2, 2), (3, 0), (5, 5), (6, 6), (7, 7), (130, 130)):
                with self.subTest(job=job, code=code), tempfile.TemporaryDirectory() as folder:
                    done = run_gate_step(folder, job, code)
                    self.assertEqual(done.returncode, ends, done.stderr)
                    self.assertEqual("::warning::" in done.stdout, code == 3, done.stdout)
                    self.assertEqual("::error::" in done.stdout, code not in (0, 3), done.stdout)
                    if code == 2:  # no verdict: the error is in the log
                        continue
                    self.assertLessEqual(os.path.getsize(folder + "/summary"), 1 << 20)
                    with open(folder + "/replay.txt") as replay:
                        self.assertEqual(replay.read(), "binpick trial a.yaml --seed 7  # first pick\n"
                                         "binpick trial scenes/ci/tee_ppf.yaml --seed 11  # Timeout\n")

    def test_nights_have_seeds_of_their_own(self):
        with tempfile.TemporaryDirectory() as folder:
            run_gate_step(folder, "nightly", 0)
            with open(folder + "/calls") as calls:
                renewed, gated = calls.read().splitlines()
            self.assertIn("--renew --seeds 1042000:1042300", renewed)
            self.assertIn("--max-seeds 300", gated)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
