#pragma once

#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/sensitivity/modal_damping.h>
#include <squeal/sensitivity/term_products.h>
#include <squeal/studies/sensitivity/sensitivity_parameters.h>
#include <squeal/studies/sweep/sweep_model.h>

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Products from which the derivatives of some modes at an operating point follow, k × k each.
  struct SensitivityProducts
  {
    std::vector<std::complex<double>> lambda;
    ComplexDenseMatrix                D; ///< ψ_iᵀ ((λ_i + λ_j) M + C) φ_j
    std::vector<ComplexDenseMatrix>   N; ///< ψ_iᵀ (∂Q(λ_j)/∂p) φ_j of each parameter
  };

  /// A sweep with its terms kept apart, as far as the derivatives of its eigenvalues need.
  struct SensitivityModel
  {
    static constexpr int main_line = 0; ///< of the sweep

    SweepModel                              &sweep; ///< of the main line
    const BodyTerms                         &bodies;
    const std::vector<SensitivityParameter> &parameters;
    std::optional<ModalDampingDerivatives>   modal_damping = {}; ///< none without it

    /// damping_rates() at the friction coefficients where they were wanted.
    mutable std::map<double, std::vector<ParameterValues>> known_damping_rates = {};

    /// Products of modes of a point of the main line. All processes must call.
    SensitivityProducts products(const ChartPoint &point, const std::vector<int> &modes) const;

    /// ψ_iᵀ (dQ(λ_j)/dp) φ_j of friction and damping of contact nodes that move, with the vectors on the dofs of the bodies and the reactions.
    ComplexDenseMatrix by_moved_contact(const ContactMotion      &motion,
                                        double                    friction_coefficient,
                                        const Eigentriples       &apart,
                                        const ComplexDenseMatrix &reactions) const;

    /// Rates of the friction coefficient and of the contact damping with respect to a parameter of the operation, by central differences.
    ParameterValues contact_rates(const SensitivityParameter &parameter, double friction_coefficient) const;

    /// dK/dp and dM/dp of the bodies for each parameter, which change the modes of modal damping and the reactions of steady sliding.
    std::vector<BodyRates> body_rates() const;

    /**
     * Rates of the contact damping for each parameter by what it changes of the bodies, on which the reactions of steady sliding depend; empty where
     * reactions are shares of the load. All processes must call.
     */
    const std::vector<ParameterValues> &damping_rates(double friction_coefficient) const;

    /// Modes of a point of the main line, as the basis grows by them.
    ChartModel::ModesAt modes_at(const ChartPoint &point, const std::vector<int> &modes) const;

    /**
     * Grows the basis by the residuals of groups of modes, one group after the other, as the vectors of one take less memory than those of all, and
     * forgets what was evaluated; returns why it cannot, or nothing. All processes must call.
     */
    std::string grow(const std::vector<std::vector<ChartModel::ModesAt>> &groups, unsigned int maximum_basis);
  };
} // namespace Squeal
