#include <squeal/base/conventions.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/verdict.h>
#include <squeal/studies/steps/mode_results.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// File name of a mode: what it is of, its row in the table, counted from 1, and its label.
    std::string file_name(const std::string &kind, const std::size_t row, const ModeLabel &label)
    {
      std::ostringstream name;
      name << kind << "_" << std::setw(3) << std::setfill('0') << row + 1 << "_" << file_text(label);
      return name.str();
    }

    std::string real_mode_title(const std::string &what, const ModeLabel &label, const double frequency)
    {
      return text(what, " ", to_string(label), ", ", decimal_text(frequency), " Hz");
    }

    /// A displacement on the dofs of the uncoupled bodies, n_free × 1: rows of this process.
    std::vector<double> rows_here(const MultiVector &displacement)
    {
      return {displacement.col(0).begin(), displacement.col(0).end()};
    }

    /// What an animation shows of the growth of a mode, e^{2π ξ n} in n periods.
    std::string growth_text(const double divergence_rate, const unsigned int periods)
    {
      const double exponent = 2. * M_PI * divergence_rate;
      return text("; the fastest grows by a factor of ", std::exp(exponent * periods), ", and of e in ", 1. / exponent, " periods");
    }

    void write_complex_modes(const Linearisation &linearisation,
                             const FrictionModes &friction,
                             const PowerBalances &balances,
                             FieldWriter         &writer,
                             Run                 &run)
    {
      const OutputParameters &output = run.parameters.output;
      const ComplexModes     &modes  = friction.modes;
      std::vector<ListedMode> list;
      unsigned int            n_animations = 0;
      double                  highest      = 0.; // divergence rate of what is animated
      run.progress.begin("Mode shapes");
      for (std::size_t j = 0; j < friction.labels.size(); ++j)
        {
          if (output.fields != FieldSelection::all && !friction.unstable[j])
            continue;
          const ModeLabel &label     = friction.labels[j];
          const double     frequency = modal_quantities(modes.lambda[j]).frequency;
          run.progress.update(text(to_string(label), ", ", frequency, " Hz"));
          const int column = static_cast<int>(j);
          ModeField field  = mode_field(linearisation, file_name("complex", j, label), modes.lambda[j], view(*modes.real_part, column, 1),
                                        view(*modes.imaginary_part, column, 1));
          field.title      = mode_title(label, modes.lambda[j]);
          if (const auto balance = balances.find(column); balance != balances.end())
            field.energy_input = energy_input(linearisation, balance->second);
          writer.write_mode(field);
          list.push_back({field.name, frequency});
          if (friction.unstable[j] && output.animation_frames > 0)
            {
              writer.write_animation(field, animation_options(output));
              ++n_animations;
              highest = std::max(highest, modal_quantities(modes.lambda[j]).divergence_rate);
            }
        }
      if (!list.empty())
        writer.write_list("modes", list);
      run.progress.finish(text(list.size(), " modes, ", n_animations, " animations",
                               output.animation_growth && highest > 0. ? growth_text(highest, output.animation_periods) : ""));
    }

    void write_real_modes(const FrictionlessModes &modes, FieldWriter &writer, Run &run)
    {
      std::vector<ListedMode> list;
      run.progress.begin("Real mode shapes");
      for (std::size_t j = 0; j < modes.labels.size(); ++j)
        {
          const double      frequency = hertz(std::sqrt(modes.real.eigenvalues[j]));
          const std::string name      = file_name("real", j, modes.labels[j]);
          const MultiVector shape     = *modes.linearisation.coupled.kernel * view(*modes.real.vectors, static_cast<int>(j), 1);
          run.progress.update(name);
          writer.write_mode({name, real_mode_title("real mode", modes.labels[j], frequency), rows_here(shape), {}});
          list.push_back({name, frequency});
        }
      writer.write_list("real_modes", list);
      run.progress.finish(text(list.size(), " modes"));
    }

    void write_component_modes(const FrictionlessModes &modes, FieldWriter &writer, Run &run)
    {
      const double omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
      const auto   listed    = listed_component_modes(modes, omega_max * omega_max);
      // Disc and pins are different meshes, so that each set has a list of its own
      std::map<std::string, std::vector<ListedMode>> lists;
      run.progress.begin("Component mode shapes");
      for (std::size_t row = 0; row < listed.size(); ++row)
        {
          const ListedComponentMode &mode    = listed[row];
          const bool                 is_disc = mode.set == &modes.disc;
          const std::string          set     = is_disc ? "disc" : text("pins_", mode.contact);
          const std::string          name    = file_name("component_" + set, row, mode.label);
          run.progress.update(name);
          writer.write_mode({name, real_mode_title(is_disc ? "free disc" : text(mode.contact, " pins"), mode.label, mode.frequency()),
                             rows_here(view(*mode.set->vectors, mode.number, 1)), is_disc ? Component::disc : Component::pins});
          lists["component_modes_" + set].push_back({name, mode.frequency()});
        }
      for (const auto &[name, list] : lists)
        writer.write_list(name, list);
      run.progress.finish(text(listed.size(), " modes"));
    }
  } // namespace

  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda)
  {
    const ModalQuantities mode = modal_quantities(lambda);
    return text(to_string(label), ", ", decimal_text(mode.frequency), " Hz, divergence rate ", 100. * mode.divergence_rate, " %",
                verdict_of(lambda) == Verdict::unstable ? ", unstable" : "");
  }

  AnimationOptions animation_options(const OutputParameters &output)
  {
    return {output.animation_frames, output.animation_periods, output.animation_growth};
  }

  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run)
  {
    const OutputParameters &output        = run.parameters.output;
    const Linearisation    &linearisation = frictionless.linearisation;
    const Scene            &scene         = *linearisation.scene;
    FieldWriter             writer(*scene.model, scene.interface, linearisation.closed, run.folder());
    if (output.fields != FieldSelection::none)
      write_complex_modes(linearisation, friction, balances, writer, run);
    if (output.real_fields)
      write_real_modes(frictionless, writer, run);
    if (output.component_fields)
      write_component_modes(frictionless, writer, run);
  }
} // namespace Squeal
