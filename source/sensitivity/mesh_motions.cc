// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/sensitivity/mesh_motions.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Point = Mesh::Point;

    /// Largest difference of the mesh from the parameters, relative to the outer radius: polygons of true area are slightly larger than
    /// circles [-].
    constexpr double resemblance = 0.02;

    /// Tolerance for axial positions and for gaps between pins, relative to the outer radius [-].
    constexpr double rounding = 1e-9;

    /// Position of a pin in the plane of the disc.
    struct PinPlace
    {
      unsigned int component;
      std::string  name;
      int          side;                 ///< sign of z
      double       x, y;                 ///< position of its axis [m]
      double       radius;               ///< distance of its outermost node from its axis [m]
      double       gap = 0.;             ///< distance to the nearest other pin on its side, or to a rim [m]
      double       axis_distance, angle; ///< from the parameters [m], [degree]
    };

    /// Pins with positions from the parameters; empty if the mesh does not have exactly these pins.
    std::vector<PinPlace> places(const Mesh &mesh, const std::vector<unsigned int> &component, const GeometryParameters &parameters)
    {
      std::vector<PinPlace> pins;
      for (const auto &[layout, prefix, side] :
           {std::make_tuple(&parameters.top, "pin_top_", 1), std::make_tuple(&parameters.bottom, "pin_bottom_", -1)})
        for (std::size_t i = 0; i < layout->radii.size(); ++i)
          {
            const std::string name  = prefix + std::to_string(i + 1);
            const auto        found = std::find(mesh.body_names.begin(), mesh.body_names.end(), name);
            if (found == mesh.body_names.end())
              return {};
            const double r = layout->radii[i], angle = layout->angles[i] * M_PI / 180.;
            PinPlace     pin{static_cast<unsigned int>(found - mesh.body_names.begin()),
                         name,
                         side,
                         r * std::cos(angle),
                         r * std::sin(angle),
                         0.,
                         0.,
                         r,
                         layout->angles[i]};
            for (std::size_t n = 0; n < mesh.points.size(); ++n)
              if (component[n] == pin.component)
                pin.radius = std::max(pin.radius, std::hypot(mesh.points[n][0] - pin.x, mesh.points[n][1] - pin.y));
            pins.push_back(pin);
          }
      if (pins.size() + 1 != mesh.body_names.size())
        return {};
      return pins;
    }

    /// Extent of the mesh, from the nodes of the disc and of the pins.
    struct Extent
    {
      double inner = std::numeric_limits<double>::infinity(), outer = 0., highest = 0.;
      double innermost_pin = inner, outermost_pin = 0., end = 0.;
    };

    Extent extent_of(const Mesh &mesh, const std::vector<unsigned int> &component)
    {
      Extent found;
      for (std::size_t n = 0; n < mesh.points.size(); ++n)
        {
          const Point &x       = mesh.points[n];
          const double r       = std::hypot(x[0], x[1]);
          const bool   is_disc = component[n] == 0;
          double      &least = is_disc ? found.inner : found.innermost_pin, &most = is_disc ? found.outer : found.outermost_pin,
                 &top = is_disc ? found.highest : found.end;
          least       = std::min(least, r);
          most        = std::max(most, r);
          top         = std::max(top, std::abs(x[2]));
        }
      return found;
    }

    /// Pins and the free space around them; empty if the mesh does not match the parameters.
    std::vector<PinPlace> pins_of(const Mesh                      &mesh,
                                  const std::vector<unsigned int> &component,
                                  const Extent                    &extent,
                                  const GeometryParameters        &parameters)
    {
      const double          t = parameters.disc_thickness, h = parameters.pin_height, R_out = parameters.disc_outer_radius;
      const auto            differs = [R_out](const double a, const double b) { return std::abs(a - b) > resemblance * R_out; };
      std::vector<PinPlace> pins    = places(mesh, component, parameters);
      if (differs(extent.inner, parameters.disc_inner_radius) || differs(extent.outer, R_out) ||
          std::abs(extent.highest - t / 2.) > rounding * R_out || std::abs(extent.end - t / 2. - h) > rounding * R_out)
        return {};
      for (PinPlace &pin : pins)
        {
          const double r = std::hypot(pin.x, pin.y);
          if (differs(pin.radius, parameters.pin_diameter / 2.))
            return {};
          pin.gap = std::min(extent.outer - r - pin.radius, r - pin.radius - extent.inner);
          for (const PinPlace &other : pins)
            if (&other != &pin && other.side == pin.side)
              pin.gap = std::min(pin.gap, std::hypot(pin.x - other.x, pin.y - other.y) - pin.radius - other.radius);
          if (!(pin.gap > rounding * R_out))
            return {};
        }
      return pins;
    }

    /// ρ of a pin: 1 inside the pin; falls to 0 at the distance of the nearest other pin or rim.
    double weight(const PinPlace &pin, const Point &x)
    {
      const double outside = std::hypot(x[0] - pin.x, x[1] - pin.y) - pin.radius;
      return std::clamp(1. - outside / pin.gap, 0., 1.);
    }
  } // namespace

  std::vector<MeshMotion> mesh_motions(const Mesh &mesh, const GeometryParameters &parameters)
  {
    const std::vector<unsigned int> component = body_of_nodes(mesh);
    const double                    t = parameters.disc_thickness, h = parameters.pin_height, d = parameters.pin_diameter;
    const Extent                    extent = extent_of(mesh, component);
    const std::vector<PinPlace>     pins   = pins_of(mesh, component, extent, parameters);
    if (pins.empty())
      return {};

    std::vector<MeshMotion> result;
    const auto add = [&](const char *parameter, const std::string &pin, const char *unit, const double value, const bool moves_contact,
                         const std::function<Point(const Point &x, unsigned int component)> &velocity) {
      MeshMotion motion{std::string("Geometry/") + parameter, pin, unit, value, {}, moves_contact};
      for (std::size_t n = 0; n < mesh.points.size(); ++n)
        motion.velocity.push_back(velocity(mesh.points[n], component[n]));
      result.push_back(std::move(motion));
    };
    // Factor that falls linearly from 1 on the face of the pins to 0 on the opposite face
    const auto through_disc = [&](const PinPlace &pin, const Point &x) { return std::clamp(0.5 + pin.side * x[2] / t, 0., 1.); };
    // In-plane velocity of the nodes of a pin and of the disc due to the motion of this pin
    const auto taken_along = [&](const PinPlace &pin, const Point &x, const unsigned int k, const auto &inside) {
      if (k != 0 && k != pin.component)
        return Point();
      const double factor = k == 0 ? through_disc(pin, x) * weight(pin, x) : 1.;
      const auto   v      = inside(pin, x);
      return Point(factor * v[0], factor * v[1], 0.);
    };

    add("Disc thickness", "", "m", t, false,
        [&](const Point &x, const unsigned int k) { return Point(0., 0., k == 0 ? x[2] / t : std::copysign(0.5, x[2])); });
    add("Pin height", "", "m", h, false, [&](const Point &x, const unsigned int k) {
      return Point(0., 0., k == 0 ? 0. : std::copysign((std::abs(x[2]) - t / 2.) / h, x[2]));
    });
    const auto radial = [&](const double rim, const double R, const double nearest_pin) {
      return [=](const Point &x, const unsigned int k) {
        const double r = std::hypot(x[0], x[1]), s = (r - nearest_pin) / (rim - nearest_pin);
        const double v = k == 0 && s > 0. ? s * rim / R / r : 0.;
        return Point(v * x[0], v * x[1], 0.);
      };
    };
    add("Disc inner radius", "", "m", parameters.disc_inner_radius, false,
        radial(extent.inner, parameters.disc_inner_radius, extent.innermost_pin));
    add("Disc outer radius", "", "m", parameters.disc_outer_radius, false,
        radial(extent.outer, parameters.disc_outer_radius, extent.outermost_pin));
    add("Pin diameter", "", "m", d, true, [&](const Point &x, const unsigned int k) {
      Point sum;
      for (const PinPlace &pin : pins)
        sum += taken_along(pin, x, k,
                           [&](const PinPlace &p, const Point &at) {
                             // Limit the velocity outside the pin to the velocity of the outline
                             const double s = std::hypot(at[0] - p.x, at[1] - p.y), slow = s > p.radius ? p.radius / s : 1.;
                             return Point(slow * (at[0] - p.x) / d, slow * (at[1] - p.y) / d, 0.);
                           }) -
               Point();
      return sum;
    });
    for (const PinPlace &pin : pins)
      {
        const bool is_top = pin.side > 0;
        add(is_top ? "Top pin radii" : "Bottom pin radii", pin.name, "m", pin.axis_distance, true,
            [&](const Point &x, const unsigned int k) {
              return taken_along(pin, x, k, [](const PinPlace &p, const Point &) {
                const double r = std::hypot(p.x, p.y);
                return Point(p.x / r, p.y / r, 0.);
              });
            });
        add(is_top ? "Top pin angles" : "Bottom pin angles", pin.name, "degree", pin.angle, true,
            [&](const Point &x, const unsigned int k) {
              return taken_along(pin, x, k,
                                 [](const PinPlace &, const Point &at) { return Point(-at[1] * M_PI / 180., at[0] * M_PI / 180., 0.); });
            });
      }
    return result;
  }

  Mesh moved(Mesh mesh, const MeshMotion &motion, const double change)
  {
    for (std::size_t n = 0; n < mesh.points.size(); ++n)
      for (int i = 0; i < 3; ++i)
        mesh.points[n][i] += change * motion.velocity[n][i];
    return mesh;
  }

  double largest_velocity(const MeshMotion &motion)
  {
    double result = 0.;
    for (const Point &v : motion.velocity)
      result = std::max(result, v.norm());
    return result;
  }
} // namespace Squeal
