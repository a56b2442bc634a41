// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/stability/strain_energy.h>

#include <map>

namespace Squeal
{
  namespace
  {
    /// Part of the model to which a stiffness term belongs, by its name in tables.
    std::string part_of(const Term &term, const std::vector<std::string> &volumes, const MaterialParameters &materials)
    {
      for (const std::string &volume : volumes)
        if (term.coefficient.contains(BodyParameter::young_modulus(volume)))
          return is_of_disc(volume) && !materials.has_own(volume) ? "disc" :
                 volume.rfind(PhysicalNames::pin_prefix, 0) == 0  ? "pins" :
                                                                    volume;
      return "mounts";
    }

    /// φᴴ K φ of each mode.
    Eigen::VectorXd energies(const SparseMatrix &K, const std::vector<MultiVector> &parts)
    {
      Eigen::VectorXd result = Eigen::VectorXd::Zero(parts.front().n_columns());
      for (const MultiVector &part : parts)
        result += part.local().cwiseProduct((K * part).local()).colwise().sum().transpose();
      sum_over_processes(K.communicator(), result.data(), result.size());
      return result;
    }
  } // namespace

  Columns<int> strain_energy_columns(const Linearisation &linearisation, const ComplexModes &modes, const MaterialParameters &materials)
  {
    const Scene                   &scene  = *linearisation.scene;
    const SparseMatrix            &kernel = *linearisation.coupled.kernel;
    const std::vector<MultiVector> shapes = {kernel * *modes.real_part, kernel * *modes.imaginary_part};

    std::vector<std::string>               names;
    std::map<std::string, Eigen::VectorXd> of_part;
    Eigen::VectorXd                        all = Eigen::VectorXd::Zero(modes.lambda.size());
    const auto                             add = [&](const std::string &name, const double stiffness, const SparseMatrix &matrix) {
      const Eigen::VectorXd energy = stiffness * energies(matrix, shapes);
      const auto [entry, is_new]   = of_part.emplace(name, energy);
      if (is_new)
        names.push_back(name);
      else
        entry->second += energy;
      all += energy;
    };
    for (const Term &term : scene.elastic.terms)
      add(part_of(term, scene.model->volume_names(), materials), term.coefficient.at(scene.elastic.values), *term.matrix);
    for (const ContactSpring &spring : linearisation.contact.springs)
      add("contact springs", spring.stiffness, *spring.matrix);
    Columns<int> columns;
    for (const std::string &name : names)
      {
        const Eigen::VectorXd shares = 100. * of_part[name].cwiseQuotient(all);
        columns.push_back({"strain energy in " + name, "%", [shares](const int j) { return shares[j]; }, 2});
      }
    return columns;
  }
} // namespace Squeal
