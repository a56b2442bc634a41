// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/geometry/mortar.h>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

using namespace Squeal;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{
  enum class Kind
  {
    triangles,
    quadrilaterals,
    mixed
  };

  const std::vector<Kind> kinds = {Kind::triangles, Kind::quadrilaterals, Kind::mixed};

  struct Grid
  {
    Kind         kind;
    unsigned int degree;
    unsigned int n;                ///< cells per direction
    double       distortion;       ///< largest shift of a corner relative to the cell size
    bool         is_below = false; ///< true if the face points downwards
  };

  using Embedding = std::function<dealii::Point<3>(double, double)>;

  dealii::Point<3> flat(const double x, const double y)
  {
    return {x, y, 0.3 * x - 0.2 * y};
  }

  /// Mesh of the unit square with randomly shifted corners; other nodes are midway between corners.
  SurfacePatch patch(const Grid &grid, const Embedding &place = flat)
  {
    std::mt19937                                      random(grid.n);
    std::uniform_real_distribution<>                  shift(-grid.distortion, grid.distortion);
    const unsigned int                                n = grid.n;
    std::vector<dealii::Point<2>>                     corners;
    std::map<std::vector<unsigned int>, unsigned int> numbers; // numbers of nodes by their adjacent corners
    SurfacePatch                                      result;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        corners.emplace_back((i + (i % n == 0 ? 0. : shift(random))) / n, (j + (j % n == 0 ? 0. : shift(random))) / n);
    const auto add = [&](std::vector<unsigned int> around) {
      if (grid.is_below)
        std::reverse(around.begin(), around.end());
      const Shape    shape = shape_of_face(around.size());
      SurfaceElement element{shape, {}};
      for (const dealii::Point<3> &reference : reference_nodes(shape, grid.degree))
        {
          std::vector<unsigned int> key;
          dealii::Point<2>          mean;
          for (unsigned int i = 0; i < around.size(); ++i)
            if (ShapeFunctions::of(shape, 1).value(i, reference) > 0.1)
              key.push_back(around[i]);
          for (const unsigned int corner : key)
            mean += corners[corner] / double(key.size());
          std::sort(key.begin(), key.end());
          const auto [it, is_new] = numbers.insert({key, result.points.size()});
          if (is_new)
            result.points.push_back(place(mean[0], mean[1]));
          element.nodes.push_back(it->second);
        }
      result.elements.push_back(element);
    };
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          const unsigned int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
          if (grid.kind == Kind::quadrilaterals || (grid.kind == Kind::mixed && (i + j) % 2 == 0))
            add({a, b, c, d});
          else
            {
              add({a, b, c});
              add({a, c, d});
            }
        }
    return result;
  }

  /// ∫ N_i for every node.
  VectorXd loads(const SurfacePatch &patch)
  {
    VectorXd result = VectorXd::Zero(patch.points.size());
    for (const SurfaceElement &element : patch.elements)
      {
        const unsigned int degree    = element.nodes.size() > 4 ? 2 : 1;
        const auto        &functions = ShapeFunctions::of(element.shape, degree);
        for (const QuadraturePoint &point : quadrature(element.shape, degree))
          {
            std::array<dealii::Tensor<1, 3>, 2> tangents;
            for (unsigned int i = 0; i < element.nodes.size(); ++i)
              for (unsigned int d = 0; d < 2; ++d)
                tangents[d] += functions.gradient(i, point.x)[d] * patch.points[element.nodes[i]];
            for (unsigned int i = 0; i < element.nodes.size(); ++i)
              result[element.nodes[i]] += point.weight * cross_product_3d(tangents[0], tangents[1]).norm() * functions.value(i, point.x);
          }
      }
    return result;
  }

  MatrixXd matrix(const Mortar &mortar, const NodeWeights MortarRow::*part, const SurfacePatch &patch)
  {
    MatrixXd result = MatrixXd::Zero(mortar.rows.size(), patch.points.size());
    for (unsigned int j = 0; j < mortar.rows.size(); ++j)
      for (const auto &[node, weight] : mortar.rows[j].*part)
        result(j, node) += weight;
    return result;
  }

  /// Constant and linear displacements of the nodes.
  MatrixXd displacements(const SurfacePatch &patch)
  {
    MatrixXd result(patch.points.size(), 4);
    for (unsigned int i = 0; i < patch.points.size(); ++i)
      result.row(i) << 1., patch.points[i][0], patch.points[i][1], patch.points[i][2];
    return result;
  }

  struct Tied
  {
    Tied(const SurfacePatch &slave, const SurfacePatch &master, const double search_distance = 1e-3)
      : result(mortar(slave, master, search_distance))
      , slave(matrix(result, &MortarRow::slave, slave))
      , master(matrix(result, &MortarRow::master, master))
      , left_inverse(matrix(result, &MortarRow::left_inverse, slave))
      , area(result.rows.size())
      , relative(this->slave * displacements(slave) - this->master * displacements(master))
    {
      for (unsigned int j = 0; j < result.rows.size(); ++j)
        area[j] = result.rows[j].area;
      EXPECT_GT(area.minCoeff(), 0.);
      EXPECT_LT((this->master.rowwise().sum().array() - 1.).abs().maxCoeff(), 1e-14);
      EXPECT_LT((left_inverse * this->slave.transpose() - MatrixXd::Identity(area.size(), area.size())).cwiseAbs().maxCoeff(), 1e-14);
    }

    Mortar   result;
    MatrixXd slave, master, left_inverse;
    VectorXd area;
    MatrixXd relative; ///< relative motions for constant and linear displacements
  };

  /// Calls @p check for every kind, degree and distortion of the slave mesh.
  template <typename Check>
  void for_all(const Check &check)
  {
    for (const Kind kind : kinds)
      for (const unsigned int degree : {1, 2})
        for (const double distortion : {0., 0.2})
          {
            SCOPED_TRACE(testing::Message() << "kind " << int(kind) << ", degree " << degree << ", distortion " << distortion);
            check(Grid{kind, degree, 5, distortion, true});
          }
  }
} // namespace

TEST(Mortar, MatchingMeshesAreTiedNodeByNode)
{
  for_all([](Grid grid) {
    const SurfacePatch slave  = patch(grid);
    grid.is_below             = false;
    const SurfacePatch master = patch(grid);
    const Tied         tied(slave, master);
    const bool         is_transformed = grid.degree == 2 && grid.kind != Kind::quadrilaterals;
    ASSERT_EQ(tied.result.rows.size(), slave.points.size());
    for (unsigned int i = 0; i < slave.points.size(); ++i)
      {
        const auto l =
          std::find_if(master.points.begin(), master.points.end(), [&](const auto &x) { return x.distance(slave.points[i]) < 1e-12; });
        EXPECT_LT((tied.slave.col(i) - tied.master.col(l - master.points.begin())).cwiseAbs().maxCoeff(), is_transformed ? 1e-13 : 1e-300);
      }
    for (const MortarRow &row : tied.result.rows)
      {
        EXPECT_EQ(row.master.size(), row.slave.size());
        EXPECT_LE(row.slave.size(), is_transformed ? 3u : 1u);
      }
  });
}

TEST(Mortar, LinearDisplacementsAndConstantPressureAreExact)
{
  for_all([](const Grid &grid) {
    for (const Kind other : kinds)
      {
        const SurfacePatch slave = patch(grid), master = patch({other, grid.degree, 7, grid.distortion});
        const Tied         tied(slave, master);
        EXPECT_EQ(tied.result.rows.size(), slave.points.size());
        EXPECT_NEAR(tied.result.overlap_area, tied.result.slave_area, 1e-14);
        EXPECT_LT(tied.relative.cwiseAbs().maxCoeff(), 1e-14);
        // Quadrature is inexact on distorted quadrilaterals
        const double tolerance = grid.distortion == 0. ? 1e-15 : 1e-11;
        EXPECT_LT((tied.slave.transpose() * tied.area - loads(slave)).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_LT((tied.master.transpose() * tied.area - loads(master)).cwiseAbs().maxCoeff(), tolerance);
      }
  });
}

TEST(Mortar, PartsThatOverlapAreTied)
{
  for_all([](const Grid &grid) {
    for (const Kind other : kinds)
      for (const double offset : {0.3, 0.37, 0.45, 0.52, 0.61, 0.74, 0.81, 0.97})
        {
          const auto   place = [&](const double x, const double y) { return flat(x + offset, y + offset / 2.); };
          const Tied   tied(patch(grid), patch({other, grid.degree, 7, grid.distortion}, place));
          const double overlap = tied.result.overlap_area;
          EXPECT_LT(tied.area.size(), tied.slave.cols());
          EXPECT_NEAR(overlap, (1. - offset) * (1. - offset / 2.) * std::sqrt(1.13), 1e-14);
          // Elements with a negligible overlap are omitted
          EXPECT_LT(tied.area.sum(), overlap * (1. + 1e-14));
          EXPECT_GT(tied.area.sum(), 0.97 * overlap);
          EXPECT_LT(tied.relative.cwiseAbs().maxCoeff(), 1e-11);
          EXPECT_LT(tied.master.cwiseAbs().maxCoeff(), 6.);
        }
  });
}

TEST(Mortar, CurvedFacesConverge)
{
  const auto cylinder = [](const double x, const double y) { return dealii::Point<3>(std::sin(x), y, std::cos(x)); };
  for_all([&](const Grid &grid) {
    std::vector<double> errors;
    for (const unsigned int n : {4, 8})
      {
        const Tied tied(patch({grid.kind, grid.degree, n, grid.distortion, true}, cylinder),
                        patch({Kind::triangles, grid.degree, n + n / 2, grid.distortion}, cylinder), 0.1);
        errors.push_back(std::sqrt(tied.area.dot(tied.relative.rowwise().squaredNorm())));
      }
    EXPECT_GT(errors[0] / errors[1], grid.degree == 1 ? 3.8 : 14.);
    EXPECT_LT(errors[0], grid.degree == 1 ? 4e-3 : 1e-5);
  });
}

TEST(Mortar, FindsPointsInStronglyDistortedElements)
{
  const auto warped = [](const double x, const double y) { return dealii::Point<3>(x, y, 0.3 * x * y + 0.1 * std::sin(3. * x)); };
  const Tied tied(patch({Kind::quadrilaterals, 2, 6, 0.3, true}, warped), patch({Kind::quadrilaterals, 2, 9, 0.3}, warped), 0.1);
  EXPECT_NEAR(tied.result.overlap_area / tied.result.slave_area, 1., 1e-4);
}

TEST(Mortar, ReportsHowMuchCoarserTheSlaveIs)
{
  for (const unsigned int degree : {1, 2})
    EXPECT_NEAR(Tied(patch({Kind::mixed, degree, 3, 0., true}), patch({Kind::quadrilaterals, degree, 12, 0.})).result.coarseness, 4.,
                1e-12);
}

TEST(Mortar, RejectsFacesThatDoNotMeet)
{
  const SurfacePatch slave     = patch({Kind::quadrilaterals, 1, 4, 0., true});
  const auto         rejection = [&](const Grid &grid, const dealii::Point<3> &offset) -> std::string {
    try
      {
        mortar(slave, patch(grid, [&](const double x, const double y) { return flat(x, y) + offset; }), 1e-3);
      }
    catch (const MeshError &error)
      {
        return error.reason;
      }
    return "";
  };
  EXPECT_NE(rejection({Kind::triangles, 1, 4, 0., true}, {}).find("do not face each other"), std::string::npos);
  for (const dealii::Point<3> &offset :
       {dealii::Point<3>(0., 0., 2e-3), dealii::Point<3>(0.9995, 0., 0.29985), dealii::Point<3>(2., 0., 0.)})
    EXPECT_NE(rejection({Kind::triangles, 1, 4, 0.}, offset).find("overlap by"), std::string::npos) << offset;
}
