#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace Squeal
{
  /// What a decision has been asked, on this process or in several parts of a run.
  struct DecisionRecord
  {
    std::string quantity;
    double      threshold = 0.;
    double      below = 0., above = std::numeric_limits<double>::infinity(); ///< nearest values on either side, where there were any
    long        n_below = 0, n_above = 0;                                    ///< how often each side was taken
    std::string below_in = {}, above_in = {}; ///< parts of the run to which the nearest values belong; empty: the run itself

    /// Orders of magnitude between the threshold and the nearest value on either side; infinite where there is none.
    double margin_below() const
    {
      return std::log10(threshold / below);
    }
    double margin_above() const
    {
      return std::log10(above / threshold);
    }

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &quantity &threshold &below &above &n_below &n_above &below_in &above_in;
    }
  };

  /**
   * Takes records of a part of the run into those of the whole: of every quantity the nearest values of all, and how often each side
   * was taken. Of equal values the one that was there first stays. The result is ascending by name.
   */
  void merge(std::vector<DecisionRecord> &whole, const std::vector<DecisionRecord> &part);

  /**
   * A threshold between what counts and what rounding leaves, such as the rank
   * of a matrix or equal eigenvalues. Quantities are dimensionless: scaled by
   * the size of that from which they come. Made once, at namespace scope, where
   * the quantity is computed; it keeps the nearest value on either side, so that
   * a run can tell how far its decisions were from falling the other way.
   * Nothing that is computed depends on what it keeps. Several threads may ask.
   */
  class Decision
  {
  public:
    /// @param quantity what is compared, and with what it is scaled; must outlive the decision
    Decision(const char *quantity, double threshold);
    ~Decision();

    Decision(const Decision &)            = delete;
    Decision &operator=(const Decision &) = delete;

    /// Whether @p value > threshold: it counts. NaN does not.
    bool exceeded_by(double value) const;

    double threshold() const
    {
      return limit;
    }

    /// Every decision that has been asked, ascending by name.
    static std::vector<DecisionRecord> records();

    /// Forgets what was asked so far.
    static void forget();

    /// Every decision that has been asked, and forgets it: the decisions of one of several parts.
    static std::vector<DecisionRecord> take();

  private:
    /// What some of the threads asked; on a cache line of its own, so that threads do not wait for each other.
    struct alignas(64) Asked
    {
      std::atomic<double> below = 0., above = std::numeric_limits<double>::infinity();
      std::atomic<long>   n_below = 0, n_above = 0;
    };

    DecisionRecord record() const;
    void           clear();

    const char                   *quantity;
    double                        limit;
    mutable std::array<Asked, 16> asked;
  };
} // namespace Squeal
