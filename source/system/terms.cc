// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/terms.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Matrix = std::shared_ptr<const SparseMatrix>;

    Matrix product(const Term &term, const ParameterValues &values)
    {
      const SparseMatrix &R = *term.right->sparse_transpose(), &L = *term.left->sparse_transpose();
      if (term.weights.empty())
        return multiply(L, R, true, false);
      const std::vector<double> &d = values.at(term.weights);
      return multiply(L, *scale_rows(R, [&d](const int i) { return d[i]; }), true, false);
    }

  } // namespace

  Matrix sum(const std::vector<std::pair<double, Matrix>> &summands)
  {
    if (summands.empty())
      return nullptr;
    // Share a single unscaled matrix instead of copying it
    if (summands.size() == 1 && summands.front().first == 1.)
      return summands.front().second;
    std::vector<std::pair<double, const SparseMatrix *>> parts;
    for (const auto &[factor, matrix] : summands)
      parts.emplace_back(factor, matrix.get());
    return linear_combination(parts);
  }

  namespace
  {
    class Monomial : public ParameterFunction
    {
    public:
      Monomial(const double factor, std::map<std::string, int> powers)
        : factor(factor)
        , powers(std::move(powers))
      {}

      double at(const ParameterValues &values) const override
      {
        double result = factor;
        for (const auto &[parameter, power] : powers)
          result *= std::pow(values.at(parameter).front(), power);
        return result;
      }

      double derivative(const std::string &parameter, const ParameterValues &values) const override
      {
        double result = contains(parameter) ? factor : 0.;
        for (const auto &[other, power] : powers)
          {
            const double value = values.at(other).front();
            result *= other == parameter ? power * std::pow(value, power - 1) : std::pow(value, power);
          }
        return result;
      }

      bool contains(const std::string &parameter) const override
      {
        return powers.count(parameter) > 0;
      }

      bool is_constant() const override
      {
        return powers.empty();
      }

      std::string text() const override
      {
        std::string result = exact_text(factor);
        for (const auto &[parameter, power] : powers)
          result += (power < 0 ? "/" : "*") + parameter + (std::abs(power) == 1 ? "" : "^" + std::to_string(std::abs(power)));
        return result;
      }

      Monomial operator*(const Monomial &other) const
      {
        std::map<std::string, int> sums = powers;
        for (const auto &[parameter, power] : other.powers)
          if ((sums[parameter] += power) == 0)
            sums.erase(parameter);
        return {factor * other.factor, sums};
      }

    private:
      const double                     factor;
      const std::map<std::string, int> powers;
    };

    class Product : public ParameterFunction
    {
    public:
      Product(std::shared_ptr<const ParameterFunction> a, std::shared_ptr<const ParameterFunction> b)
        : a(std::move(a))
        , b(std::move(b))
      {}

      double at(const ParameterValues &values) const override
      {
        return a->at(values) * b->at(values);
      }

      double derivative(const std::string &parameter, const ParameterValues &values) const override
      {
        return a->derivative(parameter, values) * b->at(values) + a->at(values) * b->derivative(parameter, values);
      }

      bool contains(const std::string &parameter) const override
      {
        return a->contains(parameter) || b->contains(parameter);
      }

      bool is_constant() const override
      {
        return a->is_constant() && b->is_constant();
      }

      std::string text() const override
      {
        return a->is_constant() && a->at({}) == 1. ? b->text() :
               b->is_constant() && b->at({}) == 1. ? a->text() :
                                                     a->text() + "*(" + b->text() + ")";
      }

    private:
      const std::shared_ptr<const ParameterFunction> a, b;
    };
  } // namespace

  Coefficient::Coefficient(const double factor, std::map<std::string, int> powers)
    : function(std::make_shared<Monomial>(factor, std::move(powers)))
  {}

  Coefficient::Coefficient(std::shared_ptr<const ParameterFunction> function)
    : function(std::move(function))
  {}

  double Coefficient::at(const ParameterValues &values) const
  {
    return function->at(values);
  }

  double Coefficient::derivative(const std::string &parameter, const ParameterValues &values) const
  {
    return function->derivative(parameter, values);
  }

  bool Coefficient::contains(const std::string &parameter) const
  {
    return function->contains(parameter);
  }

  bool Coefficient::is_constant() const
  {
    return function->is_constant();
  }

  std::string Coefficient::text() const
  {
    return function->text();
  }

  Coefficient operator*(const Coefficient &a, const Coefficient &b)
  {
    const auto *first = dynamic_cast<const Monomial *>(a.function.get()), *second = dynamic_cast<const Monomial *>(b.function.get());
    if (first != nullptr && second != nullptr)
      return Coefficient(std::make_shared<Monomial>(*first * *second));
    return Coefficient(std::make_shared<Product>(a.function, b.function));
  }

  bool Term::vanishes(const ParameterValues &values) const
  {
    if (coefficient.at(values) == 0.)
      return true;
    if (weights.empty())
      return false;
    const std::vector<double> &d = values.at(weights);
    return std::all_of(d.begin(), d.end(), [](const double x) { return x == 0.; });
  }

  bool Term::is_sparse() const
  {
    return matrix || (left->sparse_transpose() != nullptr && right->sparse_transpose() != nullptr);
  }

  Term sparse_term(std::string name, const int power, Coefficient coefficient, Matrix matrix, const Symmetry symmetry, const TermKind kind)
  {
    return {std::move(name), power, std::move(coefficient), std::move(matrix), symmetry, {}, {}, "", kind};
  }

  Term low_rank_term(std::string                          name,
                     const int                            power,
                     Coefficient                          coefficient,
                     std::shared_ptr<const LowRankFactor> left,
                     std::shared_ptr<const LowRankFactor> right,
                     std::string                          weights,
                     const TermKind                       kind)
  {
    return {std::move(name),    power, std::move(coefficient), {}, Symmetry::symmetric, std::move(left), std::move(right),
            std::move(weights), kind};
  }

  std::vector<Term> split_by_symmetry(const Term &term)
  {
    constexpr double  rounding  = 1e-15;
    const auto        transpose = Squeal::transpose(*term.matrix);
    const double      size      = max_norm(*term.matrix);
    std::vector<Term> result;
    for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::skew})
      {
        const Matrix part = add(0.5, *term.matrix, symmetry == Symmetry::skew ? -0.5 : 0.5, *transpose);
        if (max_norm(*part) <= rounding * size)
          continue;
        result.push_back(term);
        result.back().matrix   = part;
        result.back().symmetry = symmetry;
      }
    if (result.size() == 2)
      {
        result[0].name += ", symmetric part";
        result[1].name += ", skew part";
      }
    return result;
  }

  std::vector<const Term *> terms_of(const std::vector<Term> &terms, const ParameterValues &values, const int power)
  {
    std::vector<const Term *> result;
    for (const Term &term : terms)
      if (term.power == power && !term.vanishes(values))
        result.push_back(&term);
    return result;
  }

  MultiVector times(const std::vector<Term> &terms,
                    const ParameterValues   &values,
                    const int                power,
                    const MultiVector       &X,
                    const bool               transposed)
  {
    MultiVector                                                result(X.map(), X.n_columns());
    std::vector<std::pair<const LowRankFactor *, DenseMatrix>> onto; // Y summed over the terms of each target factor
    for (const Term *term : terms_of(terms, values, power))
      {
        const double theta = term->coefficient.at(values);
        if (term->matrix)
          result.local() += (transposed && term->symmetry == Symmetry::skew ? -theta : theta) * (*term->matrix * X).local();
        else
          {
            const DenseMatrix    Y      = term->weighted(term->source(transposed).transpose_times(X), values);
            const LowRankFactor *target = &term->target(transposed);
            auto found = std::find_if(onto.begin(), onto.end(), [target](const auto &entry) { return entry.first == target; });
            if (found == onto.end())
              found = onto.insert(found, {target, DenseMatrix::Zero(Y.rows(), Y.cols())});
            found->second += theta * Y;
          }
      }
    for (const auto &[factor, Y] : onto)
      result += *factor * Y;
    return result;
  }

  namespace
  {
    /// A as a sparse matrix, even if it has low rank.
    Matrix sparse_form(const Term &term, const ParameterValues &values)
    {
      if (!term.is_sparse())
        throw SolverError("the term `" + term.name + "` has no sparse matrix", "system matrices",
                          "choose a solver that applies such terms as products, or remove the term");
      return term.matrix ? term.matrix : product(term, values);
    }
  } // namespace

  double norm_bound(const std::vector<Term> &terms, const ParameterValues &values, const int power)
  {
    double result = 0.;
    for (const Term *term : terms_of(terms, values, power))
      result += std::abs(term->coefficient.at(values)) * row_sum_norm(*sparse_form(*term, values));
    return result;
  }

  SecondOrderSystem sparse_matrices(const std::vector<Term> &terms, const ParameterValues &values)
  {
    std::array<Matrix, 3> matrices;
    for (int power = 0; power < 3; ++power)
      {
        std::vector<std::pair<double, Matrix>> summands;
        for (const Term *term : terms_of(terms, values, power))
          summands.emplace_back(term->coefficient.at(values), sparse_form(*term, values));
        matrices[power] = sum(summands);
      }
    return {matrices[2], matrices[1], matrices[0]};
  }

  std::vector<Term> merged(const std::vector<Term> &terms, const ParameterValues &values)
  {
    const std::array<std::array<const char *, 3>, 2> names = {
      {{{"stiffness of the bodies", "damping of the bodies", "mass of the bodies"}},
       {{"skew stiffness of the bodies", "gyroscopic forces", "skew mass of the bodies"}}}};
    std::vector<Term> result;
    for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::skew})
      for (int power = 0; power < 3; ++power)
        {
          std::vector<std::pair<double, Matrix>> summands;
          for (const Term *term : terms_of(terms, values, power))
            if (term->symmetry == symmetry)
              summands.emplace_back(term->coefficient.at(values), term->matrix);
          if (const Matrix matrix = sum(summands))
            result.push_back(sparse_term(names[symmetry == Symmetry::skew][power], power, {}, matrix, symmetry,
                                         symmetry == Symmetry::skew ? TermKind::rotation : TermKind::body));
        }
    return result;
  }

  LowRankFactor::LowRankFactor(std::shared_ptr<const SparseMatrix> transpose)
    : rows(std::move(transpose))
  {}

  LowRankFactor::LowRankFactor(MultiVector columns)
    : full(std::make_shared<MultiVector>(std::move(columns)))
  {}

  int LowRankFactor::rank() const
  {
    return rows ? rows->n_rows() : full->n_columns();
  }

  DenseMatrix LowRankFactor::transpose_times(const MultiVector &X) const
  {
    return rows ? replicate(*rows * X) : gram(*full, X);
  }

  MultiVector LowRankFactor::operator*(const DenseMatrix &Y) const
  {
    return rows ? Squeal::transpose_times(*rows, distribute(Y, rows->rows())) : *full * Y;
  }

  MultiVector LowRankFactor::columns(const int first, const int n) const
  {
    if (full)
      return MultiVector(view(*full, first, n));
    return *this * DenseMatrix(DenseMatrix::Identity(rank(), rank()).middleCols(first, n));
  }

  const std::shared_ptr<const SparseMatrix> &LowRankFactor::sparse_transpose() const
  {
    return rows;
  }

  namespace
  {
    /// Relative difference below which scales count as equal [-].
    constexpr double same_scale = 1e-13;

    /// Terms of the same power and symmetry whose coefficients have the same ratios to their means.
    struct Group
    {
      const Term                                                         *first;
      std::vector<double>                                                 scales; ///< ratio for each member
      std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> summands;
    };

    bool agree(const std::vector<double> &x, const std::vector<double> &y)
    {
      return std::equal(x.begin(), x.end(), y.begin(), [](const double a, const double b) { return std::abs(a - b) <= same_scale; });
    }
  } // namespace

  TermFamily term_family(const std::vector<Term> &terms, const std::vector<ParameterValues> &members)
  {
    std::vector<Group> groups;
    for (const Term &term : terms)
      {
        std::vector<double> coefficients;
        double              mean = 0.; // of absolute values, because coefficients may have different signs
        for (const ParameterValues &values : members)
          {
            coefficients.push_back(term.coefficient.at(values));
            mean += std::abs(coefficients.back()) / static_cast<double>(members.size());
          }
        if (mean == 0.)
          continue;
        for (double &x : coefficients)
          x /= mean;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group &other) {
          return other.first->power == term.power && other.first->symmetry == term.symmetry && agree(other.scales, coefficients);
        });
        if (group == groups.end())
          group = groups.insert(group, {&term, coefficients, {}});
        group->summands.emplace_back(mean, term.matrix);
      }

    TermFamily result{{}, {}, std::vector<ParameterValues>(members.size())};
    for (const Group &group : groups)
      {
        Coefficient coefficient;
        if (!agree(group.scales, std::vector<double>(members.size(), 1.)))
          {
            const std::string scale = "scale of " + group.first->name;
            coefficient             = Coefficient(1., {{scale, 1}});
            result.values[scale]    = {1.};
            for (std::size_t m = 0; m < members.size(); ++m)
              result.members[m][scale] = {group.scales[m]};
          }
        result.terms.push_back(
          sparse_term(group.first->name, group.first->power, coefficient, sum(group.summands), group.first->symmetry, group.first->kind));
      }
    return result;
  }
} // namespace Squeal
