#pragma once

#include <squeal/base/element.h>
#include <squeal/geometry/hex_mesh.h>
#include <squeal/linear_algebra/row_map.h>
#include <squeal/parameters/materials.h>

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// One finite element node: a support point of the displacement, with its three dofs.
  struct Node
  {
    std::array<double, 3> position;  ///< [m]
    std::array<int, 3>    dofs;      ///< numbers among the free dofs; -1 where clamped
    unsigned int          component; ///< 0: the disc; k ≥ 1: pin k
  };

  /**
   * The discretised bodies: a mesh whose cells know their component and whose
   * faces know their surface, the displacement dofs, and their numbering
   * without the clamped ones, which never reach a matrix.
   *
   * The mesh is present on every process; dofs and matrices are distributed.
   */
  class Model
  {
  public:
    /**
     * @param mesh      hexahedra with named parts
     * @param element   quadratic ones follow named cylindrical surfaces about axes parallel to z
     * @param communicator processes that share the work
     *
     * Throws MeshError if deal.II refuses the mesh.
     */
    Model(const HexMesh &mesh, Element element, MPI_Comm communicator);

    const dealii::Triangulation<3> &triangulation() const;
    const dealii::DoFHandler<3>    &dof_handler() const;
    const dealii::Mapping<3>       &mapping() const;
    Element                         element() const;

    /// Polynomial degree of the nodal displacements.
    unsigned int degree() const;

    MPI_Comm communicator() const;

    /// Names of the components, in the order of the cells' material ids.
    const std::vector<std::string> &component_names() const;

    /// All nodes, the same on every process.
    const std::vector<Node> &nodes() const;

    /// Node of a dof of deal.II's numbering.
    unsigned int node_of_dof(dealii::types::global_dof_index dof) const;

    /// Boundary id of a named surface; throws MeshError naming the known ones if there is none.
    dealii::types::boundary_id surface_id(const std::string &name) const;

    bool has_surface(const std::string &name) const;

    /// Distribution of the free dofs.
    const RowMap &free_map() const;

    /// Number of a deal.II dof among the free ones; -1 where clamped.
    int free_dof(dealii::types::global_dof_index dof) const;

    /// Number of all dofs, clamped ones included.
    unsigned int n_dofs() const;

  private:
    void create_triangulation(const HexMesh &mesh);
    void distribute_dofs();

    std::vector<std::string>                   components, surfaces;
    Element                                    element_type;
    dealii::parallel::shared::Triangulation<3> tria;
    dealii::FESystem<3>                        fe;
    dealii::MappingQ<3>                        geometry_mapping;
    dealii::DoFHandler<3>                      dofs;
    std::vector<int>                           free_numbers;
    std::vector<unsigned int>                  dof_nodes;
    std::vector<Node>                          node_table;
    RowMap                                     map;
  };
} // namespace Squeal
