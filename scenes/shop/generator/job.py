"""A job: its part, stock, tools, program and fault, and the files that they become."""
import json
import re

from . import solids

JOBS = {}


class Tool:
    """A cutter with shank and holder; `keys` are further keys of [[tool]]."""

    def __init__(self, number, note, d, flutes, shape=None, length=None, shank=None, holder=40, **keys):
        self.number, self.note, self.d, self.flutes, self.shape = number, note, d, flutes, shape
        self.length = length or max(flutes + 20, 45)
        self.shank, self.holder, self.keys = shank, holder, keys

    def text(self, table="[[tool]]"):
        lines = [table, f"number = {self.number}"]
        if self.shape:
            lines.append(f'shape = "{self.shape}"')
        lines.append(f"diameter_mm = {self.d:g}")
        lines += [f"{key} = {value:g}" for key, value in self.keys.items()]
        if self.shape != "woodruff":
            lines.append(f"flute_length_mm = {self.flutes:g}")
        if self.shank:
            lines.append(f"shank_diameter_mm = {self.shank:g}")
        lines.append(f"length_mm = {self.length:g}")
        lines.append(f"holder = [{{ diameter_mm = {self.holder:g}, length_mm = 50 }}]")
        return "\n".join(lines)


class Fault:
    """What the program makes wrong when it is written with fault=True, or what `sets` change.

    amount_um: greatest distance to the design; place_mm: where; mark: the blocks that cut it (several: a tuple)."""

    def __init__(self, kind, amount_um, place_mm, mark, what, sets=()):
        self.kind, self.amount, self.place, self.what, self.sets = kind, amount_um, place_mm, what, list(sets)
        self.marks = [mark] if isinstance(mark, str) else list(mark)


class Job:
    def __init__(self, name, title, part, stock, tools, program, fault=None, notes=(), machine="mill_3axis",
                 scene_text=None, excess_um=10, setup='work_origin_mm = "on_table"', extra="", kind="nc",
                 stock_text=None, head="", voxel=None, chord_um=solids.CHORD_UM, files=None,
                 facets=None):
        self.__dict__.update(locals())
        del self.__dict__["self"]
        JOBS[name] = self

    def text_of(self, fault):
        program = self.program(fault)
        return program, "\n".join(program.lines) + "\n"

    def scene(self):
        if self.scene_text:
            return self.scene_text
        stl = self.chord_um
        lines = [f"# {note}" for note in self.notes]
        lines += [f"# Against the mesh, whose facets err by up to {stl:g} um: --set 'design={{mesh=\"part.stl\"}}' "
                  f"--set accept.gouge_max_um={stl + 2:g} --set accept.excess_max_um={self.excess_um + stl:g}"]
        lines += [f'title = "{self.title}"', f'machine = "{self.machine}"', f'{self.kind} = "part.{self.kind}"']
        if self.head:
            lines.append(self.head)
        lines += ["", "[setup]", self.setup, "", "[stock]"]
        if self.stock_text:
            lines.append(self.stock_text)
        else:
            low, high = self.stock
            lines.append(f"box_mm = [{list(low)}, {list(high)}]")
        if self.voxel:
            lines.append(f"voxel_mm = {self.voxel:g}")
        lines += ["", "[design]", 'step = "part.step"', "", "[accept]", "gouge_max_um = 2",
                  f"excess_max_um = {self.excess_um:g}", "", "[movie]", "seconds = 0"]
        if self.extra:
            lines += ["", self.extra]
        for tool in self.tools:
            lines += ["", tool.text()]
        return "\n".join(lines) + "\n"

    def mesh_sets(self):
        """What --set says so that part.stl is the design: limits are those of the faces and the facets' error."""
        setup = "setup[1]." if "[[setup]]" in self.scene() else ""
        return [setup + 'design={mesh="part.stl"}', f"{setup}accept.gouge_max_um={self.chord_um + 2:g}",
                f"{setup}accept.excess_max_um={self.excess_um + self.chord_um:g}"]

    def truth(self, right, right_text, wrong_text):
        fault = self.fault
        a, b = right_text.split("\n"), wrong_text.split("\n")
        assert len(a) == len(b), f"{self.name}: the fault changes the number of lines"
        edits = [[k + 1, x, y] for k, (x, y) in enumerate(zip(a, b)) if x != y]
        assert edits or fault.sets, f"{self.name}: the fault changes nothing"
        return {"mesh": {"chord_um": self.chord_um, "set": self.mesh_sets()},
                "fault": {"what": fault.what, "kind": fault.kind, "amount_um": round(fault.amount, 3),
                          "place_mm": [round(c, 4) for c in fault.place],
                          "lines": [list(right.marks[mark]) for mark in fault.marks], "edits": edits,
                          "set": fault.sets}}

    def write(self, folder, shapes=True):
        folder.mkdir(exist_ok=True)
        print(f"{self.name}:", end=" ", flush=True)
        if shapes:
            shape = solids.one_solid(self.part())
            solids.write_step(shape, folder / "part.step", self.name)
            count, error = solids.write_stl(shape, folder / "part.stl", self.name, self.chord_um,
                                            self.facets() if self.facets else None)
            print(f"{len(shape.Faces)} faces, {count} facets within {error:.2f} um,", end=" ")
        right, text = self.text_of(False)
        (folder / f"part.{self.kind}").write_text(text)
        (folder / "scene.toml").write_text(self.scene())
        for name, make in (self.files or {}).items():
            make(folder / name)
        dump = json.dumps(self.truth(right, text, self.text_of(True)[1]), indent=1)
        dump = re.sub(r"\[\s*([^\[\]{}]*?)\s*\]", lambda m: "[" + re.sub(r"\s*\n\s*", " ", m[1]) + "]", dump)
        (folder / "truth.json").write_text(dump + "\n")
        print(f"{len(right.lines)} lines")
