#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/communication.h>

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

    /// Eliminates one dof of @p node from n·u = s: its other directions, and those of @p partner (s = n·u_partner) where there is one.
    void eliminate(SlaveRows &rows, const ContactNode &contact, const Node &node, const Node *partner)
    {
      const unsigned int k     = eliminated_direction(contact);
      const auto        &slave = node.dofs;
      auto              &row   = rows[slave[k]];
      for (unsigned int j = 0; j < 3; ++j)
        {
          const double ratio = contact.normal[j] / contact.normal[k];
          if (ratio == 0.)
            continue;
          if (j != k)
            row.emplace_back(slave[j], -ratio);
          if (partner != nullptr)
            row.emplace_back(partner->dofs[j], ratio);
        }
    }

    /// Columns of the masters of all slaves, whoever has them; the columns of this process begin with number @p first.
    std::map<int, int> master_columns(const RowMap &rows, const std::vector<int> &column, const int first, const SlaveRows &slaves)
    {
      std::map<int, int> result;
      for (const auto &[slave, row] : slaves)
        for (const auto &[master, coefficient] : row)
          result[master] = 0;
      std::vector<int> numbers;
      for (const auto &[master, number] : result)
        {
          const int place = rows.place(master);
          numbers.push_back(place >= 0 ? first + column[place] : 0);
        }
      sum_over_processes(rows.communicator(), numbers.data(), numbers.size());
      auto next = numbers.begin();
      for (auto &[master, number] : result)
        number = *next++;
      return result;
    }

    /// Selection of the dofs that are @p kept, of those of this process, and not slaves, with the rows of the slaves.
    std::shared_ptr<SparseMatrix> kernel_matrix(const RowMap &rows, const std::vector<bool> &kept, const SlaveRows &slaves)
    {
      // Columns keep the order and the owner of their dofs
      std::vector<int> column(kept.size(), -1);
      int              n_own = 0;
      for (unsigned int i = 0; i < kept.size(); ++i)
        if (kept[i] && slaves.count(rows.number(i)) == 0)
          column[i] = n_own++;
      const RowMap columns = RowMap(n_own, rows.communicator());
      const int    first   = n_own > 0 ? columns.number(0) : 0;
      const auto   masters = master_columns(rows, column, first, slaves);
      return std::make_shared<SparseMatrix>(rows, columns, [&](const int i, SparseMatrix::Row &row) {
        if (!kept[i])
          return;
        if (const auto slave = slaves.find(rows.number(i)); slave != slaves.end())
          for (const auto &[master, coefficient] : slave->second)
            row.emplace_back(masters.at(master), coefficient);
        else
          row.emplace_back(first + column[i], 1.);
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
              row.emplace_back(node.disc_node.dofs[k], value);
              row.emplace_back(node.pin_node.dofs[k], -value);
            }
      });
    }
  } // namespace

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface)
  {
    SlaveRows slaves;
    for (const ContactNode &contact : interface)
      eliminate(slaves, contact, contact.pin_node, &contact.disc_node);
    const auto normal = relative_displacement(model, interface, &ContactNode::normal);
    return {normal, relative_displacement(model, interface, &ContactNode::sliding),
            relative_displacement(model, interface, &ContactNode::radial),
            kernel_matrix(model.free_map(), std::vector<bool>(model.free_map().n_local(), true), slaves),
            linear_combination({{0.5, normal.get()}})};
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
    std::vector<bool> kept(model.free_map().n_local(), false);
    for (const Node &node : model.nodes())
      if (belongs_to(node, component))
        for (const int dof : node.dofs)
          if (const int i = model.free_map().place(dof); i >= 0)
            kept[i] = true;

    SlaveRows slaves;
    if (boundary == ContactBoundary::sliding)
      for (const ContactNode &contact : interface)
        for (const Node *node : {&contact.disc_node, &contact.pin_node})
          if (belongs_to(*node, component))
            eliminate(slaves, contact, *node, nullptr);
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
