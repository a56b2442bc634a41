#include "scenes.h"

#include <squeal/geometry/grading.h>

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

TEST(Grading, PinsHaveThinnerLayersAtTheirHeldEnd)
{
  GeometryParameters parameters = one_pin();
  parameters.bottom             = {{0.23}, {-60.}};
  parameters.pin_layers         = 3;
  parameters.pin_grading        = 2.;
  const HexMesh mesh            = generate_mesh(parameters);
  const double  z_face          = parameters.disc_thickness / 2.;
  for (const double side : {1., -1.})
    {
      // Heights above the face: 4 : 2 : 1 of 7
      std::set<double> heights;
      for (const HexMesh::Point &p : mesh.points)
        if (side * p[2] >= z_face)
          heights.insert(std::round(1e9 * (side * p[2] - z_face) / parameters.pin_height) / 1e9);
      ASSERT_EQ(heights.size(), 4u);
      EXPECT_NEAR(*std::next(heights.begin()), 4. / 7., 1e-8);
      EXPECT_NEAR(*std::next(heights.begin(), 2), 6. / 7., 1e-8);
      EXPECT_EQ(*heights.rbegin(), 1.);
    }
}
