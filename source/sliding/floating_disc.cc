#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/sliding/floating_disc.h>

#include <cmath>
#include <utility>
#include <vector>

namespace Squeal
{
  namespace
  {
    const Decision motion_in_plane("motion in its plane but turning / motion that leaves the gaps of a free disc as they are", 1e-6);
    const Decision gap_of_all_motions("smallest / largest singular value of the gaps of backplates and free disc, unit columns", 1e-8);
    const Decision unequal_loads("difference / sum of the loads on a floating disc", 1e-10);

    /// Throws SolverError if there are other motions in the plane than turning, whose moment the drive takes.
    void refuse_unless_turning(const Model &model, const SecondOrderSystem &system, const MultiVector &sliding)
    {
      MultiVector turning = view(rigid_motions(model, 0), 5, 1);
      double      norm;
      turning.Dot(*system.mass * turning, &norm);
      turning.Scale(1. / std::sqrt(norm));
      const DenseMatrix turned = gram(sliding, *system.mass * turning);
      const double      others = sliding.NumVectors() - turned.squaredNorm();
      if (motion_in_plane.exceeded_by(others))
        throw SolverError("nothing holds the disc in its plane against the friction forces", "steady sliding",
                          "add a mount with radial or tangential stiffness (Mounts/Elastic mounts), or set Steady sliding/Contact "
                          "state = equal load");
    }

    /// The columns of @p matrix scaled to unit Euclidean norm, and their norms.
    std::pair<DenseMatrix, std::vector<double>> unit_columns(DenseMatrix matrix)
    {
      std::vector<double> norms;
      for (auto column : matrix.colwise())
        {
          norms.push_back(column.norm());
          column /= norms.back();
        }
      return {std::move(matrix), std::move(norms)};
    }

    /// Throws SolverError if forces do work on a motion @p y that changes no gap.
    void refuse_unbalanced(const std::vector<double> &y, const std::vector<double> &forces)
    {
      double sum = 0., sum_of_sizes = 0.;
      for (std::size_t k = 0; k < y.size(); ++k)
        {
          sum += y[k] * forces[k];
          sum_of_sizes += std::abs(y[k] * forces[k]);
        }
      if (sum_of_sizes > 0. && unequal_loads.exceeded_by(std::abs(sum) / sum_of_sizes))
        throw SolverError("the disc floats along its axis, and the loads on its sides are not equal", "steady sliding",
                          "give equal loads on both sides, or a mount with axial stiffness (Mounts/Elastic mounts)");
    }
  } // namespace

  std::optional<MultiVector> balanced_disc_motions(const Model             &model,
                                                   const ContactOperators  &contact,
                                                   const SecondOrderSystem &system,
                                                   const StaticResponse    &response,
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
    const auto [B, sizes]  = unit_columns(problem.motions);
    const auto [values, V] = singular_values(B); // descending
    const int n            = B.cols();
    if (static_cast<int>(values.size()) == n && gap_of_all_motions.exceeded_by(values.back() / values.front()))
      return;
    std::vector<double> y;
    for (int k = 0; k < n; ++k)
      y.push_back(V(k, n - 1) / sizes[k]);
    refuse_unbalanced(y, problem.forces);

    int held = n_plates;
    for (int k = n_plates; k < n; ++k)
      if (std::abs(V(k, n - 1)) > std::abs(V(held, n - 1)))
        held = k;
    // The row of its balance becomes z = 0: it follows from the others
    problem.motions.col(held).setZero();
    problem.balance.row(held).setZero();
    problem.held.push_back(held);
  }
} // namespace Squeal
