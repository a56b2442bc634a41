#pragma once

#include <squeal/base/choices.h>
#include <squeal/geometry/hex_mesh.h>
#include <squeal/linear_algebra/row_map.h>
#include <squeal/parameters/materials.h>

#include <boost/serialization/array.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

// Whoever asks for these includes deal.II's headers, which take seconds to read
namespace dealii
{
  template <int, int>
  class DoFHandler;
  template <int, int>
  class Mapping;
} // namespace dealii

namespace Squeal
{
  /// One finite element node: a support point of the displacement, with its three dofs.
  struct Node
  {
    std::array<double, 3> position;  ///< [m]
    std::array<int, 3>    dofs;      ///< numbers among the free dofs; -1 where clamped
    unsigned int          component; ///< 0: the disc; k ≥ 1: pin k
    std::int64_t          number;    ///< tells the nodes of all processes apart; ascends in the order of the cells
    bool                  is_own;    ///< every node is that of one process, which has the rows of its dofs

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &position &dofs &component &number &is_own;
    }
  };

  /**
   * The discretised bodies: a mesh whose cells know their component and whose
   * faces know their surface, the displacement dofs, and their numbering
   * without the clamped ones, which never reach a matrix.
   *
   * Mesh, dofs and matrices are distributed: a process has its cells and those around them, all cells that meet at a node of its own
   * among them. Process 0 makes the parts.
   */
  class Model
  {
  public:
    /**
     * @param mesh      hexahedra with named parts; other processes than 0 need the names only
     * @param element   quadratic ones follow named cylindrical surfaces about axes parallel to z
     * @param communicator processes that share the work
     *
     * Throws MeshError, on all processes, if deal.II refuses the mesh.
     */
    Model(const HexMesh &mesh, Element element, MPI_Comm communicator);
    ~Model();

    const dealii::DoFHandler<3, 3> &dof_handler() const;
    const dealii::Mapping<3, 3>    &mapping() const;

    Element element() const
    {
      return element_type;
    }

    /// Polynomial degree of the nodal displacements.
    unsigned int degree() const
    {
      return degree_of(element_type);
    }

    MPI_Comm communicator() const
    {
      return processes;
    }

    /// Names of the components, in the order of the cells' material ids.
    const std::vector<std::string> &component_names() const
    {
      return components;
    }

    /// Nodes of the cells that this process has, in the order of these.
    const std::vector<Node> &nodes() const
    {
      return node_table;
    }

    /// Nodes of all processes in the order of their numbers, on process 0: for files of small models.
    std::vector<Node> gathered_nodes() const;

    /// Place among nodes() of the node of a dof of deal.II's numbering, one of the cells that this process has.
    unsigned int node_of_dof(std::size_t dof) const;

    /// Boundary ids of the faces of a named surface, one for each combination of names that they bear; throws MeshError naming the
    /// known surfaces if there is none of this name.
    const std::set<unsigned int> &surface_ids(const std::string &name) const;

    bool has_surface(const std::string &name) const;

    /// Distribution of the free dofs.
    const RowMap &free_map() const
    {
      return map;
    }

    /// Number of a deal.II dof, one of the cells that this process has, among the free ones of all processes; -1 where clamped.
    int free_dof(std::size_t dof) const;

    /// Number of all dofs, clamped ones included.
    unsigned int n_dofs() const;

  private:
    struct Discretisation;

    void create_triangulation(const HexMesh &mesh);
    void number_free_dofs();
    void find_nodes();

    std::vector<std::string>            components, surfaces;
    std::vector<std::set<unsigned int>> ids_of_surfaces;
    Element                             element_type;
    MPI_Comm                            processes;
    std::unique_ptr<Discretisation>     discretisation;
    std::vector<int>                    free_numbers; ///< of the dofs of the cells that this process has
    std::vector<unsigned int>           dof_nodes;    ///< of these
    std::vector<Node>                   node_table;
    RowMap                              map;
  };
} // namespace Squeal
