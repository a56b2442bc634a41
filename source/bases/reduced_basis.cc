#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/linear_algebra/replicate.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Largest max |T_rᵀ M_c T_r − I|.
    constexpr double largest_orthonormality_defect = 1e-10;
    /// M-norm of a rigid-body motion outside of given modes below which they contain it.
    constexpr double contained = 1e-6;

    const Decision connected("singular value of the gaps of component vectors / tolerance of their rank", 1.);

    std::string where(const BasisKind kind)
    {
      return "reduced basis `" + to_string(kind) + "`";
    }

    /// @p pointer, or an error that names what it should point to.
    template <typename Type>
    const Type &required(const Type *pointer, const BasisKind kind, const std::string &what, const std::string &change)
    {
      if (pointer == nullptr)
        throw SolverError("the basis needs " + what + ", which is missing or empty", where(kind), change);
      return *pointer;
    }

    const MultiVector &required_modes(const MultiVector *modes, const BasisKind kind, const BasisPart part)
    {
      return required(modes, kind, to_string(part), "compute these modes, up to a higher frequency if none was found");
    }

    /// Motions of a free disc outside of the span of its M-orthonormal modes; nothing if there is none.
    std::optional<MultiVector> missing_motions(const BasisIngredients &in, const MultiVector &modes)
    {
      const MultiVector *N = in.static_modes != nullptr ? in.static_modes->rigid_body_modes() : nullptr;
      if (N == nullptr)
        return {};
      return orthonormalize_if_any(*in.uncoupled->mass, &modes, *N, contained);
    }

    MultiVector part_vectors(const BasisPart part, const BasisKind kind, const BasisIngredients &in)
    {
      const auto statics = [&]() -> const StaticModes & {
        return required(in.static_modes, kind, "static modes of the bodies", "pass a StaticModes");
      };
      const auto coupled = [&]() -> const CoupledSystem & { return required(in.coupled, kind, "the coupled system", "pass it"); };
      const auto inverse = [&]() -> const UpdatedInverse & {
        return required(in.inverse, kind, "the inverse of the coupled stiffness", "pass an UpdatedInverse");
      };
      const auto real = [&]() -> const MultiVector & { return required_modes(in.real, kind, BasisPart::real); };
      switch (part)
        {
          case BasisPart::disc_free:
            return required_modes(in.disc_free, kind, part);
          case BasisPart::disc_sliding:
            return required_modes(in.disc_sliding, kind, part);
          case BasisPart::pins_free:
            return required_modes(in.pins_free, kind, part);
          case BasisPart::pins_sliding:
            return required_modes(in.pins_sliding, kind, part);
          case BasisPart::normal_attachment:
            return statics().normal_attachment();
          case BasisPart::normal_attachment_disc:
            return statics().normal_attachment(Component::disc);
          case BasisPart::tangential_attachment:
            return statics().tangential_attachment();
          case BasisPart::rubbing_attachment:
            return statics().rubbing_attachment(in.friction_coefficient);
          case BasisPart::constraint_disc:
            return statics().constraint(Component::disc);
          case BasisPart::constraint_pins:
            return statics().constraint(Component::pins);
          case BasisPart::real:
            return real();
          case BasisPart::coupled_tangential_attachment:
            return inverse().attachment_modes();
          case BasisPart::friction_right:
            return friction_response(coupled(), inverse(), real(), Side::right);
          case BasisPart::friction_left:
            return friction_response(coupled(), inverse(), real(), Side::left);
          case BasisPart::damping:
            return damping_response(coupled(), inverse(), real(), in.friction_coefficient);
          case BasisPart::snapshots:
            return required(in.snapshots, kind, "complex modes", "compute them at some friction coefficients");
          default:
            return required(in.residuals, kind, "vectors grown by residuals", "grow them first");
        }
    }

    /// T_r0: the parts side by side.
    MultiVector join_parts(const BasisKind kind, const BasisIngredients &in, BasisCounts &counts)
    {
      std::vector<MultiVector> parts;
      for (const BasisPart part : basis_parts(kind))
        {
          parts.push_back(part_vectors(part, kind, in));
          const int n = parts.back().NumVectors();
          switch (part)
            {
              case BasisPart::disc_free:
                counts.disc_free = n;
                if (const auto motions = missing_motions(in, parts.back()))
                  {
                    counts.rigid_body = motions->NumVectors();
                    parts.push_back(*motions);
                  }
                break;
              case BasisPart::disc_sliding:
                counts.disc_sliding = n;
                break;
              case BasisPart::pins_free:
                counts.pins_free = n;
                break;
              case BasisPart::pins_sliding:
                counts.pins_sliding = n;
                break;
              case BasisPart::real:
                counts.real = n;
                break;
              case BasisPart::snapshots:
                counts.snapshots = n;
                break;
              case BasisPart::residuals:
                counts.residuals = n;
                break;
              default:;
            }
        }
      std::vector<const MultiVector *> pointers;
      for (const MultiVector &part : parts)
        pointers.push_back(&part);
      return join(pointers);
    }

    /// Divides the columns by their M-norms; throws SolverError at a zero column.
    void scale_to_unit_norm(const SparseMatrix &M, const BasisKind kind, MultiVector &X)
    {
      std::vector<double> squares(X.NumVectors());
      X.Dot(M * X, squares.data());
      for (int j = 0; j < X.NumVectors(); ++j)
        {
          if (!(squares[j] > 0.))
            throw SolverError("column " + std::to_string(j) + " of T_r0 is zero or undefined", where(kind), "check the step that computed it");
          X(j)->Scale(1. / std::sqrt(squares[j]));
        }
    }

    double largest_entry(const MultiVector &X)
    {
      std::vector<double> norms(X.NumVectors());
      X.NormInf(norms.data());
      return *std::max_element(norms.begin(), norms.end());
    }

    /// T_r0 T_cr in coupled coordinates; the columns of T_r0 get scaled.
    MultiVector connect(MultiVector &T_r0, const BasisKind kind, const BasisIngredients &in, const double tolerance, ConnectionRank &connection)
    {
      const SparseMatrix &P_n = *in.contact->normal;
      scale_to_unit_norm(*in.uncoupled->mass, kind, T_r0);
      auto [values, V] = singular_values(replicate(P_n * T_r0));
      agree(T_r0.Comm(), V, values);

      const double largest = values.front();
      const int    n_r0    = T_r0.NumVectors();
      connection.rank      = std::count_if(values.begin(), values.end(), [&](const double value) {
        return connected.exceeded_by(value / largest / tolerance);
      });
      if (connection.rank == n_r0)
        throw SolverError("no combination of its " + std::to_string(n_r0) + " vectors keeps the contact closed", where(kind),
                          "take more component modes");
      connection.smallest_kept   = connection.rank > 0 ? values[connection.rank - 1] / largest : 0.;
      connection.largest_dropped = connection.rank < static_cast<int>(values.size()) ? values[connection.rank] / largest : 0.;

      const MultiVector u         = T_r0 * columns(V, connection.rank, n_r0 - connection.rank);
      connection.constraint_error = max_norm(replicate(P_n * u)) / largest_entry(u);
      return coordinates(*in.contact->kernel, u);
    }
  } // namespace

  std::vector<BasisPart> basis_parts(const BasisKind kind)
  {
    using Part = BasisPart;
    switch (kind)
      {
        case BasisKind::free:
          return {Part::disc_free, Part::pins_free, Part::normal_attachment};
        case BasisKind::fixed:
          return {Part::disc_sliding, Part::pins_sliding, Part::constraint_disc, Part::constraint_pins};
        case BasisKind::mixed:
          return {Part::disc_free, Part::pins_sliding, Part::normal_attachment_disc, Part::constraint_pins};
        case BasisKind::free_tangential:
          return {Part::disc_free, Part::pins_free, Part::normal_attachment, Part::tangential_attachment};
        case BasisKind::free_rubbing:
          return {Part::disc_free, Part::pins_free, Part::rubbing_attachment};
        case BasisKind::fixed_tangential:
          return {Part::disc_sliding, Part::pins_sliding, Part::constraint_disc, Part::constraint_pins, Part::tangential_attachment};
        case BasisKind::mixed_tangential:
          return {Part::disc_free, Part::pins_sliding, Part::normal_attachment_disc, Part::constraint_pins, Part::tangential_attachment};
        case BasisKind::real:
          return {Part::real};
        case BasisKind::real_tangential:
          return {Part::real, Part::coupled_tangential_attachment};
        case BasisKind::real_first_order:
          return {Part::real, Part::friction_right};
        case BasisKind::real_two_sided:
          return {Part::real, Part::friction_right, Part::friction_left};
        case BasisKind::real_two_sided_damped:
          return {Part::real, Part::friction_right, Part::friction_left, Part::damping};
        case BasisKind::pod:
          return {Part::snapshots};
        default:
          return {Part::residuals};
      }
  }

  std::string basis_columns(const BasisKind kind)
  {
    std::string text;
    for (const BasisPart part : basis_parts(kind))
      text += (text.empty() ? "" : " ") + to_string(part);
    return text;
  }

  bool is_connected(const BasisKind kind)
  {
    switch (basis_parts(kind).front())
      {
        case BasisPart::disc_free:
        case BasisPart::disc_sliding:
          return true;
        default:
          return false;
      }
  }

  bool needs_friction(const BasisKind kind)
  {
    return kind != BasisKind::free && kind != BasisKind::fixed && kind != BasisKind::mixed;
  }

  BasisSize nominal_size(const BasisKind kind, const BasisCounts &counts)
  {
    int n = 0;
    for (const BasisPart part : basis_parts(kind))
      switch (part)
        {
          case BasisPart::disc_free:
            n += counts.disc_free + counts.rigid_body;
            break;
          case BasisPart::disc_sliding:
            n += counts.disc_sliding;
            break;
          case BasisPart::pins_free:
            n += counts.pins_free;
            break;
          case BasisPart::pins_sliding:
            n += counts.pins_sliding;
            break;
          case BasisPart::real:
          case BasisPart::friction_right:
          case BasisPart::friction_left:
          case BasisPart::damping:
            n += counts.real;
            break;
          case BasisPart::snapshots:
            n += counts.snapshots;
            break;
          case BasisPart::residuals:
            n += counts.residuals;
            break;
          default:
            n += counts.contact;
        }
    return {n, is_connected(kind) ? n - counts.contact : n};
  }

  int ReducedBasis::size() const
  {
    return vectors->NumVectors();
  }

  ReducedBasis reduced_basis(const BasisKind kind, const BasisIngredients &in, const BasisOptions &options)
  {
    const SparseMatrix &M = *required(in.coupled, kind, "the coupled system", "pass it").mass;
    if (is_connected(kind))
      {
        required(in.uncoupled, kind, "the matrices of the bodies", "pass them");
        required(in.contact, kind, "the contact operators", "pass them");
        required(in.static_modes, kind, "static modes of the bodies", "pass a StaticModes");
      }

    // ------------------------------------------------- T_r0 and its nominal size
    BasisCounts counts;
    counts.contact      = in.coupled->n_contact();
    MultiVector     X   = join_parts(kind, in, counts);
    const BasisSize size = nominal_size(kind, counts);
    const int       n    = M.NumGlobalRows();
    if (size.n_r > n && kind != BasisKind::pod)
      throw SolverError("the basis has " + std::to_string(size.n_r) + " vectors, the coupled system only " + std::to_string(n) + " dofs",
                        where(kind), "take fewer component modes, or a finer mesh");

    ReducedBasis basis{to_string(kind), nullptr, size.n_r0, size.n_r, 0, options.tolerance, 1., 0., {}};

    // ------------------------------------------------- T_r
    std::optional<MultiVector> connected;
    if (is_connected(kind))
      connected.emplace(connect(X, kind, in, options.connection_tolerance, basis.connection));
    const MultiVector &T = connected ? *connected : X;
    PrincipalAxes      axes;
    if (kind == BasisKind::pod)
      {
        basis.tolerance   = options.pod_tolerance;
        const int maximum = options.pod_size > 0 ? options.pod_size : std::numeric_limits<int>::max();
        basis.vectors     = std::make_shared<MultiVector>(principal_axes(M, T, options.pod_tolerance, maximum, &axes));
      }
    else
      basis.vectors = std::make_shared<MultiVector>(orthonormalize(M, nullptr, T, options.tolerance, &axes));
    basis.condition      = axes.condition;
    basis.n_dropped      = T.NumVectors() - basis.size();
    basis.orthonormality = orthonormality_defect(M, *basis.vectors);
    if (!(basis.orthonormality <= largest_orthonormality_defect))
      throw SolverError("its vectors are not orthonormal: max |TᵀMT − I| = " + std::to_string(basis.orthonormality), where(kind),
                        "raise the tolerance of its rank");
    return basis;
  }
} // namespace Squeal
