#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/matrix_market.h>

#include <deal.II/base/mpi.h>

#include <suitesparse/cholmod.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

namespace Squeal
{
  SparseRows read_matrix_market(const std::string &path)
  {
    const auto refuse = [&path](const std::string &what) {
      throw FileError(what, "file " + path, "write the matrix in Matrix Market form: coordinate or array, real, with finite entries");
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "r"), std::fclose);
    if (!file)
      refuse(text("the file cannot be opened: ", std::strerror(errno)));
    std::string header;
    std::getline(std::ifstream(path), header);
    if (header.rfind("%%MatrixMarket", 0) != 0)
      refuse("the first line is no header of the Matrix Market");
    for (const char *kind : {"complex", "pattern", "hermitian"})
      if (header.find(kind) != std::string::npos)
        refuse(text("the matrix is ", kind, ", not real"));

    cholmod_common common;
    cholmod_start(&common);
    common.print                   = 0;
    constexpr int   both_triangles = 1;
    int             type           = 0;
    void           *found          = cholmod_read_matrix(file.get(), both_triangles, &type, &common);
    cholmod_dense  *dense          = found != nullptr && type == CHOLMOD_DENSE ? static_cast<cholmod_dense *>(found) : nullptr;
    cholmod_sparse *A              = dense != nullptr ? cholmod_dense_to_sparse(dense, 1, &common) : static_cast<cholmod_sparse *>(found);
    cholmod_free_dense(&dense, &common);
    SparseRows result;
    if (A != nullptr)
      result = Eigen::Map<const Eigen::SparseMatrix<double>>(A->nrow, A->ncol, cholmod_nnz(A, &common), static_cast<const int *>(A->p),
                                                             static_cast<const int *>(A->i), static_cast<const double *>(A->x));
    const bool is_read = A != nullptr;
    cholmod_free_sparse(&A, &common);
    cholmod_finish(&common);
    if (!is_read)
      refuse("CHOLMOD cannot read the matrix: the number of entries, or a row or column number, is wrong, or the memory does not suffice");
    for (int i = 0; i < result.rows(); ++i)
      for (SparseRows::InnerIterator entry(result, i); entry; ++entry)
        if (!(std::abs(entry.value()) <= std::numeric_limits<double>::max()))
          refuse(text("the entry in row ", i + 1, " and column ", entry.col() + 1, " is not finite"));
    return result;
  }

  std::string matrix_market(const SparseMatrix &A, const MatrixMarketSymmetry symmetry)
  {
    const bool         symmetric = symmetry == MatrixMarketSymmetry::symmetric;
    const SparseRows   rows      = local_rows(A);
    double             n         = 0.; // exact up to 2^53
    std::ostringstream lines;
    lines.precision(std::numeric_limits<double>::max_digits10);
    for (int i = 0; i < rows.rows(); ++i)
      for (SparseRows::InnerIterator entry(rows, i); entry; ++entry)
        if (const int number = A.rows().number(i); !symmetric || entry.col() <= number)
          {
            lines << number + 1 << ' ' << entry.col() + 1 << ' ' << entry.value() << '\n';
            n += 1.;
          }
    sum_over_processes(A.communicator(), &n, 1);
    const auto parts = dealii::Utilities::MPI::gather(A.communicator(), lines.str());
    if (A.rows().rank() != 0)
      return "";
    std::string result = text("%%MatrixMarket matrix coordinate real ", symmetric ? "symmetric" : "general", "\n", A.n_rows(), " ",
                              A.n_columns(), " ", static_cast<long long>(n), "\n");
    for (const std::string &part : parts)
      result += part;
    return result;
  }
} // namespace Squeal
