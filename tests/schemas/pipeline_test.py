"""SARIF and JUnit files of the program, by the rules of their public schemas.

SARIF: the objects that are written, with the properties that SARIF 2.1.0 (OASIS) gives them and no others. JUnit: elements
and attributes in the order of the schema that Jenkins publishes for its xUnit plugin.
SWARF_PROGRAM names the program."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import jsonschema

PROGRAM = os.environ["SWARF_PROGRAM"]

MESSAGE = {"type": "object", "required": ["text"], "additionalProperties": False, "properties": {"text": {"type": "string"}}}
REGION = {
    "type": "object", "required": ["startLine"], "additionalProperties": False,
    "properties": {"startLine": {"type": "integer", "minimum": 1}, "startColumn": {"type": "integer", "minimum": 1}},
}
LOCATION = {
    "type": "object", "required": ["physicalLocation"], "additionalProperties": False,
    "properties": {
        "physicalLocation": {
            "type": "object", "required": ["artifactLocation"], "additionalProperties": False,
            "properties": {
                "artifactLocation": {
                    "type": "object", "required": ["uri"], "additionalProperties": False,
                    "properties": {"uri": {"type": "string", "pattern": r"^[A-Za-z0-9\-._~/%:]+$"}},
                },
                "region": REGION,
            },
        },
    },
}
RESULT = {
    "type": "object", "required": ["message", "ruleId"], "additionalProperties": False,
    "properties": {
        "ruleId": {"type": "string"},
        "kind": {"enum": ["notApplicable", "pass", "fail", "review", "open", "informational"]},
        "level": {"enum": ["none", "note", "warning", "error"]},
        "message": MESSAGE,
        "locations": {"type": "array", "items": LOCATION},
    },
    # 3.27.10: where kind is not "fail", level is "none".
    "if": {"required": ["kind"], "properties": {"kind": {"not": {"const": "fail"}}}},
    "then": {"properties": {"level": {"const": "none"}}},
}
SARIF = {
    "type": "object", "required": ["version", "runs"], "additionalProperties": False,
    "properties": {
        "$schema": {"type": "string", "format": "uri"},
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object", "required": ["tool"], "additionalProperties": False,
                "properties": {
                    "tool": {
                        "type": "object", "required": ["driver"], "additionalProperties": False,
                        "properties": {
                            "driver": {
                                "type": "object", "required": ["name"], "additionalProperties": False,
                                "properties": {
                                    "name": {"type": "string"},
                                    "version": {"type": "string"},
                                    "rules": {
                                        "type": "array", "uniqueItems": True,
                                        "items": {"type": "object", "required": ["id"], "additionalProperties": False,
                                                  "properties": {"id": {"type": "string"}}},
                                    },
                                },
                            },
                        },
                    },
                    "invocations": {
                        "type": "array",
                        "items": {
                            "type": "object", "required": ["executionSuccessful"], "additionalProperties": False,
                            "properties": {"executionSuccessful": {"type": "boolean"}, "exitCode": {"type": "integer"}},
                        },
                    },
                    "results": {"type": "array", "items": RESULT},
                },
            },
        },
    },
}

# Element: (attributes that must stand there, those that may, children in their order).
JUNIT = {
    "testsuites": (set(), {"name", "time", "tests", "failures", "disabled", "errors"}, ["testsuite"]),
    "testsuite": ({"name", "tests"}, {"failures", "errors", "time", "disabled", "skipped", "timestamp", "hostname", "id", "package"},
                  ["properties", "testcase", "system-out", "system-err"]),
    "testcase": ({"name"}, {"classname", "time", "assertions", "status"},
                 ["skipped", "error", "failure", "system-out", "system-err"]),
    "skipped": (set(), {"message", "type"}, []),
    "error": (set(), {"message", "type"}, []),
    "failure": (set(), {"message", "type"}, []),
}

GROOVE = "G21 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0 Z20\nG1 Z-4 F300\nX20 F900\nG0 Z20\nM2\n"


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def told(self, *words):
        """Exit code, SARIF log and JUnit root of a command."""
        done = subprocess.run([PROGRAM, *words, "--sarif", "log.sarif", "--junit", "junit.xml"], cwd=self.path, capture_output=True)
        return (done.returncode, json.loads((self.path / "log.sarif").read_text(encoding="utf-8")),
                xml.etree.ElementTree.parse(self.path / "junit.xml").getroot())

    def check_element(self, element):
        must, may, children = JUNIT[element.tag]
        self.assertLessEqual(must, set(element.attrib), element.tag)
        self.assertLessEqual(set(element.attrib), must | may, element.tag)
        order = [children.index(child.tag) for child in element]
        self.assertEqual(order, sorted(order), element.tag)
        for child in element:
            self.check_element(child)

    def check_both(self, log, root):
        jsonschema.Draft202012Validator(SARIF).validate(log)
        rules = [rule["id"] for rule in log["runs"][0]["tool"]["driver"]["rules"]]
        self.assertEqual(len(rules), len(set(rules)))
        self.assertEqual({result["ruleId"] for result in log["runs"][0]["results"]}, set(rules))
        self.assertEqual(root.tag, "testsuites")
        self.check_element(root)
        for suite in root:
            for tag, count in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
                self.assertEqual(len(suite.findall(f"testcase/{tag}")), int(suite.get(count)), tag)
            self.assertEqual(len(suite.findall("testcase")), int(suite.get("tests")))

    def test_check(self):
        self.path.joinpath("good one.nc").write_text(GROOVE)
        self.path.joinpath("bäd<&>.nc").write_text(GROOVE.replace("X20", "X20 Q<1>"))
        code, log, root = self.told("check", "good one.nc", "bäd<&>.nc", "gone.nc")
        self.assertEqual(code, 2)
        self.check_both(log, root)
        self.assertEqual([suite.get("name") for suite in root], ["good one.nc", "bäd<&>.nc", "gone.nc"])
        wrong = [result for result in log["runs"][0]["results"] if result["level"] == "error"]
        self.assertEqual(wrong[0]["locations"][0]["physicalLocation"]["region"]["startLine"], 6)

    def test_run(self):
        self.path.joinpath("part.nc").write_text(GROOVE)
        code, log, root = self.told("run", "part.nc", "--tool", "10", "--voxel", "1", "--no-render")
        self.assertEqual(code, 0)
        self.check_both(log, root)
        kinds = {result.get("kind") for result in log["runs"][0]["results"]}
        self.assertLessEqual({"pass", "open"}, kinds)

    def test_findings_and_input_that_is_refused(self):
        self.path.joinpath("part.nc").write_text(GROOVE.replace("Z20\nG1 Z-4", "Z-4\nG1 Z-4"))
        code, log, root = self.told("run", "part.nc", "--tool", "10", "--voxel", "1", "--no-render", "--stock=-10,-10,-10,30,10,0")
        self.assertEqual(code, 1)
        self.check_both(log, root)
        self.assertGreater(int(root[0].get("failures")), 0)
        code, log, root = self.told("run", "part.nc", "--tools", "T2=10", "--no-render")
        self.assertEqual(code, 2)
        self.check_both(log, root)
        self.assertFalse(log["runs"][0]["invocations"][0]["executionSuccessful"])


if __name__ == "__main__":
    unittest.main()
