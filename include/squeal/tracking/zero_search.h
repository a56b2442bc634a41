#pragma once

#include <squeal/tracking/chart_point.h>

#include <functional>
#include <optional>
#include <vector>

namespace Squeal
{
  /// A function of one mode or two.
  enum class ModeFunction
  {
    growth,       ///< Re λ of a mode
    discriminant, ///< Re (λ_1 − λ_2)² of two modes
    frequency     ///< Im λ of a mode, less a bound
  };

  /// Modes at a point of a chart.
  struct ModesAtPoint
  {
    const ChartPoint *point;
    std::vector<int>  modes;
  };

  /// A function that changes its sign between two points of a chart.
  struct ZeroSearch
  {
    ModeFunction              function;
    double                    bound;         ///< of the frequency [rad/s]
    ModesAtPoint              first, second; ///< the same one or two modes at both points
    std::vector<ModesAtPoint> beyond;        ///< and at the points before and behind them, where there are such
  };

  /// Where between the points the zero is likely to lie; nothing where that cannot be told. The same on every process.
  using PredictZero = std::function<std::optional<double>(const ZeroSearch &)>;
} // namespace Squeal
