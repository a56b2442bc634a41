// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/slave_rows.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// Displacement component that is eliminated at a node: the coordinate axis closest to the normal.
    unsigned int eliminated_direction(const ContactNode &node)
    {
      unsigned int k;
      node.normal.cwiseAbs().maxCoeff(&k);
      return k;
    }

    /// Solves n·(Σ w u of @p own − Σ w u of @p partners) = 0 for one dof of @p node, which is in @p own, in terms of the other dofs.
    void eliminate(SlaveRows &rows, const ContactNode &contact, const Node &node, const WeightedNodes &own, const WeightedNodes &partners)
    {
      const unsigned int k    = eliminated_direction(contact);
      const auto         self = std::find_if(own.begin(), own.end(), [&](const WeightedNode &w) { return w.node.number == node.number; });
      auto              &row  = rows[node.dofs[k]];
      for (const auto &[nodes, sign] : {std::make_pair(&own, -1.), std::make_pair(&partners, 1.)})
        for (const auto &[other, weight] : *nodes)
          for (unsigned int j = 0; j < 3; ++j)
            if (const double ratio = contact.normal[j] / contact.normal[k]; ratio != 0. && other.dofs[j] != node.dofs[k])
              row.emplace_back(other.dofs[j], sign * weight / self->weight * ratio);
    }

    void resolve_contact(SlaveRows &rows)
    {
      if (!resolve(rows)) // slaves may depend on slaves: edge and corner nodes of quadratic faces
        throw MeshError("contact nodes depend on each other circularly", "contact surfaces, parameter Contact/Pairs",
                        "change positions or meshes of the contact faces so that they overlap by whole elements");
    }

    /// Column numbers of the masters of all slaves, obtained from their owners; the columns of this process start at @p first.
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

    /// Matrix from independent dofs to all dofs: unit rows for @p kept dofs that are not slaves, rows of @p slaves, and zero rows.
    std::shared_ptr<SparseMatrix> kernel_matrix(const RowMap &rows, const std::vector<bool> &kept, const SlaveRows &slaves)
    {
      // Columns have the order and owners of their dofs
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

    /// Matrix with one row for each contact node, set by @p fill(node, row).
    template <typename Fill>
    std::shared_ptr<SparseMatrix> contact_rows(const Model &model, const ContactInterface &interface, const Fill &fill)
    {
      const RowMap rows = RowMap::even(interface.size(), model.communicator());
      return std::make_shared<SparseMatrix>(rows, model.free_map(),
                                            [&](const int i, SparseMatrix::Row &row) { fill(interface[rows.number(i)], row); });
    }

    /// Adds @p factor times v·Σ weight u of the nodes to a row.
    void add_along(const Eigen::Vector3d &v, const WeightedNodes &nodes, const double factor, SparseMatrix::Row &row)
    {
      for (unsigned int k = 0; k < 3; ++k)
        if (v[k] != 0.)
          for (const auto &[node, weight] : nodes)
            row.emplace_back(node.dofs[k], factor * weight * v[k]);
    }

    /// Rows v_c·(u_D − u_P) with the vector v = @p direction(node) of each contact node.
    template <typename Direction>
    std::shared_ptr<SparseMatrix> relative_displacement(const Model &model, const ContactInterface &interface, const Direction &direction)
    {
      return contact_rows(model, interface, [direction](const ContactNode &node, SparseMatrix::Row &row) {
        const Eigen::Vector3d v = direction(node);
        add_along(v, node.on_disc, 1., row);
        add_along(v, node.on_pin, -1., row);
      });
    }

    std::shared_ptr<const SparseMatrix> reaction(const Model &model, const ContactInterface &interface)
    {
      const bool all_pairs = std::all_of(interface.begin(), interface.end(), [](const ContactNode &node) { return node.is_pair(); });
      return contact_rows(model, interface, [all_pairs](const ContactNode &node, SparseMatrix::Row &row) {
        if (!node.is_rigid())
          return;
        if (all_pairs)
          add_along(node.normal, node.on_disc, 0.5, row);
        add_along(node.normal, node.forces_of_pin, all_pairs ? -0.5 : -1., row);
      });
    }

    std::vector<ContactSpring> springs(const Model &model, const ContactInterface &interface, const SparseMatrix &normal)
    {
      std::map<unsigned int, double> stiffnesses;
      for (const ContactNode &node : interface)
        if (!node.is_rigid())
          stiffnesses[node.pair] = node.stiffness;
      std::vector<ContactSpring> result;
      for (const auto &[pair, stiffness] : stiffnesses)
        {
          const auto negative = contact_rows(model, interface, [number = pair](const ContactNode &node, SparseMatrix::Row &row) {
            if (node.pair == number)
              {
                add_along(node.normal, node.on_disc, -node.area, row);
                add_along(node.normal, node.on_pin, node.area, row);
              }
          });
          result.push_back({contact_stiffness_parameter(pair), stiffness,
                            linear_combination({{-1., multiply(normal, *negative, true, false).get()}}), negative});
        }
      return result;
    }
  } // namespace

  std::string contact_stiffness_parameter(const unsigned int pair)
  {
    return text("normal stiffness of contact pair ", pair + 1);
  }

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface)
  {
    SlaveRows slaves;
    for (const ContactNode &contact : interface)
      if (contact.is_rigid())
        eliminate(slaves, contact, contact.pin_node, contact.on_pin, contact.on_disc);
    resolve_contact(slaves);
    const auto along  = [&](const auto &direction) { return relative_displacement(model, interface, direction); };
    const auto normal = along([](const ContactNode &node) { return node.normal; });
    return {normal,
            along([](const ContactNode &node) -> Eigen::Vector3d { return node.friction * node.sliding; }),
            along([](const ContactNode &node) { return node.radial; }),
            kernel_matrix(model.free_map(), std::vector<bool>(model.free_map().n_local(), true), slaves),
            reaction(model, interface),
            springs(model, interface, *normal)};
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
        {
          if (component == Component::pins)
            eliminate(slaves, contact, contact.pin_node, contact.on_pin, {});
          else
            for (const WeightedNode &on_disc : contact.on_disc)
              if (slaves.count(on_disc.node.dofs[eliminated_direction(contact)]) == 0)
                eliminate(slaves, contact, on_disc.node, {on_disc}, {});
        }
    resolve_contact(slaves);
    return kernel_matrix(model.free_map(), kept, slaves);
  }

  MultiVector coordinates(const SparseMatrix &T, const MultiVector &u)
  {
    // Columns of T have the order and owners of the selected dofs; a slave with the row of the next selected dof has the same value
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
