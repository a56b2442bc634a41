#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/sparse.h>

#include <cmath>

namespace Squeal
{
  namespace
  {
    /// ω²/ω_max² below which a rigid-body motion counts as free: far above rounding, far below any mount worth the name.
    constexpr double free_motion = 1e-8;
    /// ω_max / s for a free disc.
    constexpr double band_per_shift = 50.;
  } // namespace

  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system)
  {
    // Uncoupled: the disc moves, the pins rest
    MultiVector motions(model.free_map(), 6);
    for (const Node &node : model.nodes())
      if (node.component == 0)
        {
          const auto  &p              = node.position;
          const double values[6][3] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}, {0., -p[2], p[1]}, {p[2], 0., -p[0]}, {-p[1], p[0], 0.}};
          for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 3; ++k)
              if (node.dofs[k] >= 0 && model.free_map().MyGID(node.dofs[k]))
                motions.ReplaceGlobalValue(node.dofs[k], j, values[j][k]);
        }

    // Coupled coordinates: rows of T_c with a single one select; transposing them picks the disc's own values, because only
    // dofs of pins are eliminated, and adds what the eliminated dofs (at rest here) contribute: nothing.
    return transpose_times(*system.kernel, motions);
  }

  double stabilizing_shift(const Model &model, const CoupledSystem &system, const double largest_circular_frequency)
  {
    const MultiVector X = rigid_disc_motions(model, system);

    // Smallest Rayleigh quotient: eigenvalues of M^{-1/2} K M^{-1/2} on the six motions
    DenseMatrix       axes = gram(X, *system.frictionless.mass * X);
    const auto        m    = symmetric_eigenvalues(axes);
    for (int j = 0; j < axes.n_columns(); ++j)
      for (int i = 0; i < axes.n_rows(); ++i)
        axes(i, j) /= std::sqrt(m[j]);
    const MultiVector Y        = X * axes;
    DenseMatrix       K        = gram(Y, *system.frictionless.stiffness * Y);
    const double      smallest = symmetric_eigenvalues(K).front();

    const double omega = largest_circular_frequency;
    return smallest < free_motion * omega * omega ? omega / band_per_shift : 0.;
  }
} // namespace Squeal
