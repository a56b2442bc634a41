#include <squeal/output/field_mesh.h>

#include <deal.II/fe/fe_tools.h>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using ActiveCell = DoFHandler<3>::active_cell_iterator;
    using Places     = std::vector<unsigned int>; // of nodes among those of the model

    /// Corners of a square in the order of VTK.
    constexpr unsigned int square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    /// Appends the p³ hexahedra of a cell.
    void add_hexahedra(const Places &nodes, const unsigned int degree, Places &corners)
    {
      const unsigned int n = degree + 1;
      for (unsigned int z = 0; z < degree; ++z)
        for (unsigned int y = 0; y < degree; ++y)
          for (unsigned int x = 0; x < degree; ++x)
            for (unsigned int up = 0; up < 2; ++up)
              for (const auto &[right, back] : square)
                corners.push_back(nodes[x + right + n * (y + back + n * (z + up))]);
    }

    /// Appends the p² quadrilaterals of a face of a cell, numbered like those of deal.II.
    void add_quadrilaterals(const Places &nodes, const unsigned int degree, const unsigned int face, Places &corners)
    {
      const unsigned int n       = degree + 1;
      const unsigned int step[3] = {1, n, n * n};
      const unsigned int normal = face / 2, is_far = face % 2;
      const unsigned int origin = is_far * degree * step[normal];
      const unsigned int along = step[(normal + 2 - is_far) % 3], across = step[(normal + 1 + is_far) % 3];
      for (unsigned int j = 0; j < degree; ++j)
        for (unsigned int i = 0; i < degree; ++i)
          for (const auto &[right, back] : square)
            corners.push_back(nodes[origin + (i + right) * along + (j + back) * across]);
    }

    /// Numbers vertices in the order of the cells. @p add(cell, nodes, corners) appends the corners of what a file has of a cell, from its
    /// (p + 1)³ nodes, x fastest.
    template <typename Add>
    FieldMesh mesh_of(const Model &model, const unsigned int n_corners, const Add &add)
    {
      const auto                           order = FETools::lexicographic_to_hierarchic_numbering<3>(model.degree());
      std::vector<types::global_dof_index> dofs(model.dof_handler().get_fe().n_dofs_per_cell());
      std::vector<std::int32_t>            numbers(model.nodes().size(), -1);
      FieldMesh                            mesh{n_corners, {}, {}, {}};
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            Places nodes, corners;
            cell->get_dof_indices(dofs);
            for (const unsigned int i : order)
              nodes.push_back(model.node_of_dof(dofs[cell->get_fe().component_to_system_index(0, i)]));
            add(cell, nodes, corners);
            for (const unsigned int node : corners)
              {
                if (numbers[node] < 0)
                  {
                    numbers[node] = static_cast<std::int32_t>(mesh.nodes.size());
                    mesh.nodes.push_back(model.nodes()[node]);
                  }
                mesh.cells.push_back(numbers[node]);
              }
            mesh.components.resize(mesh.cells.size() / n_corners, static_cast<std::int32_t>(cell->material_id()));
          }
      return mesh;
    }

    /// Of faces at the boundary whose id is @p wanted.
    template <typename Wanted>
    FieldMesh face_mesh(const Model &model, const Wanted &wanted)
    {
      return mesh_of(model, 4, [&](const ActiveCell &cell, const Places &nodes, Places &corners) {
        for (const unsigned int face : cell->face_indices())
          if (cell->face(face)->at_boundary() && wanted(cell->face(face)->boundary_id()))
            add_quadrilaterals(nodes, model.degree(), face, corners);
      });
    }
  } // namespace

  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component)
  {
    return mesh_of(model, 8, [&](const ActiveCell &cell, const Places &nodes, Places &corners) {
      if (!component || (cell->material_id() == 0) == (*component == Component::disc))
        add_hexahedra(nodes, model.degree(), corners);
    });
  }

  FieldMesh surface_mesh(const Model &model)
  {
    return face_mesh(model, [](types::boundary_id) { return true; });
  }

  FieldMesh contact_face_mesh(const Model &model)
  {
    const auto &ids = model.surface_ids(PhysicalNames::pin_contact);
    return face_mesh(model, [&](const types::boundary_id id) { return ids.count(id) > 0; });
  }
} // namespace Squeal
