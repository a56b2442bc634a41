// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <squeal/base/exceptions.h>
#include <squeal/output/result_folder.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <ostream>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  using Names = std::vector<std::string>;

  class ResultFolders : public ::testing::Test
  {
  protected:
    /// Error message of the action; empty if it succeeds.
    static std::string refusal(const std::function<void()> &action)
    {
      try
        {
          action();
        }
      catch (const FileError &error)
        {
          return error.what();
        }
      return {};
    }
    static bool contains(const std::string &text, const std::string &word)
    {
      return text.find(word) != std::string::npos;
    }
    static void write(const ResultFolder &folder, const std::string &name, const std::string &text)
    {
      folder.write(name, [&](std::ostream &stream) { stream << text; });
    }
    /// Writes two result files and their record; returns the remarks.
    std::vector<std::string> make_results(const std::string &text) const
    {
      ResultFolder folder(results, true);
      write(folder, "table.csv", text);
      write(folder, "modes/" + text + ".vtu", text);
      const RunRecord record{"squeal", 1, 1, 1, {}, {}, {}, folder.files(), "abc"};
      folder.write(ResultFolder::run_record, [&](std::ostream &stream) { write_run_record(stream, record, Progress()); });
      return folder.commit();
    }
    Names files() const
    {
      return folder.files();
    }
    const TemporaryFolder folder;
    const fs::path        place   = folder.path;
    const std::string     results = (place / "results").string();
    const Names           first   = {"results/modes/one.vtu", "results/run.json", "results/table.csv"}; ///< files of make_results("one")
  };
} // namespace

TEST_F(ResultFolders, ListTheirFiles)
{
  make_results("one");
  EXPECT_EQ(files(), first);
  const auto list = read_file_list(results + "/run.json");
  ASSERT_TRUE(list);
  EXPECT_EQ(*list, (FileSizes{{"modes/one.vtu", 3}, {"table.csv", 3}}));
  put(place / "old.json", "{\"command\": \"squeal\"}");
  put(place / "cut.json", "{\"files [byte]\": {");
  for (const char *name : {"old.json", "cut.json", "missing.json"})
    EXPECT_FALSE(read_file_list(place / name));
}

TEST_F(ResultFolders, OfOthersAreNotTouched)
{
  put(results + "/thesis.tex", "years of work");
  for (const char *name : {"", "/", "/thesis.tex"})
    EXPECT_THROW(ResultFolder(results + name, true), FileError);
  EXPECT_EQ(content(results + "/thesis.tex"), "years of work");
  EXPECT_EQ(files(), (Names{"results/thesis.tex"}));
  // An empty folder is accepted
  fs::remove(results + "/thesis.tex");
  EXPECT_NO_THROW(make_results("new"));
}

TEST_F(ResultFolders, KeepFilesOfTheUser)
{
  make_results("one");
  put(results + "/notes.txt", "mine");
  put(results + "/modes/own.vtu", "mine too");
  fs::create_symlink("nowhere", results + "/link");
  EXPECT_TRUE(make_results("two").empty());
  EXPECT_EQ(files(), (Names{"results/link", "results/modes/own.vtu", "results/modes/two.vtu", "results/notes.txt", "results/run.json",
                            "results/table.csv"}));
  EXPECT_EQ(content(results + "/notes.txt"), "mine");
  EXPECT_EQ(content(results + "/table.csv"), "two");
  // A further run keeps the user's files as well
  make_results("three");
  EXPECT_EQ(content(results + "/modes/own.vtu"), "mine too");
}

TEST_F(ResultFolders, RenameFilesOfTheUserThatAreInTheWay)
{
  make_results("one");
  put(results + "/modes/two.vtu", "mine");
  put(results + "/modes/two.vtu.kept", "mine as well");
  const auto remarks = make_results("two");
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(contains(remarks[0], "`modes/two.vtu`")) << remarks[0];
  EXPECT_TRUE(contains(remarks[0], "`modes/two.vtu.kept-2`")) << remarks[0];
  EXPECT_EQ(content(results + "/modes/two.vtu"), "two");
  EXPECT_EQ(content(results + "/modes/two.vtu.kept"), "mine as well");
  EXPECT_EQ(content(results + "/modes/two.vtu.kept-2"), "mine");
  // A folder of the user with the name of a result file is renamed as well
  fs::remove(results + "/table.csv");
  put(results + "/table.csv/a", "a");
  EXPECT_EQ(make_results("two").size(), 1u);
  EXPECT_EQ(content(results + "/table.csv"), "two");
  EXPECT_EQ(content(results + "/table.csv.kept/a"), "a");
}

TEST_F(ResultFolders, AreForOneRunAtATime)
{
  const ResultFolder running(results, true);
  fs::create_symlink("results", place / "link");
  for (const std::string &name : {results, results + "/", (place / "link").string()})
    EXPECT_TRUE(contains(refusal([&] { ResultFolder(name, true); }), "another run")) << name;
  // The first run is not affected
  write(running, "table.csv", "here");
  EXPECT_EQ(content(results + "/.unfinished/table.csv"), "here");
}

TEST_F(ResultFolders, OtherProcessesTouchNothing)
{
  {
    ResultFolder other(results, false);
    write(other, "table.csv", "not mine to write");
    other.commit();
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(ResultFolders, TakeWhatOnlyAnUnfinishedRunNeedsWithThem)
{
  bool         done = false;
  ResultFolder running(results, true);
  write(running, ResultFolder::run_record, "{}");
  running.commit([&] { done = fs::exists(results + "/run.json"); });
  EXPECT_TRUE(done);
}

TEST_F(ResultFolders, LeaveFormerOnesWhereARunFails)
{
  {
    const ResultFolder running(results, true);
    write(running, "modes/one.txt", "half");
  }
  EXPECT_FALSE(fs::exists(results)) << "a failed run must not create results";

  make_results("one");
  const auto lose = [&](const std::string &name, const std::function<void()> &loss) {
    ResultFolder running(results, true);
    write(running, "table.csv", "two");
    write(running, ResultFolder::run_record, "{}");
    loss();
    EXPECT_TRUE(contains(refusal([&] { running.commit(); }), "results/" + name));
  };
  lose("table.csv", [&] { fs::resize_file(results + "/.unfinished/table.csv", 2); });
  lose("table.csv", [&] { fs::remove(results + "/.unfinished/table.csv"); });
  lose("run.json", [&] { fs::remove_all(results + "/.unfinished"); });
  EXPECT_EQ(files(), first);
  EXPECT_EQ(content(results + "/table.csv"), "one");

  {
    const ResultFolder running(results, true);
    write(running, "matrices", "a file where a folder is needed");
    const std::string message = refusal([&] { write(running, "matrices/K.mtx", "1"); });
    EXPECT_TRUE(contains(message, "file " + results + "/matrices/K.mtx")) << message;
    // Files that could not be written are not listed
    EXPECT_TRUE(contains(refusal([&] { running.write("mesh.msh", [](std::ostream &s) { s.setstate(std::ios::badbit); }); }), "mesh.msh"));
    EXPECT_THROW(running.write("table.csv", [](std::ostream &) { throw FileError("a number is not finite", "column", "report"); }),
                 FileError);
    EXPECT_EQ(running.files(), (FileSizes{{"matrices", 31}}));
  }
  EXPECT_EQ(files(), first);
  EXPECT_EQ(content(results + "/table.csv"), "one");
}

TEST_F(ResultFolders, SettleWhatAKilledRunHasLeft)
{
  put(results + "/.unfinished/half", "half");
  make_results("one");
  // If a run is killed while it moves files, there is no record, because it would list files of two runs
  put(results + "/.unfinished/half", "half");
  fs::remove(results + "/run.json");
  make_results("two");
  EXPECT_EQ(content(results + "/table.csv"), "two");
  EXPECT_TRUE(fs::exists(results + "/run.json"));
  EXPECT_FALSE(fs::exists(results + "/.unfinished"));
}

TEST_F(ResultFolders, FollowLinks)
{
  fs::create_directories(place / "deep" / "target");
  fs::create_symlink("deep/target", place / "link");
  fs::create_symlink("link", results);
  make_results("one");
  make_results("two");
  EXPECT_EQ(files(), (Names{"deep/target/modes/two.vtu", "deep/target/run.json", "deep/target/table.csv", "link", "results"}));
}

TEST(RunRecords, AreJson)
{
  Progress progress;
  progress.begin("Mesh \"quoted\" \\ \n and more");
  progress.finish("12 elements");
  const RunRecord record{"squeal \"a b.prm\"", 3, 2, 1, {{"dofs", 123456789012L}}, {{"worst scaled Jacobian [-]", 0.5}}, {}, {}, "abc1234"};
  std::ostringstream stream;
  write_run_record(stream, record, progress);

  const auto tree = nlohmann::json::parse(stream.str());
  EXPECT_EQ(tree.at("command"), record.command);
  EXPECT_EQ(tree.at("counts").at("dofs"), 123456789012L);
  EXPECT_EQ(tree.at("quantities").at("worst scaled Jacobian [-]"), 0.5);
  EXPECT_EQ(tree.at("machine").at("processes"), 3);
  EXPECT_EQ(tree.at("machine").at("threads per process"), 2);
  EXPECT_EQ(tree.at("steps").at(0).at("name"), "Mesh \"quoted\" \\ \n and more");
  EXPECT_EQ(tree.at("steps").at(0).at("result"), "12 elements");
  EXPECT_GT(tree.at("steps").at(0).at("peak memory so far [byte]"), 0.);
  EXPECT_GE(tree.at("wall time [s]"), 0.);
  for (const char *library : {"squeal", "revision", "deal.II", "Trilinos", "MUMPS", "CHOLMOD", "UMFPACK", "Gmsh"})
    EXPECT_FALSE(tree.at("versions").at(library).get<std::string>().empty()) << library;
}
