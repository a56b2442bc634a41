#include "scenes.h"

#include <squeal/base/exceptions.h>
#include <squeal/output/fields.h>
#include <squeal/output/result_folder.h>
#include <squeal/output/run_record.h>
#include <squeal/output/table.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

using namespace Squeal;
namespace fs = std::filesystem;

namespace
{
  std::string csv(const Table &table)
  {
    std::ostringstream stream;
    table.write_csv(stream);
    return stream.str();
  }

  std::string content(const fs::path &file)
  {
    std::ifstream     stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  /// An empty folder of its own that is removed at the end.
  class ResultFolders : public ::testing::Test
  {
  protected:
    ResultFolders()
      : place(fs::temp_directory_path() / ("squeal_output_test_" + std::to_string(getpid())))
      , results((place / "deep" / "results").string())
    {
      fs::create_directories(place);
    }
    ~ResultFolders() override
    {
      fs::remove_all(place);
    }
    /// What lies beside and in the results.
    std::vector<std::string> files() const
    {
      std::vector<std::string> names;
      for (const auto &entry : fs::recursive_directory_iterator(place))
        if (!entry.is_directory())
          names.push_back(entry.path().lexically_relative(place).string());
      std::sort(names.begin(), names.end());
      return names;
    }
    void make_results(const std::string &text) const
    {
      ResultFolder folder(results, true);
      folder.write("table.csv", [&](std::ostream &stream) { stream << text; });
      folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
      folder.commit();
    }
    const fs::path    place;
    const std::string results;
  };
} // namespace

TEST(Tables, TwelveDigitsAndUnitsOnDisk)
{
  struct Row
  {
    std::string           label;
    double                frequency, share;
    int                   number;
    std::optional<double> rest;
  };
  const Table table(Columns<Row>{{"label", "", &Row::label},
                                 {"frequency", "Hz", &Row::frequency, 2},
                                 {"share", "-", [](const Row &row) { return row.share; }},
                                 {"number", "-", &Row::number},
                                 {"rest", "1/s", &Row::rest, 1, true}},
                    std::vector<Row>{{"A0-2 -", 1000. / 3., 1e-20, 42, {}}, {"a,\"b\"", -0., 2.5, -1, 1.}});
  EXPECT_EQ(csv(table), "label,frequency [Hz],share [-],number [-],rest [1/s]\n"
                        "A0-2 -,333.333333333,1e-20,42,\n"
                        "\"a,\"\"b\"\"\",0,2.5,-1,1\n");

  // On the screen: as many lines, all of one width
  std::ostringstream screen;
  table.print(screen);
  std::istringstream       lines(screen.str());
  std::string              line;
  std::vector<std::size_t> widths;
  while (std::getline(lines, line))
    widths.push_back(line.size());
  ASSERT_EQ(widths.size(), 3u);
  EXPECT_EQ(widths[0], widths[1]);
  EXPECT_EQ(widths[1], widths[2]);
  EXPECT_NE(screen.str().find("333.33 "), std::string::npos) << screen.str();
  EXPECT_EQ(screen.str().find("-0.00"), std::string::npos) << screen.str();
}

TEST(Tables, RefuseWhatIsNotANumber)
{
  const Columns<double> columns = {{"label", "", [](double) { return "A0-2"; }},
                                   {"growth rate", "1/s", [](const double rate) { return rate; }}};
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    try
      {
        Table(columns, std::vector<double>{1., value});
        FAIL() << "accepted " << value;
      }
    catch (const Error &error)
      {
        EXPECT_NE(std::string(error.what()).find("growth rate [1/s]"), std::string::npos) << error.what();
      }
}

TEST_F(ResultFolders, NothingRemainsOfAFailedRun)
{
  {
    ResultFolder folder(results, true);
    folder.write("modes/one.txt", [](std::ostream &stream) { stream << "half"; });
    EXPECT_FALSE(fs::exists(results));
  }
  EXPECT_TRUE(files().empty());
  EXPECT_FALSE(fs::exists(results));
  EXPECT_FALSE(fs::exists(results + ".unfinished"));
}

TEST_F(ResultFolders, EarlierResultsStayUntilTheEnd)
{
  make_results("first");
  EXPECT_EQ(files(), (std::vector<std::string>{"deep/results/run.json", "deep/results/table.csv"}));

  // A run that fails leaves them
  {
    ResultFolder folder(results, true);
    folder.write("table.csv", [](std::ostream &stream) { stream << "failed"; });
  }
  EXPECT_EQ(content(fs::path(results) / "table.csv"), "first");

  // One that is complete replaces them altogether
  {
    ResultFolder folder(results, true);
    folder.write("other/other.csv", [](std::ostream &stream) { stream << "second"; });
    folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
    EXPECT_EQ(content(fs::path(results) / "table.csv"), "first");
    folder.commit();
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"deep/results/other/other.csv", "deep/results/run.json"}));
}

TEST_F(ResultFolders, ForeignFoldersAreNeverReplaced)
{
  fs::create_directories(results);
  std::ofstream(fs::path(results) / "thesis.tex") << "years of work";
  EXPECT_THROW(ResultFolder(results, true), FileError);
  EXPECT_THROW(ResultFolder(results + "/", true), FileError);
  EXPECT_EQ(content(fs::path(results) / "thesis.tex"), "years of work");
  // Nor a file of that name
  EXPECT_THROW(ResultFolder(results + "/thesis.tex", true), FileError);
  EXPECT_EQ(files(), (std::vector<std::string>{"deep/results/thesis.tex"}));
  // An empty folder is as good as none.
  fs::remove(fs::path(results) / "thesis.tex");
  EXPECT_NO_THROW(make_results("new"));
  EXPECT_EQ(content(fs::path(results) / "table.csv"), "new");
}

TEST_F(ResultFolders, OtherProcessesTouchNothing)
{
  {
    ResultFolder folder(results, false);
    folder.write("table.csv", [](std::ostream &stream) { stream << "not mine to write"; });
    folder.commit();
  }
  EXPECT_TRUE(files().empty());
}

TEST(RunRecords, AreJson)
{
  Progress progress;
  progress.begin("Mesh \"quoted\" \\ \n and more");
  progress.finish("12 elements");
  progress.begin("Modes");
  progress.finish();
  const RunRecord    record{"squeal \"a b.prm\" --set \"Operation/Rotation=negative\"",
                         3,
                         1,
                         {{"dofs", 123456789012L}, {"modes", 0}},
                         {{"worst scaled Jacobian [-]", 0.5}},
                         {},
                         {},
                         "abc1234"};
  std::ostringstream stream;
  write_run_record(stream, record, progress);

  const auto tree = nlohmann::json::parse(stream.str());
  EXPECT_EQ(tree.at("command"), record.command);
  EXPECT_EQ(tree.at("counts").at("dofs"), 123456789012L);
  EXPECT_EQ(tree.at("counts").at("modes"), 0);
  EXPECT_EQ(tree.at("quantities").at("worst scaled Jacobian [-]"), 0.5);
  EXPECT_EQ(tree.at("machine").at("processes"), 3);
  ASSERT_EQ(tree.at("steps").size(), 2u);
  EXPECT_EQ(tree.at("steps")[0].at("name"), "Mesh \"quoted\" \\ \n and more");
  EXPECT_EQ(tree.at("steps")[0].at("result"), "12 elements");
  EXPECT_GT(tree.at("steps")[1].at("peak memory so far [byte]"), 0.);
  EXPECT_GE(tree.at("wall time [s]"), 0.);
  for (const char *library : {"squeal", "revision", "deal.II", "Trilinos", "MUMPS", "CHOLMOD", "UMFPACK", "Gmsh"})
    EXPECT_FALSE(tree.at("versions").at(library).get<std::string>().empty()) << library;
}

TEST_F(ResultFolders, ModeShapesAndAnimations)
{
  using namespace Squeal::Testing;
  for (const unsigned int degree : {1u, 2u})
    {
      const Scene  s(extrude(polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 2, 0, 1}}), layers(1, 1)), mounted(), operating(), degree);
      ResultFolder folder(results, true);
      const FieldWriter writer(s.model, s.interface, {}, folder);
      ModeField         mode{"complex_001_A0-2", {1., 1000.}, {}, {}};
      for (int i = 0; i < s.model.free_map().n(); ++i)
        mode.displacement.emplace_back(std::cos(i), std::sin(i));
      mode.reactions.assign(s.interface.size(), {-1., 2.});
      writer.write_mode(mode);
      writer.write_animation(mode, 4);
      folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
      folder.commit();

      const std::string body    = content(results + "/modes/complex_001_A0-2.vtu"),
                        contact = content(results + "/modes/complex_001_A0-2_contact.vtu");
      for (const char *field : {"displacement_real", "displacement_imag", "amplitude", "phase", "component"})
        EXPECT_NE(body.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
      for (const char *field : {"normal_reaction_real", "normal_reaction_imag", "closed"})
        EXPECT_NE(contact.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;

      // The animation covers one period 2π/ω with equal steps, and its pictures exist where it says.
      const std::string pvd      = content(results + "/animations/complex_001_A0-2.pvd");
      int               n_frames = 0;
      for (auto at = pvd.find("timestep=\""); at != std::string::npos; at = pvd.find("timestep=\"", at + 1), ++n_frames)
        {
          EXPECT_NEAR(std::stod(pvd.substr(at + 10)), 2. * M_PI / 1000. * n_frames / 4., 1e-6);
          const auto file = pvd.find("file=\"", at) + 6;
          EXPECT_TRUE(fs::exists(results + "/animations/" + pvd.substr(file, pvd.find('"', file) - file)));
        }
      EXPECT_EQ(n_frames, 4);
    }
}
