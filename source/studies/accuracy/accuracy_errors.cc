// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/studies/accuracy/accuracy.h>

namespace Squeal
{
  namespace
  {

    Limit limit_of(const std::vector<double> &widths, const std::vector<double> &values, const double order, const bool in_cluster)
    {
      if (values.size() < 2)
        return {{}, values.back(), 0.};
      const Extrapolation sequence   = extrapolate(widths, values, order);
      const double        difference = std::abs(values.back() - values[values.size() - 2]);
      const bool          is_finest  = in_cluster || (values.size() > 2 && !sequence.is_trustworthy);
      return {sequence, is_finest ? values.back() : sequence.limit, is_finest ? difference : sequence.uncertainty};
    }

    ConvergedMode converged(const int                              number,
                            const std::vector<const SolvedMesh *> &members,
                            const std::vector<ModePairing>        &pairings) // pairings of each coarser mesh with the finest
    {
      const SolvedMesh   &finest = *members.back();
      ConvergedMode       mode{finest.labels[number], false, {}, {}, {}};
      std::vector<double> widths, frequencies, divergences;
      for (std::size_t k = 0; k < members.size(); ++k)
        {
          const PairedMode pair = k + 1 < members.size() ? pairings[k].fine[number] : PairedMode{number, 1., false};
          mode.numbers.push_back(pair.partner);
          mode.in_cluster = mode.in_cluster || pair.in_cluster;
          if (pair.partner < 0)
            continue;
          const ModalQuantities q = modal_quantities(members[k]->modes.lambda[pair.partner]);
          widths.push_back(1. / members[k]->mesh.factor);
          frequencies.push_back(q.frequency);
          divergences.push_back(q.divergence_rate);
        }
      const double order = 2. * degree_of(finest.mesh.element);
      mode.frequency     = limit_of(widths, frequencies, order, mode.in_cluster);
      mode.divergence    = limit_of(widths, divergences, order, mode.in_cluster);

      return mode;
    }

    ConvergedFamily converged(const std::string &name, const std::vector<const SolvedMesh *> &members, const double maximum_frequency)
    {
      std::vector<ModePairing> pairings;
      for (std::size_t k = 0; k + 1 < members.size(); ++k)
        pairings.push_back(pair_modes(members[k]->modes, members.back()->modes));
      ConvergedFamily family{name, members, {}, 0.};
      int             n = 0;
      for (std::size_t j = 0; j < members.back()->labels.size(); ++j)
        {
          family.modes.push_back(converged(j, members, pairings));
          const ConvergedMode &mode  = family.modes.back();
          const Limit         &limit = mode.frequency;
          if (!limit.sequence || limit.value > maximum_frequency)
            continue;
          const double finest = modal_quantities(members.back()->modes.lambda[j]).frequency;
          family.error += std::pow((std::abs(finest - limit.value) + limit.uncertainty) / limit.value, 2);
          ++n;
        }
      family.error = n > 0 ? std::sqrt(family.error / n) : 1.;
      return family;
    }

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
      mode.frequency_error  = errors_of(found.frequency, full.frequency, reference.frequency.value, reference.frequency.value, algebraic);
      mode.divergence_error = errors_of(found.divergence_rate, full.divergence_rate, reference.divergence.value, 1., algebraic);
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
          if (reference.modes[j].frequency.value > maximum_frequency)
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

    /// Marks the Pareto-optimal methods with respect to CPU time and error, excluding methods with lost modes.
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

  std::vector<ConvergedFamily> converged_families(const std::vector<SolvedMesh> &meshes, const double maximum_frequency)
  {
    std::map<std::string, std::vector<const SolvedMesh *>> members;
    for (const SolvedMesh &mesh : meshes)
      members[mesh.mesh.family()].push_back(&mesh);
    std::vector<ConvergedFamily> families;
    for (const auto &[name, of_family] : members)
      if (of_family.size() > 1)
        families.push_back(converged(name, of_family, maximum_frequency));
    return families;
  }

  const ConvergedFamily &best_family(const std::vector<ConvergedFamily> &families)
  {
    if (families.empty())
      throw SolverError("extrapolation requires two solved meshes with the same element and outline, but there are none",
                        "Study = accuracy",
                        "give more or smaller Accuracy study/Mesh factors, raise Accuracy study/Largest number of dofs, or remove "
                        "other causes of skipped meshes");
    return *std::min_element(families.begin(), families.end(),
                             [](const ConvergedFamily &a, const ConvergedFamily &b) { return a.error < b.error; });
  }

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
