#include "files.h"

#include <squeal/base/exceptions.h>
#include <squeal/output/result_folder.h>
#include <squeal/output/run_record.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  void put(const fs::path &file, const std::string &text)
  {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  /// What is said when something is refused; empty: nothing is.
  std::string refusal(const std::function<void()> &action)
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

  bool contains(const std::string &text, const std::string &word)
  {
    return text.find(word) != std::string::npos;
  }

  /// An empty folder of its own that is removed at the end.
  class SafeFolders : public ::testing::Test
  {
  protected:
    SafeFolders()
      : place(fs::temp_directory_path() / ("squeal_safe_test_" + std::to_string(getpid())))
      , results((place / "results").string())
    {
      fs::create_directories(place);
    }
    ~SafeFolders() override
    {
      fs::remove_all(place);
    }
    /// Leaves a result of two files and its record; returns what is to be said.
    std::vector<std::string> make_results(const std::string &text) const
    {
      ResultFolder folder(results, true, "squeal first.prm");
      folder.write("table.csv", [&](std::ostream &stream) { stream << text; });
      folder.write("modes/" + text + ".vtu", [&](std::ostream &stream) { stream << text; });
      write_record(folder);
      return folder.commit();
    }
    static void write_record(const ResultFolder &folder)
    {
      RunRecord record{"squeal", 1, 1, 1, {}, {}, {}, folder.files(), "abc"};
      folder.write(ResultFolder::run_record, [&](std::ostream &stream) { write_run_record(stream, record, Progress()); });
    }
    /// Everything below the folder, links as such.
    std::vector<std::string> files() const
    {
      std::vector<std::string> names;
      for (const auto &entry : fs::recursive_directory_iterator(place))
        if (!fs::is_directory(entry.symlink_status()))
          names.push_back(entry.path().lexically_relative(place).string());
      std::sort(names.begin(), names.end());
      return names;
    }
    const fs::path    place;
    const std::string results;
  };

  using Names = std::vector<std::string>;
} // namespace

TEST_F(SafeFolders, ListTheirFiles)
{
  make_results("one");
  const auto list = read_file_list(results + "/run.json");
  ASSERT_TRUE(list);
  EXPECT_EQ(*list, (FileSizes{{"modes/one.vtu", 3}, {"table.csv", 3}}));
  put(place / "old.json", "{\"command\": \"squeal\"}");
  EXPECT_FALSE(read_file_list(place / "old.json"));
  put(place / "cut.json", "{\"files [byte]\": {");
  EXPECT_FALSE(read_file_list(place / "cut.json"));
  EXPECT_FALSE(read_file_list(place / "missing.json"));
}

TEST_F(SafeFolders, KeepFilesOfTheUser)
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
  // They stay files of the user in the next run, too.
  make_results("three");
  EXPECT_EQ(content(results + "/modes/own.vtu"), "mine too");
}

TEST_F(SafeFolders, RenameFilesOfTheUserThatAreInTheWay)
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
  // A folder of the user where the results have a file
  put(results + "/table.csv.d/a", "a");
  fs::remove(results + "/table.csv");
  fs::rename(results + "/table.csv.d", results + "/table.csv");
  put(results + "/table.csv/b", "b");
  EXPECT_EQ(make_results("two").size(), 1u);
  EXPECT_EQ(content(results + "/table.csv"), "two");
  EXPECT_EQ(content(results + "/table.csv.kept/a"), "a");
  EXPECT_EQ(content(results + "/table.csv.kept/b"), "b");
}

TEST_F(SafeFolders, AreForOneRunAtATime)
{
  const ResultFolder folder(results, true, "squeal first.prm");
  const std::string  message = refusal([&] { ResultFolder(results + "/", true, "squeal second.prm"); });
  EXPECT_TRUE(contains(message, "another run")) << message;
  EXPECT_TRUE(contains(message, "process " + std::to_string(getpid()))) << message;
  EXPECT_TRUE(contains(message, "`squeal first.prm`")) << message;
  fs::create_symlink("results", place / "link");
  EXPECT_TRUE(contains(refusal([&] { ResultFolder((place / "link").string(), true); }), "another run"));
  // The first one goes on undisturbed.
  folder.write("table.csv", [](std::ostream &stream) { stream << "here"; });
  EXPECT_EQ(content(results + "/.unfinished/table.csv"), "here");
}

TEST_F(SafeFolders, TakeWhatOnlyAnUnfinishedRunNeedsWithThem)
{
  const fs::path checkpoint = results + ".checkpoint";
  put(checkpoint / "sweep.key", "so far");
  ResultFolder folder(results, true);
  folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
  folder.commit([&] {
    EXPECT_TRUE(fs::exists(results + "/run.json"));
    fs::remove_all(checkpoint);
  });
  EXPECT_FALSE(fs::exists(checkpoint));
}

TEST_F(SafeFolders, AreNotLeftWhereFilesAreMissing)
{
  make_results("one");
  for (const bool is_cut : {false, true})
    {
      ResultFolder folder(results, true);
      folder.write("table.csv", [](std::ostream &stream) { stream << "two"; });
      folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
      if (is_cut)
        fs::resize_file(results + "/.unfinished/table.csv", 2);
      else
        fs::remove(results + "/.unfinished/table.csv");
      EXPECT_TRUE(contains(refusal([&] { folder.commit(); }), "results/table.csv"));
    }
  EXPECT_EQ(files(), (Names{"results/modes/one.vtu", "results/run.json", "results/table.csv"}));
  EXPECT_EQ(content(results + "/table.csv"), "one");
}

TEST_F(SafeFolders, DoNotReplaceOthersWhereTheyVanish)
{
  make_results("one");
  {
    ResultFolder folder(results, true);
    folder.write("table.csv", [](std::ostream &stream) { stream << "two"; });
    fs::remove_all(results + "/.unfinished");
    EXPECT_TRUE(contains(refusal([&] { folder.commit(); }), "results/table.csv"));
  }
  EXPECT_EQ(files(), (Names{"results/modes/one.vtu", "results/run.json", "results/table.csv"}));
}

TEST_F(SafeFolders, NameTheFileThatCannotBeWrittenAndLeaveNothing)
{
  make_results("one");
  const Names before = files();
  {
    ResultFolder folder(results, true);
    folder.write("matrices", [](std::ostream &stream) { stream << "a file where a folder is needed"; });
    const std::string message = refusal([&] { folder.write("matrices/K.mtx", [](std::ostream &stream) { stream << "1"; }); });
    EXPECT_TRUE(contains(message, "the file cannot be written: Not a directory")) << message;
    EXPECT_TRUE(contains(message, "file " + results + "/matrices/K.mtx")) << message;
    // What failed is not promised, and what could not be put together is not written.
    EXPECT_TRUE(contains(refusal([&] { folder.write("mesh.msh", [](std::ostream &s) { s.setstate(std::ios::badbit); }); }), "mesh.msh"));
    EXPECT_THROW(folder.write("table.csv", [](std::ostream &) { throw FileError("a number is not finite", "column", "report"); }),
                 FileError);
    EXPECT_EQ(folder.files(), (FileSizes{{"matrices", 31}}));
  }
  EXPECT_EQ(files(), before);
  EXPECT_EQ(content(results + "/table.csv"), "one");
}

TEST_F(SafeFolders, SettleWhatAKilledRunHasLeft)
{
  const auto leave = [&] {
    put(results + "/.lock", "process 1 on a host");
    put(results + "/.unfinished/half", "half");
  };
  leave();
  make_results("one");
  leave();
  EXPECT_TRUE(ResultFolder(results, true).files().empty());
  EXPECT_EQ(content(results + "/table.csv"), "one");
  // Killed while files were moved: there is no record that would list files of two runs.
  leave();
  fs::remove(results + "/run.json");
  make_results("two");
  EXPECT_EQ(content(results + "/table.csv"), "two");
  EXPECT_TRUE(fs::exists(results + "/run.json"));
  EXPECT_FALSE(fs::exists(results + "/.unfinished") || fs::exists(results + "/.lock"));
}

TEST_F(SafeFolders, FollowLinks)
{
  fs::create_directories(place / "deep" / "target");
  fs::create_symlink("deep/target", place / "link");
  fs::create_symlink("link", results);
  make_results("one");
  make_results("two");
  EXPECT_EQ(files(), (Names{"deep/target/modes/two.vtu", "deep/target/run.json", "deep/target/table.csv", "link", "results"}));
}
