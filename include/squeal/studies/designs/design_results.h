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
  /// Stability threshold of a mode of a design.
  struct DesignThreshold
  {
    double                  friction_coefficient = 0.;
    double                  uncertainty          = 0.;
    std::string             event, mechanism, label; ///< label of the mode that begins or ceases to grow
    boost::optional<double> overlap;                 ///< overlap with the reference mode [-]; empty in a cluster or without reference mode
    std::string             partner;                 ///< label of the other mode; empty: none
    double                  frequency = 0.;          ///< [Hz]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &uncertainty &event &mechanism &label &overlap &partner &frequency;
    }
  };

  /// A mode of a design, at the smallest and largest friction coefficients at which it is in the band.
  struct DesignMode
  {
    std::string             label;     ///< label of the most similar reference mode; own_label if there is none
    std::string             own_label; ///< label from the component modes of the design
    boost::optional<double> overlap;   ///< overlap with the reference mode [-]; empty in a cluster or without reference mode
    double                  first_frequency = 0., last_friction_coefficient = 0., last_frequency = 0.; ///< [Hz], [-], [Hz]
    double                  last_growth_rate = 0., last_divergence_rate = 0., last_error = 0.;         ///< [1/s], [-], [-]
    std::string             verdict;                      ///< verdict at the last friction coefficient
    double                  largest_divergence_rate = 0.; ///< maximum over the sweep [-]
    boost::optional<double> onset;                        ///< first friction coefficient at which the mode begins to grow

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &label &own_label &overlap &first_frequency &last_friction_coefficient &last_frequency &last_growth_rate &last_divergence_rate
        &last_error &verdict &largest_divergence_rate &onset;
    }
  };

  /// Outcome of a design.
  enum class DesignOutcome
  {
    solved,
    refused, ///< parameters, geometry or mesh were rejected
    failed   ///< the solution failed, or its process ended early
  };

  template <>
  inline constexpr EnumName<DesignOutcome> enum_table<DesignOutcome>[] = {{DesignOutcome::solved, "solved"},
                                                                          {DesignOutcome::refused, "refused"},
                                                                          {DesignOutcome::failed, "failed"}};

  /// A friction coefficient and a mode that grows there.
  struct DesignGrowth
  {
    double      friction_coefficient = 0.;
    double      uncertainty          = 0.; ///< uncertainty of the friction coefficient; 0 if it is prescribed
    std::string label;
    double      frequency       = 0.; ///< [Hz]
    double      divergence_rate = 0.; ///< [-]
    double      error           = 0.; ///< estimated |δλ| / |λ| [-]; not set for onsets

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &uncertainty &label &frequency &divergence_rate &error;
    }
  };

  /// A row of the table of designs, with the data for the other tables.
  struct DesignResult
  {
    int                      number = 0; ///< counted from one
    std::vector<std::string> values;     ///< values of the variables, from the given model if the design does not set them
    DesignOutcome            outcome = DesignOutcome::failed;
    std::string              reason; ///< reason for rejection or failure

    int    n_dofs = 0, n_modes = 0, n_counted = 0; ///< modes at the smallest friction coefficient; real modes by inertia
    bool   is_complete = false;                    ///< the numbers of modes agree with all counts
    int    n_unstable = 0, n_undecided = 0;        ///< numbers of modes at the largest friction coefficient
    int    n_growing     = 0;                      ///< number of modes that grow at one or more friction coefficients
    double largest_error = 0., largest_residual = 0.;
    int    n_doubtful = 0; ///< number of steps in which modes were distinguished only by frequency

    boost::optional<DesignGrowth> onset;      ///< smallest friction coefficient at which a mode grows
    boost::optional<DesignGrowth> weak_onset; ///< smallest friction coefficient with a divergence rate above weak_divergence
    boost::optional<DesignGrowth> worst;      ///< unstable mode with the largest divergence rate over all friction coefficients
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

  /// Outcome of a design, in a few words.
  std::string outcome_of(const DesignResult &result);

  /// One row for each design; @p names: names of the variables.
  Table design_table(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);

  Table design_threshold_table(const std::vector<DesignResult> &designs);

  Table design_mode_table(const std::vector<DesignResult> &designs);

  /// The quietest solved designs: designs without weak_onset, then designs by descending weak_onset; limited to one screen.
  Table quietest_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);

  /// Lines with the quietest design, the loudest design and the numbers of solved, rejected, failed and incomplete designs.
  std::vector<std::string> verdict(const std::vector<std::string> &names, const std::vector<DesignResult> &designs);
} // namespace Squeal
