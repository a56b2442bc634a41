// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <functional>

using namespace Scenes;

namespace
{
  using Change = std::function<void(GeometryParameters &)>;

  /// The default parameters with a change.
  GeometryParameters with(const Change &change)
  {
    GeometryParameters parameters;
    change(parameters);
    return parameters;
  }
} // namespace

TEST(GeometryParameters, RefusalsNameParameterValueAndRemedy)
{
  for (const auto &[change, mentions] : std::vector<std::pair<Change, std::vector<std::string>>>{
         {[](auto &p) { p.disc_inner_radius = 0.4; }, {"Geometry/Disc inner radius is 0.4", "Geometry/Disc outer radius"}},
         {[](auto &p) { p.top.angles.pop_back(); }, {"Geometry/Top pin radii has 6 values", "Top pin angles has 5"}},
         {[](auto &p) { p.top = p.bottom = {}; }, {"both empty", "at least one pin"}},
         {[](auto &p) { p.element_size = 0.1; }, {"Geometry/Element size is 0.1", "at most 0.0825"}},
         {[](auto &p) { p.bottom.radii[0] = 0.16; },
          {"Bottom pin radii: pin 1", "0.0165 m beyond the inner", "between 0.1765 m and 0.2895 m"}},
         {[](auto &p) { p.bottom.angles[1] = -10.; }, {"Bottom pin angles: pins 1 and 2", "axes are 0.028", "0.052 m"}}})
    expect_mentions(message<ParameterError>([&] { with(change).check(); }), mentions);

  // Pin positions are not checked for a user-defined plan
  GeometryParameters parameters = of_file("my_plan.geo");
  parameters.top.radii[3]       = 0.3;
  EXPECT_NO_THROW(parameters.check());
}

TEST(GeometryParameters, NodesPerPinFaceNamesTheNearest)
{
  for (const auto &[given, nearest] : {std::pair(1, 7), {14, 19}, {50, 61}})
    expect_mentions(message<ParameterError>([n = given] { with([n](auto &p) { p.nodes_per_pin_face = n; }).check(); }),
                    {"Geometry/Nodes per pin face is " + std::to_string(given), "nearest allowed value, " + std::to_string(nearest)});
}
