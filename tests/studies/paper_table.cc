#include <squeal/studies/paper_table.h>

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <tuple>

using namespace Squeal;

namespace
{
  constexpr auto  minus = DoubletSign::minus, plus = DoubletSign::plus;
  const ModeLabel A04 = {ModeFamily::axial, 0, 4}, F1 = {ModeFamily::flexural, 0, 0, 1};

  ModeLabel with_sign(ModeLabel label, const DoubletSign sign)
  {
    label.sign = sign;
    return label;
  }

  /// A mode by its frequency [Hz] and divergence rate [%].
  ComparedMode mode(const ModeLabel &label, const double frequency, const double divergence)
  {
    const double omega = circular_frequency(frequency);
    return {label, modal_quantities({0.01 * divergence * omega, omega})};
  }

  /// The cells of a row of table1.csv by the names of their columns.
  std::map<std::string, std::string> row_of(const TableOne &one, const std::string &label)
  {
    std::stringstream stream;
    one.table.write_csv(stream);
    const auto cells = [](const std::string &line) {
      std::vector<std::string> result(1);
      for (const char c : line)
        if (c == ',')
          result.emplace_back();
        else
          result.back() += c;
      return result;
    };
    std::string line;
    std::getline(stream, line);
    const auto                         names = cells(line);
    std::map<std::string, std::string> row;
    while (std::getline(stream, line))
      if (const auto values = cells(line); values[0] == label)
        for (std::size_t c = 0; c < names.size(); ++c)
          row[names[c]] = values[c];
    return row;
  }
} // namespace

TEST(TableOne, GrowingModesStandBesideGrowingOnes)
{
  // The paper prints A0-4 - as growing with C_b; here + is the one that grows
  TableOneResults results;
  results.damped = {mode(with_sign(A04, minus), 2300., -0.5), mode(with_sign(A04, plus), 2310., 0.4)};
  const auto one = table_one(results);
  for (const auto &[label, paper, name, here] :
       {std::make_tuple("A0-4 -", "0.65", "A0-4 +", "0.4"), std::make_tuple("A0-4 +", "-0.67", "A0-4 -", "-0.5")})
    {
      auto row = row_of(one, label);
      EXPECT_EQ(row["divergence with C_b paper [%]"], paper);
      EXPECT_EQ(row["mode with C_b"], name);
      EXPECT_EQ(row["divergence with C_b [%]"], here);
      EXPECT_EQ(row["mode without C_b"], "");
    }
  EXPECT_EQ(one.damped.n, 2u);
  EXPECT_EQ(one.undamped.n, 0u);

  const auto paper = paper_divergence_damped(with_sign(A04, plus));
  ASSERT_TRUE(paper);
  EXPECT_EQ(to_string(paper->label), "A0-4 -");
  EXPECT_EQ(paper->rate, 0.65);
  EXPECT_FALSE(paper_divergence_damped(A04));
  EXPECT_FALSE(paper_divergence_damped(F1));
}

TEST(TableOne, RangesOfPinModes)
{
  // Eight F1 modes in the order of their frequencies; the four most damped ones make the range
  TableOneResults results;
  results.damped = {mode(F1, 3520., -0.2), mode(F1, 3525., 0.01), mode(F1, 3528., -0.01), mode(F1, 3535., -0.4),
                    mode(F1, 3550., -1.4), mode(F1, 3560., -1.1), mode(F1, 3564., -1.2),  mode(F1, 3566., -0.9)};
  results.damped[1].quantities.divergence_rate = 0.01;
  const auto one                               = table_one(results);
  const auto expect                            = [&](const char *label, const char *frequency, const char *divergence) {
    auto row = row_of(one, label);
    EXPECT_EQ(row["with C_b [Hz]"], frequency) << label;
    EXPECT_EQ(row["divergence with C_b [%]"], divergence) << label;
  };
  expect("F1 damped lowest", "3550", "-1.4");
  expect("F1 damped highest", "3566", "-0.9");
  expect("F1 pair 1 -", "3535", "-0.4");
  expect("F1 next damped", "3520", "-0.2");
  expect("F1 neutral lowest", "3528", "-0.01");
  expect("F1 neutral highest", "3528", "-0.01");
  expect("F1 pair 1 +", "3525", "1");

  // Of too few modes there is no such group
  results.damped.resize(2);
  EXPECT_EQ(row_of(table_one(results), "F1 neutral lowest")["with C_b [Hz]"], "");
}

TEST(TableOne, UnnamedModesAreFoundByTheirFrequencies)
{
  TableOneResults results;
  results.coupled = {mode(with_sign(A04, minus), 1050., 0.), mode(with_sign(A04, plus), 1300., 0.)};
  EXPECT_EQ(row_of(table_one(results), "unnamed")["coupled [Hz]"], "1050");
  results.coupled.erase(results.coupled.begin());
  EXPECT_EQ(row_of(table_one(results), "unnamed")["coupled [Hz]"], "");
}
