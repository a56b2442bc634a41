// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/mpi_environment.h>
#include <squeal/linear_algebra/blas_threads.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

int main(int argc, char **argv)
{
  Squeal::prepare_mpi_environment();
  Squeal::set_blas_threads(1);
  // Remove GoogleTest arguments before the libraries parse argv
  ::testing::InitGoogleTest(&argc, argv);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return RUN_ALL_TESTS();
}
