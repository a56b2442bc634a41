#include <squeal/contact/contact_operators.h>

#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// u_slave = Σ coefficient u_master, in numbers of free dofs.
    struct SlaveRow
    {
      std::vector<int>    masters;
      std::vector<double> coefficients;
    };
    using SlaveRows = std::map<int, SlaveRow>;

    /// Direction in which a node is eliminated: the coordinate axis nearest to the normal.
    unsigned int eliminated_direction(const ContactNode &node)
    {
      unsigned int k = 0;
      for (unsigned int j = 1; j < 3; ++j)
        if (std::abs(node.normal[j]) > std::abs(node.normal[k]))
          k = j;
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
      SlaveRow          &row   = rows[slave[k]];
      for (unsigned int j = 0; j < 3; ++j)
        {
          const double ratio = contact.normal[j] / contact.normal[k];
          if (ratio == 0.)
            continue;
          if (j != k)
            {
              row.masters.push_back(slave[j]);
              row.coefficients.push_back(-ratio);
            }
          if (partner >= 0)
            {
              row.masters.push_back(model.nodes()[partner].dofs[j]);
              row.coefficients.push_back(ratio);
            }
        }
    }

    /// Selection of the dofs that are @p kept and not slaves, with the rows of the slaves.
    std::shared_ptr<SparseMatrix> kernel_matrix(const Epetra_Map &rows, const std::vector<bool> &kept, const SlaveRows &slaves)
    {
      // Columns keep the order and the owner of their dofs
      std::vector<int> column(kept.size(), -1);
      int              n_columns = 0, n_own = 0;
      for (unsigned int dof = 0; dof < kept.size(); ++dof)
        if (kept[dof] && slaves.count(dof) == 0)
          {
            column[dof] = n_columns++;
            n_own += rows.MyGID(static_cast<int>(dof));
          }
      const Epetra_Map domain(n_columns, n_own, 0, rows.Comm());

      auto         T   = std::make_shared<SparseMatrix>(Copy, rows, 2);
      const double one = 1.;
      for (int i = 0; i < rows.NumMyElements(); ++i)
        {
          const int dof = rows.GID(i);
          if (!kept[dof])
            continue;
          if (const auto slave = slaves.find(dof); slave != slaves.end())
            for (unsigned int m = 0; m < slave->second.masters.size(); ++m)
              T->InsertGlobalValues(dof, 1, &slave->second.coefficients[m], &column[slave->second.masters[m]]);
          else
            T->InsertGlobalValues(dof, 1, &one, &column[dof]);
        }
      T->FillComplete(domain, rows);
      return T;
    }

    /// Rows v_c·(u_D − u_P) for the vector v of each contact node that @p direction picks.
    std::shared_ptr<SparseMatrix> relative_displacement(const Model                &model,
                                                        const ContactInterface     &interface,
                                                        const std::array<double, 3> ContactNode::*const direction)
    {
      const Epetra_Map rows(static_cast<int>(interface.size()), 0, model.free_map().Comm());
      auto             P = std::make_shared<SparseMatrix>(Copy, rows, 6);
      for (int i = 0; i < rows.NumMyElements(); ++i)
        {
          const int          c    = rows.GID(i);
          const ContactNode &node = interface[c];
          for (unsigned int k = 0; k < 3; ++k)
            if (const double value = (node.*direction)[k]; value != 0.)
              {
                const double minus_value = -value;
                P->InsertGlobalValues(c, 1, &value, &model.nodes()[node.disc_node].dofs[k]);
                P->InsertGlobalValues(c, 1, &minus_value, &model.nodes()[node.pin_node].dofs[k]);
              }
        }
      P->FillComplete(model.free_map(), rows);
      return P;
    }
  } // namespace

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface)
  {
    SlaveRows slaves;
    for (const ContactNode &contact : interface)
      eliminate(slaves, model, contact, contact.pin_node, contact.disc_node);
    return {relative_displacement(model, interface, &ContactNode::normal), relative_displacement(model, interface, &ContactNode::sliding),
            relative_displacement(model, interface, &ContactNode::radial),
            kernel_matrix(model.free_map(), std::vector<bool>(model.free_map().NumGlobalElements(), true), slaves)};
  }

  std::shared_ptr<SparseMatrix> component_kernel(const Model             &model,
                                                 const ContactInterface  &interface,
                                                 const std::vector<bool> &selected,
                                                 const ContactBoundary    boundary)
  {
    std::vector<bool> kept(model.free_map().NumGlobalElements(), false);
    for (const Node &node : model.nodes())
      if (selected[node.component])
        for (const int dof : node.dofs)
          if (dof >= 0)
            kept[dof] = true;

    SlaveRows slaves;
    if (boundary == ContactBoundary::sliding)
      for (const ContactNode &contact : interface)
        for (const unsigned int node : {contact.disc_node, contact.pin_node})
          if (selected[model.nodes()[node].component])
            eliminate(slaves, model, contact, node, -1);
    return kernel_matrix(model.free_map(), kept, slaves);
  }

  MultiVector coordinates(const SparseMatrix &T, const MultiVector &u)
  {
    // Columns keep the order and the owner of the dofs that they select; a slave that equals the dof selected next does as well.
    const Epetra_Map &columns = T.DomainMap();
    MultiVector       q(columns, u.NumVectors());
    int               next = 0;
    for (int i = 0; i < T.NumMyRows() && next < columns.NumMyElements(); ++i)
      {
        int     n_entries;
        double *values;
        int    *entries;
        T.ExtractMyRowView(i, n_entries, values, entries);
        if (n_entries == 1 && values[0] == 1. && T.GCID(entries[0]) == columns.GID(next))
          {
            for (int j = 0; j < u.NumVectors(); ++j)
              q[j][next] = u[j][i];
            ++next;
          }
      }
    return q;
  }
} // namespace Squeal
