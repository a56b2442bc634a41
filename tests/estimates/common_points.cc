#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/estimates/body_frames.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/estimates/reduction_errors.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Annuli with a pin on either side of the same sectors; the outlines of meshes of other widths are other polygons.
  HexMesh mesh(const int refinement, const int n_layers)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, -refinement, 2 * refinement, refinement, refinement},
                                        {Plan::Side::bottom, -refinement, 2 * refinement, refinement, refinement}};
    return extrude(polar_plan(0.1505, 0.3155, 3 * refinement, 24 * refinement, pins), layers(n_layers, n_layers + 1));
  }

  /// In the space of extruded cells, and zero on the clamped face of the upper pin.
  Point3 multilinear(const Point3 &x)
  {
    const GeometryParameters parameters;
    const double             z = x[2] - parameters.disc_thickness / 2. - parameters.pin_height;
    return {{z * (1. + 2. * x[0] - x[1]), z * x[1], 3. * z}};
  }

  /// √m u(x) at all common points, one after the other.
  std::vector<double> exact(const CommonPoints &points, const std::function<Point3(unsigned int, const Point3 &)> &u)
  {
    std::vector<double> result;
    for (unsigned int body = 0; body < points.bodies.size(); ++body)
      for (std::size_t q = 0; q < points.bodies[body].points.size(); ++q)
        {
          const auto &x = points.bodies[body].points[q];
          for (const double value : u(body, {{x[0], x[1], x[2]}}))
            result.push_back(std::sqrt(points.bodies[body].masses[q]) * value);
        }
    return result;
  }
} // namespace

TEST(CommonPoints, HaveTheMassOfEveryBody)
{
  const HexMesh            coarse = mesh(1, 2);
  const Model              model(coarse, Element::trilinear, MPI_COMM_WORLD);
  const MaterialParameters materials = mounted();
  const CommonPoints       points    = common_points(model, materials);
  ASSERT_EQ(points.bodies.size(), 3u);
  for (unsigned int body = 0; body < 3; ++body)
    {
      double mass = 0.;
      for (const double m : points.bodies[body].masses)
        mass += m;
      EXPECT_EQ(points.bodies[body].name, coarse.volume_names[body]);
      EXPECT_NEAR(mass, (body == 0 ? materials.disc : materials.pin).density * volume(coarse, body), 1e-12 * mass);
    }
  EXPECT_EQ(points.n(), 8 * static_cast<int>(coarse.hexahedra.size()));
}

TEST(CommonPoints, EvaluateMultilinearFieldsExactlyInTheirOwnBodyOnly)
{
  // Faces of disc and pin coincide, but each body has a field of its own
  const MaterialParameters materials = mounted();
  const HexMesh            coarse    = mesh(1, 2);
  const CommonPoints       points    = common_points(Model(coarse, Element::trilinear, MPI_COMM_WORLD), materials);
  const auto               expected  = exact(points, [](const unsigned int body, const Point3 &x) {
    return body == 1 ? multilinear(x) : Point3{{0., 0., 0.}};
  });
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      // The same outline, cells that do not match
      HexMesh fine =
        extrude(polar_plan(0.1505, 0.3155, 3, 24, {{Plan::Side::top, -1, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 1, 1}}, "bore", "rim"),
                layers(3, 5));
      for (HexMesh::Hexahedron &cell : fine.hexahedra) // names that are in another order
        cell.volume = cell.volume == 0 ? 0 : 3 - cell.volume;
      std::swap(fine.volume_names[1], fine.volume_names[2]);
      const Model       model(fine, element, MPI_COMM_WORLD);
      MultiVector       u     = displacements(model, 2, multilinear);
      const DenseMatrix found = replicate(*displacements_at(points, model) * u);
      for (std::size_t row = 0; row < expected.size(); ++row)
        ASSERT_NEAR(found(row, 0), expected[row], 1e-12) << row;
    }
}

TEST(CommonPoints, MassProductsAreThoseOfTheMesh)
{
  const MaterialParameters materials = mounted();
  const Testing::Scene     coarse(mesh(1, 2), materials, operating()), fine(mesh(2, 3), materials, operating());
  const CommonPoints       points = common_points(coarse.model, materials);
  const auto               smooth = [](const Point3 &x) { return Point3{{std::sin(6. * x[0]), x[1] * x[2], std::cos(5. * x[1]) * x[0]}}; };
  for (const Testing::Scene *scene : {&coarse, &fine})
    {
      const MultiVector u = displacements(scene->model, 0, smooth), Eu = *displacements_at(points, scene->model) * u;
      // On another mesh the rim is another polygon, whose area is 1 % larger
      EXPECT_NEAR(gram(Eu, Eu)(0, 0) / product(u, *scene->system.mass, u), 1., scene == &coarse ? 1e-6 : 0.03);
    }
}

TEST(CommonPoints, PairModesOfMeshesOfOneScene)
{
  // Twice as fine, other layers, and quadratic: numbers of modes differ in the band, shapes do not
  const MaterialParameters materials = mounted();
  const Testing::Scene     coarse(mesh(1, 2), materials, operating()), fine(mesh(2, 3), materials, operating()),
    quadratic(mesh(1, 2), materials, operating(), Element::quadratic);
  const CommonPoints points = common_points(coarse.model, materials);
  const auto         solve  = [&](const Testing::Scene &scene) {
    return at_points(*displacements_at(points, scene.model), *scene.contact.kernel, undamped_modes(real_modes(scene.coupled)));
  };
  const ModesAtPoints reference = solve(coarse);
  for (const Testing::Scene *scene : {&fine, &quadratic})
    {
      const ModesAtPoints finer   = solve(*scene);
      const ModePairing   pairing = pair_modes(reference, finer);
      int                 n       = 0;
      for (std::size_t k = 0; k < reference.lambda.size(); ++k)
        {
          const PairedMode &mode = pairing.coarse[k];
          if (mode.partner < 0)
            continue;
          ++n;
          EXPECT_EQ(pairing.fine[mode.partner].partner, static_cast<int>(k));
          EXPECT_TRUE(mode.in_cluster || mode.overlap > 0.7) << k;
          // Coarser meshes are stiffer
          EXPECT_LT(finer.lambda[mode.partner].imag(), 1.001 * reference.lambda[k].imag()) << k;
        }
      EXPECT_GE(n, 0.8 * reference.lambda.size());
    }
}

TEST(CommonPoints, RefuseAMeshOfOtherBodies)
{
  const MaterialParameters materials = mounted();
  const HexMesh            two       = mesh(1, 1);
  const CommonPoints       points    = common_points(Model(two, Element::trilinear, MPI_COMM_WORLD), materials);
  HexMesh                  other     = two;
  other.volume_names[1]              = "pin_elsewhere";
  EXPECT_THROW(displacements_at(points, Model(other, Element::trilinear, MPI_COMM_WORLD)), MeshError);
}

namespace
{
  /// A mesh with another width of the disc and another thickness of everything.
  HexMesh other(HexMesh mesh)
  {
    for (HexMesh::Point &x : mesh.points)
      {
        const double r = std::hypot(x[0], x[1]), theta = std::atan2(x[1], x[0]), new_r = 0.1 + 2. * (r - 0.1505);
        x = HexMesh::Point(new_r * std::cos(theta), new_r * std::sin(theta), 1.5 * x[2]);
      }
    return mesh;
  }
} // namespace

TEST(BodyFrames, CarryPointsToTheSamePlacesOfADisc)
{
  const HexMesh      one = mesh(1, 2), two = other(one);
  const Model        from(one, Element::trilinear, MPI_COMM_WORLD), to(two, Element::trilinear, MPI_COMM_WORLD);
  const CommonPoints points = common_points(from, mounted(), 1), carried = carried_over(points, body_frames(from), body_frames(to));
  ASSERT_EQ(carried.bodies.size(), 3u);
  EXPECT_EQ(carried.bodies[0].masses, points.bodies[0].masses);
  for (std::size_t q = 0; q < points.bodies[0].points.size(); ++q)
    {
      const auto  &x = points.bodies[0].points[q], &y = carried.bodies[0].points[q];
      const double r = std::hypot(x[0], x[1]);
      EXPECT_NEAR(std::hypot(y[0], y[1]), 0.1 + 2. * (r - 0.1505), 1e-14);
      EXPECT_NEAR(std::atan2(y[1], y[0]), std::atan2(x[1], x[0]), 1e-13);
      EXPECT_NEAR(y[2], 1.5 * x[2], 1e-14);
    }
}

TEST(BodyFrames, LeaveOutBodiesThatTheOtherDesignLacks)
{
  const HexMesh          one = mesh(1, 2);
  const Model            from(one, Element::trilinear, MPI_COMM_WORLD);
  std::vector<BodyFrame> frames = body_frames(from), fewer = frames;
  fewer.erase(fewer.begin() + 1);
  const CommonPoints points = common_points(from, mounted(), 1), carried = carried_over(points, frames, fewer);
  ASSERT_EQ(carried.bodies.size(), 2u);
  EXPECT_EQ(carried.bodies[1].name, points.bodies[2].name);
  for (std::size_t q = 0; q < points.bodies[2].points.size(); ++q)
    EXPECT_LT(carried.bodies[1].points[q].distance(points.bodies[2].points[q]), 1e-15);
}

TEST(CylindricalDirections, FollowATurnedScene)
{
  // The same displacement, turned with the scene, has the same components
  const HexMesh one = mesh(1, 2), two = [&] {
    HexMesh turned = one;
    for (HexMesh::Point &x : turned.points)
      x = HexMesh::Point(-x[1], x[0], x[2]);
    return turned;
  }();
  const Model  from(one, Element::trilinear, MPI_COMM_WORLD), to(two, Element::trilinear, MPI_COMM_WORLD);
  CommonPoints points = common_points(from, mounted(), 1);
  const auto   E      = displacements_at(points, from, Directions::cylindrical);
  for (CommonPoints::Body &body : points.bodies)
    for (dealii::Point<3> &x : body.points)
      x = dealii::Point<3>(-x[1], x[0], x[2]);
  const auto F      = displacements_at(points, to, Directions::cylindrical);
  const auto field  = [](const Point3 &a) { return Point3{{1. + a[0], 2. * a[1] - a[2], 3. + a[0] * a[2]}}; };
  const auto turned = [&](const Point3 &b) {
    const Point3 value = field({{b[1], -b[0], b[2]}});
    return Point3{{-value[1], value[0], value[2]}};
  };
  const MultiVector u = displacements(from, 0, field), v = displacements(to, 0, turned);
  const MultiVector x = *E * u, y = *F * v;
  EXPECT_GT(x.local().cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((x.local() - y.local()).cwiseAbs().maxCoeff(), 1e-12);
}
