#include <squeal/linear_algebra/replicate.h>
#include <squeal/studies/mode_fields.h>

#include <vector>

namespace Squeal
{
  ModeField mode_field(const Scene                     &scene,
                       const CoupledSystem             &system,
                       const std::vector<unsigned int> &closed,
                       const std::string               &name,
                       const std::complex<double>      &lambda,
                       const MultiVector               &real_part,
                       const MultiVector               &imaginary_part)
  {
    DenseMatrix reaction_re, reaction_im;
    normal_reactions(system, {lambda}, real_part, imaginary_part, reaction_re, reaction_im);
    const DenseMatrix re = replicate(*system.kernel * real_part), im = replicate(*system.kernel * imaginary_part);

    ModeField field{name, lambda, {}, std::vector<std::complex<double>>(scene.interface.size())};
    for (int i = 0; i < re.n_rows(); ++i)
      field.displacement.emplace_back(re(i, 0), im(i, 0));
    for (int c = 0; c < reaction_re.n_rows(); ++c)
      field.reactions[closed[c]] = {reaction_re(c, 0), reaction_im(c, 0)};
    return field;
  }
} // namespace Squeal
