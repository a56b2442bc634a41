#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/studies/accuracy/accuracy_reference.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// A value with its sequence: of all meshes that have the mode.
    struct Limit
    {
      std::optional<Extrapolation> sequence;
      double                       value, uncertainty;
    };

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
                            const std::vector<ModePairing>        &pairings) // of every member but the last with that
    {
      const SolvedMesh   &finest = *members.back();
      ConvergedMode       mode{finest.labels[number], false, {}, 0., 0., 0., 0., {}, {}};
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
      const double order          = 2. * degree_of(finest.mesh.element);
      const Limit  frequency      = limit_of(widths, frequencies, order, mode.in_cluster);
      const Limit  divergence     = limit_of(widths, divergences, order, mode.in_cluster);
      mode.frequency              = frequency.value;
      mode.frequency_uncertainty  = frequency.uncertainty;
      mode.frequencies            = frequency.sequence;
      mode.divergence             = divergence.value;
      mode.divergence_uncertainty = divergence.uncertainty;
      mode.divergences            = divergence.sequence;
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
          const ConvergedMode &mode = family.modes.back();
          if (!mode.frequencies || mode.frequency > maximum_frequency)
            continue;
          const double finest = modal_quantities(members.back()->modes.lambda[j]).frequency;
          family.error += std::pow((std::abs(finest - mode.frequency) + mode.frequency_uncertainty) / mode.frequency, 2);
          ++n;
        }
      family.error = n > 0 ? std::sqrt(family.error / n) : 1.;
      return family;
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
      throw SolverError("no element was solved on two meshes, so that nothing can be extrapolated", "study of accuracy",
                        "give more Accuracy study/Mesh factors, smaller ones, or raise Accuracy study/Largest number of dofs");
    return *std::min_element(families.begin(), families.end(),
                             [](const ConvergedFamily &a, const ConvergedFamily &b) { return a.error < b.error; });
  }
} // namespace Squeal
