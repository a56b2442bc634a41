#include <squeal/studies/paper_statements.h>

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>

using namespace Squeal;

namespace
{
  const ModeLabel A04_minus = {ModeFamily::axial, 0, 4, 0, DoubletSign::minus}, A04_plus = {ModeFamily::axial, 0, 4, 0, DoubletSign::plus},
                  R0_minus = {ModeFamily::radial, 0, 1, 0, DoubletSign::minus}, R0_plus = {ModeFamily::radial, 0, 1, 0, DoubletSign::plus},
                  F1 = {ModeFamily::flexural, 0, 0, 1};

  /// A mode by its frequency [Hz], divergence rate [%] and the share that travels with the rotation.
  StatedMode mode(const ModeLabel &label, const double frequency, const double divergence = 0., const double along = 0.5)
  {
    const double omega = circular_frequency(frequency);
    StatedMode   result;
    result.label      = label;
    result.quantities = modal_quantities({0.01 * divergence * omega, omega});
    result.unstable   = divergence > 1e-6;
    if (!label.is_of_pins())
      result.waves = WaveShares{along, 1. - along};
    return result;
  }

  /// A pair of the disc and one of the pins without C_b; with it the first decays less than it grows, the other is stable.
  SectionFour example()
  {
    SectionFour results;
    results.n_pins   = 1;
    results.coupled  = {mode(A04_minus, 2290.), mode(A04_plus, 2310.), mode(F1, 3500.), mode(F1, 3507.)};
    results.undamped = {mode(A04_minus, 2300., -0.6, 0.1), mode(A04_plus, 2300., 0.6, 0.9), mode(F1, 3503., -0.1), mode(F1, 3503., 0.1)};
    results.damped   = {mode(A04_minus, 2300., -0.62), mode(A04_plus, 2300., 0.59), mode(F1, 3502., -1.), mode(F1, 3503., -0.02)};
    results.kept     = {1, {0., 0.9, 0., 0.1}, {0., 0.9, 0.1, 0.}};
    return results;
  }

  /// Number and verdict of the statement that begins with some words; empty if there is none.
  std::pair<std::string, std::string> statement(const SectionFour &results, const std::string &beginning)
  {
    std::stringstream stream;
    statements(results).write_csv(stream);
    for (std::string line; std::getline(stream, line);)
      {
        std::vector<std::string> cells(1);
        bool                     is_quoted = false;
        for (const char c : line)
          if (c == '"')
            is_quoted = !is_quoted;
          else if (c == ',' && !is_quoted)
            cells.emplace_back();
          else
            cells.back() += c;
        if (cells.at(1).rfind(beginning, 0) == 0)
          return {cells.at(3), cells.at(5)};
      }
    return {};
  }

  using Answer = std::pair<std::string, std::string>;
} // namespace

TEST(Statements, PairsThatGrowAndDecay)
{
  SectionFour results = example();
  EXPECT_EQ(statement(results, "unstable disc modes"), Answer("1", "does not hold"));
  EXPECT_EQ(statement(results, "unstable pin modes"), Answer("1", "does not hold"));
  EXPECT_EQ(statement(results, "unstable modes have a stable partner").second, "holds");
  EXPECT_EQ(statement(results, "A0-4 + looks like a rotating wave"), Answer("0.9", "holds"));
  EXPECT_EQ(statement(results, "its partner A0-4 - rotates the opposite way"), Answer("0.9", "holds"));
  EXPECT_EQ(statement(results, "further unstable modes"), Answer());

  // Weak ones are counted apart
  results.undamped.push_back(mode(R0_minus, 690., -0.003));
  results.undamped.push_back(mode(R0_plus, 690., 0.003));
  EXPECT_EQ(statement(results, "unstable disc modes").first, "1");
  EXPECT_EQ(statement(results, "further unstable modes"), Answer("1", "holds less"));

  // A partner that decays less, and stands nearly still
  results.undamped[0] = mode(A04_minus, 2300., -0.57, 0.45);
  EXPECT_EQ(statement(results, "unstable modes have a stable partner").second, "holds less");
  EXPECT_EQ(statement(results, "its partner A0-4 -"), Answer("0.55", "does not hold"));
}

TEST(Statements, WhatDissipationChanges)
{
  SectionFour results = example();
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it removes"), Answer("1", "holds"));
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it adds"), Answer("0", "holds"));
  EXPECT_EQ(statement(results, "C_b breaks the symmetry"), Answer("-0.03", "holds"));
  EXPECT_EQ(statement(results, "C_b reduces the divergence rate of the growing A0-4"), Answer("-0.01", "holds"));

  results.damped[1] = mode(A04_plus, 2300., 0.63);
  results.damped[2] = mode(F1, 3502., 0.2);
  EXPECT_EQ(statement(results, "C_b reduces the divergence rate of the growing A0-4"), Answer("0.03", "does not hold"));
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it adds"), Answer("1", "does not hold"));
  results.damped[2] = mode(F1, 3502., 0.05);
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it adds"), Answer("1", "holds less"));

  // The other pair goes on
  results.kept.n_kept = 2;
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it adds").first, "0");
  EXPECT_EQ(statement(results, "C_b stabilises: unstable modes that it removes").first, "0");
}

TEST(Statements, FrequenciesBesideTheCoupledModes)
{
  SectionFour results = example();
  EXPECT_EQ(statement(results, "complex modes have nearly the frequencies of the real coupled ones, without C_b").second, "holds");
  results.undamped[0].quantities.frequency = 2260.; // 1.3 %
  EXPECT_EQ(statement(results, "complex modes have nearly the frequencies of the real coupled ones, without C_b").second, "holds less");
  EXPECT_EQ(statement(results, "coupling spreads the bending modes"), Answer("0.2", "holds"));
  // In-plane modes are not there
  EXPECT_EQ(statement(results, "friction hardly shifts"), Answer());
}
