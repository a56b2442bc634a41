// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"
#include "scenes.h"

#include <squeal/model/element_values.h>
#include <squeal/output/fields.h>

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  using Vector3 = dealii::Tensor<1, 3>;

  std::vector<Vector3> corners(const FieldMesh &mesh, const unsigned int cell)
  {
    std::vector<Vector3> result;
    for (int corner = cell == 0 ? 0 : mesh.ends[cell - 1]; corner < mesh.ends[cell]; ++corner)
      {
        const auto &x = mesh.nodes[mesh.corners[corner]].position;
        result.push_back(Vector3({x[0], x[1], x[2]}));
      }
    return result;
  }

  /// Normals of the triangles of a fan about the first corner of a polygon; each length is twice the area.
  std::vector<Vector3> fan(const std::vector<Vector3> &x)
  {
    std::vector<Vector3> result;
    for (std::size_t i = 2; i < x.size(); ++i)
      result.push_back(dealii::cross_product_3d(x[i - 1] - x[0], x[i] - x[0]));
    return result;
  }

  /// Signed volume of the cone from the origin to a polygon, positive if its normal points away from the origin.
  double cone(const std::vector<Vector3> &x)
  {
    double result = 0.;
    for (const Vector3 &normal : fan(x))
      result += normal * x[0] / 6.;
    return result;
  }

  /// Volume of a cell in VTK order, negative if inverted.
  double volume(const FieldMesh &mesh, const unsigned int cell)
  {
    const std::map<int, Shape> shapes = {{10, Shape::tetrahedron}, {12, Shape::hexahedron}, {13, Shape::wedge}, {14, Shape::pyramid}};
    std::vector<Vector3>       x      = corners(mesh, cell);
    if (mesh.types[cell] == 13) // in VTK, the first triangle of a wedge faces outwards
      {
        std::swap(x[1], x[2]);
        std::swap(x[4], x[5]);
      }
    double result = 0.;
    for (const auto &face : topology(shapes.at(mesh.types[cell])).faces)
      {
        std::vector<Vector3> around;
        for (const unsigned int corner : face)
          around.push_back(x[corner] - x[0]);
        result += cone(around);
      }
    return result;
  }

  double area(const std::vector<Vector3> &x)
  {
    Vector3 sum;
    for (const Vector3 &normal : fan(x))
      sum += 0.5 * normal;
    return sum.norm();
  }

  /// Area or volume with two chords for each curved edge: the error is a quarter of the error with one chord.
  double of_half_edges(const double with_chords, const double with_parabolas)
  {
    return with_parabolas + (with_chords - with_parabolas) / 4.;
  }

  /// Volume enclosed by faces with outward normals.
  double enclosed(const FieldMesh &mesh)
  {
    double result = 0.;
    for (unsigned int cell = 0; cell < mesh.ends.size(); ++cell)
      result += cone(corners(mesh, cell));
    return result;
  }

  template <typename Number>
  Number on_all(const Number &here)
  {
    return dealii::Utilities::MPI::sum(here, MPI_COMM_WORLD);
  }

  std::set<std::int64_t> numbers_of(const std::vector<Node> &nodes)
  {
    std::set<std::int64_t> numbers;
    for (const Node &node : nodes)
      numbers.insert(node.number);
    return numbers;
  }

  /// A result folder with the files written by @p action(folder).
  template <typename Action>
  fs::path results(const TemporaryFolder &place, const Action &action)
  {
    const fs::path path = place.path / "results";
    ResultFolder   folder(path.string(), true);
    action(folder);
    folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
    folder.commit();
    return path;
  }

  /// A disc of 24 cells with one pin.
  struct DiscWithPin : Scene
  {
    explicit DiscWithPin(const Element element)
      : Scene(extrude(polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 2, 0, 1}}), layers(1, 1)), mounted(), operating(), element)
    {}
    ModeField mode(const std::complex<double> &lambda, const std::string &name = "complex_001_A0-2") const
    {
      ModeField result{name, lambda, {}, {}, "A0-2, 160 Hz"};
      for (int i = 0; i < model.free_map().n(); ++i)
        result.displacement.emplace_back(std::cos(i), std::sin(i));
      result.reactions.assign(interface.size(), {-1., 2.});
      return result;
    }
    /// A result folder with the fields written by @p action(writer).
    template <typename Action>
    fs::path written(const TemporaryFolder &place, const Action &action) const
    {
      return results(place, [&](const ResultFolder &folder) {
        FieldWriter writer(model, interface, {}, folder);
        action(writer);
      });
    }
  };

  /// Values of an array in a file with one piece and a single block.
  template <typename Number = float>
  std::vector<Number> values_of(const std::string &text, const std::string &name)
  {
    const auto    place = text.find("offset=", text.find("Name=\"" + name + "\""));
    const auto    data  = text.find("\n_") + 2 + std::stoul(text.substr(place + 8));
    std::uint64_t head[4];
    std::memcpy(head, text.data() + data, sizeof(head));
    std::vector<Number> result(head[1] / sizeof(Number));
    uLongf              size = head[1];
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef *>(result.data()), &size,
                         reinterpret_cast<const Bytef *>(text.data()) + data + sizeof(head), head[3]),
              Z_OK);
    EXPECT_EQ(head[0], 1u);
    EXPECT_EQ(size, head[1]);
    return result;
  }

  /// Times and files listed in a .pvd file.
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
} // namespace

TEST(FieldMeshes, CellsFillTheBodiesAndShareVertices)
{
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      const DiscWithPin  s(element);
      const unsigned int p = s.model.degree();
      const FieldMesh all = body_mesh(s.model, {}), disc = body_mesh(s.model, Component::disc), pins = body_mesh(s.model, Component::pins);
      EXPECT_EQ(on_all(all.components.size()), s.mesh.cells.size() * p * p * p);
      EXPECT_EQ(on_all(disc.components.size()), 24 * p * p * p);
      EXPECT_EQ(disc.components.size() + pins.components.size(), all.components.size());
      EXPECT_EQ(disc.nodes.size() + pins.nodes.size(), all.nodes.size());
      EXPECT_EQ(numbers_of(all.nodes).size(), all.nodes.size()) << "vertices must be shared";

      double sum = 0., straight = 0., parabolic = 0.;
      for (unsigned int cell = 0; cell < all.components.size(); ++cell)
        {
          const double v = volume(all, cell);
          EXPECT_GT(v, 0.);
          sum += v;
          for (unsigned int vertex = 0; vertex < 8; ++vertex)
            EXPECT_EQ(all.nodes[all.corners[8 * cell + vertex]].component, static_cast<unsigned int>(all.components[cell]));
        }
      sum = on_all(sum);
      for (unsigned int body = 0; body < s.mesh.body_names.size(); ++body)
        straight += Testing::volume(s.mesh, body);
      ElementValues values(s.model);
      for (const Cell &cell : s.model.cells())
        if (cell.is_own)
          {
            values.reinit(cell);
            for (unsigned int q = 0; q < values.n_points(); ++q)
              parabolic += values.JxW(q);
          }
      EXPECT_NEAR(sum, of_half_edges(straight, on_all(parabolic)), 1e-12 * sum);
      EXPECT_NEAR(on_all(enclosed(surface_mesh(s.model))), sum, 1e-12 * sum) << to_string(element);
    }
}

TEST(FieldMeshes, ContactFacesHaveTheAreaOfThePairs)
{
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const DiscWithPin  s(element);
      const unsigned int p        = s.model.degree();
      const FieldMesh    mesh     = contact_face_mesh(s.model);
      double             of_cells = 0., of_pairs = 0., of_straight_faces = 0.;
      for (unsigned int cell = 0; cell < mesh.components.size(); ++cell)
        of_cells += area(corners(mesh, cell));
      for (const ContactNode &pair : s.interface)
        of_pairs += pair.area;
      EXPECT_EQ(mesh.components.size() % (p * p), 0u);
      for (const Mesh::Face &face : s.mesh.faces)
        if (s.mesh.surface_names[face.surface] == PhysicalNames::pin_contact)
          {
            std::vector<Vector3> x;
            for (std::size_t i = 0; i < topology(face.shape).corners.size(); ++i)
              x.push_back(s.mesh.points[face.nodes[i]]);
            of_straight_faces += area(x);
          }
      EXPECT_NEAR(on_all(of_cells), of_half_edges(of_straight_faces, of_pairs), 1e-12 * of_pairs) << to_string(element);
    }
}

TEST(Fields, OfMixedCellsAreThoseOfLinearParts)
{
  // A cube, a pyramid on top, a wedge next to it, and between pyramid and wedge a tetrahedron of another volume
  Mesh mesh;
  mesh.points         = {{0., 0., 0.}, {1., 0., 0.}, {1., 1., 0.}, {0., 1., 0.},  {0., 0., 1.},  {1., 0., 1.},
                         {1., 1., 1.}, {0., 1., 1.}, {.5, .5, 2.}, {2., .5, 1.5}, {1.5, .5, 0.}, {1.5, .5, 1.}};
  mesh.cells          = {{Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, 0},
                         {Shape::pyramid, {4, 5, 6, 7, 8}, 0},
                         {Shape::wedge, {1, 10, 2, 5, 11, 6}, 0},
                         {Shape::tetrahedron, {5, 6, 8, 9}, 1}};
  mesh.volume_names   = {"disc", "ring"};
  mesh.body_names     = {"disc"};
  mesh.body_of_volume = {0, 0};

  const TemporaryFolder place;
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const Model     model(mesh, element, MPI_COMM_WORLD);
      const FieldMesh bodies = body_mesh(model, {}), surface = surface_mesh(model);
      const fs::path  folder = results(place, [&](const ResultFolder &into) {
        VtuPiece(bodies).write(into, "mixed.vtu", {}, MPI_COMM_WORLD);
        VtuPiece(surface).write(into, "surface.vtu", {}, MPI_COMM_WORLD);
      });
      // Number of cells of each type
      const auto check_file = [&](const char *name, const FieldMesh &written, const std::map<int, unsigned int> &expected) {
        const std::string text  = content(folder / name);
        const auto        types = values_of<std::uint8_t>(text, "types");
        EXPECT_EQ(values_of<std::int32_t>(text, "connectivity"), written.corners);
        EXPECT_EQ(values_of<std::int32_t>(text, "offsets"), written.ends);
        std::map<int, unsigned int> found;
        for (const int type : types)
          ++found[type];
        EXPECT_EQ(found, expected);
        return text;
      };
      const bool        is_linear = element == Element::trilinear;
      const std::string text      = check_file("mixed.vtu", bodies,
                                          is_linear ? std::map<int, unsigned int>{{10, 1}, {12, 1}, {13, 1}, {14, 1}} :
                                                           std::map<int, unsigned int>{{10, 12}, {12, 8}, {13, 8}, {14, 6}});
      check_file("surface.vtu", surface,
                 is_linear ? std::map<int, unsigned int>{{5, 8}, {9, 6}} : std::map<int, unsigned int>{{5, 32}, {9, 24}});
      const auto volumes = values_of<std::int32_t>(text, "volume");
      EXPECT_EQ(std::count(volumes.begin(), volumes.end(), 1), is_linear ? 1 : 8);

      double sum = 0.;
      for (unsigned int cell = 0; cell < bodies.types.size(); ++cell)
        {
          EXPECT_GT(volume(bodies, cell), 0.) << int(bodies.types[cell]);
          sum += volume(bodies, cell);
        }
      EXPECT_NEAR(sum, 1. + 1. / 3. + 1. / 4. + 1.25 / 6., 1e-12);
      EXPECT_NEAR(enclosed(surface), sum, 1e-12);
    }
}

TEST(Fields, HaveTheDisplacementsOfTheirPoints)
{
  const auto displacement = [](const std::array<double, 3> &x, const int d) {
    return std::sin(1. + d + 7. * x[0] - 5. * x[1] + 9. * x[2]);
  };
  constexpr double      half_a_step = 0.5 / 65536. + 1e-7; // half a step of the displacements, and rounding to single precision
  const TemporaryFolder place;
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const DiscWithPin   s(element);
      std::vector<double> u(s.model.free_map().n());
      double              largest = 0.;
      for (const Node &node : s.model.nodes())
        for (int d = 0; d < 3; ++d)
          if (node.dofs[d] >= 0)
            {
              u[node.dofs[d]] = displacement(node.position, d);
              largest         = std::max(largest, std::abs(u[node.dofs[d]]));
            }
      const auto        folder = s.written(place, [&](FieldWriter &writer) { writer.write_mode({"real", "µ", u, {}}); });
      const std::string text   = content(folder / "modes" / "real.vtu");
      const auto points = values_of(text, "points"), values = values_of(text, "displacement"), amplitude = values_of(text, "amplitude");
      const auto mesh = body_mesh(s.model, {});
      ASSERT_EQ(points.size(), 3 * mesh.nodes.size());
      ASSERT_EQ(values.size(), points.size());
      ASSERT_EQ(amplitude.size(), mesh.nodes.size());
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        {
          double sum = 0.;
          for (int d = 0; d < 3; ++d)
            {
              const double wanted = mesh.nodes[i].dofs[d] < 0 ? 0. : displacement(mesh.nodes[i].position, d) / largest;
              EXPECT_NEAR(values[3 * i + d], wanted, half_a_step);
              EXPECT_NEAR(points[3 * i + d], mesh.nodes[i].position[d], 3e-8);
              sum += wanted * wanted;
            }
          EXPECT_NEAR(amplitude[i], std::sqrt(sum), half_a_step);
        }
    }
}

TEST(Fields, OfAnimationsWithGrowthAreLargestWhereTheModeIs)
{
  const TemporaryFolder place;
  const DiscWithPin     s(Element::trilinear);
  std::vector<float>    without;
  for (const bool grows : {false, true})
    {
      const auto folder = s.written(place, [&](FieldWriter &writer) {
        writer.write_animation("all", {s.mode({50., 1000.}, "grows"), s.mode({-50., 1000.}, "decays")}, {4, 3, grows});
      });
      // The final frame is written only with growth; otherwise it would repeat the first frame
      const auto frames = listed(folder / "animations" / "all.pvd");
      ASSERT_EQ(frames.size(), grows ? 13u : 12u);
      EXPECT_EQ(frames.back().first, (frames.size() - 1) / 4.);
      const auto first = content(folder / "animations" / frames.front().second),
                 last  = content(folder / "animations" / frames.back().second);
      if (!grows)
        without = values_of(first, "grows");
      // Growing modes end, and decaying modes begin, with the amplitude of an animation without growth
      EXPECT_EQ(values_of(first, "decays"), without);
      EXPECT_EQ(values_of(first, "grows") == without, !grows);
      EXPECT_EQ(values_of(last, "grows") == without, grows);
      EXPECT_NE(values_of(last, "decays"), without);
    }
}

TEST(Fields, AreListedWithATimeForEachMode)
{
  const TemporaryFolder place;
  const DiscWithPin     s(Element::trilinear);
  // Rigid-body modes, modes whose frequencies differ only by rounding, and distinct modes
  const std::vector<double> frequencies = {0., 0., 500., 500., 500. * (1. + 1e-14), 500.1, 4999.};
  std::vector<ListedMode>   modes;
  for (const double frequency : frequencies)
    modes.push_back({"mode_" + std::to_string(modes.size()), frequency});
  const auto list = listed(s.written(place, [&](FieldWriter &writer) { writer.write_list("modes", modes); }) / "modes.pvd");
  ASSERT_EQ(list.size(), frequencies.size());
  for (std::size_t j = 0; j < list.size(); ++j)
    {
      EXPECT_EQ(list[j].second, "modes/" + modes[j].name + ".vtu");
      EXPECT_NEAR(list[j].first, frequencies[j], 3e-6 * frequencies[j] + 1e-3) << j;
      EXPECT_TRUE(j == 0 || list[j].first > list[j - 1].first) << j;
    }
}
