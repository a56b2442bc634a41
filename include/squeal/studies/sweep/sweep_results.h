#pragma once

#include <squeal/modes/contour_count.h>
#include <squeal/studies/sweep/sweep_charts.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// What is known about stability at one friction coefficient and one load or speed.
  struct MapCell
  {
    double                         friction_coefficient; ///< [-]
    double                         value;                ///< load [N] or speed [rad/s]
    std::size_t                    n_open;               ///< contact nodes that are lifted
    std::optional<ModalQuantities> leading;              ///< of the most unstable mode; nothing where none was computed
    ModeLabel                      label;                ///< of that mode
    int                            n_unstable  = 0;
    int                            n_undecided = 0;  ///< modes whose growth is undecided
    double                         error       = 0.; ///< largest estimated |δλ| / |λ| [-]
  };

  /// Appends the points of the map in a contact set; modes are named after the branches of the chart @p main, unless it is null.
  void append_map_cells(const SweepModel &model, const SweepChart *main, std::vector<MapCell> &cells);

  /// A mode of the band at one of the friction coefficients of the complex plane.
  struct PlaneMode
  {
    double               friction_coefficient; ///< [-]
    RadialDissipation    dissipation;
    std::complex<double> lambda; ///< [rad/s]
    ModeLabel            label;
    double               error; ///< estimated |δλ| / |λ| [-]
    Verdict              verdict;
  };

  /**
   * Appends the modes of the band at the friction coefficients of the complex plane that belong to the contact set, on the main line
   * and on that without radial dissipation, from the basis as it is then: charts do not change.
   */
  void append_plane_modes(SweepModel &model, std::vector<PlaneMode> &modes);

  /// Number of modes at one friction coefficient by the sweep and by the argument principle.
  struct CountAt
  {
    double       friction_coefficient;
    int          n_found; ///< in the rectangle
    ContourCount count;
  };

  /// Counts the modes at the friction coefficients that the parameters choose, where they belong to the contact set.
  void append_counts(SweepModel &model, std::vector<CountAt> &counts);

  /// Writes fields of the leading modes at the friction coefficients that the parameters choose, where they belong to the contact set.
  void write_leading_modes(SweepModel &model);
} // namespace Squeal
