#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/reduced_model.h>

namespace Squeal
{
  namespace
  {
    /// diag(c) X
    DenseMatrix rows_scaled(DenseMatrix X, const std::vector<double> &c)
    {
      for (int j = 0; j < X.n_columns(); ++j)
        for (int i = 0; i < X.n_rows(); ++i)
          X(i, j) *= c[i];
      return X;
    }
  } // namespace

  ReducedModel::ReducedModel(const CoupledSystem &system)
    : system(&system)
  {}

  void ReducedModel::extend(const MultiVector &vectors)
  {
    T = std::make_unique<MultiVector>(T ? join({T.get(), &vectors}) : vectors);
    border(parts.mass, gram(*T, *system->frictionless.mass * vectors));
    border(parts.stiffness, gram(*T, *system->frictionless.stiffness * vectors));
    if (system->body_damping || system->modal_damping)
      {
        MultiVector forces(vectors.Map(), vectors.NumVectors());
        if (system->body_damping)
          forces.Update(1., *system->body_damping * vectors, 1.);
        if (system->modal_damping)
          forces.Update(1., *system->modal_damping * vectors, 1.);
        border(parts.body_damping, gram(*T, forces));
      }
    const auto append = [](DenseMatrix &part, const MultiVector &columns) { part = append_columns(part, replicate(columns)); };
    append(parts.friction_forces, transpose_times(*system->friction_forces, vectors));
    append(parts.radial_motion, *system->radial_motion * vectors);
    append(parts.normal_stiffness, *system->normal_stiffness * vectors);
    append(parts.normal_mass, *system->normal_mass * vectors);
    friction_K = multiply(parts.friction_forces, parts.normal_stiffness, true);
    friction_M = multiply(parts.friction_forces, parts.normal_mass, true);
    if (system->normal_damping)
      {
        append(parts.normal_damping, *system->normal_damping * vectors);
        friction_C = multiply(parts.friction_forces, parts.normal_damping, true);
      }
  }

  int ReducedModel::size() const
  {
    return parts.mass.n_rows();
  }

  const MultiVector &ReducedModel::basis() const
  {
    return *T;
  }

  const ReducedModel::Blocks &ReducedModel::blocks() const
  {
    return parts;
  }

  const ContactDamping &ReducedModel::contact_damping() const
  {
    return system->contact_damping;
  }

  ReducedPencil ReducedModel::at(const double mu) const
  {
    return at(mu, system->contact_damping);
  }

  ReducedPencil ReducedModel::at(const double mu, const ContactDamping &damping) const
  {
    ReducedPencil pencil{add(parts.mass, friction_M, -mu), parts.body_damping, add(parts.stiffness, friction_K, -mu), false};
    pencil.has_damping = parts.body_damping.n_rows() > 0 || !damping.is_zero();
    if (pencil.has_damping && parts.body_damping.n_rows() == 0)
      pencil.damping = DenseMatrix(size(), size());
    if (system->normal_damping)
      pencil.damping = add(pencil.damping, friction_C, -mu);
    const auto add_contact_damping = [&pencil](const DenseMatrix &motion, const std::vector<double> &coefficients) {
      if (pencil.has_damping && !coefficients.empty())
        pencil.damping = add(pencil.damping, multiply(motion, rows_scaled(motion, coefficients), true));
    };
    add_contact_damping(parts.radial_motion, damping.radial);
    add_contact_damping(parts.friction_forces, damping.sliding);
    return pencil;
  }
} // namespace Squeal
