// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/modes/reduced_modes.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Largest |Im λ| of a real λ, relative to the end of the band, because rounding splits a multiple real λ into complex pairs [-].
    constexpr double real_in_band = 1e-7;

    /// Smallest number of basis vectors for which separating the modes of the band saves time.
    constexpr int least_separated = 64;

    bool is_real(const Complex lambda, const double largest_circular_frequency)
    {
      return !(std::abs(lambda.imag()) / largest_circular_frequency > real_in_band);
    }

    /// |λ|² up to this limit counts as zero: rounding errors of K_c or of the stiffest basis vector [rad²/s²].
    double hidden_square(const ReducedModel &model)
    {
      constexpr double rounding = 100. * std::numeric_limits<double>::epsilon();
      const double stiffest = model.size() > 0 ? (model.stiffness().diagonal().array() / model.mass().diagonal().array()).maxCoeff() : 0.;
      return std::max(model.full_order().hidden_square, rounding * stiffest);
    }

    /// Keeps only oscillating modes: moves real eigenvalues to their list, and counts zeros of rigid-body motions and spurious real
    /// eigenvalues.
    void separate_real(ReducedModes &modes, const ReducedModel &model, const double largest_circular_frequency)
    {
      const double hidden = hidden_square(model);
      // Count twice, because modes.lambda contains one eigenvalue of each conjugate pair
      std::vector<int> others;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (const Complex l = modes.lambda[j]; !(std::norm(l) > hidden))
          modes.n_zeros += 2;
        else if (is_real(l, largest_circular_frequency))
          modes.real_values.insert(modes.real_values.end(), 2, l.real());
        else
          others.push_back(static_cast<int>(j));
      if (others.size() < modes.lambda.size())
        modes = selected(modes, others);

      auto &values = modes.real_values;
      // Real λ below zero_frequency times the end of the band are creep motions and count as zeros
      const auto end = std::remove_if(values.begin(), values.end(),
                                      [&](const double l) { return !(std::abs(l) / largest_circular_frequency > zero_frequency); });
      modes.n_zeros += static_cast<int>(values.end() - end);
      values.erase(end, values.end());
      std::sort(values.begin(), values.end());
    }

    /// Replaces the modes by the modes of process 0, because vectors of a multiple eigenvalue may differ between processes.
    void agree_on_modes(const MPI_Comm communicator, ReducedModes &modes)
    {
      const int r         = modes.mass.rows();
      int       counts[3] = {static_cast<int>(modes.lambda.size()), static_cast<int>(modes.real_values.size()), modes.n_zeros};
      agree(communicator, counts, 3);
      const int k = counts[0];
      modes.lambda.resize(k);
      modes.real_values.resize(counts[1]);
      modes.n_zeros = counts[2];
      if (modes.right.cols() != k)
        modes.right = modes.left = ComplexDenseMatrix(r, k);
      agree(communicator, modes.lambda.data(), k);
      agree(communicator, modes.right.data(), r * k);
      agree(communicator, modes.left.data(), r * k);
      agree(communicator, modes.real_values.data(), counts[1]);
    }

    /// Result with the pencil of the model, but without modes.
    ReducedModes without_modes(const ReducedModel &model, const ParameterValues &values)
    {
      ReducedModes modes;
      modes.values    = values;
      modes.pencil    = model.at(values);
      modes.mass      = model.mass();
      modes.stiffness = model.stiffness();
      return modes;
    }

    const DenseMatrix *damping_of(const ReducedPencil &pencil)
    {
      return pencil.has_damping ? &pencil.damping : nullptr;
    }

    void take(ReducedModes &modes, DenseQuadraticModes found)
    {
      modes.lambda      = std::move(found.values);
      modes.right       = std::move(found.right);
      modes.left        = std::move(found.left);
      modes.real_values = std::move(found.real_values);
    }

    /// Modes up to @p largest_circular_frequency by the QR algorithm, without separation of the band.
    ReducedModes all_modes(const ReducedModel    &model,
                           const ParameterValues &values,
                           const double           largest_circular_frequency,
                           const RealVectors      real_vectors)
    {
      ReducedModes         modes  = without_modes(model, values);
      const ReducedPencil &pencil = modes.pencil;
      take(modes, dense_quadratic_modes(pencil.mass, damping_of(pencil), pencil.stiffness, largest_circular_frequency, real_vectors));
      return modes;
    }

    double band_limit(const double largest_circular_frequency, const BandEnd end)
    {
      return end == BandEnd::cut ? largest_circular_frequency : std::numeric_limits<double>::infinity();
    }

  } // namespace

  ReducedModes local_reduced_modes(const ReducedModel    &model,
                                   const ParameterValues &values,
                                   const double           largest_circular_frequency,
                                   const BandEnd          end)
  {
    const double limit = band_limit(largest_circular_frequency, end);
    if (auto found = modal_modes_of_band(model, values, limit))
      {
        const DenseMatrix &V     = model.modal().vectors;
        ReducedModes       modes = without_modes(model, values);
        take(modes, {std::move(found->lambda), multiply(V, found->right), multiply(V, found->left), std::move(found->real_values)});
        modes.n_zeros = found->n_zeros;
        normalize_columns(modes.right);
        normalize_columns(modes.left);
        return modes;
      }
    return local_reduced_modes_by_qr(model, values, largest_circular_frequency, end);
  }

  ReducedModes local_reduced_modes_by_qr(const ReducedModel    &model,
                                         const ParameterValues &values,
                                         const double           largest_circular_frequency,
                                         const BandEnd          end)
  {
    ReducedModes modes = all_modes(model, values, band_limit(largest_circular_frequency, end), RealVectors::none);
    separate_real(modes, model, largest_circular_frequency);
    return modes;
  }

  std::optional<ReducedModes> modal_modes_of_band(const ReducedModel    &model,
                                                  const ParameterValues &values,
                                                  const double           largest_circular_frequency)
  {
    // With few vectors or without a frequency limit, separation does not save time
    if (model.size() < least_separated || !std::isfinite(largest_circular_frequency))
      return {};
    const ReducedModel::Modal &modal  = model.modal();
    ReducedModes               modes  = without_modes(modal.model, values);
    const ReducedPencil       &pencil = modes.pencil;
    auto found = dense_modes_of_band(pencil.mass, damping_of(pencil), pencil.stiffness, modal.squares, largest_circular_frequency);
    if (!found)
      return {};
    take(modes, std::move(*found));
    separate_real(modes, model, largest_circular_frequency);
    return modes;
  }

  ReducedModes reduced_modes(const ReducedModel &model, const double mu, const double largest_circular_frequency, const BandEnd end)
  {
    ReducedModes modes = local_reduced_modes(model, model.full_order().at(mu), largest_circular_frequency, end);
    agree_on_modes(model.basis().communicator(), modes);
    return modes;
  }

  ReducedModes real_eigenvalue_modes(const ReducedModel &model, const double mu, const Band &band)
  {
    ReducedModes     modes = all_modes(model, model.full_order().at(mu), band.end, RealVectors::wanted);
    std::vector<int> real;
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (const double size = std::abs(modes.lambda[j]);
          is_real(modes.lambda[j], band.end) && size > zero_frequency * band.end && band.lists(modes.lambda[j]))
        real.push_back(static_cast<int>(j));
    modes = selected(modes, real);
    agree_on_modes(model.basis().communicator(), modes);
    return modes;
  }

  ReducedModes reduced_real_modes(const ReducedModel &model, const double largest_circular_frequency, const BandEnd end)
  {
    ReducedModes modes;
    modes.values    = model.full_order().values;
    modes.mass      = model.mass();
    modes.stiffness = model.stiffness();
    modes.pencil    = {modes.mass, DenseMatrix(), modes.stiffness, false};

    const auto [squares, vectors] = symmetric_eigenpairs(modes.stiffness, modes.mass);
    const double     limit = band_limit(largest_circular_frequency, end), hidden = hidden_square(model);
    std::vector<int> kept;
    for (std::size_t j = 0; j < squares.size(); ++j)
      if (!(squares[j] > hidden))
        modes.n_zeros += 2;
      else if (squares[j] <= limit * limit)
        {
          kept.push_back(static_cast<int>(j));
          modes.lambda.emplace_back(0., std::sqrt(squares[j]));
        }
    modes.right = modes.left = vectors(Eigen::placeholders::all, kept).cast<Complex>();
    agree_on_modes(model.basis().communicator(), modes);
    return modes;
  }

  ReducedModes selected(const ReducedModes &modes, const std::vector<int> &chosen)
  {
    ReducedModes result = modes;
    result.lambda.clear();
    for (const int j : chosen)
      result.lambda.push_back(modes.lambda[j]);
    result.right = modes.right(Eigen::placeholders::all, chosen);
    result.left  = modes.left(Eigen::placeholders::all, chosen);
    return result;
  }
} // namespace Squeal
