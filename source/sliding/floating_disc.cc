// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/sliding/floating_disc.h>

#include <Eigen/QR>

#include <cmath>
#include <numeric>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// The sliding motion is a free motion of the disc if its energy outside the span of the free motions is below this limit [-].
    constexpr double free_to_turn = 1e-6;
    /// Slip due to a free motion, relative to its largest displacement, and relative force of a pressure on this motion, count as rounding
    /// errors up to this limit [-].
    constexpr double no_slip = 1e-6;
    /// A combination of motions does not change the gaps if the ratio of the smallest to the largest singular value of B is below this
    /// limit; rounding errors cause 1e-15 [-].
    constexpr double unchanged_gaps = 1e-8;
    /// Loads on a floating disc are equal up to rounding errors if their difference relative to their sum is below this limit [-].
    constexpr double equal_loads = 1e-10;

    /// Rigid-body motion of the disc with the sliding velocity, n × 1, of unit modal mass.
    MultiVector sliding_motion(const Model &model, const SecondOrderSystem &system, const SlidingVelocity &velocity)
    {
      const auto rigid = velocity.rigid_motion();
      if (!rigid)
        throw SolverError("the disc is not fully held, and its sliding velocity is not a rigid-body motion that a drive could prescribe",
                          "steady sliding, parameter Operation/Sliding direction",
                          "hold the disc by Mounts/Elastic mounts, or choose the velocity of a rigid-body motion");
      const MultiVector motion = rigid_motions(model, 0) * DenseMatrix(*rigid);
      return motion * DenseMatrix::Constant(1, 1, 1. / std::sqrt(column_products(motion, *system.mass * motion)[0]));
    }

    /// Free motions @p N of the disc without the sliding motion @p turning, which is excluded even if it changes gaps (polygonal rim),
    /// because the drive balances its moment.
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

    /// Throws SolverError if friction or pressure does work on @p motions of a body, which do not change gaps.
    void refuse_forces_on(const MultiVector      &motions,
                          const ContactOperators &contact,
                          const std::string      &body,
                          const double            mu,
                          const MultiVector      *pressing)
    {
      const std::vector<double> slips = column_norms(*contact.tangential * motions);
      for (int j = 0; j < motions.n_columns(); ++j)
        {
          const MultiVector motion = view(motions, j, 1);
          const double      size   = largest_of_processes(motion.communicator(), max_norm(motion.local()));
          const double      slip   = slips[j] / (size * std::sqrt(contact.tangential->rows().n()));
          const double      force  = pressing ? std::abs(gram(motion, *pressing)(0, 0)) / (size * column_norms(*pressing)[0]) : 0.;
          if ((mu > 0. && slip > no_slip) || force > no_slip)
            throw SolverError(text("nothing holds ", body == PhysicalNames::disc ? "the disc" : body, " against the ",
                                   mu > 0. && slip > no_slip ? "friction forces" : "pressure",
                                   " in a direction that does not change the gaps"),
                              "steady sliding",
                              "add stiffness in this direction (Mounts/Elastic mounts), for a disc usually radial or tangential, or set "
                              "Steady sliding/Contact state = equal load");
        }
    }

    /// Throws SolverError if loads or friction do work on a motion @p y that does not change gaps; @p of_contact is the work of unit
    /// reactions.
    void refuse_unbalanced(const Eigen::VectorXd &y, const Eigen::VectorXd &forces, const DenseMatrix &of_contact)
    {
      if (max_norm(of_contact.transpose() * y) > no_slip * max_norm(of_contact.cwiseAbs().transpose() * y.cwiseAbs()))
        throw SolverError("the disc and the bodies on it can move together without changing a gap, and friction does work on this motion",
                          "steady sliding", "hold the disc against this motion, for example against tilting (Mounts/Elastic mounts)");
      const Eigen::VectorXd work         = y.cwiseProduct(forces);
      const double          sum_of_sizes = work.lpNorm<1>();
      if (sum_of_sizes > 0. && std::abs(work.sum()) / sum_of_sizes > equal_loads)
        throw SolverError("the disc floats between its backplates, and the loads on them are not in equilibrium", "steady sliding",
                          "use loads that balance each other, or hold the disc in their direction (Mounts/Elastic mounts)");
    }
  } // namespace

  std::optional<MultiVector> balanced_motions(const Model                                   &model,
                                              const ContactOperators                        &contact,
                                              const SecondOrderSystem                       &system,
                                              const std::vector<std::optional<MultiVector>> &free,
                                              const OperationParameters                     &operation,
                                              const MultiVector                             *pressing)
  {
    std::vector<MultiVector> result;
    for (std::size_t body = 0; body < free.size(); ++body)
      {
        const std::string &name   = model.component_names()[body];
        auto               others = free[body];
        if (others && body == 0)
          others = without_turning(*others, sliding_motion(model, system, operation), system);
        if (!others)
          continue;
        if (body > 0 && !(pressing && max_norm(gram(rigid_motions(model, body), *pressing)) > 0.))
          throw SolverError("nothing holds " + name + " completely, and no pressure acts on it", "steady sliding",
                            "hold it by Mounts/Elastic mounts or pin_clamp, or add its back to Steady sliding/Pressed faces");
        const auto [balanced, unchanged] = contact_motions(*contact.normal, *others);
        if (unchanged)
          refuse_forces_on(*unchanged, contact, name, operation.friction_coefficient, pressing);
        if (balanced)
          result.push_back(*balanced);
      }
    if (result.empty())
      return {};
    return join_all(result);
  }

  void hold_undetermined_motion(ContactProblem &problem, const int n_plates)
  {
    std::vector<int> free(problem.motions.cols());
    std::iota(free.begin(), free.end(), 0);
    while (static_cast<int>(free.size()) > n_plates)
      {
        const DenseMatrix        B     = problem.motions(Eigen::placeholders::all, free);
        const Eigen::RowVectorXd sizes = B.colwise().norm();
        const auto [values, V]         = singular_values(B * sizes.cwiseInverse().asDiagonal()); // descending
        const int n                    = sizes.size();
        if (static_cast<int>(values.size()) == n && values.back() / values.front() > unchanged_gaps)
          return;
        const Eigen::VectorXd y = V.col(n - 1), forces = as_column(problem.forces)(free, 0);
        refuse_unbalanced(y.cwiseQuotient(sizes.transpose()), forces, problem.balance(free, Eigen::placeholders::all));

        Eigen::Index held;
        y.tail(n - n_plates).cwiseAbs().maxCoeff(&held);
        held += n_plates;
        // Replace the equation of equilibrium of this motion, which follows from the others, by z = 0
        problem.motions.col(free[held]).setZero();
        problem.balance.row(free[held]).setZero();
        problem.held.push_back(free[held]);
        free.erase(free.begin() + held);
      }
  }
} // namespace Squeal
