#include "scenes.h"

#include <squeal/geometry/disc_axis.h>

#include <functional>

using namespace Scenes;

namespace
{
  using Map = std::function<HexMesh::Point(const HexMesh::Point &)>;

  /// The mesh of one pin with every node moved.
  HexMesh moved(const Map &map)
  {
    static const HexMesh mesh   = generate_mesh(one_pin());
    HexMesh              result = mesh;
    for (HexMesh::Point &point : result.points)
      point = map(point);
    return result;
  }

  void expect_vector(const dealii::Tensor<1, 3> &actual, const dealii::Tensor<1, 3> &expected)
  {
    for (unsigned int d = 0; d < 3; ++d)
      EXPECT_NEAR(actual[d], expected[d], 1e-6);
  }
} // namespace

TEST(DiscAxes, RoundDiscIsFoundWhereItIs)
{
  const HexMesh  mesh = moved([](const auto &p) { return p; });
  const DiscAxis axis = find_disc_axis(mesh);
  expect_vector(axis.direction, HexMesh::Point{0., 0., 1.});
  EXPECT_LT(axis.offset, 1e-6);
  EXPECT_GT(axis.round, 0.99);
  EXPECT_GT(axis.round_about_z, 0.99);
  EXPECT_NO_THROW(check_disc_axis(axis, mesh, "here"));
}

TEST(DiscAxes, OtherAxesAreRefusedByName)
{
  const double a = 0.02;
  for (const auto &[map, direction, centre, text] : std::vector<std::tuple<Map, HexMesh::Point, HexMesh::Point, std::string>>{
         {[](const auto &p) {
            return HexMesh::Point{p[0] + 0.001, p[1] - 0.002, p[2] + 0.7};
          },
          {0., 0., 1.},
          {0.001, -0.002, 0.7},
          "through (0.001, -0.002, 0.7) m in direction (0, 0, 1)"},
         {[](const auto &p) {
            return HexMesh::Point{p[1], p[2], p[0]};
          },
          {0., 1., 0.},
          {0., 0., 0.},
          "in direction (0, 1, 0)"},
         {[a](const auto &p) {
            return HexMesh::Point{p[0], std::cos(a) * p[1] - std::sin(a) * p[2], std::sin(a) * p[1] + std::cos(a) * p[2]};
          },
          {0., -std::sin(a), std::cos(a)},
          {0., 0., 0.},
          "in direction (0, -0.02, 0.9998)"}})
    {
      const HexMesh  mesh = moved(map);
      const DiscAxis axis = find_disc_axis(mesh);
      expect_vector(axis.direction, direction);
      expect_vector(axis.centre, centre);
      expect_mentions(message<MeshError>([&] { check_disc_axis(axis, mesh, "here"); }), {text, "here", "Translate and Rotate"});
    }
}

TEST(DiscAxes, HalfADiscWithAnEarStillHasItsAxis)
{
  // Radii of a sector of 60° are stretched: what is left of bore and rim decides
  const auto with_ear = [](const HexMesh::Point &p) {
    const double factor = std::abs(std::atan2(p[1], -p[0])) < std::acos(-1.) / 6. ? 1.2 : 1.;
    return HexMesh::Point{factor * p[0], factor * p[1], p[2]};
  };
  const HexMesh  centred = moved(with_ear);
  const DiscAxis axis    = find_disc_axis(centred);
  EXPECT_LT(axis.offset, 1e-3);
  EXPECT_NO_THROW(check_disc_axis(axis, centred, "here"));
  const HexMesh aside = moved([&](const HexMesh::Point &p) {
    HexMesh::Point q = with_ear(p);
    q[0] += 0.01;
    return q;
  });
  EXPECT_NEAR(find_disc_axis(aside).offset, 0.01, 1e-3);
  EXPECT_THROW(check_disc_axis(find_disc_axis(aside), aside, "here"), MeshError);
}

TEST(DiscAxes, SquareDiscIsNotRoundButAccepted)
{
  // From the square to the circle and back
  const HexMesh  mesh = moved([](const HexMesh::Point &p) {
    const double factor = std::hypot(p[0], p[1]) / std::max(std::abs(p[0]), std::abs(p[1]));
    return HexMesh::Point{factor * p[0], factor * p[1], p[2]};
  });
  const DiscAxis axis = find_disc_axis(mesh);
  EXPECT_LT(axis.round_about_z, 0.5);
  EXPECT_NO_THROW(check_disc_axis(axis, mesh, "here"));
}
