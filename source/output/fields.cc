#include <squeal/output/fields.h>
#include <squeal/output/vtu_writer.h>
#include <squeal/output/xdmf_writer.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Least distance of times in a list of modes, as a part of the time, and that from a time of zero [Hz].
    constexpr double least_relative_step = 1e-6, least_step = 1e-6;

    template <typename Number>
    double largest_modulus(const std::vector<Number> &displacement, const MPI_Comm communicator)
    {
      double largest = 0.;
      for (const Number &u : displacement)
        largest = std::max<double>(largest, std::abs(u));
      largest = dealii::Utilities::MPI::max(largest, communicator);
      return largest > 0. ? largest : 1.;
    }
  } // namespace

  double largest_amplitude(const std::vector<double> &displacement, const MPI_Comm communicator)
  {
    return largest_modulus(displacement, communicator);
  }

  double largest_amplitude(const std::vector<std::complex<double>> &displacement, const MPI_Comm communicator)
  {
    return largest_modulus(displacement, communicator);
  }

  std::vector<AnimationFrame> animation_frames(const ModeField &mode, const AnimationOptions &options, const MPI_Comm communicator)
  {
    const double       scale    = 1. / largest_amplitude(mode.displacement, communicator);
    const double       period   = 2. * M_PI / mode.lambda.imag();
    const unsigned int n_steps  = options.frames_per_period * options.periods;
    const unsigned int n_frames = options.grows ? n_steps + 1 : n_steps;
    const double       growth   = options.grows ? mode.lambda.real() : 0.;
    // When the amplitude is largest: scaled to this time, growth cannot overflow
    const double largest_at = growth > 0. ? options.periods * period : 0.;

    std::vector<AnimationFrame> frames;
    for (unsigned int frame = 0; frame < n_frames; ++frame)
      {
        const double time = period * frame / options.frames_per_period;
        frames.push_back({time, std::polar(scale * std::exp(growth * (time - largest_at)), mode.lambda.imag() * time)});
      }
    return frames;
  }

  std::vector<double> distinct_times(const std::vector<ListedMode> &modes)
  {
    std::vector<double> times;
    for (const ListedMode &mode : modes)
      {
        const double least = times.empty() ? 0. : (1. + least_relative_step) * times.back() + least_step;
        times.push_back(std::max(mode.frequency, least));
      }
    return times;
  }

  std::unique_ptr<ModeFieldWriter> mode_field_writer(const FieldFormat                format,
                                                     const Model                     &model,
                                                     const ContactInterface          &interface,
                                                     const std::vector<unsigned int> &closed,
                                                     const ResultFolder              &folder)
  {
    if (format == FieldFormat::vtu)
      return std::make_unique<VtuWriter>(model, interface, closed, folder);
    return std::make_unique<XdmfWriter>(model, interface, closed, folder);
  }
} // namespace Squeal
