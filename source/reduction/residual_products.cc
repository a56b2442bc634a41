// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/reduction/residual_products.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Number s of random vectors. New basis vectors are selected with s other vectors, because the first set would miss the residuals that
    /// it underestimates.
    constexpr int size_of_sketch = 128;

    /// Diagonal of Xᴴ Y for matrices stored as real parts, then imaginary parts; negative rounding errors are set to zero.
    std::vector<double> hermitian_products(const DenseMatrix &X, const DenseMatrix &Y)
    {
      const Eigen::Index    k        = X.cols() / 2;
      const Eigen::VectorXd products = X.cwiseProduct(Y).colwise().sum();
      const Eigen::VectorXd result   = (products.head(k) + products.tail(k)).cwiseMax(0.);
      return {result.begin(), result.end()};
    }

    Eigen::VectorXcd powers(const std::vector<Complex> &lambda, const int exponent)
    {
      return as_column(lambda).unaryExpr([exponent](const Complex &l) { return exponent == 0 ? 1. : exponent == 1 ? l : l * l; });
    }

    /// True for symmetric terms of the stiffness (power 0) or the mass (2).
    bool is_symmetric(const Term &term, const int power)
    {
      return term.matrix && term.is_frictionless() && term.power == power;
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
      // Keep terms that vanish only at these values, unless their weights vanish; the caller guarantees that such weights remain zero
      if (const Term &term = system.terms[k]; term.vanishes(with_friction) && (!term.weights.empty() || term.coefficient.is_constant()))
        continue;
      else if (term.matrix)
        sparse.push_back({&term, k, term.symmetry == Symmetry::skew ? -1. : 1., 0., {}, {}, {}, {}});
      else
        {
          low_rank.push_back(&term);
          for (const LowRankFactor *factor : {term.left.get(), term.right.get()})
            if (number_of(*factor) == static_cast<int>(factors.size()))
              {
                factors.push_back({factor, n_factor_columns});
                n_factor_columns += factor->rank();
              }
        }
    // Constant stiffness terms cancel in Q(λ) − S
    sparse.erase(std::remove_if(sparse.begin(), sparse.end(),
                                [](const Sparse &part) { return is_symmetric(*part.term, 0) && part.term->coefficient.is_constant(); }),
                 sparse.end());
    for (Sparse &part : sparse)
      if (is_symmetric(*part.term, 0) || is_symmetric(*part.term, 2))
        part.sigma = part.term->coefficient.at(system.values) * (is_symmetric(*part.term, 2) ? shift * shift : 1.);
    clear();
  }

  bool ProjectedResiduals::use_sketch()
  {
    MultiVector     white(inverse.map(), 2 * size_of_sketch, false), V(inverse.map(), 2 * size_of_sketch);
    std::mt19937_64 random;
    const double    size = 1. / std::sqrt(double(size_of_sketch));
    for (double &entry : white.local().reshaped())
      entry = random() % 2 == 0 ? size : -size;
    if (inverse.frictionless().half_solve(white, V))
      sketch = std::move(V);
    return sketch.has_value();
  }

  DenseMatrix ProjectedResiduals::factor_products(const MultiVector &X) const
  {
    DenseMatrix result(n_factor_columns, X.n_columns());
    for (const Factor &f : factors)
      result.middleRows(f.first, f.factor->rank()) = f.factor->transpose_times(X);
    return result;
  }

  void ProjectedResiduals::clear()
  {
    r = 0;
    motions.clear();
    is_prepared     = false;
    sketched_pencil = {};
    for (Sparse &part : sparse)
      {
        part.projected = part.factor_products = part.sketched = {};
        part.products.assign(sparse.size(), {});
      }
  }

  void ProjectedResiduals::extend(const ReducedModel &model)
  {
    const int old = r;
    if (model.size() == old)
      return;
    set_projections(model);

    // New columns of (A T)ᵀ S⁻¹ A' T; its new rows follow from the transposed problem
    const MultiVector &T     = model.basis();
    const MultiVector  fresh = view(T, old, r - old);
    if (sketch)
      {
        for (Sparse &part : sparse)
          part.sketched = append_columns(part.sketched, gram(*sketch, *part.term->matrix * fresh));
        const MultiVector ST = *system.stiffness * fresh + shift * shift * (*system.mass * fresh);
        sketched_pencil      = append_columns(sketched_pencil, gram(*sketch, ST));
        return;
      }

    if (factor_gram.cols() < n_factor_columns)
      {
        factor_gram = DenseMatrix(n_factor_columns, n_factor_columns);
        for (const Factor &f : factors)
          inverse.for_responses(*f.factor, [&](const int first, const MultiVector &X) {
            factor_gram.middleCols(f.first + first, X.n_columns()) = factor_products(X);
          });
      }
    const std::size_t        n = sparse.size();
    std::vector<DenseMatrix> columns(n * n, DenseMatrix(r, r - old));
    for (std::size_t k = 0; k < n; ++k)
      for_column_blocks(r - old, [&](const int first, const int width) {
        const MultiVector U       = inverse.solve_frictionless(*sparse[k].term->matrix * view(fresh, first, width));
        sparse[k].factor_products = append_columns(sparse[k].factor_products, factor_products(U));
        for (std::size_t l = 0; l < n; ++l)
          columns[l + n * k].middleCols(first, width) = sparse[l].sign * gram(T, *sparse[l].term->matrix * U);
      });
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t l = 0; l < n; ++l)
        {
          DenseMatrix products(r, r);
          products << sparse[k].products[l], columns[l + n * k].topRows(old), columns[k + n * l].topRows(old).transpose(),
            columns[l + n * k].bottomRows(r - old);
          sparse[k].products[l] = std::move(products);
        }
  }

  void ProjectedResiduals::set_projections(const ReducedModel &model)
  {
    r = model.size();
    for (const Factor &f : factors)
      motions[f.factor] = model.motions(*f.factor);
    for (Sparse &part : sparse)
      part.projected = model.projected(part.number);
    pencil      = model.stiffness() + shift * shift * model.mass();
    is_prepared = false;
  }

  void ProjectedResiduals::restrict(const ReducedModel &model, const DenseMatrix &Z)
  {
    set_projections(model);
    const auto restrict_columns = [&Z](DenseMatrix &X) {
      if (X.size() > 0)
        X *= Z;
    };
    restrict_columns(sketched_pencil);
    for (Sparse &part : sparse)
      {
        restrict_columns(part.sketched);
        restrict_columns(part.factor_products);
        for (DenseMatrix &products : part.products)
          if (products.size() > 0)
            products = Z.transpose() * products * Z;
      }
  }

  int ProjectedResiduals::number_of(const LowRankFactor &factor) const
  {
    return static_cast<int>(std::find_if(factors.begin(), factors.end(), [&factor](const Factor &f) { return f.factor == &factor; }) -
                            factors.begin());
  }

  bool ProjectedResiduals::has_columns(const LowRankFactor &factor) const
  {
    int n_terms = 0;
    for (const Term *term : low_rank)
      if (&factor == term->left.get() || &factor == term->right.get())
        {
          if (!term->weights.empty())
            return false;
          ++n_terms;
        }
    return factor.rank() > n_terms * r;
  }

  void ProjectedResiduals::find_blocks() const
  {
    blocks.clear();
    for (int s = 0; s < static_cast<int>(sparse.size()); ++s)
      blocks.push_back({s, -1, nullptr, true, true, r});
    for (const Term *term : low_rank)
      for (const bool transposed : {false, true})
        if (const LowRankFactor &factor = term->target(transposed); has_columns(factor))
          {
            const bool is_symmetric = term->left == term->right;
            if (!is_symmetric || !transposed)
              blocks.push_back({-1, number_of(factor), term, transposed || is_symmetric, !transposed, r});
          }
    for (int f = 0; f < static_cast<int>(factors.size()); ++f)
      if (!has_columns(*factors[f].factor))
        {
          Block block{-1, f, nullptr, false, false, factors[f].factor->rank()};
          for (const Term *term : low_rank)
            {
              block.in_left  = block.in_left || &term->target(true) == factors[f].factor;
              block.in_right = block.in_right || &term->target(false) == factors[f].factor;
            }
          blocks.push_back(block);
        }
    n_columns = 0;
    for (Block &block : blocks)
      {
        block.first = n_columns;
        n_columns += block.n;
      }
  }

  void ProjectedResiduals::prepare() const
  {
    if (is_prepared)
      return;
    find_blocks();
    // Columns of W from a low-rank factor F are F C, so that their products follow from Fᵀ S⁻¹ F
    const auto gram_of = [&](const Factor &f, const Factor &g) {
      return factor_gram.block(f.first, g.first, f.factor->rank(), g.factor->rank());
    };
    const auto times_coefficients = [&](const Block &block, const auto &rows) -> DenseMatrix {
      return block.term != nullptr ? DenseMatrix(rows * motions.at(&block.term->source(!block.in_right))) : DenseMatrix(rows);
    };

    // Scale every basis vector to unit S-norm, because these norms may differ by many orders of magnitude if bodies are light
    DenseMatrix H(r, n_columns);
    for (const Block &b : blocks)
      H.middleCols(b.first, b.n) =
        b.sparse >= 0 ? sparse[b.sparse].projected : times_coefficients(b, motions.at(factors[b.factor].factor).transpose());
    const Eigen::VectorXd scale = pencil.diagonal().cwiseSqrt().cwiseInverse();
    const RealLU          lu    = regular_lu(scale.asDiagonal() * pencil * scale.asDiagonal(), "stiffness of a reduced model");
    H                           = scale.asDiagonal() * H;
    is_prepared                 = true;
    if (sketch)
      {
        Z = DenseMatrix(2 * size_of_sketch, n_columns);
        for (const Block &b : blocks)
          Z.middleCols(b.first, b.n) = b.sparse >= 0 ?
                                         sparse[b.sparse].sketched :
                                         times_coefficients(b, factors[b.factor].factor->transpose_times(*sketch).transpose());
        Z -= sketched_pencil * scale.asDiagonal() * lu.solve(H);
        return;
      }

    // Wᵀ S⁻¹ W
    bracket = DenseMatrix(n_columns, n_columns);
    for (const Block &b : blocks)
      for (const Block &a : blocks)
        {
          if (a.first > b.first)
            break;
          const auto product = [&]() -> DenseMatrix {
            if (a.sparse >= 0 && b.sparse >= 0)
              return sparse[b.sparse].products[a.sparse];
            if (a.sparse >= 0 || b.sparse >= 0)
              {
                const Block      &of_factor = a.sparse >= 0 ? b : a;
                const Factor     &f         = factors[of_factor.factor];
                const auto        rows      = sparse[std::max(a.sparse, b.sparse)].factor_products.middleRows(f.first, f.factor->rank());
                const DenseMatrix columns   = times_coefficients(of_factor, rows.transpose());
                return a.sparse >= 0 ? columns : DenseMatrix(columns.transpose());
              }
            const DenseMatrix columns = times_coefficients(b, gram_of(factors[a.factor], factors[b.factor]));
            return times_coefficients(a, columns.transpose()).transpose();
          };
          bracket.block(a.first, b.first, a.n, b.n) = product();
          bracket.block(b.first, a.first, b.n, a.n) = bracket.block(a.first, b.first, a.n, b.n).transpose().eval();
        }
    bracket -= H.transpose() * lu.solve(H);
  }

  std::vector<ProjectedResiduals::Group> ProjectedResiduals::groups(const ParameterValues &values, const bool transposed) const
  {
    std::vector<Group> result;
    // Group blocks whose rows differ only by a factor; key: index of the low-rank factor applied to φ_r, or -1, and the power
    std::map<std::pair<int, int>, std::vector<std::pair<const Block *, double>>> alike;
    const auto add = [&](const Block &block, const double scale, const int reader, const int power) {
      if (scale != 0.)
        alike[{reader, power}].emplace_back(&block, scale);
    };
    const auto n_readers = [&](const LowRankFactor &factor) {
      return std::count_if(low_rank.begin(), low_rank.end(), [&](const Term *term) { return &term->source(transposed) == &factor; });
    };
    for (const Block &block : blocks)
      {
        if (!(transposed ? block.in_left : block.in_right))
          continue;
        if (block.sparse >= 0)
          {
            const Sparse &part = sparse[block.sparse];
            add(block, (transposed ? part.sign : 1.) * part.term->coefficient.at(values), -1, part.term->power);
            add(block, -part.sigma, -1, 0);
            continue;
          }
        if (block.term != nullptr)
          {
            add(block, block.term->coefficient.at(values), -1, block.term->power);
            continue;
          }
        Group own{{{&block, 1.}}, {}};
        for (const Term *term : low_rank)
          if (&term->target(transposed) == factors[block.factor].factor && !term->vanishes(values))
            {
              const LowRankFactor *source = &term->source(transposed);
              const double         scale  = term->coefficient.at(values);
              if (term->weights.empty() && n_readers(*source) > 1)
                add(block, scale, number_of(*source), term->power);
              else
                own.shares.push_back({scale, term->power, source, term->weights.empty() ? nullptr : term});
            }
        if (!own.shares.empty())
          result.push_back(std::move(own));
      }
    for (auto &[rows, blocks_of_rows] : alike)
      result.push_back({std::move(blocks_of_rows), {{1., rows.second, rows.first < 0 ? nullptr : factors[rows.first].factor, nullptr}}});
    return result;
  }

  std::vector<ComplexDenseMatrix> ProjectedResiduals::group_rows(const std::vector<Group>   &groups,
                                                                 const ParameterValues      &values,
                                                                 const std::vector<Complex> &lambda,
                                                                 const ComplexDenseMatrix   &vectors) const
  {
    std::map<const LowRankFactor *, ComplexDenseMatrix> moved;
    std::vector<ComplexDenseMatrix>                     result;
    for (const Group &group : groups)
      {
        ComplexDenseMatrix rows = ComplexDenseMatrix::Zero(group.blocks.front().first->n, vectors.cols());
        for (const Group::Share &share : group.shares)
          {
            if (share.motions != nullptr && moved[share.motions].size() == 0)
              moved[share.motions] = multiply(motions.at(share.motions), vectors);
            const ComplexDenseMatrix &X      = share.motions != nullptr ? moved[share.motions] : vectors;
            const Eigen::VectorXcd    factor = share.scale * powers(lambda, share.power);
            rows += (share.weighted != nullptr ? share.weighted->weighted(X, values) : X) * factor.asDiagonal();
          }
        result.push_back(std::move(rows));
      }
    return result;
  }

  DenseMatrix ProjectedResiduals::coefficients(const ParameterValues      &values,
                                               const std::vector<Complex> &lambda,
                                               const ComplexDenseMatrix   &vectors,
                                               const bool                  transposed) const
  {
    ComplexDenseMatrix                    result = ComplexDenseMatrix::Zero(n_columns, vectors.cols());
    const std::vector<Group>              found  = groups(values, transposed);
    const std::vector<ComplexDenseMatrix> rows   = group_rows(found, values, lambda, vectors);
    for (std::size_t g = 0; g < found.size(); ++g)
      for (const auto &[block, factor] : found[g].blocks)
        result.middleRows(block->first, block->n) += factor * rows[g];
    return halves(result);
  }

  DenseMatrix ProjectedResiduals::sketches(const ParameterValues      &values,
                                           const std::vector<Complex> &lambda,
                                           const ComplexDenseMatrix   &vectors,
                                           const bool                  transposed) const
  {
    DenseMatrix                           result = DenseMatrix::Zero(size_of_sketch, 2 * vectors.cols());
    const std::vector<Group>              found  = groups(values, transposed);
    const std::vector<ComplexDenseMatrix> rows   = group_rows(found, values, lambda, vectors);
    for (std::size_t g = 0; g < found.size(); ++g)
      {
        DenseMatrix sum = DenseMatrix::Zero(size_of_sketch, rows[g].rows());
        for (const auto &[block, factor] : found[g].blocks)
          sum += factor * Z.topRows(size_of_sketch).middleCols(block->first, block->n);
        result += sparing_zeros(halves(rows[g]), [&sum](const DenseMatrix &X) -> DenseMatrix { return sum * X; });
      }
    return result;
  }

  ResidualProducts ProjectedResiduals::products(const ParameterValues      &values,
                                                const std::vector<Complex> &lambda,
                                                const ComplexDenseMatrix   &right,
                                                const ComplexDenseMatrix   &left) const
  {
    prepare();
    if (sketch)
      {
        const DenseMatrix R = sketches(values, lambda, right, false), L = sketches(values, lambda, left, true);
        return {product_of_halves(L.transpose() * R), hermitian_products(R, R), hermitian_products(L, L)};
      }
    // Compute groups common to left and right residuals once
    const std::vector<Group> C = groups(values, false), D = groups(values, true);
    std::vector<Group>       all = C;
    std::vector<std::size_t> of_D;
    for (const Group &group : D)
      {
        const auto same = std::find_if(all.begin(), all.end(), [&group](const Group &other) { return other.blocks == group.blocks; });
        of_D.push_back(same - all.begin());
        if (same == all.end())
          all.push_back(group);
      }
    std::vector<Eigen::Index> first(1, 0);
    for (const Group &group : all)
      first.push_back(first.back() + group.blocks.front().first->n);
    std::vector<Eigen::Index> rows_of_D;
    for (const std::size_t g : of_D)
      for (Eigen::Index i = first[g]; i < first[g + 1]; ++i)
        rows_of_D.push_back(i);

    // Read only half of the symmetric bracket, once, because it is larger than the processor's cache
    DenseMatrix small(first.back(), first.back());
    for (std::size_t g = 0; g < all.size(); ++g)
      for (std::size_t h = 0; h <= g; ++h)
        {
          const auto &rows = all[g].blocks, &columns = all[h].blocks;
          DenseMatrix sum = DenseMatrix::Zero(first[g + 1] - first[g], first[h + 1] - first[h]);
          const auto  add = [&](const auto &x, const auto &y) {
            sum += x.second * y.second * bracket.block(x.first->first, y.first->first, x.first->n, y.first->n);
          };
          for (std::size_t x = 0; x < rows.size(); ++x)
            for (std::size_t y = 0; y < (g == h ? x : columns.size()); ++y)
              add(rows[x], columns[y]);
          if (g == h)
            {
              sum += sum.transpose().eval();
              for (const auto &x : rows)
                add(x, x);
            }
          small.block(first[g], first[h], sum.rows(), sum.cols()) = sum;
          if (g != h)
            small.block(first[h], first[g], sum.cols(), sum.rows()) = sum.transpose();
        }

    const auto stack = [&](const std::vector<Group> &some, const ComplexDenseMatrix &vectors) {
      DenseMatrix result(0, 2 * vectors.cols());
      for (const ComplexDenseMatrix &rows : group_rows(some, values, lambda, vectors))
        {
          result.conservativeResize(result.rows() + rows.rows(), Eigen::NoChange);
          result.bottomRows(rows.rows()) = halves(rows);
        }
      return result;
    };
    const auto apply = [](const DenseMatrix &A, const DenseMatrix &X) {
      return sparing_zeros(X, [&A](const DenseMatrix &Y) -> DenseMatrix { return A * Y; });
    };
    const DenseMatrix c = stack(C, right), d = stack(D, left), products = apply(small.leftCols(c.rows()), c);
    return {product_of_halves(d.transpose() * products(rows_of_D, Eigen::placeholders::all)),
            hermitian_products(c, products.topRows(c.rows())), hermitian_products(d, apply(small(rows_of_D, rows_of_D), d))};
  }

  DenseMatrix ProjectedResiduals::coordinates(const ModesAt &modes) const
  {
    // Scale the modes to unit strain energy; the basis is M-orthonormal
    const auto scaled = [&](const ComplexDenseMatrix &X) -> ComplexDenseMatrix {
      const Eigen::VectorXcd factors =
        (X.colwise().norm().transpose().array() * as_column(modes.lambda).array().abs()).inverse().matrix().cast<Complex>();
      return X * factors.asDiagonal();
    };
    DenseMatrix result(n_columns, 4 * modes.right.cols());
    result << coefficients(modes.values, modes.lambda, scaled(modes.right), false),
      coefficients(modes.values, modes.lambda, scaled(modes.left), true);
    std::vector<int> others;
    for (int j = 0; j < result.cols(); ++j)
      if (!(result.col(j).array() == 0.).all())
        others.push_back(j);
    return result(Eigen::placeholders::all, others);
  }

  std::optional<MultiVector> ProjectedResiduals::principal_responses(const ReducedModel         &model,
                                                                     const std::vector<ModesAt> &modes,
                                                                     const double                tolerance) const
  {
    prepare();
    DenseMatrix Y;
    for (const ModesAt &some : modes)
      if (!some.lambda.empty())
        Y = append_columns(Y, coordinates(some));
    if (Y.cols() == 0)
      return {};
    const DenseMatrix sketched = sketch ? DenseMatrix(Z.bottomRows(size_of_sketch) * Y) : DenseMatrix();
    const DenseMatrix energies = sketch ? DenseMatrix(sketched.transpose() * sketched) : DenseMatrix(Y.transpose() * bracket * Y);
    const auto [squares, axes] =
      agreed(inverse.map().communicator(), symmetric_eigenpairs(0.5 * (energies + energies.transpose()))); // ascending
    if (!(squares.back() > 0.))
      return {};
    const auto        first = std::upper_bound(squares.begin(), squares.end(), tolerance * tolerance * squares.back()) - squares.begin();
    const auto        kept  = static_cast<Eigen::Index>(squares.size()) - first;
    const DenseMatrix C     = Y * axes.rightCols(kept) * as_column(squares).tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
    MultiVector       WC(inverse.map(), static_cast<int>(kept));
    for (const Block &block : blocks)
      {
        const DenseMatrix rows = C.middleRows(block.first, block.n);
        if (block.sparse >= 0)
          WC += *sparse[block.sparse].term->matrix * (model.basis() * rows);
        else if (block.term != nullptr)
          WC += *factors[block.factor].factor * (motions.at(&block.term->source(!block.in_right)) * rows);
        else
          WC += *factors[block.factor].factor * rows;
      }
    return inverse.solve_frictionless(WC);
  }
} // namespace Squeal
