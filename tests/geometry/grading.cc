#include "scenes.h"

#include <squeal/geometry/grading.h>
#include <squeal/geometry/mesh_check.h>

using namespace Squeal;
using namespace Scenes;

TEST(Grading, IntervalsShrinkByTheRatio)
{
  EXPECT_EQ(graded_intervals(4, 1.), (std::vector<double>{0., 0.25, 0.5, 0.75, 1.}));
  const std::vector<double> ends = graded_intervals(4, 2.); // 8 : 4 : 2 : 1 of 15
  for (int i = 0; i <= 4; ++i)
    EXPECT_NEAR(ends[i], std::vector<double>({0., 8. / 15., 12. / 15., 14. / 15., 1.})[i], 1e-15);
  EXPECT_EQ(ends.back(), 1.);
}

TEST(Grading, PinsAreFinerAtTheirHeldEndAndOutline)
{
  GeometryParameters parameters = one_pin();
  parameters.bottom             = {{0.23}, {-60.}};
  parameters.nodes_per_pin_face = 37;
  parameters.pin_layers         = 3;
  const HexMesh uniform         = generate_mesh(parameters);
  parameters.pin_grading        = 2.;
  const HexMesh graded          = generate_mesh(parameters);
  ASSERT_EQ(graded.points.size(), uniform.points.size());
  EXPECT_GT(check_mesh(graded).worst_scaled_jacobian, 0.2);

  const double z_face = parameters.disc_thickness / 2., r = parameters.pin_diameter / 2.;
  for (const double side : {1., -1.})
    {
      // Heights above the face: 4 : 2 : 1 of 7; radii the same, within the roundness of inner rings
      const double     angle = side > 0. ? 30. : -60., x = 0.23 * std::cos(angle * M_PI / 180.), y = 0.23 * std::sin(angle * M_PI / 180.);
      std::set<double> heights;
      double           inner = 0.;
      for (const HexMesh::Point &p : graded.points)
        if (side * p[2] >= z_face && std::hypot(p[0] - x, p[1] - y) <= 1.0001 * r)
          {
            heights.insert(std::round(1e9 * (side * p[2] - z_face) / parameters.pin_height) / 1e9);
            if (std::hypot(p[0] - x, p[1] - y) < 0.99 * r)
              inner = std::max(inner, std::hypot(p[0] - x, p[1] - y));
          }
      ASSERT_EQ(heights.size(), 4u);
      EXPECT_NEAR(*std::next(heights.begin()), 4. / 7., 1e-8);
      EXPECT_NEAR(*std::next(heights.begin(), 2), 6. / 7., 1e-8);
      EXPECT_GT(inner, 0.84 * r); // a uniform grid has its last ring at two thirds
      EXPECT_LT(inner, 6. / 7. * r * 1.001);
    }
}
