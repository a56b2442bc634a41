#pragma once

#include <squeal/base/field_format.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/model/model.h>
#include <squeal/output/result_folder.h>

#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A complex mode as the field writer needs it.
  struct ModeField
  {
    std::string                       name;         ///< of its files, without extension
    std::complex<double>              lambda;       ///< [rad/s]
    std::vector<std::complex<double>> displacement; ///< on the free dofs, rows of this process
    std::vector<std::complex<double>> reactions;    ///< r_n of each pair of contact nodes [N per unit amplitude]; compression negative
    std::string                       title = {};   ///< what its files say of the mode
    std::vector<double> energy_input        = {};   ///< what each pair adds to the divergence rate, over its area [1/m²]; empty: not known
  };

  /// A mode without friction, of the coupled bodies or of one component, as the field writer needs it.
  struct RealModeField
  {
    std::string              name;         ///< of its file, without extension
    std::string              title;        ///< what the file says of the mode
    std::vector<double>      displacement; ///< on the free dofs, rows of this process
    std::optional<Component> component;    ///< the bodies to write; nothing: all
  };

  /// A mode file in a list through which ParaView steps.
  struct ListedMode
  {
    std::string name;      ///< of its file, without extension
    double      frequency; ///< [Hz]
  };

  /// What an animation shows of a mode.
  struct AnimationOptions
  {
    unsigned int frames_per_period = 16;
    unsigned int periods           = 1;
    bool         grows             = false; ///< multiplied by e^{Rt}
  };

  /// A picture of an animation.
  struct AnimationFrame
  {
    double               time; ///< [s]
    std::complex<double> turn; ///< Re(turn φ) is shown
  };

  /// Pictures of Re(φ e^{iωt}), or of Re(φ e^{λt}) where the animation grows, with a largest amplitude as ModeFieldWriter::write_animation() has it.
  std::vector<AnimationFrame> animation_frames(const ModeField &mode, const AnimationOptions &options, MPI_Comm communicator);

  /// Frequencies [Hz] as times that ParaView keeps apart, each beyond the one before by at least 10⁻⁶ of it; @p modes in ascending order.
  std::vector<double> distinct_times(const std::vector<ListedMode> &modes);

  /// Largest |u| of the dofs of all processes, by which fields are divided; one where nothing moves.
  double largest_amplitude(const std::vector<double> &displacement, MPI_Comm communicator);
  double largest_amplitude(const std::vector<std::complex<double>> &displacement, MPI_Comm communicator);

  /**
   * Writes shapes of modes for ParaView. All processes must call.
   *
   * On the bodies are `displacement_real`, `displacement_imag` and `amplitude`, scaled so that the largest modulus of a displacement is one, with the
   * cell field `component`; on the contact faces `normal_reaction_real` and `normal_reaction_imag` [N] in the same scale, `closed` (1: the
   * node belongs to S_0) and, where it is known, `energy_input` [1/m²].
   */
  class ModeFieldWriter
  {
  public:
    virtual ~ModeFieldWriter() = default;

    /// Files `modes/NAME*`.
    virtual void write_mode(const ModeField &mode) = 0;

    /// Files `modes/NAME*` with `displacement` and `amplitude`, in the same scale.
    virtual void write_mode(const RealModeField &mode) = 0;

    /**
     * A file `NAME.*` through which ParaView steps, frequencies [Hz] as times (see distinct_times()).
     *
     * @param modes that have been written, in ascending order of frequency
     */
    virtual void write_list(const std::string &name, const std::vector<ListedMode> &modes) = 0;

    /**
     * Periods of a mode as `animations/NAME.*`; time in the file is in seconds. The largest amplitude is one: at all times without growth,
     * in the last picture of a mode that grows and in the first of one that decays. Without growth the last picture comes one step before
     * the end, so that it may be repeated; with growth at the end.
     */
    virtual void write_animation(const ModeField &mode, const AnimationOptions &options) = 0;
  };

  /**
   * A writer of modes in the format asked for.
   *
   * @param closed numbers of the pairs that are in contact, among those of @p interface
   */
  std::unique_ptr<ModeFieldWriter> mode_field_writer(FieldFormat                      format,
                                                     const Model                     &model,
                                                     const ContactInterface          &interface,
                                                     const std::vector<unsigned int> &closed,
                                                     const ResultFolder              &folder);
} // namespace Squeal
