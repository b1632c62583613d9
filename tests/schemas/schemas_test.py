"""The JSON Schemas of assets/schemas against what the program reads and writes.

SWARF_PROGRAM names the program, SWARF_SOURCE the folder of the sources."""
import copy
import json
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib
import unittest

import jsonschema

PROGRAM = os.environ["SWARF_PROGRAM"]
SOURCE = pathlib.Path(os.environ["SWARF_SOURCE"])

# No key is near it, so that the program lists the keys that it knows.
NO_KEY = "qqqqqqqqqqqqqqqqqqqqqqqqqqqq"


def schema(name):
    return json.loads((SOURCE / "assets/schemas" / f"{name}.schema.json").read_text())


def validator(name):
    jsonschema.Draft202012Validator.check_schema(schema(name))
    return jsonschema.Draft202012Validator(schema(name))


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def known_keys(text, name="scene.toml"):
    """By table ("" or "cutter.holder"): the keys that the program lists for the text's unknown one."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "part.ngc").write_text("G21\n")
        file = pathlib.Path(folder, name)
        file.write_text(text)
        said = run("check", file)[1]
    known = {}
    for place, keys in re.findall(rf"nothing is called '(.*){NO_KEY}'.*\n\s*fix: known here: (.*)", said):
        known.setdefault(re.sub(r"\[\d+\]", "", place).rstrip("."), set()).update(keys.split(", "))
    return known


def in_inches(key):
    """speed_max_mm_min: speed_max_in_min; None for a key that is no length."""
    found = re.fullmatch(r"(.*)_mm(_(?!.*_mm).*)?", key)
    return f"{found[1]}_in{found[2] or ''}" if found else None


def in_mm(names):
    """Without the spellings in inches, which every length has and nothing else."""
    twins = {in_inches(name) for name in names} - {None}
    assert twins <= names, twins - names
    return names - twins


def schema_keys(node, root, path=""):
    """The same of a schema: every table with fixed names, lengths in mm."""
    while "$ref" in node:
        node = root["$defs"][node["$ref"].rsplit("/", 1)[-1]]
    if node.get("type") == "array":
        return schema_keys(node["items"], root, path)
    if "properties" not in node:
        return {}
    found = {path: in_mm(set(node["properties"]))}
    for name in found[path]:
        found.update(schema_keys(node["properties"][name], root, f"{path}.{name}".lstrip(".")))
    return found


def scene_texts():
    """Scenes that together ask for every key: each kind of program, cutter and design, an unknown key in each table."""
    tables = ["setup", "stock", "toolpath", "interpolator", "accept", "movie", "stills", "output", "report"]
    shapes = schema("scene")["$defs"]["tool"]["properties"]["shape"]["enum"]
    designs = schema("scene")["properties"]["design"]["properties"]["kind"]["enum"]
    no = f"{NO_KEY} = 0\n"
    rest = "".join(f"[{table}]\n{no}" for table in tables)
    for kind in ("program", "cl", "nc"):
        switch = f"[kinematics_switch]\n{no}" if kind == "nc" else ""
        yield f"{no}{kind} = 'part.ngc'\n{rest}[cutter]\n{no}{switch}"
    for shape in shapes:
        yield f"nc = 'part.ngc'\n[[tool]]\nshape = '{shape}'\n{no}"
    yield f"nc = 'part.ngc'\n[[tool]]\nshape = 'profile'\n{no}[[tool.profile]]\n{no}[[tool.holder]]\n{no}"
    yield f"cl = 'part.cls'\n[post]\n{no}[post.clamping]\n{no}[post.tool_reach]\n{no}"
    yield (f"nc = 'part.ngc'\n[design]\nkind = 'nurbs'\ndegree = [1, 1]\ncount = [2, 2]\nweights = [1, 1, 1, 1]\n"
           f"poles_mm = [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]\n{no}")
    yield f"nc = 'part.ngc'\n[design]\nkind = 'ruled_faces'\nstep = 'a.stp'\n{no}[[design.face]]\n{no}"
    # A guide has no interval; the part is a surface, a mesh or a CAD file.
    for mode in ("scan", "contour", "spiral", "guide"):
        for part in ("surface", "mesh", "step"):
            for axis in ("lead_deg = 5", "axis = [0, 0, 1]"):
                yield (f"[driven]\n{part} = 'part.x'\nmode = '{mode}'\narea_mm = [[0, 0], [1, 1]]\nfloor_mm = 0\n"
                       f"compare_cam_um = [10, 1]\n{axis}\n{no}[interpolator]\n{no}")
    yield f"nc = 'part.ngc'\n[[contact_pair]]\nparts = ['table', 'holder']\n{no}"
    yield f"nc = 'part.ngc'\n[movie]\n{no}[[movie.shot]]\n{no}"
    yield f"nc = 'part.ngc'\n[stills]\n{no}[[stills.shot]]\n{no}"
    yield f"[flank]\n{no}[design]\nkind = 'ruled'\n{no}[interpolator]\n{no}[stock]\n{no}"
    for kind in schema("scene")["properties"]["fixture"]["items"]["properties"]["kind"]["enum"]:
        yield f"nc = 'part.ngc'\n[[fixture]]\nkind = '{kind}'\n{no}"
    for raw in ("cylinder = {{ {0} }}", "tube = {{ {0} }}", "outline = {{ {0} }}", "mesh = 'a.stl'",
                "from_run = 'out'\nfrom_run_pose = {{ {0} }}"):
        yield f"nc = 'part.ngc'\n[stock]\n{raw.format(no.strip())}\n{no}"
    for design in designs:
        yield f"nc = 'part.ngc'\n[design]\nkind = '{design}'\n{no}"


class Keys(unittest.TestCase):
    """The schema's keys are those that the reader knows, so that it cannot go stale."""

    maxDiff = None

    def test_scene(self):
        known = {}
        for text in scene_texts():
            for table, keys in known_keys(text).items():
                known.setdefault(table, set()).update(keys)
        expected = schema_keys(schema("scene"), schema("scene"))
        self.assertEqual(known["cutter"] - {NO_KEY}, known["cutter"])
        # [cutter] and [[tool]] are one description; the shapes were tried in [[tool]].
        self.assertLessEqual(known.pop("cutter"), known["tool"])
        for name in ("cutter", "cutter.profile", "cutter.holder"):
            self.assertEqual(expected.pop(name), expected[name.replace("cutter", "tool")])
        self.assertEqual(known, expected)

    def test_machine(self):
        no = f"{NO_KEY} = 0\n"
        known = {}
        for kind in ("linear", "rotary"):
            text = (f"{no}[[axis]]\nname = 'A'\ntype = '{kind}'\n{no}"
                    + "".join(f"{table}\n{no}" for table in ("[work]", "[tool]", "[[link]]")))
            for table, keys in known_keys(text, "machine.toml").items():
                known.setdefault(table, set()).update(keys)
        self.assertEqual(known, schema_keys(schema("machine"), schema("machine")))

    def test_post(self):
        no = f"{NO_KEY} = 0\n"
        tables = ["numbers", "blocks", "comment", "program", "tool", "spindle", "coolant", "words", "motion", "feed",
                  "tcp", "tilted_plane", "cycle", "output"]
        numbers = [f"numbers.{name}" for name in ("linear", "rotary", "feed", "inverse_time", "speed", "time")]
        text = f"{no}name = 'x'\ndialect = 'fanuc'\n" + "".join(f"[{table}]\n{no}" for table in tables + numbers)
        self.assertEqual(known_keys(text, "post.toml"), schema_keys(schema("post"), schema("post")))


class Shipped(unittest.TestCase):
    def test_every_scene(self):
        files = sorted((SOURCE / "scenes").glob("*/scene.toml"))
        self.assertGreater(len(files), 20)
        for file in files:
            with self.subTest(file=file):
                validator("scene").validate(tomllib.loads(file.read_text()))

    def test_every_machine(self):
        files = sorted((SOURCE / "assets/machines").glob("*/machine.toml"))
        self.assertEqual(len(files), 8)
        for file in files:
            with self.subTest(file=file):
                validator("machine").validate(tomllib.loads(file.read_text()))

    def test_every_post(self):
        files = sorted((SOURCE / "assets/posts").glob("*.toml"))
        self.assertEqual(len(files), 6)
        for file in files:
            with self.subTest(file=file):
                post = tomllib.loads(file.read_text())
                validator("post").validate(post)
                self.assertFalse(validator("post").is_valid({**post, "moton": {}}))


    def test_the_keys_of_one_of_several_set_ups(self):
        whole = schema("scene")
        one = set(whole["$defs"]["one_setup"]["properties"])
        root = set(whole["properties"]) - {"setup"}
        self.assertEqual(one, root | set(whole["properties"]["setup"]["properties"]) | {"name", "part_pose"})
        scene = {"stock": {"box_mm": [[0, 0, -5], [20, 20, 0]], "voxel_mm": 0.5}}
        setups = [{"nc": "a.ngc", "tools": "6"}, {"nc": "b.ngc", "tools": "6", "part_pose": {"rotation_deg": [180, 0, 0]}}]
        self.assertTrue(validator("scene").is_valid({**scene, "setup": setups}))
        for wrong in ([], [{**setups[0], "part_pos": {}}], [{**setups[0], "part_pose": {"scale": 2}}]):
            self.assertFalse(validator("scene").is_valid({**scene, "setup": wrong}), wrong)


class Written(unittest.TestCase):
    """metrics.json and findings.json of runs that fill each section."""

    def check(self, name, *words, section=None):
        with tempfile.TemporaryDirectory() as folder:
            code, said = run("run", SOURCE / "scenes" / name / "scene.toml", "--no-render", "-q", "-o", f"{folder}/out", *words)
            self.assertIn(code, (0, 1), said)
            metrics, findings = (json.loads(pathlib.Path(folder, "out", file).read_text())
                                 for file in ("metrics.json", "findings.json"))
        validator("metrics").validate(metrics)
        validator("findings").validate(findings)
        if section:
            self.assertTrue(metrics[section])
        return metrics, findings

    def test_a_design_with_gouges(self):
        metrics, findings = self.check("exact_gouges", section="gouges")
        self.assertEqual(len(findings), 3)
        for wrong in ({"verdict": "good"}, {"stock": {}}, {"gouge_max": 1.0}, {"memory_peak_mb": "12"}):
            self.assertFalse(validator("metrics").is_valid({**metrics, **wrong}), wrong)
        for wrong in ({"severity": "bad"}, {"line": -1}, {"colour": "red"}):
            self.assertFalse(validator("findings").is_valid([{**findings[0], **wrong}]), wrong)
        self.assertFalse(validator("findings").is_valid(findings[0]))

    def test_an_nc_program_without_a_design(self):
        metrics, findings = self.check("nc_pocket", section="program")
        self.assertIsNone(metrics["surface"]["gouge_max_um"])
        self.assertEqual(findings, [])

    def test_contacts(self):
        metrics, _ = self.check("exact_shank", section="bad_cuts")
        self.assertTrue(metrics["collisions"]["events"] and metrics["bad_cuts"]["events"])

    def test_a_casting(self):
        metrics, _ = self.check("stock_casting", section="stock")
        self.assertEqual(set(metrics["stock"]["raw"]), {"shape", "volume_mm3", "box_mm"})

    def test_a_second_set_up(self):
        with tempfile.TemporaryDirectory() as folder:
            code, said = run("run", SOURCE / "scenes/two_setups/scene.toml", "--no-render", "-q", "-o", f"{folder}/out")
            self.assertEqual(code, 0, said)
            for name in ("1_first_side", "2_turned_over"):
                metrics = json.loads(pathlib.Path(folder, "out", name, "metrics.json").read_text())
                validator("metrics").validate(metrics)
                self.assertEqual(metrics["stock"]["earlier"] is None, name == "1_first_side")
            setups = json.loads(pathlib.Path(folder, "out", "setups.json").read_text())
            validator("setups").validate(setups)
            self.assertFalse(validator("setups").is_valid({**setups, "finished": [{}]}))

    def test_a_batch(self):
        with tempfile.TemporaryDirectory() as folder:
            jobs = pathlib.Path(folder, "jobs.toml")
            jobs.write_text('arguments = ["--no-render"]\n' + "".join(
                f'[[job]]\nfile = "{SOURCE}/scenes/{name}/scene.toml"\n' for name in ("exact_slot_flat", "exact_slot_ball")))
            code, said = run("batch", jobs, "-o", f"{folder}/out", "-q", "--only", "1")
            self.assertEqual(code, 0, said)
            code, said = run("batch", jobs, "-o", f"{folder}/out", "--summary", "-q")
            self.assertEqual(code, 130, said)
            table = json.loads(pathlib.Path(folder, "out", "batch.json").read_text())
            validator("batch").validate(table)
            self.assertEqual([job["outcome"] for job in table["jobs"]], ["PASS", "NOT RUN"])
            self.assertFalse(validator("batch").is_valid({**table, "jobs": [{}]}))

    def test_flank(self):
        self.check("exact_flank_f1", section="flank")

    def test_pole(self):
        self.check("so_singularity", section="singularity")

    def test_planned_passes(self):
        coarse = ["stock.voxel_mm=1", "design.pitch_mm=1", "toolpath.compare=false", "accept.gouge_max_um=100",
                  "accept.scallop_max_um=100"]
        self.check("lin_koren_dome", *sum((["--set", key] for key in coarse), []), section="planners")


class Refused(unittest.TestCase):
    """What the schema refuses, the program refuses too."""

    SCENE = {
        "nc": "part.ngc",
        "cutter": {"number": 1, "diameter_mm": 6, "flute_length_mm": 20, "length_mm": 50},
        "stock": {"box_mm": [[0, 0, -5], [20, 20, 0]], "voxel_mm": 0.5},
    }
    WRONG = {
        "a misspelt key": ("stock.voxle_mm", 0.5),
        "a misspelt table": ("stok", {}),
        "a text for a number": ("cutter.diameter_mm", "6"),
        "a voxel of nothing": ("stock.voxel_mm", 0),
        "a box of one corner": ("stock.box_mm", [[0, 0, 0]]),
        "two raw stocks": ("stock", {"mesh": "a.stl", "cylinder": {"diameter_mm": 20, "length_mm": 10}}),
        "a bar without its length": ("stock", {"cylinder": {"diameter_mm": 20}}),
        "an outline of two corners": ("stock", {"outline": {"points_mm": [[0, 0], [1, 1]], "z_mm": [0, 1]}}),
        "a shape that nobody knows": ("cutter.shape", "fish"),
        "two programs": ("cl", "part.cls"),
        "an axis without its unit": ("setup", {"start": {"X": 1}}),
        "a picture of odd size": ("stills", {"size": [641, 480]}),
        "a limit of -1": ("accept", {"collisions": -1}),
    }

    def test_scenes(self):
        self.assertTrue(validator("scene").is_valid(self.SCENE))
        for what, (key, value) in self.WRONG.items():
            with self.subTest(what=what):
                scene = copy.deepcopy(self.SCENE)
                *tables, last = key.split(".")
                table = scene
                for name in tables:
                    table = table[name]
                table[last] = value
                self.assertFalse(validator("scene").is_valid(scene))
                self.assertEqual(self.program_says(scene), 2)
        self.assertFalse(validator("scene").is_valid({"cutter": self.SCENE["cutter"]}))

    def test_inches(self):
        scene = copy.deepcopy(self.SCENE)
        scene["cutter"] = {"number": 1, "diameter_in": 0.25, "flute_length_in": 1, "length_mm": 50}
        scene["stock"] = {"box_in": [[0, 0, -0.2], [1, 1, 0]], "voxel_mm": 0.5}
        self.assertTrue(validator("scene").is_valid(scene))
        self.assertNotEqual(self.program_says(scene), 2)
        scene["cutter"]["length_in"] = 2
        self.assertFalse(validator("scene").is_valid(scene))
        self.assertEqual(self.program_says(scene), 2)
        del scene["cutter"]["length_in"], scene["cutter"]["length_mm"]
        self.assertFalse(validator("scene").is_valid(scene))

    def program_says(self, scene):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "part.ngc").write_text("G21 G90\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM2\n")
            file = pathlib.Path(folder, "scene.toml")
            # JSON and TOML write numbers, texts and lists alike.
            tables = {k: v for k, v in scene.items() if isinstance(v, dict)}
            lines = [f"{k} = {json.dumps(v)}" for k, v in scene.items() if k not in tables]
            for name, table in tables.items():
                lines += [f"{name}.{k} = {self.inline(v)}" for k, v in table.items()] or [f"[{name}]"]
            file.write_text("\n".join(lines) + "\n")
            return run("check", file)[0]

    def inline(self, value):
        if isinstance(value, dict):
            return "{ " + ", ".join(f"{k} = {self.inline(v)}" for k, v in value.items()) + " }"
        return json.dumps(value)

    def test_machines(self):
        right = tomllib.loads((SOURCE / "assets/machines/mill_3axis/machine.toml").read_text())
        self.assertTrue(validator("machine").is_valid(right))
        for key, value in {"axis": [], "rapid": "slow", "nmae": "mill", "work": {}, "link": [{}]}.items():
            with self.subTest(key=key):
                self.assertFalse(validator("machine").is_valid({**right, key: value}))
        del right["axis"][0]["speed_max_mm_min"]
        self.assertFalse(validator("machine").is_valid(right))


if __name__ == "__main__":
    unittest.main()
