// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/multivector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Upper limit of max |T_rᵀ M_c T_r − I| [-].
    constexpr double largest_orthonormality_defect = 1e-10;
    /// Modes contain a rigid-body motion if its component M-orthogonal to the modes has an M-norm below this limit [-].
    constexpr double contained = 1e-6;

    std::string where(const BasisRecipe &recipe)
    {
      return std::string("reduced basis `") + recipe.name + "`";
    }

    /// Dereferences @p pointer; throws a SolverError that names the missing object if it is null.
    template <typename Type>
    const Type &required(const Type *pointer, const BasisRecipe &recipe, const std::string &what)
    {
      if (pointer == nullptr)
        throw SolverError("the basis needs " + what + ", which is missing or empty", where(recipe),
                          "compute it beforehand; if no modes were found, include modes up to a higher frequency");
      return *pointer;
    }

    MultiVector join_parts(const BasisRecipe &recipe, const BasisIngredients &in, BasisCounts &counts)
    {
      std::vector<MultiVector> sets;
      for (const BasisPart *part : recipe.parts)
        {
          if (part->compute && !part->is_uncoupled)
            required(in.inverse, recipe, "the factor of the coupled stiffness");
          sets.push_back(part->compute ? part->compute(in) : required(in.set(*part->set), recipe, part->symbol));
          if (part->set)
            counts.sets[*part->set] = sets.back().n_columns();
          // Add rigid-body motions of a free disc that are not among its modes
          const MultiVector *N =
            part->set == BasisSource::disc_free && in.static_modes != nullptr ? in.static_modes->response.rigid_body_modes() : nullptr;
          if (N == nullptr)
            continue;
          if (const auto motions = orthonormalize_if_any(*in.uncoupled->mass, &sets.back(), *N, contained))
            {
              counts.rigid_body = motions->n_columns();
              sets.push_back(*motions);
            }
        }
      return join_all(sets);
    }

    /// Divides the columns by their M-norms; throws SolverError at a zero column.
    void scale_to_unit_norm(const SparseMatrix &M, const BasisRecipe &recipe, MultiVector &X)
    {
      const std::vector<double> squares = column_products(X, M * X);
      for (int j = 0; j < X.n_columns(); ++j)
        {
          if (!(squares[j] > 0.))
            throw SolverError("column " + std::to_string(j) + " of T_r0 is zero or undefined", where(recipe),
                              "check the computation of this column");
          X.col(j) /= std::sqrt(squares[j]);
        }
    }

    double largest_entry(const MultiVector &X)
    {
      return largest_of_processes(X.communicator(), max_norm(X.local()));
    }

    /// T_r0 T_cr in coupled coordinates; scales the columns of T_r0.
    MultiVector connect(MultiVector            &T_r0,
                        const BasisRecipe      &recipe,
                        const BasisIngredients &in,
                        const double            tolerance,
                        ConnectionRank         &connection)
    {
      const SparseMatrix &P_n = *in.contact->normal;
      scale_to_unit_norm(*in.uncoupled->mass, recipe, T_r0);
      const SingularValues axes = singular_values(replicate(P_n * T_r0));
      const auto [values, V]    = agreed(T_r0.communicator(), {axes.values, axes.right});

      const double largest = values.front();
      const int    n_r0    = T_r0.n_columns();
      connection.rank = std::count_if(values.begin(), values.end(), [&](const double value) { return value / largest / tolerance > 1.; });
      if (connection.rank == n_r0)
        throw SolverError("no combination of the " + std::to_string(n_r0) + " vectors of T_r0 keeps the contact closed", where(recipe),
                          "use more component modes");
      connection.smallest_kept   = connection.rank > 0 ? values[connection.rank - 1] / largest : 0.;
      connection.largest_dropped = connection.rank < static_cast<int>(values.size()) ? values[connection.rank] / largest : 0.;

      const MultiVector u         = T_r0 * V.rightCols(n_r0 - connection.rank);
      connection.constraint_error = max_norm(replicate(P_n * u)) / largest_entry(u);
      return coordinates(*in.contact->kernel, u);
    }
  } // namespace

  BasisSize nominal_size(const BasisRecipe &recipe, const BasisCounts &counts)
  {
    int n = 0;
    for (const BasisPart *part : recipe.parts)
      n += (part->set ? counts.sets.at(*part->set) : counts.contact) + (part->set == BasisSource::disc_free ? counts.rigid_body : 0);
    return {n, recipe.is_connected() ? n - counts.contact : n};
  }

  ReducedBasis reduced_basis(const BasisRecipe &recipe, const BasisIngredients &in, const BasisOptions &options)
  {
    const SparseMatrix &M = *required(in.coupled, recipe, "the coupled system").mass;
    if (recipe.is_connected())
      {
        required(in.uncoupled, recipe, "the system of the bodies");
        required(in.contact, recipe, "the set of contact operators");
        required(in.static_modes, recipe, "the static modes of the bodies");
      }

    // ------------------------------------------------- T_r0 and its nominal size
    BasisCounts counts;
    counts.contact       = in.coupled->n_contact();
    MultiVector     X    = join_parts(recipe, in, counts);
    const BasisSize size = nominal_size(recipe, counts);
    const int       n    = M.n_rows();
    if (size.n_r > n && recipe.is_connected())
      throw SolverError("the basis has " + std::to_string(size.n_r) + " vectors, but the coupled system has only " + std::to_string(n) +
                          " dofs",
                        where(recipe), "use fewer component modes, or a finer mesh");

    ReducedBasis basis{nullptr, size.n_r0, size.n_r, 0, options.tolerance, 1., 0., {}};

    // ------------------------------------------------- T_r
    std::optional<MultiVector> connected;
    if (recipe.is_connected())
      connected.emplace(connect(X, recipe, in, options.connection_tolerance, basis.connection));
    const MultiVector &T = connected ? *connected : X;
    PrincipalAxes      axes;
    if (recipe.is_pod)
      {
        basis.tolerance   = options.pod_tolerance;
        const int maximum = options.pod_size > 0 ? options.pod_size : std::numeric_limits<int>::max();
        basis.vectors     = std::make_shared<MultiVector>(principal_axes(M, T, options.pod_tolerance, maximum, &axes));
      }
    else
      basis.vectors = std::make_shared<MultiVector>(orthonormalize(M, nullptr, T, options.tolerance, &axes));
    basis.condition      = axes.condition;
    basis.n_dropped      = T.n_columns() - basis.size();
    basis.orthonormality = orthonormality_defect(M, *basis.vectors);
    if (!(basis.orthonormality <= largest_orthonormality_defect))
      throw SolverError(text("the vectors are not orthonormal: max |TᵀMT − I| = ", basis.orthonormality), where(recipe),
                        "raise the rank tolerance");
    return basis;
  }
} // namespace Squeal
