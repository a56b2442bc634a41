#include <squeal/estimates/subspaces.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/studies/stated_modes.h>

namespace Squeal
{
  std::vector<StatedMode> stated_modes(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves)
  {
    std::vector<StatedMode> modes;
    for (std::size_t j = 0; j < friction.labels.size(); ++j)
      modes.push_back({{friction.labels[j], modal_quantities(friction.modes.lambda[j])}, friction.unstable[j], waves[j]});
    return modes;
  }

  bool grows(const StatedMode &mode)
  {
    return mode.unstable && mode.quantities.divergence_rate >= weak_divergence;
  }

  GrowthKept growth_kept(const FrictionlessModes       &frictionless,
                         const FrictionModes           &before,
                         const std::vector<StatedMode> &stated_before,
                         const FrictionModes           &after,
                         const std::vector<StatedMode> &stated_after)
  {
    const auto both_parts = [](const FrictionModes &friction) {
      return join({friction.modes.real_part.get(), friction.modes.imaginary_part.get()});
    };
    const SparseMatrix      &M = *frictionless.linearisation.coupled.mass;
    const MultiVector        X = both_parts(before), Y = both_parts(after), MY = M * Y;
    const ComplexDenseMatrix G_uu = hermitian_products(gram(X, M * X)), G_dd = hermitian_products(gram(Y, MY)),
                             G_ud = hermitian_products(gram(X, MY));
    const auto growing            = [](const std::vector<StatedMode> &modes) {
      std::vector<Eigen::Index> places;
      for (std::size_t j = 0; j < modes.size(); ++j)
        if (grows(modes[j]))
          places.push_back(static_cast<Eigen::Index>(j));
      return places;
    };
    const auto u = growing(stated_before), d = growing(stated_after);

    GrowthKept result;
    result.share_before.assign(stated_before.size(), 0.);
    result.share_after.assign(stated_after.size(), 0.);
    if (u.empty() || d.empty())
      return result;
    const Eigen::RowVectorXd in_d = shares_in_span(G_dd(d, d), G_ud(Eigen::all, d).adjoint(), G_uu),
                             in_u = shares_in_span(G_uu(u, u), G_ud(u, Eigen::all), G_dd);
    result.share_before.assign(in_d.begin(), in_d.end());
    result.share_after.assign(in_u.begin(), in_u.end());
    result.n_kept = (squared_cosines(G_uu(u, u), G_dd(d, d), G_ud(u, d)).array() > 0.5).count();
    return result;
  }
} // namespace Squeal
