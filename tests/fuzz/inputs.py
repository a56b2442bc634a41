"""Makes up input of the program: parameter files, settings of the command line, meshes and geometry scripts, damaged in some way."""

import dataclasses
import pathlib
import re

import mutations
from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from mutations import NUMBERS, WORDS, damaged
from program import SCENE, SOURCE

# So that no input keeps the machine busy: the limits themselves are input, too
LIMITS = ["Geometry/Meshing time limit=10", "Geometry/Meshing memory limit=2"]

STATEMENTS = ["Exit;", "Abort;", 'Error("x");', "For i In {1 : 1000000000}\n  a = i;\nEndFor", "l() = {1 : 100000000}; m() = {l(), l()};",
              'SystemCall "touch trace";', 'Printf("x") > "trace";', 'Save "trace.msh";', 'Include "case.geo";', 'Merge "case.geo";',
              'Merge "missing.msh";', 'Include "/dev/zero";', "Delete Model;", "Mesh 3;", "Mesh 0;", "RefineMesh;", "SetOrder 2;", "Mesh.ElementOrder = 2;",
              "Physical Volume(1) = {99};", 'Physical Volume("disc") = {};', 'Physical Surface("") = {1};', "Coherence;", "Coherence Mesh;",
              "Point(1) = {0/0, 1/0, 1e308};", "Curve Loop(1) = {1, 1, 1};", "Recursive Delete { Volume{:}; }", "Mesh.MeshSizeFactor = 1e-6;",
              "Mesh.MeshSizeMax = 0;", "Mesh.Algorithm = 99;", "Transfinite Curve{:} = -1;", "Transfinite Curve{:} = 1000000;", "General.NumThreads = -1;",
              "If (1)", "EndIf", "Macro x", "Return", "Call y;", "a = Pi ^ 1e9 % 0;", "DefineConstant[ a = {1, Name \"" + "x" * 10000 + "\"} ];",
              "DefineNumber[", "a" * 100_000 + " = 1;", "(" * 10_000, "/*", '"', "x() = LinSpace[0, 1, 1e9];", "Dilate {{0, 0, 0}, 0} { Volume{:}; }",
              "Periodic Surface {1} = {1} Translate {0, 0, 0};", "OnelabRun(\"x\", \"touch trace\");", "Plugin(Skin).Run;", "Mesh.Format = 1;"]


@dataclasses.dataclass
class Case:
    """Files by their names, one of them `case.prm`, and arguments besides it."""
    files: dict
    arguments: list = dataclasses.field(default_factory=list)

    def write(self, folder):
        for name, content in self.files.items():
            (folder / name).write_bytes(content)


def settings(*texts):
    return [word for text in texts for word in ("--set", text)]


class Inputs:
    """All kinds of input; @p listing is what --print-parameters prints, @p meshes one mesh in several formats."""

    def __init__(self, random, listing, meshes):
        self.random = random
        self.meshes = meshes
        self.parameters = self.names_and_values(listing)
        self.parameter_files = [path.read_bytes() for path in sorted((SOURCE / "prm").rglob("*.prm"))]
        self.scripts = [path.read_bytes() for path in sorted((SOURCE / "geometry").glob("*.geo"))]
        self.scripts += [(BLOCKS + HEXAHEDRA + VOLUMES + SURFACES).encode()]
        self.kinds = {"parameters": self.parameter_file, "settings": self.command_line, "meshes": self.mesh, "scripts": self.script}

    @staticmethod
    def names_and_values(listing):
        """Section/Name and value of every parameter."""
        result, sections = {}, []
        for line in listing.splitlines():
            words = line.split()
            if line.strip().startswith("subsection"):
                sections.append(" ".join(words[1:]))
            elif words == ["end"]:
                sections.pop()
            elif setting := re.match(r"\s*set (.*?)\s*=\s*(.*)", line):
                result["/".join([*sections, setting[1]])] = setting[2]
        return result

    def case(self, kind):
        return self.kinds[kind]()

    def bad_value(self, old):
        """Anything in the place of a value."""
        return self.random.choice([self.random.choice(NUMBERS), self.random.choice(WORDS), mutations.exchange_numbers(self.random, old),
                                   damaged(self.random, old, mutations.OF_BYTES), old + b"e" + str(self.random.randint(-20, 20)).encode()])

    # --------------------------------------------------------- parameter files

    def parameter_file(self):
        scene = self.random.choice([SCENE.encode(), SCENE.encode(), *self.parameter_files])
        builders = [self.damaged_file, self.damaged_file, self.other_values, self.other_values, self.includes, self.structure]
        return self.random.choice(builders)(scene)

    def damaged_file(self, scene):
        if self.random.random() < 0.1:
            return Case({"case.prm": mutations.random_bytes(self.random, self.random.choice([0, 1, 10, 1000, 100_000]))}, settings(*LIMITS))
        return Case({"case.prm": damaged(self.random, scene, mutations.OF_TEXT)}, settings(*LIMITS))

    def assignment(self):
        name, value = self.random.choice(list(self.parameters.items()))
        *sections, name = name.split("/")
        bad = self.bad_value(value.encode())
        return ("".join(f"subsection {section}\n" for section in sections).encode() + b"set " + name.encode() + b" = " + bad + b"\n" +
                b"end\n" * len(sections))

    def other_values(self, scene):
        lines = b"\n".join(self.assignment() for _ in range(self.random.choice([1, 1, 1, 2, 3])))
        return Case({"case.prm": scene + b"\n" + lines}, settings(*LIMITS))

    def includes(self, scene):
        """Chains, circles and trees of files."""
        depth = self.random.choice([1, 2, 30, 300])
        files = {f"{i}.prm": b"include %d.prm\n" % (i + 1) for i in range(depth)}
        files[f"{depth}.prm"] = self.random.choice(
            [b"include 0.prm", b"include case.prm", b"include ./../%s/0.prm" % b"x", b"include missing.prm", b"include .", b"include", b"end",
             b"subsection Geometry", b"include /dev/zero", b"include /dev/stdin", b"include " + b"x" * 5000, b"include \xff\xff", b"set Study = x",
             b"", scene, damaged(self.random, scene, mutations.OF_TEXT)])
        if self.random.random() < 0.3:  # each file twice: as many readings as 2 to the power of the depth
            files = {name: content * (2 if name != f"{depth}.prm" else 1) for name, content in files.items()}
        return Case({"case.prm": scene + b"\ninclude 0.prm\n", **files}, settings(*LIMITS))

    def structure(self, scene):
        """Sections that are open, closed twice, nested or unknown; names that do not exist or come twice."""
        lines = [b"end", b"subsection", b"subsection Geometry", b"subsection geometry", b"subsection Geometry/File", b"set", b"set =", b"set = 1",
                 b"set Study", b"set Study = stability = sweep", b"set Geometry/File = x", b"set Study = sweep\nset Study = stability", b"unknown line",
                 b"subsection No section\nend", b"set No parameter = 1", b"Set Study = sweep", b"subsection Geometry\nset Pin layers = 2\nend\n" * 3,
                 b"subsection Geometry\n" * 200 + b"end\n" * 200, b"subsection x\n" * 100_000, b"#" * 1_000_000, b"\\\n" * 1000, b"set Study = \\\nsweep",
                 b"set Study = sta\\\nbility", b"set Study \t=\tstability \r", b"set  Study=stability#sweep", b"set Study = stability \xff"]
        where = scene.split(b"\n")
        for _ in range(self.random.choice([1, 2, 3])):
            where.insert(self.random.randrange(len(where) + 1), self.random.choice(lines))
        return Case({"case.prm": b"\n".join(where)}, settings(*LIMITS))

    # ------------------------------------------------------------ command line

    def command_line(self):
        words = []
        for _ in range(self.random.choice([1, 1, 2, 3])):
            name, value = self.random.choice(list(self.parameters.items()))
            text = name.encode() + b"=" + self.bad_value(value.encode())
            if self.random.random() < 0.3:
                text = damaged(self.random, text, mutations.OF_BYTES)
            words += [b"--set", text]
        if self.random.random() < 0.1:
            words[self.random.randrange(len(words))] = self.random.choice(WORDS)
        # No argument holds a zero byte, nor more than 128 KiB
        return Case({"case.prm": SCENE.encode()}, [*settings(*LIMITS), *(word.replace(b"\0", b"")[:100_000] for word in words)])

    # ------------------------------------------------------------------ meshes

    def geometry(self, name, content):
        return Case({"case.prm": SCENE.encode(), name: content},
                    settings(*LIMITS, f"Geometry/File={name}", "Mounts/Elastic mounts="))

    def mesh(self):
        name, content = self.random.choice(list(self.meshes.items()))
        if name.startswith("binary") or self.random.random() < 0.2:
            return self.geometry("case.msh", damaged(self.random, content, mutations.OF_BYTES))
        if self.random.random() < 0.2:
            content = self.without_section(content)
            return self.geometry("case.msh", content)
        return self.geometry("case.msh", damaged(self.random, content, mutations.OF_TEXT))

    def without_section(self, content):
        """A section is missing, comes twice, is empty, or has another count."""
        sections = re.findall(rb"\$(\w+)\n.*?\$End\1\n", content, re.DOTALL)
        name = self.random.choice(sections)
        whole = re.search(rb"\$%s\n.*?\$End%s\n" % (name, name), content, re.DOTALL)
        empty = b"$%s\n$End%s\n" % (name, name)
        lines = whole[0].split(b"\n")
        other_count = b"\n".join([lines[0], b" ".join(self.random.choice(NUMBERS) for _ in lines[1].split()), *lines[2:]])
        without_end = b"\n".join(lines[:-2]) + b"\n"
        new = self.random.choice([b"", whole[0] * 2, empty, other_count, other_count, without_end])
        return content[:whole.start()] + new + content[whole.end():]

    # ----------------------------------------------------------------- scripts

    def script(self):
        content = self.random.choice(self.scripts)
        if self.random.random() < 0.5:
            lines = content.split(b"\n")
            for _ in range(self.random.choice([1, 1, 2])):
                lines.insert(self.random.randrange(len(lines) + 1), self.random.choice(STATEMENTS).encode())
            return self.geometry("case.geo", b"\n".join(lines))
        return self.geometry("case.geo", damaged(self.random, content, mutations.OF_TEXT))
