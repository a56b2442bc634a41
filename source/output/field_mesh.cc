#include <squeal/output/field_mesh.h>

#include <deal.II/fe/fe_tools.h>

#include <array>
#include <map>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Numbers of nodes on a grid of cells of degree p, (p + 1)^dim of them, x fastest.
    class CellNodes
    {
    public:
      explicit CellNodes(const Model &model)
        : model(model)
        , degree(model.degree())
        , order(FETools::lexicographic_to_hierarchic_numbering<3>(degree))
        , dofs(model.dof_handler().get_fe().n_dofs_per_cell())
        , nodes(order.size())
      {}

      const std::vector<unsigned int> &of(const DoFHandler<3>::active_cell_iterator &cell)
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          nodes[i] = model.node_of_dof(dofs[cell->get_fe().component_to_system_index(0, order[i])]);
        return nodes;
      }

    private:
      const Model                         &model;
      const unsigned int                   degree;
      const std::vector<unsigned int>      order;
      std::vector<types::global_dof_index> dofs;
      std::vector<unsigned int>            nodes;
    };

    /// Corners of a square in the order of VTK.
    constexpr unsigned int square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    /// Appends the p³ hexahedra of a cell.
    void add_hexahedra(const std::vector<unsigned int> &nodes, const unsigned int degree, std::vector<unsigned int> &cells)
    {
      const unsigned int n = degree + 1;
      for (unsigned int z = 0; z < degree; ++z)
        for (unsigned int y = 0; y < degree; ++y)
          for (unsigned int x = 0; x < degree; ++x)
            for (unsigned int up = 0; up < 2; ++up)
              for (const auto &[right, back] : square)
                cells.push_back(nodes[x + right + n * (y + back + n * (z + up))]);
    }

    /// Appends the p² quadrilaterals of a face of a cell, numbered like those of deal.II.
    void add_quadrilaterals(const std::vector<unsigned int> &nodes,
                            const unsigned int               degree,
                            const unsigned int               face,
                            std::vector<unsigned int>       &cells)
    {
      const unsigned int n       = degree + 1;
      const unsigned int step[3] = {1, n, n * n};
      const unsigned int normal = face / 2, along = step[(normal + 1) % 3], across = step[(normal + 2) % 3];
      const unsigned int origin = face % 2 == 0 ? 0 : degree * step[normal];
      for (unsigned int j = 0; j < degree; ++j)
        for (unsigned int i = 0; i < degree; ++i)
          for (const auto &[right, back] : square)
            cells.push_back(nodes[origin + (i + right) * along + (j + back) * across]);
    }
  } // namespace

  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component)
  {
    FieldMesh                 mesh;
    std::vector<unsigned int> cells;
    CellNodes                 cell_nodes(model);
    mesh.corners = 8;
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      if (!component || (cell->material_id() == 0) == (*component == Component::disc))
        {
          add_hexahedra(cell_nodes.of(cell), model.degree(), cells);
          mesh.components.resize(cells.size() / mesh.corners, cell->material_id());
        }

    std::vector<std::int32_t> place(model.nodes().size(), -1);
    for (const unsigned int node : cells)
      {
        if (place[node] < 0)
          {
            place[node] = mesh.nodes.size();
            mesh.nodes.push_back(node);
          }
        mesh.cells.push_back(place[node]);
      }
    return mesh;
  }

  FieldMesh contact_face_mesh(const Model &model, const ContactInterface &interface)
  {
    FieldMesh                            mesh;
    std::map<unsigned int, std::int32_t> place;
    for (unsigned int c = 0; c < interface.size(); ++c)
      {
        mesh.nodes.push_back(interface[c].pin_node);
        place[interface[c].pin_node] = c;
      }

    std::vector<unsigned int> cells;
    CellNodes                 cell_nodes(model);
    const types::boundary_id  id = model.surface_id(PhysicalNames::pin_contact);
    mesh.corners                 = 4;
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      for (const unsigned int face : cell->face_indices())
        if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == id)
          {
            add_quadrilaterals(cell_nodes.of(cell), model.degree(), face, cells);
            mesh.components.resize(cells.size() / mesh.corners, cell->material_id());
          }
    for (const unsigned int node : cells)
      mesh.cells.push_back(place.at(node));
    return mesh;
  }
} // namespace Squeal
