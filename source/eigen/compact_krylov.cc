#include <squeal/base/exceptions.h>
#include <squeal/eigen/compact_krylov.h>

#include <Epetra_Comm.h>
#include <lapacke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Parts of a vector below this fraction of the whole are rounding errors.
    constexpr double negligible = 1e-15;
    /// Unit vectors of which projecting them again leaves less than this were rounding errors.
    constexpr double meaningless = 1e-3;

    /// Every process takes the values of the first one: branches must not depend on how a sum was rounded.
    void replicate(const Epetra_Comm &comm, double *values, const std::size_t n)
    {
      if (n > 0)
        comm.Broadcast(values, static_cast<int>(n), 0);
    }

    void replicate(const Epetra_Comm &comm, DenseMatrix &A)
    {
      replicate(comm, A.column(), static_cast<std::size_t>(A.n_rows()) * A.n_columns());
    }

    /// A copied into the upper left corner of an n_rows × n_columns matrix of zeros.
    DenseMatrix enlarged(const DenseMatrix &A, const int n_rows, const int n_columns)
    {
      DenseMatrix result(n_rows, n_columns);
      for (int j = 0; j < A.n_columns(); ++j)
        std::copy_n(A.column(j), A.n_rows(), result.column(j));
      return result;
    }

    /// Rows [first, first + n) of A.
    DenseMatrix rows(const DenseMatrix &A, const int first, const int n)
    {
      DenseMatrix result(n, A.n_columns());
      for (int j = 0; j < A.n_columns(); ++j)
        std::copy_n(A.column(j) + first, n, result.column(j));
      return result;
    }

    /// [A B].
    DenseMatrix beside(const DenseMatrix &A, const DenseMatrix &B)
    {
      DenseMatrix result = enlarged(A, std::max(A.n_rows(), B.n_rows()), A.n_columns() + B.n_columns());
      for (int j = 0; j < B.n_columns(); ++j)
        std::copy_n(B.column(j), B.n_rows(), result.column(A.n_columns() + j));
      return result;
    }

    /// Coordinates of @p degree stacked parts of length r, padded by zeros to parts of length r_new.
    DenseMatrix padded(const DenseMatrix &G, const int degree, const int r_new)
    {
      const int   r = G.n_rows() / degree;
      DenseMatrix result(degree * r_new, G.n_columns());
      for (int j = 0; j < G.n_columns(); ++j)
        for (int part = 0; part < degree; ++part)
          std::copy_n(G.column(j) + part * r, r, result.column(j) + part * r_new);
      return result;
    }

    double norm(const double *x, const int n)
    {
      double sum = 0.;
      for (int i = 0; i < n; ++i)
        sum += x[i] * x[i];
      return std::sqrt(sum);
    }

    /**
     * X Π = Q R by modified Gram–Schmidt with column pivoting; columns left
     * with no more than @p smallest, one for each, are dropped. Q replaces the
     * first columns of X; returns R Πᵀ, k × b.
     */
    DenseMatrix pivoted_qr(MultiVector &X, std::vector<double> smallest)
    {
      const int        b = X.NumVectors();
      DenseMatrix      R(b, b);
      std::vector<int> permutation(b);
      std::iota(permutation.begin(), permutation.end(), 0);

      int k = 0;
      for (; k < b; ++k)
        {
          const MultiVector   remaining = view(X, k, b - k);
          std::vector<double> norms     = column_norms(remaining);
          replicate(X.Comm(), norms.data(), norms.size());
          int pivot = 0;
          for (int j = 1; j < b - k; ++j)
            if (norms[j] > norms[pivot])
              pivot = j;

          // ------------------------------------------------- the largest one next
          const double largest = norms[pivot];
          if (pivot > 0)
            {
              pivot += k;
              MultiVector       first = view(X, k, 1), second = view(X, pivot, 1);
              const MultiVector copy = first;
              first.Update(1., second, 0.);
              second.Update(1., copy, 0.);
              for (int i = 0; i < k; ++i)
                std::swap(R(i, k), R(i, pivot));
              std::swap(permutation[k], permutation[pivot]);
              std::swap(smallest[k], smallest[pivot]);
            }
          if (!(largest > smallest[k]))
            break;

          // ------------------------------------------------- removed from the others
          MultiVector q = view(X, k, 1);
          q.Scale(1. / largest);
          R(k, k) = largest;
          if (k + 1 < b)
            {
              MultiVector       others       = view(X, k + 1, b - k - 1);
              const DenseMatrix coefficients = gram(q, others);
              multiply_add(-1., q, coefficients, 1., others);
              for (int j = k + 1; j < b; ++j)
                R(k, j) = coefficients(0, j - k - 1);
            }
        }

      DenseMatrix result(k, b);
      for (int j = 0; j < b; ++j)
        std::copy_n(R.column(j), k, result.column(permutation[j]));
      return result;
    }

    /// The same for a small matrix, by Householder reflections (X is replaced by Q, n × k).
    DenseMatrix pivoted_qr(DenseMatrix &X, const double smallest)
    {
      const int           n = X.n_rows(), b = X.n_columns();
      const int           size = std::min(n, b);
      std::vector<int>    permutation(b, 0);
      std::vector<double> reflections(size);
      if (size == 0)
        {
          X = DenseMatrix(n, 0);
          return DenseMatrix(0, b);
        }
      LAPACKE_dgeqp3(LAPACK_COL_MAJOR, n, b, X.column(), n, permutation.data(), reflections.data());
      int k = 0;
      while (k < size && std::abs(X(k, k)) > smallest)
        ++k;
      DenseMatrix R(k, b);
      for (int j = 0; j < b; ++j)
        std::copy_n(X.column(j), std::min(k, j + 1), R.column(permutation[j] - 1));
      if (k > 0)
        LAPACKE_dorgqr(LAPACK_COL_MAJOR, n, k, k, X.column(), n, reflections.data());
      X = columns(X, 0, k);
      return R;
    }

    /// A above B.
    DenseMatrix above(const DenseMatrix &A, const DenseMatrix &B)
    {
      DenseMatrix result = enlarged(A, A.n_rows() + B.n_rows(), A.n_columns());
      for (int j = 0; j < B.n_columns(); ++j)
        std::copy_n(B.column(j), B.n_rows(), result.column(j) + A.n_rows());
      return result;
    }
  } // namespace

  CompactKrylov::CompactKrylov(const Epetra_Map &map, const int degree, const int n_reserved)
    : map(&map)
    , degree(degree)
    , U(std::make_unique<MultiVector>(map, std::max(n_reserved, 1), false))
  {}

  int CompactKrylov::dimension() const
  {
    return m;
  }

  int CompactKrylov::block_size() const
  {
    return b;
  }

  int CompactKrylov::n_vectors() const
  {
    return r;
  }

  MultiVector CompactKrylov::basis() const
  {
    return view(*U, 0, r);
  }

  void CompactKrylov::reserve(const int n)
  {
    if (n <= U->NumVectors())
      return;
    auto larger = std::make_unique<MultiVector>(*map, n + n / 2, false);
    if (r > 0)
      {
        MultiVector target = view(*larger, 0, r);
        target.Update(1., basis(), 0.);
      }
    U = std::move(larger);
  }

  DenseMatrix CompactKrylov::absorb(MultiVector &X, const std::vector<double> &magnitudes)
  {
    DenseMatrix coefficients(r, X.NumVectors()), R = identity(X.NumVectors());
    const auto  project = [&](MultiVector &Q) {
      if (r == 0)
        return 0.;
      const DenseMatrix removed = gram(basis(), Q);
      multiply_add(-1., basis(), removed, 1., Q);
      coefficients = add(coefficients, multiply(removed, R));
      return max_norm(removed);
    };

    // Revealing the rank and normalising before the second round makes "twice
    // is enough" hold for each direction, however little the first one left.
    std::vector<double> smallest = magnitudes;
    std::for_each(smallest.begin(), smallest.end(), [](double &x) { x *= negligible; });
    project(X);
    R = pivoted_qr(X, smallest);
    for (int round = 0; round < 2 && R.n_rows() > 0; ++round)
      {
        MultiVector Q       = view(X, 0, R.n_rows());
        double      removed = project(Q);
        replicate(map->Comm(), &removed, 1);
        R = multiply(pivoted_qr(Q, std::vector<double>(R.n_rows(), meaningless)), R);
        if (removed < 1e-8)
          break;
      }

    const int n_new = R.n_rows();
    if (n_new > 0)
      {
        reserve(r + n_new);
        MultiVector target = view(*U, r, n_new);
        target.Update(1., view(X, 0, n_new), 0.);
        G = padded(G, degree, r + n_new);
        r += n_new;
      }
    return above(coefficients, R);
  }

  DenseMatrix CompactKrylov::append_active(const DenseMatrix &states, const int n_basis)
  {
    DenseMatrix X        = states;
    double      smallest = 0.;
    for (int j = 0; j < X.n_columns(); ++j)
      smallest = std::max(smallest, negligible * norm(X.column(j), X.n_rows()));

    const DenseMatrix V = columns(G, 0, n_basis);
    DenseMatrix       coefficients(n_basis, X.n_columns()), R = identity(X.n_columns());
    for (int round = 0; round < 3 && R.n_rows() > 0; ++round)
      {
        const DenseMatrix removed = multiply(V, X, true);
        X                         = add(X, multiply(V, removed), -1.);
        coefficients              = add(coefficients, multiply(removed, R));
        R                         = multiply(pivoted_qr(X, round == 0 ? smallest : meaningless), R);
        double largest            = max_norm(removed);
        replicate(map->Comm(), &largest, 1);
        if (round > 0 && largest < 1e-8)
          break;
      }
    G = beside(V, X);
    return above(coefficients, R);
  }

  int CompactKrylov::inject(const MultiVector &directions)
  {
    MultiVector       X           = directions;
    const DenseMatrix coordinates = absorb(X, column_norms(directions));
    const DenseMatrix states      = enlarged(coordinates, degree * r, coordinates.n_columns());
    const int         n_before    = m + b;
    append_active(states, n_before);
    b = G.n_columns() - m;
    H = enlarged(H, m + b, m);
    return m + b - n_before;
  }

  void CompactKrylov::expand(const Operator &apply)
  {
    // ------------------------------------------------- upper part of the image
    DenseMatrix parts(r, degree * b);
    for (int part = 0; part < degree; ++part)
      for (int j = 0; j < b; ++j)
        std::copy_n(G.column(m + j) + part * r, r, parts.column(part * b + j));
    MultiVector states(*map, degree * b, false), image(*map, b, false);
    multiply_add(1., basis(), parts, 0., states);
    apply(states, image);

    std::vector<double> magnitudes = column_norms(image);
    for (int j = 0; j < b; ++j)
      for (int part = 0; part < degree - 1; ++part)
        magnitudes[j] = std::hypot(magnitudes[j], norm(parts.column(part * b + j), parts.n_rows()));
    const DenseMatrix upper = absorb(image, magnitudes);

    // ------------------------------------------------- lower parts: shifted
    DenseMatrix coordinates(degree * r, b);
    for (int j = 0; j < b; ++j)
      {
        std::copy_n(upper.column(j), upper.n_rows(), coordinates.column(j));
        for (int part = 1; part < degree; ++part)
          std::copy_n(parts.column((part - 1) * b + j), parts.n_rows(), coordinates.column(j) + part * r);
      }

    // ------------------------------------------------- new columns of [H; B]
    const int         m_new    = m + b;
    const DenseMatrix entries  = append_active(coordinates, m_new);
    const int         m_before = m;
    b                          = G.n_columns() - m_new;
    m                          = m_new;
    H                          = enlarged(H, m + b, m);
    for (int j = m_before; j < m; ++j)
      std::copy_n(entries.column(j - m_before), entries.n_rows(), H.column(j));
  }

  RitzPairs CompactKrylov::ritz_pairs() const
  {
    RitzPairs ritz;
    if (m == 0)
      return ritz;

    // ------------------------------------------------- real Schur form and eigenvectors
    ritz.schur_form       = rows(H, 0, m);
    ritz.schur_vectors    = DenseMatrix(m, m);
    DenseMatrix        &T = ritz.schur_form, &Z = ritz.schur_vectors;
    std::vector<double> real(m), imaginary(m);
    lapack_int          n_sorted = 0;
    const lapack_int    info =
      LAPACKE_dgees(LAPACK_COL_MAJOR, 'V', 'N', nullptr, m, T.column(), m, &n_sorted, real.data(), imaginary.data(), Z.column(), m);
    if (info != 0)
      throw SolverError("The QR algorithm did not converge for a projected matrix of " + std::to_string(m) + " rows",
                        "eigenvalues of the quadratic pencil",
                        "check the matrices for entries that are not finite, or choose another shift");
    replicate(map->Comm(), T);
    replicate(map->Comm(), Z);
    replicate(map->Comm(), real.data(), m);
    replicate(map->Comm(), imaginary.data(), m);

    ritz.eigenvectors    = Z;
    lapack_int n_vectors = 0;
    LAPACKE_dtrevc(LAPACK_COL_MAJOR, 'R', 'B', nullptr, m, T.column(), m, nullptr, 1, ritz.eigenvectors.column(), m, m, &n_vectors);

    // ------------------------------------------------- unit vectors and their errors
    DenseMatrix &Y = ritz.eigenvectors;
    for (int j = 0; j < m; ++j)
      {
        const int    width = imaginary[j] != 0. ? 2 : 1;
        const double scale = 1. / norm(Y.column(j), width * m);
        std::for_each(Y.column(j), Y.column(j) + width * m, [scale](double &y) { y *= scale; });
        j += width - 1;
      }
    replicate(map->Comm(), Y);
    DenseMatrix errors = multiply(rows(H, m, b), Y);
    replicate(map->Comm(), errors);

    // ------------------------------------------------- by descending |ν|
    struct Entry
    {
      std::complex<double> value;
      double               error;
      int                  position;
    };
    std::vector<Entry> entries;
    for (int j = 0; j < m; ++j)
      {
        const int width = imaginary[j] != 0. ? 2 : 1;
        entries.push_back({{real[j], std::abs(imaginary[j])}, norm(errors.column(j), width * b), j});
        j += width - 1;
      }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) { return std::abs(a.value) > std::abs(b.value); });
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

  void CompactKrylov::restart(const RitzPairs &ritz, const int n_kept)
  {
    // ------------------------------------------------- wanted Schur vectors first
    DenseMatrix             T = ritz.schur_form, Z = ritz.schur_vectors;
    std::vector<lapack_int> selected(m, 0);
    for (int i = 0; i < n_kept; ++i)
      {
        selected[ritz.positions[i]] = 1;
        if (ritz.values[i].imag() != 0.)
          selected[ritz.positions[i] + 1] = 1;
      }
    std::vector<double> real(m), imaginary(m);
    lapack_int          q         = 0;
    double              condition = 0., separation = 0.;
    std::vector<double> work(std::max(m, 1));
    lapack_int          integer_work = 0;
    // A positive result means that two values too close to be exchanged stay
    // where they are: the Schur form is valid all the same. LAPACKE's driver
    // without "_work" hands over no integer work space here, and crashes.
    LAPACKE_dtrsen_work(LAPACK_COL_MAJOR, 'N', 'V', selected.data(), m, T.column(), m, Z.column(), m, real.data(), imaginary.data(), &q,
                        &condition, &separation, work.data(), m, &integer_work, 1);
    if (q > 0 && q < m && T(q, q - 1) != 0.)
      ++q;
    replicate(map->Comm(), T);
    replicate(map->Comm(), Z);
    const DenseMatrix kept = columns(Z, 0, q);

    // ------------------------------------------------- new coordinates and [H; B]
    const DenseMatrix states = beside(multiply(columns(G, 0, m), kept), columns(G, m, b));
    DenseMatrix       H_new  = enlarged(rows(columns(T, 0, q), 0, q), q + b, q);
    const DenseMatrix B      = multiply(rows(H, m, b), kept);
    for (int j = 0; j < q; ++j)
      std::copy_n(B.column(j), b, H_new.column(j) + q);

    // ------------------------------------------------- smallest basis of all parts
    DenseMatrix parts(r, degree * (q + b));
    for (int part = 0; part < degree; ++part)
      for (int j = 0; j < q + b; ++j)
        std::copy_n(states.column(j) + part * r, r, parts.column(part * (q + b) + j));
    DenseMatrix       P = parts;
    const DenseMatrix R = pivoted_qr(P, negligible);
    replicate(map->Comm(), P);
    const int r_new = P.n_columns();

    auto        compressed = std::make_unique<MultiVector>(*map, U->NumVectors(), false);
    MultiVector target     = view(*compressed, 0, r_new);
    multiply_add(1., basis(), P, 0., target);
    U = std::move(compressed);
    r = r_new;
    m = q;
    H = H_new;
    G = DenseMatrix(degree * r, m + b);
    for (int part = 0; part < degree; ++part)
      for (int j = 0; j < m + b; ++j)
        std::copy_n(R.column(part * (m + b) + j), r, G.column(j) + part * r);
  }

  CompactKrylov CompactKrylov::deflated(const RitzPairs &ritz, const int n_locked) const
  {
    CompactKrylov result(*map, degree, r);
    MultiVector   target = view(*result.U, 0, r);
    target.Update(1., basis(), 0.);
    result.r = r;
    result.m = m;
    result.b = b;
    result.G = G;
    result.H = H;
    result.restart(ritz, n_locked);
    result.b = 0;
    result.G = columns(result.G, 0, result.m);
    result.H = rows(result.H, 0, result.m);
    return result;
  }

  MultiVector CompactKrylov::ritz_vectors(const RitzPairs &ritz, const std::vector<int> &positions) const
  {
    DenseMatrix Y(m, static_cast<int>(positions.size()));
    for (int j = 0; j < Y.n_columns(); ++j)
      std::copy_n(ritz.eigenvectors.column(positions[j]), m, Y.column(j));
    const DenseMatrix image = multiply(H, Y);
    return basis() * multiply(rows(G, 0, r), image);
  }
} // namespace Squeal
