#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/sliding/floating_disc.h>

#include <Eigen/QR>

#include <cmath>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// Energy of turning outside of the free motions of the disc, up to which it is one of them: rounding errors of M-orthonormal vectors.
    constexpr double free_to_turn = 1e-6;
    /// Slip of the contact by a free motion, over that by turning of equal modal mass, on which friction does no work.
    constexpr double no_slip = 1e-6;
    /// Smallest over largest singular value of the gaps of all motions, up to which one changes no gap: rounding leaves 1e-15.
    constexpr double unchanged_gaps = 1e-8;
    /// Difference over sum of the loads on a floating disc, up to which they are equal: decimal numbers are off by rounding.
    constexpr double equal_loads = 1e-10;

    /// Motion of the disc that turns it about its axis, n × 1, of unit modal mass.
    MultiVector turning_motion(const Model &model, const SecondOrderSystem &system)
    {
      const MultiVector motions = rigid_motions(model, 0), turning = view(motions, 5, 1);
      return turning * DenseMatrix::Constant(1, 1, 1. / std::sqrt(column_products(turning, *system.mass * turning)[0]));
    }

    /// Free motions @p N of the disc but @p turning, whose moment the drive takes even where it changes gaps, as on a polygon for a rim.
    std::optional<MultiVector> without_turning(const MultiVector &N, const MultiVector &turning, const SecondOrderSystem &system)
    {
      const DenseMatrix part = gram(N, *system.mass * turning);
      if (1. - part.squaredNorm() > free_to_turn)
        return N;
      if (N.n_columns() == 1)
        return {};
      const DenseMatrix Q = Eigen::HouseholderQR<Eigen::MatrixXd>(part).householderQ();
      return N * DenseMatrix(Q.rightCols(N.n_columns() - 1));
    }

    /// Throws SolverError if forces do work on a motion @p y that changes no gap.
    void refuse_unbalanced(const Eigen::VectorXd &y, const std::vector<double> &forces)
    {
      const Eigen::VectorXd work         = y.cwiseProduct(as_column(forces));
      const double          sum_of_sizes = work.lpNorm<1>();
      if (sum_of_sizes > 0. && std::abs(work.sum()) / sum_of_sizes > equal_loads)
        throw SolverError("the disc floats between its backplates, and the loads on them are not in balance", "steady sliding",
                          "give loads that balance each other, or a mount that holds the disc along them (Mounts/Elastic mounts)");
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
    const MultiVector turning = turning_motion(model, system);
    const auto        others  = without_turning(*N, turning, system);
    if (!others)
      return {};
    const auto [pressing, sliding] = contact_motions(*contact.normal, *others);
    if (sliding && mu > 0.)
      {
        const double by_turning = column_norms(*contact.tangential * turning)[0];
        for (const double by_motion : column_norms(*contact.tangential * *sliding))
          if (by_motion / by_turning > no_slip)
            throw SolverError("nothing holds the disc in its plane against the friction forces", "steady sliding",
                              "add a mount with radial or tangential stiffness (Mounts/Elastic mounts), or set Steady sliding/Contact "
                              "state = equal load");
      }
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
