#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/sliding/floating_disc.h>

#include <cmath>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// Dimensions other than turning among the motions that keep the gaps: one or more, or rounding errors of M-orthonormal vectors.
    constexpr double only_turning = 1e-6;
    /// Smallest over largest singular value of the gaps of all motions, up to which one changes no gap: rounding leaves 1e-15.
    constexpr double unchanged_gaps = 1e-8;
    /// Difference over sum of the loads on a floating disc, up to which they are equal: decimal numbers are off by rounding.
    constexpr double equal_loads = 1e-10;

    /// Throws SolverError if there are other motions in the plane than turning, whose moment the drive takes.
    void refuse_unless_turning(const Model &model, const SecondOrderSystem &system, const MultiVector &sliding)
    {
      const MultiVector motions = rigid_motions(model, 0);
      MultiVector       turning = view(motions, 5, 1);
      turning *= 1. / std::sqrt(column_products(turning, *system.mass * turning)[0]);
      const DenseMatrix turned = gram(sliding, *system.mass * turning);
      const double      others = sliding.n_columns() - turned.squaredNorm();
      if (others > only_turning)
        throw SolverError("nothing holds the disc in its plane against the friction forces", "steady sliding",
                          "add a mount with radial or tangential stiffness (Mounts/Elastic mounts), or set Steady sliding/Contact "
                          "state = equal load");
    }

    /// Throws SolverError if forces do work on a motion @p y that changes no gap.
    void refuse_unbalanced(const Eigen::VectorXd &y, const std::vector<double> &forces)
    {
      const Eigen::VectorXd work         = y.cwiseProduct(as_column(forces));
      const double          sum_of_sizes = work.lpNorm<1>();
      if (sum_of_sizes > 0. && std::abs(work.sum()) / sum_of_sizes > equal_loads)
        throw SolverError("the disc floats along its axis, and the loads on its sides are not equal", "steady sliding",
                          "give equal loads on both sides, or a mount with axial stiffness (Mounts/Elastic mounts)");
    }
  } // namespace

  std::optional<MultiVector> balanced_disc_motions(const Model             &model,
                                                   const ContactOperators  &contact,
                                                   const SecondOrderSystem &system,
                                                   const InertiaRelief     &response,
                                                   const double             mu)
  {
    const MultiVector *N = response.rigid_body_modes();
    if (!N)
      return {};
    const auto [pressing, sliding] = contact_motions(*contact.normal, *N);
    if (sliding && mu > 0.)
      refuse_unless_turning(model, system, *sliding);
    return pressing;
  }

  void hold_undetermined_motion(ContactProblem &problem, const int n_plates)
  {
    const Eigen::RowVectorXd sizes = problem.motions.colwise().norm();
    const auto [values, V]         = singular_values(problem.motions * sizes.cwiseInverse().asDiagonal()); // descending
    const int n                    = sizes.size();
    if (static_cast<int>(values.size()) == n && values.back() / values.front() > unchanged_gaps)
      return;
    const Eigen::VectorXd y = V.col(n - 1);
    refuse_unbalanced(y.cwiseQuotient(sizes.transpose()), problem.forces);

    Eigen::Index held;
    y.tail(n - n_plates).cwiseAbs().maxCoeff(&held);
    held += n_plates;
    // The row of its balance becomes z = 0: it follows from the others
    problem.motions.col(held).setZero();
    problem.balance.row(held).setZero();
    problem.held.push_back(static_cast<int>(held));
  }
} // namespace Squeal
