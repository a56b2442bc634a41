#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/sparse.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// ω²/ω_max² below which a rigid-body motion counts as free: far above rounding, far below any mount worth the name.
    constexpr double free_motion = 1e-8;
    /// ω_max / s for a free disc.
    constexpr double band_per_shift = 50.;

    /// Ritz vectors, M-orthonormal, and Ritz values of K and M on the columns of X, ascending.
    std::pair<MultiVector, std::vector<double>> rayleigh_ritz(const MultiVector &X, const SecondOrderSystem &system)
    {
      DenseMatrix axes = gram(X, *system.mass * X);
      const auto  m    = symmetric_eigenvalues(axes);
      for (int j = 0; j < axes.n_columns(); ++j)
        for (int i = 0; i < axes.n_rows(); ++i)
          axes(i, j) /= std::sqrt(m[j]);
      const MultiVector Y      = X * axes;
      DenseMatrix       K      = gram(Y, *system.stiffness * Y);
      auto              values = symmetric_eigenvalues(K);
      // Every process must cut the same motions off.
      agree(X.Comm(), K, values);
      return {Y * K, values};
    }
  } // namespace

  MultiVector rigid_motions(const Model &model, const unsigned int component)
  {
    MultiVector motions(model.free_map(), 6);
    for (const Node &node : model.nodes())
      if (node.component == component)
        {
          const auto  &p              = node.position;
          const double values[6][3] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}, {0., -p[2], p[1]}, {p[2], 0., -p[0]}, {-p[1], p[0], 0.}};
          for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 3; ++k)
              if (node.dofs[k] >= 0 && model.free_map().MyGID(node.dofs[k]))
                motions.ReplaceGlobalValue(node.dofs[k], j, values[j][k]);
        }
    return motions;
  }

  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system)
  {
    // Coupled coordinates: rows of T_c with a single one select; transposing them picks the disc's own values, because only
    // dofs of pins are eliminated, and adds what the eliminated dofs (at rest here) contribute: nothing.
    return transpose_times(*system.kernel, rigid_motions(model, 0));
  }

  std::optional<MultiVector> free_disc_motions(const Model &model, const SecondOrderSystem &system, const double largest_circular_frequency)
  {
    const auto [modes, eigenvalues] = rayleigh_ritz(rigid_motions(model, 0), system);
    const double threshold = free_motion * largest_circular_frequency * largest_circular_frequency;
    const int    n_free    = std::upper_bound(eigenvalues.begin(), eigenvalues.end(), threshold) - eigenvalues.begin();
    if (n_free == 0)
      return {};
    return view(modes, 0, n_free);
  }

  double stabilizing_shift(const Model &model, const CoupledSystem &system, const double largest_circular_frequency)
  {
    const auto [modes, eigenvalues] = rayleigh_ritz(rigid_disc_motions(model, system), system.frictionless);
    const double omega              = largest_circular_frequency;
    return eigenvalues.front() < free_motion * omega * omega ? omega / band_per_shift : 0.;
  }
} // namespace Squeal
