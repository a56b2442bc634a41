// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/csv_file.h>
#include <squeal/parameters/number_list.h>
#include <squeal/studies/updating/measured_modes.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    constexpr const char *parameter_of_modes = "Updating/Measured modes";

    /// All columns; the first three are required.
    const std::vector<std::string> known_columns = {
      "state", "label", "frequency [Hz]", "member", "deviation [Hz]", "damping ratio [%]", "damping deviation [%]"};
    constexpr std::size_t n_required = 3;

    /// Access to the cells of a row by column name.
    class Row
    {
    public:
      Row(const CsvFile &file, const std::size_t number)
        : where(file.where[number])
        , file(file)
        , row(number)
      {}

      /// Text in a column; empty if the column is missing.
      std::string text(const char *column) const
      {
        const std::size_t place = file.column(column);
        return place == file.names.size() ? "" : file.rows[row][place];
      }

      /// Number in a column; empty if the column is missing or the cell is empty.
      std::optional<double> number(const char *column) const
      {
        return text(column).empty() ? std::nullopt : std::optional(file.number(row, file.column(column)));
      }

      std::optional<double> positive_number(const char *column) const
      {
        const auto value = number(column);
        if (value && !(*value > 0.))
          refuse(std::string(column) + " is " + exact_text(*value) + ", not positive", "give a positive number");
        return value;
      }

      [[noreturn]] void refuse(const std::string &what, const std::string &change) const
      {
        throw ParameterError(what, where, change);
      }

      const std::string &where;

    private:
      const CsvFile    &file;
      const std::size_t row;
    };

    void check_columns(const CsvFile &file)
    {
      const std::string known = boost::algorithm::join(known_columns, ", ");
      for (const std::string &name : file.names)
        if (std::find(known_columns.begin(), known_columns.end(), name) == known_columns.end())
          throw ParameterError("unknown column " + in_quotes(name), file.where_names, "remove or rename it; the columns are " + known);
      file.check_repeated_columns();
      for (std::size_t i = 0; i < n_required; ++i)
        if (file.column(known_columns[i]) == file.names.size())
          throw ParameterError("missing column " + in_quotes(known_columns[i]), file.where_names, "add it; the columns are " + known);
    }

    /// Smallest accepted deviation relative to the frequency, close to the rounding errors of the frequency [-].
    constexpr double smallest_deviation = 1e-12;

    MeasuredMode mode_of(const Row &row)
    {
      const std::string state = row.text("state");
      const auto        names = enum_names<MeasuredState>();
      if (std::find(names.begin(), names.end(), state) == names.end())
        row.refuse(in_quotes(state) + " is not a state", "write one of " + boost::algorithm::join(names, ", "));
      const std::string label = single_spaced(row.text("label")), member = row.text("member");
      if (label.empty())
        row.refuse("the row has no label", "give the label of the mode, as listed by a stability run");
      const auto number = parse_number(member);
      if (!member.empty() && member != "lowest" && member != "highest" && !(number && *number >= 1. && *number == std::floor(*number)))
        row.refuse(in_quotes(member) + " is not a valid entry in the column `member`",
                   "write lowest, highest or an integer >= 1, or leave the cell empty for the mean");
      const auto frequency = row.positive_number("frequency [Hz]");
      if (!frequency)
        row.refuse("the row has no frequency", "give a frequency in Hz");

      const auto deviation = row.positive_number("deviation [Hz]");
      if (deviation && !(*deviation > smallest_deviation * *frequency))
        row.refuse("the deviation of " + exact_text(*deviation) + " Hz is within the rounding error of the frequency",
                   "give the standard deviation of the measurement");
      MeasuredMode result{enum_value<MeasuredState>(state), label, member, {*frequency, deviation ? *deviation : 0.}, {}, row.where};
      const auto   ratio = row.number("damping ratio [%]"), ratio_deviation = row.positive_number("damping deviation [%]");
      if (ratio.has_value() != ratio_deviation.has_value())
        row.refuse("only one of damping ratio and damping deviation is given", "give both values, or leave both cells empty");
      if (ratio && result.state != MeasuredState::complex)
        row.refuse(state + " modes are computed without damping and cannot have a damping ratio",
                   "set the state to complex, or leave damping ratio and damping deviation empty");
      if (ratio)
        result.damping_ratio = Measured{0.01 * *ratio, 0.01 * *ratio_deviation};
      return result;
    }

    /// Label without the sign of a doublet.
    std::string shape_of(const std::string &label)
    {
      return boost::ends_with(label, " -") || boost::ends_with(label, " +") ? label.substr(0, label.size() - 2) : label;
    }

    /// Distinct labels of a state, for messages.
    std::string labels_of(const MeasuredState state, const std::vector<ComputedMode> &modes)
    {
      constexpr std::size_t    most = 40;
      std::vector<std::string> result;
      for (const ComputedMode &mode : modes)
        if (mode.state == state && std::find(result.begin(), result.end(), mode.label) == result.end())
          result.push_back(mode.label);
      if (result.size() > most)
        {
          result.resize(most);
          result.emplace_back("...");
        }
      return result.empty() ? "none" : boost::algorithm::join(result, ", ");
    }

    /// Modes with the measured label, by ascending frequency.
    std::vector<const ComputedMode *> modes_of_label(const MeasuredMode &measured, const std::vector<ComputedMode> &modes)
    {
      std::vector<const ComputedMode *> result;
      for (const ComputedMode &mode : modes)
        if (mode.state == measured.state && (mode.label == measured.label || shape_of(mode.label) == measured.label))
          result.push_back(&mode);
      std::stable_sort(result.begin(), result.end(),
                       [](const ComputedMode *a, const ComputedMode *b) { return a->lambda.imag() < b->lambda.imag(); });
      return result;
    }
  } // namespace

  std::size_t MeasuredModes::n_numbers() const
  {
    return modes.size() +
           std::count_if(modes.begin(), modes.end(), [](const MeasuredMode &mode) { return mode.damping_ratio.has_value(); });
  }

  bool MeasuredModes::has(const MeasuredState state) const
  {
    return std::any_of(modes.begin(), modes.end(), [state](const MeasuredMode &mode) { return mode.state == state; });
  }

  MeasuredModes read_measured_modes(const std::string &path)
  {
    const CsvFile file = read_csv(path, parameter_of_modes, "measured mode");
    check_columns(file);
    MeasuredModes result;
    for (std::size_t i = 0; i < file.rows.size(); ++i)
      result.modes.push_back(mode_of(Row(file, i)));
    const auto has_deviation = [](const MeasuredMode &mode) { return mode.frequency.deviation > 0.; };
    result.are_relative      = std::none_of(result.modes.begin(), result.modes.end(), has_deviation);
    for (MeasuredMode &mode : result.modes)
      {
        if (result.are_relative)
          mode.frequency.deviation = default_deviation * mode.frequency.value;
        if (!has_deviation(mode))
          throw ParameterError("this frequency has no deviation, but other frequencies have one", mode.where,
                               "give `deviation [Hz]` for all modes or for none");
        if (result.are_relative && mode.damping_ratio)
          throw ParameterError("the damping ratio has a deviation, but the frequencies have none", mode.where,
                               "give `deviation [Hz]` for all frequencies");
      }
    return result;
  }

  namespace
  {
    /// Modes whose weighted mean is the counterpart of a measured mode.
    struct WeightedModes
    {
      std::vector<const ComputedMode *> modes;
      std::vector<double>               weights; ///< weights with sum 1
      double                            mac;     ///< MAC of the measured shape and its projection on the span of the shapes [-]
    };

    /// Relative frequency difference up to which the shapes of two modes, such as a doublet, may mix [-].
    constexpr double mixing_difference = 0.02;

    /// The mode whose shape y_1 is most similar to a measured shape x, and a second mode with which it may mix: x ≈ c_1 y_1 + c_2 y_2 by
    /// least squares, with weights proportional to |c_j|² ‖y_j‖². If x is a multiple of y_1, the first weight is 1.
    WeightedModes most_similar(const MeasuredMode &mode, const MeasuredModes &measured, const std::vector<ComputedMode> &modes)
    {
      const Eigen::VectorXcd &shape = measured.sensors.shapes.at(mode.label);
      const auto              best  = [&](const ComputedMode *beside) {
        std::pair<const ComputedMode *, double> found{nullptr, 0.};
        for (const ComputedMode &candidate : modes)
          if (candidate.state == mode.state && &candidate != beside &&
              (beside == nullptr || std::abs(candidate.lambda.imag() - beside->lambda.imag()) <= mixing_difference * beside->lambda.imag()))
            if (const double mac = modal_assurance_criterion(shape, candidate.at_sensors); mac > found.second)
              found = {&candidate, mac};
        return found.first;
      };
      WeightedModes result{{}, {}, 0.};
      if (const ComputedMode *first = best(nullptr))
        {
          result.modes = {first};
          if (const ComputedMode *second = best(first))
            result.modes.push_back(second);
          const auto         n = static_cast<Eigen::Index>(result.modes.size());
          ComplexDenseMatrix Y(shape.size(), n);
          for (Eigen::Index j = 0; j < n; ++j)
            Y.col(j) = result.modes[j]->at_sensors.normalized();
          const Eigen::VectorXcd c     = Y.colPivHouseholderQr().solve(shape);
          const Eigen::VectorXd  parts = c.cwiseAbs2() / c.squaredNorm();
          result.weights.assign(parts.begin(), parts.end());
          result.mac = modal_assurance_criterion(shape, Y * c);
        }
      if (!(result.mac >= measured.least_mac))
        throw SolverError(text("no computed mode is similar to the measured shape ", in_quotes(mode.label), ": the largest MAC is ",
                               result.mac, result.modes.empty() ? "" : " (" + result.modes.front()->label + ")"),
                          mode.where, "check positions and directions of the sensors, remove the mode, or lower Updating/Least MAC");
      return result;
    }
  } // namespace

  Counterpart counterpart_of(const MeasuredMode &measured, const MeasuredModes &all, const std::vector<ComputedMode> &modes)
  {
    Counterpart                       result{};
    std::vector<const ComputedMode *> found;
    std::vector<double>               weights;
    if (all.sensors.has(measured.label))
      {
        const WeightedModes similar = most_similar(measured, all, modes);
        found                       = similar.modes;
        weights                     = similar.weights;
        result.mac                  = similar.mac;
      }
    else
      found = modes_of_label(measured, modes);
    const auto refuse = [&](const std::string &what) {
      throw SolverError(text(what, " among the ", to_string(measured.state), " modes in the band"), measured.where,
                        "use an existing label (" + labels_of(measured.state, modes) + ") and member, or raise Band/Maximum frequency");
    };
    if (found.empty())
      refuse("there is no mode " + in_quotes(measured.label));
    if (!measured.member.empty())
      {
        const auto        number = parse_number(measured.member);
        const std::size_t place  = number ? static_cast<std::size_t>(*number) - 1 : measured.member == "highest" ? found.size() - 1 : 0;
        if (place >= found.size())
          refuse(text("there is no member ", place + 1, " of ", in_quotes(measured.label), ", only ", found.size()));
        found = {found[place]};
      }
    if (weights.empty())
      weights.assign(found.size(), 1. / static_cast<double>(found.size()));
    result.label = found.front()->label;
    const auto n = found.front()->derivatives.size();
    result.frequency_rates.assign(n, 0.);
    result.damping_ratio_rates.assign(n, 0.);
    for (std::size_t i = 0; i < found.size(); ++i)
      {
        const ComputedMode *mode   = found[i];
        const double        weight = weights[i], re = mode->lambda.real(), im = mode->lambda.imag(), size = std::abs(mode->lambda);
        result.frequency += weight * hertz(im);
        result.damping_ratio -= weight * re / size;
        for (std::size_t p = 0; p < n; ++p)
          {
            const std::complex<double> rate = mode->derivatives[p];
            result.frequency_rates[p] += weight * hertz(rate.imag());
            // d(−R/|λ|) = −(ω² R' − R ω ω') / |λ|³
            result.damping_ratio_rates[p] -= weight * im * (im * rate.real() - re * rate.imag()) / std::pow(size, 3);
          }
      }
    return result;
  }
} // namespace Squeal
