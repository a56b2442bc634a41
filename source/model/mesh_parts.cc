#include <squeal/model/mesh_parts.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/cell_id.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>
#include <limits>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using Key = std::array<unsigned int, 4>; ///< vertices of a face, ascending

    struct CellFace
    {
      Key          key;
      unsigned int cell, number;
    };

    Key sorted(Key vertices)
    {
      std::sort(vertices.begin(), vertices.end());
      return vertices;
    }

    /// Faces of all cells, those that coincide side by side.
    std::vector<CellFace> all_faces(const std::vector<CellData<3>> &cells)
    {
      std::vector<CellFace> faces;
      faces.reserve(6 * cells.size());
      for (unsigned int cell = 0; cell < cells.size(); ++cell)
        for (unsigned int f = 0; f < 6; ++f)
          {
            Key key;
            for (unsigned int v = 0; v < 4; ++v)
              key[v] = cells[cell].vertices[GeometryInfo<3>::face_to_cell_vertices(f, v)];
            faces.push_back({sorted(key), cell, f});
          }
      std::sort(faces.begin(), faces.end(),
                [](const CellFace &a, const CellFace &b) { return std::make_pair(a.key, a.cell) < std::make_pair(b.key, b.cell); });
      return faces;
    }

    std::vector<std::pair<Key, types::boundary_id>> named(const SubCellData &faces)
    {
      std::vector<std::pair<Key, types::boundary_id>> result;
      for (const CellData<2> &face : faces.boundary_quads)
        result.emplace_back(sorted({{face.vertices[0], face.vertices[1], face.vertices[2], face.vertices[3]}}), face.boundary_id);
      std::sort(result.begin(), result.end());
      return result;
    }
  } // namespace

  MeshParts::MeshParts(CellLists lists, std::map<unsigned int, CellManifolds> given_manifolds, const unsigned int n_parts)
    : vertices(std::move(lists.vertices))
    , cells(std::move(lists.cells))
    , manifolds(std::move(given_manifolds))
    , owners(cells.size(), 0)
  {
    const auto neighbours = find_faces(lists.faces);
    if (n_parts == 1)
      return;
    SparsityPattern graph(cells.size(), cells.size(), 7);
    for (const auto &[a, b] : neighbours)
      {
        graph.add(a, b);
        graph.add(b, a);
      }
    graph.compress();
    SparsityTools::partition(graph, n_parts, owners);
  }

  std::vector<std::pair<unsigned int, unsigned int>> MeshParts::find_faces(const SubCellData &given)
  {
    const std::vector<CellFace>                        faces = all_faces(cells);
    const auto                                         names = named(given);
    std::vector<std::pair<unsigned int, unsigned int>> neighbours;
    for (std::size_t i = 0; i < faces.size(); ++i)
      {
        const auto name     = std::lower_bound(names.begin(), names.end(), std::make_pair(faces[i].key, types::boundary_id(0)));
        const bool is_named = name != names.end() && name->first == faces[i].key;
        if (i + 1 < faces.size() && faces[i + 1].key == faces[i].key)
          {
            AssertThrow(i + 2 >= faces.size() || faces[i + 2].key != faces[i].key, ExcMessage("more than two cells share a face"));
            AssertThrow(!is_named, ExcMessage("a face with a name lies inside a body"));
            neighbours.emplace_back(faces[i].cell, faces[i + 1].cell);
            ++i;
          }
        else if (is_named)
          named_faces[faces[i].cell].emplace_back(faces[i].number, name->second);
      }
    return neighbours;
  }

  TriangulationDescription::Description<3, 3> MeshParts::part(const unsigned int number, const MPI_Comm communicator) const
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();
    std::vector<bool>      is_near(vertices.size(), false); // vertices of own cells
    for (unsigned int cell = 0; cell < cells.size(); ++cell)
      if (owners[cell] == number)
        for (const unsigned int vertex : cells[cell].vertices)
          is_near[vertex] = true;

    TriangulationDescription::Description<3, 3> result;
    result.comm      = communicator;
    result.settings  = TriangulationDescription::default_setting;
    result.smoothing = Triangulation<3>::none;
    result.cell_infos.resize(1);
    std::vector<unsigned int> place(vertices.size(), none); // of vertices in this part
    for (unsigned int cell = 0; cell < cells.size(); ++cell)
      {
        CellData<3> data = cells[cell];
        if (std::none_of(data.vertices.begin(), data.vertices.end(), [&](const unsigned int vertex) { return is_near[vertex]; }))
          continue;
        for (unsigned int &vertex : data.vertices)
          {
            if (place[vertex] == none)
              {
                place[vertex] = result.coarse_cell_vertices.size();
                result.coarse_cell_vertices.push_back(vertices[vertex]);
              }
            vertex = place[vertex];
          }
        result.coarse_cells.push_back(data);
        result.coarse_cell_index_to_coarse_cell_id.push_back(cell);

        TriangulationDescription::CellData<3> info;
        info.id                 = CellId(cell, 0, nullptr).to_binary<3>();
        info.subdomain_id       = owners[cell];
        info.level_subdomain_id = numbers::artificial_subdomain_id;
        info.manifold_id        = numbers::flat_manifold_id;
        info.manifold_line_ids.fill(numbers::flat_manifold_id);
        info.manifold_quad_ids.fill(numbers::flat_manifold_id);
        if (const auto curved = manifolds.find(cell); curved != manifolds.end())
          {
            info.manifold_line_ids = curved->second.lines;
            info.manifold_quad_ids = curved->second.quads;
          }
        if (const auto with_names = named_faces.find(cell); with_names != named_faces.end())
          info.boundary_ids = with_names->second;
        result.cell_infos[0].push_back(info);
      }
    return result;
  }
} // namespace Squeal
