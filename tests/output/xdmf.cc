#include "files.h"
#include "scenes.h"

#include <squeal/base/exceptions.h>
#include <squeal/output/field_mesh.h>
#include <squeal/output/hdf5_file.h>
#include <squeal/output/xdmf_writer.h>

#include <deal.II/base/hdf5.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
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

  /// A disc of 24 cells with one pin.
  struct SmallBrake : Scene
  {
    explicit SmallBrake(const Element element)
      : Scene(extrude(polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 2, 0, 1}}), layers(1, 1)), mounted(), operating(), element)
    {}
  };

  /// An empty folder that is removed at the end.
  struct TemporaryFolder
  {
    TemporaryFolder()
      : place(fs::temp_directory_path() / ("squeal_xdmf_test_" + std::to_string(getpid())))
    {
      fs::create_directories(place);
    }
    ~TemporaryFolder()
    {
      fs::remove_all(place);
    }
    const fs::path place;
  };
} // namespace

TEST(FieldMeshes, CellsFillTheBodiesAndShareVertices)
{
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      const SmallBrake   s(element);
      const unsigned int p = s.model.degree();
      const FieldMesh all = body_mesh(s.model, {}), disc = body_mesh(s.model, Component::disc), pins = body_mesh(s.model, Component::pins);
      EXPECT_EQ(all.nodes.size(), s.model.nodes().size());
      EXPECT_EQ(all.n_cells(), s.model.triangulation().n_active_cells() * p * p * p);
      EXPECT_EQ(disc.n_cells(), 24 * p * p * p);
      EXPECT_EQ(disc.n_cells() + pins.n_cells(), all.n_cells());
      EXPECT_EQ(disc.nodes.size() + pins.nodes.size(), all.nodes.size());

      double sum = 0.;
      for (unsigned int cell = 0; cell < all.n_cells(); ++cell)
        {
          const double v = volume(corners(all, cell));
          EXPECT_GT(v, 0.);
          sum += v;
          for (unsigned int vertex = 0; vertex < 8; ++vertex)
            EXPECT_EQ(all.nodes[all.cells[8 * cell + vertex]].component, static_cast<unsigned int>(all.components[cell]));
        }
      EXPECT_NEAR(sum,
                  of_half_edges(dealii::GridTools::volume(s.model.triangulation()),
                                dealii::GridTools::volume(s.model.triangulation(), s.model.mapping())),
                  1e-12 * sum);
    }
}

TEST(FieldMeshes, ContactFacesHaveTheAreaOfThePairs)
{
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const SmallBrake   s(element);
      const unsigned int p    = s.model.degree();
      const FieldMesh    mesh = contact_face_mesh(s.model, s.interface);
      EXPECT_EQ(mesh.nodes.size(), s.interface.size());
      double of_cells = 0., of_pairs = 0., of_straight_faces = 0.;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        of_cells += area(corners(mesh, cell));
      for (const ContactNode &pair : s.interface)
        of_pairs += pair.area;
      EXPECT_EQ(mesh.n_cells() % (p * p), 0u);
      for (const auto &cell : s.model.triangulation().active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && s.model.surface_ids(PhysicalNames::pin_contact).count(face->boundary_id()) > 0)
            of_straight_faces += face->measure();
      EXPECT_NEAR(of_cells, of_half_edges(of_straight_faces, of_pairs), 1e-12 * of_pairs) << to_string(element);
      EXPECT_EQ(std::set<std::int32_t>(mesh.components.begin(), mesh.components.end()), (std::set<std::int32_t>{1}));
      EXPECT_EQ(std::set<std::int32_t>(mesh.cells.begin(), mesh.cells.end()).size(), s.interface.size()) << "every node is a corner";
    }
}

TEST(Hdf5Files, AreReadByAnotherLibrary)
{
  // Parts of any length: a chunk may be spread over processes, and a process may have nothing
  const int                 n_processes = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const int                 me          = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const int                 n           = 200000; // more than one chunk
  const TemporaryFolder     folder;
  const std::string         file = (folder.place / "fields.h5").string();
  std::vector<float>        values;
  std::vector<std::int32_t> numbers;
  for (int i = 0; i < 3 * n; ++i)
    {
      values.push_back(std::sin(i));
      numbers.push_back((i % 40000) * (i % 40000));
    }
  for (const auto &ends : {std::vector<int>{50000, 50007, n, n}, std::vector<int>{0, 150000, 150000, n}})
    {
      const int begin = me == 0 ? 0 : ends[me - 1], end = me + 1 == n_processes ? n : ends[me];
      {
        Hdf5File writer(file, "fields.h5", MPI_COMM_WORLD);
        writer.add("deep/inside/values", std::vector<float>(values.begin() + 3 * begin, values.begin() + 3 * end), 3);
        writer.add("numbers", std::vector<std::int32_t>(numbers.begin() + begin, numbers.begin() + end));
        writer.describe("mode", "A0-4 +, µ");
        writer.close();
      }
      if (me != 0)
        continue;
      EXPECT_LT(fs::file_size(file), 4 * (values.size() + n));
      dealii::HDF5::File reader(file, dealii::HDF5::File::FileAccessMode::open);
      const auto         deep = reader.open_dataset("deep/inside/values");
      EXPECT_EQ(deep.get_dimensions(), (std::vector<hsize_t>{n, 3}));
      const auto read = reader.open_dataset("deep/inside/values").read<dealii::FullMatrix<float>>();
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < 3; ++j)
          ASSERT_EQ(read(i, j), values[3 * i + j]);
      EXPECT_EQ(reader.open_dataset("numbers").read<std::vector<int>>(), std::vector<int>(numbers.begin(), numbers.begin() + n));
      EXPECT_EQ(reader.get_attribute<std::string>("mode"), "A0-4 +, µ");
    }
}

TEST(Hdf5Files, KeepWhatDoesNotShrink)
{
  // Random bits, which the filter would make longer
  const TemporaryFolder     folder;
  const std::string         file = (folder.place / "noise.h5").string();
  std::vector<std::int32_t> noise;
  std::uint64_t             state = 1;
  for (int i = 0; i < 1000; ++i)
    {
      state = 6364136223846793005u * state + 1442695040888963407u;
      noise.push_back(static_cast<std::int32_t>(state >> 32));
    }
  const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  Hdf5File   writer(file, "noise.h5", MPI_COMM_WORLD);
  writer.add("noise", is_root ? noise : std::vector<std::int32_t>());
  writer.close();
  if (!is_root)
    return;
  dealii::HDF5::File reader(file, dealii::HDF5::File::FileAccessMode::open);
  EXPECT_EQ(reader.open_dataset("noise").read<std::vector<int>>(), noise);
}

TEST(Hdf5Files, NameTheCauseWhereTheyCannotBeWritten)
{
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "process 0 alone throws";
  try
    {
      Hdf5File("/nowhere/fields.h5", "results/fields.h5", MPI_COMM_WORLD);
      FAIL();
    }
  catch (const FileError &error)
    {
      EXPECT_NE(std::string(error.what()).find("results/fields.h5"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
    }
}

TEST(XdmfFields, ListsNameModesThatWereWritten)
{
  const TemporaryFolder folder;
  const std::string     results = (folder.place / "results").string();
  const SmallBrake      s(Element::trilinear);
  {
    ResultFolder              place(results, true);
    XdmfWriter                writer(s.model, s.interface, {0}, place);
    const std::vector<double> u(s.model.free_map().n(), -3.);
    writer.write_mode(RealModeField{"one", "real mode <1> & \"more\"", u, {}});
    writer.write_mode(RealModeField{"two", "real mode 2", u, {}});
    writer.write_list("modes", {{"one", 500.}, {"two", 500.}});
    EXPECT_THROW(writer.write_list("other", {{"three", 1.}}), std::out_of_range);
    place.write(ResultFolder::run_record, [](std::ostream &stream) { stream << "{}"; });
    place.commit();
  }
  const std::string list = content(results + "/modes.xdmf");
  EXPECT_NE(list.find("real mode &lt;1&gt; &amp; &quot;more&quot;"), std::string::npos) << list.substr(0, 600);
  EXPECT_NE(list.find("modes/two.h5:/displacement"), std::string::npos);
  EXPECT_NE(list.find("Value=\"500\""), std::string::npos);
  EXPECT_NE(list.find("Value=\"500.000501\""), std::string::npos);
  dealii::HDF5::File mode(results + "/modes/one.h5", dealii::HDF5::File::FileAccessMode::open);
  const auto         field = mode.open_dataset("displacement").read<dealii::FullMatrix<float>>();
  ASSERT_EQ(field.m(), s.model.nodes().size());
  float smallest = 0.;
  for (unsigned int i = 0; i < field.m(); ++i)
    for (unsigned int j = 0; j < 3; ++j)
      smallest = std::min(smallest, field(i, j));
  EXPECT_EQ(smallest, -1.f);
}
