#include <squeal/base/conventions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/studies/accuracy/accuracy_errors.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    ErrorKinds errors_of(const double value, const double full, const double reference, const double scale, const double algebraic)
    {
      return {std::abs(value - reference) / scale, std::abs(full - reference) / scale, std::abs(value - full) / scale, algebraic};
    }

    ErrorKinds larger(const ErrorKinds &a, const ErrorKinds &b)
    {
      return {std::max(a.total, b.total), std::max(a.discretisation, b.discretisation), std::max(a.reduction, b.reduction),
              std::max(a.algebraic, b.algebraic)};
    }

    ModeErrors compared(const ConvergedMode &reference, const PairedMode &pair, const SolvedMesh &mesh, const ModesByMethod &method)
    {
      ModeErrors mode{&reference, pair.partner, pair.overlap, pair.in_cluster || reference.in_cluster, 0., 0., {}, {}};
      if (pair.partner < 0)
        return mode;
      const ModalQuantities found     = modal_quantities(method.lambda[pair.partner]);
      const ModalQuantities full      = modal_quantities(mesh.modes.lambda[pair.partner]);
      const double          algebraic = method.algebraic_errors[pair.partner];
      mode.frequency                  = found.frequency;
      mode.divergence                 = found.divergence_rate;
      mode.frequency_error            = errors_of(found.frequency, full.frequency, reference.frequency, reference.frequency, algebraic);
      mode.divergence_error           = errors_of(found.divergence_rate, full.divergence_rate, reference.divergence, 1., algebraic);
      return mode;
    }

    ComparedMethod compared(const SolvedMesh      &mesh,
                            const ModesByMethod   &method,
                            const ConvergedFamily &reference,
                            const ModePairing     &pairing,
                            const double           maximum_frequency)
    {
      ComparedMethod result{&mesh, &method, {}, {}, 0., {}, 0, 0};
      double         sum = 0.;
      for (std::size_t j = 0; j < reference.modes.size(); ++j)
        {
          if (reference.modes[j].frequency > maximum_frequency)
            continue;
          const ModeErrors mode = compared(reference.modes[j], pairing.fine[j], mesh, method);
          result.modes.push_back(mode);
          result.n_in_cluster += mode.in_cluster;
          result.n_lost += mode.number < 0;
          result.largest_frequency = larger(result.largest_frequency, mode.frequency_error);
          sum += mode.frequency_error.total * mode.frequency_error.total;
          if (!mode.in_cluster)
            result.largest_divergence = larger(result.largest_divergence, mode.divergence_error);
        }
      const int n          = static_cast<int>(result.modes.size()) - result.n_lost;
      result.rms_frequency = n > 0 ? std::sqrt(sum / n) : 0.;
      return result;
    }

    /// Marks what nothing beats in both processor time and error, lost modes left out.
    void mark_front(std::vector<ComparedMethod> &methods)
    {
      const auto beats = [](const ComparedMethod &a, const ComparedMethod &b) {
        const double ta = a.method->cost.cpu_seconds, tb = b.method->cost.cpu_seconds;
        const double ea = a.largest_frequency.total, eb = b.largest_frequency.total;
        return a.n_lost == 0 && ta <= tb && ea <= eb && (ta < tb || ea < eb);
      };
      for (ComparedMethod &method : methods)
        method.on_front = method.n_lost == 0 &&
                          std::none_of(methods.begin(), methods.end(), [&](const ComparedMethod &other) { return beats(other, method); });
    }
  } // namespace

  std::vector<ComparedMethod> compare(const std::vector<SolvedMesh> &meshes,
                                      const ConvergedFamily         &reference,
                                      const double                   maximum_frequency)
  {
    std::vector<ComparedMethod> result;
    for (const SolvedMesh &mesh : meshes)
      {
        const ModePairing pairing = pair_modes(mesh.modes, reference.members.back()->modes);
        for (const ModesByMethod &method : mesh.methods)
          result.push_back(compared(mesh, method, reference, pairing, maximum_frequency));
      }
    mark_front(result);
    return result;
  }
} // namespace Squeal
