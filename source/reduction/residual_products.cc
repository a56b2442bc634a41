#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/residual_products.h>

#include <algorithm>
#include <functional>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Copies @p part into @p matrix from entry (row, column) on.
    void insert(DenseMatrix &matrix, const DenseMatrix &part, const int row, const int column)
    {
      for (int j = 0; j < part.n_columns(); ++j)
        std::copy(part.column(j), part.column(j) + part.n_rows(), matrix.column(column + j) + row);
    }

    /// Rows [first, first + n).
    DenseMatrix rows(const DenseMatrix &X, const int first, const int n)
    {
      DenseMatrix result(n, X.n_columns());
      for (int j = 0; j < X.n_columns(); ++j)
        std::copy(X.column(j) + first, X.column(j) + first + n, result.column(j));
      return result;
    }

    MultiVector solve(const UpdatedInverse &inverse, const MultiVector &F)
    {
      MultiVector U(F.Map(), F.NumVectors());
      inverse.apply_frictionless(F, U);
      return U;
    }

    /// Diagonal of Xᴴ Y for matrices of real and imaginary halves.
    std::vector<double> hermitian_products(const DenseMatrix &X, const DenseMatrix &Y)
    {
      const int           k = X.n_columns() / 2;
      std::vector<double> result(k);
      for (int j = 0; j < k; ++j)
        for (const int column : {j, k + j})
          for (int i = 0; i < X.n_rows(); ++i)
            result[j] += X(i, column) * Y(i, column);
      // Rounding may leave a residual of zero with a negative square
      for (double &square : result)
        square = std::max(square, 0.);
      return result;
    }
  } // namespace

  ProjectedResiduals::ProjectedResiduals(const CoupledSystem   &system,
                                         const UpdatedInverse  &inverse,
                                         const double           shift,
                                         const ParameterValues &values)
    : system(system)
    , inverse(inverse)
    , shift(shift)
  {
    const ParameterValues with_friction = system.at(1., values);
    for (std::size_t k = 0; k < system.terms.size(); ++k)
      if (const Term &term = system.terms[k]; term.vanishes(with_friction) || term.matrix == system.stiffness)
        continue;
      else if (term.matrix)
        sparse.push_back({&term, k, term.symmetry == Symmetry::skew ? -1. : 1., term.matrix == system.mass ? shift * shift : 0., {}, {}});
      else
        {
          low_rank.push_back(&term);
          for (const bool transposed : {false, true})
            {
              const LowRankFactor *factor = &term.target(transposed);
              auto known = std::find_if(factors.begin(), factors.end(), [factor](const Factor &f) { return f.factor == factor; });
              if (known == factors.end())
                known = factors.insert(known, {factor, 0, false, false});
              (transposed ? known->in_left : known->in_right) = true;
            }
        }
    std::stable_sort(factors.begin(), factors.end(),
                     [](const Factor &a, const Factor &b) { return a.in_right - a.in_left < b.in_right - b.in_left; });
    int first = 0;
    for (Factor &f : factors)
      {
        f.first = first;
        first += f.factor->rank();
        (!f.in_right ? n_left : !f.in_left ? n_right : n_shared) += f.factor->rank();
      }
    for (const Factor &f : factors)
      // The responses to friction forces are at hand
      factor_gram = append_columns(factor_gram, factor_products(f.factor == system.friction_forces.get() ?
                                                                  inverse.attachment_modes() :
                                                                  solve(inverse, f.factor->columns(0, f.factor->rank()))));
    clear();
  }

  DenseMatrix ProjectedResiduals::factor_products(const MultiVector &X) const
  {
    DenseMatrix result(n_left + n_shared + n_right, X.NumVectors());
    for (const Factor &f : factors)
      insert(result, f.factor->transpose_times(X), f.first, 0);
    return result;
  }

  int ProjectedResiduals::column_of(const Factor &factor) const
  {
    return factor.first + (factor.in_right ? static_cast<int>(sparse.size()) * r : 0);
  }

  void ProjectedResiduals::clear()
  {
    r = 0;
    motions.clear();
    left_columns = right_block = {};
    for (Sparse &part : sparse)
      {
        part.factor_products = {};
        part.products.assign(sparse.size(), {});
      }
  }

  void ProjectedResiduals::extend(const ReducedModel &model)
  {
    const int old = r;
    r             = model.size();
    if (r == old)
      return;
    for (const Factor &f : factors)
      motions[f.factor] = model.motions(*f.factor);

    // New columns of (A T)ᵀ S⁻¹ A' T; its new rows are those of the transposed problem
    const MultiVector       &T     = model.basis();
    const MultiVector        fresh = view(T, old, r - old);
    const std::size_t        n     = sparse.size();
    std::vector<DenseMatrix> columns(n * n);
    for (std::size_t k = 0; k < n; ++k)
      {
        const MultiVector U       = solve(inverse, *sparse[k].term->matrix * fresh);
        sparse[k].factor_products = append_columns(sparse[k].factor_products, factor_products(U));
        for (std::size_t l = 0; l < n; ++l)
          {
            MultiVector F = *sparse[l].term->matrix * U;
            F.Scale(sparse[l].sign);
            columns[l + n * k] = gram(T, F);
          }
      }
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t l = 0; l < n; ++l)
        {
          DenseMatrix products(r, r);
          insert(products, sparse[k].products[l], 0, 0);
          insert(products, columns[l + n * k], 0, old);
          insert(products, transpose(rows(columns[k + n * l], 0, old)), old, 0);
          sparse[k].products[l] = std::move(products);
        }
    assemble(model);
  }

  void ProjectedResiduals::assemble(const ReducedModel &model)
  {
    const int n_sparse = static_cast<int>(sparse.size()) * r, size = n_sparse + n_left + n_shared + n_right;

    // Wᵀ S⁻¹ W and Tᵀ W
    DenseMatrix G(size, size), H(r, size);
    for (const Factor &f : factors)
      {
        const int column = column_of(f), rank = f.factor->rank();
        for (const Factor &g : factors)
          insert(G, rows(columns(factor_gram, f.first, rank), g.first, g.factor->rank()), column_of(g), column);
        insert(H, transpose(motions.at(f.factor)), 0, column);
      }
    for (std::size_t k = 0; k < sparse.size(); ++k)
      {
        const int column = n_left + static_cast<int>(k) * r;
        for (std::size_t l = 0; l < sparse.size(); ++l)
          insert(G, sparse[k].products[l], n_left + static_cast<int>(l) * r, column);
        for (const Factor &f : factors)
          {
            const DenseMatrix part = rows(sparse[k].factor_products, f.first, f.factor->rank());
            insert(G, part, column_of(f), column);
            insert(G, transpose(part), column, column_of(f));
          }
        insert(H, model.projected(sparse[k].number), 0, column);
      }

    DenseMatrix responses = H;
    DenseLU(add(model.stiffness(), model.mass(), shift * shift), "stiffness of a reduced model").solve(responses);
    const DenseMatrix remainder = add(G, multiply(H, responses, true), -1.);
    left_columns                = columns(remainder, 0, size - n_right);
    right_block                 = rows(columns(remainder, n_left, size - n_left), n_left, size - n_left);
  }

  DenseMatrix ProjectedResiduals::coefficients(const ParameterValues      &values,
                                               const std::vector<Complex> &lambda,
                                               const ComplexDenseMatrix   &vectors,
                                               const bool                  transposed) const
  {
    const int   k     = static_cast<int>(lambda.size());
    const int   first = transposed ? 0 : n_left; // column of W that belongs to the first row
    DenseMatrix result(transposed ? left_columns.n_columns() : right_block.n_columns(), 2 * k);
    const auto  theta = [&](const Term &term, const int j) {
      return term.coefficient.at(values) * (term.power == 0 ? 1. : term.power == 1 ? lambda[j] : lambda[j] * lambda[j]);
    };
    const auto add_rows = [&](const ComplexDenseMatrix &part, const int row, const std::function<Complex(int)> &factor) {
      for (int j = 0; j < k; ++j)
        {
          const Complex f = factor(j);
          for (int i = 0; i < part.n_rows(); ++i)
            {
              const Complex value = f * part(i, j);
              result(row + i, j) += value.real();
              result(row + i, k + j) += value.imag();
            }
        }
    };

    for (std::size_t s = 0; s < sparse.size(); ++s)
      add_rows(vectors, n_left - first + static_cast<int>(s) * r,
               [&](const int j) { return (transposed ? sparse[s].sign : 1.) * theta(*sparse[s].term, j) - sparse[s].sigma; });
    std::map<const LowRankFactor *, ComplexDenseMatrix> moved;
    for (const Term *term : low_rank)
      {
        if (term->vanishes(values))
          continue;
        const LowRankFactor &source = term->source(transposed), &target = term->target(transposed);
        if (moved.count(&source) == 0)
          moved[&source] = multiply(motions.at(&source), vectors);
        const auto factor = std::find_if(factors.begin(), factors.end(), [&target](const Factor &f) { return f.factor == &target; });
        add_rows(term->weighted(moved.at(&source), values), column_of(*factor) - first, [&](const int j) { return theta(*term, j); });
      }
    return result;
  }

  ResidualProducts ProjectedResiduals::products(const ParameterValues      &values,
                                                const std::vector<Complex> &lambda,
                                                const ComplexDenseMatrix   &right,
                                                const ComplexDenseMatrix   &left) const
  {
    const DenseMatrix y = coefficients(values, lambda, right, false), z = coefficients(values, lambda, left, true);
    const DenseMatrix Gy = multiply(right_block, y), Gz = multiply(left_columns, z);
    return {from_halves(multiply(rows(Gz, n_left, y.n_rows()), y, true)), hermitian_products(y, Gy),
            hermitian_products(z, rows(Gz, 0, z.n_rows()))};
  }
} // namespace Squeal
