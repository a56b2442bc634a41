// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/terms.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Terms with the first power of λ: 2 a b² S with S symmetric, −3 a G with G skew, and low-rank terms Lᵀ R with and without weights. The
  /// last term has the second power.
  struct Terms
  {
    RowMap                               map = rows(4), short_map = rows(2);
    std::shared_ptr<const SparseMatrix>  S    = sparse(map, map, [](const int i) { return Row{{i, 1. + i}, {3 - i, 0.5}}; });
    std::shared_ptr<const SparseMatrix>  G    = sparse(map, map, [](const int i) {
      return i < 2 ? Row{{i + 2, 1.5 - i}} : Row{{i - 2, i - 3.5}};
    });
    std::shared_ptr<const SparseMatrix>  L    = sparse(short_map, map, [](const int i) { return Row{{i, 2.}, {3, -1.}}; });
    std::shared_ptr<const SparseMatrix>  R    = sparse(short_map, map, [](const int i) { return Row{{2 - i, 1.}, {3, 0.3}}; });
    std::shared_ptr<const LowRankFactor> left = std::make_shared<LowRankFactor>(L), right = std::make_shared<LowRankFactor>(R);
    ParameterValues                      values = {{"a", {0.7}}, {"b", {1.3}}, {"d", {4., -2.}}};
    std::vector<Term>                    terms  = {sparse_term("symmetric", 1, {2., {{"a", 1}, {"b", 2}}}, S),
                                                   sparse_term("skew", 1, {-3., {{"a", 1}}}, G, Symmetry::skew),
                                                   low_rank_term("of low rank", 1, {}, left, right), low_rank_term("weighted", 1, {0.5, {}}, left, right, "d"),
                                                   sparse_term("of another power", 2, {}, S)};

    /// Expected sum of the terms with the first power of λ.
    DenseMatrix expected() const
    {
      DenseMatrix weighted = to_dense(*R);
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 2; ++i)
          weighted(i, j) *= 1. + 0.5 * values.at("d")[i];
      const DenseMatrix result = to_dense(*L).transpose() * weighted;
      return result + 2. * 0.7 * 1.3 * 1.3 * to_dense(*S) - 3. * 0.7 * to_dense(*G);
    }
  };

  double deviation(const DenseMatrix &A, const DenseMatrix &B)
  {
    return max_norm(A - B) / max_norm(B);
  }
} // namespace

TEST(Terms, SumOnVectorsAndAsASparseMatrix)
{
  Terms      t;
  const auto matrices = sparse_matrices(t.terms, t.values);
  EXPECT_LT(deviation(replicate(times(t.terms, t.values, 1, unit_vectors(t.map))), t.expected()), 1e-15);
  EXPECT_LT(deviation(replicate(times(t.terms, t.values, 1, unit_vectors(t.map), true)), t.expected().transpose()), 1e-15);
  EXPECT_LT(deviation(to_dense(*matrices.damping), t.expected()), 1e-15);
  EXPECT_EQ(matrices.mass, t.S); // unchanged matrices are not copied
  EXPECT_EQ(matrices.stiffness, nullptr);

  t.terms.push_back(low_rank_term("full columns", 1, {}, std::make_shared<LowRankFactor>(unit_vectors(t.map)),
                                  std::make_shared<LowRankFactor>(unit_vectors(t.map))));
  EXPECT_THROW(sparse_matrices(t.terms, t.values), SolverError);
}

TEST(Terms, VanishWithTheirParametersOrWeights)
{
  Terms      t;
  const auto names = [&t] {
    std::string result;
    for (const Term *term : terms_of(t.terms, t.values, 1))
      result += term->name + ", ";
    return result;
  };
  EXPECT_EQ(names(), "symmetric, skew, of low rank, weighted, ");
  t.values["d"] = {0., 0.};
  t.values["b"] = {0.};
  EXPECT_EQ(names(), "skew, of low rank, ");
  t.values["d"] = {}; // an empty list means zeros
  t.values["a"] = {0.};
  EXPECT_EQ(names(), "of low rank, ");
}

TEST(Terms, FamilyRepresentsMembersOfOppositeSign)
{
  Terms             t;
  std::vector<Term> sparse_terms;
  for (const Term &term : t.terms)
    if (term.matrix)
      sparse_terms.push_back(term);
  const std::vector<ParameterValues> members = {{{"a", {0.7}}, {"b", {1.3}}}, {{"a", {-0.7}}, {"b", {2.}}}};
  const TermFamily                   family  = term_family(sparse_terms, members);
  for (std::size_t m = 0; m < members.size(); ++m)
    {
      ParameterValues values = family.values;
      for (const auto &[name, value] : family.members[m])
        values[name] = value;
      const auto actual = sparse_matrices(family.terms, values), expected = sparse_matrices(sparse_terms, members[m]);
      EXPECT_LT(deviation(to_dense(*actual.damping), to_dense(*expected.damping)), 1e-15);
      EXPECT_LT(deviation(to_dense(*actual.mass), to_dense(*expected.mass)), 1e-15);
    }
}
