#include "files.h"
#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/output/result_folder.h>

#include <deal.II/base/utilities.h>

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  constexpr int n_rows = 23;

  const std::string key = "# squeal 1\nsubsection Operation\n  set Load = 300\nend\n";

  bool same_bits(const DenseMatrix &a, const DenseMatrix &b)
  {
    return a.rows() == b.rows() && a.cols() == b.cols() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
  }

  bool same_bits(const ChartPoint &a, const ChartPoint &b)
  {
    return dealii::Utilities::pack(a, false) == dealii::Utilities::pack(b, false);
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

  OperatingPoint at(const double friction, const int line = 0)
  {
    return {friction, {}, line};
  }

  class ChartCheckpoints : public ::testing::Test
  {
  protected:
    ChartCheckpoint checkpoint(const std::string &with_key = key) const
    {
      return ChartCheckpoint(folder, with_key, MPI_COMM_WORLD);
    }

    fs::path record(const int number) const
    {
      return fs::path(folder) / ("found-" + std::to_string(number));
    }

    /// Two blocks and two results on the first, one on both, in the order of block, result, result, block, result.
    void keep_some() const
    {
      ChartCheckpoint kept  = checkpoint();
      const auto      store = kept.part("sweep", rows);
      store->keep(random_vectors(rows, 4, 1));
      store->keep(at(0.1), result_at(0.1));
      store->keep(at(1. / 3., 1), result_at(1. / 3.));
      store->keep(random_vectors(rows, 2, 2));
      store->keep(at(0.2), result_at(0.2));
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

    const TemporaryFolder temporary;
    const fs::path        place  = temporary.path;
    const std::string     folder = (place / "deep" / "results.checkpoint").string();
    const RowMap          rows   = RowMap::even(n_rows, MPI_COMM_WORLD);
  };
} // namespace

TEST_F(ChartCheckpoints, ReturnEveryBit)
{
  keep_some();
  for (const RowMap &map : {rows, Testing::rows(n_rows, Testing::Distribution::last_process_all)})
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
  checkpoint().part("sweep", rows);
  temporary.alone([&] { EXPECT_FALSE(fs::exists(folder)) << "nothing is found yet"; });
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

TEST_F(ChartCheckpoints, TakeTheLaterOfTwoResults)
{
  keep_some();
  ChartPoint better = result_at(0.1);
  better.n_zeros    = 3;
  checkpoint().part("sweep", rows)->keep(at(0.1), better);
  ChartCheckpoint kept = checkpoint();
  EXPECT_EQ(kept.n_found(), 3);
  EXPECT_EQ(kept.part("sweep", rows)->find(at(0.1)).value().n_zeros, 3);
}

TEST_F(ChartCheckpoints, ContinueTheirOwnSweepOnly)
{
  keep_some();
  const std::string message = refusal([&] { checkpoint("# squeal 1\nsubsection Operation\n  set Load = 400\nend\n"); });
  for (const std::string &part :
       {std::string("`set Load = 300` there, `set Load = 400` here"), "folder " + folder, std::string("sweep.key")})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_NE(refusal([&] { checkpoint(key + "set Study = stability\n"); }).find("`set Study = stability` here"), std::string::npos);
  EXPECT_EQ(checkpoint().n_found(), 3);
  // Another format
  temporary.alone([&] { std::ofstream(fs::path(folder) / ChartCheckpoint::key_name) << "squeal sweep 0\n" << key; });
  EXPECT_NE(refusal([&] { checkpoint(); }).find("`squeal sweep 0` there"), std::string::npos);
}

TEST_F(ChartCheckpoints, HaveTheLastWholeStateWhereverARunWasKilled)
{
  const std::vector<int> n_results = {0, 0, 1, 2, 2, 3}, n_blocks = {0, 1, 1, 1, 2, 2};
  for (int n = 0; n < 5; ++n)
    for (const double part : {-1., 0., 0.1, 0.99}) // of the next record that is there; all other ones are
      {
        keep_some();
        temporary.alone([&] {
          const auto size = fs::file_size(record(n + 1));
          if (part < 0.)
            fs::remove(record(n + 1));
          else
            fs::resize_file(record(n + 1), static_cast<std::uintmax_t>(part * static_cast<double>(size)));
          std::ofstream(record(6).string() + ".incomplete") << "squeal";
        });
        {
          ChartCheckpoint kept = checkpoint();
          EXPECT_EQ(kept.n_found(), n_results[n]) << n << ", " << part;
          const auto store = kept.part("sweep", rows);
          EXPECT_EQ(store->basis().size(), static_cast<std::size_t>(n_blocks[n]));
          EXPECT_FALSE(store->find(at(0.2)).has_value());
          // It goes on from there
          store->keep(at(0.7), result_at(0.7));
        }
        ChartCheckpoint kept = checkpoint();
        EXPECT_EQ(kept.n_found(), n_results[n] + 1) << n << ", " << part;
        EXPECT_TRUE(same_bits(kept.part("sweep", rows)->find(at(0.7)).value(), result_at(0.7)));
        EXPECT_EQ(kept.part("sweep", rows)->basis().size(), static_cast<std::size_t>(n_blocks[n]));
        kept.remove();
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
  temporary.alone([&] {
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
  temporary.alone([&] {
    EXPECT_FALSE(fs::exists(folder));
    EXPECT_TRUE(fs::exists(output));
  });
}

TEST_F(ChartCheckpoints, SayWhatIsInTheWay)
{
  // A folder of something else, a file, a file where a parent should be
  const fs::path thesis = fs::path(folder) / "thesis.tex";
  temporary.alone([&] { put(thesis, "years of work"); });
  EXPECT_NE(refusal([&] { checkpoint(); }).find("folder " + folder), std::string::npos);
  temporary.alone([&] {
    EXPECT_EQ(content(thesis), "years of work");
    fs::remove_all(folder);
    put(folder, "a file");
  });
  for (const std::string &name : {folder, folder + "/below/results.checkpoint"})
    EXPECT_NE(refusal([&] { ChartCheckpoint(name, key, MPI_COMM_WORLD); }).find(name), std::string::npos);
  temporary.alone([&] { EXPECT_EQ(content(folder), "a file"); });
}

TEST_F(ChartCheckpoints, SayWhatCannotBeWritten)
{
  keep_some();
  ChartCheckpoint kept   = checkpoint();
  const auto      store  = kept.part("sweep", rows);
  const fs::path  in_way = record(6).string() + ".incomplete";
  temporary.alone([&] { fs::create_directories(in_way); });
  const std::string message = refusal([&] { store->keep(random_vectors(rows, 1, 3)); });
  for (const std::string &part : {std::string(std::strerror(EISDIR)), record(6).string()})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  // What was kept stays, and the next attempt may succeed.
  temporary.alone([&] { fs::remove(in_way); });
  store->keep(random_vectors(rows, 1, 3));
  EXPECT_EQ(checkpoint().n_found(), 3);
  EXPECT_EQ(checkpoint().part("sweep", rows)->basis().size(), 3u);
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
    ChartModel model(system, inverse, 0., *real.vectors, omega_max);
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
