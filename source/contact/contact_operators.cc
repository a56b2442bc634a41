#include <squeal/contact/contact_operators.h>

#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// u_slave = Σ coefficient u_master: (master, coefficient) of each slave, in numbers of free dofs.
    using SlaveRows = std::map<int, std::vector<std::pair<int, double>>>;

    /// Direction in which a node is eliminated: the coordinate axis nearest to the normal.
    unsigned int eliminated_direction(const ContactNode &node)
    {
      unsigned int k;
      node.normal.cwiseAbs().maxCoeff(&k);
      return k;
    }

    /**
     * Eliminates one dof of @p node_number from n·u = s: its other directions,
     * and those of @p partner (s = n·u_partner) where there is one.
     */
    void eliminate(SlaveRows &rows, const Model &model, const ContactNode &contact, const unsigned int node_number, const int partner)
    {
      const unsigned int k     = eliminated_direction(contact);
      const auto        &slave = model.nodes()[node_number].dofs;
      auto              &row   = rows[slave[k]];
      for (unsigned int j = 0; j < 3; ++j)
        {
          const double ratio = contact.normal[j] / contact.normal[k];
          if (ratio == 0.)
            continue;
          if (j != k)
            row.emplace_back(slave[j], -ratio);
          if (partner >= 0)
            row.emplace_back(model.nodes()[partner].dofs[j], ratio);
        }
    }

    /// Selection of the dofs that are @p kept and not slaves, with the rows of the slaves.
    std::shared_ptr<SparseMatrix> kernel_matrix(const RowMap &rows, const std::vector<bool> &kept, const SlaveRows &slaves)
    {
      // Columns keep the order and the owner of their dofs
      std::vector<int> column(kept.size(), -1);
      int              n_columns = 0, n_own = 0;
      for (unsigned int dof = 0; dof < kept.size(); ++dof)
        if (kept[dof] && slaves.count(dof) == 0)
          {
            column[dof] = n_columns++;
            n_own += rows.place(static_cast<int>(dof)) >= 0;
          }
      return std::make_shared<SparseMatrix>(rows, RowMap::contiguous(n_own, rows.communicator()), [&](const int i, SparseMatrix::Row &row) {
        const int dof = rows.number(i);
        if (!kept[dof])
          return;
        if (const auto slave = slaves.find(dof); slave != slaves.end())
          for (const auto &[master, coefficient] : slave->second)
            row.emplace_back(column[master], coefficient);
        else
          row.emplace_back(column[dof], 1.);
      });
    }

    /// Rows v_c·(u_D − u_P) for the vector v of each contact node that @p direction picks.
    std::shared_ptr<SparseMatrix> relative_displacement(const Model            &model,
                                                        const ContactInterface &interface,
                                                        const Eigen::Vector3d ContactNode::*const direction)
    {
      const RowMap rows = RowMap::even(interface.size(), model.communicator());
      return std::make_shared<SparseMatrix>(rows, model.free_map(), [&](const int i, SparseMatrix::Row &row) {
        const ContactNode &node = interface[rows.number(i)];
        for (unsigned int k = 0; k < 3; ++k)
          if (const double value = (node.*direction)[k]; value != 0.)
            {
              row.emplace_back(model.nodes()[node.disc_node].dofs[k], value);
              row.emplace_back(model.nodes()[node.pin_node].dofs[k], -value);
            }
      });
    }
  } // namespace

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface)
  {
    SlaveRows slaves;
    for (const ContactNode &contact : interface)
      eliminate(slaves, model, contact, contact.pin_node, contact.disc_node);
    return {relative_displacement(model, interface, &ContactNode::normal), relative_displacement(model, interface, &ContactNode::sliding),
            relative_displacement(model, interface, &ContactNode::radial),
            kernel_matrix(model.free_map(), std::vector<bool>(model.free_map().n(), true), slaves)};
  }

  bool belongs_to(const Node &node, const Component component)
  {
    return (node.component == 0) == (component == Component::disc);
  }

  std::shared_ptr<SparseMatrix> component_kernel(const Model            &model,
                                                 const ContactInterface &interface,
                                                 const Component         component,
                                                 const ContactBoundary   boundary)
  {
    std::vector<bool> kept(model.free_map().n(), false);
    for (const Node &node : model.nodes())
      if (belongs_to(node, component))
        for (const int dof : node.dofs)
          if (dof >= 0)
            kept[dof] = true;

    SlaveRows slaves;
    if (boundary == ContactBoundary::sliding)
      for (const ContactNode &contact : interface)
        for (const unsigned int node : {contact.disc_node, contact.pin_node})
          if (belongs_to(model.nodes()[node], component))
            eliminate(slaves, model, contact, node, -1);
    return kernel_matrix(model.free_map(), kept, slaves);
  }

  MultiVector coordinates(const SparseMatrix &T, const MultiVector &u)
  {
    // Columns keep the order and the owner of the dofs that they select; a slave that equals the dof selected next does as well.
    const RowMap     &columns = T.columns();
    MultiVector       q(columns, u.n_columns());
    SparseMatrix::Row row;
    int               next = 0;
    for (int i = 0; i < T.rows().n_local() && next < columns.n_local(); ++i)
      {
        T.get_row(i, row);
        if (row.size() == 1 && row[0] == std::make_pair(columns.number(next), 1.))
          q.local().row(next++) = u.local().row(i);
      }
    return q;
  }
} // namespace Squeal
