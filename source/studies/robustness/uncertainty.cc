// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/robustness/uncertainty.h>

#include <boost/math/distributions/binomial.hpp>

// OpenTURNS 1.23 renamed ComposedDistribution to JointDistribution, and a later version UserDefined to FiniteDiscreteDistribution
#if __has_include(<openturns/JointDistribution.hxx>)
#  include <openturns/JointDistribution.hxx>
#else
#  include <openturns/ComposedDistribution.hxx>
#endif
#if __has_include(<openturns/FiniteDiscreteDistribution.hxx>)
#  include <openturns/FiniteDiscreteDistribution.hxx>
#else
#  include <openturns/UserDefined.hxx>
#endif
#include <openturns/LogNormal.hxx>
#include <openturns/MartinezSensitivityAlgorithm.hxx>
#include <openturns/NormalCopula.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolIndicesExperiment.hxx>
#include <openturns/TruncatedNormal.hxx>
#include <openturns/Uniform.hxx>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
#if __has_include(<openturns/JointDistribution.hxx>)
    using JointDistribution = OT::JointDistribution;
#else
    using JointDistribution    = OT::ComposedDistribution;
#endif
#if __has_include(<openturns/FiniteDiscreteDistribution.hxx>)
    using DiscreteDistribution = OT::FiniteDiscreteDistribution;
#else
    using DiscreteDistribution = OT::UserDefined;
#endif
    constexpr double confidence = 0.95;

    OT::Distribution ot_distribution(const Distribution &distribution)
    {
      const std::vector<double> &x = distribution.numbers;
      switch (distribution.kind)
        {
          case DistributionKind::uniform:
            return OT::Uniform(x[0], x[1]);
          case DistributionKind::normal:
            return x.size() == 4 ?
                     OT::TruncatedNormal(x[0], x[1], x[2], x[3]) :
                     OT::TruncatedNormal(x[0], x[1], x[0] - Distribution::normal_end * x[1], x[0] + Distribution::normal_end * x[1]);
          case DistributionKind::lognormal:
            {
              const double square = std::log1p(std::pow(x[1] / x[0], 2)); // variance of the logarithm
              return OT::LogNormal(std::log(x[0]) - 0.5 * square, std::sqrt(square), 0.);
            }
          case DistributionKind::table:
            break;
        }
      OT::Sample values(x.size(), 1);
      for (std::size_t i = 0; i < x.size(); ++i)
        values(i, 0) = x[i];
      return DiscreteDistribution(values);
    }

    JointDistribution joint_distribution(const std::vector<Distribution> &distributions, const DenseMatrix *correlations)
    {
      OT::Collection<OT::Distribution> all;
      for (const Distribution &distribution : distributions)
        all.add(ot_distribution(distribution));
      if (correlations == nullptr || correlations->isIdentity(0.))
        return JointDistribution(all);
      OT::CorrelationMatrix R(distributions.size());
      for (std::size_t i = 0; i < distributions.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          R(i, j) = (*correlations)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      try
        {
          return JointDistribution(all, OT::NormalCopula(R));
        }
      catch (const OT::Exception &)
        {
          throw ParameterError("the correlation matrix is not positive definite", "parameter Robustness/Correlations",
                               "give correlations closer to zero");
        }
    }

    DenseMatrix as_matrix(const OT::Sample &sample)
    {
      DenseMatrix result(sample.getSize(), sample.getDimension());
      for (Eigen::Index i = 0; i < result.rows(); ++i)
        for (Eigen::Index j = 0; j < result.cols(); ++j)
          result(i, j) = sample(i, j);
      return result;
    }
  } // namespace

  DenseMatrix independent_samples(const std::vector<Distribution> &distributions,
                                  const DenseMatrix               &correlations,
                                  const int                        n,
                                  const unsigned int               seed)
  {
    OT::RandomGenerator::SetSeed(seed);
    return as_matrix(joint_distribution(distributions, &correlations).getSample(n));
  }

  DenseMatrix saltelli_samples(const std::vector<Distribution> &distributions, const int n, const unsigned int seed)
  {
    OT::RandomGenerator::SetSeed(seed);
    return as_matrix(OT::SobolIndicesExperiment(joint_distribution(distributions, nullptr), n, false).generate());
  }

  SobolIndices sobol_indices(const DenseMatrix &samples, const std::vector<double> &outputs)
  {
    const auto d = static_cast<std::size_t>(samples.cols());
    OT::Sample inputs(outputs.size(), d), values(outputs.size(), 1);
    for (std::size_t i = 0; i < outputs.size(); ++i)
      {
        values(i, 0) = outputs[i];
        for (std::size_t j = 0; j < d; ++j)
          inputs(i, j) = samples(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    OT::RandomGenerator::SetSeed(0);
    OT::MartinezSensitivityAlgorithm algorithm(inputs, values, outputs.size() / (d + 2));
    algorithm.setConfidenceLevel(confidence);
    const auto estimates = [d](const OT::Point &indices, const OT::Interval &interval) {
      std::vector<Estimate> result;
      for (std::size_t j = 0; j < d; ++j)
        result.push_back({indices[j], interval.getLowerBound()[j], interval.getUpperBound()[j]});
      return result;
    };
    return {estimates(algorithm.getFirstOrderIndices(), algorithm.getFirstOrderIndicesInterval()),
            estimates(algorithm.getTotalOrderIndices(), algorithm.getTotalOrderIndicesInterval())};
  }

  Estimate probability(const int k, const int n)
  {
    using Binomial         = boost::math::binomial_distribution<>;
    constexpr double outer = 0.5 * (1. - confidence);
    return {static_cast<double>(k) / n, Binomial::find_lower_bound_on_p(n, k, outer), Binomial::find_upper_bound_on_p(n, k, outer)};
  }

  double mean(const std::vector<double> &values)
  {
    return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
  }

  double deviation(const std::vector<double> &values)
  {
    const double middle = mean(values);
    double       sum    = 0.;
    for (const double value : values)
      sum += std::pow(value - middle, 2);
    return std::sqrt(sum / static_cast<double>(values.size()));
  }

  double quantile(const std::vector<double> &sorted, const double p)
  {
    const double place = p * static_cast<double>(sorted.size() - 1);
    const auto   i     = static_cast<std::size_t>(place);
    const double part  = place - static_cast<double>(i);
    // Avoid the difference of two infinite values
    return i + 1 == sorted.size() || part == 0. || sorted[i + 1] == sorted[i] ? sorted[i] : sorted[i] + part * (sorted[i + 1] - sorted[i]);
  }
} // namespace Squeal
