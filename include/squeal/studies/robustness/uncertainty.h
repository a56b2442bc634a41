// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/parameters/robustness.h>

#include <vector>

namespace Squeal
{
  /// Independent samples of uncertain numbers, n × d, equal for equal seeds. Correlated ones have a normal copula.
  ///
  /// @param correlations d × d, of normal scores. Throws ParameterError if it is not positive definite.
  DenseMatrix independent_samples(const std::vector<Distribution> &distributions,
                                  const DenseMatrix               &correlations,
                                  int                              n,
                                  unsigned int                     seed);

  /// Samples from which sobol_indices() follow, n (d + 2) × d: two independent sets of n, and for each number the first set with that
  /// number of the second (A. Saltelli et al. 2010).
  DenseMatrix saltelli_samples(const std::vector<Distribution> &distributions, int n, unsigned int seed);

  /// A number with its interval of 95 % confidence.
  struct Estimate
  {
    double value, lower, upper;
  };

  /// Parts of the variance of an output that uncertain numbers explain.
  struct SobolIndices
  {
    std::vector<Estimate> first; ///< by each number alone
    std::vector<Estimate> total; ///< by each number with all its interactions
  };

  /// Indices (I. M. Sobol' 1993) by the estimators of J.-M. Martinez (2011), with intervals from resampling.
  ///
  /// @param samples of saltelli_samples()
  /// @param outputs one for each of them, not all of the same value
  SobolIndices sobol_indices(const DenseMatrix &samples, const std::vector<double> &outputs);

  /// Probability of an event that @p k of @p n independent samples have, with the interval of C. J. Clopper and E. S. Pearson (1934).
  Estimate probability(int k, int n);

  /// Mean, and standard deviation about it, of one value at least.
  double mean(const std::vector<double> &values);
  double deviation(const std::vector<double> &values);

  /// Value below which a part @p p of some values lies, between the two nearest ones. The values are sorted, one at least.
  double quantile(const std::vector<double> &sorted, double p);
} // namespace Squeal
