#include <squeal/base/assignment.h>
#include <squeal/bases/component_modes.h>
#include <squeal/bases/near_null_space.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <map>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// Smallest participation of component modes after which a mode is named [-].
    constexpr double smallest_participation = 0.1;
  } // namespace

  std::vector<double> nodal_masses(const Model &model, const SparseMatrix &mass)
  {
    // Row sums of the x displacements: M e_x
    MultiVector e_x(model.free_map(), 1);
    for (const Node &node : model.nodes())
      if (const int i = e_x.map().place(node.dofs[0]); i >= 0)
        e_x(i, 0) = 1.;
    const MultiVector   row_sums = mass * e_x;
    std::vector<double> masses;
    for (const Node &node : model.nodes())
      {
        const int i = row_sums.map().place(node.dofs[0]);
        masses.push_back(i >= 0 ? row_sums(i, 0) : 0.);
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
    const auto T = component_kernel(model, closed, component, boundary);

    // Multigrid has to know how the dofs of this component move
    SymmetricModesOptions        used = options;
    std::optional<NearNullSpace> space;
    if (options.library == FactorizationLibrary::multigrid)
      used.near_null_space = &space.emplace(near_null_space(model, *T));
    const SymmetricModes modes =
      symmetric_modes(*congruence(*system.stiffness, *T), *congruence(*system.mass, *T), largest_eigenvalue, used);

    ComponentModes result;
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
    const int         n_modes = real_part.n_columns();
    const MultiVector M_re    = mass * real_part;
    const MultiVector M_im    = imaginary_part ? mass * *imaginary_part : MultiVector(real_part.map(), n_modes);

    const std::vector<double> norm_re = column_products(real_part, M_re),
                              norm_im = imaginary_part ? column_products(*imaginary_part, M_im) : std::vector<double>(n_modes, 0.);

    std::vector<ShapeShares> shares(n_modes);
    for (const ComponentModes *reference : references)
      if (reference->vectors)
        {
          const DenseMatrix re = gram(*reference->vectors, M_re), im = gram(*reference->vectors, M_im);
          for (int j = 0; j < n_modes; ++j)
            for (int i = 0; i < re.rows(); ++i)
              shares[j][reference->labels[i].shape()] += (re(i, j) * re(i, j) + im(i, j) * im(i, j)) / (norm_re[j] + norm_im[j]);
        }
    return shares;
  }

  std::vector<ModeLabel> identify(const std::vector<const ComponentModes *> &references, const std::vector<ShapeShares> &shares)
  {
    const int n_modes = static_cast<int>(shares.size());

    // A label is given to no more modes than there are component modes of it
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
