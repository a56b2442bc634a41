// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/output/table.h>

#include <boost/serialization/optional.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <boost/optional.hpp>

namespace Squeal
{
  /// Where a mode of a design begins or ceases to grow.
  struct DesignThreshold
  {
    double                  friction_coefficient = 0.;
    double                  uncertainty          = 0.;
    std::string             event, mechanism, label; ///< of the mode that grows
    boost::optional<double> overlap;                 ///< with the reference mode of that label [-]; none in a cluster
    std::string             partner;                 ///< empty: none
    double                  frequency = 0.;          ///< [Hz]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &uncertainty &event &mechanism &label &overlap &partner &frequency;
    }
  };

  /// A mode of a design, at the smallest and at the largest friction coefficient at which it is in the band.
  struct DesignMode
  {
    std::string             label;     ///< that of the reference mode it resembles; else its own
    std::string             own_label; ///< by the component modes of the design
    boost::optional<double> overlap;   ///< with the reference mode [-]; none in a cluster, whose members rounding mixes
    double                  first_frequency = 0., last_friction_coefficient = 0., last_frequency = 0.; ///< [Hz]
    double                  last_growth_rate = 0., last_divergence_rate = 0., last_error = 0.;         ///< [1/s], [-], [-]
    std::string             verdict;                                                                   ///< at the largest one
    double                  largest_divergence_rate = 0.;                                              ///< at any friction coefficient [-]
    boost::optional<double> onset;                                                                     ///< where it first begins to grow

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &label &own_label &overlap &first_frequency &last_friction_coefficient &last_frequency &last_growth_rate &last_divergence_rate
        &last_error &verdict &largest_divergence_rate &onset;
    }
  };

  /// What became of a design.
  enum class DesignOutcome
  {
    solved,
    refused, ///< its parameters or its geometry make no sense
    failed   ///< meshing or solving it did not succeed
  };

  template <>
  inline constexpr EnumName<DesignOutcome> enum_table<DesignOutcome>[] = {{DesignOutcome::solved, "solved"},
                                                                          {DesignOutcome::refused, "refused"},
                                                                          {DesignOutcome::failed, "failed"}};

  /// A friction coefficient and the mode that grows there.
  struct DesignGrowth
  {
    double      friction_coefficient = 0.;
    double      uncertainty          = 0.; ///< of the friction coefficient; 0 where it is given
    std::string label;
    double      frequency       = 0.; ///< [Hz]
    double      divergence_rate = 0.; ///< [-]
    double      error           = 0.; ///< estimated |δλ| / |λ| [-]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &uncertainty &label &frequency &divergence_rate &error;
    }
  };

  /// A row of the table of designs, with what its other tables show of it.
  struct DesignResult
  {
    int                      number = 0; ///< from one on
    std::vector<std::string> values;     ///< of the variables, with those of the scene where the design has none
    DesignOutcome            outcome = DesignOutcome::failed;
    std::string              reason; ///< why it was refused or failed

    int    n_dofs = 0, n_modes = 0, n_counted = 0; ///< modes in the band at the smallest friction coefficient, and real ones by inertia
    bool   is_complete = false;                    ///< the same number, and the expected one at every friction coefficient
    int    n_unstable = 0, n_undecided = 0;        ///< at the largest friction coefficient
    int    n_growing     = 0;                      ///< modes that grow at some friction coefficient
    double largest_error = 0., largest_residual = 0.;
    int    n_doubtful = 0; ///< steps in which modes could be told apart by their frequencies only

    boost::optional<DesignGrowth> onset;      ///< where the first mode begins to grow
    boost::optional<DesignGrowth> weak_onset; ///< where the first divergence rate exceeds weak_divergence
    boost::optional<DesignGrowth> worst;      ///< the largest divergence rate at any friction coefficient
    std::vector<DesignThreshold>  thresholds;
    std::vector<DesignMode>       modes;
    double                        seconds = 0.; ///< wall time [s]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &number &values &outcome &reason &n_dofs &n_modes &n_counted &is_complete &n_unstable &n_undecided &n_growing &largest_error
        &largest_residual &n_doubtful &onset &weak_onset &worst &thresholds &modes &seconds;
    }
  };

  /// How a design went, in a few words.
  std::string outcome_of(const DesignResult &result);

  /// One row for each design; @p names of the variables.
  Table design_table(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);

  /// Thresholds of all designs.
  Table design_threshold_table(const std::vector<DesignResult> &designs);

  /// Modes of all designs.
  Table design_mode_table(const std::vector<DesignResult> &designs);

  /// The designs that stay quiet up to the largest friction coefficient, then those that do longest, as far as the screen has place for them.
  Table quietest_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);

  /// Which design is the quietest and which squeals most, and how many were refused or failed, one line each.
  std::vector<std::string> verdict(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);
} // namespace Squeal
