// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>
#include <squeal/bases/component_modes.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <complex>
#include <map>

namespace Squeal
{
  namespace
  {
    /// Smallest participation for which a mode gets the label of a component mode [-].
    constexpr double smallest_participation = 0.1;

    /// Entry of A in a local row of this process; 0 if there is none.
    double entry(const SparseMatrix &A, const int place, const int column)
    {
      SparseMatrix::Row row;
      A.get_row(place, row);
      const auto found = std::find_if(row.begin(), row.end(), [column](const auto &other) { return other.first == column; });
      return found == row.end() ? 0. : found->second;
    }
  } // namespace

  std::vector<double> nodal_masses(const Model &model, const SparseMatrix &mass)
  {
    // Use the x displacements: row sums M e_x with e_x = 1 at every node, and the diagonal of M
    MultiVector     e_x(model.free_map(), 1);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(e_x.n_local_rows());
    for (const Node &node : model.nodes())
      if (const int i = e_x.map().place(node.dofs[0]); i >= 0)
        {
          e_x(i, 0)   = 1.;
          diagonal[i] = entry(mass, i, node.dofs[0]);
        }
    Eigen::VectorXd lumped  = (mass * e_x).col(0);
    double          sums[3] = {0., lumped.sum(), diagonal.sum()};
    for (int i = 0; i < lumped.size(); ++i)
      sums[0] += diagonal[i] > 0. && !(lumped[i] > 0.);
    sum_over_processes(model.communicator(), sums, 3);
    if (sums[0] > 0.)
      lumped = sums[1] / sums[2] * diagonal;
    std::vector<double> masses;
    for (const Node &node : model.nodes())
      {
        const int i = e_x.map().place(node.dofs[0]);
        masses.push_back(i >= 0 ? lumped[i] : 0.);
      }
    return masses;
  }

  ComponentModes component_modes(const Model                 &model,
                                 const ContactInterface      &interface,
                                 const ContactInterface      &closed,
                                 const SecondOrderSystem     &system,
                                 const Component              component,
                                 const ContactBoundary        boundary,
                                 const double                 largest_eigenvalue,
                                 const SymmetricModesOptions &options)
  {
    const auto           T = component_kernel(model, closed, component, boundary);
    const auto           K = congruence(*system.stiffness, *T), M = congruence(*system.mass, *T);
    const SymmetricModes modes = symmetric_modes(*K, *M, largest_eigenvalue, options);
    ComponentModes       result;
    result.eigenvalues = modes.eigenvalues;
    result.residuals   = modes.residuals;
    if (modes.eigenvalues.empty())
      return result;
    result.vectors = std::make_shared<MultiVector>(*T * *modes.vectors);

    const auto masses = nodal_masses(model, *system.mass);
    result.labels =
      component == Component::disc ? disc_labels(model, masses, *result.vectors) : pin_labels(model, interface, masses, *result.vectors);
    for (int j = 0; j < modes.n_rigid_body; ++j)
      result.labels[j] = {ModeFamily::rigid_body};
    return result;
  }

  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const SparseMatrix                        &mass,
                                        const MultiVector                         &real_part,
                                        const MultiVector                         *imaginary_part)
  {
    const MultiVector zero(real_part.map(), imaginary_part ? 0 : real_part.n_columns());
    const MultiVector X   = join({&real_part, imaginary_part ? imaginary_part : &zero});
    const DenseMatrix one = DenseMatrix::Identity(X.n_columns(), X.n_columns());
    return shape_shares(references, products_with(references, mass, X), weighted_gram(X, mass), one);
  }

  std::vector<DenseMatrix> products_with(const std::vector<const ComponentModes *> &references,
                                         const SparseMatrix                        &mass,
                                         const MultiVector                         &X)
  {
    const MultiVector        MX = mass * X;
    std::vector<DenseMatrix> result;
    for (const ComponentModes *reference : references)
      result.push_back(reference->vectors ? gram(*reference->vectors, MX) : DenseMatrix(0, X.n_columns()));
    return result;
  }

  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const std::vector<DenseMatrix>            &products,
                                        const DenseMatrix                         &mass,
                                        const DenseMatrix                         &coordinates)
  {
    const Eigen::Index    k       = coordinates.cols() / 2;
    const Eigen::VectorXd squares = coordinates.cwiseProduct(mass * coordinates).colwise().sum(), sums = squares.head(k) + squares.tail(k);
    std::vector<ShapeShares> shares(k);
    for (std::size_t i = 0; i < references.size(); ++i)
      {
        const DenseMatrix of_modes = products[i] * coordinates;
        for (Eigen::Index j = 0; j < k; ++j)
          for (Eigen::Index v = 0; v < of_modes.rows(); ++v)
            shares[j][references[i]->labels[v].shape()] += (std::norm(of_modes(v, j)) + std::norm(of_modes(v, k + j))) / sums[j];
      }
    return shares;
  }

  std::vector<ModeLabel> identify(const std::vector<const ComponentModes *> &references, const std::vector<ShapeShares> &shares)
  {
    const int n_modes = static_cast<int>(shares.size());

    // No label is given to more modes than there are component modes with this label
    std::vector<ModeLabel> names;
    for (const ComponentModes *reference : references)
      names.insert(names.end(), reference->labels.begin(), reference->labels.end());
    names.resize(std::max<std::size_t>(names.size(), n_modes));
    const auto share = [&](const int mode, const int name) {
      const auto it = shares[mode].find(names[name].shape());
      return it != shares[mode].end() ? it->second : 0.;
    };
    const std::vector<int> assigned = best_assignment(n_modes, names.size(), share);
    std::vector<ModeLabel> labels;
    for (int j = 0; j < n_modes; ++j)
      {
        const double participation = share(j, assigned[j]);
        labels.push_back(participation < smallest_participation ? ModeLabel() : names[assigned[j]]);
        labels.back().participation = participation;
      }
    return labels;
  }
} // namespace Squeal
