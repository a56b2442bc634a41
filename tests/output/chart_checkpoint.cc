#include "files.h"
#include "solutions.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/output/result_folder.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  constexpr int n_rows = 23;

  const std::string header = "line [-],mu [-],frequency [Hz],growth rate [1/s],divergence rate [%],estimated error of lambda [-]\n";
  const std::string key    = "# squeal 1\nsubsection Operation\n  set Load = 300\nend\n";

  const double band = circular_frequency(1000.);

  template <typename T>
  bool same_bits(const std::vector<T> &a, const std::vector<T> &b)
  {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
  }

  template <typename Number>
  bool same_bits(const Eigen::MatrixX<Number> &a, const Eigen::MatrixX<Number> &b)
  {
    return a.rows() == b.rows() && a.cols() == b.cols() && std::memcmp(a.data(), b.data(), sizeof(Number) * a.size()) == 0;
  }

  bool same_bits(const ChartPoint &a, const ChartPoint &b)
  {
    return std::memcmp(&a.friction_coefficient, &b.friction_coefficient, sizeof(double)) == 0 && same_bits(a.lambda, b.lambda) &&
           same_bits(a.right, b.right) && same_bits(a.left, b.left) && same_bits(a.right_residuals, b.right_residuals) &&
           same_bits(a.left_residuals, b.left_residuals) && same_bits(a.errors, b.errors) && same_bits(a.uncertainties, b.uncertainties) &&
           a.verdicts == b.verdicts && same_bits(a.corrections, b.corrections) && same_bits(a.real_values, b.real_values) &&
           a.n_zeros == b.n_zeros;
  }

  /// Three modes, the last beyond the band, with numbers that no short text tells.
  ChartPoint result_at(const double friction)
  {
    ChartPoint point;
    point.friction_coefficient = friction;
    for (int j = 0; j < 3; ++j)
      point.lambda.emplace_back(j == 1 ? 10. : -1. / 3. - friction, circular_frequency(400. * (j + 1)));
    for (ComplexDenseMatrix *matrix : {&point.right, &point.left, &point.corrections})
      {
        *matrix = ComplexDenseMatrix(matrix == &point.corrections ? 3 : 7, 3);
        for (int j = 0; j < matrix->cols(); ++j)
          for (int i = 0; i < matrix->rows(); ++i)
            (*matrix)(i, j) = {std::sin(1. + i + 10. * j + friction),
                               matrix == &point.left ? -0. : std::numeric_limits<double>::denorm_min()};
      }
    point.right_residuals = {1e-9 / 3., 2e-9, 3e-9};
    point.left_residuals  = {1e-7 / 3., 2e-7, 3e-7};
    point.errors          = {1e-7, 2e-7, std::numeric_limits<double>::infinity()};
    point.uncertainties   = {0.1, 0.2, 0.3};
    point.verdicts        = {Verdict::stable, Verdict::unstable, Verdict::undecided};
    point.real_values     = {-1. / 7.};
    point.n_zeros         = 2;
    return point;
  }

  /// The rows of result_at() in points.csv.
  std::string csv_of(const int line, const double friction)
  {
    std::ostringstream text;
    text.precision(12);
    for (int j = 0; j < 2; ++j)
      {
        const ModalQuantities mode = modal_quantities(result_at(friction).lambda[j]);
        text << line << ',' << friction << ',' << mode.frequency << ',' << mode.growth_rate << ',' << 100. * mode.divergence_rate << ','
             << (j == 0 ? "1e-07" : "2e-07") << '\n';
      }
    return text.str();
  }

  OperatingPoint at(const double friction, const int line = 0)
  {
    return {friction, {}, line};
  }

  /// The rows dealt out to the processes as cards are, in descending order: unlike an even distribution even on one process.
  RowMap dealt_rows()
  {
    const RowMap     even = RowMap::even(n_rows, MPI_COMM_WORLD);
    std::vector<int> mine;
    for (int i = n_rows - 1; i >= 0; --i)
      if (i % even.n_processes() == even.rank())
        mine.push_back(i);
    return RowMap::of(mine, MPI_COMM_WORLD);
  }

  /// Lets no file grow beyond a size [byte]: like a full disk.
  class SizeLimit
  {
  public:
    explicit SizeLimit(const std::uintmax_t size)
    {
      getrlimit(RLIMIT_FSIZE, &former);
      const rlimit limit{size, former.rlim_max};
      setrlimit(RLIMIT_FSIZE, &limit);
      former_action = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~SizeLimit()
    {
      setrlimit(RLIMIT_FSIZE, &former);
      std::signal(SIGXFSZ, former_action);
    }

  private:
    rlimit former;
    void (*former_action)(int);
  };

  /// A folder that all processes share, removed at the end.
  class ChartCheckpoints : public ::testing::Test
  {
  protected:
    ChartCheckpoints()
      : rows(RowMap::even(n_rows, MPI_COMM_WORLD))
      , place(
          fs::temp_directory_path() /
          ("squeal_checkpoint_test_" + std::to_string(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()), 0))))
      , folder((place / "deep" / "results.checkpoint").string())
    {
      alone([&] { fs::create_directories(place); });
    }
    ~ChartCheckpoints() override
    {
      alone([&] { fs::remove_all(place); });
    }

    /// What one process does while the others wait.
    template <typename Function>
    void alone(const Function &action) const
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (rows.rank() == 0)
        action();
      MPI_Barrier(MPI_COMM_WORLD);
    }

    ChartCheckpoint checkpoint(const std::string &with_key = key) const
    {
      return ChartCheckpoint(folder, with_key, MPI_COMM_WORLD, band);
    }

    /// Size of the archive.
    std::uintmax_t size() const
    {
      return fs::file_size(archive);
    }

    /// Two blocks and two results on the first, one on both. Returns where title and records end, on process 0.
    std::vector<std::uintmax_t> keep_some() const
    {
      ChartCheckpoint             kept  = checkpoint();
      const auto                  store = kept.part("sweep", rows);
      std::vector<std::uintmax_t> ends;
      const auto                  note_end = [&] { alone([&] { ends.push_back(size()); }); };
      store->keep(random_vectors(rows, 4, 1));
      alone([&] { ends.push_back(content(archive).find('\0') + 1); });
      note_end();
      store->keep(at(0.1), result_at(0.1));
      note_end();
      store->keep(at(1. / 3., 1), result_at(1. / 3.));
      note_end();
      store->keep(random_vectors(rows, 2, 2));
      note_end();
      store->keep(at(0.2), result_at(0.2));
      note_end();
      return ends;
    }

    /// Changes one bit of the archive.
    void damage(const std::uintmax_t place) const
    {
      std::fstream stream(archive, std::ios::in | std::ios::out | std::ios::binary);
      stream.seekg(static_cast<std::streamoff>(place));
      const char c = static_cast<char>(stream.get() ^ 16);
      stream.seekp(static_cast<std::streamoff>(place));
      stream.put(c);
    }

    int n_files() const
    {
      return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }

    /// What a FileError says, on every process; nothing if there is none.
    template <typename Function>
    std::string refusal(const Function &action) const
    {
      try
        {
          action();
          return "";
        }
      catch (const FileError &error)
        {
          return error.what();
        }
    }

    const RowMap      rows;
    const fs::path    place;
    const std::string folder;
    const fs::path    archive = fs::path(folder) / "sweep.archive";
  };
} // namespace

TEST_F(ChartCheckpoints, ReturnEveryBit)
{
  keep_some();
  for (const RowMap &map : {rows, dealt_rows(), Testing::rows(n_rows, Testing::Distribution::last_process_all)})
    {
      ChartCheckpoint kept = checkpoint();
      EXPECT_EQ(kept.n_found(), 3);
      const auto store = kept.part("sweep", map);
      for (const OperatingPoint &point : {at(0.1), at(1. / 3., 1), at(0.2)})
        {
          const auto found = store->find(point);
          ASSERT_TRUE(found.has_value());
          EXPECT_TRUE(same_bits(*found, result_at(point.friction_coefficient)));
        }
      // Neither the other line, nor the next number
      EXPECT_FALSE(store->find(at(1. / 3.)).has_value());
      EXPECT_FALSE(store->find(at(0.1, 1)).has_value());
      EXPECT_FALSE(store->find(at(std::nextafter(0.1, 1.))).has_value());

      const auto blocks = store->basis();
      ASSERT_EQ(blocks.size(), 2u);
      for (int b = 0; b < 2; ++b)
        {
          EXPECT_TRUE(blocks[b].map() == map);
          EXPECT_TRUE(same_bits(replicate(blocks[b]), replicate(random_vectors(rows, b == 0 ? 4 : 2, b + 1))));
        }
    }
}

TEST_F(ChartCheckpoints, KeepPartsApart)
{
  const RowMap few = RowMap::even(5, rows.communicator());
  keep_some();
  {
    ChartCheckpoint kept  = checkpoint();
    const auto      other = kept.part("refinements", few);
    EXPECT_TRUE(other->basis().empty());
    EXPECT_FALSE(other->find(at(0.1)).has_value());
    other->keep(random_vectors(few, 3, 7));
    other->keep(at(0.1), result_at(0.4));
    kept.part("sweep", rows)->keep(at(0.3), result_at(0.3));
  }
  ChartCheckpoint kept = checkpoint();
  EXPECT_EQ(kept.n_found(), 5);
  EXPECT_EQ(kept.part("sweep", rows)->basis().size(), 2u);
  EXPECT_TRUE(kept.part("sweep", rows)->find(at(0.3)).has_value());
  const auto blocks = kept.part("refinements", few)->basis();
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_TRUE(same_bits(replicate(blocks[0]), replicate(random_vectors(few, 3, 7))));
}

TEST_F(ChartCheckpoints, ShowWhatIsFound)
{
  const std::uintmax_t title = std::string("squeal sweep 5\n").size() + key.size() + 1;
  const auto           ends  = keep_some();
  alone([&] {
    EXPECT_EQ(content(fs::path(folder) / "points.csv"), header + csv_of(0, 0.1) + csv_of(1, 1. / 3.) + csv_of(0, 0.2));
    EXPECT_EQ(content(archive).substr(0, title), "squeal sweep 5\n" + key + '\0');
    EXPECT_EQ(ends.front(), title);
    // As if the run had been killed while it wrote
    std::ofstream(fs::path(folder) / "points.csv", std::ios::app) << "0,0.3,1";
    std::ofstream(archive.string() + ".incomplete") << "squeal";
  });
  const auto others = csv_of(0, 0.1) + csv_of(0, 0.2) + csv_of(1, 1. / 3.);
  {
    ChartCheckpoint kept = checkpoint();
    alone([&] {
      EXPECT_EQ(content(fs::path(folder) / "points.csv"), header + others);
      EXPECT_EQ(n_files(), 2);
    });
    const auto store = kept.part("sweep", rows);
    store->keep(at(0.05), result_at(0.05));
    alone([&] { EXPECT_EQ(content(fs::path(folder) / "points.csv"), header + others + csv_of(0, 0.05)); });
    // A result that replaces another
    ChartPoint better = result_at(0.05);
    better.n_zeros    = 3;
    store->keep(at(0.05), better);
  }
  ChartCheckpoint kept = checkpoint();
  EXPECT_EQ(kept.part("sweep", rows)->find(at(0.05)).value().n_zeros, 3);
  alone([&] { EXPECT_EQ(content(fs::path(folder) / "points.csv"), header + csv_of(0, 0.05) + others); });
}

TEST_F(ChartCheckpoints, ContinueTheirOwnSweepOnly)
{
  keep_some();
  const std::string message = refusal([&] { checkpoint("# squeal 1\nsubsection Operation\n  set Load = 400\nend\n"); });
  for (const std::string &part :
       {std::string("an unfinished sweep of other parameters"), std::string("`set Load = 300` there, `set Load = 400` here"),
        "folder " + folder, archive.string(), std::string("--output"), std::string("delete the folder")})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_NE(refusal([&] { checkpoint(key + "set Study = stability\n"); }).find("nothing there, `set Study = stability` here"),
            std::string::npos);
  EXPECT_EQ(checkpoint().n_found(), 3);
  // Another format
  alone([&] {
    std::fstream stream(archive, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(std::string("squeal sweep ").size());
    stream.put('9');
  });
  EXPECT_NE(refusal([&] { checkpoint(); }).find("`squeal sweep 9` there, `squeal sweep 5` here"), std::string::npos);
}

TEST_F(ChartCheckpoints, LieNowhereBeforeAnythingIsFound)
{
  ChartCheckpoint kept  = checkpoint();
  const auto      store = kept.part("sweep", rows);
  EXPECT_FALSE(store->find(at(0.1)).has_value());
  EXPECT_TRUE(store->basis().empty());
  alone([&] { EXPECT_FALSE(fs::exists(folder)); });
}

TEST_F(ChartCheckpoints, HaveTheLastWholeStateWhereverARunWasKilled)
{
  const auto  ends = keep_some();
  std::string whole;
  alone([&] { whole = content(archive); });
  const std::vector<int> n_results = {0, 0, 1, 2, 2, 3}, n_blocks = {0, 1, 1, 1, 2, 2};
  for (std::size_t n = 0; n < n_results.size(); ++n)
    for (const int more : {0, 1, 15, 16, 17, 100})
      {
        alone([&] {
          // The record that follows is written to some of its bytes; the disk may have got room for more than it has got
          fs::remove(archive);
          std::ofstream(archive, std::ios::binary) << whole.substr(0, std::min<std::size_t>(ends[n] + more, ends.back()));
        });
        const bool is_last = n + 1 == n_results.size();
        {
          ChartCheckpoint kept = checkpoint();
          EXPECT_EQ(kept.n_found(), n_results[n]) << n << ", " << more << " bytes more";
          const auto store = kept.part("sweep", rows);
          EXPECT_EQ(store->basis().size(), static_cast<std::size_t>(n_blocks[n]));
          EXPECT_EQ(store->find(at(0.2)).has_value(), is_last);
          // It goes on from there
          store->keep(at(0.7), result_at(0.7));
        }
        ChartCheckpoint kept = checkpoint();
        EXPECT_EQ(kept.n_found(), n_results[n] + 1) << n << ", " << more << " bytes more";
        EXPECT_TRUE(same_bits(kept.part("sweep", rows)->find(at(0.7)).value(), result_at(0.7)));
        EXPECT_EQ(kept.part("sweep", rows)->basis().size(), static_cast<std::size_t>(n_blocks[n]));
      }
}

TEST_F(ChartCheckpoints, ForgetDamagedResults)
{
  const auto  ends = keep_some();
  std::string whole;
  alone([&] { whole = content(archive); });
  // Checksum, first and last byte, and the middle of the second result
  for (const double part : {0., 0.1, 0.5, 1.})
    {
      alone([&] {
        std::ofstream(archive, std::ios::binary) << whole;
        constexpr std::uintmax_t size_of_size = 8;
        const std::uintmax_t     first = ends[2] + size_of_size, last = ends[3] - 1;
        damage(first + static_cast<std::uintmax_t>(part * (last - first)));
      });
      {
        ChartCheckpoint kept = checkpoint();
        EXPECT_EQ(kept.n_found(), 2) << part;
        const auto store = kept.part("sweep", rows);
        EXPECT_FALSE(store->find(at(1. / 3., 1)).has_value());
        EXPECT_TRUE(store->find(at(0.2)).has_value());
        EXPECT_EQ(store->basis().size(), 2u);
        store->keep(at(1. / 3., 1), result_at(1. / 3.));
      }
      EXPECT_TRUE(same_bits(checkpoint().part("sweep", rows)->find(at(1. / 3., 1)).value(), result_at(1. / 3.)));
      alone([&] { EXPECT_EQ(content(fs::path(folder) / "points.csv"), header + csv_of(0, 0.1) + csv_of(0, 0.2) + csv_of(1, 1. / 3.)); });
    }
}

TEST_F(ChartCheckpoints, StartAfreshWithoutABlock)
{
  for (const int block : {0, 3}) // the place of its record
    {
      const auto ends = keep_some();
      alone([&] { damage((ends[block] + ends[block + 1]) / 2); });
      {
        ChartCheckpoint kept = checkpoint();
        EXPECT_EQ(kept.n_found(), 0) << block;
        const auto store = kept.part("sweep", rows);
        EXPECT_TRUE(store->basis().empty());
        EXPECT_FALSE(store->find(at(0.1)).has_value());
        alone([&] { EXPECT_EQ(content(fs::path(folder) / "points.csv"), header); });
        store->keep(random_vectors(rows, 3, 5));
        store->keep(at(0.1), result_at(0.1));
      }
      ChartCheckpoint again = checkpoint();
      EXPECT_EQ(again.n_found(), 1);
      EXPECT_EQ(again.part("sweep", rows)->basis().size(), 1u);
      again.remove();
    }
}

TEST_F(ChartCheckpoints, LieBesideTheResults)
{
  const std::string output = (place / "deep" / "results").string();
  EXPECT_EQ(checkpoint_folder(output), folder);
  EXPECT_EQ(checkpoint_folder(output + "/"), folder);
  EXPECT_EQ(checkpoint_folder((place / "." / "deep").string() + "//results"), folder);
  EXPECT_EQ(checkpoint_folder("results/a"), "results/a.checkpoint");
  keep_some();
  alone([&] {
    // Neither a run that fails nor one that is complete touches it
    for (const bool is_complete : {false, true})
      {
        ResultFolder results(output, true);
        results.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
        if (is_complete)
          results.commit();
      }
  });
  ChartCheckpoint kept = checkpoint();
  EXPECT_EQ(kept.n_found(), 3);
  kept.remove();
  alone([&] {
    EXPECT_FALSE(fs::exists(folder));
    EXPECT_TRUE(fs::exists(output));
  });
}

TEST_F(ChartCheckpoints, SayWhatIsInTheWay)
{
  // A folder of something else
  alone([&] {
    fs::create_directories(folder);
    std::ofstream(fs::path(folder) / "thesis.tex") << "years of work";
  });
  EXPECT_NE(refusal([&] { checkpoint(); }).find("holds files that are not those of an unfinished sweep"), std::string::npos);
  alone([&] {
    EXPECT_EQ(content(fs::path(folder) / "thesis.tex"), "years of work");
    // A file
    fs::remove_all(folder);
    std::ofstream(fs::path(folder)) << "a file";
  });
  EXPECT_NE(refusal([&] { checkpoint(); }).find("`" + folder + "` is a file"), std::string::npos);
  // A file where a parent should be
  const std::string below = folder + "/below/results.checkpoint";
  EXPECT_NE(refusal([&] { ChartCheckpoint(below, key, MPI_COMM_WORLD, band); }).find("folder " + below), std::string::npos);
  alone([&] {
    EXPECT_EQ(content(folder), "a file");
    fs::remove(folder);
  });
}

TEST_F(ChartCheckpoints, SayThatTheDiskIsFull)
{
  keep_some();
  ChartCheckpoint kept  = checkpoint();
  const auto      store = kept.part("sweep", rows);
  {
    // Room for the beginning of the next record
    std::uintmax_t room = 0;
    alone([&] { room = size() + 30; });
    const SizeLimit   limit(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, room, 0));
    const std::string message = refusal([&] { store->keep(random_vectors(rows, 1, 3)); });
    for (const std::string &part : {std::string(std::strerror(EFBIG)), archive.string(), std::string("free space")})
      EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    alone([&] { EXPECT_EQ(size(), room); });
  }
  // What was kept stays, and the next attempt may succeed.
  store->keep(random_vectors(rows, 1, 3));
  EXPECT_EQ(checkpoint().n_found(), 3);
  EXPECT_EQ(checkpoint().part("sweep", rows)->basis().size(), 3u);
  // Someone tidied up
  alone([&] { fs::remove_all(folder); });
  EXPECT_NE(refusal([&] { store->keep(at(0.7), result_at(0.7)); }).find("cannot be kept"), std::string::npos);
}

TEST_F(ChartCheckpoints, LetASweepContinueAsIfNotInterrupted)
{
  const Scene          s(mesh_of(skewed_pins), mounted(), operating());
  const UpdatedInverse inverse(s.coupled, 0., FactorizationLibrary::automatic);
  const SymmetricModes real = real_modes(s.coupled);
  ContactDamping       damping{{}, {}};
  damping.radial.assign(s.interface.size(), 40.);
  const CoupledSystem         system = with_values(s.coupled, damping.values());
  std::vector<OperatingPoint> points;
  for (int i = 0; i <= 4; ++i)
    points.push_back({0.2 * i, damping.values(), 0});
  const auto sweep = [&](ChartStore *store) {
    Progress   progress;
    ChartModel model(system, inverse, 0., *real.vectors, omega_max, 0.05);
    return error_controlled_sweep(model, points, {4, 0}, {}, store, MPI_COMM_WORLD, progress);
  };
  const ErrorControlledSweep whole = sweep(nullptr);

  // As if the run were killed before its third result
  struct Killed
  {};
  struct Short : ChartStore
  {
    explicit Short(ChartStore &store)
      : store(store)
    {}
    std::optional<ChartPoint> find(const OperatingPoint &point) const override
    {
      return store.find(point);
    }
    void keep(const OperatingPoint &point, const ChartPoint &result) override
    {
      if (n_left-- == 0)
        throw Killed();
      store.keep(point, result);
    }
    std::vector<MultiVector> basis() const override
    {
      return store.basis();
    }
    void keep(const MultiVector &block) override
    {
      store.keep(block);
    }
    ChartStore &store;
    int         n_left = 2;
  };
  {
    ChartCheckpoint kept  = checkpoint();
    const auto      store = kept.part("sweep", system.map());
    Short           killed(*store);
    EXPECT_THROW(sweep(&killed), Killed);
  }
  ChartCheckpoint resumed = checkpoint();
  const auto      store   = resumed.part("sweep", system.map());
  EXPECT_EQ(resumed.n_found(), 2);
  std::vector<std::optional<ChartPoint>> before;
  for (const OperatingPoint &point : points)
    before.push_back(store->find(point));
  EXPECT_TRUE(before[0] && before[1] && !before[2]);
  const ErrorControlledSweep again = sweep(store.get());
  ASSERT_EQ(again.points.size(), whole.points.size());
  ChartCheckpoint finished = checkpoint();
  EXPECT_EQ(finished.n_found(), 5);
  const auto all = finished.part("sweep", system.map());
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      ASSERT_TRUE(again.points[i] && whole.points[i]);
      // On several processes two runs may differ by rounding.
      EXPECT_LT(largest(distances(again.points[i]->lambda, whole.points[i]->lambda)), 1e-11) << "point " << i;
      const auto kept = all->find(points[i]);
      EXPECT_TRUE(kept && same_bits(*kept, *again.points[i])) << "point " << i;
      EXPECT_TRUE(!before[i] || same_bits(*before[i], *again.points[i])) << "point " << i;
    }
}
