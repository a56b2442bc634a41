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
    const auto        reactions = normal_reactions(system, {lambda}, real_part, imaginary_part);
    const DenseMatrix re = replicate(*system.kernel * real_part), im = replicate(*system.kernel * imaginary_part);

    ModeField field{name, lambda, {}, std::vector<std::complex<double>>(scene.interface.size())};
    for (int i = 0; i < re.rows(); ++i)
      field.displacement.emplace_back(re(i, 0), im(i, 0));
    for (std::size_t c = 0; c < closed.size(); ++c)
      field.reactions[closed[c]] = reactions(c, 0);
    return field;
  }
} // namespace Squeal
