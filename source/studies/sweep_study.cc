#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/stability/branches.h>
#include <squeal/stability/certified_sweep.h>
#include <squeal/stability/mode_links.h>
#include <squeal/studies/contact_states.h>
#include <squeal/studies/frictionless_modes.h>
#include <squeal/studies/mode_fields.h>
#include <squeal/studies/sliding_results.h>
#include <squeal/studies/sweep_study.h>
#include <squeal/studies/sweep_tables.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Modes are followed somewhat beyond the band, so that none is lost that enters or leaves it.
    constexpr double band_margin = 0.05;
    /// Thresholds less certain than this times the tolerance of the search get vectors of their own, in as many rounds.
    constexpr double threshold_safety         = 3.;
    constexpr int    maximum_threshold_rounds = 2;

    // ------------------------------------------------------------- what is asked

    /// Friction coefficients at one load and speed.
    struct Line
    {
      enum class Kind
      {
        main,               ///< as the operation says
        without_dissipation, ///< the same without radial dissipation
        map                 ///< at another load or speed
      };

      Kind                kind;
      OperationParameters operation; ///< but for the friction coefficient
      double              value;     ///< load or speed of a line of the map
      std::vector<double> friction_coefficients;
    };

    std::vector<Line> lines_of(const Parameters &parameters)
    {
      const SweepParameters    &sweep     = parameters.sweep;
      const OperationParameters operation = parameters.operation;
      std::vector<Line>         lines     = {{Line::Kind::main, operation, 0., sweep.friction_coefficients.linear()}};
      if (sweep.compare_dissipation && operation.radial_dissipation != RadialDissipation::none)
        {
          lines.push_back({Line::Kind::without_dissipation, operation, 0., sweep.friction_coefficients.linear()});
          lines.back().operation.radial_dissipation = RadialDissipation::none;
        }
      if (sweep.map_parameter != MapParameter::none)
        for (const double value : sweep.map_values.geometric())
          {
            lines.push_back({Line::Kind::map, operation, value, sweep.map_grid()});
            (sweep.map_parameter == MapParameter::load ? lines.back().operation.load_per_side : lines.back().operation.rotation_speed) = value;
          }
      return lines;
    }

    /// One operating point of a line with its state of contact.
    struct SweepPoint
    {
      int            line;
      double         friction_coefficient;
      ContactStateAt contact;
    };

    OperationParameters operation_at(const Line &line, const double mu)
    {
      OperationParameters operation = line.operation;
      operation.friction_coefficient = mu;
      return operation;
    }

    /// Operating points with the same closed contact nodes: one coupled system, one basis.
    struct ContactRegime
    {
      std::vector<unsigned int> closed;
      std::vector<SweepPoint>   points;

      /// Numbers of the points of a line.
      std::vector<int> on_line(const int line) const
      {
        std::vector<int> result;
        for (std::size_t i = 0; i < points.size(); ++i)
          if (points[i].line == line)
            result.push_back(static_cast<int>(i));
        return result;
      }
    };

    std::vector<ContactRegime> contact_regimes(const std::vector<Line> &lines, const ContactStates &states, Run &run)
    {
      run.progress.begin("States of contact");
      std::vector<ContactRegime>                      regimes;
      std::map<std::vector<unsigned int>, std::size_t> numbers;
      std::size_t                                     n_points = 0;
      for (std::size_t l = 0; l < lines.size(); ++l)
        for (const double mu : lines[l].friction_coefficients)
          {
            run.progress.update(text("state ", n_points + 1));
            const ContactStateAt contact = states.at(operation_at(lines[l], mu));
            const auto [place, is_new]   = numbers.emplace(contact.closed, regimes.size());
            if (is_new)
              regimes.push_back({contact.closed, {}});
            regimes[place->second].points.push_back({static_cast<int>(l), mu, contact});
            ++n_points;
          }
      run.progress.finish(text(n_points, " operating points, ", regimes.size(), regimes.size() == 1 ? " contact set" : " contact sets"));
      return regimes;
    }

    // ------------------------------------------------------------- what comes out

    /// A chart over a stretch of a line on which the contact set stays the same.
    struct LineChart
    {
      int                      line;
      StabilityChart           chart;
      std::vector<std::string> labels; ///< of the branches
    };

    /// The most unstable mode at an operating point of the map.
    struct MapPoint
    {
      double          friction_coefficient, value;
      int             n_open;
      bool            is_known = false;
      ModalQuantities mode{};
      std::string     leader;
      int             n_unstable = 0, n_undecided = 0;
      double          error      = 0.;
    };

    struct SweepResults
    {
      std::vector<LineChart> charts;
      std::vector<MapPoint>  map;
    };

    bool is_in_band(const std::complex<double> &lambda, const double largest_frequency)
    {
      return lambda.imag() <= largest_frequency;
    }

    /// The mode of the band that grows most, or is damped least.
    int leading_mode(const ChartPoint &point, const double largest_frequency)
    {
      int result = -1;
      for (std::size_t j = 0; j < point.lambda.size(); ++j)
        if (is_in_band(point.lambda[j], largest_frequency) &&
            (result < 0 || modal_quantities(point.lambda[j]).divergence_rate > modal_quantities(point.lambda[result]).divergence_rate))
          result = static_cast<int>(j);
      return result;
    }

    // ----------------------------------------------------------- one contact set

    /// The system of a contact set with its basis and names.
    class RegimeModel
    {
    public:
      RegimeModel(const Scene &scene, const ContactRegime &regime, const std::vector<Line> &lines, const ContactStates &states, Run &run)
        : scene(scene)
        , regime(regime)
        , lines(lines)
        , states(states)
        , run(run)
        , omega_max(circular_frequency(run.parameters.discretization.maximum_frequency))
      {
        // Linearised where contact damps most: the basis starts from the responses to that damping
        const auto damps = [](const SweepPoint &point) {
          double sum = 0.;
          for (const auto *coefficients : {&point.contact.damping.radial, &point.contact.damping.sliding})
            for (const double c : *coefficients)
              sum += std::abs(c);
          return sum;
        };
        const SweepPoint &most = *std::max_element(regime.points.begin(), regime.points.end(),
                                                   [&](const SweepPoint &a, const SweepPoint &b) { return damps(a) < damps(b); });
        const OperationParameters operation = operation_at(lines[most.line], most.friction_coefficient);
        const auto                sliding   = states.sliding(operation);
        linearisation                       = linearise(scene, sliding ? &*sliding : nullptr, operation);

        // Neither real modes nor the factor know of damping
        Linearisation bare = linearisation;
        bare.coupled       = undamped(linearisation.coupled);
        frictionless       = frictionless_modes(scene, bare, run, band_margin);
        add_modal_damping(frictionless, run.parameters, linearisation);

        run.progress.begin("Reduced model");
        model = std::make_unique<ChartModel>(linearisation.coupled, *frictionless.inverse, frictionless.shift, *frictionless.real.vectors, omega_max,
                                             band_margin);
        run.progress.finish(text(model->size(), " vectors to start from"));
      }

      /// Proves what can be proved at all points, then follows branches and collects the map.
      void add_to(SweepResults &results)
      {
        certify();
        for (std::size_t l = 0; l < lines.size(); ++l)
          if (lines[l].kind != Line::Kind::map)
            for (const auto &stretch : stretches(static_cast<int>(l)))
              results.charts.push_back(follow(static_cast<int>(l), stretch));
        collect_map(results);
        write_shapes(results);
      }

      const FrictionlessModes &modes() const
      {
        return frictionless;
      }

    private:
      OperatingPoint operating_point(const int line, const double mu, const ContactStateAt &contact) const
      {
        return {mu, selected(contact.damping, regime.closed), line};
      }

      void certify()
      {
        std::vector<OperatingPoint> points;
        for (const SweepPoint &point : regime.points)
          points.push_back(operating_point(point.line, point.friction_coefficient, point.contact));

        run.progress.begin("Sweep");
        CertifiedSweepOptions options;
        options.tolerance     = run.parameters.sweep.tolerance;
        options.maximum_basis = static_cast<int>(run.parameters.sweep.maximum_basis);
        sweep                 = certified_sweep(*model, points, training(), options, nullptr, run.communicator, run.progress);
        for (std::size_t i = 0; i < points.size(); ++i)
          if (sweep.points[i])
            known.emplace(std::make_pair(points[i].line, points[i].friction_coefficient), *sweep.points[i]);
        run.progress.finish(text(known.size(), " of ", points.size(), " operating points, ", model->size(), " vectors, estimated error ",
                                 sweep.worst_error));
        run.count("basis vectors", model->size());
        run.measure("largest estimated error of lambda [-]", sweep.worst_error);
        if (!sweep.why_stopped.empty())
          run.progress.note(text("  note: ", points.size() - known.size(), " operating points miss the tolerance of ", options.tolerance, ": ",
                                 sweep.why_stopped, "; what is written was proved. Raise Sweep/Maximum basis or Sweep/Tolerance"));
      }

      /// Ends, middle and quarters of the outer lines: what lies between is evaluated later.
      std::vector<int> training() const
      {
        std::set<int> lines_here;
        for (const SweepPoint &point : regime.points)
          lines_here.insert(point.line);
        std::vector<int> result;
        for (const int line : {*lines_here.begin(), *lines_here.rbegin()})
          {
            const auto numbers = regime.on_line(line);
            const int  last    = static_cast<int>(numbers.size()) - 1;
            for (const int place : {last, last / 2, last / 4, 3 * last / 4, 0})
              if (std::find(result.begin(), result.end(), numbers[place]) == result.end())
                result.push_back(numbers[place]);
          }
        return result;
      }

      /// Proved friction coefficients of a line, in parts between which the contact set is another one.
      std::vector<std::vector<double>> stretches(const int line) const
      {
        std::vector<std::vector<double>> result;
        std::size_t                      last = 0;
        const auto                      &all  = lines[line].friction_coefficients;
        for (std::size_t i = 0; i < all.size(); ++i)
          if (known.count({line, all[i]}) > 0)
            {
              if (result.empty() || i != last + 1)
                result.emplace_back();
              result.back().push_back(all[i]);
              last = i;
            }
        return result;
      }

      /// Modes of a line, known ones or new ones; all processes must call.
      std::vector<ChartPoint> evaluate_line(const int line, const std::vector<double> &friction_coefficients)
      {
        std::vector<OperatingPoint> missing;
        for (const double mu : friction_coefficients)
          if (known.count({line, mu}) == 0)
            missing.push_back(operating_point(line, mu, states.at(operation_at(lines[line], mu))));
        const auto found = evaluate(*model, missing, run.communicator);
        for (std::size_t i = 0; i < missing.size(); ++i)
          known.emplace(std::make_pair(line, missing[i].friction_coefficient), found[i]);
        std::vector<ChartPoint> result;
        for (const double mu : friction_coefficients)
          result.push_back(known.at({line, mu}));
        return result;
      }

      LineChart follow(const int line, const std::vector<double> &friction_coefficients)
      {
        run.progress.begin("Branches");
        ChartOptions options;
        options.largest_frequency   = omega_max;
        options.threshold_tolerance = run.parameters.sweep.threshold_tolerance;
        std::size_t n_evaluated     = 0;
        const auto  chart_of        = [&](const ChartOptions &options) {
          return stability_chart(
            friction_coefficients,
            [&](const std::vector<double> &mus) {
              n_evaluated += mus.size();
              run.progress.update(text(n_evaluated, " points"));
              return evaluate_line(line, mus);
            },
            options);
        };
        // Thresholds ask for more than λ: where modes hardly interact, μ_c moves far for a small error. Which do, the
        // values of the grid tell.
        ChartOptions coarse        = options;
        coarse.maximum_refinements = 0;
        LineChart result{line, chart_of(coarse), {}};
        sharpen(result, friction_coefficients);
        for (int round = 0; round < maximum_threshold_rounds; ++round)
          {
            result.chart = chart_of(options);
            if (!sharpen(result, friction_coefficients))
              break;
          }
        result.labels = labels(result.chart);
        const StabilityChart &chart = result.chart;
        run.progress.finish(text(chart.branches.size(), " branches, ", chart.thresholds.size(), " thresholds, ", chart.crossings.size(),
                                 " crossings of the band's edge, ", chart.points.size() - friction_coefficients.size(), " refinements"));
        if (chart.n_doubtful_steps > 0)
          run.progress.note(text("  note: in ", chart.n_doubtful_steps, " steps modes could be told apart by their frequencies only"));
        return result;
      }

      /**
       * Adds to the basis what the modes of uncertain thresholds lack on both sides, and forgets the results
       * there and at refinements: they were found without it. Returns whether there was anything to add.
       */
      bool sharpen(const LineChart &line, const std::vector<double> &grid)
      {
        const StabilityChart            &chart = line.chart;
        std::vector<ChartModel::ModesAt> sets;
        for (const Threshold &threshold : chart.thresholds)
          {
            if (threshold.share_of_modes <= threshold_safety * run.parameters.sweep.threshold_tolerance)
              continue;
            // Values of the grid beside it: next to a coalescence the vectors of both modes are nearly the same
            const auto above = std::upper_bound(grid.begin(), grid.end(), threshold.friction_coefficient);
            for (const auto place : {above, above == grid.begin() ? above : std::prev(above)})
              {
                if (place == grid.end())
                  continue;
                const auto i = std::find_if(chart.points.begin(), chart.points.end(),
                                            [&](const ChartPoint &point) { return point.friction_coefficient == *place; }) -
                               chart.points.begin();
                ChartModel::ModesAt set{operating_point(line.line, *place, states.at(operation_at(lines[line.line], *place))), &chart.points[i], {}};
                for (const int branch : {threshold.branch, threshold.partner})
                  if (branch >= 0 && chart.branches[branch].modes[i] >= 0)
                    set.modes.push_back(chart.branches[branch].modes[i]);
                sets.push_back(set);
              }
          }
        if (sets.empty())
          return false;
        const auto vectors = model->new_vectors(sets);
        if (!vectors || model->size() + vectors->NumVectors() > static_cast<int>(run.parameters.sweep.maximum_basis))
          return false;
        model->extend(*vectors);
        for (std::size_t i = 0; i < chart.points.size(); ++i)
          if (chart.is_refinement[i])
            known.erase({line.line, chart.points[i].friction_coefficient});
        for (const ChartModel::ModesAt &set : sets)
          known.erase({line.line, set.point.friction_coefficient});
        return true;
      }

      /// Right vectors of some modes of a point at full order.
      std::pair<MultiVector, MultiVector> shapes(const ChartPoint &point, const std::vector<int> &modes) const
      {
        const ComplexDenseMatrix X = padded(selected_columns(point.right, modes), model->size());
        return {model->reduced().basis() * real_part(X), model->reduced().basis() * imaginary_part(X)};
      }

      /// Names of branches after the modes with which they begin.
      std::vector<std::string> labels(const StabilityChart &chart) const
      {
        std::vector<std::string> result(chart.branches.size());
        for (std::size_t i = 0; i < chart.points.size(); ++i)
          {
            std::vector<int> modes, branches;
            for (std::size_t b = 0; b < chart.branches.size(); ++b)
              if (const int j = chart.branches[b].modes[i]; j >= 0 && result[b].empty())
                {
                  modes.push_back(j);
                  branches.push_back(static_cast<int>(b));
                }
            if (modes.empty())
              continue;
            const auto [re, im] = shapes(chart.points[i], modes);
            const auto names    = labels_of(identify_coupled(scene, linearisation, frictionless, re, &im));
            for (std::size_t k = 0; k < modes.size(); ++k)
              result[branches[k]] = names[k];
          }
        return result;
      }

      void collect_map(SweepResults &results)
      {
        // Named after the branch of the first chart that the leading mode resembles most at the nearest friction coefficient
        const auto name = [&](const ChartPoint &point, const int mode) {
          std::string                   label;
          double                        largest = 0.;
          for (const LineChart &line : results.charts)
            {
              const auto &points  = line.chart.points;
              const auto  nearest = std::min_element(points.begin(), points.end(), [&](const ChartPoint &a, const ChartPoint &b) {
                return std::abs(a.friction_coefficient - point.friction_coefficient) < std::abs(b.friction_coefficient - point.friction_coefficient);
              });
              const std::size_t i = nearest - points.begin();
              for (std::size_t b = 0; b < line.chart.branches.size(); ++b)
                if (const int j = line.chart.branches[b].modes[i]; j >= 0)
                  {
                    std::complex<double> product = 0.;
                    for (int row = 0; row < std::min(point.right.n_rows(), nearest->right.n_rows()); ++row)
                      product += std::conj(point.right(row, mode)) * nearest->right(row, j);
                    if (std::abs(product) > largest)
                      {
                        largest = std::abs(product);
                        label   = line.labels[b];
                      }
                  }
              break;
            }
          return label;
        };

        for (const SweepPoint &operating : regime.points)
          {
            if (lines[operating.line].kind != Line::Kind::map)
              continue;
            MapPoint result{operating.friction_coefficient, lines[operating.line].value,
                            static_cast<int>(scene.interface.size() - regime.closed.size())};
            const auto found = known.find({operating.line, operating.friction_coefficient});
            if (found != known.end())
              {
                const ChartPoint &point = found->second;
                const int         mode  = leading_mode(point, omega_max);
                result.is_known         = mode >= 0;
                result.mode             = modal_quantities(point.lambda[mode]);
                result.leader           = name(point, mode);
                result.error            = model->largest_error(point);
                for (std::size_t j = 0; j < point.lambda.size(); ++j)
                  if (is_in_band(point.lambda[j], omega_max))
                    {
                      result.n_unstable += point.verdicts[j] == Verdict::unstable;
                      result.n_undecided += point.verdicts[j] == Verdict::undecided;
                    }
              }
            results.map.push_back(result);
          }
      }

      void write_shapes(const SweepResults &results)
      {
        const auto &wanted = run.parameters.sweep.mode_shapes;
        if (wanted.empty() || run.parameters.output.fields == FieldSelection::none)
          return;
        const FieldWriter writer(*scene.model, scene.interface, linearisation.closed, run.folder());
        run.progress.begin("Mode shapes");
        int n_written = 0;
        for (const double mu : wanted)
          if (states.at(operation_at(lines[0], mu)).closed == regime.closed)
            {
              const ChartPoint point = evaluate_line(0, {mu}).front();
              const int        mode  = leading_mode(point, omega_max);
              if (mode < 0 || !is_growing(point.lambda[mode]))
                {
                  run.progress.note(text("  no mode grows at mu = ", mu, ": no mode shape is written"));
                  continue;
                }
              const auto [re, im]     = shapes(point, {mode});
              const std::string label = labels_of(identify_coupled(scene, linearisation, frictionless, re, &im)).front();
              Linearisation     here  = linearisation;
              here.coupled            = with_contact_damping(linearisation.coupled, selected(states.at(operation_at(lines[0], mu)).damping, regime.closed));
              const ModeField field   = mode_field(scene, here, text("mu_", mu, "_", file_label(label)), point.lambda[mode], re, im);
              writer.write_mode(field);
              if (run.parameters.output.animation_frames > 0)
                writer.write_animation(field, run.parameters.output.animation_frames);
              ++n_written;
            }
        (void)results;
        run.progress.finish(text(n_written, " leading modes"));
      }

      const Scene               &scene;
      const ContactRegime       &regime;
      const std::vector<Line>   &lines;
      const ContactStates       &states;
      Run                       &run;
      const double               omega_max;
      Linearisation              linearisation;
      FrictionlessModes          frictionless;
      std::unique_ptr<ChartModel> model;
      CertifiedSweep             sweep;
      std::map<std::pair<int, double>, ChartPoint> known; ///< by line and friction coefficient
    };

    // ------------------------------------------------------------------- tables

    Table map_table(std::vector<MapPoint> points, const MapParameter parameter)
    {
      std::sort(points.begin(), points.end(), [](const MapPoint &a, const MapPoint &b) {
        return std::make_pair(a.value, a.friction_coefficient) < std::make_pair(b.value, b.friction_coefficient);
      });
      const bool is_load = parameter == MapParameter::load;
      Table      table({{"mu", "-", 4},
                   {is_load ? "load per side" : "rotation speed", is_load ? "N" : "rad/s", 3},
                   {"unstable modes", "-"},
                   {"undecided modes", "-"},
                   {"label", ""},
                   {"frequency", "Hz", 2},
                   {"growth rate", "1/s", 4},
                   {"divergence rate", "%", 4},
                   {"estimated error of lambda", "-", 1, true},
                   {"open contact nodes", "-"}});
      for (const MapPoint &point : points)
        {
          const auto known = [&](const Cell &cell) { return point.is_known ? cell : Cell(); };
          table.add_row({point.friction_coefficient, point.value, known(static_cast<long>(point.n_unstable)),
                         known(static_cast<long>(point.n_undecided)), known(point.leader), known(point.mode.frequency),
                         known(point.mode.growth_rate), known(100. * point.mode.divergence_rate), known(point.error),
                         static_cast<long>(point.n_open)});
        }
      return table;
    }
  } // namespace

  void run_sweep_study(Run &run)
  {
    const Parameters &parameters = run.parameters;
    const double      omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    // ------------------------------------------------- scene, states of contact
    Scene scene = mesh_scene(run);
    if (run.is_dry)
      {
        run.progress.note("  dry run: nothing was computed or written");
        return;
      }
    assemble_scene(scene, run);
    const ContactStates     states(scene, run);
    const std::vector<Line> lines   = lines_of(parameters);
    const auto              regimes = contact_regimes(lines, states, run);

    // ------------------------------------------------------------- every regime
    SweepResults results;
    for (const ContactRegime &regime : regimes)
      RegimeModel(scene, regime, lines, states, run).add_to(results);

    // ------------------------------------------------------------------ results
    for (std::size_t c = 0; c < results.charts.size(); ++c)
      {
        const LineChart  &line = results.charts[c];
        const std::string suffix = lines[line.line].kind == Line::Kind::main ? "" : "_without_dissipation";
        run.folder().write("branches" + suffix + ".csv",
                           [&](std::ostream &stream) { branch_table(line.chart, line.labels, omega_max).write_csv(stream); });
        run.write_table("thresholds" + suffix, threshold_table(line.chart, line.labels));
        run.folder().write("counts" + suffix + ".csv", [&](std::ostream &stream) { count_table(line.chart).write_csv(stream); });
        run.folder().write("band_crossings" + suffix + ".csv",
                           [&](std::ostream &stream) { crossing_table(line.chart, line.labels).write_csv(stream); });
      }
    if (!results.map.empty())
      run.write_table("map", map_table(results.map, parameters.sweep.map_parameter));
    run.finish();
  }
} // namespace Squeal
