// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/parameters/robustness.h>

#include <vector>

namespace Squeal
{
  /// Independent samples of uncertain numbers, n × d, reproducible with the seed. Correlated numbers have a normal copula.
  ///
  /// @param correlations d × d, correlations of the normal scores. Throws ParameterError if they are not positive definite.
  DenseMatrix independent_samples(const std::vector<Distribution> &distributions,
                                  const DenseMatrix               &correlations,
                                  int                              n,
                                  unsigned int                     seed);

  /// Samples for sobol_indices(), n (d + 2) × d: two independent sets of n samples, and for each number a copy of the first set with this
  /// number taken from the second set (A. Saltelli et al. 2010).
  DenseMatrix saltelli_samples(const std::vector<Distribution> &distributions, int n, unsigned int seed);

  /// A number with its 95 % confidence interval.
  struct Estimate
  {
    double value, lower, upper;
  };

  /// Fractions of the variance of an output due to each uncertain number.
  struct SobolIndices
  {
    std::vector<Estimate> first; ///< due to each number alone
    std::vector<Estimate> total; ///< due to each number, including interactions
  };

  /// Sobol' indices (I. M. Sobol' 1993) by the estimators of J.-M. Martinez (2011), with confidence intervals from resampling.
  ///
  /// @param samples from saltelli_samples()
  /// @param outputs one for each sample, not all equal
  SobolIndices sobol_indices(const DenseMatrix &samples, const std::vector<double> &outputs);

  /// Probability of an event observed in @p k of @p n independent samples, with the confidence interval of C. J. Clopper and E. S. Pearson
  /// (1934).
  Estimate probability(int k, int n);

  /// Mean of one or more values, and their standard deviation.
  double mean(const std::vector<double> &values);
  double deviation(const std::vector<double> &values);

  /// p-quantile of one or more values, interpolated linearly; the values must be sorted.
  double quantile(const std::vector<double> &sorted, double p);
} // namespace Squeal
