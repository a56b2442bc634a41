// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/contact/imported_system.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/multivector.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// True for friction terms that UpdatedInverse can include by a low-rank update of its factor.
    bool is_low_rank_friction(const Term &term, const std::string &varied, const ParameterValues &values)
    {
      if (term.kind != TermKind::friction || term.matrix || !term.weights.empty() || varied != SystemParameter::friction)
        return false;
      ParameterValues others = values;
      const auto      at     = [&](const double mu) {
        others.at(varied) = {mu};
        return term.coefficient.at(others);
      };
      return at(0.) == 0. && at(2.) == 2. * at(1.);
    }

    /// L diag(d) Rᵀ as sparse terms.
    std::vector<Term> multiplied_out(const Term &term, const ParameterValues &values)
    {
      Term plain          = term;
      plain.coefficient   = {};
      const auto matrices = sparse_matrices({plain}, values);
      Term       result   = term;
      result.matrix       = term.power == 0 ? matrices.stiffness : term.power == 1 ? matrices.damping : matrices.mass;
      result.left = result.right = nullptr;
      result.weights.clear();
      return result.matrix ? split_by_symmetry(result) : std::vector<Term>();
    }

    /// Inverse square roots of the diagonal of K + ω² M, rounded to powers of two, for the rows of this process.
    std::vector<double> dof_scales(const SparseMatrix &K, const SparseMatrix &M, const double omega)
    {
      std::vector<double> result(K.rows().n_local());
      SparseMatrix::Row   row;
      for (int i = 0; i < K.rows().n_local(); ++i)
        {
          double diagonal = 0., largest = 0.;
          for (const auto &[A, factor] : {std::make_pair(&K, 1.), {&M, omega * omega}})
            {
              A->get_row(i, row);
              for (const auto &[column, value] : row)
                {
                  largest = std::max(largest, factor * std::abs(value));
                  diagonal += column == A->rows().number(i) ? factor * value : 0.;
                }
            }
          const double size = diagonal > 0. ? diagonal : largest > 0. ? largest : 1.;
          result[i]         = std::exp2(-std::round(0.5 * std::log2(size)));
        }
      return result;
    }

    /// Sets mass and stiffness from the symmetric frictionless terms; both are null if either has no such term.
    void set_symmetric_parts(CoupledSystem &system)
    {
      const auto has_part = [&](const int power) {
        return std::any_of(system.terms.begin(), system.terms.end(),
                           [power](const Term &term) { return term.matrix && term.is_frictionless() && term.power == power; });
      };
      if (has_part(0) && has_part(2))
        set_frictionless_matrices(system);
      else
        system.mass = system.stiffness = nullptr;
    }
  } // namespace

  CoupledSystem imported_system(const SystemFile      &file,
                                const ParameterValues &values,
                                const std::string     &varied,
                                const double           largest_circular_frequency)
  {
    CoupledSystem result;
    result.values = values;
    result.varied = varied;
    for (const Term &term : file.terms)
      if (term.matrix)
        result.terms.push_back(term);
      else if (is_low_rank_friction(term, varied, values) && (!result.friction_forces || result.friction_forces == term.left))
        {
          result.terms.push_back(term);
          result.friction_forces   = term.left;
          result.values.at(varied) = {0.};
        }
      else if (term.power == 1 && term.left == term.right)
        result.terms.push_back(term);
      else
        for (Term &part : multiplied_out(term, values))
          result.terms.push_back(std::move(part));
    set_symmetric_parts(result);

    const RowMap           &map       = file.map;
    const bool              has_parts = result.stiffness && max_norm(*result.stiffness) > 0. && max_norm(*result.mass) > 0.;
    const SecondOrderSystem whole     = has_parts ? SecondOrderSystem() : sparse_matrices(result.terms, values);
    const auto             &M = has_parts ? result.mass : whole.mass, &K = has_parts ? result.stiffness : whole.stiffness;
    for (const auto &[matrix, name] : {std::make_pair(&M, "mass"), {&K, "stiffness"}})
      if (!*matrix)
        throw ParameterError(std::string("all ") + name + " terms are missing or zero at the values of the parameters", "file " + file.path,
                             "give terms of power 0 (stiffness) and 2 (mass) that are nonzero at these values");
    const std::vector<double> d = dof_scales(*K, *M, largest_circular_frequency);
    const auto                D =
      std::make_shared<SparseMatrix>(map, map, [&](const int i, SparseMatrix::Row &row) { row.emplace_back(map.number(i), d[i]); });
    std::map<const LowRankFactor *, std::shared_ptr<const LowRankFactor>> scaled;
    const auto scaled_factor = [&](const std::shared_ptr<const LowRankFactor> &factor) {
      auto &entry = scaled[factor.get()];
      if (factor && !entry)
        entry = std::make_shared<LowRankFactor>(multiply(*factor->sparse_transpose(), *D));
      return entry;
    };
    for (Term &term : result.terms)
      {
        if (term.matrix)
          term.matrix = multiply(*multiply(*D, *term.matrix), *D);
        term.left  = scaled_factor(term.left);
        term.right = scaled_factor(term.right);
      }
    result.friction_forces = result.friction_forces ? scaled_factor(result.friction_forces) :
                                                      std::make_shared<LowRankFactor>(std::make_shared<SparseMatrix>(
                                                        RowMap::even(0, map.communicator()), map, [](int, SparseMatrix::Row &) {}));
    result.kernel          = D;
    set_symmetric_parts(result);
    const auto is_definite = [&] { return result.stiffness && definite_shift(result, largest_circular_frequency); };
    if (!is_definite())
      {
        for (Term &term : result.terms)
          if (term.kind == TermKind::circulatory)
            term.kind = TermKind::friction;
        set_symmetric_parts(result);
        if (!is_definite())
          result.mass = result.stiffness = nullptr;
      }
    return result;
  }

  std::optional<double> definite_shift(const CoupledSystem &system, const double largest_circular_frequency)
  {
    constexpr double part_of_band = 0.02;
    const auto       is_definite  = [&](const double square) {
      int n_null = 0;
      return count_negative_eigenvalues(square == 0. ? *system.stiffness : *add(1., *system.stiffness, square, *system.mass),
                                        "symmetric part of the stiffness", &n_null) +
               n_null ==
             0;
    };
    if (is_definite(0.))
      return 0.;
    const double shift = part_of_band * largest_circular_frequency;
    // Negative eigenvalues within this limit are rounding errors of rigid-body motions; negative eigenvalues of larger magnitude are
    // growing motions, which a shift must not hide
    return is_definite(std::min(shift * shift, system.hidden_square)) && is_definite(shift * shift) ? std::optional(shift) : std::nullopt;
  }
} // namespace Squeal
