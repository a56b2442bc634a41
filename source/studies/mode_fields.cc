#include <squeal/linear_algebra/replicate.h>
#include <squeal/studies/mode_fields.h>

#include <vector>

namespace Squeal
{
  ModeField mode_field(const Scene                &scene,
                       const Linearisation        &linearisation,
                       const std::string          &name,
                       const std::complex<double> &lambda,
                       const MultiVector          &real_part,
                       const MultiVector          &imaginary_part)
  {
    const CoupledSystem &system = linearisation.coupled;
    DenseMatrix          reaction_re, reaction_im;
    normal_reactions(system, {lambda}, real_part, imaginary_part, reaction_re, reaction_im);
    const DenseMatrix re = replicate(*system.kernel * real_part), im = replicate(*system.kernel * imaginary_part);

    ModeField field{name, lambda, {}, {}};
    for (int i = 0; i < re.n_rows(); ++i)
      field.displacement.emplace_back(re(i, 0), im(i, 0));
    std::vector<std::complex<double>> reactions;
    for (int c = 0; c < reaction_re.n_rows(); ++c)
      reactions.emplace_back(reaction_re(c, 0), reaction_im(c, 0));
    field.reactions = linearisation.on_all_pairs(reactions, scene.interface.size());
    return field;
  }
} // namespace Squeal
