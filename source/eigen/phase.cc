#include <squeal/eigen/phase.h>
#include <squeal/linear_algebra/communication.h>

#include <cmath>
#include <complex>
#include <limits>

namespace Squeal
{
  void fix_phase(MultiVector &real_part, MultiVector &imaginary_part)
  {
    using dealii::Utilities::MPI::max;
    using dealii::Utilities::MPI::min;
    const RowMap  &map       = real_part.map();
    const MPI_Comm processes = map.communicator();
    for (int j = 0; j < real_part.n_columns(); ++j)
      {
        const Eigen::ArrayXd moduli  = (real_part.col(j).array().square() + imaginary_part.col(j).array().square()).sqrt();
        const double         largest = max(moduli.size() > 0 ? moduli.maxCoeff() : 0., processes);
        if (!(largest > 0.))
          continue;
        int row = std::numeric_limits<int>::max();
        for (int i = 0; i < moduli.size(); ++i)
          if (moduli[i] >= (1. - 1e-13) * largest)
            row = std::min(row, map.number(i));
        row = min(row, processes);

        double entry[2] = {0., 0.};
        if (const int i = map.place(row); i >= 0)
          {
            entry[0] = real_part(i, j);
            entry[1] = imaginary_part(i, j);
          }
        sum_over_processes(processes, entry, 2);
        const double          modulus = std::hypot(entry[0], entry[1]);
        const double          c = entry[0] / modulus, s = -entry[1] / modulus;
        const Eigen::VectorXd re = real_part.col(j);
        real_part.col(j)         = c * re - s * imaginary_part.col(j);
        imaginary_part.col(j)    = s * re + c * imaginary_part.col(j);
      }
  }
} // namespace Squeal
