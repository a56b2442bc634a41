#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/mode_count_estimate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>

namespace Squeal
{
  namespace
  {
    using Point = HexMesh::Point;

    /// Orders along the height that are summed one by one; of more, samples.
    constexpr double most_orders = 1000.;
    /// Edge term of a wave in a region with free edges, and of a thin plate in bending [-].
    constexpr double free_edge = 1., free_plate_edge = 1.7126;
    /// Shear correction of plates and bars [-].
    constexpr double shear_correction = 5. / 6.;

    // ------------------------------------------------------------------ bodies

    /// A body as a prism along z.
    struct Prism
    {
      double height, area, outline; ///< h [m], S [m²], L [m]
    };

    Point difference(const Point &a, const Point &b)
    {
      return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
    }

    Point cross(const Point &a, const Point &b)
    {
      return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
    }

    /// Corners of the faces of a hexahedron, outwards.
    constexpr unsigned int face_corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

    /// Faces on the outside, by their sorted nodes: the others belong to two elements.
    using Faces = std::map<std::array<unsigned int, 4>, std::array<unsigned int, 4>>;

    Prism prism(const HexMesh &mesh, const unsigned int volume)
    {
      Faces  outside;
      double lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();
      for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
        if (hexahedron.volume == volume)
          {
            for (const auto &corners : face_corners)
              {
                std::array<unsigned int, 4> nodes;
                std::transform(corners, corners + 4, nodes.begin(), [&](const unsigned int c) { return hexahedron.nodes[c]; });
                auto key = nodes;
                std::sort(key.begin(), key.end());
                if (outside.erase(key) == 0)
                  outside.emplace(key, nodes);
              }
            for (const unsigned int node : hexahedron.nodes)
              {
                lowest  = std::min(lowest, mesh.points[node][2]);
                highest = std::max(highest, mesh.points[node][2]);
              }
          }

      // Gauss' theorem: V = ∮ z n_z dS; faces that stand upright make up the outline.
      double content = 0., lateral = 0.;
      for (const auto &[key, nodes] : outside)
        {
          const auto  &p      = mesh.points;
          const Point  normal = cross(difference(p[nodes[2]], p[nodes[0]]), difference(p[nodes[3]], p[nodes[1]]));
          const double area   = 0.5 * std::hypot(normal[0], normal[1], normal[2]);
          const double middle = 0.25 * (p[nodes[0]][2] + p[nodes[1]][2] + p[nodes[2]][2] + p[nodes[3]][2]);
          content += 0.5 * normal[2] * (middle - lowest);
          if (0.5 * std::abs(normal[2]) < 0.5 * area)
            lateral += area;
        }
      const double height = highest - lowest;
      return {height, content / height, lateral / height};
    }

    /// Of the edges of the elements of a body [m].
    double longest_edge(const HexMesh &mesh, const unsigned int volume)
    {
      double longest = 0.;
      for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
        if (hexahedron.volume == volume)
          for (const auto &corners : face_corners)
            for (unsigned int i = 0; i < 4; ++i)
              {
                const Point edge =
                  difference(mesh.points[hexahedron.nodes[corners[i]]], mesh.points[hexahedron.nodes[corners[(i + 1) % 4]]]);
                longest = std::max(longest, std::hypot(edge[0], edge[1], edge[2]));
              }
      return longest;
    }

    // ------------------------------------------------------------------ waves

    /// Wave speeds of a material [m/s].
    struct WaveSpeeds
    {
      explicit WaveSpeeds(const Material &material)
        : shear(std::sqrt(material.young_modulus / (2. * (1. + material.poisson_ratio) * material.density)))
        , bar(std::sqrt(material.young_modulus / material.density))
        , plate(bar / std::sqrt(1. - material.poisson_ratio * material.poisson_ratio))
      {}

      double shear, bar, plate;
    };

    /// Wave number of bending, ω_b = @p thin k² and ω_s = @p shear k.
    double bending_wave_number(const double omega, const double thin, const double shear)
    {
      const double a = omega / shear, b = omega / thin;
      return std::sqrt(0.5 * (a * a + std::hypot(a * a, 2. * b)));
    }

    /// N(k).
    double plane_modes(const Prism &body, const double wave_number, const double edge)
    {
      return (body.area * wave_number * wave_number + edge * body.outline * wave_number) / (4. * M_PI);
    }

    /**
     * Modes across the section for all orders along the height: k_n = (n − @p offset) π / h, n = 1, 2, ..., below
     * @p wave_number = ω / c.
     */
    double section_modes(const Prism &body, const double wave_number, const double offset)
    {
      const double n_orders = std::floor(wave_number * body.height / M_PI + offset);
      if (!(n_orders >= 1.))
        return 0.;
      const double n_samples = std::min(n_orders, most_orders), width = n_orders / n_samples;
      double       sum = 0.;
      for (double i = 0.; i < n_samples; ++i)
        {
          const double k_n = ((i + 0.5) * width + 0.5 - offset) * M_PI / body.height;
          sum += width * plane_modes(body, std::sqrt(std::max(0., wave_number * wave_number - k_n * k_n)), free_edge);
        }
      return sum;
    }

    double disc_modes(const Prism &body, const WaveSpeeds &speed, const double omega)
    {
      const double thin    = speed.plate * body.height / std::sqrt(12.);
      const double bending = bending_wave_number(omega, thin, std::sqrt(shear_correction) * speed.shear);
      double       n       = 3. + plane_modes(body, bending, free_plate_edge);
      for (const double c : {speed.shear, speed.plate})
        n += plane_modes(body, omega / c, free_edge);
      for (const double c : {speed.shear, speed.shear, speed.plate})
        n += section_modes(body, omega / c, 0.);
      return n;
    }

    double pin_modes(const Prism &body, const WaveSpeeds &speed, const double omega)
    {
      // Fixed at the back, free to slide in front: k_n = (n − ½) π / h; along the axis both ends are fixed.
      const auto   orders  = [&](const double k, const double offset) { return std::floor(k * body.height / M_PI + offset); };
      const double radius  = std::sqrt(body.area / (4. * M_PI)); // of gyration, of a round section
      const double bending = bending_wave_number(omega, speed.bar * radius, std::sqrt(shear_correction) * speed.shear);
      return 2. * orders(bending, 0.5) + orders(omega / speed.shear, 0.5) + orders(omega / speed.bar, 0.) +
             section_modes(body, omega / speed.shear, 0.5) + section_modes(body, omega / speed.plate, 0.5) +
             section_modes(body, omega / speed.shear, 0.);
    }
  } // namespace

  double ModeCountEstimate::coupled() const
  {
    return disc + pins;
  }

  ModeCountEstimate expected_number_of_modes(const HexMesh            &mesh,
                                             const MaterialParameters &materials,
                                             const double              largest_circular_frequency)
  {
    ModeCountEstimate estimate;
    for (unsigned int volume = 0; volume < mesh.volume_names.size(); ++volume)
      {
        const Prism body = prism(mesh, volume);
        if (mesh.volume_names[volume] == PhysicalNames::disc)
          estimate.disc = disc_modes(body, WaveSpeeds(materials.disc), largest_circular_frequency);
        else
          estimate.pins += pin_modes(body, WaveSpeeds(materials.pin), largest_circular_frequency);
      }
    return estimate;
  }

  void check_wave_resolution(const HexMesh            &mesh,
                             const MaterialParameters &materials,
                             const unsigned int        degree,
                             const double              largest_circular_frequency)
  {
    for (unsigned int volume = 0; volume < mesh.volume_names.size(); ++volume)
      {
        const std::string &name      = mesh.volume_names[volume];
        const bool         is_disc   = name == PhysicalNames::disc;
        const double       frequency = hertz(largest_circular_frequency);
        const double       wave      = WaveSpeeds(is_disc ? materials.disc : materials.pin).shear / frequency;
        const double       edge      = longest_edge(mesh, volume);
        if (wave * degree >= edge)
          continue;
        std::ostringstream what, change;
        what << "shear waves of " << frequency << " Hz are " << wave << " m long in " << name << ", whose elements measure up to " << edge
             << " m: the mesh does not resolve the modes of the band";
        change << "lower it below " << wave * degree / edge * frequency << " Hz, choose smaller elements, or correct "
               << (is_disc ? "Disc" : "Pin") << " material/Young modulus and Density";
        throw ParameterError(what.str(), "parameter Band/Maximum frequency", change.str());
      }
  }
} // namespace Squeal
