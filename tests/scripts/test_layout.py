"""The rooms of the code include only from their own row of the table in doc/structure.md or from rows above; who knows which library; names of
files that a unity build joins do not clash."""

import json
import pathlib
import re
import unittest

import internal_names

ROOT = pathlib.Path(__file__).resolve().parents[2]


def rooms():
    """Rooms in the order of the table."""
    table = (ROOT / "doc" / "structure.md").read_text(encoding="utf-8")
    return re.findall(r"^\| `(\w+)/` \|", table, flags=re.MULTILINE)


class Layout(unittest.TestCase):
    def test_every_room_is_in_the_table(self):
        for base in (ROOT / "source", ROOT / "include" / "squeal"):
            found = {path.name for path in base.iterdir() if path.is_dir() and any(path.iterdir())}
            self.assertEqual(found - set(rooms()), set())

    def test_includes_go_one_way(self):
        order = {room: row for row, room in enumerate(rooms())}
        n_includes = 0
        for base in (ROOT / "source", ROOT / "include" / "squeal"):
            for path in base.rglob("*/*.*"):
                room = path.relative_to(base).parts[0]
                for other in re.findall(r"#include <squeal/(\w+)/", path.read_text(encoding="utf-8")):
                    n_includes += 1
                    self.assertLessEqual(order[other], order[room], f"{path} includes from {other}/")
        self.assertGreater(n_includes, 100)

    def test_distributed_matrices_need_no_library(self):
        files = [path for base in ("source", "include", "tests") for path in (ROOT / base).rglob("*") if path.suffix in (".cc", ".h")]
        self.assertIn(ROOT / "source/linear_algebra/sparse_matrix.cc", files)
        self.assertEqual([str(path) for path in files if re.search("epetra", path.read_text(encoding="utf-8"), re.IGNORECASE)], [])

    def test_files_that_a_unity_build_joins_share_no_names(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        batch = max(int(preset.get("cacheVariables", {}).get("CMAKE_UNITY_BUILD_BATCH_SIZE", 0)) for preset in presets)
        self.assertGreater(batch, 1)
        # In the order of the build: a new file may shift what is joined
        files = [(str(path.relative_to(ROOT)), path.read_text(encoding="utf-8")) for path in sorted((ROOT / "source").rglob("*/*.cc"), key=str)
                 if path.parent.name != "mesher"]
        self.assertGreater(sum(len(internal_names.internal_declarations(text)) for _, text in files), 500)
        self.assertEqual(internal_names.clashes(files, batch - 1), [])


class InternalNames(unittest.TestCase):
    FIRST = """
namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;
    using Json   = nlohmann::json;

    /// A "text"; with { braces
    constexpr double small[] = {1e-3}; // and } more
    template <typename T, std::enable_if_t<(sizeof(T) > 1), int> = 0>
    T twice(const T &value, const int n = 2)
    {
      const double local = value;
      return local * n;
    }
    void say(const std::string &text) {}
    struct Row
    {
      double member;
    };
  } // namespace

  static void run() {}

  double shared(const Row &row)
  {
    return 1.;
  }
} // namespace Squeal
"""

    def clashes(self, *declarations, apart=0):
        other = "namespace\n{\n" + "\n".join(declarations) + "\n}"
        return internal_names.clashes([("a.cc", self.FIRST)] + [("", "")] * apart + [("b.cc", other)], 3)

    def test_names_are_found(self):
        names = [internal_names.named(declaration)[0] for declaration in internal_names.internal_declarations(self.FIRST)]
        self.assertEqual(names, ["fs", "Json", "small", "twice", "say", "Row", "run"])

    def test_clashes_are_told(self):
        for declaration, name in (("const int small = 3;", "small"), ("class Row {};", "Row"), ("using Json = nlohmann::ordered_json;", "Json"),
                                  ("template <class U> U twice(const U &, int n);", ""), ("int say(const std::string &other) { return 1; }", "say"),
                                  ("void run();", "run"), ("int fs;", "fs"), ('const Quantity say("text", 1.);', "say")):
            self.assertEqual(self.clashes(declaration), [f"{name} in a.cc and b.cc"] if name else [], declaration)
        self.assertEqual(self.clashes("class Row {};", apart=2), ["Row in a.cc and b.cc"])

    def test_what_may_come_again_is_let_pass(self):
        self.assertEqual(self.clashes("using Json = nlohmann::json;", "namespace fs = std::filesystem;", "using std::string;", "void say(int number) {}",
                                      "void shared(const Row &);", "template <> void run<int>();", "double member, local;"), [])
        self.assertEqual(self.clashes("class Row {};", apart=3), [])


if __name__ == "__main__":
    unittest.main()
