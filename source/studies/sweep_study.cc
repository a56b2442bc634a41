#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/base/version.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/stability/branches.h>
#include <squeal/stability/error_controlled_sweep.h>
#include <squeal/stability/contour_count.h>
#include <squeal/stability/mode_links.h>
#include <squeal/studies/contact_states.h>
#include <squeal/studies/frictionless_modes.h>
#include <squeal/studies/mode_fields.h>
#include <squeal/studies/parameter_usage.h>
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

    // ------------------------------------------------------------- what is asked

    /// Friction coefficients at one load and speed.
    struct Line
    {
      enum class Kind
      {
        main,                ///< as the operation says
        without_dissipation, ///< the same without radial dissipation
        map                  ///< at another load or speed
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
            (sweep.map_parameter == MapParameter::load ? lines.back().operation.load_per_side : lines.back().operation.rotation_speed) =
              value;
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
      OperationParameters operation  = line.operation;
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
      std::vector<ContactRegime>                       regimes;
      std::map<std::vector<unsigned int>, std::size_t> numbers;
      std::size_t                                      n_points = 0;
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

    /// Number of modes at one friction coefficient by the sweep and by the argument principle.
    struct CountAt
    {
      double       friction_coefficient;
      int          n_found; ///< in the rectangle
      ContourCount count;
    };

    /// Modes over the friction coefficient at one load and speed, with the names of the branches.
    struct ChartLine
    {
      StabilityChart         chart;
      std::vector<ModeLabel> labels; ///< one for each branch
    };

    /// What is known about stability at one friction coefficient and one load or speed.
    struct MapCell
    {
      double    friction_coefficient = 0.; ///< [-]
      double    value                = 0.; ///< load [N] or speed [rad/s]
      double    growth_rate          = 0.; ///< of the most unstable mode [1/s]
      double    divergence_rate      = 0.; ///< of the most unstable mode [-]
      double    frequency            = 0.; ///< of the most unstable mode [Hz]
      int       n_unstable           = 0;
      int       n_undecided          = 0; ///< modes whose growth is undecided
      int       n_open               = 0; ///< contact nodes that are lifted
      ModeLabel leader;                   ///< label of the most unstable mode
      bool      is_known = false;         ///< whether it was computed
      double    error    = 0.;            ///< largest estimated |δλ| / |λ| [-]
    };

    struct SweepResults
    {
      std::map<int, std::vector<ChartLine>>        charts; ///< by line: stretches with one contact set each
      std::map<std::pair<double, double>, MapCell> map;    ///< by load or speed, and friction coefficient
      std::vector<CountAt>                         counts;
    };

    /// Everything on which the results of a sweep depend: the version of the program, the parameters, the mesh.
    std::string identity(const Run &run, const Scene &scene)
    {
      // What only adds to the results does not change them
      Parameters parameters        = run.parameters;
      parameters.output            = {};
      parameters.sweep.mode_shapes = {};
      parameters.sweep.counts      = {};
      std::ostringstream stream;
      stream << "# squeal " << version << '\n';
      parameters.print(stream, false);
      stream << "# mesh: " << scene.mesh.hexahedra.size() << " hexahedra, " << scene.model->free_map().NumGlobalElements()
             << " dofs, nodes " << std::hex << checksum(scene.mesh) << '\n';
      return stream.str();
    }

    bool is_in_band(const std::complex<double> &lambda, const double largest_circular_frequency)
    {
      return lambda.imag() <= largest_circular_frequency;
    }

    /// The mode of the band that grows most, or is damped least.
    int leading_mode(const ChartPoint &point, const double largest_circular_frequency)
    {
      int result = -1;
      for (std::size_t j = 0; j < point.lambda.size(); ++j)
        if (is_in_band(point.lambda[j], largest_circular_frequency) &&
            (result < 0 || modal_quantities(point.lambda[j]).divergence_rate > modal_quantities(point.lambda[result]).divergence_rate))
          result = static_cast<int>(j);
      return result;
    }

    /// Of every branch [1/s]; zero for one that never grows.
    std::vector<double> largest_growth_rates(const StabilityChart &chart)
    {
      std::vector<double> result(chart.branches.size(), 0.);
      for (std::size_t i = 0; i < chart.points.size(); ++i)
        for (std::size_t b = 0; b < chart.branches.size(); ++b)
          if (const int j = chart.branches[b].modes[i]; j >= 0 && chart.points[i].verdicts[j] == Verdict::unstable)
            result[b] = std::max(result[b], chart.points[i].lambda[j].real());
      return result;
    }

    // ----------------------------------------------------------- one contact set

    /// The system of a contact set with its basis and names.
    class RegimeModel
    {
    public:
      RegimeModel(const Scene             &scene,
                  const ContactRegime     &regime,
                  const std::size_t        number,
                  const std::vector<Line> &lines,
                  const ContactStates     &states,
                  ChartCheckpoint         &checkpoint,
                  Run                     &run)
        : scene(scene)
        , regime(regime)
        , number(number)
        , lines(lines)
        , states(states)
        , checkpoint(checkpoint)
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
        const SweepPoint         &most      = *std::max_element(regime.points.begin(), regime.points.end(),
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
        model = std::make_unique<ChartModel>(linearisation.coupled, *frictionless.inverse, frictionless.shift, *frictionless.real.vectors,
                                             omega_max, band_margin);
        run.progress.finish(text(model->size(), " vectors to start from"));
      }

      /// Evaluates all points to the tolerance, then follows branches and collects the map.
      void add_to(SweepResults &results)
      {
        evaluate_points();
        for (std::size_t l = 0; l < lines.size(); ++l)
          if (lines[l].kind != Line::Kind::map)
            for (const auto &stretch : stretches(static_cast<int>(l)))
              {
                results.charts[static_cast<int>(l)].push_back(follow(static_cast<int>(l), stretch));
                if (lines[l].kind == Line::Kind::main)
                  compare_with_inertia(results.charts[static_cast<int>(l)].back().chart);
              }
        collect_map(results);
        count(results);
        write_shapes();
      }

    private:
      OperatingPoint operating_point(const int line, const double mu, const ContactStateAt &contact) const
      {
        return {mu, selected(contact.damping, regime.closed).values(), line};
      }

      void evaluate_points()
      {
        std::vector<OperatingPoint> points;
        for (const SweepPoint &point : regime.points)
          points.push_back(operating_point(point.line, point.friction_coefficient, point.contact));

        run.progress.begin("Sweep");
        ErrorControlledSweepOptions options;
        options.tolerance                = run.parameters.sweep.tolerance;
        options.maximum_basis            = static_cast<int>(run.parameters.sweep.maximum_basis);
        const auto                 store = store_of("sweep");
        const ErrorControlledSweep sweep =
          error_controlled_sweep(*model, points, training(), options, store.get(), run.communicator, run.progress);
        for (std::size_t i = 0; i < points.size(); ++i)
          if (sweep.points[i])
            known.emplace(std::make_pair(points[i].line, points[i].friction_coefficient), *sweep.points[i]);
        run.progress.finish(
          text(known.size(), " of ", points.size(), " operating points, ", model->size(), " vectors, estimated error ", sweep.worst_error));
        run.count("basis vectors", model->size());
        run.measure("largest estimated error of lambda [-]", sweep.worst_error);
        if (!sweep.why_stopped.empty())
          run.progress.note(text("  note: ", points.size() - known.size(), " operating points miss the tolerance of ", options.tolerance,
                                 ": ", sweep.why_stopped, "; what is written meets it. Raise Sweep/Maximum basis or Sweep/Tolerance"));
      }

      /// Where a phase of the work on this contact set keeps its results.
      std::unique_ptr<ChartStore> store_of(const std::string &phase) const
      {
        return checkpoint.part(text("contact set ", number, " of ", regime.closed.size(), " nodes, ", phase), linearisation.coupled.map());
      }

      /// Without friction as many modes as inertia counts.
      void compare_with_inertia(const StabilityChart &chart) const
      {
        const auto       &real   = frictionless.real;
        const std::size_t n_real = n_in_band(real.eigenvalues, omega_max * omega_max) - real.n_rigid_body;
        if (chart.points.front().friction_coefficient != 0.)
          run.progress.note("  note: the sweep does not begin at mu = 0: numbers of modes are compared among its values only");
        else if (chart.counts.front().n_modes + chart.counts.front().n_overdamped != static_cast<int>(n_real))
          run.progress.note(text("  note: ", chart.counts.front().n_modes, " modes lie in the band at mu = 0, where ", n_real,
                                 " real modes were counted: damping moved some across its end"));
        if (n_incomplete(chart) > 0)
          run.progress.note(
            text("  note: at ", n_incomplete(chart), " points the number of modes is not the expected one, see counts.csv"));
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
            {
              const OperatingPoint point  = operating_point(line, mu, states.at(operation_at(lines[line], mu)));
              const auto           stored = refinements ? refinements->find(point) : std::nullopt;
              if (stored)
                known.emplace(std::make_pair(line, mu), *stored);
              else
                missing.push_back(point);
            }
        evaluate(*model, missing, run.communicator, [&](const int i, const ChartPoint &found) {
          known.emplace(std::make_pair(line, missing[i].friction_coefficient), found);
          if (refinements)
            refinements->keep(missing[i], found);
        });
        std::vector<ChartPoint> result;
        for (const double mu : friction_coefficients)
          result.push_back(known.at({line, mu}));
        return result;
      }

      ChartLine follow(const int line, const std::vector<double> &friction_coefficients)
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
        // Thresholds ask for more than λ: where modes hardly interact, μ_c moves far for a small error. The values of the grid
        // tell between which modes there are thresholds; which of them are uncertain is not asked, for that hangs on rounding.
        ChartOptions coarse        = options;
        coarse.maximum_refinements = 0;
        refinements                = store_of(text("line ", line, " from ", exact_text(friction_coefficients.front())));
        sharpen(line, chart_of(coarse), friction_coefficients);
        ChartLine result{chart_of(options), {}};
        refinements.reset();
        result.labels               = labels(result.chart);
        const StabilityChart &chart = result.chart;
        run.progress.finish(text(chart.branches.size(), " branches, ", chart.thresholds.size(), " thresholds, ", chart.crossings.size(),
                                 " crossings of the band's edge, ", chart.points.size() - friction_coefficients.size(), " refinements"));
        if (chart.n_doubtful_steps > 0)
          run.progress.note(text("  note: in ", chart.n_doubtful_steps, " steps modes could be told apart by their frequencies only"));
        return result;
      }

      /**
       * Adds to the basis what the modes of all thresholds lack on both sides, and forgets the results
       * there: they were found without it.
       */
      void sharpen(const int line, const StabilityChart &chart, const std::vector<double> &grid)
      {
        // Values of the grid beside them: next to a coalescence the vectors of both modes are nearly the same
        std::map<int, std::set<int>> modes_at; // by point of the chart, which has those of the grid only
        for (const Threshold &threshold : chart.thresholds)
          {
            const int above = std::upper_bound(grid.begin(), grid.end(), threshold.friction_coefficient) - grid.begin();
            for (const int i : {above - 1, above})
              for (const int branch : {threshold.branch, threshold.partner})
                if (i >= 0 && i < static_cast<int>(grid.size()) && branch >= 0 && chart.branches[branch].modes[i] >= 0)
                  modes_at[i].insert(chart.branches[branch].modes[i]);
          }
        std::vector<ChartModel::ModesAt> sets;
        for (const auto &[i, modes] : modes_at)
          sets.push_back({operating_point(line, grid[i], states.at(operation_at(lines[line], grid[i]))),
                          &chart.points[i],
                          {modes.begin(), modes.end()}});
        if (sets.empty())
          return;
        if (const auto earlier = refinements->basis(); !earlier.empty())
          model->extend(earlier.front());
        else
          {
            const auto vectors = model->new_vectors(sets);
            if (!vectors || model->size() + vectors->NumVectors() > static_cast<int>(run.parameters.sweep.maximum_basis))
              return;
            refinements->keep(*vectors);
            model->extend(*vectors);
          }
        for (const ChartModel::ModesAt &set : sets)
          known.erase({line, set.point.friction_coefficient});
      }

      /// Right vectors of some modes of a point at full order.
      std::pair<MultiVector, MultiVector> shapes(const ChartPoint &point, const std::vector<int> &modes) const
      {
        const ComplexDenseMatrix X = padded(selected_columns(point.right, modes), model->size());
        return {model->reduced().basis() * real_part(X), model->reduced().basis() * imaginary_part(X)};
      }

      /// Names of branches after the modes with which they begin; of a doublet the one that grows most over the chart is `+`.
      std::vector<ModeLabel> labels(const StabilityChart &chart) const
      {
        const std::vector<double> growth = largest_growth_rates(chart);
        std::vector<bool>         is_named(chart.branches.size(), false);
        std::vector<ModeLabel>    result(chart.branches.size());
        for (std::size_t i = 0; i < chart.points.size(); ++i)
          {
            std::vector<int>    modes, branches;
            std::vector<double> growth_here;
            for (std::size_t b = 0; b < chart.branches.size(); ++b)
              if (const int j = chart.branches[b].modes[i]; j >= 0 && !is_named[b])
                {
                  modes.push_back(j);
                  branches.push_back(static_cast<int>(b));
                  growth_here.push_back(growth[b]);
                }
            if (modes.empty())
              continue;
            const auto [re, im] = shapes(chart.points[i], modes);
            auto names          = identify_coupled(scene, linearisation, frictionless, re, &im);
            mark_doublets(names, growth_here);
            for (std::size_t k = 0; k < modes.size(); ++k)
              {
                result[branches[k]]   = names[k];
                is_named[branches[k]] = true;
              }
          }
        return result;
      }

      /// Label of the branch of the first chart that a mode resembles most, at the point of the chart nearest to its own.
      ModeLabel nearest_label(const SweepResults &results, const ChartPoint &point, const int mode) const
      {
        ModeLabel  label;
        double     largest = 0.;
        const auto main    = results.charts.find(0);
        if (main == results.charts.end())
          return label;
        const auto &line     = main->second.back();
        const auto &points   = line.chart.points;
        const auto  distance = [&](const ChartPoint &other) { return std::abs(other.friction_coefficient - point.friction_coefficient); };
        const auto  nearest  = std::min_element(points.begin(), points.end(),
                                                [&](const ChartPoint &a, const ChartPoint &b) { return distance(a) < distance(b); });
        const std::size_t i  = nearest - points.begin();
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
        return label;
      }

      void collect_map(SweepResults &results) const
      {
        for (const SweepPoint &operating : regime.points)
          {
            const Line &line = lines[operating.line];
            if (line.kind != Line::Kind::map)
              continue;
            MapCell cell;
            cell.friction_coefficient = operating.friction_coefficient;
            cell.value                = line.value;
            cell.n_open               = static_cast<int>(scene.interface.size() - regime.closed.size());
            const auto found          = known.find({operating.line, operating.friction_coefficient});
            if (found != known.end())
              {
                const ChartPoint &point = found->second;
                const int         mode  = leading_mode(point, omega_max);
                cell.is_known           = mode >= 0;
                if (cell.is_known)
                  {
                    const ModalQuantities quantities = modal_quantities(point.lambda[mode]);
                    cell.growth_rate                 = quantities.growth_rate;
                    cell.divergence_rate             = quantities.divergence_rate;
                    cell.frequency                   = quantities.frequency;
                    cell.leader                      = nearest_label(results, point, mode);
                  }
                for (std::size_t j = 0; j < point.lambda.size(); ++j)
                  if (is_in_band(point.lambda[j], omega_max))
                    {
                      cell.n_unstable += point.verdicts[j] == Verdict::unstable;
                      cell.n_undecided += point.verdicts[j] == Verdict::undecided;
                    }
                cell.error = model->largest_error(point);
              }
            results.map[{cell.value, cell.friction_coefficient}] = cell;
          }
      }

      /// The chosen friction coefficients may be ones that miss the tolerance.
      void note_if_inaccurate(const ChartPoint &point) const
      {
        const double error = model->largest_error(point);
        if (!(error <= run.parameters.sweep.tolerance))
          run.progress.note(text("  note: at mu = ", point.friction_coefficient, " the modes miss the tolerance of ",
                                 run.parameters.sweep.tolerance, ": the estimated error is ", error));
      }

      /// Counts the modes at chosen friction coefficients by the argument principle.
      void count(SweepResults &results)
      {
        for (const double mu : run.parameters.sweep.counts)
          {
            const ContactStateAt contact = states.at(operation_at(lines[0], mu));
            if (contact.closed != regime.closed)
              continue;
            run.progress.begin("Argument principle");
            const CoupledSystem here = with_values(linearisation.coupled, selected(contact.damping, regime.closed).values());
            ContourOptions      options;
            options.largest_frequency  = omega_max;
            options.lowest_frequency   = 1e-3 * omega_max;
            options.largest_growth     = 0.1 * omega_max;
            options.method             = contour_method(here);
            options.real_modes.solver  = run.parameters.solvers.real_solver;
            options.real_modes.library = run.parameters.solvers.library;
            options.real_modes.shift   = frictionless.shift * frictionless.shift;
            options.real_modes.inverse = &frictionless.inverse->frictionless(); // of the undamped system
            options.real_modes.what    = "real modes beyond the band";
            const ContourCount result  = count_by_contour(here, {mu}, options, run.progress).front();
            const ChartPoint   point   = evaluate_line(0, {mu}).front();
            note_if_inaccurate(point);
            const auto inside = [&](const std::complex<double> &lambda) {
              return lambda.imag() >= options.lowest_frequency && lambda.imag() <= omega_max &&
                     std::abs(lambda.real()) <= options.largest_growth;
            };
            const int n_found = static_cast<int>(std::count_if(point.lambda.begin(), point.lambda.end(), inside));
            results.counts.push_back({mu, n_found, result});
            run.progress.finish(text(result.n_modes, " modes counted, ", n_found, " found at mu = ", mu, ", ", result.n_points, " points"));
            if (result.n_modes != n_found)
              run.progress.note(text("  note: at mu = ", mu, " the sweep has ", n_found, " modes where ", result.n_modes, " were counted"));
          }
      }

      /// Fields of the leading modes at chosen friction coefficients.
      void write_shapes()
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
              note_if_inaccurate(point);
              const int mode = leading_mode(point, omega_max);
              if (mode < 0 || !is_growing(point.lambda[mode]))
                {
                  run.progress.note(text("  no mode grows at mu = ", mu, ": no mode shape is written"));
                  continue;
                }
              const auto [re, im]   = shapes(point, {mode});
              const ModeLabel label = identify_coupled(scene, linearisation, frictionless, re, &im).front();
              Linearisation   here  = linearisation;
              here.coupled =
                with_values(linearisation.coupled, selected(states.at(operation_at(lines[0], mu)).damping, regime.closed).values());
              const ModeField field = mode_field(scene, here, text("mu_", mu, "_", file_text(label)), point.lambda[mode], re, im);
              writer.write_mode(field);
              if (run.parameters.output.animation_frames > 0)
                writer.write_animation(field, run.parameters.output.animation_frames);
              ++n_written;
            }
        run.progress.finish(text(n_written, " leading modes"));
      }

      const Scene                                 &scene;
      const ContactRegime                         &regime;
      const std::size_t                            number; ///< of the contact set, from one on
      const std::vector<Line>                     &lines;
      const ContactStates                         &states;
      ChartCheckpoint                             &checkpoint;
      Run                                         &run;
      const double                                 omega_max;
      Linearisation                                linearisation;
      FrictionlessModes                            frictionless;
      std::unique_ptr<ChartModel>                  model;
      std::unique_ptr<ChartStore>                  refinements; ///< of the line that is followed
      std::map<std::pair<int, double>, ChartPoint> known;       ///< by line and friction coefficient
    };

    // ------------------------------------------------------------------- tables

    Table map_table(const SweepResults &results, const MapParameter parameter)
    {
      using Row          = MapCell;
      const bool is_load = parameter == MapParameter::load;
      const auto known   = [](const auto &value) {
        return [value](const Row &row) { return row.is_known ? Cell(std::invoke(value, row)) : Cell(); };
      };
      std::vector<Row> rows;
      for (const auto &[place, cell] : results.map)
        rows.push_back(cell);
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {is_load ? "load per side" : "rotation speed", is_load ? "N" : "rad/s", &Row::value, 3},
                                {"unstable modes", "-", known(&Row::n_unstable)},
                                {"undecided modes", "-", known(&Row::n_undecided)},
                                {"label", "", known(&Row::leader)},
                                {"frequency", "Hz", known(&Row::frequency), 2},
                                {"growth rate", "1/s", known(&Row::growth_rate), 4},
                                {"divergence rate", "%", known([](const Row &row) { return 100. * row.divergence_rate; }), 4},
                                {"estimated error of lambda", "-", known(&Row::error), 1, true},
                                {"open contact nodes", "-", &Row::n_open}},
                   rows);
    }

    Table argument_table(const std::vector<CountAt> &counts)
    {
      using Row = CountAt;
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {"modes of the sweep", "-", &Row::n_found},
                                {"modes counted", "-", [](const Row &row) { return row.count.n_modes; }},
                                {"real modes by inertia", "-", [](const Row &row) { return row.count.n_frictionless; }},
                                {"contour points", "-", [](const Row &row) { return row.count.n_points; }},
                                {"largest phase step", "rad", [](const Row &row) { return row.count.largest_phase_step; }, 3},
                                {"truncation bound", "-", [](const Row &row) { return row.count.truncation_bound; }, 1, true}},
                   counts);
    }

    /// Contact sets along a line: where they change.
    Table contact_table(const std::vector<Line> &lines, const std::vector<ContactRegime> &regimes, const std::size_t n_pairs)
    {
      struct Row
      {
        double      friction_coefficient, load, speed;
        std::size_t contact_set, n_open;
      };
      std::vector<Row> rows;
      for (std::size_t l = 0; l < lines.size(); ++l)
        for (const double mu : lines[l].friction_coefficients)
          for (std::size_t r = 0; r < regimes.size(); ++r)
            for (const int i : regimes[r].on_line(static_cast<int>(l)))
              if (regimes[r].points[i].friction_coefficient == mu && lines[l].kind != Line::Kind::without_dissipation)
                rows.push_back(
                  {mu, lines[l].operation.load_per_side, lines[l].operation.rotation_speed, r + 1, n_pairs - regimes[r].closed.size()});
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {"load per side", "N", &Row::load, 3},
                                {"rotation speed", "rad/s", &Row::speed, 3},
                                {"contact set", "-", &Row::contact_set},
                                {"open contact nodes", "-", &Row::n_open}},
                   rows);
    }

    // ------------------------------------------------------------------ in words

    /// Divergence rates that the least structural damping outweighs [-].
    constexpr double weak_divergence = 1e-4;

    std::string verdict(const std::vector<ChartLine> &stretches, const std::size_t n_asked, const double largest_circular_frequency)
    {
      double      first = -1., strong = -1., largest = 0., worst = 0., frequency = 0.;
      ModeLabel   first_label, strong_label, label;
      std::size_t n_known = 0; // of the values asked for
      for (const ChartLine &line : stretches)
        n_known += std::count(line.chart.is_refinement.begin(), line.chart.is_refinement.end(), false);
      for (const ChartLine &line : stretches)
        for (std::size_t i = 0; i < line.chart.points.size(); ++i)
          for (std::size_t b = 0; b < line.chart.branches.size(); ++b)
            {
              const ChartPoint &point = line.chart.points[i];
              const int         j     = line.chart.branches[b].modes[i];
              if (j < 0 || !is_in_band(point.lambda[j], largest_circular_frequency) || point.verdicts[j] != Verdict::unstable)
                continue;
              const ModalQuantities mode = modal_quantities(point.lambda[j]);
              if (first < 0.)
                {
                  first       = point.friction_coefficient;
                  first_label = line.labels[b];
                }
              if (strong < 0. && mode.divergence_rate > weak_divergence)
                {
                  strong       = point.friction_coefficient;
                  strong_label = line.labels[b];
                }
              if (mode.divergence_rate > largest)
                {
                  largest   = mode.divergence_rate;
                  worst     = point.friction_coefficient;
                  frequency = mode.frequency;
                  label     = line.labels[b];
                }
            }
      if (first < 0.)
        return n_known == n_asked ?
                 "  stable: no mode of the band grows at any friction coefficient of the sweep" :
                 text("  no mode of the band grows at ", n_known, " of ", n_asked, " friction coefficients; the others miss the tolerance");
      return text(
        "  squeal from mu = ", first, " on (", to_string(first_label), ")",
        strong >= 0. ? text(", beyond ", 100. * weak_divergence, " % from mu = ", strong, " on (", to_string(strong_label), ")") : "",
        "; most at mu = ", worst, ": ", to_string(label), " at ", decimal_text(frequency), " Hz with ", decimal_text(100. * largest), " %");
    }

    // ------------------------------------------------------------ the study

    /// Throws ParameterError where nothing depends on what a map varies.
    void check_map(const Parameters &parameters)
    {
      const MapParameter varied = parameters.sweep.map_parameter;
      if (varied == MapParameter::none)
        return;
      const OperationParameters &operation = parameters.operation;
      const bool                 is_steady = parameters.needs_steady_sliding();
      if (operation.radial_dissipation == RadialDissipation::none && operation.friction_slope == 0. &&
          !(is_steady && varied == MapParameter::load))
        throw ParameterError("without contact damping nothing depends on the " + to_string(varied), "parameter Sweep/Map parameter",
                             "set Operation/Radial dissipation or Operation/Friction slope, or Sweep/Map parameter = none");
      if (is_steady && varied == MapParameter::load && parameters.sliding.control != BackplateControl::load_per_side)
        throw ParameterError("a map over the load needs backplates that are pressed with it", "parameter Steady sliding/Control",
                             "set it to load per side, or Sweep/Map parameter = none");
    }
  } // namespace

  /**
   * `Study = sweep`: complex modes over a range of the friction coefficient, with and without radial dissipation, where
   * they begin and cease to grow, and maps over load or speed.
   */
  static void run_sweep_study(Run &run)
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
    ChartCheckpoint checkpoint(checkpoint_folder(run.folder().name()), identity(run, scene), run.communicator, omega_max);
    if (checkpoint.n_found() > 0)
      run.progress.note(text("  an interrupted sweep goes on: ", checkpoint.n_found(), " operating points are known"));
    assemble_scene(scene, run);
    const ContactStates     states(scene, run);
    const std::vector<Line> lines   = lines_of(parameters);
    const auto              regimes = contact_regimes(lines, states, run);

    // ------------------------------------------------------------- every regime
    SweepResults results;
    for (std::size_t r = 0; r < regimes.size(); ++r)
      RegimeModel(scene, regimes[r], r + 1, lines, states, checkpoint, run).add_to(results);

    for (const auto *chosen : {&parameters.sweep.mode_shapes, &parameters.sweep.counts})
      for (const double mu : *chosen)
        {
          const auto closed = states.at(operation_at(lines[0], mu)).closed;
          if (std::none_of(regimes.begin(), regimes.end(), [&](const ContactRegime &regime) { return regime.closed == closed; }))
            run.progress.note(text("  note: at mu = ", mu, " other contact nodes are closed than at any value of the sweep: ",
                                   chosen == &parameters.sweep.counts ? "modes are not counted" : "no mode shape is written",
                                   ". Raise Sweep/Number of friction coefficients"));
        }

    // ------------------------------------------------------------------ results
    if (const auto main = results.charts.find(0); main != results.charts.end())
      run.progress.note("\n" + verdict(main->second, lines[0].friction_coefficients.size(), omega_max));
    for (const auto &[l, stretches] : results.charts)
      for (std::size_t s = 0; s < stretches.size(); ++s)
        {
          const ChartLine  &line   = stretches[s];
          const std::string suffix = (lines[l].kind == Line::Kind::main ? "" : "_without_dissipation") + (s > 0 ? text("_", s + 1) : "");
          const auto        write_quietly = [&](const std::string &name, const Table &table) { run.store_table(name + suffix, table); };
          write_quietly("branches", branch_table(line.chart, line.labels, omega_max));
          write_quietly("counts", count_table(line.chart));
          run.write_table("thresholds" + suffix, threshold_table(line.chart, line.labels));
          if (line.chart.crossings.empty())
            write_quietly("band_crossings", crossing_table(line.chart, line.labels));
          else
            run.write_table("band_crossings" + suffix, crossing_table(line.chart, line.labels));
        }
    if (!results.counts.empty())
      run.write_table("argument_counts", argument_table(results.counts));
    if (regimes.size() > 1)
      {
        run.store_table("contact_sets", contact_table(lines, regimes, scene.interface.size()));
        run.progress.note(text("  note: ", regimes.size(), " contact sets, see contact_sets.csv; branches end where the set changes"));
      }
    if (!results.map.empty())
      run.store_table("map", map_table(results, parameters.sweep.map_parameter));
    run.finish();
    checkpoint.remove();
  }

  extern const Study sweep_study = [] {
    const auto map_axis = [](const Parameters &p) {
      return unless(p.sweep.map_parameter != MapParameter::none, "Sweep/Map parameter = none");
    };
    Study study{"sweep", run_sweep_study, {"Sweep/"}};
    study.rules          = {{"Operation/Friction coefficient",
                             [](const Parameters &) { return "a sweep goes from Sweep/First to Sweep/Last friction coefficient"; }},
                            {"Operation/Rotation speed", no_sliding_speed},
                            {"Complex modes/", [](const Parameters &) { return "a sweep solves reduced models"; }},
                            {"Sweep/First map value", map_axis},
                            {"Sweep/Last map value", map_axis},
                            {"Sweep/Number of map values", map_axis},
                            {"Sweep/Map friction coefficients", map_axis}};
    study.no_mode_shapes = [](const Parameters &p) {
      return unless(!p.sweep.mode_shapes.empty(), "a sweep writes mode shapes for Sweep/Mode shapes at");
    };
    study.check = check_map;
    return study;
  }();
} // namespace Squeal
