#include "files.h"
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
#include <map>
#include <sstream>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  std::string csv(const Table &table)
  {
    std::ostringstream stream;
    table.write_csv(stream);
    return stream.str();
  }

  /// What a field file holds, without the date at its top.
  std::string pieces(const fs::path &file)
  {
    const std::string text = content(file);
    return text.substr(std::min(text.find("<Piece"), text.size()));
  }

  /// Times of a .pvd with the files that it lists.
  std::vector<std::pair<double, std::string>> listed(const fs::path &file)
  {
    std::vector<std::pair<double, std::string>> result;
    const std::string                           pvd = content(file);
    for (auto at = pvd.find("timestep=\""); at != std::string::npos; at = pvd.find("timestep=\"", at + 1))
      {
        const auto name = pvd.find("file=\"", at) + 6;
        result.emplace_back(std::stod(pvd.substr(at + 10)), pvd.substr(name, pvd.find('"', name) - name));
      }
    return result;
  }

  /// A disc of 24 cells with one pin.
  struct DiscWithPin : Scene
  {
    explicit DiscWithPin(const Element element)
      : Scene(extrude(polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 2, 0, 1}}), layers(1, 1)), mounted(), operating(), element)
    {}
    ModeField mode(const std::complex<double> &lambda) const
    {
      ModeField result{"complex_001_A0-2", lambda, {}, {}, "A0-2, 160 Hz"};
      for (int i = 0; i < model.free_map().n(); ++i)
        result.displacement.emplace_back(std::cos(i), std::sin(i));
      result.reactions.assign(interface.size(), {-1., 2.});
      return result;
    }
  };

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
      folder.write(ResultFolder::run_record,
                   [&](std::ostream &stream) { stream << R"({"files [byte]": {"table.csv": )" << text.size() << "}}"; });
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
  }
  EXPECT_TRUE(files().empty());
  EXPECT_FALSE(fs::exists(results));
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

  // One that is complete replaces all files of the former one
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
                         2,
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
  EXPECT_EQ(tree.at("machine").at("threads per process"), 2);
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
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const DiscWithPin s(element);
      ResultFolder      folder(results, true);
      FieldWriter       writer(s.model, s.interface, {}, folder);
      const ModeField   mode = s.mode({1., 1000.});
      writer.write_mode(mode);
      writer.write_animation(mode, {4});
      folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
      folder.commit();

      const std::string body    = content(results + "/modes/complex_001_A0-2.vtu"),
                        contact = content(results + "/modes/complex_001_A0-2_contact.vtu");
      for (const char *field : {"displacement_real", "displacement_imag", "amplitude", "phase", "component", "points"})
        EXPECT_NE(body.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
      for (const char *field : {"normal_reaction_real", "normal_reaction_imag", "closed", "mode"})
        EXPECT_NE(contact.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
      // The title as codes of its characters
      EXPECT_NE(body.find("Name=\"mode\""), std::string::npos);
      EXPECT_NE(body.find("\n65 48 45 50 44 32 49 54 48 32 72 122 0\n"), std::string::npos) << body.substr(0, 600);

      // The animation covers one period 2π/ω with equal steps, and its pictures exist where it says.
      const auto frames = listed(results + "/animations/complex_001_A0-2.pvd");
      ASSERT_EQ(frames.size(), 4u);
      for (std::size_t frame = 0; frame < frames.size(); ++frame)
        {
          EXPECT_NEAR(frames[frame].first, 2. * M_PI / 1000. * frame / 4., 1e-12);
          EXPECT_TRUE(fs::exists(results + "/animations/" + frames[frame].second));
        }
    }
}

TEST_F(ResultFolders, AnimationsWithGrowthAreLargestWhereTheModeIs)
{
  const DiscWithPin                  s(Element::trilinear);
  const double                       period = 2. * M_PI / 1000.;
  std::map<std::string, std::string> first, last;
  for (const auto &[name, lambda] : {std::make_pair("grows", std::complex<double>(50., 1000.)), {"decays", {-50., 1000.}}})
    for (const bool grows : {false, true})
      {
        ResultFolder folder(results, true);
        FieldWriter  writer(s.model, s.interface, {}, folder);
        writer.write_animation(s.mode(lambda), {4, 3, grows});
        folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
        folder.commit();

        // With growth the last picture is that of the end; without it that would be the first one again
        const auto frames = listed(results + "/animations/complex_001_A0-2.pvd");
        ASSERT_EQ(frames.size(), grows ? 13u : 12u) << name;
        EXPECT_EQ(frames.front().first, 0.);
        EXPECT_NEAR(frames.back().first, (frames.size() - 1) * period / 4., 1e-12);
        const std::string key = grows ? name : "neither";
        first[key]            = pieces(results + "/animations/" + frames.front().second);
        last[key]             = pieces(results + "/animations/" + frames.back().second);
      }
  // The largest amplitude is that without growth
  EXPECT_EQ(first["decays"], first["neither"]);
  EXPECT_EQ(last["grows"], first["neither"]);
  EXPECT_NE(first["grows"], first["neither"]);
  EXPECT_NE(last["decays"], first["neither"]);
}

TEST_F(ResultFolders, RealModesOfAllBodiesAndOfOne)
{
  const DiscWithPin         s(Element::trilinear);
  ResultFolder              folder(results, true);
  FieldWriter               writer(s.model, s.interface, {}, folder);
  const std::vector<double> displacement(s.model.free_map().n(), -3.);
  writer.write_mode({"real", "real mode A0-2", displacement, {}});
  writer.write_mode({"disc", "free disc A0-2", displacement, Component::disc});
  writer.write_mode({"pins", "free pins F1", displacement, Component::pins});
  folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
  folder.commit();

  const auto n_cells = [&](const std::string &name) {
    const std::string text = content(results + "/modes/" + name + ".vtu"), key = "NumberOfCells=\"";
    for (const char *field : {"displacement", "amplitude", "component"})
      EXPECT_NE(text.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
    return std::stoi(text.substr(text.find(key) + key.size()));
  };
  EXPECT_EQ(n_cells("disc"), 24);
  EXPECT_EQ(n_cells("pins"), static_cast<int>(s.model.triangulation().n_active_cells()) - 24);
  EXPECT_EQ(n_cells("real"), static_cast<int>(s.model.triangulation().n_active_cells()));
}

TEST_F(ResultFolders, ListsOfModesHaveATimeForEach)
{
  const DiscWithPin s(Element::trilinear);
  ResultFolder      folder(results, true);
  FieldWriter       writer(s.model, s.interface, {}, folder);
  // Rigid-body modes, doublets equal to rounding, and one that is farther away
  const std::vector<double> frequencies = {0., 0., 500., 500., 500. * (1. + 1e-14), 500.1, 4999.};
  std::vector<ListedMode>   modes;
  for (const double frequency : frequencies)
    modes.push_back({"mode_" + std::to_string(modes.size()), frequency});
  writer.write_list("modes", modes);
  folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
  folder.commit();

  const auto list = listed(results + "/modes.pvd");
  ASSERT_EQ(list.size(), frequencies.size());
  for (std::size_t j = 0; j < list.size(); ++j)
    {
      EXPECT_EQ(list[j].second, "modes/" + modes[j].name + ".vtu");
      EXPECT_NEAR(list[j].first, frequencies[j], 3e-6 * frequencies[j] + 1e-3) << j;
      EXPECT_TRUE(j == 0 || list[j].first > list[j - 1].first) << j;
    }
}
