#include "scenes.h"

using namespace Scenes;

namespace
{
  /// What check() says once the defaults are changed.
  template <typename Change>
  std::string refusal(const Change &change)
  {
    GeometryParameters parameters;
    change(parameters);
    return message<ParameterError>([&] { parameters.check(); });
  }
} // namespace

TEST(GeometryParameters, ListsAreReadAndMayBeEmpty)
{
  GeometryParameters parameters;
  Declarations       declarations;
  parameters.declare(declarations);
  for (const auto &[name, value] :
       {std::make_pair("Bottom pin radii", ""), std::make_pair("Bottom pin angles", ""), std::make_pair("Top pin radii", "0.2, 0.25"),
        std::make_pair("Top pin angles", "-10, 25.5"), std::make_pair("Nodes per pin face", "37")})
    declarations.find(std::string("Geometry/") + name)->parse(value);
  parameters.check();
  EXPECT_TRUE(parameters.bottom.radii.empty());
  EXPECT_TRUE(parameters.bottom.angles.empty());
  EXPECT_EQ(parameters.top.radii, (std::vector<double>{0.2, 0.25}));
  EXPECT_EQ(parameters.top.angles, (std::vector<double>{-10., 25.5}));
  EXPECT_EQ(parameters.nodes_per_pin_face, 37u);
}

TEST(GeometryParameters, EveryTextSaysUnits)
{
  GeometryParameters parameters;
  Declarations       declarations;
  parameters.declare(declarations);
  EXPECT_EQ(declarations.parameters().size(), 21u);
  for (const DeclaredParameter &parameter : declarations.parameters())
    EXPECT_NE(parameter.documentation.find("Units: "), std::string::npos) << parameter.path;
}

TEST(GeometryParameters, RefusalsNameParameterValueAndRemedy)
{
  expect_mentions(refusal([](auto &p) { p.disc_inner_radius = 0.4; }), {"Geometry/Disc inner radius is 0.4", "Geometry/Disc outer radius"});
  expect_mentions(refusal([](auto &p) { p.disc_thickness = 0.; }), {"Geometry/Disc thickness is 0", "positive"});
  expect_mentions(refusal([](auto &p) { p.pin_layers = 0; }), {"Geometry/Pin layers is 0"});
  expect_mentions(refusal([](auto &p) { p.top.angles.pop_back(); }), {"Geometry/Top pin radii has 6 values", "Top pin angles has 5"});
  expect_mentions(refusal([](auto &p) { p.top = p.bottom = {}; }), {"both empty", "at least one pin"});
  expect_mentions(refusal([](auto &p) { p.element_size = 0.1; }), {"Geometry/Element size is 0.1", "at most 0.0825"});
  expect_mentions(refusal([](auto &p) { p.pairing_tolerance = 0.01; }), {"Geometry/Pairing tolerance is 0.01"});
  expect_mentions(refusal([](auto &p) { p.file = ""; }), {"Geometry/File"});
}

TEST(GeometryParameters, NodesPerPinFaceNamesTheNearest)
{
  for (const auto &[given, nearest] : std::vector<
         std::pair<unsigned int, std::string>>{{1, "7"}, {8, "7"}, {12, "7"}, {14, "19"}, {20, "19"}, {36, "37"}, {50, "61"}, {62, "61"}})
    expect_mentions(refusal([n = given](auto &p) { p.nodes_per_pin_face = n; }),
                    {"Geometry/Nodes per pin face is " + std::to_string(given), "nearest allowed value is " + nearest});
  for (const unsigned int n : {7, 19, 37, 61, 91, 331})
    {
      GeometryParameters parameters;
      parameters.nodes_per_pin_face = n;
      EXPECT_NO_THROW(parameters.check());
    }
}

TEST(GeometryParameters, PinsMustFitOnTheDisc)
{
  expect_mentions(refusal([](auto &p) { p.top.radii[3] = 0.3; }), {"Top pin radii: pin 4", "0.0105 m beyond the outer"});
  expect_mentions(refusal([](auto &p) { p.bottom.radii[0] = 0.16; }),
                  {"Bottom pin radii: pin 1", "0.0165 m beyond the inner", "between 0.1765 m and 0.2895 m"});
  expect_mentions(refusal([](auto &p) { p.bottom.angles[1] = -10.; }), {"Bottom pin angles: pins 1 and 2", "overlap by 0.0231", "0.052 m"});

  // In a plan of the user's own the positions need not mean anything
  GeometryParameters parameters;
  parameters.file         = "my_plan.geo";
  parameters.top.radii[3] = 0.3;
  EXPECT_NO_THROW(parameters.check());
}
