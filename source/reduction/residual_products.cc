#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/residual_products.h>

#include <algorithm>
#include <array>
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

    /// Copies a complex block into real and imaginary halves from @p row on, each column times a factor.
    void insert(DenseMatrix &halves, const ComplexDenseMatrix &part, const int row, const std::function<Complex(int, int)> &factor)
    {
      const int k = part.n_columns();
      for (int j = 0; j < k; ++j)
        for (int i = 0; i < part.n_rows(); ++i)
          {
            const Complex value        = factor(i, j) * part(i, j);
            halves(row + i, j)     = value.real();
            halves(row + i, k + j) = value.imag();
          }
    }

    bool any(const std::vector<double> &coefficients)
    {
      return std::any_of(coefficients.begin(), coefficients.end(), [](const double c) { return c != 0.; });
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

    /// (T_cᵀ C T_c + C_m) X
    MultiVector body_damping_times(const CoupledSystem &system, const MultiVector &X)
    {
      MultiVector result(X.Map(), X.NumVectors());
      if (system.body_damping)
        result.Update(1., *system.body_damping * X, 1.);
      if (system.modal_damping)
        result.Update(1., *system.modal_damping * X, 1.);
      return result;
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

  ProjectedResiduals::ProjectedResiduals(const CoupledSystem  &system,
                                         const UpdatedInverse &inverse,
                                         const double          shift,
                                         const ContactDamping &damping)
    : system(system)
    , inverse(inverse)
    , shift(shift)
    , has_body_damping(system.body_damping || system.modal_damping)
    , has_radial_damping(any(damping.radial))
    , has_sliding_damping(any(damping.sliding))
    , n_c(system.friction_forces->NumGlobalCols())
  {
    fixed.push_back({system.normal_stiffness.get(), true});
    fixed.push_back({system.normal_mass.get(), true});
    if (system.normal_damping)
      fixed.push_back({system.normal_damping.get(), true});
    n_reactions = n_c * static_cast<int>(fixed.size());
    if (has_radial_damping)
      fixed.push_back({system.radial_motion.get(), true});
    fixed.push_back({system.friction_forces.get(), false});

    for (std::size_t p = 0; p < fixed.size(); ++p)
      {
        const SparseMatrix &part = *fixed[p].matrix;
        // The responses to friction forces are at hand
        const MultiVector X =
          fixed[p].transposed ? solve(inverse, transpose_times(part, unit_vectors(part.RangeMap()))) : inverse.attachment_modes();
        fixed_gram = append_columns(fixed_gram, fixed_products(X));
      }
  }

  DenseMatrix ProjectedResiduals::fixed_products(const MultiVector &X) const
  {
    DenseMatrix result(n_c * static_cast<int>(fixed.size()), X.NumVectors());
    for (std::size_t p = 0; p < fixed.size(); ++p)
      insert(result, replicate(fixed[p].transposed ? *fixed[p].matrix * X : transpose_times(*fixed[p].matrix, X)), n_c * static_cast<int>(p), 0);
    return result;
  }

  void ProjectedResiduals::clear()
  {
    blocks     = {};
    fixed_mass = fixed_damping = mass_mass = mass_damping = damping_damping = left_columns = right_block = {};
  }

  void ProjectedResiduals::extend(const ReducedModel &model)
  {
    const int old = blocks.mass.n_rows(), r = model.size();
    if (r == old)
      return;
    blocks                    = model.blocks();
    const MultiVector  &T     = model.basis();
    const MultiVector   fresh = view(T, old, r - old);
    const SparseMatrix &M     = *system.frictionless.mass;

    const MultiVector U = solve(inverse, M * fresh);
    fixed_mass          = append_columns(fixed_mass, fixed_products(U));
    border(mass_mass, gram(T, M * U));
    if (has_body_damping)
      {
        const MultiVector U_C = solve(inverse, body_damping_times(system, fresh));
        fixed_damping         = append_columns(fixed_damping, fixed_products(U_C));
        border(damping_damping, gram(T, body_damping_times(system, U_C)));
        DenseMatrix products(r, r);
        insert(products, mass_damping, 0, 0);
        insert(products, gram(T, M * U_C), 0, old);
        if (old > 0)
          insert(products, gram(body_damping_times(system, U), view(T, 0, old)), old, 0);
        mass_damping = std::move(products);
      }

    // Wᵀ S⁻¹ W and Tᵀ W; the columns that grow stand between those of reactions and the other fixed ones
    const int   n_grown = has_body_damping ? 2 * r : r, n_fixed = fixed_gram.n_rows(), size = n_grown + n_fixed;
    const int   grown = n_reactions, rest = n_reactions + n_grown, n_rest = n_fixed - n_reactions;
    DenseMatrix G(size, size), H(r, size);
    const auto  insert_fixed = [&](const DenseMatrix &products, const int column) {
      for (const auto &[target, first, n] : {std::array<int, 3>{{0, 0, n_reactions}}, {{rest, n_reactions, n_rest}}})
        {
          const DenseMatrix part = rows(products, first, n);
          insert(G, part, target, column);
          insert(G, transpose(part), column, target);
        }
    };
    const DenseMatrix reactions = columns(fixed_gram, 0, n_reactions), others = columns(fixed_gram, n_reactions, n_rest);
    const auto insert_rows = [&](const DenseMatrix &part, const int column) {
      insert(G, rows(part, 0, n_reactions), 0, column);
      insert(G, rows(part, n_reactions, n_rest), rest, column);
    };
    insert_rows(reactions, 0);
    insert_rows(others, rest);
    insert(G, mass_mass, grown, grown);
    insert_fixed(fixed_mass, grown);
    insert(H, blocks.mass, 0, grown);
    if (has_body_damping)
      {
        insert(G, damping_damping, grown + r, grown + r);
        insert(G, mass_damping, grown, grown + r);
        insert(G, transpose(mass_damping), grown + r, grown);
        insert_fixed(fixed_damping, grown + r);
        insert(H, blocks.body_damping, 0, grown + r);
      }
    int        column = 0;
    const auto append = [&](const DenseMatrix &projected) {
      insert(H, transpose(projected), 0, column);
      column += n_c;
    };
    append(blocks.normal_stiffness);
    append(blocks.normal_mass);
    if (system.normal_damping)
      append(blocks.normal_damping);
    column = rest;
    if (has_radial_damping)
      append(blocks.radial_motion);
    append(blocks.friction_forces);

    DenseMatrix responses = H;
    DenseLU(add(blocks.stiffness, blocks.mass, shift * shift), "stiffness of a reduced model").solve(responses);
    const DenseMatrix remainder = add(G, multiply(H, responses, true), -1.);
    left_columns                = columns(remainder, 0, size - (has_sliding_damping ? 0 : n_c));
    right_block                 = rows(columns(remainder, grown, size - grown), grown, size - grown);
  }

  DenseMatrix ProjectedResiduals::coefficients(const double                mu,
                                               const ContactDamping       &damping,
                                               const std::vector<Complex> &lambda,
                                               const ComplexDenseMatrix   &vectors,
                                               const bool                  left) const
  {
    const int   k = static_cast<int>(lambda.size());
    DenseMatrix result(left ? left_columns.n_columns() : right_block.n_columns(), 2 * k);
    const auto  square = [&](const int j) { return lambda[j] * lambda[j]; };
    int         row    = 0;
    const auto  put    = [&](const ComplexDenseMatrix &part, const std::function<Complex(int, int)> &factor) {
      insert(result, part, row, factor);
      row += part.n_rows();
    };
    const auto coefficient = [](const std::vector<double> &c, const int i) { return c.empty() ? 0. : c[i]; };

    const ComplexDenseMatrix tangential = multiply(blocks.friction_forces, vectors);
    if (left) // V_Kᵀ, V_Mᵀ, V_Cᵀ: friction of the left vectors
      {
        put(tangential, [&](int, int) { return -mu; });
        put(tangential, [&](int, const int j) { return -mu * square(j); });
        if (system.normal_damping)
          put(tangential, [&](int, const int j) { return -mu * lambda[j]; });
      }

    put(vectors, [&](int, const int j) { return square(j) - shift * shift; });
    if (has_body_damping)
      put(vectors, [&](int, const int j) { return lambda[j]; });
    if (has_radial_damping)
      put(multiply(blocks.radial_motion, vectors), [&](const int i, const int j) { return lambda[j] * coefficient(damping.radial, i); });

    // A: damping along t of both, friction of the right vectors
    if (row == result.n_rows())
      return result;
    ComplexDenseMatrix forces(n_c, k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < n_c; ++i)
        forces(i, j) = lambda[j] * coefficient(damping.sliding, i) * tangential(i, j);
    if (!left)
      {
        const auto add_friction = [&](const DenseMatrix &V, const std::function<Complex(int)> &factor) {
          const ComplexDenseMatrix reaction = multiply(V, vectors);
          for (int j = 0; j < k; ++j)
            for (int i = 0; i < n_c; ++i)
              forces(i, j) -= mu * factor(j) * reaction(i, j);
        };
        add_friction(blocks.normal_stiffness, [](int) { return 1.; });
        add_friction(blocks.normal_mass, square);
        if (system.normal_damping)
          add_friction(blocks.normal_damping, [&](const int j) { return lambda[j]; });
      }
    put(forces, [](int, int) { return 1.; });
    return result;
  }

  ResidualProducts ProjectedResiduals::products(const double                mu,
                                                const ContactDamping       &damping,
                                                const std::vector<Complex> &lambda,
                                                const ComplexDenseMatrix   &right,
                                                const ComplexDenseMatrix   &left) const
  {
    const DenseMatrix y = coefficients(mu, damping, lambda, right, false), z = coefficients(mu, damping, lambda, left, true);
    const DenseMatrix Gy = multiply(right_block, y), Gz = multiply(left_columns, z);
    return {from_halves(multiply(rows(Gz, n_reactions, y.n_rows()), y, true)), hermitian_products(y, Gy),
            hermitian_products(z, rows(Gz, 0, z.n_rows()))};
  }
} // namespace Squeal
