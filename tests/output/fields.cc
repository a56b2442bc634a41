#include "files.h"
#include "scenes.h"

#include <squeal/output/fields.h>

#include <deal.II/base/tensor.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

namespace
{
  using Corner = dealii::Tensor<1, 3>;

  /// Corners of a cell.
  std::vector<Corner> corners(const FieldMesh &mesh, const unsigned int cell)
  {
    std::vector<Corner> result;
    for (unsigned int v = 0; v < mesh.corners; ++v)
      {
        const auto &x = mesh.nodes[mesh.cells[cell * mesh.corners + v]].position;
        result.push_back(Corner({x[0], x[1], x[2]}));
      }
    return result;
  }

  double triple(const Corner &a, const Corner &b, const Corner &c)
  {
    return dealii::cross_product_3d(a, b) * c;
  }

  /// Of a hexahedron in the order of VTK, by six tetrahedra about one diagonal; negative where it is inside out.
  double volume(const std::vector<Corner> &x)
  {
    constexpr int tetrahedra[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
    double        result           = 0.;
    for (const auto &[a, b] : tetrahedra)
      result += triple(x[a] - x[0], x[b] - x[0], x[6] - x[0]) / 6.;
    return result;
  }

  double area(const std::vector<Corner> &x)
  {
    return 0.5 * dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]).norm();
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
        result += (triple(x[1], x[2], x[0]) + triple(x[2], x[3], x[0])) / 6.;
      }
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
    /// The folder in which fields are once @p action(writer) has written them.
    template <typename Action>
    fs::path written(const TemporaryFolder &place, const Action &action) const
    {
      const fs::path path = place.path / "results";
      ResultFolder   folder(path.string(), true);
      FieldWriter    writer(model, interface, {}, folder);
      action(writer);
      folder.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
      folder.commit();
      return path;
    }
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
} // namespace

TEST(FieldMeshes, CellsFillTheBodiesAndShareVertices)
{
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      const DiscWithPin  s(element);
      const unsigned int p = s.model.degree();
      const FieldMesh all = body_mesh(s.model, {}), disc = body_mesh(s.model, Component::disc), pins = body_mesh(s.model, Component::pins);
      EXPECT_EQ(on_all(all.components.size()), s.model.dof_handler().get_triangulation().n_global_active_cells() * p * p * p);
      EXPECT_EQ(on_all(disc.components.size()), 24 * p * p * p);
      EXPECT_EQ(disc.components.size() + pins.components.size(), all.components.size());
      EXPECT_EQ(disc.nodes.size() + pins.nodes.size(), all.nodes.size());
      EXPECT_EQ(numbers_of(all.nodes).size(), all.nodes.size()) << "vertices are shared";

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
                  of_half_edges(dealii::GridTools::volume(s.model.dof_handler().get_triangulation()),
                                dealii::GridTools::volume(s.model.dof_handler().get_triangulation(), s.model.mapping())),
                  1e-12 * sum);
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
      for (const auto &cell : s.model.dof_handler().get_triangulation().active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && s.model.surface_ids(PhysicalNames::pin_contact).count(face->boundary_id()) > 0)
            of_straight_faces += face->measure();
      EXPECT_NEAR(on_all(of_cells), of_half_edges(on_all(of_straight_faces), of_pairs), 1e-12 * of_pairs) << to_string(element);
    }
}

TEST(Fields, HaveTheDisplacementsOfTheirPoints)
{
  const auto displacement = [](const std::array<double, 3> &x, const int d) {
    return std::sin(1. + d + 7. * x[0] - 5. * x[1] + 9. * x[2]);
  };
  constexpr double      half_a_step = 0.5 / 65536. + 1e-7; // and rounding
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
      // With growth the last picture is that of the end; without it that would be the first one again
      const auto frames = listed(folder / "animations" / "all.pvd");
      ASSERT_EQ(frames.size(), grows ? 13u : 12u);
      EXPECT_EQ(frames.back().first, (frames.size() - 1) / 4.);
      const auto first = content(folder / "animations" / frames.front().second),
                 last  = content(folder / "animations" / frames.back().second);
      if (!grows)
        without = values_of(first, "grows");
      // The largest amplitude is that without growth
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
  // Rigid-body modes, doublets equal to rounding, and one that is farther away
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
