#include "files.h"
#include "scenes.h"

#include <squeal/output/fields.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  using Corner = std::array<double, 3>;

  Corner minus(const Corner &a, const Corner &b)
  {
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
  }

  Corner cross(const Corner &a, const Corner &b)
  {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
  }

  double dot(const Corner &a, const Corner &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  /// Corners of a cell.
  std::vector<Corner> corners(const FieldMesh &mesh, const unsigned int cell)
  {
    std::vector<Corner> result;
    for (unsigned int v = 0; v < mesh.corners; ++v)
      result.push_back(mesh.nodes[mesh.cells[cell * mesh.corners + v]].position);
    return result;
  }

  /// Of a hexahedron in the order of VTK, by six tetrahedra about one diagonal; negative where it is inside out.
  double volume(const std::vector<Corner> &x)
  {
    constexpr int tetrahedra[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
    double        result           = 0.;
    for (const auto &[a, b] : tetrahedra)
      result += dot(cross(minus(x[a], x[0]), minus(x[b], x[0])), minus(x[6], x[0])) / 6.;
    return result;
  }

  double area(const std::vector<Corner> &x)
  {
    const Corner normal = cross(minus(x[2], x[0]), minus(x[3], x[1]));
    return 0.5 * std::sqrt(dot(normal, normal));
  }

  /// Area or volume with two chords for each edge that is a parabola: they leave a quarter of what a single chord does.
  double of_half_edges(const double with_chords, const double with_parabolas)
  {
    return with_parabolas + (with_chords - with_parabolas) / 4.;
  }

  /// Volume of what quadrilaterals enclose whose normals point outwards.
  double enclosed(const FieldMesh &mesh)
  {
    double result = 0.;
    for (unsigned int cell = 0; cell < mesh.components.size(); ++cell)
      {
        const auto x = corners(mesh, cell);
        result += (dot(x[0], cross(x[1], x[2])) + dot(x[0], cross(x[2], x[3]))) / 6.;
      }
    return result;
  }

  template <typename Number>
  Number on_all(const Number &here)
  {
    return dealii::Utilities::MPI::sum(here, MPI_COMM_WORLD);
  }

  /// A disc of 24 cells with one pin.
  struct SmallBrake : Scene
  {
    explicit SmallBrake(const Element element)
      : Scene(extrude(polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 2, 0, 1}}), layers(1, 1)), mounted(), operating(), element)
    {}
  };

  /// The values of a field of a file of one piece, which a single block holds.
  std::vector<float> values_of(const std::string &text, const std::string &name)
  {
    const auto    place = text.find("offset=", text.find("Name=\"" + name + "\""));
    const auto    data  = text.find("\n_") + 2 + std::stoul(text.substr(place + 8));
    std::uint64_t head[4];
    std::memcpy(head, text.data() + data, sizeof(head));
    std::vector<float> result(head[1] / sizeof(float));
    uLongf             size = head[1];
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef *>(result.data()), &size,
                         reinterpret_cast<const Bytef *>(text.data()) + data + sizeof(head), head[3]),
              Z_OK);
    EXPECT_EQ(head[0], 1u);
    EXPECT_EQ(size, head[1]);
    return result;
  }
} // namespace

TEST(FieldMeshes, CellsFillTheBodiesAndShareVertices)
{
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      const SmallBrake   s(element);
      const unsigned int p = s.model.degree();
      const FieldMesh all = body_mesh(s.model, {}), disc = body_mesh(s.model, Component::disc), pins = body_mesh(s.model, Component::pins);
      EXPECT_EQ(on_all(all.components.size()), s.model.triangulation().n_global_active_cells() * p * p * p);
      EXPECT_EQ(on_all(disc.components.size()), 24 * p * p * p);
      EXPECT_EQ(disc.components.size() + pins.components.size(), all.components.size());
      EXPECT_EQ(disc.nodes.size() + pins.nodes.size(), all.nodes.size());
      std::set<std::int64_t> numbers;
      for (const Node &node : all.nodes)
        numbers.insert(node.number);
      EXPECT_EQ(numbers.size(), all.nodes.size()) << "vertices are shared";
      if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
        EXPECT_EQ(all.nodes.size(), s.model.nodes().size());

      double sum = 0.;
      for (unsigned int cell = 0; cell < all.components.size(); ++cell)
        {
          const double v = volume(corners(all, cell));
          EXPECT_GT(v, 0.);
          sum += v;
          for (unsigned int vertex = 0; vertex < 8; ++vertex)
            EXPECT_EQ(all.nodes[all.cells[8 * cell + vertex]].component, static_cast<unsigned int>(all.components[cell]));
        }
      sum = on_all(sum);
      EXPECT_NEAR(sum,
                  of_half_edges(dealii::GridTools::volume(s.model.triangulation()),
                                dealii::GridTools::volume(s.model.triangulation(), s.model.mapping())),
                  1e-12 * sum);
      EXPECT_NEAR(on_all(enclosed(surface_mesh(s.model))), sum, 1e-12 * sum) << to_string(element);
    }
}

TEST(FieldMeshes, ContactFacesHaveTheAreaOfThePairs)
{
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const SmallBrake   s(element);
      const unsigned int p        = s.model.degree();
      const FieldMesh    mesh     = contact_face_mesh(s.model);
      double             of_cells = 0., of_pairs = 0., of_straight_faces = 0.;
      for (unsigned int cell = 0; cell < mesh.components.size(); ++cell)
        of_cells += area(corners(mesh, cell));
      for (const ContactNode &pair : s.interface)
        of_pairs += pair.area;
      EXPECT_EQ(mesh.components.size() % (p * p), 0u);
      for (const auto &cell : s.model.triangulation().active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && s.model.surface_ids(PhysicalNames::pin_contact).count(face->boundary_id()) > 0)
            of_straight_faces += face->measure();
      of_cells          = on_all(of_cells);
      of_straight_faces = on_all(of_straight_faces);
      EXPECT_NEAR(of_cells, of_half_edges(of_straight_faces, of_pairs), 1e-12 * of_pairs) << to_string(element);
      std::set<std::int64_t> numbers, wanted;
      for (const Node &node : mesh.nodes)
        numbers.insert(node.number);
      EXPECT_EQ(numbers.size(), mesh.nodes.size());
      for (const auto &part : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, std::vector<std::int64_t>(numbers.begin(), numbers.end())))
        numbers.insert(part.begin(), part.end());
      for (const ContactNode &pair : s.interface)
        wanted.insert(pair.pin_node.number);
      EXPECT_EQ(numbers, wanted) << "every node is a corner";
    }
}

TEST(VtuFiles, HaveTheDisplacementsOfTheirPoints)
{
  const auto displacement = [](const std::array<double, 3> &x, const int d) {
    return std::sin(1. + d + 7. * x[0] - 5. * x[1] + 9. * x[2]);
  };
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const fs::path      place = fs::temp_directory_path() / ("squeal_vtu_test_" + std::to_string(getpid()));
      const SmallBrake    s(element);
      std::vector<double> u(s.model.free_map().n());
      double              largest = 0.;
      for (const Node &node : s.model.nodes())
        for (int d = 0; d < 3; ++d)
          if (node.dofs[d] >= 0)
            {
              u[node.dofs[d]] = displacement(node.position, d);
              largest         = std::max(largest, std::abs(u[node.dofs[d]]));
            }
      {
        ResultFolder folder(place.string(), true);
        FieldWriter(s.model, s.interface, {}, folder).write_mode({"real", "µ", u, {}});
        folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
        folder.commit();
      }
      const std::string text = content((place / "modes" / "real.vtu").string());
      fs::remove_all(place);
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
              EXPECT_NEAR(values[3 * i + d], wanted, 1e-7);
              EXPECT_NEAR(points[3 * i + d], mesh.nodes[i].position[d], 3e-8);
              sum += wanted * wanted;
            }
          EXPECT_NEAR(amplitude[i], std::sqrt(sum), 2e-7);
        }
    }
}
