#include <squeal/base/exceptions.h>
#include <squeal/parameters/parameters.h>

#include <gtest/gtest.h>

using namespace Squeal;

namespace
{
  /// The message with which an override is refused, or "accepted".
  std::string list_refusal(const std::string &setting)
  {
    try
      {
        Parameters::read("/dev/null", {setting});
      }
    catch (const ParameterError &error)
      {
        return error.what();
      }
    return "accepted";
  }

  void expect_decimal_point(const std::string &setting, const std::string &number)
  {
    const std::string message = list_refusal(setting);
    EXPECT_NE(message.find("decimal"), std::string::npos) << setting << ": " << message;
    EXPECT_NE(message.find(number), std::string::npos) << setting << ": " << message;
    EXPECT_NE(message.find(setting.substr(0, setting.find('='))), std::string::npos) << message;
  }
} // namespace

TEST(NumberLists, DecimalCommasAreRefused)
{
  expect_decimal_point("Operation/Friction coefficient=0,4", "0.4");
  expect_decimal_point("Pin material/Young modulus=1,5e9", "1.5");
  expect_decimal_point("Sweep/Number of friction coefficients=1,5", "1.5");
  expect_decimal_point("Sweep/Count modes at=0,3, 0,4", "0.3");
  expect_decimal_point("Sweep/Count modes at=0,3; 0,4", "0.3");
  expect_decimal_point("Sweep/Count modes at=0,05", "0.05");
  expect_decimal_point("Sweep/Mode shapes at=0,4, 1", "0.4");
  expect_decimal_point("Reduction/Snapshots=0,05, 0,25", "0.05");
  expect_decimal_point("Geometry/Top pin radii=0,197, 0,2585", "0.197");
  expect_decimal_point("Geometry/Top pin angles=-12,5, 12,5", "-12.5");
  expect_decimal_point("Accuracy study/Mesh factors=1, 1,5, 2,5", "1.5");
  expect_decimal_point("Pin material/Single pins=pin_top_1: 2e9, 0,25", "0.25");
  expect_decimal_point("Mounts/Elastic mounts=disc_bore: 0, 7,8e10, 1,88e10", "7.8");
  expect_decimal_point("Damping/Modal damping ratio=1000: 0,01", "0.01");
  expect_decimal_point("Steady sliding/Loads=pin_top_1: 500,5", "500.5");
}

TEST(NumberLists, RealListsAreRead)
{
  for (const char *angles :
       {"0, 60, 120, 180, 240, 300", "0,60,120,180,240,300", "-150,-90,-30,30,90,150", "0.5,60.5,120.5,180.5,240.5,300.5",
        "0,60,120, 180,240,300", "-150,-90, -30,30, 90,150", "0 , 60 , 120 , 180 , 240 , 300"})
    EXPECT_EQ(list_refusal(std::string("Geometry/Top pin angles=") + angles), "accepted") << angles;
  const auto read = [](const std::string &setting) { return Parameters::read("/dev/null", {setting}); };
  EXPECT_EQ(read("Accuracy study/Mesh factors=1,2").accuracy.factors, (std::vector<double>{1., 2.}));
  EXPECT_EQ(read("Accuracy study/Mesh factors=1, 2, 3").accuracy.factors, (std::vector<double>{1., 2., 3.}));
  EXPECT_EQ(read("Accuracy study/Mesh factors=1,2,3, 4").accuracy.factors.size(), 4u);
  EXPECT_EQ(read("Reduction/Coupled frequency=0,10000").reduction.coupled_frequencies, (std::vector<double>{0., 10000.}));
  EXPECT_EQ(read("Reduction/Coupled frequency=0, 9000,10000").reduction.coupled_frequencies.size(), 3u);
  EXPECT_EQ(read("Reduction/Snapshots=0,1").reduction.snapshots, (std::vector<double>{0., 1.}));
  EXPECT_EQ(read("Reduction/Component modes=80, 120, 60; 30,36,36").reduction.truncations.size(), 2u);
  EXPECT_EQ(read("Mounts/Elastic mounts=disc_bore: 0,1,2").materials.mounts[0].axial, 2.);
  EXPECT_EQ(read("Sweep/Count modes at=0.1,0.2, 0.3").sweep.counts, (std::vector<double>{0.1, 0.2, 0.3}));
}

TEST(NumberLists, ListsOfPointsNameEachOnce)
{
  for (const char *list : {"Sweep/Mode shapes at", "Sweep/Complex plane at", "Sweep/Count modes at", "Reduction/Snapshots"})
    {
      const std::string message = list_refusal(list + std::string("=0,0.3,0,0.4"));
      EXPECT_NE(message.find("0 is given twice"), std::string::npos) << message;
      EXPECT_NE(message.find(list), std::string::npos) << message;
    }
  // Other lists may have equal numbers
  EXPECT_EQ(list_refusal("Mounts/Elastic mounts=disc_bore: 0, 0, 1e10"), "accepted");
}
