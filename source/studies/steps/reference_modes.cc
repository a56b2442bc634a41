#include <squeal/estimates/mode_pairing.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/studies/steps/reference_modes.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// The rows of the shapes that belong to bodies of @p chosen.
    DenseMatrix rows_of(const ReferenceModes &reference, const CommonPoints &chosen)
    {
      DenseMatrix  result(3 * chosen.n(), reference.shapes.cols());
      Eigen::Index from = 0, to = 0;
      auto         next = chosen.bodies.begin();
      for (const CommonPoints::Body &body : reference.points.bodies)
        {
          const auto n = static_cast<Eigen::Index>(3 * body.points.size());
          if (next != chosen.bodies.end() && next->name == body.name)
            {
              result.middleRows(to, n) = reference.shapes.middleRows(from, n);
              to += n;
              ++next;
            }
          from += n;
        }
      return result;
    }
  } // namespace

  ReferenceModes reference_modes(const FrictionlessModes &modes, const MaterialParameters &materials)
  {
    const Linearisation &linearisation = modes.linearisation;
    const Model         &model         = *linearisation.scene->model;
    constexpr int        per_cell      = 1; // its centre
    ReferenceModes       result{body_frames(model), common_points(model, materials, per_cell), {}, {}, {}};
    const auto           E = displacements_at(result.points, model, Directions::cylindrical);
    result.shapes          = gather(*E * (*linearisation.coupled.kernel * *modes.real.vectors));
    for (std::size_t j = 0; j < modes.labels.size(); ++j)
      {
        result.lambda.emplace_back(0., std::sqrt(std::max(0., modes.real.eigenvalues[j])));
        result.names.push_back(to_string(modes.labels[j]));
      }
    return result;
  }

  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes)
  {
    const CommonPoints         points = carried_over(reference.points, reference.frames, body_frames(model));
    const auto                 E      = displacements_at(points, model, Directions::cylindrical);
    const ModesAtPoints        here   = at_points(*E, kernel, modes);
    const MultiVector          shapes = scatter(rows_of(reference, points), here.real_part.map());
    const ModesAtPoints        there  = {reference.lambda, shapes, MultiVector(shapes.map(), shapes.n_columns())};
    std::vector<ReferenceName> result;
    for (const PairedMode &mode : pair_modes(there, here).fine)
      result.push_back({mode.partner >= 0 ? reference.names[mode.partner] : "", mode.overlap, mode.in_cluster});
    return result;
  }
} // namespace Squeal
