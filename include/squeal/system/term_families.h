#pragma once

#include <squeal/system/terms.h>

#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// Terms that several systems have in common, the members of a family: they differ in coefficients only.
  struct TermFamily
  {
    std::vector<Term>            terms;   ///< with coefficients of one, or a scale where members differ
    ParameterValues              values;  ///< of the scales in the middle of the family: ones
    std::vector<ParameterValues> members; ///< of the scales, for each member
  };

  /**
   * The terms Σ θ_k A_k of a family with as few matrices as possible: those whose coefficients θ_k keep their ratios from member to
   * member are summed, with the means of θ_k over the members. All terms must be sparse.
   *
   * @param members values of the parameters of the terms for each member, of one at least
   */
  TermFamily term_family(const std::vector<Term> &terms, const std::vector<ParameterValues> &members);

  /// A term of a member as a sum of terms of its family: their numbers and factors.
  using TermShares = std::vector<std::pair<std::size_t, double>>;
} // namespace Squeal
