// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/eigen/compact_krylov.h>
#include <squeal/linear_algebra/communication.h>

#include <Eigen/QR>
#include <lapacke.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Components below this fraction of the norm of a vector are rounding errors [-].
    constexpr double negligible = 1e-15;
    /// A unit vector whose norm is smaller than this after a second projection consists of rounding errors [-].
    constexpr double meaningless = 1e-3;

    /// A column is clearly independent if more than this fraction of its norm remains after projection [-].
    constexpr double independent = 1e-2;

    /// The parts of stacked coordinates, r rows each, as adjacent column blocks.
    DenseMatrix parts_of(const DenseMatrix &states, const int degree)
    {
      const Eigen::Index r = states.rows() / degree, k = states.cols();
      DenseMatrix        parts(r, degree * k);
      for (int part = 0; part < degree; ++part)
        parts.middleCols(part * k, k) = states.middleRows(part * r, r);
      return parts;
    }

    /// Inverse of parts_of(): stacks the parts, each extended by zero rows to @p r_new rows.
    DenseMatrix stacked(const DenseMatrix &parts, const int degree, const int r_new)
    {
      const Eigen::Index k      = parts.cols() / degree;
      DenseMatrix        states = DenseMatrix::Zero(degree * r_new, k);
      for (int part = 0; part < degree; ++part)
        states.block(part * r_new, 0, parts.rows(), k) = parts.middleCols(part * k, k);
      return states;
    }

    /// X Π = Q R by modified Gram–Schmidt with column pivoting; a column is dropped if the norm of its remainder is at most its value in @p
    /// smallest. Q replaces the first columns of X; returns R Πᵀ, k × b.
    DenseMatrix pivoted_qr(MultiVector &X, std::vector<double> smallest)
    {
      const int        b = X.n_columns();
      DenseMatrix      R = DenseMatrix::Zero(b, b);
      std::vector<int> permutation(b);
      std::iota(permutation.begin(), permutation.end(), 0);

      int k = 0;
      for (; k < b; ++k)
        {
          const MultiVector   remaining = view(X, k, b - k);
          std::vector<double> norms     = column_norms(remaining);
          agree(X.communicator(), norms.data(), norms.size());
          int pivot = 0;
          for (int j = 1; j < b - k; ++j)
            if (norms[j] > norms[pivot])
              pivot = j;

          // ------------------------------------------------- pivot: the largest column
          const double largest = norms[pivot];
          if (pivot > 0)
            {
              pivot += k;
              MultiVector       first = view(X, k, 1), second = view(X, pivot, 1);
              const MultiVector copy = first;
              first                  = second;
              second                 = copy;
              R.col(k).head(k).swap(R.col(pivot).head(k));
              std::swap(permutation[k], permutation[pivot]);
              std::swap(smallest[k], smallest[pivot]);
            }
          if (!(largest > smallest[k]))
            break;

          // ------------------------------------------------- projection of the others
          MultiVector q = view(X, k, 1);
          q *= 1. / largest;
          R(k, k) = largest;
          if (k + 1 < b)
            {
              MultiVector       others       = view(X, k + 1, b - k - 1);
              const DenseMatrix coefficients = gram(q, others);
              multiply_add(-1., q, coefficients, 1., others);
              R.row(k).tail(b - k - 1) = coefficients;
            }
        }

      DenseMatrix result(k, b);
      for (int j = 0; j < b; ++j)
        result.col(permutation[j]) = R.col(j).head(k);
      return result;
    }

    /// pivoted_qr() of a small matrix by Householder reflections (X is replaced by Q, n × k).
    DenseMatrix pivoted_qr(DenseMatrix &X, const double smallest)
    {
      const DenseMatrix::Index b = X.cols();
      if (X.size() == 0)
        {
          X.resize(Eigen::NoChange, 0);
          return DenseMatrix(0, b);
        }
      const Eigen::ColPivHouseholderQR<DenseMatrix> qr(X);
      Eigen::Index                                  k = 0;
      while (k < std::min(X.rows(), b) && std::abs(qr.matrixR()(k, k)) > smallest)
        ++k;
      X                   = qr.householderQ() * DenseMatrix::Identity(X.rows(), k);
      const DenseMatrix R = qr.matrixR().topRows(k).triangularView<Eigen::Upper>();
      return R * qr.colsPermutation().transpose();
    }

    /// Smallest ratio of a pivot of R Πᵀ from pivoted_qr() to the norm of its column.
    double smallest_share(const DenseMatrix &R)
    {
      double result = 1.;
      for (Eigen::Index k = 0; k < R.rows(); ++k)
        {
          Eigen::Index pivot;
          const double largest = R.row(k).cwiseAbs().maxCoeff(&pivot);
          result               = std::min(result, largest / R.col(pivot).norm());
        }
      return result;
    }

    /// A stacked on B.
    DenseMatrix above(const DenseMatrix &A, const DenseMatrix &B)
    {
      DenseMatrix result(A.rows() + B.rows(), A.cols());
      result << A, B;
      return result;
    }
  } // namespace

  CompactKrylov::CompactKrylov(const RowMap &map, const int degree, const int n_reserved)
    : map(map)
    , degree(degree)
    , U(std::make_unique<MultiVector>(map, std::max(n_reserved, 1), false))
  {}

  MultiVector CompactKrylov::basis() const
  {
    return view(*U, 0, n_vectors);
  }

  void CompactKrylov::reserve(const int n)
  {
    if (n <= U->n_columns())
      return;
    auto larger = std::make_unique<MultiVector>(map, n + n / 2, false);
    if (n_vectors > 0)
      {
        MultiVector target = view(*larger, 0, n_vectors);
        target             = basis();
      }
    U = std::move(larger);
  }

  DenseMatrix CompactKrylov::absorb(MultiVector &X, const std::vector<double> &magnitudes)
  {
    DenseMatrix coefficients = DenseMatrix::Zero(n_vectors, X.n_columns());
    if (n_vectors > 0)
      {
        // The second pass removes rounding errors of the first
        const DenseMatrix most = gram(basis(), X);
        multiply_add(-1., basis(), most, 1., X);
        const DenseMatrix rest = gram(basis(), X);
        multiply_add(-1., basis(), rest, 1., X);
        coefficients = most + rest;
      }
    std::vector<double> smallest = magnitudes;
    std::for_each(smallest.begin(), smallest.end(), [](double &x) { x *= negligible; });
    DenseMatrix R = pivoted_qr(X, smallest);

    // Normalising the remainder of nearly dependent columns amplifies its rounding errors: project again
    double share = smallest_share(R);
    agree(map.communicator(), &share, 1);
    for (int round = 0; round < 2 && R.rows() > 0 && share < independent; ++round)
      {
        MultiVector Q       = view(X, 0, R.rows());
        double      removed = 0.;
        if (n_vectors > 0)
          {
            const DenseMatrix rest = gram(basis(), Q);
            multiply_add(-1., basis(), rest, 1., Q);
            coefficients += rest * R;
            removed = max_norm(rest);
            agree(map.communicator(), &removed, 1);
          }
        R = pivoted_qr(Q, std::vector<double>(R.rows(), meaningless)) * R;
        if (removed < 1e-8)
          break;
      }

    const int n_new = R.rows();
    if (n_new > 0)
      {
        reserve(n_vectors + n_new);
        MultiVector target = view(*U, n_vectors, n_new);
        target             = view(X, 0, n_new);
        G                  = stacked(parts_of(G, degree), degree, n_vectors + n_new);
        n_vectors += n_new;
      }
    return above(coefficients, R);
  }

  DenseMatrix CompactKrylov::append_active(const DenseMatrix &states, const int n_basis)
  {
    DenseMatrix  X        = states;
    const double smallest = X.cols() == 0 ? 0. : negligible * X.colwise().norm().maxCoeff();

    const DenseMatrix V            = G.leftCols(n_basis);
    DenseMatrix       coefficients = DenseMatrix::Zero(n_basis, X.cols()), R = DenseMatrix::Identity(X.cols(), X.cols());
    for (int round = 0; round < 3 && R.rows() > 0; ++round)
      {
        const DenseMatrix removed = V.transpose() * X;
        X -= V * removed;
        coefficients += removed * R;
        R              = pivoted_qr(X, round == 0 ? smallest : meaningless) * R;
        double largest = max_norm(removed);
        agree(map.communicator(), &largest, 1);
        if (round > 0 && largest < 1e-8)
          break;
      }
    G = append_columns(V, X);
    return above(coefficients, R);
  }

  int CompactKrylov::inject(const MultiVector &directions)
  {
    MultiVector       X           = directions;
    const DenseMatrix coordinates = absorb(X, column_norms(directions));
    const int         n_before    = dimension + block_size;
    append_active(with_rows(coordinates, degree * n_vectors), n_before);
    block_size = G.cols() - dimension;
    H          = with_rows(H, dimension + block_size);
    return dimension + block_size - n_before;
  }

  void CompactKrylov::expand(const Operator &apply)
  {
    // ------------------------------------------------- upper part of the image
    const DenseMatrix parts = parts_of(G.middleCols(dimension, block_size), degree);
    MultiVector       states(map, degree * block_size, false), image(map, block_size, false);
    multiply_add(1., basis(), parts, 0., states);
    apply(states, image);

    const DenseMatrix   shifted    = parts.leftCols((degree - 1) * block_size);
    std::vector<double> magnitudes = column_norms(image);
    for (int j = 0; j < block_size; ++j)
      for (int part = 0; part < degree - 1; ++part)
        magnitudes[j] = std::hypot(magnitudes[j], shifted.col(part * block_size + j).norm());
    const DenseMatrix upper = absorb(image, magnitudes);

    // ------------------------------------------------- lower parts: shifted
    const DenseMatrix coordinates = stacked(append_columns(upper, with_rows(shifted, n_vectors)), degree, n_vectors);

    // ------------------------------------------------- new columns of [H; B]
    const int         m_before = dimension;
    const DenseMatrix entries  = append_active(coordinates, dimension + block_size);
    dimension += block_size;
    block_size = G.cols() - dimension;
    H          = with_rows(H, dimension + block_size);
    H.conservativeResize(Eigen::NoChange, dimension);
    H.rightCols(dimension - m_before) = entries;
  }

  RitzPairs CompactKrylov::ritz_pairs() const
  {
    RitzPairs ritz;
    if (dimension == 0)
      return ritz;

    // ------------------------------------------------- real Schur form and eigenvectors
    ritz.schur_form       = H.topRows(dimension);
    ritz.schur_vectors    = DenseMatrix(dimension, dimension);
    DenseMatrix        &T = ritz.schur_form, &Z = ritz.schur_vectors;
    std::vector<double> real(dimension), imaginary(dimension);
    lapack_int          n_sorted = 0;
    const lapack_int    info = LAPACKE_dgees(LAPACK_COL_MAJOR, 'V', 'N', nullptr, dimension, T.data(), dimension, &n_sorted, real.data(),
                                             imaginary.data(), Z.data(), dimension);
    if (info != 0)
      throw SolverError("the QR algorithm did not converge for a projected matrix of " + std::to_string(dimension) + " rows",
                        "eigenvalues of the quadratic pencil",
                        "check the parameters and matrices for values that are not finite, or change Band/Maximum frequency");
    agree(map.communicator(), T);
    agree(map.communicator(), Z);
    agree(map.communicator(), real.data(), dimension);
    agree(map.communicator(), imaginary.data(), dimension);

    ritz.eigenvectors    = Z;
    DenseMatrix &Y       = ritz.eigenvectors;
    lapack_int   n_found = 0;
    LAPACKE_dtrevc(LAPACK_COL_MAJOR, 'R', 'B', nullptr, dimension, T.data(), dimension, nullptr, 1, Y.data(), dimension, dimension,
                   &n_found);

    // ------------------------------------------------- unit vectors and their errors
    const auto width = [&](const int j) { return imaginary[j] != 0. ? 2 : 1; };
    for (int j = 0; j < dimension; j += width(j))
      Y.middleCols(j, width(j)).normalize();
    agree(map.communicator(), Y);
    DenseMatrix errors = H.bottomRows(block_size) * Y;
    agree(map.communicator(), errors);

    // ------------------------------------------------- by descending |ν|
    struct Entry
    {
      std::complex<double> value;
      double               error;
      int                  position;
    };
    std::vector<Entry> entries;
    for (int j = 0; j < dimension; j += width(j))
      entries.push_back({{real[j], std::abs(imaginary[j])}, errors.middleCols(j, width(j)).norm(), j});
    std::stable_sort(entries.begin(), entries.end(), [](const Entry &x, const Entry &y) { return std::abs(x.value) > std::abs(y.value); });
    for (const Entry &entry : entries)
      for (const bool conjugate : {false, true})
        if (!conjugate || entry.value.imag() != 0.)
          {
            ritz.values.push_back(conjugate ? std::conj(entry.value) : entry.value);
            ritz.errors.push_back(entry.error);
            ritz.positions.push_back(entry.position);
          }
    return ritz;
  }

  void CompactKrylov::take_schur_vectors(const CompactKrylov &from, const RitzPairs &ritz, const int n_kept, const int n_reserved)
  {
    // ------------------------------------------------- wanted Schur vectors first
    const int               n = from.dimension;
    DenseMatrix             T = ritz.schur_form, Z = ritz.schur_vectors;
    std::vector<lapack_int> selected(n, 0);
    for (int i = 0; i < n_kept; ++i)
      {
        selected[ritz.positions[i]] = 1;
        if (ritz.values[i].imag() != 0.)
          selected[ritz.positions[i] + 1] = 1;
      }
    std::vector<double> real(n), imaginary(n);
    lapack_int          q         = 0;
    double              condition = 0., separation = 0.;
    std::vector<double> work(std::max(n, 1));
    lapack_int          integer_work = 0;
    // Ignore a positive result: two values that are too close to be exchanged keep their order, and the Schur form is still valid.
    // Without condition numbers, LAPACKE_dtrsen() allocates no integer workspace and crashes: call the variant with workspaces
    LAPACKE_dtrsen_work(LAPACK_COL_MAJOR, 'N', 'V', selected.data(), n, T.data(), n, Z.data(), n, real.data(), imaginary.data(), &q,
                        &condition, &separation, work.data(), n, &integer_work, 1);
    if (q > 0 && q < n && T(q, q - 1) != 0.)
      ++q;
    agree(map.communicator(), T);
    agree(map.communicator(), Z);
    const DenseMatrix kept = Z.leftCols(q);

    // ------------------------------------------------- new coordinates and [H; B]
    const DenseMatrix states = append_columns(from.G.leftCols(n) * kept, from.G.rightCols(from.block_size));
    H                        = above(T.topLeftCorner(q, q), from.H.bottomRows(from.block_size) * kept);
    block_size               = from.block_size;

    // ------------------------------------------------- smallest basis of all parts
    DenseMatrix       P = parts_of(states, degree);
    const DenseMatrix R = pivoted_qr(P, negligible);
    agree(map.communicator(), P);

    auto        compressed = std::make_unique<MultiVector>(map, std::max(n_reserved, static_cast<int>(P.cols())), false);
    MultiVector target     = view(*compressed, 0, P.cols());
    multiply_add(1., from.basis(), P, 0., target);
    U         = std::move(compressed);
    n_vectors = P.cols();
    dimension = q;
    G         = stacked(R, degree, n_vectors);
  }

  void CompactKrylov::restart(const RitzPairs &ritz, const int n_kept)
  {
    take_schur_vectors(*this, ritz, n_kept, U->n_columns());
  }

  CompactKrylov CompactKrylov::deflated(const RitzPairs &ritz, const int n_locked, const int n_more) const
  {
    CompactKrylov result(map, degree, 0);
    result.take_schur_vectors(*this, ritz, n_locked, n_locked + n_more);
    result.block_size = 0;
    result.G.conservativeResize(Eigen::NoChange, result.dimension);
    result.H.conservativeResize(result.dimension, Eigen::NoChange);
    return result;
  }

  MultiVector CompactKrylov::ritz_vectors(const RitzPairs &ritz, const std::vector<int> &positions) const
  {
    const DenseMatrix Y = ritz.eigenvectors(Eigen::placeholders::all, positions);
    return basis() * (G.topRows(n_vectors) * (H * Y));
  }
} // namespace Squeal
